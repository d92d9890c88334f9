/* plausible.c - what real materials keep to, as data for warnings: reflectances of dielectrics, no diffuse on
 * a metal, no sheen out of nothing */
#include <math.h>
#include <string.h>

#include "base/fail.h"
#include "scene/set.h"
#include "shading/choice.h"
#include "shading/workflow.h"

static float value(const Material *material, InputId input) { return material->inputs[input].value[0]; }

static float greatest(const Material *material, InputId input) {
    const float *v = material->inputs[input].value;
    return fmaxf(v[0], fmaxf(v[1], v[2]));
}

/* Reflectance at normal incidence, of a dielectric and as the workflows have it. */
static float f0_metallic(const Material *material) {
    Surface s = {.ior = value(material, INPUT_ior), .reflectance = value(material, INPUT_reflectance)};
    return dielectric_f0(s);
}
static float f0_disney(const Material *material) { return 0.08f * value(material, INPUT_specular); }
static float f0_specular(const Material *material) {
    return value(material, INPUT_specular) * greatest(material, INPUT_specular_color);
}

static float in_between(const Material *material) {
    float m = value(material, INPUT_metallic);
    return fminf(m, 1.0f - m);
}

/* The diffuse colour beside a reflectance that only metals have. */
static float diffuse_on_metal(const Material *material) {
    return f0_specular(material) > 0.2f ? greatest(material, INPUT_base_color) : 0.0f;
}

/* A measure that should be in low .. high, of materials of one workflow; it depends on up to three inputs.
 * Nothing is said of an input that a texture gives. */
typedef struct Limit {
    const char *workflow;
    int inputs[3]; /* beyond the last: -1 */
    float (*measure)(const Material *material);
    float low, high;
    const char *what; /* the measure %g in words */
} Limit;

static const Limit limits[] = {
    {"metallic",
     {INPUT_ior, INPUT_reflectance, -1},
     f0_metallic,
     DIELECTRIC_LOW,
     DIELECTRIC_HIGH,
     "reflectance of a dielectric"},
    {"disney", {INPUT_specular, -1, -1}, f0_disney, 0.0f, DIELECTRIC_HIGH, "reflectance of a dielectric"},
    {"metallic", {INPUT_metallic, -1, -1}, in_between, 0.0f, 0.0f, "between dielectric and metal by"},
    {"disney", {INPUT_metallic, -1, -1}, in_between, 0.0f, 0.0f, "between dielectric and metal by"},
    {"specular",
     {INPUT_base_color, INPUT_specular_color, INPUT_specular},
     diffuse_on_metal,
     0.0f,
     0.0f,
     "diffuse colour of a metal"},
};

/* Choices that gain energy. */
static const struct {
    ChoiceId choice;
    const char *id, *text;
} gains[] = {
    {CHOICE_layer, "additive", "the base loses nothing to the sheen: more light may leave than came"},
    {CHOICE_layer, "multiplicative", "the sheen adds to the base: more light may leave than came"},
    {CHOICE_layer, "albedo-min", "the base loses too little to the sheen: more light may leave than came"},
    {CHOICE_workflow, "free", "nothing takes from anything: more light may leave than came"},
};

static bool concerns(const Limit *limit, int input) {
    bool named = false;
    for (int k = 0; k < 3 && limit->inputs[k] >= 0; k++) named |= limit->inputs[k] == input;
    return named;
}

/* Whether it speaks of this material: of its workflow, and of numbers alone. */
static bool applies(const Limit *limit, const Material *material) {
    int workflow = material->choices[CHOICE_workflow] == CHOICE_AUTO ? 0 : material->choices[CHOICE_workflow];
    bool textured = false;
    for (int k = 0; k < 3 && limit->inputs[k] >= 0; k++)
        textured |= material->inputs[limit->inputs[k]].texture != 0;
    return !textured && strcmp(choice_id(CHOICE_workflow, workflow), limit->workflow) == 0;
}

static void check_limit(const Limit *limit, const Material *material, const char *target,
                        const WeftLog *log) {
    if (!applies(limit, material)) return;
    float found = limit->measure(material);
    if (found < limit->low - 1e-6f || found > limit->high + 1e-6f)
        warn(log, WEFT_MESSAGE_PLAUSIBLE, target,
             limit->low < limit->high ? "%s %.3g, not in %g .. %g" : "%s %.3g, not %g", limit->what,
             (double)found, (double)limit->low, (double)limit->high);
}

static void check_gains(const Material *material, int choice, const char *target, const WeftLog *log) {
    for (size_t k = 0; k < sizeof gains / sizeof *gains; k++) {
        const char *id = choice_id((ChoiceId)choice, material->choices[choice]);
        if ((int)gains[k].choice == choice && id && strcmp(id, gains[k].id) == 0)
            warn(log, WEFT_MESSAGE_PLAUSIBLE, target, "%s: %s", id, gains[k].text);
    }
}

void plausible_check(const Material *material, int input, int choice, const char *target,
                     const WeftLog *log) {
    for (size_t k = 0; input >= 0 && k < sizeof limits / sizeof *limits; k++)
        if (concerns(&limits[k], input)) check_limit(&limits[k], material, target, log);
    if (choice >= 0) check_gains(material, choice, target, log);
}

void plausible_check_all(const Material *material, const char *target, const WeftLog *log) {
    for (size_t k = 0; k < sizeof limits / sizeof *limits; k++)
        check_limit(&limits[k], material, target, log);
    for (int k = 0; k < CHOICE_COUNT; k++) check_gains(material, k, target, log);
}
