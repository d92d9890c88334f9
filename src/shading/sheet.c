/* sheet.c - layer rule stochastic: the sheen as a thin sheet over the base, with the light that bounces
 * between them
 *
 *   f = c f_s(o, i) + T(o) f_b(o, i) T(i)
 *     + T(o) int f_b(o, a) cos_a c f_s(a, b) cos_b f_b(b, i) T(i) + ...,   T(w) = 1 - c E(w)
 *
 * The sheet reflects by the sheen's lobe on both of its sides and lets the rest through unbent. The first two
 * terms are stack_value's; the sum over bounces is estimated by a random walk from wo, the next step's base
 * as its connection to wi. After Yu Guo, Milos Hasan, Shuang Zhao, "Position-Free Monte Carlo Simulation for
 * Arbitrary Layered BSDFs", ACM TOG 37(6), 2018, section 4, for layers without thickness. Over a lossless
 * base and with E <= 1 a white sheen loses nothing. */
#include "base/random.h"
#include "shading/material_stack.h"

enum { BOUNCES_MOST = 64 };

static float walk_random(uint32_t *walk) { return unit_float(*walk = hash32(*walk + 0x9e3779b9u)); }

/* Extends the walk by one reflection; o becomes the new direction. False where it ends. */
static bool walk_on(uint32_t *walk, const Stack *layer, Dir *o, Rgb *weight) {
    float u = walk_random(walk), v = walk_random(walk);
    Dir i = stack_sample(layer, *o, u, v);
    if (i.z <= 0.0f) return false;
    StackValue value = stack_eval(layer, *o, i, 0);
    if (!(value.pdf > 0.0f)) return false;
    *weight = rgb_mul(*weight, rgb_scale(value.f_cos, 1.0f / value.pdf));
    *o = i;
    return rgb_max3(*weight) > 0.0f;
}

static Rgb let_through(const Stack *stack, Dir w) {
    SheenE e = stack_albedo(stack, w);
    Rgb c = stack->by == LAYER_BY_CHANNEL ? stack->color : rgb_grey(rgb_max3(stack->color));
    return rgb(max(1.0f - c.r * sheen_e_in(e, c.r), 0.0f), max(1.0f - c.g * sheen_e_in(e, c.g), 0.0f),
               max(1.0f - c.b * sheen_e_in(e, c.b), 0.0f));
}

/* One of the two layers by itself, the picks of what is left scaled to 1. */
static Stack only(const Stack *stack, bool sheen) {
    Stack m = *stack;
    m.coat.pick = m.dust.pick = 0.0f;
    if (sheen)
        m.diffuse.pick = m.specular.pick = 0.0f;
    else
        m.sheen.pick = 0.0f;
    float sum = m.diffuse.pick + m.specular.pick + m.sheen.pick, k = sum > 0.0f ? 1.0f / sum : 0.0f;
    m.diffuse.pick *= k, m.specular.pick *= k, m.sheen.pick *= k;
    m.color = rgb_grey(0.0f);
    m.layer = LAYER_ADDITIVE;
    /* slots hold colour times what dust and coat let through, which counts once and not at every bounce */
    float back = 1.0f / max(m.left, 1e-6f);
    Slot *slots[] = {&m.diffuse, &m.specular, &m.sheen};
    for (int j = 0; j < 3; j++) {
        slots[j]->f0 = rgb_scale(slots[j]->f0, back);
        slots[j]->f90 = rgb_scale(slots[j]->f90, back);
    }
    return m;
}

Rgb sheet_bounces(const Stack *stack, Slots last, Dir o, Dir i, uint32_t seed) {
    if (stack->layer != LAYER_STOCHASTIC || !(stack->sheen.pick > 0.0f)) return rgb_grey(0.0f);
    Stack base = only(stack, false), sheen = only(stack, true);
    Rgb weight = rgb_scale(let_through(stack, o), stack->left), sum = rgb_grey(0.0f);
    Rgb out = let_through(stack, i);
    for (int bounce = 0; bounce < BOUNCES_MOST; bounce++) {
        if (!walk_on(&seed, &base, &o, &weight) || !walk_on(&seed, &sheen, &o, &weight)) break;
        sum = rgb_add(sum, rgb_mul(rgb_mul(weight, out), stack_eval_of(&base, last, o, i).f_cos));
        float survive = min(rgb_max3(weight), 1.0f);
        if (walk_random(&seed) >= survive) break;
        weight = rgb_scale(weight, 1.0f / survive);
    }
    return sum;
}
