/* scene_bake.c - a woven material of a scene, baked in its place */
#include <stdbool.h>
#include <stdio.h>

#include "base/fail.h"
#include "scene/material/assign.h"
#include "scene/material/cloth_fit.h"
#include "weft/match.h"
#include "weft/weave.h"

/* The inputs that lie over the threads and stay as they are: those of each layer, the amount first. A sheen is fitted with the
 * threads, since glTF has one sheen. */
enum { LAYERS = 3, LAYER_INPUTS = 9 };
static const char *const layers[LAYERS][LAYER_INPUTS] = {{"fuzz", "fuzz_color", "fuzz_roughness"},
                                                         {"clearcoat", "clearcoat_roughness", "clearcoat_normal",
                                                          "coat_ior", "coat_color", "coat_darkening", "coat_anisotropy",
                                                          "coat_anisotropy_direction"},
                                                         {"emission", "emission_strength"}};

/* The amounts of what textures do not have. */
enum { DROPPED = 2 };
static const char *const dropped[DROPPED] = {"dust", "wear"};

/* Returns true if there is some of an input. */
static bool is_there(const WeftMaterial *material, const char *amount) {
    const float *value = material->inputs[weft_material_input_find(amount)].value;
    WeftInputInfo info;
    (void)weft_material_input_info(weft_material_input_find(amount), &info);
    return value[0] > 0.0f || (info.kind == WEFT_INPUT_COLOR && (value[1] > 0.0f || value[2] > 0.0f));
}

static void take_off(WeftMaterial *material, const char *amount) {
    WeftInput *input = &material->inputs[weft_material_input_find(amount)];
    for (int c = 0; c < 3; c++) input->value[c] = 0.0f;
    input->texture = 0;
}

/* Returns a woven material without what stays, and without what textures do not have. */
static WeftMaterial without_layers(const WeftMaterial *woven) {
    WeftMaterial bare = *woven;
    for (int l = 0; l < LAYERS; l++) take_off(&bare, layers[l][0]);
    for (int d = 0; d < DROPPED; d++) take_off(&bare, dropped[d]);
    return bare;
}

/* Lists what the textures lack of a woven material: its rotation, a place on the mesh, what is dropped, and textures on
 * anything but the layers. Returns false where memory is short. */
static bool list_lost(const WeftScene *scene, int index, const WeftMaterial *woven, WeftLosses *losses) {
    const WeftMaterial bare = without_layers(woven);
    const double degrees = (double)weft_scene_cloth_info(scene, woven->cloth).rotation;
    const char *name = weft_scene_material_name(scene, index);
    bool room = true;
    char why[96];
    snprintf(why, sizeof why, "the weave lies straight, and is rotated by %g degrees in the original", degrees);
    if (degrees > 0.0 || degrees < 0.0) room = weft_losses_add(losses, index, name, "rotation", why) != 0;
    if (weft_scene_material_used(scene, index) && !(cloth_uv_metres(scene, index, 0, NULL) > 0.0))
        room = room && weft_losses_add(losses, index, name, "threads",
                                       "its mesh has no texture coordinates, so that all of it shows one texel");
    for (int d = 0; d < DROPPED; d++) {
        if (!is_there(woven, dropped[d])) continue;
        snprintf(why, sizeof why, "%g of it is not baked",
                 (double)woven->inputs[weft_material_input_find(dropped[d])].value[0]);
        room = room && weft_losses_add(losses, index, name, dropped[d], why);
    }
    for (int k = 0; weft_material_input_name(k); k++)
        if (bare.inputs[k].texture && weft_material_reads(&bare, k))
            room =
                room && weft_losses_add(losses, index, name, weft_material_input_name(k), "its texture is not baked");
    return room;
}

/* Lays the layers of the woven material over the baked one. */
static WeftResult keep_layers(WeftScene *scene, int index, const WeftMaterial *woven, WeftError *error) {
    WeftMaterial baked;
    const WeftResult result = weft_scene_material(scene, index, &baked, error);
    if (result != WEFT_OK) return result;
    for (int l = 0; l < LAYERS; l++) {
        if (!is_there(woven, layers[l][0])) continue;
        for (int k = 0; k < LAYER_INPUTS && layers[l][k]; k++) {
            const int input = weft_material_input_find(layers[l][k]);
            baked.inputs[input] = woven->inputs[input];
        }
    }
    return weft_scene_put_material(scene, index, &baked, error);
}

/* Writes the maps of the cloth of a woven material. */
static WeftResult bake_cloth(const WeftScene *scene, const WeftMaterial *woven, const WeftBaking *baking,
                             const char *folder, WeftBaked *found, WeftError *error) {
    const WeftClothInfo info = weft_scene_cloth_info(scene, woven->cloth);
    const WeftMaterial bare = without_layers(woven);
    WeftBaking own = *baking;
    WeftYarn yarns[2];
    WeftCloth *cloth = NULL;
    if (!(own.metres > 0.0) && !(own.metres < 0.0)) own.metres = (double)info.metres;
    const WeftDraft *draft = weft_scene_cloth(scene, woven->cloth, yarns);
    WeftResult result = weft_cloth_create(draft, yarns, (unsigned)info.seed, &cloth, error);
    if (result == WEFT_OK) result = weft_material_bake(&bare, cloth, &own, folder, found, error);
    weft_cloth_free(cloth);
    return result;
}

WeftResult weft_scene_bake(WeftScene *scene, int material, const WeftBaking *baking, const char *folder,
                           WeftBaked *found, WeftError *error) {
    WeftMaterial woven;
    char file[4096];
    const int length = snprintf(file, sizeof file, "%s/material.json", folder);
    WeftResult result = weft_scene_material(scene, material, &woven, error);
    if (result != WEFT_OK) return result;
    if (!woven.cloth) return fail(error, WEFT_MESSAGE_DESC, "maps", "the material is not woven");
    if (length < 0 || (size_t)length >= sizeof file)
        return fail(error, WEFT_MESSAGE_FILE_WRITE, "maps", "the name is too long");
    if (baking->losses && !list_lost(scene, material, &woven, baking->losses))
        return fail(error, WEFT_MESSAGE_MEMORY, "maps", NULL);
    result = bake_cloth(scene, &woven, baking, folder, found, error);
    if (result == WEFT_OK) result = material_assign_file(scene, material, file, error);
    return result == WEFT_OK ? keep_layers(scene, material, &woven, error) : result;
}
