/* arrays.c - arrays of pairs of directions and of elements, put to the loops of their lobe
 *
 * No loops of vectors: a lobe that walks has none, and is asked for one pair after the other. */
#include "shading/catalogue/registry.h"
#include "shading/lobe/each_loop.h"
#include "shading/loops.gen.h"

#define LOOPS_DECLARED(name, ...) extern const LobeLoops name##_loops;
CATALOGUE_LOOPS(LOOPS_DECLARED)
COMPOSED_LOOPS(LOOPS_DECLARED)

/* Returns the loops of a lobe; NULL for one that walks. */
static const LobeLoops *loops_of(int id) {
#define LOOPS_PLACED(name, Name, NAME, ...) [LOBE_##NAME] = &name##_loops,
    static const LobeLoops *const own[LOBE_COUNT] = {CATALOGUE_LOOPS(LOOPS_PLACED) COMPOSED_LOOPS(LOOPS_PLACED)};
    return id < LOBE_COUNT ? own[id] : outside_loops(id);
}

/* One pair after the other. */
#define EACH_ONE(ask, out)                                                                                             \
    for (size_t k = 0; k < n; k++) {                                                                                   \
        TAKE_PAIR(o, i, counts);                                                                                       \
        out[k] = counts ? ask(m, angles_between(o, i)) : 0.0f;                                                         \
    }

void lobe_pdf_n(const Lobe *m, size_t n, LOOP_PAIRS, float *restrict pdf) {
    const LobeLoops *loops = loops_of(m->id);
    if (loops)
        loops->pdf(m, n, LOOP_NAMES, pdf);
    else
        EACH_ONE(lobe_pdf, pdf);
}

void lobe_eval_n(const Lobe *m, size_t n, LOOP_PAIRS, float *restrict f, float *restrict s) {
    const LobeLoops *loops = loops_of(m->id);
    if (s && loops && loops->shares) {
        loops->shares(m, n, LOOP_NAMES, f, s);
        return;
    }
    if (loops)
        loops->f(m, n, LOOP_NAMES, f);
    else
        EACH_ONE(lobe_eval, f);
    if (s) memset(s, 0, n * sizeof *s);
}

void lobe_tinted_n(const Lobe *m, const float w[3], size_t n, LOOP_PAIRS, float *const f[3]) {
    const LobeLoops *loops = loops_of(m->id);
    if (w[0] >= 1.0f && w[1] >= 1.0f && w[2] >= 1.0f) { /* white is quicker by itself */
        lobe_eval_n(m, n, LOOP_NAMES, f[0], NULL);
        memcpy(f[1], f[0], n * sizeof *f[1]);
        memcpy(f[2], f[0], n * sizeof *f[2]);
    } else if (loops && loops->tinted) {
        loops->tinted(m, w, n, LOOP_NAMES, f[0], f[1], f[2]);
    } else {
        for (int k = 0; k < 3; k++) memset(f[k], 0, n * sizeof *f[k]);
    }
}

/* Returns the lobe of element k. */
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

void each_eval(const Each *e, size_t n) {
    const LobeLoops *loops = loops_of(e->lobe.id);
    if (loops)
        loops->each->eval(e, n);
    else
        walk_each_n(e, n);
}

void each_sample(const Each *e, size_t n) {
    const LobeLoops *loops = loops_of(e->lobe.id);
    if (loops)
        loops->each->sample(e, n);
    else
        walk_drawn_each_n(e, n);
}
