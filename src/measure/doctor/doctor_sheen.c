/* doctor_sheen.c - sheens together with metal, glass or a coat; and the extensions that the file declares */
#include <math.h>
#include <string.h>

#include "gltf/asset/material_fields.h"
#include "gltf/read/gltf.h"
#include "measure/doctor/doctor.h"

#define SHEEN_PLACE(cloth) ((Place){WEFT_OF_MATERIAL, (cloth)->index, "extensions/KHR_materials_sheen"})

static bool in_list(json_t *list, const char *name) {
    size_t k;
    json_t *value;
    json_array_foreach(list, k, value) {
        if (json_is_string(value) && strcmp(json_string_value(value), name) == 0) return true;
    }
    return false;
}

/* Reports an extension that extensionsUsed lacks, if it is not reported yet. */
static void declare(WeftDoctor *doctor, const char *name) {
    if (in_list(doctor_list(doctor, "extensionsUsed"), name)) return;
    for (int k = 0; k < doctor->count; k++)
        if (doctor->items[k].kind == WEFT_FINDING_EXTENSION_UNDECLARED &&
            strcmp(doctor->repairs[k].extension, name) == 0)
            return;
    Repair repair = {.act = REPAIR_DECLARE};
    if (strlen(name) >= sizeof repair.extension) return; /* no registered extension has so long a name */
    memcpy(repair.extension, name, strlen(name) + 1);
    doctor_found(
        doctor, WEFT_FINDING_EXTENSION_UNDECLARED, (Place){WEFT_OF_ASSET, 0, "extensionsUsed"}, 0, (double)NAN, &repair,
        "%s is used, but extensionsUsed does not name it: readers that look there drop it without a word", name);
    doctor_advise(doctor, "add %s to extensionsUsed", name);
}

/* Reports every undeclared extension below a value. The reader limits the depth of JSON. */
static void declare_below(WeftDoctor *doctor, json_t *value) {
    const char *key, *name;
    json_t *part, *extension;
    size_t k;
    json_array_foreach(value, k, part) { declare_below(doctor, part); }
    json_object_foreach(value, key, part) {
        if (strcmp(key, "extras") == 0) continue; /* extras belong to any application */
        if (strcmp(key, "extensions") == 0) json_object_foreach(part, name, extension) {
                declare(doctor, name);
            }
        declare_below(doctor, part);
    }
}

void check_extensions(WeftDoctor *doctor) {
    size_t k;
    json_t *value;
    json_array_foreach(doctor_list(doctor, "extensionsRequired"), k, value) {
        const char *name = json_string_value(value);
        if (!name || gltf_supports(name) || material_extension_lost(name)) continue;
        doctor_found(doctor, WEFT_FINDING_EXTENSION_REQUIRED, (Place){WEFT_OF_ASSET, 0, "extensionsRequired"}, 0,
                     (double)NAN, NULL,
                     "%.64s is required, which weft does not support: any shape or pixels that it adds were "
                     "not examined",
                     name);
        doctor_advise(doctor, "check that every engine you mean to use has it, or export without");
    }
    declare_below(doctor, doctor->asset.root);
}

void check_archived(WeftDoctor *doctor, const Cloth *cloth) {
    const MaterialField *row = doctor_row(cloth->json, INPUT_base_color);
    if (!material_field_replaces(row)) return;
    char path[FIELD_PATH];
    material_field_path(row, row->factor, path);
    *strrchr(path, '/') = '\0';
    const bool fallback = json_object_get(cloth->json, pbr_object) != NULL;
    doctor_found(
        doctor, WEFT_FINDING_EXTENSION_ARCHIVED, (Place){WEFT_OF_MATERIAL, cloth->index, path}, doctor_engine("three"),
        (double)NAN, NULL,
        "%s is archived by Khronos: weft reads it, but three.js and others no longer do, and show %s", row->object,
        fallback ? "what pbrMetallicRoughness has instead" : "a white metal, since pbrMetallicRoughness is missing");
    doctor_advise(doctor, "`weft render ASSET --save FILE.glb` writes it with KHR_materials_specular");
}

static bool lets_light_through(json_t *material) {
    double factor = 0.0;
    return doctor_numbers(material, "extensions/KHR_materials_transmission/transmissionFactor", &factor, 1) &&
           factor > 0.0;
}

void check_glass(WeftDoctor *doctor) {
    int glass = -1, cloth = -1;
    for (int m = (int)doctor->asset.material_count - 1; m >= 0; m--) {
        json_t *material = doctor_item(doctor, "materials", m);
        Cloth used = doctor_cloth(doctor, m);
        if (lets_light_through(material))
            glass = m;
        else if (cloth_shows(&used))
            cloth = m;
    }
    if (glass < 0 || cloth < 0) return;
    doctor_found(doctor, WEFT_FINDING_SHEEN_BEHIND_GLASS, (Place){WEFT_OF_ASSET, 0, NULL},
                 doctor_engine("filament-sheen"), (double)NAN, NULL,
                 "materials[%d] has a sheen and materials[%d] lets light through: in Filament what has a "
                 "sheen vanished "
                 "where it was seen through such a material",
                 cloth, glass);
    doctor_advise(doctor, "keep the cloth out of the view through the glass, or give it no sheen");
}

static void check_metal(WeftDoctor *doctor, const Cloth *cloth) {
    static const char path[] = "pbrMetallicRoughness/metallicFactor";
    if (!(cloth->metallic > 0.05f)) return;
    bool textured = doctor_part(cloth->json, "pbrMetallicRoughness/metallicRoughnessTexture") != NULL;
    bool given = doctor_part(cloth->json, path) != NULL;
    const Repair repair = {.act = REPAIR_NUMBER, .numbers = {0.0}, .count = 1};
    doctor_found(doctor, WEFT_FINDING_SHEEN_ON_METAL, (Place){WEFT_OF_MATERIAL, cloth->index, path}, 0,
                 (double)cloth->metallic, textured ? NULL : &repair,
                 "the sheen lies on a metal (metallic %.3g%s): the base has no diffuse colour, and mirrors instead",
                 (double)cloth->metallic,
                 given      ? ""
                 : textured ? ", in the mean of its texture"
                            : ", which is what it is when metallicFactor is left out");
    doctor_advise(doctor, textured ? "paint the blue channel of metallicRoughnessTexture black where there is cloth"
                                   : "write metallicFactor 0");
}

static void check_coat(WeftDoctor *doctor, const Cloth *cloth) {
    double coat = 0.0;
    if (!doctor_numbers(cloth->json, "extensions/KHR_materials_clearcoat/clearcoatFactor", &coat, 1) || !(coat > 0.0))
        return;
    doctor_found(doctor, WEFT_FINDING_SHEEN_COAT, SHEEN_PLACE(cloth), 0, coat, NULL,
                 "a clear coat lies over the sheen: glTF puts lacquer over fibres, OpenPBR and its kin "
                 "fibres over lacquer, "
                 "so that what is exported from one to the other changes");
    doctor_advise(doctor, "cloth has no lacquer: drop the coat, or for dusty lacquer the sheen");
}

static void check_ior(WeftDoctor *doctor, const Cloth *cloth) {
    if (!doctor_part(cloth->json, "extensions/KHR_materials_ior")) return;
    doctor_found(doctor, WEFT_FINDING_SHEEN_IOR, SHEEN_PLACE(cloth), doctor_engine("filament-sheen"), (double)NAN, NULL,
                 "Filament's ready-made materials had no sampler left for a sheen and an index of refraction "
                 "together: "
                 "one of them may be dropped there");
    doctor_advise(doctor, "drop KHR_materials_ior: 1.5 is what it is without, and near enough for cloth");
}

static void check_transmission(WeftDoctor *doctor, const Cloth *cloth) {
    if (!lets_light_through(cloth->json)) return;
    doctor_found(doctor, WEFT_FINDING_SHEEN_TRANSMISSION, SHEEN_PLACE(cloth), doctor_engine("filament-sheen"),
                 (double)NAN, NULL,
                 "one material has a sheen and lets light through: how the sheen takes from what comes "
                 "through is up to "
                 "each engine, and in Filament sheen and transmission did not work together");
    doctor_advise(doctor, "make thin cloth of alphaMode BLEND or MASK, without KHR_materials_transmission");
}

static void check_emission(WeftDoctor *doctor, const Cloth *cloth) {
    float glow[3];
    doctor_input(doctor, cloth->json, INPUT_emission, glow);
    float most = fmaxf(glow[0], fmaxf(glow[1], glow[2]));
    if (!(most > 1e-3f)) return;
    doctor_found(doctor, WEFT_FINDING_SHEEN_EMISSION, (Place){WEFT_OF_MATERIAL, cloth->index, "emissiveFactor"}, 0,
                 (double)most, NULL,
                 "the cloth sends out light of its own (%.2g): where that stands in for a rim, it is there "
                 "in the dark too",
                 (double)most);
    doctor_advise(doctor, "drop emissiveFactor where it was to imitate a sheen");
}

void check_neighbours(WeftDoctor *doctor, const Cloth *cloth) {
    static void (*const checks[])(WeftDoctor *, const Cloth *) = {check_metal, check_coat, check_ior,
                                                                  check_transmission, check_emission};
    if (!cloth_shows(cloth)) return;
    for (size_t k = 0; k < sizeof checks / sizeof *checks; k++) checks[k](doctor, cloth);
}
