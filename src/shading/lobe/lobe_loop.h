/* lobe_loop.h - loops of one lobe over arrays of pairs of directions, for loops_NAME.c (cmake/lobes.cmake) and
 * plugins (plugin.h) */
#pragma once

#include "shading/dialect/loop.h"
#include "shading/lobe/lobe.h"
#include "shading/lobe/loops.h"

/* A loop over pairs of a prepared lobe: what to do with the value v of pair k, which counts or does not. */
#define EACH_PAIR(name, Name, ...)                                                                                     \
    EACH(k, n) {                                                                                                       \
        TAKE_PAIR(o, i, counts);                                                                                       \
        Angles a = angles_between(o, i);                                                                               \
        Name##View w;                                                                                                  \
        name##_view(&p, o, &w);                                                                                        \
        LobeValue v = name##_value(&p, &w, a);                                                                         \
        __VA_ARGS__;                                                                                                   \
    }
#define EACH_VALUE(name, Name, ...)                                                                                    \
    Name##Prepared p;                                                                                                  \
    name##_prepare(name##_of(m), &p);                                                                                  \
    EACH_PAIR(name, Name, __VA_ARGS__)

/* A loop for a prepared lobe p whose value is a sum of p.count rounds (ROUNDS_OF), of which later ones would add nothing. It
 * is compiled four times, for up to 3, 5 and 9 rounds and for all, since it is one of vectors only where the compiler knows
 * their number. */
#define ALL_ROUNDS(p) p.count = 1e3f
#define BY_COUNT(...)                                                                                                  \
    if (p.count <= 3.0f) {                                                                                             \
        p.count = 3.0f;                                                                                                \
        __VA_ARGS__                                                                                                    \
    } else if (p.count <= 5.0f) {                                                                                      \
        p.count = 5.0f;                                                                                                \
        __VA_ARGS__                                                                                                    \
    } else if (p.count <= 9.0f) {                                                                                      \
        p.count = 9.0f;                                                                                                \
        __VA_ARGS__                                                                                                    \
    } else {                                                                                                           \
        ALL_ROUNDS(p);                                                                                                 \
        __VA_ARGS__                                                                                                    \
    }

/* One member of a lobe's value: f or pdf. */
#define LOBE_LOOP(question, name, Name)                                                                                \
    LOOP(name##_##question##_n, (const Lobe *m, size_t n, LOOP_PAIRS, float *restrict question),                       \
         (m, n, LOOP_NAMES, question)) {                                                                               \
        EACH_VALUE(name, Name, question[k] = counts ? v.question : 0.0f)                                               \
    }

/* f and s of a lobe of two colours. */
#define SHARES_LOOP(name, Name)                                                                                        \
    LOOP(name##_shares_n, (const Lobe *m, size_t n, LOOP_PAIRS, float *restrict f, float *restrict s),                 \
         (m, n, LOOP_NAMES, f, s)) {                                                                                   \
        EACH_VALUE(name, Name, f[k] = counts ? v.f : 0.0f; s[k] = counts ? v.s : 0.0f)                                 \
    }

/* A lobe with a count (BY_COUNT) has loops for f and s together, and f alone is made by them, since another set of loops
 * would take long to compile. */
#define COUNTED_LOOPS(name, Name)                                                                                      \
    LOOP(name##_shares_n, (const Lobe *m, size_t n, LOOP_PAIRS, float *restrict f, float *restrict s),                 \
         (m, n, LOOP_NAMES, f, s)) {                                                                                   \
        Name##Prepared p;                                                                                              \
        name##_prepare(name##_of(m), &p);                                                                              \
        BY_COUNT(EACH_PAIR(name, Name, f[k] = counts ? v.f : 0.0f; s[k] = counts ? v.s : 0.0f))                        \
    }                                                                                                                  \
    static void name##_f_n(const Lobe *m, size_t n, LOOP_PAIRS, float *restrict f) {                                   \
        enum { SOME = 1024 };                                                                                          \
        float s[SOME];                                                                                                 \
        for (size_t k = 0; k < n; k += SOME)                                                                           \
            name##_shares_n(m, n - k < SOME ? n - k : SOME, ox + k, oy + k, oz + k, ix + k, iy + k, iz + k, f + k, s); \
    }

/* f of a tinted lobe in three channels, made of what has albedo c. */
#define TINTED_LOOP(name, Name)                                                                                        \
    LOOP(name##_tinted_n,                                                                                              \
         (const Lobe *m, const float c[3], size_t n, LOOP_PAIRS, float *restrict r, float *restrict g,                 \
          float *restrict b),                                                                                          \
         (m, c, n, LOOP_NAMES, r, g, b)) {                                                                             \
        float c_r = c[0], c_g = c[1], c_b = c[2];                                                                      \
        EACH_VALUE(name, Name, float f = counts ? v.f : 0.0f; r[k] = f * tint_color(v.tint, c_r);                      \
                   g[k] = f * tint_color(v.tint, c_g); b[k] = f * tint_color(v.tint, c_b))                             \
    }

/* The loops over pairs of a lobe of each kind, in cmake/lobes.cmake's words, and where they stand in LobeLoops. */
#define PAIR_LOOPS_single(name, Name) LOBE_LOOP(pdf, name, Name) LOBE_LOOP(f, name, Name)
#define PAIR_LOOPS_shares(name, Name) PAIR_LOOPS_single(name, Name) SHARES_LOOP(name, Name)
#define PAIR_LOOPS_tinted(name, Name) PAIR_LOOPS_single(name, Name) TINTED_LOOP(name, Name)
#define PAIR_LOOPS_rounds(name, Name) LOBE_LOOP(pdf, name, Name) COUNTED_LOOPS(name, Name)
#define PAIR_PLACES_single(name)      name##_f_n, name##_pdf_n, NULL, NULL
#define PAIR_PLACES_shares(name)      name##_f_n, name##_pdf_n, name##_shares_n, NULL
#define PAIR_PLACES_tinted(name)      name##_f_n, name##_pdf_n, NULL, name##_tinted_n
#define PAIR_PLACES_rounds(name)      PAIR_PLACES_shares(name)
