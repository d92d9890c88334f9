#include "scene/save/u3m_look.h"

#include <math.h>
#include <string.h>

#include "base/equal.h"
#include "base/fail.h"
#include "scene/record/material_at.h"
#include "shading/material/choice.h"
#include "shading/stack/workflow.h"

#define SPECULAR_MOST 0.08f /* reflectance where specular_value is 1 */

static bool is_chosen(const Material *material, ChoiceId choice, const char *id) {
    const char *chosen = choice_id(choice, material->choices[choice]);
    return chosen && strcmp(chosen, id) == 0;
}

/* Returns true if a material is of the principled shader already. */
static bool is_principled(const Material *material) {
    return material->choices[CHOICE_profile] >= 0 ? is_chosen(material, CHOICE_profile, "disney-2012")
                                                  : is_chosen(material, CHOICE_workflow, "disney");
}

static float luminance(const float v[3]) { return 0.2126f * v[0] + 0.7152f * v[1] + 0.0722f * v[2]; }

/* Returns the share t of the base colour's hue in a colour: the least squares of mix(1, tint, t) and the hue. */
static float tint_share(const float color[3], const float base[3]) {
    const float y = luminance(color), yb = luminance(base);
    float over = 0.0f, under = 0.0f;
    for (int c = 0; c < 3 && y > 0.0f && yb > 0.0f; c++) {
        const float tint = base[c] / yb - 1.0f;
        over += (color[c] / y - 1.0f) * tint;
        under += tint * tint;
    }
    return under > 1e-6f ? fminf(fmaxf(over / under, 0.0f), 1.0f) : 0.0f;
}

/* Makes the number of an input of the luminance of a colour, times a factor. */
static void take_luminance(U3mLook *look, InputId to, const Input *color, float factor) {
    Input *input = &look->material.inputs[to];
    *input = *color;
    input->value[0] = factor * luminance(color->value);
    input->value[1] = input->value[2] = 0.0f;
    look->luminance[to] = input->texture != 0;
}

static void set_number(Material *material, InputId id, float x) {
    Input *input = &material->inputs[id];
    input->value[0] = x;
    input->texture = 0;
}

U3mLook u3m_look(const Material *given) {
    U3mLook look = {.material = *given, .gloss = is_principled(given)};
    Material *m = &look.material;
    if (look.gloss) return look;
    const Surface plain = {.ior = given->inputs[INPUT_ior].value[0],
                           .reflectance = given->inputs[INPUT_reflectance].value[0]};
    const Input *sheen = &given->inputs[INPUT_sheen_color];
    material_choose(m, CHOICE_workflow, choice_find(CHOICE_workflow, "disney"));
    if (is_chosen(given, CHOICE_workflow, "specular")) {
        take_luminance(&look, INPUT_specular, &given->inputs[INPUT_specular_color], 1.0f / SPECULAR_MOST);
        set_number(m, INPUT_metallic, 0.0f);
    } else {
        m->inputs[INPUT_specular] = given->inputs[INPUT_specular];
        m->inputs[INPUT_specular].value[0] *= dielectric_f0(&plain) / SPECULAR_MOST;
    }
    take_luminance(&look, INPUT_sheen, sheen, given->inputs[INPUT_sheen].value[0]);
    set_number(m, INPUT_sheen_tint, tint_share(sheen->value, given->inputs[INPUT_base_color].value));
    set_number(m, INPUT_specular_tint, 0.0f);
    set_number(m, INPUT_subsurface, 0.0f);
    return look;
}

/* Inputs that a U3M says; the others are lost if they are not at their defaults. */
static const InputId said[] = {INPUT_base_color,          INPUT_opacity,     INPUT_metallic,
                               INPUT_roughness,           INPUT_normal,      INPUT_specular,
                               INPUT_anisotropy,          INPUT_clearcoat,   INPUT_anisotropy_direction,
                               INPUT_clearcoat_normal,    INPUT_sheen_color, INPUT_sheen,
                               INPUT_reflectance,         INPUT_ior,         INPUT_clearcoat_roughness,
                               INPUT_diffuse_transmission};
static const InputId said_principled[] = {INPUT_specular_tint, INPUT_sheen_tint, INPUT_subsurface,
                                          INPUT_clearcoat_gloss};

static bool is_said(const Material *material, InputId id) {
    for (size_t k = 0; k < sizeof said / sizeof *said; k++)
        if (said[k] == id) return true;
    for (size_t k = 0; k < sizeof said_principled / sizeof *said_principled && is_principled(material); k++)
        if (said_principled[k] == id) return true;
    return id == INPUT_specular_color && is_chosen(material, CHOICE_workflow, "specular");
}

/* Returns true if an input changes how the material looks, and nothing of it is written. */
static bool is_lost(const Material *material, const Material *fresh, int id) {
    const Input *input = &material->inputs[id];
    bool differs = input->texture != 0;
    for (int c = 0; c < input_value_count((InputId)id); c++)
        differs |= !is_equal(input->value[c], fresh->inputs[id].value[c]);
    if (!differs || is_said(material, (InputId)id)) return false;
    if (id == INPUT_occlusion) return input->texture != 0;
    if (id == INPUT_emission_strength) return false; /* of emission */
    return id == INPUT_emission || weft_material_reads(material, id);
}

/* Returns the greatest difference of a colour's channels, as a part of the strongest. */
static float saturation(const float v[3]) {
    const float most = fmaxf(v[0], fmaxf(v[1], v[2])), least = fminf(v[0], fminf(v[1], v[2]));
    return most > 0.0f ? (most - least) / most : 0.0f;
}

static void models_lost(const Material *material, const char *name, const WeftLog *log) {
    const bool sheen = luminance(material->inputs[INPUT_sheen_color].value) > 0.0f;
    if (!is_principled(material))
        warn(log, WEFT_MESSAGE_GLTF_WARN_IGNORED, name,
             "its own shading: U3M has the principled shader, so that the same numbers look otherwise");
    for (int k = 0; k < CHOICE_COUNT && is_principled(material); k++)
        if (material->choices[k] >= 0 && k != CHOICE_workflow && k != CHOICE_profile)
            warn(log, WEFT_MESSAGE_GLTF_WARN_IGNORED, name, "its %s: U3M has the principled shader's",
                 weft_material_choice_name(k));
    if (!is_principled(material) && sheen && saturation(material->inputs[INPUT_sheen_color].value) > 0.05f)
        warn(log, WEFT_MESSAGE_GLTF_WARN_IGNORED, name,
             "the hue of sheen_color: a U3M's sheen is white or of the base colour");
    if (is_chosen(material, CHOICE_workflow, "specular") &&
        saturation(material->inputs[INPUT_specular_color].value) > 0.05f)
        warn(log, WEFT_MESSAGE_GLTF_WARN_IGNORED, name, "the hue of specular_color: a U3M has a number for it");
}

void u3m_look_lost(const Material *material, const char *name, const WeftLog *log) {
    Material fresh = material_default();
    for (int k = 0; k < CHOICE_COUNT; k++) material_choose(&fresh, (ChoiceId)k, material->choices[k]);
    models_lost(material, name, log);
    for (int k = 0; k < INPUT_COUNT; k++)
        if (is_lost(material, &fresh, k))
            warn(log, WEFT_MESSAGE_GLTF_WARN_IGNORED, name, "%s: U3M has no word for it", input_infos[k].name);
    if (material->alpha_mode == WEFT_ALPHA_MASK)
        warn(log, WEFT_MESSAGE_GLTF_WARN_IGNORED, name, "the cut-out at an opacity of %g: U3M's alpha blends",
             (double)material->alpha_cutoff);
    if (material->unlit) warn(log, WEFT_MESSAGE_GLTF_WARN_IGNORED, name, "its unlit look: U3M has no word for it");
    if (material->cloth)
        warn(log, WEFT_MESSAGE_GLTF_WARN_IGNORED, name,
             "its threads: a U3M has their construction; weft weave --bake makes pictures of them");
    if (material->measured) warn(log, WEFT_MESSAGE_GLTF_WARN_IGNORED, name, "its measurement: its numbers are written");
    if (material->hair[WEFT_HAIR_LENGTH] > 0.0f)
        warn(log, WEFT_MESSAGE_GLTF_WARN_IGNORED, name, "its hair: U3M has no word for it");
}
