/* layer_walk.c - layer rule stochastic: the sheen as a thin sheet over the base, with the light that bounces
 * between them
 *
 *   f = c f_s(o, i) + T(o) f_b(o, i) T(i)
 *     + T(o) int f_b(o, a) cos_a c f_s(a, b) cos_b f_b(b, i) T(i) + ...,   T(w) = 1 - c E(w)
 *
 * The sheet reflects by the sheen's lobe on both of its sides and transmits the rest without refraction. The first
 * two terms are stack_value's; the sum over bounces is estimated by a random walk from wo, the next step's base
 * as its connection to wi. After Yu Guo, Milos Hasan, Shuang Zhao, "Position-Free Monte Carlo Simulation for
 * Arbitrary Layered BSDFs", ACM TOG 37(6), 2018, section 4, for layers without thickness. Over a lossless
 * base and with E <= 1 a white sheen loses nothing. */
#include "base/random.h"
#include "shading/material/material_stack.h"

enum { BOUNCES_MOST = 64 };

static float walk_random(uint32_t *walk) { return unit_float(*walk = hash32(*walk + 0x9e3779b9u)); }

/* One of the two layers: the stack without its layer rule, its view, and the slots of the layer.
 */
typedef struct WalkLayer {
    const Stack *stack;
    StackView view;
    Slots own;
} WalkLayer;

/* Views the layer from o; nothing else changes. */
static void view_from(WalkLayer *layer, Dir o) {
    layer->view.o = layer->view.coat_o = o;
    stack_view_lobes(layer->stack, &layer->view);
}

/* Extends the walk by one reflection; o becomes the new direction. Returns false if the walk ends. */
static bool walk_on(uint32_t *walk, WalkLayer *layer, Dir *o, Rgb *weight) {
    float u = walk_random(walk), v = walk_random(walk);
    view_from(layer, *o);
    Dir i;
    stack_sample(layer->stack, &layer->view, u, v, &i);
    if (i.z <= 0.0f) return false;
    StackValue value = stack_eval_of(layer->stack, &layer->view, layer->own, i);
    if (!(value.pdf > 0.0f)) return false;
    *weight = rgb_mul(*weight, rgb_scale(value.f_cos, 1.0f / value.pdf));
    *o = i;
    return rgb_max3(*weight) > 0.0f;
}

static Rgb let_through(const Stack *stack, Dir w) {
    SheenE e = stack_albedo(stack, w);
    Rgb c = stack->combine == LAYER_BY_CHANNEL ? stack->color : rgb_grey(rgb_max3(stack->color));
    return rgb(max(1.0f - c.r * sheen_e_in(e, c.r), 0.0f), max(1.0f - c.g * sheen_e_in(e, c.g), 0.0f),
               max(1.0f - c.b * sheen_e_in(e, c.b), 0.0f));
}

/* Returns one layer with its own probabilities scaled to a sum of 1. The transmittance of dust and coat is divided out:
 * it applies once and not at each bounce. */
static WalkLayer walk_layer_of(const Stack *alone, const StackView *view, bool sheen) {
    WalkLayer s = {alone, *view, slots_of(!sheen, !sheen, sheen, false, false)};
    const Scales *p = &view->select_p;
    float sum = sheen ? p->sheen : p->diffuse + p->specular, k = sum > 0.0f ? 1.0f / sum : 0.0f;
    float back = 1.0f / max(view->coat_transmittance * view->dust_transmittance, 1e-6f);
    s.view.select_p = (Scales){0};
    if (sheen) s.view.select_p.sheen = p->sheen * k;
    if (!sheen) s.view.select_p.diffuse = p->diffuse * k, s.view.select_p.specular = p->specular * k;
    s.view.scale.diffuse *= back, s.view.scale.specular *= back, s.view.scale.sheen *= back;
    s.view.base_scale = rgb_grey(1.0f);
    return s;
}

Rgb layer_walk_bounces(const Stack *stack, const StackView *view, Slots last, Dir i, uint32_t seed) {
    if (stack->layer != LAYER_STOCHASTIC || !HAS_SHEEN(stack)) return rgb_grey(0.0f);
    Stack alone = *stack;
    alone.color = rgb_grey(0.0f);
    alone.layer = LAYER_ADDITIVE;
    WalkLayer base = walk_layer_of(&alone, view, false), sheen = walk_layer_of(&alone, view, true);
    Slots of_base = slots_of(last.diffuse, last.specular, false, false, false);
    Dir o = view->o;
    Rgb weight = rgb_scale(let_through(stack, o), view->coat_transmittance * view->dust_transmittance),
        sum = rgb_grey(0.0f);
    Rgb out = let_through(stack, i);
    for (int bounce = 0; bounce < BOUNCES_MOST; bounce++) {
        if (!walk_on(&seed, &base, &o, &weight) || !walk_on(&seed, &sheen, &o, &weight)) break;
        view_from(&base, o);
        Rgb f_cos = stack_eval_of(&alone, &base.view, of_base, i).f_cos;
        sum = rgb_add(sum, rgb_mul(rgb_mul(weight, out), f_cos));
        float survive = min(rgb_max3(weight), 1.0f);
        if (walk_random(&seed) >= survive) break;
        weight = rgb_scale(weight, 1.0f / survive);
    }
    return sum;
}
