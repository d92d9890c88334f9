/* weave_set.c - setting a key of a material's weave by its name and a text */
#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/fail.h"
#include "base/number.h"
#include "scene/material/assign.h"
#include "scene/material/cloth_file.h"
#include "scene/material/cloth_fit.h"
#include "scene/material/relief.h"
#include "weave/weft_cloth.h"

/* A change of a weave. */
typedef struct WeaveSetting {
    const char *key, *value;
    WeftError *error;
} WeaveSetting;

static WeftResult refuse(const WeaveSetting *setting, const char *expected) {
    return fail(setting->error, WEFT_MESSAGE_PARAM_VALUE, setting->value, "weave.%s is %s", setting->key, expected);
}

/* Returns true if the value is the JSON of a whole weave. */
static bool is_whole(const WeaveSetting *setting) {
    return !setting->key[0] && setting->value[strspn(setting->value, " ")] == '{';
}

static json_t *read_numbers(const char *text, int count) {
    float numbers[3];
    json_t *list = parse_numbers(text, ',', count, numbers) ? json_array() : NULL;
    for (int k = 0; list && k < count; k++) json_array_append_new(list, json_real((double)numbers[k]));
    return list;
}

static json_t *read_number(const char *text) {
    float number;
    return parse_number(text, &number) ? json_real((double)number) : NULL;
}

/* Sets a key to a new value. Fails with WEFT_MESSAGE_PARAM_VALUE where there is none. */
static WeftResult put(const WeaveSetting *setting, json_t *object, const char *key, json_t *value,
                      const char *expected) {
    return value && json_object_set_new(object, key, value) == 0 ? WEFT_OK : refuse(setting, expected);
}

/* Returns the object of a system's yarn, made of its name where it is a name alone; NULL if memory is short. */
static json_t *yarn_object(json_t *weave, const char *system) {
    json_t *yarn = json_object_get(weave, system);
    if (json_is_object(yarn)) return yarn;
    json_t *object = json_pack("{s:s}", "yarn", json_is_string(yarn) ? json_string_value(yarn) : "cotton");
    return json_object_set_new(weave, system, object) == 0 ? object : NULL;
}

/* Sets the yarn of a system by its name, which replaces all numbers, but not the colour. */
static WeftResult put_yarn(const WeaveSetting *setting, json_t *weave, const char *system) {
    json_t *yarn = yarn_object(weave, system), *color = json_incref(json_object_get(yarn, "color"));
    json_object_clear(yarn);
    WeftResult result = put(setting, yarn, "yarn", json_string(setting->value), "the name of a yarn");
    if (color && result == WEFT_OK) return put(setting, yarn, "color", color, "the name of a yarn");
    json_decref(color);
    return result;
}

static WeftResult put_yarn_key(const WeaveSetting *setting, json_t *weave, const char *system, const char *key) {
    json_t *yarn = yarn_object(weave, system);
    if (strcmp(key, "yarn") == 0) return put_yarn(setting, weave, system);
    if (strcmp(key, "color") == 0) {
        const bool hex = setting->value[0] == '#';
        return put(setting, yarn, key, hex ? json_string(setting->value) : read_numbers(setting->value, 3),
                   "a colour: #rrggbb, or r,g,b in linear reflectance");
    }
    for (int k = 0; weft_yarn_number(k); k++)
        if (strcmp(weft_yarn_number(k)->name, key) == 0)
            return put(setting, yarn, key, read_number(setting->value), "a number");
    const char *meant = cloth_key_meant(setting->key);
    return fail(setting->error, WEFT_MESSAGE_PARAM_NAME, setting->key, "is not yarn, color or a number of a yarn%s%s%s",
                meant ? "; did you mean " : "", meant ? meant : "", meant ? "?" : "");
}

/* Sets the whole weave: its JSON, or the draft of a new one in cotton. */
static WeftResult put_weave(const WeaveSetting *setting, json_t *weave) {
    json_t *fresh = is_whole(setting) ? json_loads(setting->value, JSON_REJECT_DUPLICATES, NULL)
                                      : json_pack("{s:s}", "draft", setting->value);
    if (!json_is_object(fresh)) {
        json_decref(fresh);
        return refuse(setting, "a draft, or the JSON of a weave");
    }
    json_object_clear(weave);
    const bool whole = json_object_update(weave, fresh) == 0;
    json_decref(fresh);
    return whole ? WEFT_OK : refuse(setting, "too large");
}

static WeftResult change(const WeaveSetting *setting, json_t *weave) {
    const char *key = setting->key, *value = setting->value;
    if (!key[0]) return put_weave(setting, weave);
    if (strcmp(key, "draft") == 0) return put(setting, weave, key, json_string(value), "words, or a file");
    if (strcmp(key, "seed") == 0) return put(setting, weave, key, read_number(value), "a number");
    if (strcmp(key, "rotation") == 0) return put(setting, weave, key, read_number(value), "a number of degrees");
    if (strcmp(key, "metres") == 0)
        return put(setting, weave, key, strcmp(value, "auto") == 0 ? json_string(value) : read_number(value),
                   "a number of metres, or auto");
    if (strcmp(key, "relief") == 0)
        return put(setting, weave, key, isalpha((unsigned char)value[0]) ? json_string(value) : read_number(value),
                   "folds, all, none, or a number of metres");
    if (strcmp(key, "sett") == 0)
        return put(setting, weave, key, strchr(value, ',') ? read_numbers(value, 2) : read_number(value),
                   "threads per centimetre, WARP,WEFT");
    if (strncmp(key, "warp", 4) == 0 || strncmp(key, "weft", 4) == 0) {
        char system[5];
        snprintf(system, sizeof system, "%.4s", key);
        if (!key[4]) return put_yarn(setting, weave, system);
        if (key[4] == '.') return put_yarn_key(setting, weave, system, key + 5);
    }
    const char *meant = cloth_key_meant(key);
    return fail(setting->error, WEFT_MESSAGE_PARAM_NAME, key,
                "%s%s%sa weave has draft, sett, metres, seed, rotation, relief, warp and weft, and these yarn, color "
                "and numbers: "
                "warp.color",
                meant ? "did you mean " : "", meant ? meant : "", meant ? "? " : "");
}

/* Makes a material that is not woven a plain one of cotton, as a material file does: without a sheen. */
static WeftResult begin_weave(WeftScene *scene, int material, WeftError *error) {
    static const char plain[] = "{\"weave\": {\"draft\": \"plain\"}}";
    if (scene->materials[material].cloth) return WEFT_OK;
    return material_assign_text(scene, material, plain, error);
}

/* Weaves the cloth of a material anew with the change. */
static WeftResult reweave(WeftScene *scene, int material, const WeaveSetting *setting, const WeftLog *log) {
    const int number = scene->materials[material].cloth;
    const WeftCloth *was = number ? scene->cloths[number - 1] : NULL;
    WeftCloth *cloth = NULL;
    json_t *weave = was ? cloth_to_json(was, was->path) : json_object();
    if (!weave) return fail(setting->error, WEFT_MESSAGE_MEMORY, scene->name, NULL);
    /* A draft is looked for among files if it is new, or was a file before, whose path is absolute. */
    const bool file = !setting->key[0] || strcmp(setting->key, "draft") == 0 || (was && was->path);
    WeftResult result = change(setting, weave);
    const ClothSource source = {setting->value, WEFT_MESSAGE_PARAM_VALUE, file ? "" : NULL, log, setting->error};
    if (result == WEFT_OK) result = cloth_from_json(weave, &source, &cloth);
    json_decref(weave);
    return result == WEFT_OK ? cloth_put(scene, material, cloth, setting->error) : result;
}

/* Warns of what a material loses that is now woven. */
static void warn_of_change(const WeftScene *scene, int material, const Material *was, const WeftLog *log) {
    const char *name = scene->material_names[material];
    if (was->inputs[INPUT_base_color].texture)
        warn(log, WEFT_MESSAGE_GLTF_WARN_IGNORED, name,
             "the texture of its base colour: a weave has the colours of its yarns");
    cloth_check(scene, material, log);
}

WeftResult weft_scene_weave(WeftScene *scene, const char *material, const char *key, const char *value,
                            const WeftLog *log, WeftError *error) {
    const WeaveSetting setting = {key, value, error};
    const bool *selected = materials_matching(scene, material, error);
    if (!selected) return WEFT_USAGE;
    WeftResult result = WEFT_OK;
    for (int k = 0; k < scene_own_materials(scene) && result == WEFT_OK; k++) {
        if (!selected[k]) continue;
        const Material was = scene->materials[k];
        if (!is_whole(&setting)) result = begin_weave(scene, k, error);
        if (result == WEFT_OK) result = reweave(scene, k, &setting, log);
        if (result != WEFT_OK) scene->materials[k] = was;
        if (result == WEFT_OK && !was.cloth) warn_of_change(scene, k, &was, log);
    }
    return result == WEFT_OK ? materials_complete(scene, error) : result;
}

WeftClothInfo weft_scene_cloth_info(const WeftScene *scene, int cloth) {
    if (cloth < 1 || cloth > scene->cloth_count) return (WeftClothInfo){0};
    return weft_cloth_info(scene->cloths[cloth - 1]);
}

char *weft_scene_weave_text(const WeftScene *scene, int cloth) {
    if (cloth < 1 || cloth > scene->cloth_count) return NULL;
    const WeftCloth *of = scene->cloths[cloth - 1];
    json_t *json = of->text ? cloth_to_json(of, of->path) : NULL;
    char *text = json ? json_dumps(json, JSON_COMPACT) : NULL;
    json_decref(json);
    return text;
}
