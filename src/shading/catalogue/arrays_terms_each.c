/* arrays_terms_each.c - the loops of the composed lobe, cook-torrance, in which each element has numbers of its own */
#define FN_NOINLINE FN /* no loop of vectors has a call */
#include "shading/catalogue/arrays_terms.h"

/* One term at a time, as in arrays_terms.c. */
#define TAKE_TERMS(e)                                                                                                  \
    CookTorrance terms = cook_torrance_of(&(e)->lobe);                                                                 \
    const float *alpha = (e)->params[COOK_TORRANCE_ALPHA], *stretch = (e)->params[COOK_TORRANCE_STRETCH],              \
                *ior = (e)->params[COOK_TORRANCE_IOR], *extinction = (e)->params[COOK_TORRANCE_K]
#define TAKE_OWN_TERMS(choice, NAME)                                                                                   \
    CookTorrance m = {alpha[k], terms.d, terms.v, terms.f, stretch[k], ior[k], extinction[k]};                         \
    m.choice = NAME

#define SPREAD_EACH(id, NAME, ...)                                                                                     \
    LOOP(spread_##NAME##_each_n, (const Each *e, size_t n), (e, n)) {                                                  \
        TAKE_PAIRS(e);                                                                                                 \
        float *pdf = e->pdf;                                                                                           \
        TAKE_TERMS(e);                                                                                                 \
        EACH(k, EACH_WHOLE(n)) {                                                                                       \
            TAKE_PAIR(o, i, counts);                                                                                   \
            TAKE_OWN_TERMS(d, NAME);                                                                                   \
            Angles a = angles_between(o, i);                                                                           \
            float spread = cook_torrance_spread(m, a), density = cook_torrance_sample_pdf(m, spread, a);               \
            r[k] = counts ? spread : 0.0f;                                                                             \
            pdf[k] = counts ? density : 0.0f;                                                                          \
        }                                                                                                              \
    }
#define SHADOW_EACH(id, NAME, ...)                                                                                     \
    LOOP(shadow_##NAME##_each_n, (const Each *e, size_t n), (e, n)) {                                                  \
        TAKE_PAIRS(e);                                                                                                 \
        TAKE_TERMS(e);                                                                                                 \
        EACH(k, EACH_WHOLE(n)) {                                                                                       \
            TAKE_PAIR(o, i, counts);                                                                                   \
            TAKE_OWN_TERMS(v, NAME);                                                                                   \
            float shadow = cook_torrance_shadow(m, angles_between(o, i));                                              \
            r[k] = counts ? r[k] * shadow : 0.0f;                                                                      \
        }                                                                                                              \
    }
#define TERM_COLOR(first, second) fresnel_weight_mix(s, first, cook_torrance_second(m, first, second))
#define MIXED_EACH(id, NAME, ...)                                                                                      \
    LOOP(mixed_##NAME##_each_n, (const Each *e, size_t n), (e, n)) {                                                   \
        TAKE_PAIRS(e);                                                                                                 \
        TAKE_COLORS(e);                                                                                                \
        TAKE_TERMS(e);                                                                                                 \
        EACH(k, EACH_WHOLE(n)) {                                                                                       \
            TAKE_PAIR(o, i, counts);                                                                                   \
            TAKE_OWN_TERMS(f, NAME);                                                                                   \
            float s = cook_torrance_fresnel_weight(m, angles_between(o, i)), f = counts ? r[k] : 0.0f;                 \
            PUT_COLORS(f, TERM_COLOR);                                                                                 \
        }                                                                                                              \
    }
#define DRAWN_EACH(id, NAME, ...)                                                                                      \
    LOOP(drawn_##NAME##_each_n, (const Each *e, size_t n), (e, n)) {                                                   \
        TAKE_DRAWS(e);                                                                                                 \
        TAKE_TERMS(e);                                                                                                 \
        EACH(k, EACH_WHOLE(n)) {                                                                                       \
            TAKE_ONE(o, counts);                                                                                       \
            TAKE_OWN_TERMS(d, NAME);                                                                                   \
            CookTorrancePrepared p = {m};                                                                              \
            CookTorranceView w = {0.0f};                                                                               \
            Dir i = cook_torrance_sample(&p, &w, o, us[k], vs[k]);                                                     \
            PUT_DRAWN(i, counts);                                                                                      \
        }                                                                                                              \
    }
WEFT_D_TERMS(SPREAD_EACH)
WEFT_V_TERMS(SHADOW_EACH)
WEFT_F_TERMS(MIXED_EACH)
WEFT_D_TERMS(DRAWN_EACH)

#define CALL_SPREAD(id, NAME, ...)                                                                                     \
    case NAME:                                                                                                         \
        spread_##NAME##_each_n(e, n);                                                                                  \
        break;
#define CALL_SHADOW(id, NAME, ...)                                                                                     \
    case NAME:                                                                                                         \
        shadow_##NAME##_each_n(e, n);                                                                                  \
        break;
#define CALL_MIXED(id, NAME, ...)                                                                                      \
    case NAME:                                                                                                         \
        mixed_##NAME##_each_n(e, n);                                                                                   \
        break;
#define CALL_DRAWN(id, NAME, ...)                                                                                      \
    case NAME: drawn_##NAME##_each_n(e, n); break;

static void cook_torrance_each_n(const Each *e, size_t n) {
    switch (cook_torrance_of(&e->lobe).d) { WEFT_D_TERMS(CALL_SPREAD) }
    switch (cook_torrance_of(&e->lobe).v) { WEFT_V_TERMS(CALL_SHADOW) }
    switch (cook_torrance_of(&e->lobe).f) { WEFT_F_TERMS(CALL_MIXED) }
}
static void cook_torrance_drawn_each_n(const Each *e, size_t n) {
    switch (cook_torrance_of(&e->lobe).d) { WEFT_D_TERMS(CALL_DRAWN) }
}

const EachLoops cook_torrance_each_loops = {cook_torrance_each_n, cook_torrance_drawn_each_n};
