/* each_loop.h - the two loops of a lobe in which each element has numbers of its own, for each_NAME.c (cmake/lobes.cmake)
 * and plugins (plugin.h)
 *
 * What depends on parameters alone is made anew for each element, so these take longer than those of lobe_loop.h, which
 * make it once. */
#pragma once

#include "shading/lobe/each.h"
#include "shading/lobe/lobe_loop.h"
#include "shading/lobe/traits.h"

/* The arrays of a pair in variables of their own, as loops want them. */
#define TAKE_PAIRS(e)                                                                                                  \
    const float *ox = (e)->o[0], *oy = (e)->o[1], *oz = (e)->o[2], *ix = (e)->i[0], *iy = (e)->i[1], *iz = (e)->i[2];  \
    float *r = (e)->f[0]
#define TAKE_COLORS(e)                                                                                                 \
    const float *r0 = (e)->f0[0], *g0 = (e)->f0[1], *b0 = (e)->f0[2];                                                  \
    const float *r90 = (e)->f90[0], *g90 = (e)->f90[1], *b90 = (e)->f90[2];                                            \
    float *g = (e)->f[1], *b = (e)->f[2]

/* The value in the colours of an element. */
#define PUT_COLORS(value, color)                                                                                       \
    r[k] = (value)*color(r0[k], r90[k]);                                                                               \
    g[k] = (value)*color(g0[k], g90[k]);                                                                               \
    b[k] = (value)*color(b0[k], b90[k])
#define TAKE_DRAWS(e)                                                                                                  \
    const float *ox = (e)->o[0], *oy = (e)->o[1], *oz = (e)->o[2], *us = (e)->u, *vs = (e)->v;                         \
    float *x = (e)->drawn[0], *y = (e)->drawn[1], *z = (e)->drawn[2]

/* An o that counts, or the normal. */
#define TAKE_ONE(o, counts)                                                                                            \
    Dir o = {ox[k], oy[k], oz[k]};                                                                                     \
    bool counts = pair_counts(o, dir(0.0f, 0.0f, 1.0f));                                                               \
    o = (Dir) { counts ? o.x : 0.0f, counts ? o.y : 0.0f, counts ? o.z : 1.0f }
#define PUT_DRAWN(i, counts)                                                                                           \
    x[k] = counts ? (i).x : 0.0f;                                                                                      \
    y[k] = counts ? (i).y : 0.0f;                                                                                      \
    z[k] = counts ? (i).z : 0.0f

/* The parameters of an element; a choice of terms is that of all. */
#define EACH_PLACE(type, name, ...) place_##name,
#define EACH_ARRAY(type, name, ...) const float *own_##name = e->params[place_##name];
#define EACH_OWN(type, name, ...)   m.name = OWN_##type(own_##name[k], m.name);
#define OWN_float(own, all)         (own)
#define OWN_DTerm(own, all)         (all)
#define OWN_VTerm(own, all)         (all)
#define OWN_FTerm(own, all)         (all)
#define TAKE_OWN(name, Name, NAME)                                                                                     \
    enum { NAME##_PARAMS(EACH_PLACE) EACH_PLACES };                                                                    \
    const Name all = name##_of(&e->lobe);                                                                              \
    NAME##_PARAMS(EACH_ARRAY)

/* Prepares the lobe of an element and its view of o. rounds: ALL_ROUNDS of a lobe with a count (BY_COUNT), which differs
 * from element to element, or ITS_ROUNDS. */
#define ITS_ROUNDS(p)
#define TAKE_VIEW(name, Name, NAME, rounds)                                                                            \
    Name m = all;                                                                                                      \
    NAME##_PARAMS(EACH_OWN);                                                                                           \
    Name##Prepared p;                                                                                                  \
    name##_prepare(m, &p);                                                                                             \
    rounds(p);                                                                                                         \
    Name##View w;                                                                                                      \
    name##_view(&p, o, &w)

/* second: name_second, or EACH_F90. n is a multiple of EACH_GROUP (each.h): half of a loop's code would be for what is left
 * otherwise. */
#define EACH_WHOLE(n)        ((n) & ~(size_t)(EACH_GROUP - 1))
#define EACH_F90(m, f0, f90) (f90)
#define EACH_LOOPS(name, Name, NAME, second, rounds)                                                                   \
    FN float name##_each_color(Name m, LobeValue v, float f0, float f90) {                                             \
        if (NAME##_TRAITS & TRAIT_TINTED) return tint_color(v.tint, f0);                                               \
        return NAME##_TRAITS & TRAIT_TWO_COLORS ? mix(f0, second(m, f0, f90), v.s) : f0;                               \
    }                                                                                                                  \
    LOOP(name##_each_n, (const Each *e, size_t n), (e, n)) {                                                           \
        TAKE_PAIRS(e);                                                                                                 \
        TAKE_COLORS(e);                                                                                                \
        float *pdf = e->pdf;                                                                                           \
        TAKE_OWN(name, Name, NAME)                                                                                     \
        EACH(k, EACH_WHOLE(n)) {                                                                                       \
            TAKE_PAIR(o, i, counts);                                                                                   \
            TAKE_VIEW(name, Name, NAME, rounds);                                                                       \
            LobeValue v = name##_value(&p, &w, angles_between(o, i));                                                  \
            float f = counts ? v.f : 0.0f;                                                                             \
            r[k] = f * name##_each_color(m, v, r0[k], r90[k]);                                                         \
            g[k] = f * name##_each_color(m, v, g0[k], g90[k]);                                                         \
            b[k] = f * name##_each_color(m, v, b0[k], b90[k]);                                                         \
            pdf[k] = counts ? v.pdf : 0.0f;                                                                            \
        }                                                                                                              \
    }                                                                                                                  \
    LOOP(name##_drawn_each_n, (const Each *e, size_t n), (e, n)) {                                                     \
        TAKE_DRAWS(e);                                                                                                 \
        TAKE_OWN(name, Name, NAME)                                                                                     \
        EACH(k, EACH_WHOLE(n)) {                                                                                       \
            TAKE_ONE(o, counts);                                                                                       \
            TAKE_VIEW(name, Name, NAME, rounds);                                                                       \
            Dir i = name##_sample(&p, &w, o, us[k], vs[k]);                                                            \
            PUT_DRAWN(i, counts);                                                                                      \
        }                                                                                                              \
    }
