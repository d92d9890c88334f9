/* material_save.c - materials as other programs read them, and in extras.weft what glTF cannot express
 *
 * What is written for others is read back at once, as a reader of this library would. Where that gives
 * another input, the whole input is written. So a material comes back unchanged, whatever a workflow or a
 * profile makes of its inputs and however well glTF expresses it. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/equal.h"
#include "gltf/read/gltf_material.h"
#include "gltf/save/saving.h"
#include "scene/material/cloth_file.h"
#include "scene/material/material_numbers.h"
#include "scene/record/material_at.h"
#include "shading/material/choice.h"
#include "shading/stack/workflow.h"

enum { R, G, B, A };

static float unit(float x) { return fminf(fmaxf(x, 0.0f), 1.0f); }

static float value(const Material *material, InputId id) { return material->inputs[id].value[0]; }

static bool is_black(const Material *material, InputId id) {
    const float *v = material->inputs[id].value;
    return !(v[0] > 0.0f || v[1] > 0.0f || v[2] > 0.0f);
}

/* Saves KHR_texture_transform of a matrix of scale, rotation and shift; others are approximated. */
static void transform_put(Saving *saving, json_t *info, const float m[6]) {
    static const float identity[6] = {1.0f, 0.0f, 0.0f, 0.0f, 1.0f, 0.0f};
    bool same = true;
    for (int k = 0; k < 6; k++) same &= is_equal(m[k], identity[k]);
    if (same) return;
    json_t *object = json_object();
    float angle = m[3] < 0.0f || m[3] > 0.0f ? atan2f(-m[3], m[0]) : 0.0f, c = cosf(angle), s = sinf(angle);
    const float offset[2] = {m[2], m[5]}, scale[2] = {c * m[0] - s * m[3], s * m[1] + c * m[4]};
    saving_put(saving, object, "offset", saving_floats(offset, 2));
    if (angle < 0.0f || angle > 0.0f) saving_put(saving, object, "rotation", json_real((double)angle));
    saving_put(saving, object, "scale", saving_floats(scale, 2));
    saving_extend(saving, info, "KHR_texture_transform", object);
}

/* Makes a textureInfo; NULL if there is no texture, or one of floats, which other programs do not read. */
static json_t *texture_info(Saving *saving, const Input *input) {
    if (!input->texture) return NULL;
    const WeftScene *scene = saving->scene;
    int texture = input->texture - 1;
    if (scene->images[scene->textures[texture].image].type == WEFT_PIXEL_F32) return NULL;
    json_t *info = json_object();
    saving_put(saving, info, "index", json_integer(saving->texture_number[texture]));
    if (input->texcoord) saving_put(saving, info, "texCoord", json_integer(input->texcoord));
    transform_put(saving, info, input->transform);
    return info;
}

/* Sets object[key] to the textureInfo, if there is one and it is read by that channel. */
static void texture_put(Saving *saving, json_t *object, const char *key, const Input *input, int channel) {
    json_t *info = channel < 0 || input->channel == channel ? texture_info(saving, input) : NULL;
    if (info) saving_put(saving, object, key, info);
}

static void number_put(Saving *saving, json_t *object, const char *key, float x) {
    saving_put(saving, object, key, json_real((double)x));
}

static void color_put(Saving *saving, json_t *object, const char *key, const float v[3], float factor,
                      float most) {
    float color[3];
    for (int c = 0; c < 3; c++) color[c] = fminf(v[c] * factor, most);
    saving_put(saving, object, key, saving_floats(color, 3));
}

static void base_save(Saving *saving, json_t *object, const Material *material) {
    const Input *inputs = material->inputs;
    json_t *pbr = json_object();
    float rgba[4];
    for (int c = 0; c < 3; c++) rgba[c] = unit(inputs[INPUT_base_color].value[c]);
    rgba[3] = unit(value(material, INPUT_opacity));
    bool bare = material_choices(material).workflow > WORKFLOW_METALLIC; /* of metalness, or almost */
    saving_put(saving, pbr, "baseColorFactor", saving_floats(rgba, 4));
    texture_put(saving, pbr, "baseColorTexture", &inputs[INPUT_base_color], -1);
    number_put(saving, pbr, "metallicFactor", bare ? 0.0f : unit(value(material, INPUT_metallic)));
    number_put(saving, pbr, "roughnessFactor", unit(value(material, INPUT_roughness)));
    const Input *map = &inputs[inputs[INPUT_roughness].texture ? INPUT_roughness : INPUT_metallic];
    texture_put(saving, pbr, "metallicRoughnessTexture", map, map == &inputs[INPUT_metallic] ? B : G);
    saving_put(saving, object, "pbrMetallicRoughness", pbr);
}

/* Saves a normal map with its strength, or occlusion with its own. */
static void scaled_save(Saving *saving, json_t *object, const char *key, const char *factor,
                        const Material *material, InputId id) {
    const Input *input = &material->inputs[id];
    json_t *info = input->channel == R ? texture_info(saving, input) : NULL;
    if (!info) return;
    number_put(saving, info, factor, id == INPUT_occlusion ? unit(input->value[0]) : input->value[0]);
    saving_put(saving, object, key, info);
}

static void emission_save(Saving *saving, json_t *object, const Material *material) {
    const Input *emission = &material->inputs[INPUT_emission];
    float most = fmaxf(emission->value[0], fmaxf(emission->value[1], emission->value[2]));
    float strength = value(material, INPUT_emission_strength), above = most > 1.0f ? most : 1.0f;
    if (!(most > 0.0f)) return;
    color_put(saving, object, "emissiveFactor", emission->value, 1.0f / above, 1.0f);
    texture_put(saving, object, "emissiveTexture", emission, -1);
    if (!(strength * above < 1.0f || strength * above > 1.0f)) return;
    json_t *extension = json_object();
    number_put(saving, extension, "emissiveStrength", strength * above);
    saving_extend(saving, object, "KHR_materials_emissive_strength", extension);
}

/* Saves the dielectric: its index, and the strength and tint of its reflection. If the workflow has F0 as a
 * colour, the tint is that colour over the F0 of index 1.5. */
static void specular_save(Saving *saving, json_t *object, const Material *material) {
    const Input *inputs = material->inputs;
    const Surface plain = {.ior = value(material, INPUT_ior),
                           .reflectance = value(material, INPUT_reflectance)};
    bool own = material_choices(material).workflow == WORKFLOW_SPECULAR;
    float root = sqrtf(unit(dielectric_f0(&plain))), ior = (1.0f + root) / fmaxf(1.0f - root, 1e-3f);
    json_t *extension = json_object(), *index = json_object();
    number_put(saving, extension, "specularFactor", unit(value(material, INPUT_specular)));
    texture_put(saving, extension, "specularTexture", &inputs[INPUT_specular], A);
    color_put(saving, extension, "specularColorFactor", inputs[INPUT_specular_color].value,
              own ? 25.0f : 1.0f, 1000.0f);
    texture_put(saving, extension, "specularColorTexture", &inputs[INPUT_specular_color], -1);
    saving_extend(saving, object, "KHR_materials_specular", extension);
    number_put(saving, index, "ior", own ? 1.5f : plain.ior >= 1.0f ? plain.ior : ior);
    saving_extend(saving, object, "KHR_materials_ior", index);
}

static void anisotropy_save(Saving *saving, json_t *object, const Material *material) {
    const Input *inputs = material->inputs;
    json_t *extension = json_object();
    number_put(saving, extension, "anisotropyStrength", unit(value(material, INPUT_anisotropy)));
    number_put(saving, extension, "anisotropyRotation", value(material, INPUT_anisotropy_direction));
    texture_put(saving, extension, "anisotropyTexture", &inputs[INPUT_anisotropy_direction], -1);
    saving_extend(saving, object, "KHR_materials_anisotropy", extension);
}

static void clearcoat_save(Saving *saving, json_t *object, const Material *material) {
    const Input *inputs = material->inputs;
    json_t *extension = json_object();
    number_put(saving, extension, "clearcoatFactor", unit(value(material, INPUT_clearcoat)));
    texture_put(saving, extension, "clearcoatTexture", &inputs[INPUT_clearcoat], R);
    number_put(saving, extension, "clearcoatRoughnessFactor",
               unit(value(material, INPUT_clearcoat_roughness)));
    texture_put(saving, extension, "clearcoatRoughnessTexture", &inputs[INPUT_clearcoat_roughness], G);
    scaled_save(saving, extension, "clearcoatNormalTexture", "scale", material, INPUT_clearcoat_normal);
    saving_extend(saving, object, "KHR_materials_clearcoat", extension);
}

static void diffuse_transmission_save(Saving *saving, json_t *object, const Material *material) {
    const Input *inputs = material->inputs;
    json_t *extension = json_object();
    number_put(saving, extension, "diffuseTransmissionFactor",
               unit(value(material, INPUT_diffuse_transmission)));
    texture_put(saving, extension, "diffuseTransmissionTexture", &inputs[INPUT_diffuse_transmission], A);
    color_put(saving, extension, "diffuseTransmissionColorFactor",
              inputs[INPUT_diffuse_transmission_color].value, 1.0f, 1.0f);
    texture_put(saving, extension, "diffuseTransmissionColorTexture",
                &inputs[INPUT_diffuse_transmission_color], -1);
    saving_extend(saving, object, "KHR_materials_diffuse_transmission", extension);
}

static void sheen_save(Saving *saving, json_t *object, const Material *material) {
    const Input *inputs = material->inputs;
    json_t *extension = json_object();
    color_put(saving, extension, "sheenColorFactor", inputs[INPUT_sheen_color].value,
              value(material, INPUT_sheen), 1.0f);
    texture_put(saving, extension, "sheenColorTexture", &inputs[INPUT_sheen_color], -1);
    number_put(saving, extension, "sheenRoughnessFactor", unit(value(material, INPUT_sheen_roughness)));
    texture_put(saving, extension, "sheenRoughnessTexture", &inputs[INPUT_sheen_roughness], A);
    saving_extend(saving, object, "KHR_materials_sheen", extension);
}

static json_t *material_save(Saving *saving, const char *name, const Material *material) {
    static const char *const modes[] = {"OPAQUE", "MASK", "BLEND"}; /* as WeftAlphaMode */
    json_t *object = json_object();
    saving_name(saving, object, name);
    base_save(saving, object, material);
    scaled_save(saving, object, "normalTexture", "scale", material, INPUT_normal);
    scaled_save(saving, object, "occlusionTexture", "strength", material, INPUT_occlusion);
    emission_save(saving, object, material);
    if (material->alpha_mode != WEFT_ALPHA_OPAQUE)
        saving_put(saving, object, "alphaMode", json_string(modes[material->alpha_mode]));
    if (material->alpha_mode == WEFT_ALPHA_MASK)
        number_put(saving, object, "alphaCutoff", fmaxf(material->alpha_cutoff, 0.0f));
    if (material->double_sided) saving_put(saving, object, "doubleSided", json_true());
    if (material->unlit) saving_extend(saving, object, "KHR_materials_unlit", json_object());
    if (material->unlit) return object;
    specular_save(saving, object, material);
    if (value(material, INPUT_anisotropy) > 0.0f) anisotropy_save(saving, object, material);
    if (value(material, INPUT_clearcoat) > 0.0f) clearcoat_save(saving, object, material);
    if (value(material, INPUT_diffuse_transmission) > 0.0f)
        diffuse_transmission_save(saving, object, material);
    if (!is_black(material, INPUT_sheen_color)) sheen_save(saving, object, material);
    return object;
}

/* Returns the input with its texture numbered as in the file. */
static Input numbered(const Saving *saving, const Input *input) {
    Input out = *input;
    if (input->texture) out.texture = saving->texture_number[input->texture - 1] + 1;
    return out;
}

static bool is_same(const Input *a, const Input *b, int count) {
    return memcmp((const char *)a->value, (const char *)b->value, (size_t)count * sizeof *a->value) == 0 &&
           a->texture == b->texture && a->texcoord == b->texcoord && a->channel == b->channel &&
           a->given == b->given &&
           memcmp((const char *)a->transform, (const char *)b->transform, sizeof a->transform) == 0;
}

/* Saves all members of an input that are not their defaults. */
static json_t *input_save(Saving *saving, const Input *input, int count) {
    static const float identity[6] = {1.0f, 0.0f, 0.0f, 0.0f, 1.0f, 0.0f};
    json_t *object = json_object();
    saving_put(saving, object, "value", saving_floats(input->value, count));
    if (input->texture) saving_put(saving, object, "texture", json_integer(input->texture - 1));
    if (input->texcoord) saving_put(saving, object, "texCoord", json_integer(input->texcoord));
    if (input->channel) saving_put(saving, object, "channel", json_integer(input->channel));
    if (memcmp((const char *)input->transform, (const char *)identity, sizeof identity) != 0)
        saving_put(saving, object, "transform", saving_floats(input->transform, 6));
    if (input->given) saving_put(saving, object, "given", json_true());
    return object;
}

/* Saves in extras all that differs from `read`, the material as a reader would get it. */
static void extras_save(Saving *saving, json_t *object, const Material *material, const Material *read) {
    json_t *weft = json_object(), *choices = json_object(), *inputs = json_object(), *extras = json_object();
    for (int k = 0; k < CHOICE_COUNT; k++)
        if (choice_id((ChoiceId)k, material->choices[k]))
            saving_put(saving, choices, weft_material_choice_name(k),
                       json_string(choice_id((ChoiceId)k, material->choices[k])));
    for (int k = 0; k < INPUT_COUNT; k++) {
        const Input wanted = numbered(saving, &material->inputs[k]);
        int count = input_value_count((InputId)k);
        if (!is_same(&wanted, &read->inputs[k], count))
            saving_put(saving, inputs, input_infos[k].name, input_save(saving, &wanted, count));
    }
    if (json_object_size(choices)) saving_put(saving, weft, "choices", json_incref(choices));
    if (json_object_size(inputs)) saving_put(saving, weft, "inputs", json_incref(inputs));
    if (material->cloth)
        saving_put(saving, weft, "weave", cloth_to_json(saving->scene->cloths[material->cloth - 1], NULL));
    if (material->alpha_cutoff < read->alpha_cutoff || material->alpha_cutoff > read->alpha_cutoff)
        number_put(saving, weft, "alphaCutoff", fmaxf(material->alpha_cutoff, 0.0f));
    json_decref(choices);
    json_decref(inputs);
    if (json_object_size(weft)) {
        saving_put(saving, extras, "weft", weft);
        saving_put(saving, object, "extras", extras);
    } else {
        json_decref(weft);
        json_decref(extras);
    }
}

/* Returns the name of a material, which a light of the scene's has none of. */
static const char *name_of(const WeftScene *scene, int material) {
    const char *name = weft_scene_material_name(scene, material);
    return name ? name : "light";
}

void materials_save(Saving *saving) {
    const WeftScene *scene = saving->scene;
    if (!scene->material_count) return;
    json_t *list = saving_list(saving, "materials");
    for (int k = 0; k < scene->material_count && saving->result == WEFT_OK; k++)
        saving_append(saving, list, material_save(saving, name_of(scene, k), &scene->materials[k]));
    WeftScene read = {0};
    Asset asset = {.name = saving->path,
                   .scene = &read,
                   .root = saving->root,
                   .limit = SIZE_MAX,
                   .texture_count = (size_t)saving->texture_count};
    if (saving->result == WEFT_OK) materials_read(&asset);
    if (asset.result != WEFT_OK) saving_fail(saving, WEFT_MESSAGE_MEMORY, saving->path, NULL);
    for (int k = 0; k < scene->material_count && saving->result == WEFT_OK; k++)
        extras_save(saving, json_array_get(list, (size_t)k), &scene->materials[k], &read.materials[k]);
    arena_free(&asset.arena);
    arena_free(&read.arena);
}
