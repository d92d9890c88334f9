#include <math.h>
#include <stdlib.h>

#include "base/fail.h"
#include "base/memory.h"
#include "scene/material_numbers.h"
#include "scene/shade.h"
#include "shading/choice.h"
#include "shading/dust.h"
#include "shading/frame.h"
#include "weft/measure.h"

/* WALKS: of layer rule stochastic for one pair of directions. */
enum { WALKS = 16, DRAWS = 1024 };

struct WeftReflection {
    Surface surface;
    Choices choices;
    Dir along; /* x of the shading frame, told in the caller's */
    TableRef table;
    AlbedoTable *own;
};

/* E of the sheen, where the stack asks for a table of its own; engines' own are made before they are asked.
 */
static bool make_table(WeftReflection *self) {
    Stack stack;
    stack_make(&stack, &self->surface, &self->choices, self->table, dir(0.0f, 0.0f, 1.0f));
    if (!(stack.sheen.pick > 0.0f) && stack.layer != LAYER_MULTIPLICATIVE) return true;
    if (stack.albedo != ALBEDO_TABLE && stack.albedo != ALBEDO_KHRONOS) {
        stack_albedo(stack, dir(0.0f, 0.0f, 1.0f));
        return true;
    }
    self->own = alloc_array(1, sizeof *self->own);
    if (!self->own) return false;
    albedo_table_fill(self->own, &stack.sheen.lobe, stack.at, stack.at, 0);
    self->table = albedo_table_ref(self->own);
    return true;
}

WeftResult weft_reflection_create(const WeftMaterial *material, WeftReflection **out, WeftError *error) {
    *out = NULL;
    WeftResult result = numbers_sound(material, error);
    if (result != WEFT_OK) return result;
    Material taken = material_of_numbers(material);
    WeftReflection *self = alloc_array(1, sizeof *self);
    if (!self) return fail(error, WEFT_MESSAGE_MEMORY, "a reflection", NULL);
    Surface surface = material_plain(&taken);
    surface.dust_noise = 0.0f;
    self->along = surface.anisotropy > 0.0f ? surface.anisotropy_direction : dir(1.0f, 0.0f, 0.0f);
    self->surface = dust_settle(frame_surface(surface), dust_source(surface), dir(0.0f, 0.0f, 0.0f));
    self->choices = material_choices(&taken);
    self->table = (TableRef){.kind = TABLE_NONE};
    if (!make_table(self)) {
        weft_reflection_free(self);
        return fail(error, WEFT_MESSAGE_MEMORY, "a reflection", NULL);
    }
    *out = self;
    return WEFT_OK;
}

void weft_reflection_free(WeftReflection *self) {
    if (!self) return;
    free(self->own);
    free(self);
}

static Dir to_frame(const WeftReflection *self, const float w[3]) {
    Dir a = self->along;
    return dir(a.x * w[0] + a.y * w[1], a.x * w[1] - a.y * w[0], w[2]);
}

static Slots slots_of_part(int part) {
    bool all = part == WEFT_PART_ALL;
    return slots_of(all || part == WEFT_PART_DIFFUSE, all || part == WEFT_PART_SPECULAR,
                    all || part == WEFT_PART_SHEEN, all || part == WEFT_PART_COAT,
                    all || part == WEFT_PART_DUST);
}

/* Of what walks at random, the mean of some walks. */
static StackValue value_of(const Stack *stack, int part, Dir o, Dir i, uint32_t first, uint32_t walks) {
    StackValue sum = stack_eval_of(stack, slots_of_part(part), o, i);
    bool walk = part == WEFT_PART_ALL && stack->layer == LAYER_STOCHASTIC && stack->sheen.pick > 0.0f;
    for (uint32_t k = 0; walk && i.z > 0.0f && k < walks; k++)
        sum.f_cos = rgb_add(sum.f_cos, rgb_scale(sheet_bounces(stack, o, i, first + k), 1.0f / (float)walks));
    return sum;
}

void weft_reflection_eval(const WeftReflection *self, int part, const float wo[3], int count,
                          const float (*wi)[3], float (*f)[3]) {
    Stack stack;
    Dir o = to_frame(self, wo);
    for (int k = 0; k < count; k++) f[k][0] = f[k][1] = f[k][2] = 0.0f;
    if (!(o.z > 0.0f)) return;
    stack_make(&stack, &self->surface, &self->choices, self->table, o);
    for (int k = 0; k < count; k++) {
        Dir i = to_frame(self, wi[k]);
        if (!(i.z > 0.0f)) continue;
        Rgb c = rgb_scale(value_of(&stack, part, o, i, 0, WALKS).f_cos, 1.0f / i.z);
        f[k][0] = c.r, f[k][1] = c.g, f[k][2] = c.b;
    }
}

/* Digits of k the other way round, in [0, 1). */
static float radical_inverse(uint32_t k) {
    uint32_t x = 0;
    for (int bit = 0; bit < 24; bit++) x = x << 1 | (k >> bit & 1u);
    return (float)x * 0x1p-24f;
}

/* Directions as the lobes spread them: however narrow these are, few will do. */
void weft_reflection_albedo(const WeftReflection *self, int part, float cos_o, float albedo[3]) {
    Stack stack;
    float z = fminf(fmaxf(cos_o, 1e-4f), 1.0f);
    const float wo[3] = {sqrtf(fmaxf(1.0f - z * z, 0.0f)), 0.0f, z};
    Dir o = to_frame(self, wo);
    double sum[3] = {0.0};
    stack_make(&stack, &self->surface, &self->choices, self->table, o);
    for (uint32_t k = 0; k < DRAWS; k++) {
        Dir i = stack_sample(&stack, o, ((float)k + 0.5f) / DRAWS, radical_inverse(k));
        if (!(i.z > 0.0f)) continue;
        StackValue value = value_of(&stack, WEFT_PART_ALL, o, i, k, 1);
        float pdf = value.pdf;
        if (!(pdf > 0.0f)) continue;
        if (part != WEFT_PART_ALL) value = value_of(&stack, part, o, i, k, 1);
        Rgb c = rgb_scale(value.f_cos, 1.0f / (pdf * DRAWS));
        sum[0] += (double)c.r, sum[1] += (double)c.g, sum[2] += (double)c.b;
    }
    for (int c = 0; c < 3; c++) albedo[c] = (float)sum[c];
}
