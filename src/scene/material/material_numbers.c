#include "scene/material/material_numbers.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/fail.h"
#include "base/pi.h"
#include "scene/material/relief.h"
#include "scene/material/set.h"
#include "scene/record/material_at.h"
#include "shading/material/choice.h"

static bool is_choice(int choice, int value) {
    bool exists = value >= 0 && choice_id((ChoiceId)choice, value) && choice_fits((ChoiceId)choice, value);
    return exists || value == CHOICE_AUTO;
}

float input_clamped(InputId input, float value) {
    const WeftInputInfo *info = &input_infos[input];
    bool angle = info->kind == WEFT_INPUT_DIRECTION || info->kind == WEFT_INPUT_ANGLE;
    float unit = angle ? PI_FLOAT / 180.0f : 1.0f; /* as number_ranged converts the hard range */
    return fminf(fmaxf(value, info->hard_low * unit), info->hard_high * unit);
}

Material material_sound(const WeftMaterial *numbers) {
    Material material = material_default();
    material.alpha_mode = (unsigned)numbers->alpha_mode <= WEFT_ALPHA_BLEND ? numbers->alpha_mode : WEFT_ALPHA_OPAQUE;
    material.alpha_cutoff = fmaxf(numbers->alpha_cutoff, 0.0f); /* below it is as good as 0 */
    material.double_sided = numbers->double_sided != 0;
    material.unlit = numbers->unlit != 0;
    material.cloth = numbers->cloth;
    material.measured = numbers->measured;
    for (int k = 0; k < WEFT_HAIR_NUMBERS; k++)
        material.hair[k] = fminf(fmaxf(numbers->hair[k], hair_infos[k].hard_low), hair_infos[k].hard_high);
    for (int k = 0; k < CHOICE_COUNT; k++)
        if (is_choice(k, numbers->choices[k])) material.choices[k] = numbers->choices[k];
    for (int k = 0; k < INPUT_COUNT; k++) {
        Input *input = &material.inputs[k];
        *input = numbers->inputs[k];
        input->texcoord = input->texcoord == 1;
        input->channel &= 3;
        input->given = input->given != 0;
        for (int c = 0; c < 3; c++)
            input->value[c] = c < input_value_count((InputId)k) ? input_clamped((InputId)k, input->value[c]) : 0.0f;
    }
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
            return fail(error, WEFT_MESSAGE_PARAM_VALUE, weft_material_choice_name(k), "it has no value of number %d",
                        m->choices[k]);
    for (int k = 0; k < WEFT_HAIR_NUMBERS; k++)
        if (!isfinite(m->hair[k])) return fail(error, WEFT_MESSAGE_PARAM_VALUE, hair_infos[k].name, "it is not finite");
    for (int k = 0; k < INPUT_COUNT; k++)
        if (!all_finite(m->inputs[k].value, input_value_count((InputId)k)))
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
    if (!isfinite(m->alpha_cutoff)) return fail(error, WEFT_MESSAGE_PARAM_VALUE, "alpha_cutoff", "it is not finite");
    if (m->cloth < 0 || m->cloth > scene->cloth_count)
        return fail(error, WEFT_MESSAGE_PARAM_VALUE, "cloth", "there is no such cloth");
    if (m->measured < 0 || m->measured > scene->measured_count)
        return fail(error, WEFT_MESSAGE_PARAM_VALUE, "measured", "there is no such measurement");
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
    return fail(error, WEFT_MESSAGE_MATERIAL_NAME, number, "%s", scene_names(scene, weft_scene_material_name, names));
}

WeftResult weft_scene_material(const WeftScene *scene, int index, WeftMaterial *out, WeftError *error) {
    memset(out, 0, sizeof *out);
    if (index < 0 || index >= scene_own_materials(scene)) return no_material(scene, index, error);
    *out = relief_given(scene, index);
    return WEFT_OK;
}

WeftResult weft_scene_put_material(WeftScene *scene, int index, const WeftMaterial *numbers, WeftError *error) {
    if (index < 0 || index >= scene_own_materials(scene)) return no_material(scene, index, error);
    WeftResult result = check_numbers(scene, numbers, error);
    if (result != WEFT_OK) return result;
    Material before = scene->materials[index];
    scene->materials[index] = material_sound(numbers);
    result = materials_complete(scene, error);
    if (result != WEFT_OK) scene->materials[index] = before;
    return result;
}

WeftResult weft_scene_put_measured(WeftScene *scene, int index, const char *path, WeftError *error) {
    Measured *measured;
    if (index < 0 || index >= scene_own_materials(scene)) return no_material(scene, index, error);
    WeftResult result = scene_measured_read(path, &measured, error);
    if (result != WEFT_OK) return result;
    Material material = relief_given(scene, index);
    material.measured = scene_adopt_measured(scene, measured);
    if (material.measured) return weft_scene_put_material(scene, index, &material, error);
    scene_measured_free(measured);
    return fail(error, WEFT_MESSAGE_MEMORY, path, NULL);
}

void weft_material_choose(WeftMaterial *numbers, int choice, int value) {
    if (choice < 0 || choice >= CHOICE_COUNT || !is_choice(choice, value)) return;
    material_choose(numbers, (ChoiceId)choice, value);
}

static void check_fitted(const Material *material, const char *name, const WeftLog *log) {
    const Choices choices = material_choices(material);
    Surface surface = material_plain(material);
    Stack stack;
    if (material->inputs[INPUT_sheen_roughness].texture) surface.sheen_roughness = 0.0f;
    stack_make(&stack, &surface, &choices, (TableRef){.kind = TABLE_NONE});
    if (HAS_LAYERED_SHEEN(&stack)) lobe_fitted(&stack.sheen.lobe, name, log);
}

/* Warns of glass that the profile or workflow of a material shows as opaque. */
static void check_glass(const Material *material, const char *name, const WeftLog *log) {
    const ChoiceId by = material->choices[CHOICE_profile] > 0 ? CHOICE_profile : CHOICE_workflow;
    Material plain = *material;
    plain.choices[CHOICE_profile] = plain.choices[CHOICE_workflow] = CHOICE_AUTO;
    if (material->choices[by] < 0 || material->unlit) return;
    if (material_has_glass(&plain) && !material_has_glass(material))
        warn(log, WEFT_MESSAGE_GLTF_WARN_IGNORED, name, "its transmission: %s %s shows no glass",
             weft_material_choice_name((int)by), choice_id(by, material->choices[by]));
}

void weft_material_fitted(const WeftMaterial *numbers, const char *name, const WeftLog *log) {
    const Material material = material_sound(numbers);
    check_fitted(&material, name, log);
    check_glass(&material, name, log);
}

void weft_material_plausible(const WeftMaterial *numbers, const char *name, const WeftLog *log) {
    Material material = material_sound(numbers);
    check_fitted(&material, name, log);
    check_glass(&material, name, log);
    plausible_check_all(&material, name, log);
    for (int k = 0; k < INPUT_COUNT; k++) {
        const WeftInputInfo *info = &input_infos[k];
        if (info->kind == WEFT_INPUT_DIRECTION || numbers->inputs[k].texture || !weft_material_reads(numbers, k))
            continue;
        float unit = info->kind == WEFT_INPUT_ANGLE ? 180.0f / PI_FLOAT : 1.0f;
        float slack = 1e-5f * fmaxf(fabsf(info->low), fabsf(info->high)); /* degrees that were radians */
        for (int c = 0; c < input_value_count((InputId)k); c++) {
            float value = material.inputs[k].value[c] * unit;
            if (value >= info->low - slack && value <= info->high + slack) continue;
            warn(log, WEFT_MESSAGE_PARAM_RANGE, name, "%s %g is not in %g .. %g", info->name, (double)value,
                 (double)info->low, (double)info->high);
            break;
        }
    }
}
