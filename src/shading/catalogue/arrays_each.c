/* arrays_each.c - the loops over arrays in which each element is a lobe of its own: one that evaluates and
 * one that samples for each kind of lobe
 *
 * What depends on parameters alone is made anew for each element, so these take longer than those of
 * arrays.c, which make it once. */
#define FN_NOINLINE FN /* no loop of vectors has a call */
#include "shading/catalogue/registry.h"
#include "shading/lobe/each_loop.h"

/* The composed lobe, one term at a time as in arrays.c. */
#define TAKE_TERMS(e)                                                                                        \
    CookTorrance terms = cook_torrance_of(&(e)->lobe);                                                       \
    const float *alpha = (e)->params[COOK_TORRANCE_ALPHA], *stretch = (e)->params[COOK_TORRANCE_STRETCH],    \
                *ior = (e)->params[COOK_TORRANCE_IOR], *extinction = (e)->params[COOK_TORRANCE_K]
#define TAKE_OWN_TERMS(choice, NAME)                                                                         \
    CookTorrance m = {alpha[k], terms.d, terms.v, terms.f, stretch[k], ior[k], extinction[k]};               \
    m.choice = NAME

#define SPREAD_EACH(id, NAME, ...)                                                                           \
    LOOP(spread_##NAME##_each_n, (const Each *e, size_t n), (e, n)) {                                        \
        TAKE_PAIRS(e);                                                                                       \
        float *pdf = e->pdf;                                                                                 \
        TAKE_TERMS(e);                                                                                       \
        EACH(k, n) {                                                                                         \
            TAKE_PAIR(o, i, counts);                                                                         \
            TAKE_OWN_TERMS(d, NAME);                                                                         \
            Angles a = angles_between(o, i);                                                                 \
            float spread = cook_torrance_spread(m, a), density = cook_torrance_sample_pdf(m, spread, a);     \
            r[k] = counts ? spread : 0.0f;                                                                   \
            pdf[k] = counts ? density : 0.0f;                                                                \
        }                                                                                                    \
    }
#define SHADOW_EACH(id, NAME, ...)                                                                           \
    LOOP(shadow_##NAME##_each_n, (const Each *e, size_t n), (e, n)) {                                        \
        TAKE_PAIRS(e);                                                                                       \
        TAKE_TERMS(e);                                                                                       \
        EACH(k, n) {                                                                                         \
            TAKE_PAIR(o, i, counts);                                                                         \
            TAKE_OWN_TERMS(v, NAME);                                                                         \
            float shadow = cook_torrance_shadow(m, angles_between(o, i));                                    \
            r[k] = counts ? r[k] * shadow : 0.0f;                                                            \
        }                                                                                                    \
    }
#define TERM_COLOR(first, second) fresnel_weight_mix(s, first, cook_torrance_second(m, first, second))
#define MIXED_EACH(id, NAME, ...)                                                                            \
    LOOP(mixed_##NAME##_each_n, (const Each *e, size_t n), (e, n)) {                                         \
        TAKE_PAIRS(e);                                                                                       \
        TAKE_COLORS(e);                                                                                      \
        TAKE_TERMS(e);                                                                                       \
        EACH(k, n) {                                                                                         \
            TAKE_PAIR(o, i, counts);                                                                         \
            TAKE_OWN_TERMS(f, NAME);                                                                         \
            float s = cook_torrance_fresnel_weight(m, angles_between(o, i)), f = counts ? r[k] : 0.0f;       \
            PUT_COLORS(f, TERM_COLOR);                                                                       \
        }                                                                                                    \
    }
#define DRAWN_EACH(id, NAME, ...)                                                                            \
    LOOP(drawn_##NAME##_each_n, (const Each *e, size_t n), (e, n)) {                                         \
        TAKE_DRAWS(e);                                                                                       \
        TAKE_TERMS(e);                                                                                       \
        EACH(k, n) {                                                                                         \
            TAKE_ONE(o, counts);                                                                             \
            TAKE_OWN_TERMS(d, NAME);                                                                         \
            CookTorrancePrepared p = {m};                                                                    \
            CookTorranceView w = {0.0f};                                                                     \
            Dir i = cook_torrance_sample(&p, &w, o, us[k], vs[k]);                                           \
            PUT_DRAWN(i, counts);                                                                            \
        }                                                                                                    \
    }
WEFT_D_TERMS(SPREAD_EACH)
WEFT_V_TERMS(SHADOW_EACH)
WEFT_F_TERMS(MIXED_EACH)
WEFT_D_TERMS(DRAWN_EACH)

#define CALL_SPREAD(id, NAME, ...)                                                                           \
    case NAME:                                                                                               \
        spread_##NAME##_each_n(e, n);                                                                        \
        break;
#define CALL_SHADOW(id, NAME, ...)                                                                           \
    case NAME:                                                                                               \
        shadow_##NAME##_each_n(e, n);                                                                        \
        break;
#define CALL_MIXED(id, NAME, ...)                                                                            \
    case NAME:                                                                                               \
        mixed_##NAME##_each_n(e, n);                                                                         \
        break;
#define CALL_DRAWN(id, NAME, ...)                                                                            \
    case NAME: drawn_##NAME##_each_n(e, n); break;

static void cook_torrance_each_n(const Each *e, size_t n) {
    switch (cook_torrance_of(&e->lobe).d) { WEFT_D_TERMS(CALL_SPREAD) }
    switch (cook_torrance_of(&e->lobe).v) { WEFT_V_TERMS(CALL_SHADOW) }
    switch (cook_torrance_of(&e->lobe).f) { WEFT_F_TERMS(CALL_MIXED) }
}
static void cook_torrance_drawn_each_n(const Each *e, size_t n) {
    switch (cook_torrance_of(&e->lobe).d) { WEFT_D_TERMS(CALL_DRAWN) }
}

/* A walk is no loop of vectors. */
static Lobe lobe_of_each(const Each *e, size_t k) {
    Lobe m = e->lobe;
    for (int p = 0; p < LOBE_PARAMS_MAX; p++)
        if (e->params[p]) m.params[p] = e->params[p][k];
    return m;
}

static void walk_each_n(const Each *e, size_t n) {
    TAKE_PAIRS(e);
    TAKE_COLORS(e);
    float *pdf = e->pdf;
    for (size_t k = 0; k < n; k++) {
        TAKE_PAIR(o, i, counts);
        Lobe m = lobe_of_each(e, k);
        LobeValue v = lobe_value(&m, angles_between(o, i));
        float f = counts ? v.f : 0.0f;
#define WALKED_COLOR(first, second) lobe_color(v, first, lobe_second(&m, first, second))
        PUT_COLORS(f, WALKED_COLOR);
        pdf[k] = counts ? v.pdf : 0.0f;
    }
}

static void walk_drawn_each_n(const Each *e, size_t n) {
    TAKE_DRAWS(e);
    for (size_t k = 0; k < n; k++) {
        TAKE_ONE(o, counts);
        Lobe m = lobe_of_each(e, k);
        Dir i = lobe_sample(&m, o, us[k], vs[k]);
        PUT_DRAWN(i, counts);
    }
}

#include "shading/each.gen.h"
