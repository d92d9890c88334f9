/* weave_point.h - the point of a woven cloth at a place: which thread lies on top there, and how it lies
 *
 *   z = (l / 2) m (1 - |s|^(k + 1)) / (k + 1) + (w / 4) q (1 - r^2),   negative first term below a crossing
 *
 * x counts warp threads from the left, y picks from the bottom. A thread is runs
 * of l crossings on top and of l below, in turn; s in [-1, 1] goes along a run, r across the thread of width
 * w. m is the tangent of the steepest angle, q the slope at the thread's edge, k = 1 + floats (l - 1): a long
 * float lies level but for its ends. Own. Of all threads at a place the highest is seen, so that threads
 * whose width, place and height vary still cover each other as threads do.
 *   What varies does so by hashes of the number of the thread, counted on through all repeats: the draft
 * repeats, the cloth does not. A float that counts more than a million threads has no fractions left. */
#ifndef WEFT_SHADING_WEAVE_POINT_H
#define WEFT_SHADING_WEAVE_POINT_H

#include "shading/dust.h"
#include "shading/table.h"

/* The yarn of one system as it lies in a cloth. Widths are in its own pitch; pitches and heights have a common
 * unit.
 *   alpha, crimp, roundness, twist: as lobe yarn has them; crimp: tangent. white: share of light that one fibre reflects
 * without its dye. pitch, cross_pitch: from thread to thread, of its own system and of the other. width, bulge: of a
 * thread, and how much wider the middle of a float is. streaks, dye, slub, wander: how far slopes, albedo, width and
 * place vary. */
#define WEAVE_YARN_NUMBERS(N)                                                                                \
    N(alpha)                                                                                                 \
    N(crimp)                                                                                                 \
    N(roundness)                                                                                             \
    N(twist)                                                                                                 \
    N(white)                                                                                                 \
    N(pitch)                                                                                                 \
    N(cross_pitch)                                                                                           \
    N(width)                                                                                                 \
    N(bulge) N(floats) N(streaks) N(dye) N(slub) N(wander)

/* One system from afar: the numbers of the lobe woven that reflects as its visible points do on the mean, and how
 * far their slopes reach across it and along, were they uniform, by which yarns hide each other.
 *   crimp: tangent. share: of the cloth, as seen from above; what is left are gaps. */
#define WEAVE_FAR_NUMBERS(N) N(alpha) N(crimp) N(roundness) N(floats) N(slope_across) N(slope_along) N(share)

#define WEAVE_NUMBER(name) float name;
STRUCT(WeaveYarn){WEAVE_YARN_NUMBERS(WEAVE_NUMBER)};
STRUCT(WeaveFar){WEAVE_FAR_NUMBERS(WEAVE_NUMBER)};

/* A cloth. runs holds a row for each pick and four numbers for each warp thread: of the warp and of the weft
 * the crossings since their runs began, and their lengths, negative where they lie below; a run that never
 * ends has length 0. albedos holds a row for each thread, warp first: the fibres' albedo by channel. */
STRUCT(Weave) {
    int warps, picks;
    WeaveYarn warp, weft;
    float seed;
    WeaveFar warp_far, weft_far;
    float low, high;        /* between them heights lie */
    float openness;         /* the mean of weave_depth */
    float cycle_x, cycle_y; /* threads after which what varies comes again; 0: never */
    Table runs, albedos;
};

STRUCT(WeavePoint) {
    float height;           /* below any, where there is no thread */
    bool weft;              /* of the weft */
    float thread;           /* number of the thread, through all repeats */
    float r, s, k;          /* across and along; the power of the slope along it */
    float slope_x, slope_y; /* as lobe yarn has them, along the cloth's x and y */
    Dir fibre;              /* along the fibres, unit */
    float dye;              /* factor on the amount of dye */
};

#define WEAVE_NONE (-1e6f)

/* A shader has the tables of cloths in a texture of their own, and defines this. */
#ifndef weave_texel
#define weave_texel(t, stride, row, column) table_texel(t, stride, row, column)
#endif

/* x mod n of a whole number, n > 0. */
FN float weave_mod(float x, float n) {
    float m = x - n * floor(x / n);
    return m >= n ? m - n : m < 0.0f ? m + n : m;
}

/* A hash of a thread, 0 .. 288, and one of such a hash and a purpose. */
FN float weave_hash(float thread) {
    float low = weave_mod(thread, 289.0f), high = weave_mod(floor(thread / 289.0f), 289.0f);
    return dust_hash(dust_sum(dust_hash(high), low));
}
FN float weave_key(float hash, float purpose) { return dust_hash(dust_sum(hash, dust_mod(purpose))); }

/* From -1 to 1: for a key; smooth along t, which comes again after n; smooth over a plane. */
FN float weave_random(float key) { return dust_hash(key) / 144.0f - 1.0f; }
FN float weave_course(float key, float t, float n) {
    float i = floor(t), a = weave_mod(i, n), b = a + 1.0f < n ? a + 1.0f : 0.0f;
    return mix(weave_random(dust_sum(key, dust_mod(a))), weave_random(dust_sum(key, dust_mod(b))),
               dust_ease(t - i));
}
FN float weave_plane(float key, float t, float n, float u, float m) {
    float i = floor(u), a = weave_mod(i, m), b = a + 1.0f < m ? a + 1.0f : 0.0f;
    return mix(weave_course(dust_hash(dust_sum(key, dust_mod(a))), t, n),
               weave_course(dust_hash(dust_sum(key, dust_mod(b))), t, n), dust_ease(u - i));
}

/* A frequency in a crossing: about f > 0 times, and a whole number of times in a cycle; and how
 * often in that. Hashes repeat after 289, where there is no cycle. */
FN float weave_turns(float f, float cycle) {
    return cycle > 0.0f ? max(floor(f * cycle + 0.5f), 1.0f) : 289.0f;
}
FN float weave_pace(float f, float cycle) { return cycle > 0.0f ? weave_turns(f, cycle) / cycle : f; }

/* A slanted lattice moves in a crossing: by about f, and by a multiple of 40 lattice points in a cycle. */
FN float weave_lean(float f, float cycle) {
    return cycle > 0.0f ? 40.0f * floor(f * cycle / 40.0f + 0.5f) / cycle : f;
}

/* The number of a column of runs: column 0 and 1 are of the warp. */
FN float weave_run(const Weave *m, float warp, float pick, int column) {
    int row = to_int(weave_mod(pick, to_float(m->picks))), at = to_int(weave_mod(warp, to_float(m->warps)));
    return weave_texel(m->runs, 4 * m->warps, row, 4 * at + column);
}

/* A random course along a thread, of about f turns a crossing. */
FN float weave_along(float key, float f, float v, float cycle) {
    float pace = weave_pace(f, cycle);
    return weave_course(key, pace * v, weave_turns(pace, cycle));
}

/* The hash of a thread in a cycle of them. */
FN float weave_hash_of(float thread, float cycle) {
    return weave_hash(cycle > 0.0f ? weave_mod(thread, cycle) : thread);
}

/* The thread numbered c of a system at the place u across the system, v along it. */
FN WeavePoint weave_thread(const Weave *m, WeaveYarn y, bool weft, float c, float u, float v) {
    float cross = floor(v), seed = m->seed + (weft ? 97.0f : 0.0f);
    float side = weft ? m->cycle_y : m->cycle_x, cycle = weft ? m->cycle_x : m->cycle_y;
    float since = weave_run(m, weft ? cross : c, weft ? c : cross, weft ? 2 : 0);
    float run = weave_run(m, weft ? cross : c, weft ? c : cross, weft ? 3 : 1);
    bool ends = abs(run) > 0.5f;
    float l = max(abs(run), 1.0f), s = ends ? 2.0f * (v - cross + since) / l - 1.0f : 0.0f;
    float up = run < 0.0f ? -1.0f : 1.0f, k = 1.0f + y.floats * (l - 1.0f),
          steep = pow(max(abs(s), 1e-3f), k);
    float crimp = ends ? y.crimp : 0.0f, begin = cross - since, hash = weave_hash_of(c, side);
    crimp = crimp * (1.0f + 0.5f * y.wander * weave_along(weave_key(hash, seed + 5.0f), 1.0f, begin, cycle));
    float aside = 0.12f * y.wander * weave_along(weave_key(hash, seed + 1.0f), 0.21f, v, cycle);
    float thick = 1.0f + y.slub * (0.35f * weave_along(weave_key(hash, seed + 2.0f), 0.06f, v, cycle) +
                                   0.12f * weave_along(weave_key(hash, seed + 3.0f), 0.9f, v, cycle));
    float swell = up > 0.0f ? y.bulge * (1.0f - s * s) * (1.0f - 1.0f / l) : 0.0f;
    float width = min(y.width * max(thick, 0.2f) * (1.0f + swell), 2.0f - 2.0f * abs(aside));
    float r = 2.0f * (u - c - 0.5f - aside) / width;
    float arc = up * 0.5f * l * y.cross_pitch * crimp * (1.0f - abs(s) * steep) / (k + 1.0f);

    WeavePoint p;
    p.height = abs(r) < 1.0f ? arc + 0.25f * width * y.pitch * y.roundness * (1.0f - r * r) : WEAVE_NONE;
    p.weft = weft;
    p.thread = c;
    p.r = r;
    p.s = s;
    p.k = k;
    p.slope_x = y.roundness * r;
    p.slope_y = up * crimp * (s < 0.0f ? -steep : steep);
    p.fibre = dir(0.0f, 1.0f, 0.0f);
    p.dye = 1.0f;
    return p;
}

FN void weave_higher(WeavePoint *best, WeavePoint p) {
    if (p.height > best->height) *best = p;
}

/* Adds streaks along the twist, and how the dye took. Then turns the point from the thread's frame, along y, to
 * the cloth's. */
FN void weave_finish(const Weave *m, WeaveYarn y, float u, float v, WeavePoint *p) {
    float seed = m->seed + (p->weft ? 97.0f : 0.0f), side = p->weft ? m->cycle_y : m->cycle_x;
    float cycle = p->weft ? m->cycle_x : m->cycle_y, hash = weave_hash_of(p->thread, side);
    float key = weave_key(hash, seed + 7.0f);
    float twist = p->weft ? -y.twist : y.twist; /* across and along are x and y, mirrored */
    float c = cos(twist) / y.width, s = sin(twist) / y.width, x = u - p->thread;
    float fine = weave_lean(14.0f * s, cycle), wide = weave_lean(9.0f * s, cycle);
    float on = weave_pace(1.3f * c, cycle), slant = cycle > 0.0f ? 40.0f : 289.0f,
          turns = weave_turns(1.3f * c, cycle);
    float grain = weave_plane(key, 14.0f * c * x + fine * v, slant, on * v - 1.3f * s * x, turns);
    float waver =
        weave_plane(dust_sum(key, 31.0f), 9.0f * c * x + wide * v, slant, on * v - 1.3f * s * x, turns);
    float turn = twist + 0.35f * y.streaks * waver, ct = cos(turn), st = sin(turn);
    float sx = p->slope_x + y.streaks * grain, sy = p->slope_y;
    float n = 1.0f / sqrt(1.0f + sx * sx + sy * sy), t = 1.0f / sqrt(1.0f + sy * sy);
    float fx = -st * n / t, fy = ct * t + st * sx * sy * t * n, fz = -ct * t * sy + st * sx * t * n;
    p->dye = 1.0f - y.dye * (0.7f * weave_random(weave_key(hash, seed + 4.0f)) +
                             0.3f * weave_along(key, 0.35f, v, cycle) + 0.5f * y.streaks * grain);
    p->slope_x = p->weft ? sy : sx;
    p->slope_y = p->weft ? sx : sy;
    p->fibre = p->weft ? dir(fy, fx, fz) : dir(fx, fy, fz);
}

/* The point at x, y. No thread reaches further than the middle of the next one's place: of either system the two
 * nearest are asked. */
FN WeavePoint weave_point(const Weave *m, float x, float y) {
    float i = floor(x), j = floor(y), beside = x - i < 0.5f ? -1.0f : 1.0f,
          above = y - j < 0.5f ? -1.0f : 1.0f;
    WeavePoint best = weave_thread(m, m->warp, false, i, x, y);
    weave_higher(&best, weave_thread(m, m->warp, false, i + beside, x, y));
    weave_higher(&best, weave_thread(m, m->weft, true, j, y, x));
    weave_higher(&best, weave_thread(m, m->weft, true, j + above, y, x));
    if (best.height <= WEAVE_NONE) {
        best.slope_x = 0.0f;
        best.slope_y = 0.0f;
        return best;
    }
    if (best.weft)
        weave_finish(m, m->weft, y, x, &best);
    else
        weave_finish(m, m->warp, x, y, &best);
    return best;
}

/* The fibres' albedo at a point, one channel, without white: fibres of albedo A absorb as the dye in them
 * does, (1 - A) / A of what they scatter. */
FN float weave_albedo(const Weave *m, WeavePoint p, int channel) {
    int row = p.weft ? m->warps + to_int(weave_mod(p.thread, to_float(m->picks)))
                     : to_int(weave_mod(p.thread, to_float(m->warps)));
    float a = weave_texel(m->albedos, 3, row, channel);
    return a / max(a + (1.0f - a) * max(p.dye, 0.1f), 1e-6f);
}

/* The part of light that does not reach the lowest places. */
#define WEAVE_SHADE 0.7f

/* The light that reaches a point of that depth between threads, in parts of what reaches their crowns; and in
 * parts of the mean, so that crevices take from no cloth as a whole. */
FN float weave_depth(const Weave *m, WeavePoint p) {
    float depth = clamp((m->high - p.height) / max(m->high - m->low, 1e-6f), 0.0f, 1.0f);
    return 1.0f - WEAVE_SHADE * depth * depth;
}
FN float weave_open(const Weave *m, WeavePoint p) { return weave_depth(m, p) / m->openness; }

#endif
