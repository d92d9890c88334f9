/* plausible.c - limits of real materials, as data for warnings: reflectances and colours of the chart's
 * dielectrics and metals, no diffuse on a metal, no sheen out of nothing */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/fail.h"
#include "scene/material/set.h"
#include "scene/record/material_at.h"
#include "shading/material/choice.h"
#include "shading/workflows/disney.h"
#include "shading/workflows/metallic.h"
#include "weft/chart.h"

/* F0 above this is taken for a metal's: the chart's dielectrics end at 0.172, its metals begin at 0.504. */
#define METAL_F0 0.2f

/* A measure returns this where it has nothing to judge. */
#define NOTHING NAN

/* Returns F0 of a dielectric. An F0 of 0 is a highlight that was switched off, as in workflow cloth, and is not judged. */
static float f0_judged(float f0) { return f0 > 0.0f ? f0 : NOTHING; }
/* Returns F0 in workflow metallic. `specular` and its colour may dim it below that of any dielectric, as gaps between
 * threads do, but not raise it. */
static float f0_metallic(Surface s) {
    float whole = dielectric_f0(&s), left = rgb_max3(metallic_f0(&s));
    return s.metallic < 1.0f ? f0_judged(fmaxf(left, fminf(whole, DIELECTRIC_HIGH))) : NOTHING;
}
static float f0_disney(Surface s) { return s.metallic < 1.0f ? f0_judged(0.08f * s.specular) : NOTHING; }
static Rgb specular_f0(Surface s) { return rgb_scale(s.specular_color, s.specular); }
static bool specular_is_metal(Surface s) { return rgb_max3(specular_f0(s)) > METAL_F0; }
static float f0_specular(Surface s) { return specular_is_metal(s) ? NOTHING : f0_judged(rgb_max3(specular_f0(s))); }

/* Returns the distance between the channels of a dielectric's F0, as a fraction of the strongest of them. */
static float spread(Rgb f0) {
    float most = rgb_max3(f0), least = fminf(f0.r, fminf(f0.g, f0.b));
    return most > 0.0f ? (most - least) / most : NOTHING;
}
static float spread_metallic(Surface s) { return s.metallic < 1.0f ? spread(metallic_f0(&s)) : NOTHING; }
static float spread_disney(Surface s) {
    Rgb tint = rgb_mix(rgb_grey(1.0f), disney_tint(s.base_color), s.specular_tint);
    return s.metallic < 1.0f && s.specular > 0.0f ? spread(tint) : NOTHING;
}
static float spread_specular(Surface s) { return specular_is_metal(s) ? NOTHING : spread(specular_f0(s)); }

static float metal_metallic(Surface s) { return s.metallic < 1.0f ? NOTHING : rgb_max3(s.base_color); }
static float metal_specular(Surface s) {
    return specular_is_metal(s) ? fminf(rgb_max3(specular_f0(s)), 1.0f) : NOTHING;
}

static float albedo(Surface s) { return rgb_max3(s.base_color); }
static float albedo_metallic(Surface s) { return s.metallic < 1.0f ? albedo(s) : NOTHING; }
static float albedo_specular(Surface s) { return specular_is_metal(s) ? NOTHING : albedo(s); }

static float in_between(Surface s) { return fminf(s.metallic, 1.0f - s.metallic); }
static float diffuse_on_metal(Surface s) { return specular_is_metal(s) ? rgb_max3(s.base_color) : NOTHING; }

/* Ranges of measures. The first three are read from the chart: F0 of its dielectrics but gems, widened
 * to the ends of the slider `reflectance`; the strongest channel of its metals, to 1; up to its brightest
 * diffuse colour. Its dielectrics are grey, with a tenth of tolerance. */
typedef enum Kept { KEPT_DIELECTRIC, KEPT_METAL, KEPT_ALBEDO, KEPT_GREY, KEPT_NONE } Kept;

typedef struct PlausibleRange {
    float low, high;
} PlausibleRange;

static float strongest(const float color[3]) { return fmaxf(color[0], fmaxf(color[1], color[2])); }

static PlausibleRange range_of(Kept kept) {
    PlausibleRange range = {0.0f, kept == KEPT_GREY ? 0.1f : 0.0f};
    if (kept == KEPT_DIELECTRIC) range = (PlausibleRange){DIELECTRIC_LOW, DIELECTRIC_HIGH};
    if (kept == KEPT_METAL) range = (PlausibleRange){1.0f, 1.0f};
    const WeftChartEntry *entry;
    for (int k = 0; (entry = weft_chart(k)); k++) {
        bool metal = entry->kind == WEFT_CHART_METAL, gem = entry->kind == WEFT_CHART_GEM;
        if (kept == KEPT_DIELECTRIC && !metal && !gem) {
            range.low = fminf(range.low, entry->f0[0]);
            range.high = fmaxf(range.high, entry->f0[0]);
        }
        if (kept == KEPT_METAL && metal) range.low = fminf(range.low, strongest(entry->f0));
        if (kept == KEPT_ALBEDO && entry->kind == WEFT_CHART_OPAQUE)
            range.high = fmaxf(range.high, strongest(entry->base_color));
    }
    return range;
}

/* Returns the entry of the chart that is nearest to a measure; NULL if the chart has no such measure. */
static const WeftChartEntry *nearest_of(Kept kept, float found, float *has) {
    const WeftChartEntry *entry, *best = NULL;
    for (int k = 0; kept <= KEPT_ALBEDO && (entry = weft_chart(k)); k++) {
        bool metal = entry->kind == WEFT_CHART_METAL, opaque = entry->kind == WEFT_CHART_OPAQUE;
        if (kept == KEPT_ALBEDO ? !opaque : metal != (kept == KEPT_METAL)) continue;
        float its = strongest(kept == KEPT_ALBEDO ? entry->base_color : entry->f0);
        if (best && fabsf(its - found) >= fabsf(*has - found)) continue;
        best = entry;
        *has = its;
    }
    return best;
}

enum { LIMIT_WORKFLOWS = 2, LIMIT_INPUTS = 5 };

/* A measure of materials of some workflows; it depends on some inputs. Nothing is said of an input that a
 * texture gives. */
typedef struct Limit {
    const char *workflows[LIMIT_WORKFLOWS]; /* beyond the last: NULL */
    int inputs[LIMIT_INPUTS];               /* beyond the last: -1 */
    float (*measure)(Surface s);
    Kept kept;
    const char *what; /* the measure %g in words */
} Limit;

#define INPUTS_1(a)                                                                                                    \
    { INPUT_##a, -1, -1, -1, -1 }
#define INPUTS_2(a, b)                                                                                                 \
    { INPUT_##a, INPUT_##b, -1, -1, -1 }
#define INPUTS_3(a, b, c)                                                                                              \
    { INPUT_##a, INPUT_##b, INPUT_##c, -1, -1 }
#define INPUTS_5(a, b, c, d, e)                                                                                        \
    { INPUT_##a, INPUT_##b, INPUT_##c, INPUT_##d, INPUT_##e }

static const char reflectance[] = "reflectance of a dielectric",
                  colored[] = "coloured reflectance of a dielectric, "
                              "whose channels differ by",
                  metal[] = "reflectance of a metal", diffuse[] = "diffuse colour";

static const Limit limits[] = {
    {{"metallic"},
     INPUTS_5(ior, reflectance, specular, specular_color, metallic),
     f0_metallic,
     KEPT_DIELECTRIC,
     reflectance},
    {{"disney"}, INPUTS_2(specular, metallic), f0_disney, KEPT_DIELECTRIC, reflectance},
    {{"specular", "free"}, INPUTS_2(specular, specular_color), f0_specular, KEPT_DIELECTRIC, reflectance},
    {{"metallic"}, INPUTS_3(specular, specular_color, metallic), spread_metallic, KEPT_GREY, colored},
    {{"disney"}, INPUTS_3(specular_tint, base_color, metallic), spread_disney, KEPT_GREY, colored},
    {{"specular", "free"}, INPUTS_2(specular, specular_color), spread_specular, KEPT_GREY, colored},
    {{"metallic", "disney"}, INPUTS_1(metallic), in_between, KEPT_NONE, "between dielectric and metal by"},
    {{"metallic", "disney"}, INPUTS_2(base_color, metallic), metal_metallic, KEPT_METAL, metal},
    {{"specular", "free"}, INPUTS_2(specular, specular_color), metal_specular, KEPT_METAL, metal},
    {{"specular", "free"},
     INPUTS_3(base_color, specular_color, specular),
     diffuse_on_metal,
     KEPT_NONE,
     "diffuse colour of a metal"},
    {{"metallic", "disney"}, INPUTS_1(base_color), albedo_metallic, KEPT_ALBEDO, diffuse},
    {{"specular", "free"}, INPUTS_1(base_color), albedo_specular, KEPT_ALBEDO, diffuse},
    {{"cloth"}, INPUTS_1(base_color), albedo, KEPT_ALBEDO, diffuse},
};

/* Returns true if an input other than a colour on which the albedo of base or sheen depends has a texture. */
static bool is_shaped_by_texture(const Material *material) {
    bool shaped = false;
    for (int k = 0; k < INPUT_COUNT; k++)
        shaped |= material->inputs[k].texture && input_infos[k].kind != WEFT_INPUT_COLOR &&
                  input_roles[k] != ROLE_NONE && input_roles[k] != ROLE_WHOLE;
    return shaped;
}

/* Adds E of a slot towards a direction. */
static void slot_add(const Slot *slot, float cos_o, float sum[3]) {
    WeftLobe lobe = {.lobe = slot->lobe.id,
                     .f0 = {slot->f0.r, slot->f0.g, slot->f0.b},
                     .f90 = {slot->f90.r, slot->f90.g, slot->f90.b}};
    float e[3];
    memcpy(lobe.params, slot->lobe.params, sizeof lobe.params);
    weft_lobe_albedo(&lobe, cos_o, e);
    for (int c = 0; c < 3; c++) sum[c] += e[c];
}

/* Returns true if base and sheen side by side return no more than they receive. Textures of colours only darken;
 * with one of any other input nothing is known. */
static bool sums_to_one(const Material *material) {
    static const float cosines[] = {1.0f, 0.8f, 0.6f, 0.4f, 0.3f, 0.2f, 0.12f, 0.07f, 0.04f, 0.02f, 0.01f};
    const Surface surface = material_plain(material);
    const Choices choices = material_choices(material);
    Stack stack;
    if (is_shaped_by_texture(material)) return false;
    stack_make(&stack, &surface, &choices, (TableRef){.kind = TABLE_NONE});
    if (HAS_COAT(&stack) || weft_lobe_info(stack.sheen.lobe.id)->traits & WEFT_LOBE_REFERENCE) return false;
    for (size_t k = 0; k < sizeof cosines / sizeof *cosines; k++) {
        float sum[3] = {0.0f};
        if (HAS_DIFFUSE(&stack)) slot_add(&stack.diffuse, cosines[k], sum);
        const Rgb through = stack.transmitted;
        const Rgb glass = rgb_mul(stack.glass_tint, stack_one_minus(stack.interface_f0));
        sum[0] += through.r + glass.r, sum[1] += through.g + glass.g, sum[2] += through.b + glass.b;
        if (HAS_SPECULAR(&stack)) slot_add(&stack.specular, cosines[k], sum);
        if (HAS_SHEEN(&stack)) slot_add(&stack.sheen, cosines[k], sum);
        if (!(fmaxf(sum[0], fmaxf(sum[1], sum[2])) <= 1.0f)) return false;
    }
    return true;
}

/* Choices that may gain energy; the first does not where what it adds is dark. */
static const struct {
    ChoiceId choice;
    const char *id, *text;
} gains[] = {
    {CHOICE_layer, "additive", "the base loses nothing to the sheen: more light may leave than came"},
    {CHOICE_layer, "multiplicative", "the sheen adds to the base: more light may leave than came"},
    {CHOICE_layer, "seed", "its F is that at wi . h alone: at grazing more light may leave than came"},
    {CHOICE_layer, "albedo-min", "the base loses too little to the sheen: more light may leave than came"},
    {CHOICE_workflow, "free", "nothing takes from anything: more light may leave than came"},
};

static bool concerns(const Limit *limit, int input) {
    bool named = false;
    for (int k = 0; k < LIMIT_INPUTS && limit->inputs[k] >= 0; k++) named |= limit->inputs[k] == input;
    return named;
}

/* Returns true if the limit applies to this material: to its workflow, and if the input has no texture. */
static bool applies(const Limit *limit, const Material *material) {
    int workflow = material->choices[CHOICE_workflow] == CHOICE_AUTO ? 0 : material->choices[CHOICE_workflow];
    const char *id = choice_id(CHOICE_workflow, workflow);
    bool textured = false, meant = false;
    for (int k = 0; k < LIMIT_INPUTS && limit->inputs[k] >= 0; k++)
        textured |= material->inputs[limit->inputs[k]].texture != 0;
    for (int k = 0; k < LIMIT_WORKFLOWS && limit->workflows[k]; k++)
        meant |= id && strcmp(id, limit->workflows[k]) == 0;
    return meant && !textured;
}

static void check_limit(const Limit *limit, const Material *material, const char *target, const WeftLog *log) {
    if (!applies(limit, material)) return;
    float found = limit->measure(material_plain(material)), has = 0.0f;
    PlausibleRange range = range_of(limit->kept);
    if (!(found < range.low - 1e-6f || found > range.high + 1e-6f)) return; /* nor where it is NOTHING */
    const WeftChartEntry *nearest = nearest_of(limit->kept, found, &has);
    if (nearest)
        warn(log, WEFT_MESSAGE_PLAUSIBLE, target, "%s %.3g, not in %.3g .. %.3g; nearest in the chart: %s, %.3g",
             limit->what, (double)found, (double)range.low, (double)range.high, nearest->name, (double)has);
    else if (range.low < range.high)
        warn(log, WEFT_MESSAGE_PLAUSIBLE, target, "%s %.3g of the strongest; only metals reflect in colour",
             limit->what, (double)found);
    else
        warn(log, WEFT_MESSAGE_PLAUSIBLE, target, "%s %.3g, not 0", limit->what, (double)found);
}

static void check_gains(const Material *material, int choice, const char *target, const WeftLog *log) {
    for (size_t k = 0; k < sizeof gains / sizeof *gains; k++) {
        const char *id = choice_id((ChoiceId)choice, material->choices[choice]);
        bool chosen = (int)gains[k].choice == choice && id && strcmp(id, gains[k].id) == 0;
        if (chosen && !(k == 0 && sums_to_one(material)))
            warn(log, WEFT_MESSAGE_PLAUSIBLE, target, "%s: %s", id, gains[k].text);
    }
}

void plausible_check(const Material *material, int input, int choice, const char *target, const WeftLog *log) {
    for (size_t k = 0; input >= 0 && k < sizeof limits / sizeof *limits; k++)
        if (concerns(&limits[k], input)) check_limit(&limits[k], material, target, log);
    if (choice >= 0) check_gains(material, choice, target, log);
}

/* Returns the first of a limit's inputs that is named; -1: none. */
static int first_named(const Limit *limit, const bool *named) {
    for (int k = 0; k < LIMIT_INPUTS && limit->inputs[k] >= 0; k++)
        if (named[limit->inputs[k]]) return limit->inputs[k];
    return -1;
}

void plausible_check_named(const Material *material, const bool *named, const char *file, const WeftLog *log) {
    for (size_t k = 0; k < sizeof limits / sizeof *limits; k++) {
        const int input = first_named(&limits[k], named);
        char target[160];
        if (input < 0) continue;
        snprintf(target, sizeof target, "%.120s: %s", file, input_infos[input].name);
        check_limit(&limits[k], material, target, log);
    }
}

void plausible_check_all(const Material *material, const char *target, const WeftLog *log) {
    for (size_t k = 0; k < sizeof limits / sizeof *limits; k++) check_limit(&limits[k], material, target, log);
    for (int k = 0; k < CHOICE_COUNT; k++) check_gains(material, k, target, log);
}
