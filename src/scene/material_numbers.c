#include "scene/material_numbers.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/fail.h"
#include "scene/set.h"
#include "scene/shade.h"
#include "scene/tangents.h"
#include "shading/choice.h"

_Static_assert((int)INPUT_COUNT <= (int)WEFT_INPUTS_MAX && (int)CHOICE_COUNT <= (int)WEFT_CHOICES_MAX,
               "weft/material.h has room for all");
_Static_assert((int)WEFT_INPUT_SCALAR == (int)INPUT_SCALAR && (int)WEFT_INPUT_COLOR == (int)INPUT_COLOR &&
                   (int)WEFT_INPUT_NORMAL == (int)INPUT_NORMAL &&
                   (int)WEFT_INPUT_DIRECTION == (int)INPUT_DIRECTION &&
                   (int)WEFT_INPUT_ANGLE == (int)INPUT_ANGLE,
               "the kinds of both are one list");
_Static_assert((int)WEFT_ALPHA_MASK == (int)ALPHA_MASK && (int)WEFT_ALPHA_BLEND == (int)ALPHA_BLEND,
               "and the alpha modes");
_Static_assert(sizeof((WeftInput *)0)->transform == sizeof((Input *)0)->transform, "both are copied");

int weft_material_input_info(int index, WeftInputInfo *out) {
    *out = (WeftInputInfo){0};
    if (index < 0 || index >= INPUT_COUNT) return 0;
    const InputInfo *info = &input_infos[index];
    *out = (WeftInputInfo){.name = info->name,
                           .help = info->help,
                           .kind = (WeftInputKind)info->kind,
                           .initial = info->def,
                           .low = info->low,
                           .high = info->high,
                           .hard_low = info->hard_low,
                           .hard_high = info->hard_high};
    return 1;
}

static int value_count(int input) { return input_infos[input].kind == INPUT_COLOR ? 3 : 1; }

void numbers_of_material(const Material *material, WeftMaterial *out) {
    memset(out, 0, sizeof *out);
    out->alpha_mode = (WeftAlphaMode)material->alpha_mode;
    out->alpha_cutoff = material->alpha_cutoff;
    out->double_sided = material->double_sided;
    out->unlit = material->unlit;
    memcpy(out->choices, material->choices, sizeof material->choices);
    for (int k = 0; k < INPUT_COUNT; k++) {
        const Input *from = &material->inputs[k];
        WeftInput *to = &out->inputs[k];
        memcpy(to->value, from->value, (size_t)value_count(k) * sizeof *to->value);
        memcpy(to->transform, from->transform, sizeof to->transform);
        to->texture = from->texture;
        to->texcoord = from->texcoord;
        to->channel = from->channel;
        to->given = from->given;
    }
}

/* Copies the numbers, except those that a Material does not have. */
static Material take_numbers(const WeftMaterial *numbers) {
    Material material = material_default("");
    material.alpha_mode =
        (unsigned)numbers->alpha_mode <= WEFT_ALPHA_BLEND ? (AlphaMode)numbers->alpha_mode : ALPHA_OPAQUE;
    material.alpha_cutoff = numbers->alpha_cutoff;
    material.double_sided = numbers->double_sided != 0;
    material.unlit = numbers->unlit != 0;
    memcpy(material.choices, numbers->choices, sizeof material.choices);
    for (int k = 0; k < INPUT_COUNT; k++) {
        const WeftInput *from = &numbers->inputs[k];
        Input *to = &material.inputs[k];
        memcpy(to->value, from->value, sizeof to->value);
        memcpy(to->transform, from->transform, sizeof to->transform);
        to->texture = from->texture;
        to->texcoord = from->texcoord == 1;
        to->channel = (uint8_t)(from->channel & 3);
        to->given = from->given != 0;
    }
    return material;
}

static bool is_choice(int choice, int value) {
    bool known = value >= 0 && choice_id((ChoiceId)choice, value) && choice_fits((ChoiceId)choice, value);
    return known || value == CHOICE_AUTO;
}

float input_clamped(InputId input, float value) {
    const InputInfo *info = &input_infos[input];
    bool angle = info->kind == INPUT_DIRECTION || info->kind == INPUT_ANGLE;
    float unit = angle ? 3.14159265f / 180.0f : 1.0f; /* of what input_ranged makes of the hard range */
    return fminf(fmaxf(value, info->hard_low * unit), info->hard_high * unit);
}

Material material_of_numbers(const WeftMaterial *numbers) {
    Material material = take_numbers(numbers);
    for (int k = 0; k < CHOICE_COUNT; k++)
        if (!is_choice(k, material.choices[k])) material.choices[k] = CHOICE_AUTO;
    for (int k = 0; k < INPUT_COUNT; k++)
        for (int c = 0; c < 3; c++)
            material.inputs[k].value[c] = input_clamped((InputId)k, material.inputs[k].value[c]);
    material.alpha_cutoff = fmaxf(material.alpha_cutoff, 0.0f); /* below it is as good as 0 */
    return material;
}

static bool all_finite(const float *values, int count) {
    bool finite = true;
    for (int k = 0; k < count; k++) finite &= (bool)isfinite(values[k]);
    return finite;
}

WeftResult numbers_sound(const WeftMaterial *m, WeftError *error) {
    for (int k = 0; k < CHOICE_COUNT; k++)
        if (!is_choice(k, m->choices[k]))
            return fail(error, WEFT_MESSAGE_PARAM_VALUE, weft_material_choice_name(k),
                        "it has no value of number %d", m->choices[k]);
    for (int k = 0; k < INPUT_COUNT; k++)
        if (!all_finite(m->inputs[k].value, value_count(k)))
            return fail(error, WEFT_MESSAGE_PARAM_VALUE, input_infos[k].name, "its value is not finite");
    return WEFT_OK;
}

/* Returns the fault of an input's texture reference, or NULL. */
static const char *wrong_map(const WeftScene *scene, const WeftInput *input) {
    if (!all_finite(input->transform, 6)) return "its transform is not finite";
    if (input->texture < 0 || input->texture > scene->texture_count) return "there is no such texture";
    if (input->texcoord < 0 || input->texcoord > 1) return "texcoord is 0 or 1";
    return input->channel < 0 || input->channel > 3 ? "channel is 0 to 3" : NULL;
}

static WeftResult check_numbers(const WeftScene *scene, const WeftMaterial *m, WeftError *error) {
    if ((unsigned)m->alpha_mode > WEFT_ALPHA_BLEND)
        return fail(error, WEFT_MESSAGE_PARAM_VALUE, "alpha_mode", "there is no such mode");
    if (!isfinite(m->alpha_cutoff))
        return fail(error, WEFT_MESSAGE_PARAM_VALUE, "alpha_cutoff", "it is not finite");
    WeftResult result = numbers_sound(m, error);
    if (result != WEFT_OK) return result;
    for (int k = 0; k < INPUT_COUNT; k++) {
        const char *wrong = wrong_map(scene, &m->inputs[k]);
        if (wrong) return fail(error, WEFT_MESSAGE_PARAM_VALUE, input_infos[k].name, "%s", wrong);
    }
    return WEFT_OK;
}

static WeftResult no_material(const WeftScene *scene, int index, WeftError *error) {
    char names[NAMES_SIZE], number[16];
    snprintf(number, sizeof number, "%d", index);
    return fail(error, WEFT_MESSAGE_MATERIAL_NAME, number, "%s",
                scene_names(scene, weft_scene_material_name, names));
}

WeftResult weft_scene_material(const WeftScene *scene, int index, WeftMaterial *out, WeftError *error) {
    memset(out, 0, sizeof *out);
    if (index < 0 || index >= scene_own_materials(scene)) return no_material(scene, index, error);
    numbers_of_material(&scene->materials[index], out);
    return WEFT_OK;
}

WeftResult weft_scene_put_material(WeftScene *scene, int index, const WeftMaterial *numbers,
                                   WeftError *error) {
    if (index < 0 || index >= scene_own_materials(scene)) return no_material(scene, index, error);
    WeftResult result = check_numbers(scene, numbers, error);
    if (result != WEFT_OK) return result;
    Material before = scene->materials[index], material = material_of_numbers(numbers);
    material.name = before.name;
    scene->materials[index] = material;
    result = tangents_complete(scene, error);
    if (result != WEFT_OK) scene->materials[index] = before;
    return result;
}

void weft_material_choose(WeftMaterial *numbers, int choice, int value) {
    if (choice < 0 || choice >= CHOICE_COUNT || !is_choice(choice, value)) return;
    Material material = take_numbers(numbers);
    material_choose(&material, (ChoiceId)choice, value);
    numbers->choices[choice] = value;
    for (int k = 0; k < INPUT_COUNT; k++)
        memcpy(numbers->inputs[k].value, material.inputs[k].value, sizeof material.inputs[k].value);
}

static void check_fitted(const Material *material, const char *name, const WeftLog *log) {
    const Choices choices = material_choices(material);
    Surface surface = material_plain(material);
    Stack stack;
    if (material->inputs[INPUT_sheen_roughness].texture) surface.sheen_roughness = 0.0f;
    stack_make(&stack, &surface, &choices, (TableRef){.kind = TABLE_NONE});
    if (HAS_LAYERED_SHEEN(&stack)) lobe_fitted(&stack.sheen.lobe, name, log);
}

void weft_material_fitted(const WeftMaterial *numbers, const char *name, const WeftLog *log) {
    const Material material = material_of_numbers(numbers);
    check_fitted(&material, name, log);
}

void weft_material_plausible(const WeftMaterial *numbers, const char *name, const WeftLog *log) {
    Material material = material_of_numbers(numbers);
    check_fitted(&material, name, log);
    plausible_check_all(&material, name, log);
    for (int k = 0; k < INPUT_COUNT; k++) {
        const InputInfo *info = &input_infos[k];
        if (info->kind == INPUT_DIRECTION || numbers->inputs[k].texture || !weft_material_reads(numbers, k))
            continue;
        float unit = info->kind == INPUT_ANGLE ? 180.0f / 3.14159265f : 1.0f;
        float slack = 1e-5f * fmaxf(fabsf(info->low), fabsf(info->high)); /* degrees that were radians */
        for (int c = 0; c < value_count(k); c++) {
            float value = material.inputs[k].value[c] * unit;
            if (value >= info->low - slack && value <= info->high + slack) continue;
            warn(log, WEFT_MESSAGE_PARAM_RANGE, name, "%s %g is not in %g .. %g", info->name, (double)value,
                 (double)info->low, (double)info->high);
            break;
        }
    }
}
