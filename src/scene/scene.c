#include "scene/scene.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/fail.h"
#include "base/number.h"
#include "scene/environment.h"
#include "shading/choice.h"

WeftScene *scene_create(const char *name) {
    WeftScene *scene = alloc_array(1, sizeof *scene);
    if (!scene) return NULL;
    scene->srgb = srgb_table();
    scene->environment.strength = 1.0f;
    scene->name = arena_text(&scene->arena, name);
    if (scene->name && environment_studio(&scene->environment.image, NULL) == WEFT_OK) return scene;
    weft_scene_free(scene);
    return NULL;
}

void weft_scene_free(WeftScene *scene) {
    if (!scene) return;
    for (int k = 0; k < scene->image_count; k++) weft_image_free(&scene->images[k]);
    weft_image_free(&scene->environment.image);
    arena_free(&scene->arena);
    free(scene);
}

void scene_bounds(WeftScene *scene) {
    scene->low = (Vec3){INFINITY, INFINITY, INFINITY};
    scene->high = (Vec3){-INFINITY, -INFINITY, -INFINITY};
    for (int m = 0; m < scene->mesh_count; m++) {
        const Mesh *mesh = &scene->meshes[m];
        for (uint32_t k = 0; k < mesh->vertex_count; k++) {
            const float *p = mesh->position + 3 * (size_t)k;
            scene->low =
                (Vec3){fminf(scene->low.x, p[0]), fminf(scene->low.y, p[1]), fminf(scene->low.z, p[2])};
            scene->high =
                (Vec3){fmaxf(scene->high.x, p[0]), fmaxf(scene->high.y, p[1]), fmaxf(scene->high.z, p[2])};
        }
    }
}

WeftSceneInfo weft_scene_info(const WeftScene *scene) {
    WeftSceneInfo info = {.mesh_count = scene->mesh_count,
                          .material_count = scene->material_count,
                          .light_count = scene->light_count,
                          .camera_count = scene->camera_count,
                          .variant_count = scene->variant_count,
                          .image_count = scene->image_count,
                          .low = {scene->low.x, scene->low.y, scene->low.z},
                          .high = {scene->high.x, scene->high.y, scene->high.z}};
    for (int m = 0; m < scene->mesh_count; m++) info.triangle_count += scene->meshes[m].triangle_count;
    return info;
}

const char *weft_scene_material_name(const WeftScene *scene, int index) {
    return index >= 0 && index < scene->material_count ? scene->materials[index].name : NULL;
}

const char *weft_scene_camera_name(const WeftScene *scene, int index) {
    return index >= 0 && index < scene->camera_count ? scene->cameras[index].name : NULL;
}

const char *weft_scene_variant_name(const WeftScene *scene, int index) {
    return index >= 0 && index < scene->variant_count ? scene->variants[index] : NULL;
}

const char *scene_names(const WeftScene *scene, const char *(*name)(const WeftScene *scene, int index),
                        char text[NAMES_SIZE]) {
    enum { LISTED = 5 };
    int used = snprintf(text, NAMES_SIZE, name(scene, 0) ? "there is " : "there is none");
    for (int k = 0; k <= LISTED && name(scene, k) && used < NAMES_SIZE; k++) {
        char index[16];
        snprintf(index, sizeof index, "%d", k);
        const char *word = k == LISTED ? "..." : name(scene, k)[0] ? name(scene, k) : index;
        used += snprintf(text + used, (size_t)(NAMES_SIZE - used), "%s%.40s", k ? ", " : "", word);
    }
    return text;
}

WeftResult weft_scene_set_variant(WeftScene *scene, const char *name, WeftError *error) {
    for (int v = 0; v < scene->variant_count; v++) {
        if (strcmp(scene->variants[v], name) != 0) continue;
        for (int m = 0; m < scene->mesh_count; m++) {
            Mesh *mesh = &scene->meshes[m];
            if (mesh->variant_material && mesh->variant_material[v] >= 0)
                mesh->material = mesh->variant_material[v];
        }
        return WEFT_OK;
    }
    char names[NAMES_SIZE];
    return fail(error, WEFT_MESSAGE_VARIANT_NAME, name, "%s",
                scene_names(scene, weft_scene_variant_name, names));
}

const char *weft_material_input_name(int index) {
    return index >= 0 && index < INPUT_COUNT ? input_infos[index].name : NULL;
}

const char *weft_material_input_help(int index) {
    return index >= 0 && index < INPUT_COUNT ? input_infos[index].help : NULL;
}

/* Whether "name", a decimal index or "*" means material k. */
static bool material_matches(const WeftScene *scene, int k, const char *name) {
    char index[16];
    snprintf(index, sizeof index, "%d", k);
    return strcmp(name, "*") == 0 || strcmp(scene->materials[k].name, name) == 0 || strcmp(index, name) == 0;
}

static bool parse_input(const InputInfo *info, const char *text, float value[3]) {
    if (info->kind == INPUT_COLOR) return parse_color(text, value);
    if (!parse_number(text, value)) return false;
    if (info->kind == INPUT_DIRECTION) value[0] *= 3.14159265f / 180.0f;
    return true;
}

/* value, clamped to the hard range; a warning where it is beyond the plausible one. Any angle is plausible.
 */
static float within_range(const InputInfo *info, float value, const char *target, const WeftLog *log) {
    float taken = fminf(fmaxf(value, info->hard_low), info->hard_high);
    if (taken < value || taken > value)
        warn(log, WEFT_MESSAGE_PARAM_RANGE, target, "%g was clamped to %g", (double)value, (double)taken);
    else if (info->kind != INPUT_DIRECTION && (value < info->low || value > info->high))
        warn(log, WEFT_MESSAGE_PARAM_RANGE, target, "%g is not in %g .. %g", (double)value, (double)info->low,
             (double)info->high);
    return taken;
}

static const char *const choice_texts[CHOICE_COUNT][2] = {
#define CHOICE_TEXT(name, help) {#name, help},
    SURFACE_CHOICES(CHOICE_TEXT)
#undef CHOICE_TEXT
};

const char *weft_material_choice_name(int index) {
    return index >= 0 && index < CHOICE_COUNT ? choice_texts[index][0] : NULL;
}

const char *weft_material_choice_help(int index) {
    return index >= 0 && index < CHOICE_COUNT ? choice_texts[index][1] : NULL;
}

const char *weft_material_choice_value(int index, int value) {
    return index >= 0 && index < CHOICE_COUNT ? choice_id((ChoiceId)index, value) : NULL;
}

/* A choice by name, or -1. */
static int choice_named(const char *name) {
    for (int k = 0; k < CHOICE_COUNT; k++)
        if (strcmp(choice_texts[k][0], name) == 0) return k;
    return -1;
}

/* The value of a choice from its id; CHOICE_AUTO from "auto"; below that, none. */
static int choice_value(int choice, const char *id) {
    if (strcmp(id, "auto") == 0) return CHOICE_AUTO;
    int value = choice_find((ChoiceId)choice, id);
    return value >= 0 && choice_fits((ChoiceId)choice, value) ? value : CHOICE_AUTO - 1;
}

/* Sets an input, or a choice, of material k from text that is known to be good. */
typedef struct Setting {
    int input, choice, value; /* value: of the choice */
    float v[3];
} Setting;

static void material_set(Material *material, const Setting *setting) {
    if (setting->input < 0) {
        material_choose(material, (ChoiceId)setting->choice, setting->value);
        return;
    }
    Input *slot = &material->inputs[setting->input];
    memcpy(slot->value, setting->v, sizeof setting->v);
    if (input_infos[setting->input].kind != INPUT_NORMAL) slot->texture = 0;
}

static WeftResult setting_read(const char *name, const char *value, const char *target, Setting *setting,
                               const WeftLog *log, WeftError *error) {
    *setting = (Setting){.input = material_input(name), .choice = choice_named(name)};
    if (setting->input < 0 && setting->choice < 0)
        return fail(error, WEFT_MESSAGE_PARAM_NAME, name, "`weft models` lists the inputs");
    if (setting->input < 0) {
        setting->value = choice_value(setting->choice, value);
        if (setting->value >= CHOICE_AUTO) return WEFT_OK;
        return fail(error, WEFT_MESSAGE_PARAM_VALUE, value, "`weft models` lists what %s may be", name);
    }
    const InputInfo *info = &input_infos[setting->input];
    if (!parse_input(info, value, setting->v))
        return fail(error, WEFT_MESSAGE_PARAM_VALUE, value, "%s is %s", info->name,
                    info->kind == INPUT_COLOR ? "a number or r,g,b" : "a number");
    int count = info->kind == INPUT_COLOR ? 3 : 1;
    for (int c = 0; c < count; c++) setting->v[c] = within_range(info, setting->v[c], target, log);
    return WEFT_OK;
}

WeftResult weft_scene_set(WeftScene *scene, const char *target, const char *value, const WeftLog *log,
                          WeftError *error) {
    const char *point = strrchr(target, '.');
    char name[256];
    if (!point || (size_t)(point - target) >= sizeof name)
        return fail(error, WEFT_MESSAGE_PARAM_NAME, target, "write MATERIAL.INPUT=VALUE");
    memcpy(name, target, (size_t)(point - target));
    name[point - target] = '\0';
    Setting setting;
    WeftResult result = setting_read(point + 1, value, target, &setting, log, error);
    if (result != WEFT_OK) return result;
    int matched = 0;
    for (int k = 0; k < scene->material_count; k++) {
        if (!material_matches(scene, k, name)) continue;
        material_set(&scene->materials[k], &setting);
        matched++;
    }
    if (matched) return WEFT_OK;
    char names[NAMES_SIZE];
    return fail(error, WEFT_MESSAGE_MATERIAL_NAME, name, "%s",
                scene_names(scene, weft_scene_material_name, names));
}

WeftResult weft_scene_set_environment_file(WeftScene *scene, const char *path, const WeftLog *log,
                                           WeftError *error) {
    WeftImage raw, linear;
    WeftResult result = weft_image_read(path, &raw, log, error);
    if (result != WEFT_OK) return result;
    result = weft_image_convert_f32(&raw, 1, &linear, error);
    weft_image_free(&raw);
    if (result != WEFT_OK) return result;
    weft_image_free(&scene->environment.image);
    scene->environment.image = linear;
    scene->environment.kind = ENVIRONMENT_IMAGE;
    return WEFT_OK;
}

WeftResult weft_scene_set_environment_color(WeftScene *scene, const float color[3], WeftError *error) {
    for (int c = 0; c < 3; c++)
        if (!(isfinite(color[c]) && color[c] >= 0.0f))
            return fail(error, WEFT_MESSAGE_DESC, "environment color", "%g", (double)color[c]);
    weft_image_free(&scene->environment.image);
    scene->environment.kind = ENVIRONMENT_CONSTANT;
    memcpy(scene->environment.color, color, sizeof scene->environment.color);
    return WEFT_OK;
}

WeftResult weft_scene_set_environment_placement(WeftScene *scene, float rotation, float strength,
                                                WeftError *error) {
    if (!isfinite(rotation)) return fail(error, WEFT_MESSAGE_DESC, "environment rotation", NULL);
    if (!(isfinite(strength) && strength >= 0.0f))
        return fail(error, WEFT_MESSAGE_DESC, "environment strength", NULL);
    scene->environment.rotation = fmodf(rotation, 360.0f) * (3.14159265f / 180.0f);
    scene->environment.strength = strength;
    return WEFT_OK;
}
