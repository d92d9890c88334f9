/* arrays.c - the same text over arrays: one loop per lobe and question, the widest instructions chosen at
 * start-up
 *
 * Only this file is compiled with -ffinite-math-only (see CMakeLists.txt): under it a NaN test is folded
 * away, and a question about NaN has to be one about bits. */
#include "lobes.gen.h"
#include "shading/registry.h"

#if defined(CLONES) /* bench/ makes each clone by itself */
#elif defined(__x86_64__) && !defined(__SANITIZE_ADDRESS__) && !defined(__clang__)
#define CLONES __attribute__((target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default")))
#else
#define CLONES
#endif

#define FROM_ARRAY(type, name, def, low, high, hard_low, hard_high, help) m.name = (type)*p++;

/* Whether both directions are above the horizon and none of their components is infinite or NaN, which
 * their sum would show. */
FN bool pair_counts(Dir o, Dir i) {
    float sum = (o.x + i.x) + (o.y + i.y) + (o.z + i.z);
    uint32_t bits;
    memcpy(&bits, &sum, 4);
    return ((int32_t)(bits & 0x7fffffffu) < 0x7f800000) & (o.z > 0.0f) & (i.z > 0.0f);
}

/* A pair; where it does not count the normal twice, which no formula minds. */
#define TAKE_PAIR(o, i, counts)                                                                              \
    Dir o = {ox[k], oy[k], oz[k]}, i = {ix[k], iy[k], iz[k]};                                                \
    bool counts = pair_counts(o, i);                                                                         \
    o = (Dir){counts ? o.x : 0.0f, counts ? o.y : 0.0f, counts ? o.z : 1.0f};                                \
    i = (Dir) { counts ? i.x : 0.0f, counts ? i.y : 0.0f, counts ? i.z : 1.0f }

/* name_QUESTION_n asks the lobe for one float per pair of directions. */
#define ASK_N(question, name, Record, NAME) ASK_OF_N(question, name, Record, NAME, Record, m)
#define ASK_OF_N(question, name, Record, NAME, Asked, asked)                                                 \
    CLONES static void name##_##question##_n(const float *p, size_t n, const float *restrict ox,             \
                                             const float *restrict oy, const float *restrict oz,             \
                                             const float *restrict ix, const float *restrict iy,             \
                                             const float *restrict iz, float *restrict f) {                  \
        Record m = {0};                                                                                      \
        NAME##_PARAMS(FROM_ARRAY)(void) p;                                                                   \
        Asked of = asked;                                                                                    \
        _Pragma("omp simd") for (size_t k = 0; k < n; k++) {                                                 \
            TAKE_PAIR(o, i, counts);                                                                         \
            float e = name##_##question(of, angles_between(o, i));                                           \
            f[k] = counts ? e : 0.0f;                                                                        \
        }                                                                                                    \
    }
#define EVAL_N(id, name, Record, NAME)  ASK_N(eval, name, Record, NAME)
#define READY_N(id, name, Record, NAME) ASK_OF_N(eval, name, Record, NAME, Record##Ready, name##_ready(m))
#define PDF_N(id, name, Record, NAME)   ASK_N(pdf, name, Record, NAME)
#define SHARE_N(id, name, Record, NAME) ASK_N(share, name, Record, NAME)
WEFT_ONE_COLOR_LOBES(EVAL_N)
WEFT_TWO_COLOR_LOBES(EVAL_N)
WEFT_TINTED_LOBES(READY_N)
WEFT_LOBES(PDF_N)
WEFT_TWO_COLOR_LOBES(SHARE_N)

/* f in three colours, which share all but what a colour does. */
#define TINTED_N(id, name, Record, NAME)                                                                     \
    CLONES static void name##_tinted_n(                                                                      \
        const float *p, const float w[3], size_t n, const float *restrict ox, const float *restrict oy,      \
        const float *restrict oz, const float *restrict ix, const float *restrict iy,                        \
        const float *restrict iz, float *restrict r, float *restrict g, float *restrict b) {                 \
        Record m = {0};                                                                                      \
        NAME##_PARAMS(FROM_ARRAY)(void) p;                                                                   \
        Record##Ready of = name##_ready(m);                                                                  \
        float w_r = w[0], w_g = w[1], w_b = w[2];                                                            \
        _Pragma("omp simd") for (size_t k = 0; k < n; k++) {                                                 \
            TAKE_PAIR(o, i, counts);                                                                         \
            Angles a = angles_between(o, i);                                                                 \
            float e = name##_eval(of, a), f = counts ? e : 0.0f;                                             \
            Tint t = name##_tint(of, a);                                                                     \
            r[k] = f * tint_color(t, w_r);                                                                   \
            g[k] = f * tint_color(t, w_g);                                                                   \
            b[k] = f * tint_color(t, w_b);                                                                   \
        }                                                                                                    \
    }
WEFT_TINTED_LOBES(TINTED_N)

/* The composed lobe, one term at a time with its number a constant: a loop with a chain of terms in it stays
 * scalar, which is ten times slower. */
FN CookTorrance composed(const float *p) {
    CookTorrance m = {0};
    COOK_TORRANCE_PARAMS(FROM_ARRAY)(void) p;
    return m;
}

#define TERM_N(question, choice, NAME, value)                                                                \
    CLONES static void question##_##NAME##_n(const float *p, size_t n, const float *restrict ox,             \
                                             const float *restrict oy, const float *restrict oz,             \
                                             const float *restrict ix, const float *restrict iy,             \
                                             const float *restrict iz, float *restrict f) {                  \
        CookTorrance m = composed(p);                                                                        \
        m.choice = NAME;                                                                                     \
        _Pragma("omp simd") for (size_t k = 0; k < n; k++) {                                                 \
            TAKE_PAIR(o, i, counts);                                                                         \
            Angles a = angles_between(o, i);                                                                 \
            float e = value;                                                                                 \
            f[k] = counts ? e : 0.0f;                                                                        \
        }                                                                                                    \
    }
#define SPREAD_N(id, NAME, ...) TERM_N(spread, d, NAME, cook_torrance_spread(m, a))
#define SHADOW_N(id, NAME, ...) TERM_N(shadow, v, NAME, f[k] * cook_torrance_shadow(m, a))
#define MIXED_N(id, NAME, ...)  TERM_N(mixed, f, NAME, cook_torrance_share(m, a))
#define DRAWN_N(id, NAME, ...)  TERM_N(drawn, d, NAME, cook_torrance_pdf(m, a))
WEFT_D_TERMS(SPREAD_N)
WEFT_V_TERMS(SHADOW_N)
WEFT_F_TERMS(MIXED_N)
WEFT_D_TERMS(DRAWN_N)

#define TERM_CALL(question, NAME)                                                                            \
    case NAME:                                                                                               \
        question##_##NAME##_n(lobe->params, n, ox, oy, oz, ix, iy, iz, f);                                   \
        break;
#define CALL_SPREAD(id, NAME, ...) TERM_CALL(spread, NAME)
#define CALL_SHADOW(id, NAME, ...) TERM_CALL(shadow, NAME)
#define CALL_MIXED(id, NAME, ...)  TERM_CALL(mixed, NAME)
#define CALL_DRAWN(id, NAME, ...)  TERM_CALL(drawn, NAME)

static void composed_eval_n(const Lobe *lobe, size_t n, const float *ox, const float *oy, const float *oz,
                            const float *ix, const float *iy, const float *iz, float *f) {
    switch (composed(lobe->params).d) { WEFT_D_TERMS(CALL_SPREAD) }
    switch (composed(lobe->params).v) { WEFT_V_TERMS(CALL_SHADOW) }
}
static void composed_share_n(const Lobe *lobe, size_t n, const float *ox, const float *oy, const float *oz,
                             const float *ix, const float *iy, const float *iz, float *f) {
    switch (composed(lobe->params).f) { WEFT_F_TERMS(CALL_MIXED) }
}
static void composed_pdf_n(const Lobe *lobe, size_t n, const float *ox, const float *oy, const float *oz,
                           const float *ix, const float *iy, const float *iz, float *f) {
    switch (composed(lobe->params).d) { WEFT_D_TERMS(CALL_DRAWN) }
}

void lobe_eval_n(const Lobe *lobe, size_t n, const float *ox, const float *oy, const float *oz,
                 const float *ix, const float *iy, const float *iz, float *f, float *s) {
    if (lobe->id == LOBE_COOK_TORRANCE) {
        composed_eval_n(lobe, n, ox, oy, oz, ix, iy, iz, f);
        if (s) composed_share_n(lobe, n, ox, oy, oz, ix, iy, iz, s);
        return;
    }
    if (s) memset(s, 0, n * sizeof *s);
    switch (lobe->id) {
#define ONE_COLOR_EVAL_N(id, name, Record, NAME)                                                             \
    case LOBE_##NAME:                                                                                        \
        name##_eval_n(lobe->params, n, ox, oy, oz, ix, iy, iz, f);                                           \
        return;
#define TWO_COLOR_EVAL_N(id, name, Record, NAME)                                                             \
    case LOBE_##NAME:                                                                                        \
        name##_eval_n(lobe->params, n, ox, oy, oz, ix, iy, iz, f);                                           \
        if (s) name##_share_n(lobe->params, n, ox, oy, oz, ix, iy, iz, s);                                   \
        return;
        WEFT_ONE_COLOR_LOBES(ONE_COLOR_EVAL_N)
        WEFT_TWO_COLOR_LOBES(TWO_COLOR_EVAL_N)
        WEFT_TINTED_LOBES(ONE_COLOR_EVAL_N)
    default: break; /* a walk is no loop of vectors */
    }
    for (size_t k = 0; k < n; k++) {
        TAKE_PAIR(o, i, counts);
        f[k] = counts ? lobe_eval(lobe, angles_between(o, i)) : 0.0f;
    }
}

void lobe_pdf_n(const Lobe *lobe, size_t n, const float *ox, const float *oy, const float *oz,
                const float *ix, const float *iy, const float *iz, float *pdf) {
    if (lobe->id == LOBE_COOK_TORRANCE) {
        composed_pdf_n(lobe, n, ox, oy, oz, ix, iy, iz, pdf);
        return;
    }
    switch (lobe->id) {
#define LOBE_PDF_N(id, name, Record, NAME)                                                                   \
    case LOBE_##NAME: name##_pdf_n(lobe->params, n, ox, oy, oz, ix, iy, iz, pdf); return;
        WEFT_LOBES(LOBE_PDF_N)
    case LOBE_COUNT: return;
    }
}

void lobe_tinted_n(const Lobe *lobe, const float w[3], size_t n, const float *ox, const float *oy,
                   const float *oz, const float *ix, const float *iy, const float *iz, float *const f[3]) {
    if (w[0] >= 1.0f && w[1] >= 1.0f && w[2] >= 1.0f) { /* white is quicker by itself */
        lobe_eval_n(lobe, n, ox, oy, oz, ix, iy, iz, f[0], NULL);
        memcpy(f[1], f[0], n * sizeof *f[1]);
        memcpy(f[2], f[0], n * sizeof *f[2]);
        return;
    }
    switch (lobe->id) {
#define LOBE_TINTED_N(id, name, Record, NAME)                                                                \
    case LOBE_##NAME: name##_tinted_n(lobe->params, w, n, ox, oy, oz, ix, iy, iz, f[0], f[1], f[2]); return;
        WEFT_TINTED_LOBES(LOBE_TINTED_N)
    default:
        for (int c = 0; c < 3; c++) memset(f[c], 0, n * sizeof *f[c]);
    }
}
