/* scene_bake.c - a woven material of a scene, baked in its place */
#include <stdio.h>
#include <string.h>

#include "base/fail.h"
#include "weft/match.h"
#include "weft/weave.h"

/* The layers over the threads that stay as they are: their amount, then their other numbers. A sheen is fitted with the
 * threads, since glTF has one sheen. */
enum { LAYERS = 2, LAYER_INPUTS = 3 };
static const char *const layers[LAYERS][LAYER_INPUTS] = {{"fuzz", "fuzz_color", "fuzz_roughness"},
                                                         {"clearcoat", "clearcoat_roughness", "coat_ior"}};

/* Returns a woven material without the layers that stay. */
static WeftMaterial without_layers(const WeftMaterial *woven) {
    WeftMaterial bare = *woven;
    for (int l = 0; l < LAYERS; l++) bare.inputs[weft_material_input_find(layers[l][0])].value[0] = 0.0f;
    return bare;
}

/* Lays the layers of the woven material over the baked one. */
static WeftResult keep_layers(WeftScene *scene, int index, const WeftMaterial *woven, WeftError *error) {
    WeftMaterial baked;
    const WeftResult result = weft_scene_material(scene, index, &baked, error);
    if (result != WEFT_OK) return result;
    for (int l = 0; l < LAYERS; l++) {
        if (!(woven->inputs[weft_material_input_find(layers[l][0])].value[0] > 0.0f)) continue;
        for (int k = 0; k < LAYER_INPUTS; k++) {
            const int input = weft_material_input_find(layers[l][k]);
            baked.inputs[input] = woven->inputs[input];
        }
    }
    return weft_scene_put_material(scene, index, &baked, error);
}

/* Refuses a number that another material has as its name. */
static WeftResult check_number(const WeftScene *scene, int index, const char *number, WeftError *error) {
    for (int k = 0; k < weft_scene_info(scene).material_count; k++)
        if (k != index && strcmp(weft_scene_material_name(scene, k), number) == 0)
            return fail(error, WEFT_MESSAGE_DESC, "materials",
                        "material %d is woven, and material %d has the name \"%s\"; give that one another", index, k,
                        number);
    return WEFT_OK;
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
    char number[16], file[4096];
    const int length = snprintf(file, sizeof file, "%s/material.json", folder);
    snprintf(number, sizeof number, "%d", material);
    WeftResult result = weft_scene_material(scene, material, &woven, error);
    if (result != WEFT_OK) return result;
    if (!woven.cloth) return fail(error, WEFT_MESSAGE_DESC, "maps", "the material is not woven");
    if (length < 0 || (size_t)length >= sizeof file)
        return fail(error, WEFT_MESSAGE_FILE_WRITE, "maps", "the name is too long");
    result = check_number(scene, material, number, error);
    if (result == WEFT_OK) result = bake_cloth(scene, &woven, baking, folder, found, error);
    if (result == WEFT_OK) result = weft_scene_assign_material(scene, number, file, NULL, error);
    return result == WEFT_OK ? keep_layers(scene, material, &woven, error) : result;
}
