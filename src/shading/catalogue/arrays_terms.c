/* arrays_terms.c - the loops over pairs of directions of the composed lobe, cook-torrance */
#include "shading/catalogue/arrays_terms.h"

/* One term at a time with its number a constant: a loop with a chain of terms in it stays
 * scalar, which is ten times slower. */
#define TERM_N(question, choice, NAME, value)                                                                          \
    LOOP(question##_##NAME##_n, (const Lobe *lobe, size_t n, LOOP_PAIRS, float *restrict f),                           \
         (lobe, n, LOOP_NAMES, f)) {                                                                                   \
        CookTorrance m = cook_torrance_of(lobe);                                                                       \
        m.choice = NAME;                                                                                               \
        EACH(k, n) {                                                                                                   \
            TAKE_PAIR(o, i, counts);                                                                                   \
            Angles a = angles_between(o, i);                                                                           \
            float e = value;                                                                                           \
            f[k] = counts ? e : 0.0f;                                                                                  \
        }                                                                                                              \
    }
#define SPREAD_N(id, NAME, ...) TERM_N(spread, d, NAME, cook_torrance_spread(m, a))
#define SHADOW_N(id, NAME, ...) TERM_N(shadow, v, NAME, f[k] * cook_torrance_shadow(m, a))
#define MIXED_N(id, NAME, ...)  TERM_N(mixed, f, NAME, cook_torrance_fresnel_weight(m, a))
#define DRAWN_N(id, NAME, ...)  TERM_N(drawn, d, NAME, cook_torrance_sample_pdf(m, cook_torrance_spread(m, a), a))
WEFT_D_TERMS(SPREAD_N)
WEFT_V_TERMS(SHADOW_N)
WEFT_F_TERMS(MIXED_N)
WEFT_D_TERMS(DRAWN_N)

#define TERM_CALL(question, NAME)                                                                                      \
    case NAME:                                                                                                         \
        question##_##NAME##_n(m, n, ox, oy, oz, ix, iy, iz, f);                                                        \
        break;
#define CALL_SPREAD(id, NAME, ...) TERM_CALL(spread, NAME)
#define CALL_SHADOW(id, NAME, ...) TERM_CALL(shadow, NAME)
#define CALL_MIXED(id, NAME, ...)  TERM_CALL(mixed, NAME)
#define CALL_DRAWN(id, NAME, ...)  TERM_CALL(drawn, NAME)

static void cook_torrance_f_n(const Lobe *m, size_t n, LOOP_PAIRS, float *restrict f) {
    switch (cook_torrance_of(m).d) { WEFT_D_TERMS(CALL_SPREAD) }
    switch (cook_torrance_of(m).v) { WEFT_V_TERMS(CALL_SHADOW) }
}
static void cook_torrance_mixed_n(const Lobe *m, size_t n, LOOP_PAIRS, float *restrict f) {
    switch (cook_torrance_of(m).f) { WEFT_F_TERMS(CALL_MIXED) }
}
static void cook_torrance_shares_n(const Lobe *m, size_t n, LOOP_PAIRS, float *restrict f, float *restrict s) {
    cook_torrance_f_n(m, n, ox, oy, oz, ix, iy, iz, f);
    cook_torrance_mixed_n(m, n, ox, oy, oz, ix, iy, iz, s);
}
static void cook_torrance_pdf_n(const Lobe *m, size_t n, LOOP_PAIRS, float *restrict f) {
    switch (cook_torrance_of(m).d) { WEFT_D_TERMS(CALL_DRAWN) }
}

const LobeLoops cook_torrance_loops = {cook_torrance_f_n, cook_torrance_pdf_n, cook_torrance_shares_n, NULL,
                                       &cook_torrance_each_loops};
