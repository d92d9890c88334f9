#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "base/fail.h"
#include "base/memory.h"
#include "brdf/measured.h"
#include "measure/bsdf/halton.h"
#include "measure/bsdf/reflection.h"
#include "measure/bsdf/weave_sum.h"
#include "scene/material/material_numbers.h"
#include "scene/record/material_at.h"
#include "shading/dialect/warp.h"
#include "shading/material/choice.h"
#include "shading/material/dust.h"
#include "shading/stack/frame.h"
#include "weft/fit.h"
#include "weft/reflection.h"

/* WALKS: of layer rule stochastic, for one pair of directions. DRAWS: directions for E. */
enum { WALKS = 16, DRAWS = 1024 };

/* A material as a whole. */
typedef struct Whole {
    Surface surface;
    Choices choices;
    Dir along; /* x of the shading frame, in the caller's frame */
    TableRef table;
    AlbedoTable *own;
    WeaveSum sum;
} Whole;

typedef enum ReflectionKind { REFLECTION_WHOLE, REFLECTION_LOBE, REFLECTION_MEASURED } ReflectionKind;

struct WeftReflection {
    ReflectionKind kind;
    Whole whole;
    WeftLobe lobe, under; /* under: a second lobe, which is added if `based` */
    bool based;
    Measured measured;
};

/* Returns true if E of the sheen comes from a table of its lobe, and sets the stack that reads it. Tables of
 * engines are made beforehand. */
static bool needs_table(const Whole *self, Stack *stack) {
    stack_make(stack, &self->surface, &self->choices, (TableRef){.kind = TABLE_NONE});
    if (!HAS_SHEEN(stack) && stack->layer != LAYER_MULTIPLICATIVE) return false;
    if (albedo_is_own(stack->albedo)) return true;
    stack_albedo(stack, dir(0.0f, 0.0f, 1.0f));
    return false;
}

static bool make_table(Whole *self) {
    Stack stack;
    if (!needs_table(self, &stack)) return true;
    self->own = alloc_array(1, sizeof *self->own);
    if (!self->own) return false;
    albedo_table_fill(self->own, &stack.sheen.lobe, stack.albedo_coord, stack.albedo_coord, 0);
    self->table = albedo_table_ref(self->own);
    return true;
}

static void whole_set(Whole *self, const Material *material) {
    Surface surface = material_plain(material);
    surface.dust_noise = 0.0f;
    self->along = surface.anisotropy > 0.0f ? surface.anisotropy_direction : dir(1.0f, 0.0f, 0.0f);
    self->surface = dust_accumulate(frame_surface(surface), dust_source(surface), dir(0.0f, 0.0f, 0.0f));
    self->choices = material_choices(material);
    self->table = (TableRef){.kind = TABLE_NONE};
    self->sum = weave_sum_of(NULL);
}

static bool whole_make(Whole *self, const Material *material) {
    whole_set(self, material);
    return make_table(self);
}

/* Widens low .. high to the range of the parameter of E when roughnesses run from 0 to 1. */
static void widest(const Whole *self, float *low, float *high) {
    for (int ends = 0; ends < 4; ends++) {
        Whole end = *self;
        Stack stack;
        end.surface.sheen_roughness = end.surface.fuzz_roughness = ends & 1 ? 1.0f : 0.0f;
        end.surface.roughness = ends & 2 ? 1.0f : 0.0f;
        needs_table(&end, &stack);
        *low = fminf(*low, stack.albedo_coord);
        *high = fmaxf(*high, stack.albedo_coord);
    }
}

void reflection_change(WeftReflection *self, const WeftMaterial *material, AlbedoTable *shared) {
    Stack stack;
    const Material taken = material_sound(material);
    whole_set(&self->whole, &taken);
    if (!needs_table(&self->whole, &stack) || stack.layer == LAYER_ADDITIVE) return;
    float low = stack.albedo_coord, high = stack.albedo_coord;
    widest(&self->whole, &low, &high);
    if (!shared->rows || !albedo_table_serves(shared, &stack.sheen.lobe, low, high, false))
        albedo_table_fill(shared, &stack.sheen.lobe, low, high, 0);
    self->whole.table = albedo_table_ref(shared);
}

static WeftReflection *reflection_of_kind(ReflectionKind kind, WeftReflection **out, WeftError *error) {
    *out = alloc_array(1, sizeof **out);
    if (!*out) {
        fail(error, WEFT_MESSAGE_MEMORY, "a reflection", NULL);
        return NULL;
    }
    **out = (WeftReflection){.kind = kind};
    return *out;
}

/* Passes the result on, and frees the reflection after a failure. */
static WeftResult finish(WeftReflection **out, WeftResult result) {
    if (result == WEFT_OK) return WEFT_OK;
    weft_reflection_free(*out);
    *out = NULL;
    return result;
}

WeftResult weft_reflection_create(const WeftMaterial *material, WeftReflection **out, WeftError *error) {
    return weft_reflection_create_woven(material, NULL, out, error);
}

WeftResult weft_reflection_create_woven(const WeftMaterial *material, const WeftCloth *cloth, WeftReflection **out,
                                        WeftError *error) {
    *out = NULL;
    WeftResult result = numbers_sound(material, error);
    if (result != WEFT_OK) return result;
    if (!reflection_of_kind(REFLECTION_WHOLE, out, error)) return WEFT_RESOURCES;
    const Material taken = material_sound(material);
    if (!whole_make(&(*out)->whole, &taken)) result = fail(error, WEFT_MESSAGE_MEMORY, "a reflection", NULL);
    (*out)->whole.sum = weave_sum_of(cloth);
    return finish(out, result);
}

WeftResult weft_reflection_of_lobe(const WeftLobe *lobe, WeftReflection **out, WeftError *error) {
    char number[16];
    *out = NULL;
    snprintf(number, sizeof number, "%d", lobe->lobe);
    if (!weft_lobe_info(lobe->lobe)) return fail(error, WEFT_MESSAGE_LOBE_NAME, number, NULL);
    if (!reflection_of_kind(REFLECTION_LOBE, out, error)) return WEFT_RESOURCES;
    (*out)->lobe = *lobe;
    return WEFT_OK;
}

/* Returns the lobe of a system, with both colours. */
static WeaveBase fitted_threads(const WeftLobe *lobe) {
    WeaveBase threads = {.single = rgb(lobe->f0[0], lobe->f0[1], lobe->f0[2]),
                         .multiple = rgb(lobe->f90[0], lobe->f90[1], lobe->f90[2])};
    lobe_of(lobe, &threads.lobe);
    return threads;
}

WeftResult weft_fitted_reflection(const WeftFitted *fitted, WeftReflection **out, WeftError *error) {
    WeftMaterial bare;
    const bool woven = weft_fitted_is_weave(fitted) != 0;
    weft_material_default(&bare);
    WeftResult result =
        woven ? weft_reflection_create(&bare, out, error) : weft_reflection_of_lobe(&fitted->lobe, out, error);
    if (!*out) return result;
    (*out)->under = fitted->base;
    (*out)->based = true;
    const WeaveBase threads[2] = {fitted_threads(&fitted->lobe), fitted_threads(&fitted->base)};
    if (woven) (*out)->whole.sum = weave_sum_of_lobes(threads);
    return WEFT_OK;
}

WeftResult weft_reflection_read(const char *path, WeftReflection **out, WeftError *error) {
    if (!reflection_of_kind(REFLECTION_MEASURED, out, error)) return WEFT_RESOURCES;
    return finish(out, measured_read(path, &(*out)->measured, error));
}

void weft_reflection_free(WeftReflection *self) {
    if (!self) return;
    free(self->whole.own);
    measured_free(&self->measured);
    free(self);
}

const char *reflection_walks(const WeftReflection *self) {
    int lobe = -1;
    if (self->kind == REFLECTION_LOBE) lobe = self->lobe.lobe;
    if (self->kind == REFLECTION_WHOLE) {
        Stack stack;
        needs_table(&self->whole, &stack);
        if (HAS_SHEEN(&stack)) lobe = stack.sheen.lobe.id;
    }
    const WeftLobeInfo *info = weft_lobe_info(lobe);
    return info && info->traits & WEFT_LOBE_REFERENCE ? info->id : NULL;
}

Surface reflection_surface(const WeftReflection *self) { return self->whole.surface; }

TableRef reflection_table(const WeftReflection *self) { return self->whole.table; }

static Dir to_frame(const Whole *self, const float w[3]) {
    Dir a = self->along;
    return dir(a.x * w[0] + a.y * w[1], a.x * w[1] - a.y * w[0], w[2]);
}

/* Sees a base of a whole, and what lies on it, from o. */
static void see_base(const Whole *self, int base, Dir o, SeenStack *seen) {
    weave_sum_see(&self->sum, base, &self->surface, &self->choices, self->table, o, seen);
}

static Slots slots_of_part(int part) {
    bool all = part == WEFT_PART_ALL;
    return slots_of(all || part == WEFT_PART_DIFFUSE, all || part == WEFT_PART_SPECULAR, all || part == WEFT_PART_SHEEN,
                    all || part == WEFT_PART_COAT, all || part == WEFT_PART_DUST);
}

/* Returns the value with one base; for a rule that walks at random, the mean of some walks. */
static StackValue value_of(const SeenStack *seen, int part, int base, Dir i, uint32_t first, uint32_t walks) {
    const Stack *stack = &seen->stack;
    StackValue sum = stack_eval_of(stack, &seen->view, weave_sum_slots(base, slots_of_part(part)), i);
    bool walks_at_random = part == WEFT_PART_ALL && stack->layer == LAYER_STOCHASTIC && HAS_SHEEN(stack);
    for (uint32_t k = 0; walks_at_random && i.z > 0.0f && k < walks; k++) {
        Rgb bounces = layer_walk_bounces(stack, &seen->view, slots_all(), i, first + k);
        sum.f_cos = rgb_add(sum.f_cos, rgb_scale(bounces, 1.0f / (float)walks));
    }
    return sum;
}

static void whole_eval(const Whole *self, int part, const float wo[3], int count, const float (*wi)[3], float (*f)[3]) {
    SeenStack seen;
    Dir o = to_frame(self, wo);
    if (!(o.z > 0.0f)) return;
    for (int base = 0; base < self->sum.bases; base++) {
        see_base(self, base, o, &seen);
        for (int k = 0; k < count; k++) {
            Dir i = to_frame(self, wi[k]);
            if (!(i.z > 0.0f)) continue;
            Rgb c = rgb_scale(value_of(&seen, part, base, i, 0, WALKS).f_cos, 1.0f / i.z);
            f[k][0] += c.r, f[k][1] += c.g, f[k][2] += c.b;
        }
    }
}

static void lobes_eval(const WeftReflection *self, const float wo[3], const float wi[3], float f[3]) {
    float below[3];
    weft_lobe_eval(&self->lobe, wo, wi, f);
    if (!self->based) return;
    weft_lobe_eval(&self->under, wo, wi, below);
    for (int c = 0; c < 3; c++) f[c] += below[c];
}

static void lobes_albedo(const WeftReflection *self, float cos_o, float albedo[3]) {
    float below[3];
    weft_lobe_albedo(&self->lobe, cos_o, albedo);
    if (!self->based) return;
    weft_lobe_albedo(&self->under, cos_o, below);
    for (int c = 0; c < 3; c++) albedo[c] += below[c];
}

void weft_reflection_eval(const WeftReflection *self, int part, const float wo[3], int count, const float (*wi)[3],
                          float (*f)[3]) {
    for (int k = 0; k < count; k++) f[k][0] = f[k][1] = f[k][2] = 0.0f;
    if (self->kind == REFLECTION_WHOLE) whole_eval(&self->whole, part, wo, count, wi, f);
    if (self->kind == REFLECTION_WHOLE || part != WEFT_PART_ALL) return;
    for (int k = 0; k < count; k++)
        if (self->kind == REFLECTION_LOBE)
            lobes_eval(self, wo, wi[k], f[k]);
        else
            measured_at(&self->measured, dir(wo[0], wo[1], wo[2]), dir(wi[k][0], wi[k][1], wi[k][2]), f[k]);
}

/* Estimates E by directions distributed like the lobes, so that few are enough however narrow the lobes are. */
static void whole_albedo(const Whole *self, int part, const float wo[3], float albedo[3]) {
    SeenStack seen;
    Dir o = to_frame(self, wo);
    double sum[3] = {0.0};
    for (int base = 0; base < self->sum.bases; base++) {
        see_base(self, base, o, &seen);
        for (uint32_t k = 0; k < DRAWS; k++) {
            Dir i = seen_sample(&seen, ((float)k + 0.5f) / DRAWS, (float)halton((int)k, 2));
            if (!(i.z > 0.0f)) continue;
            float pdf = stack_eval_of(&seen.stack, &seen.view, slots_all(), i).pdf;
            if (!(pdf > 0.0f)) continue;
            Rgb c = rgb_scale(value_of(&seen, part, base, i, k, 1).f_cos, 1.0f / (pdf * DRAWS));
            sum[0] += (double)c.r, sum[1] += (double)c.g, sum[2] += (double)c.b;
        }
    }
    for (int c = 0; c < 3; c++) albedo[c] = (float)sum[c];
}

/* Estimates E by directions from the sampling of the measurement. */
static void measured_albedo(const Measured *measured, const float wo[3], float albedo[3]) {
    const Dir o = dir(wo[0], wo[1], wo[2]);
    double sum[3] = {0.0};
    for (uint32_t k = 0; k < 4 * DRAWS; k++) {
        Dir i = measured_sample(measured, o, ((float)k + 0.5f) / (4 * DRAWS), (float)halton((int)k, 2));
        float f[3], pdf = measured_pdf(measured, o, i);
        if (!(i.z > 0.0f) || !(pdf > 0.0f)) continue;
        measured_at(measured, o, i, f);
        for (int c = 0; c < 3; c++) sum[c] += (double)f[c] * (double)i.z / (double)pdf / (4 * DRAWS);
    }
    for (int c = 0; c < 3; c++) albedo[c] = (float)sum[c];
}

void weft_reflection_albedo(const WeftReflection *self, int part, float cos_o, float albedo[3]) {
    float z = fminf(fmaxf(cos_o, 1e-4f), 1.0f);
    const float wo[3] = {sqrtf(fmaxf(1.0f - z * z, 0.0f)), 0.0f, z};
    albedo[0] = albedo[1] = albedo[2] = 0.0f;
    if (self->kind == REFLECTION_WHOLE) whole_albedo(&self->whole, part, wo, albedo);
    if (part != WEFT_PART_ALL) return;
    if (self->kind == REFLECTION_LOBE) lobes_albedo(self, z, albedo);
    if (self->kind == REFLECTION_MEASURED) measured_albedo(&self->measured, wo, albedo);
}

int weft_reflection_readable(const char *name) { return measured_format(name) != MEASURED_NONE; }
