/* material_save.c - materials as other programs read them, and in extras.weft what glTF cannot express
 *
 * What is written for others is read back at once, as a reader of this library would. Where that gives
 * another input, the whole input is written. So a material comes back unchanged, whatever a workflow or a
 * profile makes of its inputs and however well glTF expresses it. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/equal.h"
#include "gltf/asset/material_fields.h"
#include "gltf/read/gltf_material.h"
#include "gltf/save/saving.h"
#include "scene/material/cloth_file.h"
#include "scene/material/material_numbers.h"
#include "scene/material/relief.h"
#include "scene/record/fuzz_sheen.h"
#include "scene/record/material_at.h"
#include "shading/material/choice.h"
#include "shading/stack/workflow.h"

static float value(const Material *material, InputId id) { return material->inputs[id].value[0]; }

static float strongest(const Input *input) { return fmaxf(input->value[0], fmaxf(input->value[1], input->value[2])); }

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

static void number_put(Saving *saving, json_t *object, const char *key, float x) {
    saving_put(saving, object, key, json_real((double)x));
}

/* Returns the index of refraction. If the workflow has F0 as a colour, it is 1.5, and the tint is that colour over the
 * F0 of 1.5. */
static float saved_ior(const Material *material) {
    const Surface plain = {.ior = value(material, INPUT_ior), .reflectance = value(material, INPUT_reflectance)};
    const float root = sqrtf(fminf(dielectric_f0(&plain), 1.0f));
    if (material_choices(material).workflow == WORKFLOW_SPECULAR) return 1.5f;
    return plain.ior >= 1.0f ? plain.ior : (1.0f + root) / fmaxf(1.0f - root, 1e-3f);
}

/* Returns number c of an input's factor in glTF's terms, where these are not weft's. */
static float saved_number(const Material *material, InputId id, int c) {
    const float x = material->inputs[id].value[c], glow = fmaxf(strongest(&material->inputs[INPUT_emission]), 1.0f);
    const int workflow = material_choices(material).workflow;
    switch (id) {
    case INPUT_metallic: return workflow > WORKFLOW_METALLIC ? 0.0f : x; /* other workflows have next to no metal */
    case INPUT_emission: return x * (1.0f / glow);
    case INPUT_emission_strength: return x * glow;
    case INPUT_specular_color: return fminf(workflow == WORKFLOW_SPECULAR ? 25.0f * x : x, 1000.0f);
    case INPUT_ior: return saved_ior(material);
    case INPUT_sheen_color: return x * value(material, INPUT_sheen);
    default: return x;
    }
}

static float in_range(const MaterialField *row, float x) { return fminf(fmaxf(x, row->low), row->high); }

static json_t *factor_json(const Material *material, const MaterialField *row) {
    const int count = material_field_numbers(row);
    float numbers[4];
    for (int c = 0; c < 3; c++) numbers[c] = in_range(row, saved_number(material, (InputId)row->input, c));
    numbers[3] = in_range(row, value(material, INPUT_opacity));
    return count == 1 ? json_real((double)numbers[0]) : saving_floats(numbers, count);
}

/* Returns the textureInfo of a row; NULL if the input reads another channel than glTF does, or if the next row has the
 * same texture. Metalness and roughness share one: that of roughness, or else that of metalness. */
static json_t *texture_json(Saving *saving, const Material *material, const MaterialField *row) {
    if (!row->texture || material_field_repeats(row + 1)) return NULL;
    if (row->input == INPUT_roughness && !material->inputs[row->input].texture) row--;
    const Input *input = &material->inputs[row->input];
    return row->channels > CHANNEL_A || input->channel == (int)row->channels ? texture_info(saving, input) : NULL;
}

/* Saves a row, but for an infinite attenuationDistance, which is absent. */
static void row_save(Saving *saving, json_t *object, const Material *material, const MaterialField *row) {
    if (row->input == INPUT_attenuation_distance && !(value(material, INPUT_attenuation_distance) > 0.0f)) return;
    json_t *info = texture_json(saving, material, row), *holder = material_field_inside(row) ? info : object;
    if (holder) saving_put(saving, holder, material_field_key(row), factor_json(material, row));
    if (info) saving_put(saving, object, row->texture, info);
}

/* Returns true if the material's coat has what KHR_materials_clearcoat cannot express; it is then written as both. */
static bool coat_is_wanted(const Material *material) {
    static const InputId coming[] = {INPUT_coat_ior, INPUT_coat_color, INPUT_coat_darkening, INPUT_coat_anisotropy};
    const Material plain = material_default();
    bool wanted = false;
    for (size_t k = 0; k < sizeof coming / sizeof *coming; k++) {
        const Input *input = &material->inputs[coming[k]], *as = &plain.inputs[coming[k]];
        wanted |= input->texture != 0;
        for (int c = 0; c < 3; c++) wanted |= !is_equal(input->value[c], as->value[c]);
    }
    return wanted && value(material, INPUT_clearcoat) > 0.0f;
}

/* Returns true if the object that begins with this row is written: an extension where its first number is not what a
 * reader takes without it. */
static bool is_wanted(const Material *material, const MaterialField *row) {
    const bool glows = strongest(&material->inputs[INPUT_emission]) > 0.0f;
    if (material_field_replaces(row)) return row->object == coat_object && coat_is_wanted(material);
    switch (row->input) {
    case NO_INPUT: return false;
    case INPUT_specular: return true;
    case INPUT_ior: return !is_equal(saved_ior(material), row->absent);
    case INPUT_emission: return glows;
    case INPUT_emission_strength:
        return glows && !is_equal(saved_number(material, INPUT_emission_strength, 0), row->absent);
    default: return !material_field_extends(row) || !is_equal(strongest(&material->inputs[row->input]), row->absent);
    }
}

/* Writes the rows from `row` to `end`, which are of one object. */
static void object_save(Saving *saving, json_t *json, const Material *material, const MaterialField *row,
                        const MaterialField *end) {
    const char *name = row->object;
    const bool extends = material_field_extends(row);
    json_t *object = name ? json_object() : json;
    for (; row < end; row++) row_save(saving, object, material, row);
    if (extends)
        saving_extend(saving, json, name, object);
    else if (name)
        saving_put(saving, json, name, object);
}

/* Writes the fields that an unlit material has too, or else the others: extensions that reflect light. */
static void rows_save(Saving *saving, json_t *json, const Material *material, bool reflects) {
    for (const MaterialField *row = material_fields, *end; row->factor; row = end) {
        for (end = row + 1; material_fields_share(row, end);) end++;
        bool reflection = material_field_extends(row) && row->input != INPUT_emission_strength;
        if (reflection == reflects && is_wanted(material, row)) object_save(saving, json, material, row, end);
    }
}

static json_t *material_save(Saving *saving, const char *name, const Material *material) {
    static const char *const modes[] = {"OPAQUE", "MASK", "BLEND"}; /* as WeftAlphaMode */
    json_t *object = json_object();
    saving_name(saving, object, name);
    rows_save(saving, object, material, false);
    if (material->alpha_mode != WEFT_ALPHA_OPAQUE)
        saving_put(saving, object, "alphaMode", json_string(modes[material->alpha_mode]));
    if (material->alpha_mode == WEFT_ALPHA_MASK)
        number_put(saving, object, "alphaCutoff", fmaxf(material->alpha_cutoff, 0.0f));
    if (material->double_sided) saving_put(saving, object, "doubleSided", json_true());
    if (material->unlit) saving_extend(saving, object, "KHR_materials_unlit", json_object());
    if (!material->unlit) rows_save(saving, object, material, true);
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
           a->texture == b->texture && a->texcoord == b->texcoord && a->channel == b->channel && a->given == b->given &&
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
    for (int k = 0; k < WEFT_HAIR_NUMBERS; k++)
        if (!is_equal(material->hair[k], read->hair[k]))
            number_put(saving, weft, hair_infos[k].name, material->hair[k]);
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

/* Moves the object of a back out of the list of materials to extras.weft.back of its front, where other programs do not
 * take it for a material that nothing has. */
static void back_put(Saving *saving, json_t *front, json_t *list, size_t at) {
    json_t *back = json_incref(json_array_get(list, at)), *extras = json_object_get(front, "extras"),
           *weft = json_object_get(extras, "weft");
    if (!extras) saving_put(saving, front, "extras", extras = json_object());
    if (!weft) saving_put(saving, extras, "weft", weft = json_object());
    json_array_remove(list, at);
    saving_put(saving, weft, "back", back);
}

/* Returns the name of a material, which a light of the scene's has none of. */
static const char *name_of(const WeftScene *scene, int material) {
    const char *name = weft_scene_material_name(scene, material);
    return name ? name : "light";
}

void materials_save(Saving *saving) {
    const WeftScene *scene = saving->scene;
    if (!scene->material_count) return;
    const int shaded = scene_shaded_materials(scene), fronts = scene->material_count;
    Material *given = arena_array(&saving->arena, (size_t)shaded, sizeof *given);
    int *of = arena_array(&saving->arena, (size_t)shaded, sizeof *of),
        count = 0; /* first the fronts, then some backs */
    if (!given || !of) {
        saving_fail(saving, WEFT_MESSAGE_MEMORY, saving->path, NULL);
        return;
    }
    for (int k = 0; k < shaded; k++) {
        const bool back = k >= fronts;
        if (back && !scene_has_back(scene, k - fronts)) continue;
        given[count] = back ? scene->materials[k] : relief_given(scene, k);
        fuzz_sheen_put(&given[count]);
        of[count++] = back ? k - fronts : k;
    }
    json_t *list = saving_list(saving, "materials");
    for (int k = 0; k < count && saving->result == WEFT_OK; k++)
        saving_append(saving, list, material_save(saving, k < fronts ? name_of(scene, k) : "", &given[k]));
    WeftScene read = {0};
    Asset asset = {.name = saving->path,
                   .scene = &read,
                   .root = saving->root,
                   .limit = SIZE_MAX,
                   .texture_count = (size_t)saving->texture_count};
    if (saving->result == WEFT_OK) materials_read(&asset);
    if (asset.result != WEFT_OK) saving_fail(saving, WEFT_MESSAGE_MEMORY, saving->path, NULL);
    for (int k = 0; k < count && saving->result == WEFT_OK; k++)
        extras_save(saving, json_array_get(list, (size_t)k), &given[k], &read.materials[k]);
    for (int k = count - 1; k >= fronts && saving->result == WEFT_OK; k--)
        back_put(saving, json_array_get(list, (size_t)of[k]), list, (size_t)k);
    arena_free(&asset.arena);
    arena_free(&read.arena);
}
