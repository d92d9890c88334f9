#include "scene/material/set.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/fail.h"
#include "base/number.h"
#include "base/pi.h"
#include "image/srgb.h"
#include "scene/material/relief.h"
#include "scene/record/material_at.h"
#include "shading/material/choice.h"
#include "shading/material/compose.h"

const char *weft_material_input_name(int index) {
    return index >= 0 && index < INPUT_COUNT ? input_infos[index].name : NULL;
}

const char *weft_material_input_help(int index) {
    return index >= 0 && index < INPUT_COUNT ? input_infos[index].help : NULL;
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

int weft_material_choice_fits(int choice, int value) {
    return weft_material_choice_value(choice, value) && choice_fits((ChoiceId)choice, value);
}

int weft_material_choice_find(const char *name) {
    for (int k = 0; k < CHOICE_COUNT; k++)
        if (strcmp(choice_texts[k][0], name) == 0) return k;
    return -1;
}

WeftResult choice_value(ChoiceId choice, const char *id, int *value, WeftError *error) {
    char text[SEVERAL_SIZE];
    *value = strcmp(id, "auto") == 0 ? CHOICE_AUTO : choice_find(choice, id);
    if (*value == CHOICE_AUTO && strcmp(id, "auto") == 0) return WEFT_OK;
    if (*value >= 0 && choice_fits(choice, *value)) return WEFT_OK;
    const char *several = choice_several(choice, id, text), *name = choice_texts[choice][0],
               *by = choice == CHOICE_layer ? strstr(id, ",by=") : NULL;
    if (by)
        return fail(error, WEFT_MESSAGE_PARAM_VALUE, id, "write layer=%.*s and layer_by=%s", (int)(by - id), id,
                    by + strlen(",by="));
    if (several) return fail(error, WEFT_MESSAGE_PARAM_VALUE, id, "several have this name: %s", several);
    return fail(error, WEFT_MESSAGE_PARAM_VALUE, id, "`weft models` lists what %s may be", name);
}

bool material_matches(const WeftScene *scene, int k, const char *name) {
    char index[16];
    snprintf(index, sizeof index, "%d", k);
    return strcmp(name, "*") == 0 || strcmp(scene->material_names[k], name) == 0 || strcmp(index, name) == 0;
}

bool hex_color(const char *text, float color[3]) {
    if (text[0] != '#' || strlen(text) != 7 || strspn(text + 1, "0123456789abcdefABCDEF") != 6) return false;
    const unsigned long rgb = strtoul(text + 1, NULL, 16);
    for (int c = 0; c < 3; c++) color[c] = srgb_decode((float)(rgb >> (16 - 8 * c) & 255u) / 255.0f);
    return true;
}

static bool parse_input(const WeftInputInfo *info, const char *text, float value[3]) {
    if (info->kind == WEFT_INPUT_COLOR) return text[0] == '#' ? hex_color(text, value) : parse_color(text, value);
    return parse_number(text, value);
}

float number_ranged(const WeftInputInfo *info, float value, const char *target, const WeftLog *log) {
    float taken = fminf(fmaxf(value, info->hard_low), info->hard_high);
    if (taken < value || taken > value)
        warn(log, WEFT_MESSAGE_PARAM_RANGE, target, "%g is beyond the limit, %g, which is used", (double)value,
             (double)taken);
    else if (info->kind != WEFT_INPUT_DIRECTION && (value < info->low || value > info->high))
        warn(log, WEFT_MESSAGE_PARAM_RANGE, target, "%g is taken; plausible is %g .. %g", (double)value,
             (double)info->low, (double)info->high);
    bool angle = info->kind == WEFT_INPUT_DIRECTION || info->kind == WEFT_INPUT_ANGLE;
    return angle ? taken * (PI_FLOAT / 180.0f) : taken;
}

WeftResult setting_read(const char *name, const char *value, const char *target, Setting *setting, const WeftLog *log,
                        WeftError *error) {
    *setting = (Setting){
        .input = weft_material_input_find(name), .choice = weft_material_choice_find(name), .hair = hair_find(name)};
    if (setting->input < 0 && setting->choice < 0 && setting->hair < 0)
        return fail(error, WEFT_MESSAGE_PARAM_NAME, name, "`weft models` lists inputs and choices");
    if (setting->choice >= 0) return choice_value((ChoiceId)setting->choice, value, &setting->value, error);
    const WeftInputInfo *info = setting->hair >= 0 ? &hair_infos[setting->hair] : &input_infos[setting->input];
    if (!parse_input(info, value, setting->v))
        return fail(error, WEFT_MESSAGE_PARAM_VALUE, value, "%s is %s", info->name,
                    info->kind == WEFT_INPUT_COLOR ? "a number, r,g,b (linear) or #rrggbb (sRGB)" : "a number");
    for (int c = 0; c < (info->kind == WEFT_INPUT_COLOR ? 3 : 1); c++)
        setting->v[c] = number_ranged(info, setting->v[c], target, log);
    return WEFT_OK;
}

void material_set(Material *material, const Setting *setting) {
    if (setting->choice >= 0) material_choose(material, (ChoiceId)setting->choice, setting->value);
    if (setting->hair >= 0) material->hair[setting->hair] = setting->v[0];
    if (setting->input < 0) return;
    Input *slot = &material->inputs[setting->input];
    memcpy(slot->value, setting->v, sizeof setting->v);
    slot->given = true;
    if (setting->input == INPUT_opacity && material->alpha_mode == WEFT_ALPHA_OPAQUE)
        material->alpha_mode = WEFT_ALPHA_BLEND; /* else opacity would have no effect */
    if (input_infos[setting->input].kind != WEFT_INPUT_NORMAL) slot->texture = 0;
}

static bool has_sheen(const Material *material) {
    Choices choices = material_choices(material);
    Surface surface = convert_surface(material_plain(material), choices);
    Stack stack;
    compose_begin(&stack, &surface, convert_choices(choices));
    return HAS_SHEEN(&stack);
}

/* Returns true for a setting that affects nothing but a sheen. */
static bool wants_sheen(const Setting *setting) {
    static const ChoiceId choices[] = {CHOICE_sheen_lobe, CHOICE_sheen_d, CHOICE_sheen_v, CHOICE_sheen_f, CHOICE_layer};
    bool wants = false;
    for (size_t k = 0; k < sizeof choices / sizeof *choices; k++) wants |= setting->choice == (int)choices[k];
    return wants && setting->value != CHOICE_AUTO;
}

/* Sets a weave if the target is "MATERIAL.weave" or "MATERIAL.weave.KEY". Returns false if it is neither. */
static bool set_weave(WeftScene *scene, const char *target, const char *value, const WeftLog *log, WeftError *error,
                      WeftResult *result) {
    static const char mark[] = ".weave";
    char name[256];
    const char *at = NULL;
    for (const char *next = target; (next = strstr(next, mark)); next++)
        if (!next[sizeof mark - 1] || next[sizeof mark - 1] == '.') at = next;
    if (!at || (size_t)(at - target) >= sizeof name) return false;
    snprintf(name, sizeof name, "%.*s", (int)(at - target), target);
    const char *key = at + sizeof mark - 1;
    *result = weft_scene_weave(scene, name, *key ? key + 1 : key, value, log, error);
    return true;
}

/* Returns true if an input is set to its initial value, as commands do that restate a material. */
static bool is_reset(const Setting *setting) {
    bool same = setting->input >= 0;
    for (int c = 0; same && c < input_value_count((InputId)setting->input); c++)
        same = fabsf(setting->v[c] - input_infos[setting->input].initial) < 1e-6f;
    return same;
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
    WeftResult result;
    if (set_weave(scene, target, value, log, error, &result)) return result;
    result = setting_read(point + 1, value, target, &setting, log, error);
    if (result != WEFT_OK) return result;
    const Material *first = NULL;
    bool idle = wants_sheen(&setting);                      /* there is none */
    bool woven = setting.input >= 0 && !is_reset(&setting); /* all are, and do not read it */
    for (int k = 0; k < scene_own_materials(scene); k++) {
        Material *material = &scene->materials[k];
        if (!material_matches(scene, k, name)) continue;
        material_set(material, &setting);
        idle = idle && !has_sheen(material);
        woven = woven && material->cloth && !weft_material_reads(material, setting.input);
        if (!first) first = material;
    }
    if (first && idle)
        warn(log, WEFT_MESSAGE_PLAUSIBLE, target, "it changes nothing as long as none of these has a sheen");
    else if (first && woven)
        warn(log, WEFT_MESSAGE_PLAUSIBLE, target,
             "it changes nothing on what is woven; colours are those of its yarns: weave.warp.color, weave.weft.color");
    else if (first)
        plausible_check(first, setting.input, setting.choice, target, log);
    if (first) return materials_complete(scene, error);
    char names[NAMES_SIZE];
    return fail(error, WEFT_MESSAGE_MATERIAL_NAME, name, "%s", scene_names(scene, weft_scene_material_name, names));
}
