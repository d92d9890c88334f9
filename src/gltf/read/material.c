/* Specification: see material_fields.c; and KHR_materials_unlit and KHR_texture_transform in Khronos' registry. */
#include "base/pi.h"
#include "gltf/read/gltf_material.h"

#include <float.h>
#include <math.h>
#include <string.h>

#include "gltf/asset/field.h"
#include "gltf/asset/material_fields.h"
#include "gltf/read/coordinates.h"
#include "gltf/read/glossiness.h"
#include "scene/material/backs.h"
#include "scene/material/cloth_file.h"
#include "scene/material/material_numbers.h"
#include "scene/material/set.h"
#include "weave/weft_cloth.h"

/* Reads KHR_texture_transform: T R S. The asset TextureTransformTest shows the sense of the rotation: v grows
 * downwards, so that counter-clockwise is (c u + s v, c v - s u). */
static void transform_read(const Field *field, Input *input) {
    static const char *const keys[] = {"offset", "rotation", "scale", "texCoord", "extensions", "extras", NULL};
    Field offset_field = field_member(field, "offset"), scale_field = field_member(field, "scale"),
          rotation = field_member(field, "rotation"), texcoord = field_member(field, "texCoord");
    float offset[2] = {0.0f, 0.0f}, scale[2] = {1.0f, 1.0f};
    field_keys(field, keys);
    field_floats(&offset_field, offset, 2, -1e6f, 1e6f);
    field_floats(&scale_field, scale, 2, -1e6f, 1e6f);
    float angle = (float)field_number(&rotation, 0.0, -1e3, 1e3);
    float c = cosf(angle), s = sinf(angle);
    const float m[6] = {c * scale[0], s * scale[1], offset[0], -s * scale[0], c * scale[1], offset[1]};
    memcpy(input->transform, m, sizeof m);
    input->texcoord = (int)field_size(&texcoord, (size_t)input->texcoord, 0, UINT8_MAX);
}

/* Warns of a texture, + 1, without a picture that can be read. textures_resolve drops it. */
static void picture_check(const Field *field, int texture) {
    const TextureSource *source = texture && field->asset->textures ? &field->asset->textures[texture - 1] : NULL;
    if (!source || source->image >= 0) return;
    const char *offer = source->offer ? source->offer : "";
    field_warn(field, WEFT_MESSAGE_GLTF_WARN_IGNORED, "textures[%d] has no picture%s%s%s", texture - 1,
               *offer ? " but that of " : "", offer, *offer ? ", which is not read" : "");
}

/* Gives an input with a texture the set of the coordinates TEXCOORD_n; it has no texture where the material reads two
 * others. */
static void coordinates_give(const Field *field, Input *input, int n) {
    const int set = coordinates_choose(field->asset, n);
    if (set < 0) {
        field_warn(field, WEFT_MESSAGE_GLTF_WARN_IGNORED,
                   "TEXCOORD_%d, but the material reads TEXCOORD_%d and %d already", n, field->asset->sets[0],
                   field->asset->sets[1]);
        input->texture = 0;
    }
    input->texcoord = set < 0 ? 0 : set;
}

/* Reads a textureInfo, if there is one; channel matters to scalars only. */
static void texture_read(const Field *field, Input *input, int channel) {
    static const char *const keys[] = {"index", "texCoord", "scale", "strength", "extensions", "extras", NULL};
    if (!field->json) return;
    Field index = field_member(field, "index"), texcoord = field_member(field, "texCoord");
    Field transform = field_extension(field, "KHR_texture_transform");
    input->texture = field_needed_index(&index, field->asset->texture_count) + 1;
    input->channel = channel;
    input->texcoord = (int)field_size(&texcoord, 0, 0, UINT8_MAX);
    if (transform.json) transform_read(&transform, input);
    field_keys(field, keys);
    const int n = input->texcoord;
    input->texcoord = 0;
    picture_check(field, input->texture);
    if (input->texture) coordinates_give(field, input, n);
}

/* Beyond these, numbers that glTF leaves unlimited are clamped: angles and the strength of a normal map. */
static const float ANY_MOST = 1e3f;

/* Reads the factor and the texture of a row into its input. object: where their keys are. */
static void row_read(const Field *object, const MaterialField *row, Input *inputs) {
    const bool any = row->low < 0.0f;
    const float low = any ? -ANY_MOST : row->low, high = any ? ANY_MOST : fminf(row->high, FLT_MAX);
    const int count = material_field_numbers(row);
    float numbers[4] = {row->absent, row->absent, row->absent, row->absent};
    Field texture = {.asset = object->asset}, factor;
    if (row->texture) texture = field_member(object, row->texture);
    factor = field_member(material_field_inside(row) ? &texture : object, material_field_key(row));
    if (count == 1)
        numbers[0] = (float)field_number(&factor, (double)row->absent, (double)low, (double)high);
    else
        field_floats(&factor, numbers, (size_t)count, low, high);
    Input *input = &inputs[row->input];
    memcpy(input->value, numbers, (count == 1 ? 1 : 3) * sizeof *numbers);
    texture_read(&texture, input, row->channels <= CHANNEL_A_GLOSS ? (int)row->channels : 0);
    if (row->channels != CHANNELS_COLOR_ALPHA) return;
    inputs[INPUT_opacity] = *input;
    inputs[INPUT_opacity].channel = CHANNEL_A;
    memcpy(inputs[INPUT_opacity].value, (const float[3]){numbers[3]}, sizeof input->value);
}

/* Repairs an ior: 0 is the extension's way to write that all is reflected; no other is below 1. */
static void ior_repair(const Field *material, float *ior) {
    Field extension = field_extension(material, material_field_of(INPUT_ior)->object),
          field = field_member(&extension, "ior");
    if (*ior <= 0.0f) {
        *ior = 1e6f;
    } else if (*ior < 1.0f) {
        field_warn(&field, WEFT_MESSAGE_GLTF_WARN_REPAIRED, "%g is taken as 1", (double)*ior);
        *ior = 1.0f;
    }
}

/* Warns of an attenuationDistance that is there and 0, below which no light would come out: it is read as absent. */
static void distance_check(const Field *material, float distance) {
    const MaterialField *row = material_field_of(INPUT_attenuation_distance);
    Field extension = field_extension(material, row->object), field = field_member(&extension, row->factor);
    if (field.json && !(distance > 0.0f))
        field_warn(&field, WEFT_MESSAGE_GLTF_WARN_REPAIRED, "%g is taken as infinite", (double)distance);
}

/* Warns of members that neither the rows of an object have nor glTF has beside them. row: the first of them. */
static void members_check(const Field *object, const MaterialField *row) {
    static const char *const of_material[] = {"name", "pbrMetallicRoughness", "alphaMode", "doubleSided"};
    enum { ROWS_MOST = 16, OF_MATERIAL = sizeof of_material / sizeof *of_material };
    const char *known[2 * ROWS_MOST + OF_MATERIAL + 3] = {"extensions", "extras"};
    size_t count = 2;
    for (size_t k = 0; !row->object && k < OF_MATERIAL; k++) known[count++] = of_material[k];
    for (const MaterialField *r = row; r->factor && count < 2 * ROWS_MOST; r++) {
        if (row->object ? !material_fields_share(row, r) : r->object != NULL) continue;
        if (!material_field_inside(r)) known[count++] = r->factor;
        if (r->texture) known[count++] = r->texture;
    }
    field_keys(object, known);
}

static void rows_read(const Field *material, Input *inputs) {
    const MaterialField *last = NULL;
    for (const MaterialField *row = material_fields; row->factor; row++) {
        Field object = material_field_extends(row) ? field_extension(material, row->object)
                       : row->object               ? field_member(material, row->object)
                                                   : *material;
        const bool begins = !last || last->object != row->object;
        last = row;
        if (row->input == NO_INPUT || (material_field_replaces(row) && !object.json)) continue;
        if (begins) members_check(&object, row);
        row_read(&object, row, inputs);
    }
    ior_repair(material, inputs[INPUT_ior].value);
    distance_check(material, inputs[INPUT_attenuation_distance].value[0]);
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
    static const char *const keys[] = {"value", "texture", "texCoord", "channel", "transform", "given", NULL};
    const float most = FLT_MAX;
    Field value = field_member(field, "value"), texture = field_member(field, "texture"),
          texcoord = field_member(field, "texCoord"), channel = field_member(field, "channel"),
          transform = field_member(field, "transform"), given = field_member(field, "given");
    const int count = input_value_count(id);
    *input = material_default().inputs[id];
    field_keys(field, keys);
    field_floats(&value, input->value, (size_t)count, -most, most);
    for (int c = 0; c < count; c++) input->value[c] = input_clamped(id, input->value[c]);
    field_floats(&transform, input->transform, 6, -most, most);
    input->texture = field_index(&texture, field->asset->texture_count) + 1;
    input->texcoord = (int)field_size(&texcoord, 0, 0, 1);
    if (input->texture) coordinates_give(field, input, input->texcoord);
    input->channel = (uint8_t)field_size(&channel, 0, 0, 3);
    input->given = field_bool(&given, false);
}

/* Reads a choice by its id. An unknown id, as of a later version, is left to the workflow with a warning. */
static void choice_read(const Field *field, ChoiceId choice, Material *material) {
    WeftError error;
    if (!field->json) return;
    if (choice_value(choice, field_text(field, "auto"), &material->choices[choice], &error) == WEFT_OK) return;
    material->choices[choice] = CHOICE_AUTO;
    field_warn(field, WEFT_MESSAGE_GLTF_WARN_IGNORED, "\"%.40s\" means nothing", field_text(field, ""));
}

/* Reads the extras that weft_scene_save adds so that a material comes back as it was. */
static void saved_read(const Field *weft, Material *material) {
    Field choices = field_member(weft, "choices"), list = field_member(weft, "inputs"),
          cutoff = field_member(weft, "alphaCutoff");
    const char *choice_names[CHOICE_COUNT + 1] = {NULL}, *input_names[INPUT_COUNT + 1] = {NULL};
    for (int k = 0; k < CHOICE_COUNT; k++) {
        Field field = field_member(&choices, choice_names[k] = weft_material_choice_name(k));
        choice_read(&field, (ChoiceId)k, material);
    }
    for (int k = 0; k < INPUT_COUNT; k++) {
        Field field = field_member(&list, input_names[k] = input_infos[k].name);
        if (field.json) whole_input_read(&field, (InputId)k, &material->inputs[k]);
    }
    field_keys(&choices, choice_names);
    field_keys(&list, input_names);
    for (int k = 0; k < WEFT_HAIR_NUMBERS; k++) {
        const Field field = field_member(weft, hair_infos[k].name);
        material->hair[k] = (float)field_number(&field, (double)material->hair[k], (double)hair_infos[k].hard_low,
                                                (double)hair_infos[k].hard_high);
    }
    material->alpha_cutoff = (float)field_number(&cutoff, (double)material->alpha_cutoff, 0.0, (double)FLT_MAX);
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
    const ClothSource source = {
        .name = field.asset->name, .refusal = WEFT_MESSAGE_MATERIAL_FILE, .log = field.asset->log, .error = &error};
    WeftResult result = cloth_from_json(field.json, &source, &cloth);
    if (result != WEFT_OK && result != WEFT_RESOURCES)
        field_warn(&field, WEFT_MESSAGE_GLTF_WARN_IGNORED, "%s", error.text);
    const bool paid =
        cloth && asset_charge(field.asset, (size_t)cloth->weave.warps * (size_t)cloth->weave.picks, 4 * sizeof(float));
    material->cloth = paid ? scene_adopt_cloth(scene, cloth) : 0;
    if (result == WEFT_RESOURCES || (paid && !material->cloth)) asset_fail(field.asset, WEFT_MESSAGE_MEMORY, NULL);
    if (!material->cloth) weft_cloth_free(cloth);
}

/* Reads extras.weft: what no extension of glTF can express. Other extras belong to other programs. */
static void extras_read(const Field *field, Material *material) {
    enum { OTHERS = 9 };
    const char *keys[OTHERS + OWN + WEFT_HAIR_NUMBERS + 1] = {
        "nap", "napRotation", "napTexture", "dustTexture", "choices", "inputs", "alphaCutoff", "weave", "back"};
    for (size_t k = 0; k < OWN; k++) keys[OTHERS + k] = own[k].key;
    for (int k = 0; k < WEFT_HAIR_NUMBERS; k++) keys[OTHERS + OWN + (size_t)k] = hair_infos[k].name;
    static const MaterialField nap[] = {
        {INPUT_nap, NULL, "nap", "napTexture", CHANNEL_B, 0.0f, 0.0f, 0.5f * PI_FLOAT},
        {INPUT_nap_direction, NULL, "napRotation", "napTexture", CHANNELS_DIRECTION, 0.0f, -INFINITY, INFINITY}};
    Input *inputs = material->inputs;
    Field extras = field_member(field, "extras");
    if (!json_is_object(extras.json)) return;
    Field weft = field_member(&extras, "weft"), dust = field_member(&weft, "dustTexture");
    for (size_t k = 0; k < OWN; k++) own_read(&weft, inputs, own[k].key, own[k].id);
    texture_read(&dust, &inputs[INPUT_dust], CHANNEL_R);
    for (size_t k = 0; k < sizeof nap / sizeof *nap; k++) row_read(&weft, &nap[k], inputs);
    saved_read(&weft, material);
    weave_read(&weft, material);
    field_keys(&weft, keys);
}

/* Reads an object of "materials"; an absent field gives the default material. */
static Material material_read(const Field *field) {
    static const char *const modes[] = {"OPAQUE", "MASK", "BLEND", NULL}; /* as WeftAlphaMode */
    Field alpha = field_member(field, "alphaMode"), cutoff = field_member(field, "alphaCutoff"),
          sided = field_member(field, "doubleSided");
    Material material = material_default();
    material.alpha_mode = (WeftAlphaMode)field_choice(&alpha, modes, WEFT_ALPHA_OPAQUE, "");
    material.alpha_cutoff = (float)field_number(&cutoff, 0.5, 0.0, (double)FLT_MAX);
    material.double_sided = field_bool(&sided, false);
    material.unlit = field_extension(field, "KHR_materials_unlit").json != NULL;
    rows_read(field, material.inputs);
    if (field_extension(field, gloss_object).json) glossiness_begin(&material);
    extras_read(field, &material);
    return material;
}

/* Reads what is seen of a material from behind: a material of "materials" in short, but with no cloth, no back and no
 * picture of glossiness. */
static void back_read(const Field *field, size_t index) {
    Asset *asset = field->asset;
    const Field extras = field_member(field, "extras");
    if (!json_is_object(extras.json)) return; /* another program's */
    const Field weft = field_member(&extras, "weft"), back = field_member(&weft, "back");
    const json_t *further = json_object_get(json_object_get(back.json, "extras"), "weft");
    if (!back.json) return;
    if (!json_is_object(back.json)) {
        field_fail(&back, WEFT_MESSAGE_GLTF_SCHEMA, "expected an object");
        return;
    }
    Material *material = asset_array(asset, &asset->arena, 1, sizeof *material);
    if (!material) return;
    *material = material_read(&back);
    if (json_object_get(further, "back") || material->cloth || field_extension(&back, gloss_object).json)
        field_warn(&back, WEFT_MESSAGE_GLTF_WARN_IGNORED, "it has a weave, a back or glossiness of its own");
    else
        asset->backs[index] = material;
}

void materials_read(Asset *asset) {
    WeftScene *scene = asset->scene;
    Field root = field_root(asset), list = field_member(&root, "materials");
    asset->material_count = field_count(&list);
    scene->materials = asset_array(asset, &scene->arena, asset->material_count + 1, sizeof(Material));
    scene->material_names = asset_array(asset, &scene->arena, asset->material_count + 1, sizeof(char *));
    asset->material_shown = asset_array(asset, &asset->arena, asset->material_count + 1, sizeof(bool));
    asset->material_sets = asset_array(asset, &asset->arena, asset->material_count + 1, sizeof *asset->material_sets);
    asset->backs = asset_array(asset, &asset->arena, asset->material_count + 1, sizeof(Material *));
    for (size_t i = 0; i <= asset->material_count && asset->result == WEFT_OK; i++) {
        Field field = field_element(&list, i);
        if (i < asset->material_count && !json_is_object(field.json))
            field_fail(&field, WEFT_MESSAGE_GLTF_SCHEMA, "expected an object");
        Field name = field_member(&field, "name");
        coordinates_begin(asset, i);
        scene->materials[i] = material_read(&field);
        back_read(&field, i);
        scene->material_names[i] = asset_text(asset, field_text(&name, ""));
    }
    scene->material_count = (int)asset->material_count;
}

void backs_take(Asset *asset) {
    WeftScene *scene = asset->scene;
    for (int m = 0; m < scene->material_count && asset->result == WEFT_OK; m++) {
        if (!asset->backs[m]) continue;
        if (backs_make(scene, asset->error) == WEFT_OK)
            back_give(scene, m, asset->backs[m]);
        else
            asset_fail(asset, WEFT_MESSAGE_MEMORY, NULL);
    }
}
