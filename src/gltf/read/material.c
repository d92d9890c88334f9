/* Specification: Khronos Group, "glTF 2.0 Specification", 2021, section 3.9 (materials), and the texts of
 * KHR_materials_anisotropy, _clearcoat, _diffuse_transmission, _emissive_strength, _ior, _sheen, _specular, _unlit and
 * KHR_texture_transform in its extension registry. */
#include "base/pi.h"
#include "gltf/read/gltf_material.h"

#include <float.h>
#include <math.h>
#include <string.h>

#include "gltf/asset/field.h"
#include "scene/material/cloth_file.h"
#include "scene/material/material_numbers.h"
#include "scene/material/set.h"
#include "weave/weft_cloth.h"

/* Reads KHR_texture_transform: T R S. The asset TextureTransformTest shows the sense of the rotation: v grows
 * downwards, so that counter-clockwise is (c u + s v, c v - s u). */
static void transform_read(const Field *field, Input *input) {
    Field offset_field = field_member(field, "offset"), scale_field = field_member(field, "scale"),
          rotation = field_member(field, "rotation"), texcoord = field_member(field, "texCoord");
    float offset[2] = {0.0f, 0.0f}, scale[2] = {1.0f, 1.0f};
    field_floats(&offset_field, offset, 2, -1e6f, 1e6f);
    field_floats(&scale_field, scale, 2, -1e6f, 1e6f);
    float angle = (float)field_number(&rotation, 0.0, -1e3, 1e3);
    float c = cosf(angle), s = sinf(angle);
    const float m[6] = {c * scale[0], s * scale[1], offset[0], -s * scale[0], c * scale[1], offset[1]};
    memcpy(input->transform, m, sizeof m);
    input->texcoord = (int)field_size(&texcoord, (size_t)input->texcoord, 0, UINT8_MAX);
}

/* Reads a textureInfo, if there is one; channel matters to scalars only. */
static void texture_read(const Field *field, Input *input, uint8_t channel) {
    if (!field->json) return;
    Field index = field_member(field, "index"), texcoord = field_member(field, "texCoord");
    Field transform = field_extension(field, "KHR_texture_transform");
    input->texture = field_needed_index(&index, field->asset->texture_count) + 1;
    input->channel = channel;
    input->texcoord = (int)field_size(&texcoord, 0, 0, UINT8_MAX);
    if (transform.json) transform_read(&transform, input);
    if (input->texcoord > 1) {
        field_warn(field, WEFT_MESSAGE_GLTF_WARN_IGNORED, "TEXCOORD_%d, only 0 and 1 are read",
                   input->texcoord);
        input->texture = 0;
        input->texcoord = 0;
    }
}

enum { R, G, B, A };

/* Reads object[factor], which is multiplied by a channel of object[texture]. */
static void scalar_read(const Field *object, Input *input, const char *factor, float absent, float high,
                        const char *texture, uint8_t channel) {
    Field factor_field = field_member(object, factor);
    input->value[0] = (float)field_number(&factor_field, (double)absent, 0.0, (double)high);
    if (!texture) return;
    Field texture_field = field_member(object, texture);
    texture_read(&texture_field, input, channel);
}

static void color_read(const Field *object, Input *input, const char *factor, float absent, float high,
                       const char *texture) {
    Field factor_field = field_member(object, factor), texture_field = field_member(object, texture);
    for (int c = 0; c < 3; c++) input->value[c] = absent;
    field_floats(&factor_field, input->value, 3, 0.0f, high);
    texture_read(&texture_field, input, 0);
}

/* Reads a normal texture, whose textureInfo contains its scale. */
static void normal_read(const Field *object, Input *input, const char *texture) {
    Field field = field_member(object, texture), scale = field_member(&field, "scale");
    input->value[0] = (float)field_number(&scale, 1.0, -1e3, 1e3);
    texture_read(&field, input, 0);
}

static void metallic_roughness_read(const Field *material, Input *inputs) {
    Field pbr = field_member(material, "pbrMetallicRoughness");
    Field factor = field_member(&pbr, "baseColorFactor"), texture = field_member(&pbr, "baseColorTexture");
    float rgba[4] = {1.0f, 1.0f, 1.0f, 1.0f};
    field_floats(&factor, rgba, 4, 0.0f, 1.0f);
    memcpy(inputs[INPUT_base_color].value, rgba, 3 * sizeof *rgba);
    inputs[INPUT_opacity].value[0] = rgba[3];
    texture_read(&texture, &inputs[INPUT_base_color], 0);
    inputs[INPUT_opacity].texture = inputs[INPUT_base_color].texture;
    inputs[INPUT_opacity].texcoord = inputs[INPUT_base_color].texcoord;
    inputs[INPUT_opacity].channel = A;
    memcpy(inputs[INPUT_opacity].transform, inputs[INPUT_base_color].transform,
           sizeof inputs[INPUT_opacity].transform);
    scalar_read(&pbr, &inputs[INPUT_metallic], "metallicFactor", 1.0f, 1.0f, "metallicRoughnessTexture", B);
    scalar_read(&pbr, &inputs[INPUT_roughness], "roughnessFactor", 1.0f, 1.0f, "metallicRoughnessTexture", G);
}

static void emission_read(const Field *material, Input *inputs) {
    Field extension = field_extension(material, "KHR_materials_emissive_strength");
    color_read(material, &inputs[INPUT_emission], "emissiveFactor", 0.0f, 1.0f, "emissiveTexture");
    scalar_read(&extension, &inputs[INPUT_emission_strength], "emissiveStrength", 1.0f, FLT_MAX, NULL, 0);
}

static void specular_read(const Field *material, Input *inputs) {
    Field ior_field = field_extension(material, "KHR_materials_ior");
    Field specular = field_extension(material, "KHR_materials_specular");
    scalar_read(&ior_field, &inputs[INPUT_ior], "ior", 1.5f, FLT_MAX, NULL, 0);
    float *ior = &inputs[INPUT_ior].value[0];
    if (*ior == 0.0f) {
        *ior = 1e6f; /* the extension's value for a base that reflects everything */
    } else if (*ior < 1.0f) {
        field_warn(&ior_field, WEFT_MESSAGE_GLTF_WARN_REPAIRED, "ior %g is taken as 1", (double)*ior);
        *ior = 1.0f;
    }
    scalar_read(&specular, &inputs[INPUT_specular], "specularFactor", 1.0f, 1.0f, "specularTexture", A);
    color_read(&specular, &inputs[INPUT_specular_color], "specularColorFactor", 1.0f, FLT_MAX,
               "specularColorTexture");
}

static void anisotropy_read(const Field *material, Input *inputs) {
    Field extension = field_extension(material, "KHR_materials_anisotropy");
    Field rotation = field_member(&extension, "anisotropyRotation"),
          texture = field_member(&extension, "anisotropyTexture");
    scalar_read(&extension, &inputs[INPUT_anisotropy], "anisotropyStrength", 0.0f, 1.0f, "anisotropyTexture",
                B);
    inputs[INPUT_anisotropy_direction].value[0] = (float)field_number(&rotation, 0.0, -1e3, 1e3);
    texture_read(&texture, &inputs[INPUT_anisotropy_direction], 0);
}

static void clearcoat_read(const Field *material, Input *inputs) {
    Field extension = field_extension(material, "KHR_materials_clearcoat");
    scalar_read(&extension, &inputs[INPUT_clearcoat], "clearcoatFactor", 0.0f, 1.0f, "clearcoatTexture", R);
    scalar_read(&extension, &inputs[INPUT_clearcoat_roughness], "clearcoatRoughnessFactor", 0.0f, 1.0f,
                "clearcoatRoughnessTexture", G);
    normal_read(&extension, &inputs[INPUT_clearcoat_normal], "clearcoatNormalTexture");
}

static void diffuse_transmission_read(const Field *material, Input *inputs) {
    Field extension = field_extension(material, "KHR_materials_diffuse_transmission");
    scalar_read(&extension, &inputs[INPUT_diffuse_transmission], "diffuseTransmissionFactor", 0.0f, 1.0f,
                "diffuseTransmissionTexture", A);
    color_read(&extension, &inputs[INPUT_diffuse_transmission_color], "diffuseTransmissionColorFactor", 1.0f,
               1.0f, "diffuseTransmissionColorTexture");
}

static void sheen_read(const Field *material, Input *inputs) {
    Field extension = field_extension(material, "KHR_materials_sheen");
    color_read(&extension, &inputs[INPUT_sheen_color], "sheenColorFactor", 0.0f, 1.0f, "sheenColorTexture");
    scalar_read(&extension, &inputs[INPUT_sheen_roughness], "sheenRoughnessFactor", 0.0f, 1.0f,
                "sheenRoughnessTexture", A);
}

/* Reads an input of extras.weft: a number, or three for a colour; an angle is in radians. */
static void own_read(const Field *weft, Input *inputs, const char *key, InputId id) {
    const WeftInputInfo *info = &input_infos[id];
    bool angle = info->kind == WEFT_INPUT_ANGLE || info->kind == WEFT_INPUT_DIRECTION;
    float unit = angle ? (float)RADIANS : 1.0f;
    Field field = field_member(weft, key);
    float low = info->hard_low * unit, high = info->hard_high * unit;
    if (info->kind == WEFT_INPUT_COLOR)
        field_floats(&field, inputs[id].value, 3, low, high);
    else
        inputs[id].value[0] = (float)field_number(&field, (double)info->initial, (double)low, (double)high);
}

static const struct {
    const char *key;
    InputId id;
} own[] = {{"sheenDensity", INPUT_sheen_density},   {"dust", INPUT_dust},
           {"dustColor", INPUT_dust_color},         {"dustRoughness", INPUT_dust_roughness},
           {"dustFalloff", INPUT_dust_falloff},     {"dustTilt", INPUT_dust_tilt},
           {"dustDirection", INPUT_dust_direction}, {"dustNoise", INPUT_dust_noise},
           {"dustScale", INPUT_dust_scale}};
enum { OWN = sizeof own / sizeof own[0] };

/* Reads a member of extras.weft.inputs, which describes a whole input: what it lacks has its default. */
static void whole_input_read(const Field *field, InputId id, Input *input) {
    const float most = FLT_MAX;
    Field value = field_member(field, "value"), texture = field_member(field, "texture"),
          texcoord = field_member(field, "texCoord"), channel = field_member(field, "channel"),
          transform = field_member(field, "transform"), given = field_member(field, "given");
    const int count = input_value_count(id);
    *input = material_default().inputs[id];
    field_floats(&value, input->value, (size_t)count, -most, most);
    for (int c = 0; c < count; c++) input->value[c] = input_clamped(id, input->value[c]);
    field_floats(&transform, input->transform, 6, -most, most);
    input->texture = field_index(&texture, field->asset->texture_count) + 1;
    input->texcoord = (int)field_size(&texcoord, 0, 0, 1);
    input->channel = (uint8_t)field_size(&channel, 0, 0, 3);
    input->given = field_bool(&given, false);
}

/* Reads a choice by its id. An unknown id, as of a later version, is left to the workflow with a warning. */
static void choice_read(const Field *field, ChoiceId choice, Material *material) {
    WeftError error;
    if (!field->json) return;
    if (choice_value(choice, field_text(field, "auto"), &material->choices[choice], &error) == WEFT_OK)
        return;
    material->choices[choice] = CHOICE_AUTO;
    field_warn(field, WEFT_MESSAGE_GLTF_WARN_IGNORED, "\"%.40s\" means nothing", field_text(field, ""));
}

/* Reads the extras that weft_scene_save adds so that a material comes back as it was. */
static void saved_read(const Field *weft, Material *material) {
    Field choices = field_member(weft, "choices"), list = field_member(weft, "inputs"),
          cutoff = field_member(weft, "alphaCutoff");
    for (int k = 0; k < CHOICE_COUNT; k++) {
        Field field = field_member(&choices, weft_material_choice_name(k));
        choice_read(&field, (ChoiceId)k, material);
    }
    for (int k = 0; k < INPUT_COUNT; k++) {
        Field field = field_member(&list, input_infos[k].name);
        if (field.json) whole_input_read(&field, (InputId)k, &material->inputs[k]);
    }
    material->alpha_cutoff =
        (float)field_number(&cutoff, (double)material->alpha_cutoff, 0.0, (double)FLT_MAX);
}

enum { WEAVES_MOST = 256 }; /* of a scene: each takes its time to be woven */

/* Reads a weave as in a material file, but with its draft inside. A weave that makes no sense is left out
 * with a warning. */
static void weave_read(const Field *weft, Material *material) {
    Field field = field_member(weft, "weave");
    WeftScene *scene = field.asset->scene;
    WeftCloth *cloth = NULL;
    WeftError error = {0};
    if (!field.json || field.asset->result != WEFT_OK) return;
    if (scene->cloth_count == WEAVES_MOST) {
        field_warn(&field, WEFT_MESSAGE_GLTF_WARN_IGNORED, "there are more than %d", WEAVES_MOST);
        return;
    }
    WeftResult result =
        cloth_from_json(field.json, field.asset->name, NULL, &cloth, field.asset->log, &error);
    if (result != WEFT_OK && result != WEFT_RESOURCES)
        field_warn(&field, WEFT_MESSAGE_GLTF_WARN_IGNORED, "%s", error.text);
    const bool paid =
        cloth &&
        asset_charge(field.asset, (size_t)cloth->weave.warps * (size_t)cloth->weave.picks, 4 * sizeof(float));
    material->cloth = paid ? scene_adopt_cloth(scene, cloth) : 0;
    if (result == WEFT_RESOURCES || (paid && !material->cloth))
        asset_fail(field.asset, WEFT_MESSAGE_MEMORY, NULL);
    if (!material->cloth) weft_cloth_free(cloth);
}

/* Reads extras.weft: what no extension of glTF can express. Other extras belong to other programs. */
static void extras_read(const Field *field, Material *material) {
    static const char *const keys[] = {"nap",     "napRotation", "napTexture",  "dustTexture",
                                       "choices", "inputs",      "alphaCutoff", "weave"};
    Input *inputs = material->inputs;
    Field extras = field_member(field, "extras");
    if (!json_is_object(extras.json)) return;
    Field weft = field_member(&extras, "weft"), rotation = field_member(&weft, "napRotation"),
          texture = field_member(&weft, "napTexture");
    Field dust = field_member(&weft, "dustTexture");
    for (size_t k = 0; k < OWN; k++) own_read(&weft, inputs, own[k].key, own[k].id);
    texture_read(&dust, &inputs[INPUT_dust], R);
    scalar_read(&weft, &inputs[INPUT_nap], "nap", 0.0f, 0.5f * PI_FLOAT, "napTexture", B);
    inputs[INPUT_nap_direction].value[0] = (float)field_number(&rotation, 0.0, -1e3, 1e3);
    texture_read(&texture, &inputs[INPUT_nap_direction], 0);
    saved_read(&weft, material);
    weave_read(&weft, material);
    const char *key;
    json_t *value;
    json_object_foreach(weft.json, key, value) {
        bool known = false;
        for (size_t k = 0; k < sizeof keys / sizeof *keys; k++) known |= strcmp(key, keys[k]) == 0;
        for (size_t k = 0; k < OWN; k++) known |= strcmp(key, own[k].key) == 0;
        if (!known) field_warn(&weft, WEFT_MESSAGE_GLTF_WARN_IGNORED, "\"%.40s\" means nothing", key);
    }
}

static WeftAlphaMode alpha_mode_read(const Field *field) {
    static const char *const names[] = {"OPAQUE", "MASK", "BLEND"};
    const char *text = field_text(field, "OPAQUE");
    for (int i = 0; i < 3; i++)
        if (strcmp(text, names[i]) == 0) return (WeftAlphaMode)i;
    field_fail(field, WEFT_MESSAGE_GLTF_SCHEMA, "expected OPAQUE, MASK or BLEND");
    return WEFT_ALPHA_OPAQUE;
}

/* Reads an object of "materials"; an absent field gives the default material. */
static Material material_read(const Field *field) {
    Field alpha = field_member(field, "alphaMode"), cutoff = field_member(field, "alphaCutoff"),
          sided = field_member(field, "doubleSided");
    Material material = material_default();
    Input *inputs = material.inputs;
    material.alpha_mode = alpha_mode_read(&alpha);
    material.alpha_cutoff = (float)field_number(&cutoff, 0.5, 0.0, (double)FLT_MAX);
    material.double_sided = field_bool(&sided, false);
    material.unlit = field_extension(field, "KHR_materials_unlit").json != NULL;
    metallic_roughness_read(field, inputs);
    normal_read(field, &inputs[INPUT_normal], "normalTexture");
    Field occlusion = field_member(field, "occlusionTexture");
    scalar_read(&occlusion, &inputs[INPUT_occlusion], "strength", 1.0f, 1.0f, NULL, 0);
    texture_read(&occlusion, &inputs[INPUT_occlusion], R);
    emission_read(field, inputs);
    specular_read(field, inputs);
    anisotropy_read(field, inputs);
    clearcoat_read(field, inputs);
    diffuse_transmission_read(field, inputs);
    sheen_read(field, inputs);
    extras_read(field, &material);
    return material;
}

void materials_read(Asset *asset) {
    WeftScene *scene = asset->scene;
    Field root = field_root(asset), list = field_member(&root, "materials");
    asset->material_count = field_count(&list);
    scene->materials = asset_array(asset, &scene->arena, asset->material_count + 1, sizeof(Material));
    scene->material_names = asset_array(asset, &scene->arena, asset->material_count + 1, sizeof(char *));
    asset->material_shown = asset_array(asset, &asset->arena, asset->material_count + 1, sizeof(bool));
    for (size_t i = 0; i <= asset->material_count && asset->result == WEFT_OK; i++) {
        Field field = field_element(&list, i);
        if (i < asset->material_count && !json_is_object(field.json))
            field_fail(&field, WEFT_MESSAGE_GLTF_SCHEMA, "expected an object");
        Field name = field_member(&field, "name");
        scene->materials[i] = material_read(&field);
        scene->material_names[i] = asset_text(asset, field_text(&name, ""));
    }
    scene->material_count = (int)asset->material_count;
}
