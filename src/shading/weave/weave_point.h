/* weave_point.h - the point of a woven cloth at a place: which thread lies on top there, and how it lies
 *
 *   z = (l / 2) m (1 - |s|^(k + 1)) / (k + 1) + (w / 4) q (1 - r^2),   negative first term below a crossing
 *
 * x counts warp threads from the left, y picks from the bottom. A thread is runs
 * of l crossings on top and of l below, in turn; s in [-1, 1] goes along a run, r across the thread of width
 * w. m is the tangent of the steepest angle, q the slope at the thread's edge, k = 1 + floats (l - 1): a long
 * float lies level but for its ends. Own. Of all threads at a place the highest is seen, so that threads
 * whose width, place and height vary still cover each other as threads do.
 *   Near by a thread is a bundle of fibres along its twist, each with a round back and dark crevices beside it, and
 * some fibres have come loose and lie across the cloth. What is finer than the distance of the points that are looked at
 * is left out, and its mean stays; but light that grazes finds what slopes towards it, so that fibres keep their slopes: a
 * point then lies across its fibre where the caller says.
 *   A float that counts more than a million threads has no fractions left, and fibres lose their shape from a hundred
 * thousand on. */
#ifndef WEFT_SHADING_WEAVE_POINT_H
#define WEFT_SHADING_WEAVE_POINT_H

#include "shading/lobe/table.h"
#include "shading/weave/weave_cell.h"
#include "shading/weave/weave_noise.h"

/* The yarn of one system as it lies in a cloth. Widths are in its own pitch; pitches and heights have a common
 * unit.
 *   alpha, crimp, roundness, twist: as lobe yarn has them; crimp: tangent. white: share of light that one fibre reflects
 * without its dye. pitch, cross_pitch: from thread to thread, of its own system and of the other. width, bulge: of a
 * thread, and how much wider the middle of a float is. streaks: slope at the edges of a fibre. dye, slub, wander: how far
 * albedo, width and place vary. hairiness: part of the places for loose fibres that have one. over_width, cos_twist,
 * sin_twist, crossing: what these make of width, twist and pitches, once for all points. */
#define WEAVE_YARN_NUMBERS(N)                                                                                \
    N(alpha)                                                                                                 \
    N(crimp)                                                                                                 \
    N(roundness)                                                                                             \
    N(twist)                                                                                                 \
    N(white)                                                                                                 \
    N(pitch)                                                                                                 \
    N(cross_pitch)                                                                                           \
    N(width)                                                                                                 \
    N(bulge)                                                                                                 \
    N(floats)                                                                                                \
    N(streaks) N(dye) N(slub) N(wander) N(hairiness) N(over_width) N(cos_twist) N(sin_twist) N(crossing)

/* One system from afar: numbers of the lobe woven that is fitted to its visible points (weave/woven_fit.c has the others),
 * and how far their slopes reach across it and along, were they uniform, by which yarns hide each other.
 *   crimp: tangent. share: of the cloth, as seen from above; what is left are gaps. once, again: factors on the lobe's
 * colours, which make it as bright as the points are. */
#define WEAVE_FAR_NUMBERS(N)                                                                                 \
    N(alpha) N(crimp) N(roundness) N(floats) N(slope_across) N(slope_along) N(share) N(once) N(again)

#define WEAVE_NUMBER(name) float name;
STRUCT(WeaveYarn){WEAVE_YARN_NUMBERS(WEAVE_NUMBER)};
STRUCT(WeaveFar){WEAVE_FAR_NUMBERS(WEAVE_NUMBER)};

/* A cloth. runs holds a row for each pick and the four numbers of a WeaveCell for each warp thread. albedos holds a row
 * for each thread, warp first: the fibres' albedo by channel. */
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
    float lit;              /* by the light that falls on the thread, in parts of its mean */
};

#define WEAVE_NONE (-1e6f)

/* A shader has the tables of cloths in a texture of their own, and defines these. */
#ifndef weave_texel
#define weave_texel(t, stride, row, column)  table_texel(t, stride, row, column)
#define weave_cell_texel(t, stride, row, at) weave_cell_of(t, 4 * (stride), row, 4 * (at))
FN WeaveCell weave_cell_of(Table t, int stride, int row, int column) {
    WeaveCell c;
    c.warp_since = table_texel(t, stride, row, column);
    c.warp_run = table_texel(t, stride, row, column + 1);
    c.weft_since = table_texel(t, stride, row, column + 2);
    c.weft_run = table_texel(t, stride, row, column + 3);
    return c;
}
#endif

FN WeaveCell weave_cell(const Weave *m, float warp, float pick) {
    int row = to_int(weave_mod(pick, to_float(m->picks))), at = to_int(weave_mod(warp, to_float(m->warps)));
    return weave_cell_texel(m->runs, m->warps, row, at);
}

/* Purposes of hashes: crossings; of the warp, and next to it of the weft, courses of threads, dye of threads and along
 * them, how fibres waver and how each one's dye took; loose fibres, as many as a cell has. */
#define WEAVE_OF_CROSSINGS 0
#define WEAVE_OF_THREADS   1
#define WEAVE_OF_DYE       3
#define WEAVE_OF_STREAKS   5
#define WEAVE_OF_WAVER     7
#define WEAVE_OF_FIBRES    9
#define WEAVE_OF_HAIRS     11

/* The thread numbered c of a system at the place u across the system, v along it. since, run: of the cell there. bends: -1
 * to 1, how thick it is and how far it bends at its crossings, smoothly from one to the next. */
FN WeavePoint weave_thread(const Weave *m, WeaveYarn y, bool weft, float c, float u, float v, float since,
                           float run, float bends) {
    float side = weft ? m->cycle_y : m->cycle_x, cycle = weft ? m->cycle_x : m->cycle_y;
    float ends =
        abs(run) > 0.5f ? 1.0f : 0.0f; /* a factor: a load behind a branch keeps loops from vectors */
    float l = max(abs(run), 1.0f), over_l = 1.0f / l,
          s = ends * (2.0f * (v - floor(v) + since) * over_l - 1.0f);
    float up = run < 0.0f ? -1.0f : 1.0f, k = 1.0f + y.floats * (l - 1.0f),
          steep = pow(max(abs(s), 1e-3f), k);
    WeavePair slow = weave_courses(m->seed, WEAVE_OF_THREADS + (weft ? 1 : 0), weave_wrap(c, side),
                                   weave_along(0.1f, v, cycle));
    float crimp = ends * y.crimp * (1.0f + 0.5f * y.wander * bends);
    float aside = 0.12f * y.wander * slow.first;
    float thick = 1.0f + y.slub * (0.35f * slow.second + 0.12f * bends);
    float swell = up > 0.0f ? y.bulge * (1.0f - s * s) * (1.0f - over_l) : 0.0f;
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
    p.lit = 1.0f;
    return p;
}

FN void weave_higher(WeavePoint *best, WeavePoint p) {
    if (p.height > best->height) *best = p;
}

/* Fibres side by side in a thread, and how many differ in it; places across it after which they waver alike; half the
 * width of a loose one, in threads. */
#define WEAVE_FIBRES      20.0f
#define WEAVE_WAVES       8.0f
#define WEAVE_FIBRES_OWN  40.0f
#define WEAVE_HAIR_RADIUS 0.018f

/* Crevices of fibres and where they lie fade as the spacing of points grows, in widths of the thread; a whole fibre's width
 * leaves none. The width of loose fibres fades later, since their colours tell them from what is below. */
FN float weave_fineness(float spacing) { return clamp(1.5f - 30.0f * spacing, 0.0f, 1.0f); }
FN float weave_hair_radius(float spacing) {
    return WEAVE_HAIR_RADIUS * clamp(1.75f - 25.0f * spacing, 0.0f, 1.0f);
}

/* -1 to 1: how the dye took of the thread of either system, of a cycle of them. */
FN float weave_thread_dye(float seed, bool weft, float thread, float cycle) {
    return weave_first(weave_key(seed, WEAVE_OF_DYE + (weft ? 1 : 0), weave_wrap(thread, cycle), 0.0f));
}

/* Cosine and sine of an angle of at most 0.7, by their series: within 2e-5. */
STRUCT(WeaveTurn) { float c, s; };
FN WeaveTurn weave_turn(float angle) {
    float a2 = angle * angle;
    WeaveTurn t;
    t.c = 1.0f - a2 * (0.5f - a2 * (1.0f / 24.0f - a2 / 720.0f));
    t.s = angle * (1.0f - a2 * (1.0f / 6.0f - a2 / 120.0f));
    return t;
}

/* Adds fibres along the twist, and how the dye took, and turns the point from the thread's frame, along y, to the cloth's.
 * Crevices between fibres, 1 - a f^4 where f goes from -1 to 1 across a fibre, take no light on the mean. across, from -1
 * to 1: the place across a fibre, of points so far apart that they do not tell; between, both have a part, and slopes vary
 * as much. */
FN void weave_finish(const Weave *m, WeaveYarn y, float u, float v, float spacing, float across,
                     WeavePoint *p) {
    float side = p->weft ? m->cycle_y : m->cycle_x, cycle = p->weft ? m->cycle_x : m->cycle_y;
    float thread = weave_wrap(p->thread, side);
    int weft = p->weft ? 1 : 0;
    float sin_twist = p->weft ? -y.sin_twist : y.sin_twist; /* across and along are x and y, mirrored */
    float c = y.cos_twist * y.over_width, s = sin_twist * y.over_width, x = u - p->thread;
    float c_v = c * y.crossing, s_v = s * y.crossing; /* v counts the others */
    float on = weave_pace(1.3f * c_v, cycle), turns = weave_turns(1.3f * c_v, cycle),
          t = on * v - 1.3f * s * x;
    WeaveStep down = weave_step(t, turns),
              over = weave_step(3.0f * c * x + weave_lean(3.0f * s_v, WEAVE_WAVES, cycle) * v, WEAVE_WAVES);
    float waver =
        mix(weave_course(m->seed, WEAVE_OF_WAVER + weft, thread, over.low, WEAVE_WAVES, down),
            weave_course(m->seed, WEAVE_OF_WAVER + weft, thread, over.high, WEAVE_WAVES, down), over.part);
    float fibre =
        WEAVE_FIBRES * c * x + weave_lean(WEAVE_FIBRES * s_v, WEAVE_FIBRES_OWN, cycle) * v + 2.0f * waver;
    float number = floor(fibre), f = 2.0f * (fibre - number) - 1.0f,
          fine = weave_fineness(spacing * y.over_width), streaks = y.streaks * fine;
    float own = weave_course(m->seed, WEAVE_OF_FIBRES + weft, thread, weave_mod(number, WEAVE_FIBRES_OWN),
                             WEAVE_FIBRES_OWN, down);
    WeaveTurn turn = weave_turn(0.35f * y.streaks * waver);
    float ct = y.cos_twist * turn.c - sin_twist * turn.s, st = sin_twist * turn.c + y.cos_twist * turn.s;
    float sx = p->slope_x +
               y.streaks * mix(across, f, fine) / sqrt(fine * fine + (1.0f - fine) * (1.0f - fine)),
          sy = p->slope_y;
    float n = 1.0f / sqrt(1.0f + sx * sx + sy * sy), q = 1.0f / sqrt(1.0f + sy * sy);
    float fx = -st * n * q * (1.0f + sy * sy), fy = ct * q + st * sx * sy * q * n,
          fz = -ct * q * sy + st * sx * q * n;
    float crevice = min(2.0f * streaks, 0.6f);
    WeavePair taken = weave_courses(m->seed, WEAVE_OF_STREAKS + weft, thread, weave_along(0.35f, v, cycle));
    p->dye = 1.0f -
             y.dye * (0.7f * weave_thread_dye(m->seed, p->weft, p->thread, side) + 0.3f * taken.first) -
             0.5f * min(streaks, 0.5f) * own;
    p->lit = (1.0f - crevice * f * f * f * f) / (1.0f - 0.2f * crevice);
    p->slope_x = p->weft ? sy : sx;
    p->slope_y = p->weft ? sx : sy;
    p->fibre = p->weft ? dir(fy, fx, fz) : dir(fx, fy, fz);
}

/* A hash of a crossing, for the warp and for the weft. */
FN uint weave_crossing(const Weave *m, float i, float j) {
    return weave_key(m->seed, WEAVE_OF_CROSSINGS, weave_wrap(i, m->cycle_x), weave_wrap(j, m->cycle_y));
}

/* The highest thread at x, y, in its own frame and without its fibres. No thread reaches further than the middle of the
 * next one's place: of either system the two nearest are asked. Threads vary from crossing to crossing by what the four
 * nearest crossings have, which all of them share. */
FN WeavePoint weave_top(const Weave *m, float x, float y) {
    float i = floor(x), j = floor(y), near_x = x - i - 0.5f, near_y = y - j - 0.5f;
    float beside = i + (near_x < 0.0f ? -1.0f : 1.0f), above = j + (near_y < 0.0f ? -1.0f : 1.0f);
    float part_x = weave_ease(abs(near_x)), part_y = weave_ease(abs(near_y));
    uint here = weave_crossing(m, i, j), right = weave_crossing(m, beside, j),
         up = weave_crossing(m, i, above), across = weave_crossing(m, beside, above);
    WeaveCell cell = weave_cell(m, i, j), cell_right = weave_cell(m, beside, j),
              cell_up = weave_cell(m, i, above);
    WeavePoint best = weave_thread(m, m->warp, false, i, x, y, cell.warp_since, cell.warp_run,
                                   mix(weave_first(here), weave_first(up), part_y));
    WeavePoint weft = weave_thread(m, m->weft, true, j, y, x, cell.weft_since, cell.weft_run,
                                   mix(weave_second(here), weave_second(right), part_x));
    weave_higher(&best,
                 weave_thread(m, m->warp, false, beside, x, y, cell_right.warp_since, cell_right.warp_run,
                              mix(weave_first(right), weave_first(across), part_y)));
    weave_higher(&weft, weave_thread(m, m->weft, true, above, y, x, cell_up.weft_since, cell_up.weft_run,
                                     mix(weave_second(up), weave_second(across), part_x)));
    bool is_weft = weft.height > best.height; /* copied, a truth would keep loops from vectors */
    weave_higher(&best, weft);
    best.weft = is_weft;
    return best;
}

/* The yarn of either system, without a branch. */
#define WEAVE_CHOOSE(name) y.name = weft ? m->weft.name : m->warp.name;
FN WeaveYarn weave_yarn_of(const Weave *m, bool weft) {
    WeaveYarn y;
    WEAVE_YARN_NUMBERS(WEAVE_CHOOSE)
    return y;
}

/* The point of a thread at x, y, with its fibres but for loose ones. A place without a thread has no slopes. */
FN WeavePoint weave_bound(const Weave *m, float x, float y, float spacing, float across) {
    WeavePoint p = weave_top(m, x, y);
    weave_finish(m, weave_yarn_of(m, p.weft), p.weft ? y : x, p.weft ? x : y, spacing, across, &p);
    p.slope_x = p.height > WEAVE_NONE ? p.slope_x : 0.0f;
    p.slope_y = p.height > WEAVE_NONE ? p.slope_y : 0.0f;
    return p;
}

/* A loose fibre at a point near it: whether the point is on it, and at what parts of its length and width, from -1 to 1;
 * number and system of the thread that it comes from; cosine and sine of its angle with that, and its slope there. */
STRUCT(WeaveHair) {
    bool here, weft;
    float along, across, thread, c, s, lean;
};

/* Loose fibres: in each cell of about two threads by two there are places for a few. None reaches further than 0.9 threads,
 * and half a cell is at least 0.94. */
#define WEAVE_HAIRS      4
#define WEAVE_HAIRS_NEAR (4 * WEAVE_HAIRS)

/* Fibre n of those near x, y, from a thread at its middle, of either system in proportion to what is seen of them: an S
 * from the thread's own direction, across = (q - l (b + w t) (1 - t^2)) / (radius sqrt(1 + lean^2)) with t from -1 to 1
 * along it and lean the slope of the S, thinner to its ends. Lengths are in threads of the finer system, which count as
 * long along as across. */
FN WeaveHair weave_hair(const Weave *m, int n, float x, float y, float radius) {
    float pace_x = weave_pace(0.5f, m->cycle_x), pace_y = weave_pace(0.5f, m->cycle_y);
    int cell_x = n / (2 * WEAVE_HAIRS), cell_y = n / WEAVE_HAIRS % 2;
    float i = floor(x * pace_x - 0.5f) + to_float(cell_x), j = floor(y * pace_y - 0.5f) + to_float(cell_y);
    float column = weave_wrap(i, weave_turns(pace_x, m->cycle_x)),
          row = weave_wrap(j, weave_turns(pace_y, m->cycle_y));
    uint place = weave_key(m->seed, WEAVE_OF_HAIRS + n % WEAVE_HAIRS, column, row),
         shape = weave_hash(place + 0x9e3779b9u);
    float middle_x = (i + 0.5f + 0.5f * weave_bits(place, 21u, 11u)) / pace_x;
    float middle_y = (j + 0.5f + 0.5f * weave_bits(place, 10u, 11u)) / pace_y;
    float covers = m->warp_far.share + m->weft_far.share;
    bool weft = (0.5f + 0.5f * weave_bits(shape, 0u, 6u)) * covers > m->warp_far.share;
    float finer = 1.0f / min(m->warp.pitch, m->weft.pitch);
    float right = (x - middle_x) * m->warp.pitch * finer, up = (y - middle_y) * m->weft.pitch * finer;
    float p = weft ? right : up, q = weft ? up : right;
    float turn = 1.2f * weave_bits(shape, 6u, 7u), c = cos(turn), s = sin(turn);
    float bend = 0.6f * weave_bits(shape, 13u, 6u), wave = 1.2f * weave_bits(shape, 19u, 6u);
    float l = 0.6f + 0.3f * weave_bits(shape, 25u, 7u), t = (c * p + s * q) / l, t2 = t * t;
    float lean = wave * (1.0f - 3.0f * t2) - 2.0f * bend * t;
    float reach = radius * (1.0f - t2 * t2) * sqrt(1.0f + lean * lean),
          off = c * q - s * p - l * (bend + wave * t) * (1.0f - t2);
    float kept = (weft ? m->weft.hairiness : m->warp.hairiness) - (0.5f + 0.5f * weave_bits(place, 0u, 10u));
    WeaveHair h;
    h.here = min(kept, min(1.0f - abs(t), reach - abs(off))) > 0.0f;
    h.weft = weft;
    h.thread = floor(weft ? middle_y : middle_x);
    h.c = c;
    h.s = s;
    h.lean = lean;
    h.along = t;
    h.across = off / max(reach, 1e-6f);
    return h;
}

/* Lays it over the point: arched, on what it crosses, and never below the middle of the cloth. */
FN void weave_lay(WeaveHair h, WeavePoint *p) {
    float rise = -0.4f * h.along, round = 0.8f * h.across;
    float fx = h.s + h.c * h.lean, fy = h.c - h.s * h.lean, n = 1.0f / sqrt(fx * fx + fy * fy);
    fx = fx * n;
    fy = fy * n;
    float sx = round * fy - rise * fx, sy = -round * fx - rise * fy, q = 1.0f / sqrt(1.0f + rise * rise);
    p->height = max(p->height, 0.0f) + WEAVE_HAIR_RADIUS;
    p->weft = h.weft;
    p->thread = h.thread;
    p->dye = 1.0f;
    p->lit = 1.0f;
    p->slope_x = h.weft ? sy : sx;
    p->slope_y = h.weft ? sx : sy;
    p->fibre = h.weft ? dir(fy * q, fx * q, rise * q) : dir(fx * q, fy * q, rise * q);
}

/* The number of the fibre on top of so many at x, y; -1: none. */
FN int weave_hair_at(const Weave *m, float x, float y, float radius, int count) {
    int top = -1;
    ROUNDS(n, count) {
        WeaveHair h = weave_hair(m, n, x, y, radius);
        top = h.here ? n : top;
    }
    return top;
}

/* That fibre itself, which drivers that do not branch would work out once more from its number; not here: none. */
FN WeaveHair weave_hair_top(const Weave *m, float x, float y, float radius, int count) {
    WeaveHair top;
    top.here = false;
    top.weft = false;
    top.along = 0.0f;
    top.across = 0.0f;
    top.thread = 0.0f;
    top.c = 1.0f;
    top.s = 0.0f;
    top.lean = 0.0f;
    ROUNDS(n, count) {
        WeaveHair h = weave_hair(m, n, x, y, radius);
        if (h.here) top = h;
    }
    return top;
}

/* Half of the width of loose fibres over a point of that height; 0: there are none. In a gap nothing else is seen that
 * could take their place: there they do not fade. */
FN float weave_hair_reach(const Weave *m, float height, float spacing) {
    float radius = height > WEAVE_NONE ? weave_hair_radius(spacing) : WEAVE_HAIR_RADIUS;
    return max(m->warp.hairiness, m->weft.hairiness) > 0.0f ? radius : 0.0f;
}

/* The point at x, y, where the spacing of points is so many threads, and across as weave_finish has it. Where there are no
 * loose fibres the loop over them has no rounds, of which drivers that do not branch run one. */
FN WeavePoint weave_point(const Weave *m, float x, float y, float spacing, float across) {
    WeavePoint p = weave_bound(m, x, y, spacing, across);
    float radius = weave_hair_reach(m, p.height, spacing);
    WeaveHair top = weave_hair_top(m, x, y, radius, radius > 0.0f ? WEAVE_HAIRS_NEAR : 0);
    if (top.here) weave_lay(top, &p);
    return p;
}

/* True where one looks through the cloth. */
FN bool weave_gap(const Weave *m, float x, float y) {
    float height = weave_top(m, x, y).height, radius = weave_hair_reach(m, WEAVE_NONE, 0.0f);
    bool open = height <= WEAVE_NONE;
    return open && weave_hair_at(m, x, y, radius, open && radius > 0.0f ? WEAVE_HAIRS_NEAR : 0) < 0;
}

/* The fibres' albedo at a point, one channel, without white: fibres of albedo A absorb as the dye in them
 * does, (1 - A) / A of what they scatter. */
FN float weave_albedo(const Weave *m, WeavePoint p, int channel) {
    float thread = weave_mod(p.thread, to_float(p.weft ? m->picks : m->warps));
    int row = to_int(thread) + (p.weft ? m->warps : 0);
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
FN float weave_open(const Weave *m, WeavePoint p) { return p.lit * weave_depth(m, p) / m->openness; }

#endif
