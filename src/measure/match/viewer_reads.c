/* viewer_reads.c - which viewer reads which extension
 *
 * As read in the loaders of three.js 0.187 (examples/jsm/loaders/GLTFLoader.js) and Babylon.js 9.28
 * (@babylonjs/loaders, glTF/2.0/Extensions), in google/filament 1.53.4 (libs/gltfio) and in KhronosGroup/glTF-Blender-IO.
 * Babylon.js's usual material takes the numbers of KHR_materials_fuzz for those of a sheen, so that the sheen beside the
 * fuzz, which is fitted to it, serves it better. Filament's build for the web ignores KHR_materials_anisotropy, ends where
 * a material has KHR_materials_ior, dims metals by the factor of KHR_materials_specular, but not by its colour, and draws no
 * specular reflection at all, of metals neither, beside a sheen where a material has no KHR_materials_specular. */
#include "measure/match/viewer_reads.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/fail.h"
#include "gltf/asset/material_fields.h"
#include "measure/match/match_factor.h"

/* The targets, in the order of their bits below. */
static const WeftTarget targets[] = {
    {"khronos", "any viewer that follows glTF's own text: nothing is taken out, fine normal maps get mip levels",
     "khronos", 1, "khronos"},
    {"three", "three.js 0.187, GLTFLoader", "three", 1, "three"},
    {"babylon", "Babylon.js 9.28, PBRMaterial", "babylon", 0, "three"},
    {"filament", "Filament 1.53.4, its build for the web too: no anisotropy", "filament-sheen", 1, "filament-sheen"},
    {"blender", "Blender 4 and later, its importer and Principled BSDF", "cycles-principled", 0, "cycles-principled"},
    {"core", "engines without extensions: metalness and roughness alone", "core", 0, "core"},
};
enum { TARGETS = sizeof targets / sizeof *targets };
enum { KHRONOS = 1, THREE = 2, BABYLON = 4, FILAMENT = 8, BLENDER = 16, CORE = 32, VIEWERS = 31 };

/* The targets that multiply the reflection of metals, too, by specularFactor, which is of dielectrics only. */
enum { STRENGTH_DIMS_METALS = FILAMENT };

/* The targets that shade a sheen without KHR_materials_specular as if its strength were 0. */
enum { SHEEN_WANTS_SPECULAR = FILAMENT };

/* The effect of leaving an extension out. */
typedef enum Effect {
    OTHER_LIGHT, /* the material reflects light in another way, which other factors make up for in part */
    OTHER_LOOK,  /* something is not shown, and no factor stands for it */
    NO_MATERIAL  /* its factors mean nothing without the extension */
} Effect;

static const struct {
    const char *name;
    unsigned readers; /* bits of targets */
    Effect effect;
    const char *lost; /* a sentence without its end */
} extensions[] = {
    {"KHR_materials_sheen", VIEWERS, OTHER_LIGHT, "there is no rim of fibres"},
    {"KHR_materials_fuzz", KHRONOS, OTHER_LOOK, "fuzz is shown as the sheen beside it"},
    {"KHR_materials_coat", KHRONOS, OTHER_LOOK, "the coat is shown as a plain clear coat"},
    {"KHR_materials_clearcoat", VIEWERS, OTHER_LIGHT, "there is no clear coat"},
    {"KHR_materials_anisotropy", KHRONOS | THREE | BABYLON | BLENDER, OTHER_LIGHT,
     "highlights are round, not stretched across fibres"},
    {"KHR_materials_specular", VIEWERS, OTHER_LIGHT, "highlights have the strength and colour of plain plastic"},
    {"KHR_materials_ior", KHRONOS | THREE | BABYLON | BLENDER, OTHER_LIGHT, "the index of refraction is 1.5"},
    {"KHR_materials_diffuse_transmission", KHRONOS | BABYLON, OTHER_LOOK, "no light shines through from behind"},
    {"KHR_materials_diffuse_roughness", KHRONOS | THREE | BABYLON, OTHER_LIGHT, "the diffuse reflection is smooth"},
    {"KHR_materials_retroreflection", KHRONOS, OTHER_LIGHT, "no light is turned back to where it came from"},
    {"KHR_materials_emissive_strength", VIEWERS, OTHER_LOOK, "emission is no stronger than 1"},
    {"KHR_materials_transmission", VIEWERS, OTHER_LOOK, "glass is opaque"},
    {"KHR_materials_volume", VIEWERS, OTHER_LOOK, "glass has no colour inside"},
    {"KHR_materials_iridescence", KHRONOS | THREE | BABYLON, OTHER_LOOK, "thin films have no colours"},
    {"KHR_materials_dispersion", KHRONOS | THREE | BABYLON | FILAMENT, OTHER_LOOK, "glass does not split colours"},
    {"KHR_materials_pbrSpecularGlossiness", KHRONOS | BABYLON | FILAMENT | BLENDER, NO_MATERIAL, ""},
};
enum { EXTENSIONS = sizeof extensions / sizeof *extensions };

int weft_target_info(int index, WeftTarget *out) {
    if (index < 0 || index >= TARGETS) return 0;
    *out = targets[index];
    return 1;
}

static bool reads(int target, int extension) { return (extensions[extension].readers >> target & 1u) != 0; }

static bool reads_named(int target, const char *name) {
    for (int k = 0; k < EXTENSIONS; k++)
        if (strcmp(extensions[k].name, name) == 0) return reads(target, k);
    return false;
}

/* Returns true if a number, or each of an array, is `usual`; NULL is. */
static bool is_usual(const json_t *value, double usual) {
    if (!value) return true;
    if (!json_is_array(value)) return fabs(json_number_value(value) - usual) < 1e-6;
    for (size_t k = 0; k < json_array_size(value); k++)
        if (!is_usual(json_array_get(value, k), usual)) return false;
    return true;
}

/* Returns true if an extension's object shows nothing: if its amount is 0 or, where it has none, all is as without it. */
static bool is_idle(const json_t *object, const char *name) {
    bool idle = true, first = true;
    for (const MaterialField *row = material_fields; row->factor; row++) {
        if (!row->object || strcmp(row->object, name) != 0) continue;
        const bool usual = is_usual(json_object_get(object, material_field_key(row)), (double)row->absent);
        if (first && row->absent < 0.5f) return usual;
        first = false;
        idle = idle && usual && !(row->texture && json_object_get(object, row->texture));
    }
    return idle && !first;
}

static const char specular_name[] = "KHR_materials_specular";

/* Multiplies the specular colour of KHR_materials_specular, which may exceed 1. */
static void specular_color_scale(json_t *specular, double scale) {
    json_t *color = json_array();
    const json_t *before = json_object_get(specular, "specularColorFactor");
    for (size_t c = 0; c < 3; c++) {
        const json_t *value = json_array_get(before, c);
        json_array_append_new(color, json_real(scale * (value ? json_number_value(value) : 1.0)));
    }
    json_object_set_new(specular, "specularColorFactor", color);
}

/* Writes an index of refraction as the specular colour that has the same F0. */
static WeftResult ior_to_color(Rewrite *rewrite, json_t *parts, const json_t *ior, WeftError *error) {
    const json_t *number = json_object_get(ior, "ior");
    const double n = number ? json_number_value(number) : 1.5;
    const double root = n >= 1.0 ? (n - 1.0) / (n + 1.0) : 1.0, scale = root * root / 0.04;
    if (fabs(scale - 1.0) < 1e-4) return WEFT_OK;
    specular_color_scale(factor_home(parts, specular_name), scale);
    return rewrite_uses(rewrite, specular_name, error);
}

void viewer_strength_fold(int target, json_t *material) {
    if ((STRENGTH_DIMS_METALS >> target & 1u) == 0) return;
    json_t *specular = json_object_get(json_object_get(material, "extensions"), specular_name);
    const json_t *strength = json_object_get(specular, "specularFactor");
    if (!strength) return;
    const double scale = json_number_value(strength);
    json_object_del(specular, "specularFactor");
    if (scale < 1.0) specular_color_scale(specular, scale);
}

WeftResult viewer_specular_put(Rewrite *rewrite, int target, json_t *material, WeftError *error) {
    json_t *parts = json_object_get(material, "extensions");
    if ((SHEEN_WANTS_SPECULAR >> target & 1u) == 0 || !json_object_get(parts, "KHR_materials_sheen")) return WEFT_OK;
    json_t *specular = factor_home(parts, specular_name);
    if (!json_object_get(specular, "specularColorFactor")) specular_color_scale(specular, 1.0);
    return rewrite_uses(rewrite, specular_name, error);
}

/* Deletes a member, and the object itself where that leaves it empty. */
static void member_drop(json_t *owner, const char *name, const char *member) {
    json_t *object = json_object_get(owner, name);
    if (json_object_del(object, member) == 0 && json_object_size(object) == 0) json_object_del(owner, name);
}

WeftResult viewer_limit(Rewrite *rewrite, int target, json_t *material, const ViewerLimit *limit, bool *changed,
                        WeftError *error) {
    member_drop(material, "extras", "weft");
    for (int k = 0; k < EXTENSIONS; k++) {
        json_t *parts = json_object_get(material, "extensions");
        const json_t *object = json_object_get(parts, extensions[k].name);
        if (!object || reads(target, k)) continue;
        if (extensions[k].effect == NO_MATERIAL)
            return fail(
                error, WEFT_MESSAGE_GLTF_EXTENSION, rewrite->asset->name,
                "%s, which %s does not read; make it metallic first: weft match ASSET --workflow metallic -o OUT",
                extensions[k].name, targets[target].name);
        WeftResult result = WEFT_OK;
        const bool kept =
            strcmp(extensions[k].name, "KHR_materials_ior") == 0 && reads_named(target, "KHR_materials_specular");
        if (kept) result = ior_to_color(rewrite, parts, object, error);
        if (result != WEFT_OK) return result;
        if (!kept && !is_idle(object, extensions[k].name)) {
            *changed |= extensions[k].effect == OTHER_LIGHT;
            if (!weft_losses_add(limit->losses, limit->material, limit->name, extensions[k].name, extensions[k].lost))
                return fail(error, WEFT_MESSAGE_MEMORY, rewrite->asset->name, NULL);
        }
        member_drop(material, "extensions", extensions[k].name);
    }
    return WEFT_OK;
}

void viewer_uses(Rewrite *rewrite, int target) {
    for (int k = 0; k < EXTENSIONS; k++)
        if (!reads(target, k)) rewrite_uses_no_more(rewrite, extensions[k].name);
}

char *viewer_extensions_text(const json_t *root) {
    const json_t *used = json_object_get(root, "extensionsUsed"), *name;
    size_t k, size = 1, length = 0;
    json_array_foreach(used, k, name) size += json_string_length(name) + 1;
    char *text = calloc(size, 1);
    json_array_foreach(used, k, name) {
        if (text) length += (size_t)snprintf(text + length, size - length, "%s\n", json_string_value(name));
    }
    return text;
}
