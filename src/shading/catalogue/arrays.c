/* arrays.c - the same text over arrays: one loop per lobe for f, f and share, and pdf, the widest instructions chosen at
 * start-up */
#include "shading/catalogue/registry.h"
#include "shading/lobe/lobe_loop.h"

/* One pair after the other. */
#define EACH_ONE(ask, out)                                                                                   \
    for (size_t k = 0; k < n; k++) {                                                                         \
        TAKE_PAIR(o, i, counts);                                                                             \
        out[k] = counts ? ask(m, angles_between(o, i)) : 0.0f;                                               \
    }

/* The composed lobe, one term at a time with its number a constant: a loop with a chain of terms in it stays
 * scalar, which is ten times slower. */
#define TERM_N(question, choice, NAME, value)                                                                \
    LOOP(question##_##NAME##_n, (const Lobe *lobe, size_t n, PAIRS, float *restrict f),                      \
         (lobe, n, PAIR_NAMES, f)) {                                                                         \
        CookTorrance m = cook_torrance_of(lobe);                                                             \
        m.choice = NAME;                                                                                     \
        EACH(k, n) {                                                                                         \
            TAKE_PAIR(o, i, counts);                                                                         \
            Angles a = angles_between(o, i);                                                                 \
            float e = value;                                                                                 \
            f[k] = counts ? e : 0.0f;                                                                        \
        }                                                                                                    \
    }
#define SPREAD_N(id, NAME, ...) TERM_N(spread, d, NAME, cook_torrance_spread(m, a))
#define SHADOW_N(id, NAME, ...) TERM_N(shadow, v, NAME, f[k] * cook_torrance_shadow(m, a))
#define MIXED_N(id, NAME, ...)  TERM_N(mixed, f, NAME, cook_torrance_fresnel_weight(m, a))
#define DRAWN_N(id, NAME, ...)                                                                               \
    TERM_N(drawn, d, NAME, cook_torrance_sample_pdf(m, cook_torrance_spread(m, a), a))
WEFT_D_TERMS(SPREAD_N)
WEFT_V_TERMS(SHADOW_N)
WEFT_F_TERMS(MIXED_N)
WEFT_D_TERMS(DRAWN_N)

#define TERM_CALL(question, NAME)                                                                            \
    case NAME:                                                                                               \
        question##_##NAME##_n(m, n, ox, oy, oz, ix, iy, iz, f);                                              \
        break;
#define CALL_SPREAD(id, NAME, ...) TERM_CALL(spread, NAME)
#define CALL_SHADOW(id, NAME, ...) TERM_CALL(shadow, NAME)
#define CALL_MIXED(id, NAME, ...)  TERM_CALL(mixed, NAME)
#define CALL_DRAWN(id, NAME, ...)  TERM_CALL(drawn, NAME)

static void cook_torrance_f_n(const Lobe *m, size_t n, PAIRS, float *restrict f) {
    switch (cook_torrance_of(m).d) { WEFT_D_TERMS(CALL_SPREAD) }
    switch (cook_torrance_of(m).v) { WEFT_V_TERMS(CALL_SHADOW) }
}
static void cook_torrance_mixed_n(const Lobe *m, size_t n, PAIRS, float *restrict f) {
    switch (cook_torrance_of(m).f) { WEFT_F_TERMS(CALL_MIXED) }
}
static void cook_torrance_shares_n(const Lobe *m, size_t n, PAIRS, float *restrict f, float *restrict s) {
    cook_torrance_f_n(m, n, ox, oy, oz, ix, iy, iz, f);
    cook_torrance_mixed_n(m, n, ox, oy, oz, ix, iy, iz, s);
}
static void cook_torrance_pdf_n(const Lobe *m, size_t n, PAIRS, float *restrict f) {
    switch (cook_torrance_of(m).d) { WEFT_D_TERMS(CALL_DRAWN) }
}

#include "shading/loops.gen.h"

void lobe_eval_n(const Lobe *m, size_t n, PAIRS, float *restrict f, float *restrict s) {
    if (s)
        lobe_shares_n(m, n, ox, oy, oz, ix, iy, iz, f, s);
    else
        lobe_f_n(m, n, ox, oy, oz, ix, iy, iz, f);
}

void lobe_tinted_n(const Lobe *m, const float w[3], size_t n, PAIRS, float *const f[3]) {
    if (w[0] >= 1.0f && w[1] >= 1.0f && w[2] >= 1.0f) { /* white is quicker by itself */
        lobe_f_n(m, n, ox, oy, oz, ix, iy, iz, f[0]);
        memcpy(f[1], f[0], n * sizeof *f[1]);
        memcpy(f[2], f[0], n * sizeof *f[2]);
    } else {
        lobe_tinted_of_n(m, w, n, ox, oy, oz, ix, iy, iz, f);
    }
}
