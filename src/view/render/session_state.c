#include "view/render/session_state.h"

#include <stdio.h>
#include <string.h>

#include "view/files/paths.h"
#include "view/files/record.h"
#include "view/files/session_file.h"

static const RecordMember light_members[] = {RECORD_WHOLE(WeftLight, kind, WEFT_LIGHT_POLYGON),
                                             RECORD_FLOATS(WeftLight, position, 3),
                                             RECORD_FLOATS(WeftLight, direction, 3),
                                             RECORD_FLOATS(WeftLight, color, 3),
                                             RECORD_FLOATS(WeftLight, range, 1),
                                             RECORD_FLOATS(WeftLight, inner, 1),
                                             RECORD_FLOATS(WeftLight, outer, 1),
                                             RECORD_FLOATS(WeftLight, size, 2),
                                             RECORD_WHOLE(WeftLight, corners, 8),
                                             RECORD_FLOATS(WeftLight, roll, 1)};
static const RecordMember environment_members[] = {RECORD_WHOLE(EnvironmentState, kind, ENVIRONMENT_COLOR),
                                                   RECORD_FLOATS(EnvironmentState, color, 3),
                                                   RECORD_FLOATS(EnvironmentState, rotation, 1),
                                                   RECORD_FLOATS(EnvironmentState, strength, 1),
                                                   RECORD_FLOATS(EnvironmentState, ambient, 1),
                                                   RECORD_FLOATS(EnvironmentState, reflection, 1)};
static const RecordMember input_members[] = {RECORD_FLOATS(WeftInput, value, 3), RECORD_WHOLE(WeftInput, texcoord, 1),
                                             RECORD_WHOLE(WeftInput, channel, 3), RECORD_WHOLE(WeftInput, given, 1),
                                             RECORD_FLOATS(WeftInput, transform, 6)};
static const RecordMember material_members[] = {
    RECORD_WHOLE(WeftMaterial, alpha_mode, WEFT_ALPHA_BLEND), RECORD_FLOATS(WeftMaterial, alpha_cutoff, 1),
    RECORD_WHOLE(WeftMaterial, double_sided, 1), RECORD_WHOLE(WeftMaterial, unlit, 1),
    RECORD_FLOATS(WeftMaterial, hair, WEFT_HAIR_NUMBERS)};

#define LENGTH(array) (sizeof(array) / sizeof *(array))

/* Writes a map: its number if the file of the scene has it, else its path. */
static json_t *map_json(int texture, const Facts *facts) {
    const bool added = texture > facts->own_maps && texture <= facts->map_count;
    const char *path = added ? facts->map_paths[texture - 1] : NULL;
    return path ? json_string(path) : json_integer(added ? 0 : texture);
}

static json_t *material_json(const SceneState *state, const SceneState *first, int index, const Facts *facts) {
    const WeftMaterial *m = scene_state_material(state, index);
    const int preset = scene_state_preset(state, index);
    json_t *object = record_write(m, material_members, LENGTH(material_members)), *choices = json_object(),
           *inputs = json_object();
    json_object_set_new(object, "index", json_integer(index));
    if (preset) json_object_set_new(object, "preset", json_string(weft_preset_name(preset - 1)));
    for (int k = 0; weft_material_choice_name(k); k++)
        if (m->choices[k] >= 0)
            json_object_set_new(choices, weft_material_choice_name(k),
                                json_string(weft_material_choice_value(k, m->choices[k])));
    for (int k = 0; weft_material_input_name(k); k++) {
        json_t *input = record_write(&m->inputs[k], input_members, LENGTH(input_members));
        json_object_set_new(input, "map", map_json(m->inputs[k].texture, facts));
        json_object_set_new(inputs, weft_material_input_name(k), input);
    }
    json_object_set_new(object, "choices", choices);
    json_object_set_new(object, "inputs", inputs);
    const bool other = !first || m->cloth != scene_state_material(first, index)->cloth;
    const char *weave = m->cloth > 0 && m->cloth <= facts->cloth_count ? facts->cloths[m->cloth - 1].text : NULL;
    if (other) json_object_set_new(object, "weave", weave ? json_string(weave) : json_null());
    return object;
}

json_t *session_state_write(const SceneState *state, const SceneState *first, const Facts *facts) {
    json_t *root = json_object(), *materials = json_array(), *lights = json_array(), *naps = json_array();
    for (int k = 0; k < state->material_count; k++)
        if (!first || !scene_state_same_material(state, first, k) ||
            scene_state_preset(state, k) != scene_state_preset(first, k))
            json_array_append_new(materials, material_json(state, first, k, facts));
    for (int k = 0; k < state->light_count; k++)
        json_array_append_new(lights, record_write(&state->lights[k], light_members, LENGTH(light_members)));
    for (int k = 0; k < state->material_count; k++)
        if (scene_state_nap(state, k)) json_array_append_new(naps, json_integer(k));
    json_t *environment = record_write(&state->environment, environment_members, LENGTH(environment_members));
    json_object_set_new(environment, "path", json_string(state->environment.path));
    json_object_set_new(root, "materials", materials);
    json_object_set_new(root, "lights", lights);
    json_object_set_new(root, "environment", environment);
    json_object_set_new(root, "variant", json_integer(state->variant));
    json_object_set_new(root, "naps", naps);
    return root;
}

static WeftResult damaged(WeftError *error, const char *what) {
    snprintf(error->text, sizeof error->text, "its %s cannot be read", what);
    return WEFT_INPUT;
}

static int value_of(int choice, const char *id) {
    int value = 0;
    while (weft_material_choice_value(choice, value) && strcmp(weft_material_choice_value(choice, value), id) != 0)
        value++;
    return weft_material_choice_value(choice, value) ? value : -1;
}

static bool read_choices(const json_t *object, WeftMaterial *m) {
    const json_t *choices = json_object_get(object, "choices");
    for (int k = 0; weft_material_choice_name(k); k++) {
        const char *id = json_string_value(json_object_get(choices, weft_material_choice_name(k)));
        m->choices[k] = id ? value_of(k, id) : -1;
        if (id && m->choices[k] < 0) return false;
    }
    return json_is_object(choices);
}

/* Reads inputs, with the maps that are files; the material in the scene receives these on the way. */
static WeftResult read_inputs(const json_t *object, int index, WeftScene *scene, WeftMaterial *m, WeftError *error) {
    const json_t *inputs = json_object_get(object, "inputs");
    for (int k = 0; weft_material_input_name(k); k++) {
        const json_t *input = json_object_get(inputs, weft_material_input_name(k)),
                     *map = json_object_get(input, "map");
        WeftInput *to = &m->inputs[k];
        if (json_is_object(inputs) && !input) continue; /* an earlier version did not have it */
        if (!record_read(input, input_members, LENGTH(input_members), to)) return damaged(error, "materials");
        to->texture = (int)json_integer_value(map);
        if (!json_is_string(map)) continue;
        char target[64];
        WeftMaterial with;
        snprintf(target, sizeof target, "%d.%s", index, weft_material_input_name(k));
        WeftResult result = weft_scene_set_texture(scene, target, json_string_value(map), NULL, error);
        if (result == WEFT_OK) result = weft_scene_material(scene, index, &with, error);
        if (result != WEFT_OK) return result;
        to->texture = with.inputs[k].texture;
    }
    return WEFT_OK;
}

static WeftResult read_weave(const json_t *weave, int index, WeftScene *scene, WeftMaterial *m, WeftError *error) {
    char target[16];
    WeftMaterial woven;
    if (!weave) return WEFT_OK;
    m->cloth = 0;
    if (!json_is_string(weave)) return WEFT_OK;
    snprintf(target, sizeof target, "%d", index);
    WeftResult result = weft_scene_weave(scene, target, "", json_string_value(weave), NULL, error);
    if (result == WEFT_OK) result = weft_scene_material(scene, index, &woven, error);
    if (result == WEFT_OK) m->cloth = woven.cloth;
    return result;
}

static int preset_of(const json_t *object) {
    const char *name = json_string_value(json_object_get(object, "preset"));
    int k = 0;
    while (name && weft_preset_name(k) && strcmp(weft_preset_name(k), name) != 0) k++;
    return name && weft_preset_name(k) ? k + 1 : 0;
}

/* Reads a material. The scene checks its numbers; then it has the first one again. */
static WeftResult read_material(const json_t *object, WeftScene *scene, const SceneState *first, SceneState *state,
                                WeftError *error) {
    int index;
    if (!record_whole(object, "index", 0, state->material_count - 1, &index)) return damaged(error, "materials");
    WeftMaterial m = *scene_state_material(first, index);
    if (!record_read(object, material_members, LENGTH(material_members), &m) || !read_choices(object, &m))
        return damaged(error, "materials");
    WeftResult result = read_weave(json_object_get(object, "weave"), index, scene, &m, error);
    if (result == WEFT_OK) result = read_inputs(object, index, scene, &m, error);
    if (result == WEFT_OK) result = weft_scene_put_material(scene, index, &m, error);
    if (result == WEFT_OK) result = weft_scene_put_material(scene, index, scene_state_material(first, index), error);
    if (result != WEFT_OK) return result;
    return scene_state_set_material(state, index, &m) && scene_state_set_preset(state, index, preset_of(object))
               ? WEFT_OK
               : WEFT_RESOURCES;
}

/* Reads the lights. The scene checks each. */
static WeftResult read_lights(const json_t *lights, WeftScene *scene, SceneState *state, WeftError *error) {
    if (!json_is_array(lights) || json_array_size(lights) > STATE_LIGHTS) return damaged(error, "lights");
    state->light_count = (int)json_array_size(lights);
    memset(state->lights, 0, sizeof state->lights);
    for (int k = 0; k < state->light_count; k++) {
        const int last = weft_scene_info(scene).light_count;
        if (!record_read(json_array_get(lights, (size_t)k), light_members, LENGTH(light_members), &state->lights[k]))
            return damaged(error, "lights");
        WeftResult result = weft_scene_add_light(scene, &state->lights[k], error);
        if (result == WEFT_OK) result = weft_scene_remove_light(scene, last, error);
        if (result != WEFT_OK) return result;
    }
    return WEFT_OK;
}

/* Reads the environment. Its picture must be there still. */
static WeftResult read_environment(const json_t *object, EnvironmentState *environment, WeftError *error) {
    const char *path = json_string_value(json_object_get(object, "path"));
    const bool good = record_read(object, environment_members, LENGTH(environment_members), environment) && path &&
                      strlen(path) < sizeof environment->path;
    if (!good || environment->strength < 0.0f || environment->ambient < 0.0f || environment->reflection < 0.0f)
        return damaged(error, "environment");
    memset(environment->path, 0, sizeof environment->path);
    memcpy(environment->path, path, strlen(path));
    if (environment->kind != ENVIRONMENT_FILE || path_stamp(path)) return WEFT_OK;
    snprintf(error->text, sizeof error->text, "%.300s, which lit it, is gone", path);
    return WEFT_INPUT;
}

static WeftResult read_nap(const char *path, int material, SceneState *state, WeftError *error) {
    WeftImage read, *image;
    WeftResult result = weft_image_read(path, &read, NULL, error);
    if (result != WEFT_OK) return result;
    const bool fits =
        read.width == NAP_SIDE && read.height == NAP_SIDE && read.channels == 3 && read.type == WEFT_PIXEL_U8;
    BrushedNap *nap = fits ? nap_copy(&(SceneState){0}, material, &read, &image) : NULL;
    weft_image_free(&read);
    return nap && scene_state_set_nap(state, nap) ? WEFT_OK : damaged(error, "brushed nap");
}

static WeftResult read_naps(const json_t *naps, const char *session, int from, SceneState *state, WeftError *error) {
    if (!json_is_array(naps) || json_array_size(naps) > STATE_NAPS) return damaged(error, "brushed naps");
    for (int k = 0; k < (int)json_array_size(naps); k++) {
        const json_int_t material = json_integer_value(json_array_get(naps, (size_t)k));
        char path[SESSION_PATH];
        if (material < 0 || material >= state->material_count || !session_file_nap(session, from + k, path))
            return damaged(error, "brushed naps");
        WeftResult result = read_nap(path, (int)material, state, error);
        if (result != WEFT_OK) return result;
    }
    return WEFT_OK;
}

WeftResult session_state_read(const json_t *root, const char *session, int nap, WeftScene *scene,
                              const SceneState *first, SceneState *state, WeftError *error) {
    const json_t *materials = json_object_get(root, "materials");
    if (!scene_state_copy(state, first)) {
        *state = (SceneState){0};
        return WEFT_RESOURCES;
    }
    WeftResult result = json_is_array(materials) ? WEFT_OK : damaged(error, "materials");
    for (size_t k = 0; result == WEFT_OK && k < json_array_size(materials); k++)
        result = read_material(json_array_get(materials, k), scene, first, state, error);
    if (result == WEFT_OK) result = read_lights(json_object_get(root, "lights"), scene, state, error);
    if (result == WEFT_OK) result = read_environment(json_object_get(root, "environment"), &state->environment, error);
    if (result == WEFT_OK) result = read_naps(json_object_get(root, "naps"), session, nap, state, error);
    if (result == WEFT_OK &&
        !record_whole(root, "variant", -1, weft_scene_info(scene).variant_count - 1, &state->variant))
        result = damaged(error, "variant");
    if (result == WEFT_OK) return WEFT_OK;
    for (int k = 0; k < first->material_count; k++)
        weft_scene_put_material(scene, k, scene_state_material(first, k), NULL);
    scene_state_free(state);
    return result;
}

bool session_state_same_naps(const SceneState *a, const SceneState *b) {
    for (int k = 0; k < a->material_count; k++)
        if (scene_state_nap(a, k) != (k < b->material_count ? scene_state_nap(b, k) : NULL)) return false;
    return true;
}

bool session_state_write_naps(const SceneState *state, const SceneState *kept, const char *session, int nap) {
    bool good = true;
    if (session_state_same_naps(state, kept)) return true;
    for (int k = 0; k < state->material_count; k++) {
        const WeftImage *image = scene_state_nap(state, k);
        char path[SESSION_PATH];
        if (!image) continue;
        good = session_file_nap(session, nap++, path) && weft_image_write(path, image, NULL) == WEFT_OK && good;
    }
    return good;
}
