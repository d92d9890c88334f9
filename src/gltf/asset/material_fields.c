/* Khronos Group, "glTF 2.0 Specification", 2021, section 3.9, and the schemas of the extensions in its registry.
 *
 * Of KHR_materials_fuzz, _coat, _diffuse_roughness and _retroreflection, which are not ratified, the texts of their
 * pull requests to KhronosGroup/glTF: 2538, 2534, 2481, 2610.
 *
 * ior, which is 0 or at least 1, has a rule of its own in the reader, the writer and the doctor, and so has
 * attenuationDistance, which is above 0, or infinite where it is absent: the input is 0 then.
 * KHR_texture_transform is part of any textureInfo. */
#include "gltf/asset/material_fields.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define KHR(name) "KHR_materials_" name

const char pbr_object[] = "pbrMetallicRoughness", gloss_object[] = KHR("pbrSpecularGlossiness"),
           coat_object[] = KHR("coat");

#define UNIT     0, 1
#define POSITIVE 0, INFINITY
#define ANY      -INFINITY, INFINITY

const MaterialField material_fields[] = {
    /* input, object, factor, texture, channels, absent, low and high */
    {INPUT_base_color, pbr_object, "baseColorFactor", "baseColorTexture", CHANNELS_COLOR_ALPHA, 1, UNIT},
    {INPUT_metallic, pbr_object, "metallicFactor", "metallicRoughnessTexture", CHANNEL_B, 1, UNIT},
    {INPUT_roughness, pbr_object, "roughnessFactor", "metallicRoughnessTexture", CHANNEL_G, 1, UNIT},
    {INPUT_normal, NULL, "normalTexture/scale", "normalTexture", CHANNELS_NORMAL, 1, ANY},
    {INPUT_occlusion, NULL, "occlusionTexture/strength", "occlusionTexture", CHANNEL_R, 1, UNIT},
    {INPUT_emission, NULL, "emissiveFactor", "emissiveTexture", CHANNELS_COLOR, 0, UNIT},
    {NO_INPUT, NULL, "alphaCutoff", NULL, CHANNEL_R, 0.5f, POSITIVE},
    {INPUT_emission_strength, KHR("emissive_strength"), "emissiveStrength", NULL, CHANNEL_R, 1, POSITIVE},
    {INPUT_specular, KHR("specular"), "specularFactor", "specularTexture", CHANNEL_A, 1, UNIT},
    {INPUT_specular_color, KHR("specular"), "specularColorFactor", "specularColorTexture", CHANNELS_COLOR, 1, POSITIVE},
    {INPUT_ior, KHR("ior"), "ior", NULL, CHANNEL_R, 1.5f, POSITIVE},
    {INPUT_anisotropy, KHR("anisotropy"), "anisotropyStrength", "anisotropyTexture", CHANNEL_B, 0, UNIT},
    {INPUT_anisotropy_direction, KHR("anisotropy"), "anisotropyRotation", "anisotropyTexture", CHANNELS_DIRECTION, 0,
     ANY},
    {INPUT_clearcoat, KHR("clearcoat"), "clearcoatFactor", "clearcoatTexture", CHANNEL_R, 0, UNIT},
    {INPUT_clearcoat_roughness, KHR("clearcoat"), "clearcoatRoughnessFactor", "clearcoatRoughnessTexture", CHANNEL_G, 0,
     UNIT},
    {INPUT_clearcoat_normal, KHR("clearcoat"), "clearcoatNormalTexture/scale", "clearcoatNormalTexture",
     CHANNELS_NORMAL, 1, ANY},
    {INPUT_diffuse_transmission, KHR("diffuse_transmission"), "diffuseTransmissionFactor", "diffuseTransmissionTexture",
     CHANNEL_A, 0, UNIT},
    {INPUT_diffuse_transmission_color, KHR("diffuse_transmission"), "diffuseTransmissionColorFactor",
     "diffuseTransmissionColorTexture", CHANNELS_COLOR, 1, UNIT},
    {INPUT_sheen_color, KHR("sheen"), "sheenColorFactor", "sheenColorTexture", CHANNELS_COLOR, 0, UNIT},
    {INPUT_sheen_roughness, KHR("sheen"), "sheenRoughnessFactor", "sheenRoughnessTexture", CHANNEL_A, 0, UNIT},
    {INPUT_fuzz, KHR("fuzz"), "fuzzFactor", "fuzzTexture", CHANNEL_R, 0, UNIT},
    {INPUT_fuzz_color, KHR("fuzz"), "fuzzColorFactor", "fuzzColorTexture", CHANNELS_COLOR, 1, UNIT},
    {INPUT_fuzz_roughness, KHR("fuzz"), "fuzzRoughnessFactor", "fuzzRoughnessTexture", CHANNEL_A, 0.5f, UNIT},
    {INPUT_diffuse_roughness, KHR("diffuse_roughness"), "diffuseRoughnessFactor", "diffuseRoughnessTexture", CHANNEL_R,
     0, UNIT},
    {INPUT_retroreflection, KHR("retroreflection"), "retroreflectionFactor", "retroreflectionTexture", CHANNEL_R, 0,
     UNIT},
    {INPUT_clearcoat, coat_object, "coatFactor", "coatTexture", CHANNEL_R, 0, UNIT},
    {INPUT_clearcoat_roughness, coat_object, "coatRoughnessFactor", "coatRoughnessTexture", CHANNEL_G, 0, UNIT},
    {INPUT_clearcoat_normal, coat_object, "coatNormalTexture/scale", "coatNormalTexture", CHANNELS_NORMAL, 1, ANY},
    {INPUT_coat_ior, coat_object, "coatIor", NULL, CHANNEL_R, 1.5f, 1, INFINITY},
    {INPUT_coat_color, coat_object, "coatColorFactor", "coatColorTexture", CHANNELS_COLOR, 1, UNIT},
    {INPUT_coat_darkening, coat_object, "coatDarkeningFactor", NULL, CHANNEL_R, 1, UNIT},
    {INPUT_coat_anisotropy, coat_object, "coatAnisotropyStrength", "coatAnisotropyTexture", CHANNEL_B, 0, UNIT},
    {INPUT_coat_anisotropy_direction, coat_object, "coatAnisotropyRotation", "coatAnisotropyTexture",
     CHANNELS_DIRECTION, 0, ANY},
    {INPUT_transmission, KHR("transmission"), "transmissionFactor", "transmissionTexture", CHANNEL_R, 0, UNIT},
    {INPUT_thickness, KHR("volume"), "thicknessFactor", "thicknessTexture", CHANNEL_G, 0, POSITIVE},
    {INPUT_attenuation_distance, KHR("volume"), "attenuationDistance", NULL, CHANNEL_R, 0, POSITIVE},
    {INPUT_attenuation_color, KHR("volume"), "attenuationColor", NULL, CHANNELS_COLOR, 1, UNIT},
    {NO_INPUT, KHR("iridescence"), "iridescenceFactor", "iridescenceTexture", CHANNEL_R, 0, UNIT},
    {NO_INPUT, KHR("dispersion"), "dispersion", NULL, CHANNEL_R, 0, POSITIVE},
    {INPUT_base_color, gloss_object, "diffuseFactor", "diffuseTexture", CHANNELS_COLOR_ALPHA, 1, UNIT},
    {INPUT_specular_color, gloss_object, "specularFactor", "specularGlossinessTexture", CHANNELS_COLOR, 1, UNIT},
    {INPUT_roughness, gloss_object, "glossinessFactor", "specularGlossinessTexture", CHANNEL_A_GLOSS, 1, UNIT},
    {.factor = NULL},
};

const MaterialField *material_field_of(InputId input) {
    const MaterialField *field = material_fields;
    while (field->factor && field->input != (int)input) field++;
    return field;
}

const char *material_extension_lost(const char *extension) {
    static const char *const losses[][2] = {
        {KHR("iridescence"), "the colours of its thin films are left out"},
        {KHR("dispersion"), "its glass bends all colours alike"},
    };
    for (size_t k = 0; k < sizeof losses / sizeof *losses; k++)
        if (strcmp(losses[k][0], extension) == 0) return losses[k][1];
    return NULL;
}

int material_field_numbers(const MaterialField *field) {
    return field->channels == CHANNELS_COLOR ? 3 : field->channels == CHANNELS_COLOR_ALPHA ? 4 : 1;
}

bool material_field_extends(const MaterialField *field) {
    return field->object && strcmp(field->object, pbr_object) != 0;
}

bool material_field_replaces(const MaterialField *field) {
    return field->object == gloss_object || field->object == coat_object;
}

static bool same_text(const char *a, const char *b) { return a && b && strcmp(a, b) == 0; }

bool material_fields_share(const MaterialField *a, const MaterialField *b) { return same_text(a->object, b->object); }

bool material_field_repeats(const MaterialField *field) {
    return field > material_fields && same_text(field->texture, field[-1].texture);
}

bool material_field_inside(const MaterialField *field) { return strchr(field->factor, '/') != NULL; }

const char *material_field_key(const MaterialField *field) {
    const char *slash = strchr(field->factor, '/');
    return slash ? slash + 1 : field->factor;
}

void material_field_path(const MaterialField *field, const char *key, char path[FIELD_PATH]) {
    snprintf(path, FIELD_PATH, "%s%s%s%s", material_field_extends(field) ? "extensions/" : "",
             field->object ? field->object : "", field->object ? "/" : "", key);
}
