/* weave_point.h - the point of a woven cloth at a place: which thread lies on top there, and how it lies
 *
 *   z = +-(l / 2) m (1 - |s|^(k + 1)) / (k + 1) + (w / 4) q (1 - r^2)
 *
 * is the height of a thread, with + where it is on top and - where it is below. A thread stays on top for a run of
 * crossings, then below for the next run. l is the length of a run. s goes from -1 to 1 along it, so the slope along
 * the thread is m |s|^k, and m at the ends of the run. With l in crossings, k = 1 + floats (l - 1): a long float is
 * level except at its ends. r goes from -1 to 1 across the thread, which is w wide and whose back has the slope q at
 * both edges. Our own model.
 *   x counts warp threads from the left and y picks from the bottom. Of the threads at a place, the highest is seen. So
 * threads that vary in width, place and height still cover each other as real ones do.
 *   Near by a thread is a bundle of fibres along its twist. Each fibre has a round back and dark crevices beside it.
 * Some fibres have come loose and lie across the cloth. Where points are too far apart for a detail, they have its mean
 * instead. Only the slopes across fibres do not fade, since grazing light depends on them: for such points the caller
 * chooses a place across a fibre.
 *   Beyond a million threads coordinates lose their fractions. Beyond a hundred thousand, fibres lose their shape. */
#pragma once

#include "shading/lobe/table.h"
#include "shading/weave/weave_cell.h"
#include "shading/weave/weave_noise.h"

/* The yarn of one system, warp or weft, as it lies in a cloth. Pitches and heights have a common unit. */
#define WEAVE_YARN_NUMBERS(N)                                                                                          \
    N(alpha)        /* of the fibres, as lobe yarn has it */                                                           \
    N(crimp)        /* m: tangent of the steepest angle along the yarn */                                              \
    N(roundness)    /* q: slope at the edges of the yarn */                                                            \
    N(twist)        /* angle of the fibres to the yarn, radians */                                                     \
    N(white)        /* share of light that a fibre reflects whatever its dye */                                        \
    N(pitch)        /* distance between neighbouring threads of this system */                                         \
    N(cross_pitch)  /* distance between neighbouring threads of the other system */                                    \
    N(width)        /* w, in pitches */                                                                                \
    N(bulge)        /* fraction by which the middle of a long float is wider */                                        \
    N(floats)       /* k = 1 + floats (l - 1) */                                                                       \
    N(streaks)      /* slope at the edges of a fibre */                                                                \
    N(dye)          /* how much the amount of dye varies */                                                            \
    N(slub)         /* how much the width varies */                                                                    \
    N(wander)       /* how much place and crimp vary */                                                                \
    N(hairiness)    /* fraction of the places for loose fibres that have one */                                        \
    N(slub_nodes)   /* nodes of the noise of width and place, per crossing */                                          \
    N(barre)        /* how much the amount of dye varies in bars over many threads */                                  \
    N(barre_nodes)  /* nodes of the widest bars, per thread */                                                         \
    N(uneven)       /* how much the amount of dye varies in patches */                                                 \
    N(uneven_nodes) /* nodes of the largest patches, per thread */                                                     \
    N(core)         /* albedo of the fibres inside, which wear lays bare */                                            \
    N(per_width)    /* 1 / width */                                                                                    \
    N(cos_twist)    /* cosine of twist */                                                                              \
    N(sin_twist)    /* sine of twist */                                                                                \
    N(crossing)     /* distance from crossing to crossing along the thread, in pitches */

/* A system from afar: numbers of lobe woven, fitted to the visible points (weave/woven_fit.c). V is the mean area of
 * yarn that a direction sees, per area of cloth. */
#define WEAVE_FAR_NUMBERS(N)                                                                                           \
    N(alpha)        /* of the lobe */                                                                                  \
    N(crimp)        /* tangent of the steepest angle along the yarn */                                                 \
    N(roundness)    /* steepest slope across the yarn */                                                               \
    N(floats)       /* power of the slope along the yarn */                                                            \
    N(slope_across) /* for V: uniform slopes up to it have the mean square of those seen across yarns */               \
    N(slope_along)  /* for V: the same along the yarn */                                                               \
    N(share)        /* of the cloth, seen from above; the shares of both systems and the gaps add up to 1 */           \
    N(single)       /* on the colour of light that met one fibre: gives the lobe the mean of points */                 \
    N(multiple)     /* the same for all other light */                                                                 \
    N(open)         /* the mean of weave_open */                                                                       \
    N(raised)       /* the mean of weave_raised, by the light that reaches a point */

#define WEAVE_NUMBER(name) float name;
STRUCT(WeaveYarn){WEAVE_YARN_NUMBERS(WEAVE_NUMBER)};
STRUCT(WeaveFar){WEAVE_FAR_NUMBERS(WEAVE_NUMBER)};

/* A cloth. */
STRUCT(Weave) {
    int warps, picks; /* threads of a repeat */
    WeaveYarn warp, weft;
    float seed;
    WeaveFar warp_far, weft_far;
    float low, high;        /* the lowest and the highest visible point */
    float openness;         /* the mean of weave_depth */
    float cycle_x, cycle_y; /* threads after which the cloth repeats, irregularities too; 0: never */
    Table runs;             /* a row for each pick, and in it a WeaveCell, a crossing, for each warp thread */
    Table albedos;          /* a row of three channels for each thread, warp first: the fibres' albedo */
};

#define WEAVE_NONE (-1e6f) /* height where there is no thread */

STRUCT(WeavePoint) {
    float height;           /* z, or WEAVE_NONE */
    bool weft;              /* the thread is a pick */
    float thread;           /* number of the thread, through all repeats */
    float r, s, k;          /* as at the top of this file */
    float slope_x, slope_y; /* how fast it falls along x and y of the cloth */
    Dir fibre;              /* along the fibres, unit */
    float dye;              /* factor on the amount of dye */
    float lit;              /* light that reaches this place of a fibre, over its mean */
};

/* A number and a crossing of a cloth's tables. A shader has these tables in a texture and defines both itself. */
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

/* Returns the crossing of two threads: where each is in its run. */
FN WeaveCell weave_cell(const Weave *m, float warp, float pick) {
    int row = to_int(weave_mod(pick, to_float(m->picks))), at = to_int(weave_mod(warp, to_float(m->warps)));
    return weave_cell_texel(m->runs, m->warps, row, at);
}

/* Purposes of random numbers. weave_key hashes one with two whole numbers. If the weft has its own, it is the next. */
#define WEAVE_OF_CROSSINGS 0
#define WEAVE_OF_THREADS   1  /* place and width along a thread */
#define WEAVE_OF_DYE       3  /* of a thread */
#define WEAVE_OF_STREAKS   5  /* dye along a thread */
#define WEAVE_OF_WAVES     7  /* how fibres wind */
#define WEAVE_OF_FIBRES    9  /* dye of a fibre */
#define WEAVE_OF_HAIRS     11 /* and three more: the loose fibres of a cell */
#define WEAVE_OF_LOTS      15 /* dye over many threads, of both systems */

/* A place in a run. */
STRUCT(WeaveRun) {
    float crossings;    /* l, at least 1 */
    float per_crossing; /* 1 / l */
    float up;           /* 1 on top, -1 below */
    float ends;         /* 1, or 0 if the run never ends; a factor, since a branch would stop vectorisation */
    float s, k;         /* as at the top of this file */
    float s_k;          /* |s|^k */
};
/* Returns a thread's place v, in crossings, as a place in its run. since: crossings since the run began; run: its
 * length, negative if the thread is below, 0 if the run never ends. */
FN WeaveRun weave_run(float floats, float v, float since, float run) {
    WeaveRun a;
    a.ends = abs(run) > 0.5f ? 1.0f : 0.0f;
    a.crossings = max(abs(run), 1.0f);
    a.per_crossing = 1.0f / a.crossings;
    a.s = a.ends * (2.0f * (v - floor(v) + since) * a.per_crossing - 1.0f);
    a.up = run < 0.0f ? -1.0f : 1.0f;
    a.k = 1.0f + floats * (a.crossings - 1.0f);
    a.s_k = pow(max(abs(a.s), 1e-3f), a.k);
    return a;
}

/* Returns the factor on the amount of dye at a place of a thread that is thick by noise `thick`: its softer yarn takes
 * up more. */
FN float weave_slub_dye(WeaveYarn y, float thick) { return 1.0f + 0.15f * y.slub * thick; }

/* Returns the part of noise that is left over a footprint of so many of its nodes. */
FN float weave_unblurred(float nodes) { return clamp(1.25f - 0.5f * nodes, 0.0f, 1.0f); }

/* Returns noise of two dimensions, -1 to 1, over a lattice of which x and y count the nodes. */
FN float weave_noise_over(float seed, float octave, float x, float y) {
    WeaveNodes across = weave_nodes(x, 0.0f), along = weave_nodes(y, 0.0f);
    float row = 1048576.0f * (octave + 1.0f); /* beyond those of the bars */
    return mix(weave_noise(seed, WEAVE_OF_LOTS, row + along.low, across).first,
               weave_noise(seed, WEAVE_OF_LOTS, row + along.high, across).first, along.part);
}

/* Returns the factor on the amount of dye at u, v, as for weave_thread, that varies over many threads: in bars across
 * the system, where one lot of the yarn ends and the next begins, and in patches, which both systems share. Bars have
 * three octaves and patches two. A cloth that repeats has neither. width, reach: of the footprint across the threads
 * and along them, in threads and in crossings. */
FN float weave_lot_dye(const Weave *m, WeaveYarn y, bool weft, float u, float v, float width, float reach) {
    float bars = 0.0f, nodes = y.barre_nodes, row = weft ? 3.0f : 0.0f;
    ROUNDS(k, 3) {
        float octave = to_float(k);
        bars = bars + (0.7f - 0.1f * octave) * weave_unblurred(width * nodes) *
                          weave_noise(m->seed, WEAVE_OF_LOTS, row + octave, weave_nodes(u * nodes, 0.0f)).first;
        nodes = 3.0f * nodes;
    }
    float patches = 0.0f, across = y.uneven_nodes, along = y.uneven_nodes * y.crossing;
    ROUNDS(k, 2) {
        float a = u * across, b = v * along, octave = to_float(k);
        patches = patches + (0.9f - 0.3f * octave) * weave_unblurred(max(width * across, reach * along)) *
                                weave_noise_over(m->seed, octave, weft ? b : a, weft ? a : b);
        across = 3.0f * across;
        along = 3.0f * along;
    }
    return 1.0f + (m->cycle_x > 0.0f ? 0.0f : y.barre * bars + y.uneven * patches);
}

/* Returns the point of thread c of a system without its fibres, in the thread's frame, whose y is along it. u, v: the
 * place across the threads of the system and along them. since, run: as for weave_run. bends: noise from crossing to
 * crossing, -1 to 1. `slow` has two noises that change along the thread over the length of a slub. */
FN WeavePoint weave_thread(const Weave *m, WeaveYarn y, bool weft, float c, float u, float v, float since, float run,
                           float bends) {
    float side = weft ? m->cycle_y : m->cycle_x, cycle = weft ? m->cycle_x : m->cycle_y;
    WeaveRun a = weave_run(y.floats, v, since, run);
    WeaveNoise slow = weave_noise(m->seed, WEAVE_OF_THREADS + (weft ? 1 : 0), weave_wrap(c, side),
                                  weave_nodes_along(y.slub_nodes, v, cycle));
    float crimp = a.ends * y.crimp * (1.0f + 0.5f * y.wander * bends);
    float aside = 0.12f * y.wander * slow.first;
    float thick = 1.0f + y.slub * (0.35f * slow.second + 0.12f * bends);
    float swell = a.up > 0.0f ? y.bulge * (1.0f - a.s * a.s) * (1.0f - a.per_crossing) : 0.0f;
    float width = min(y.width * max(thick, 0.2f) * (1.0f + swell), 2.0f - 2.0f * abs(aside));
    float r = 2.0f * (u - c - 0.5f - aside) / width;
    float arc = a.up * 0.5f * a.crossings * y.cross_pitch * crimp * (1.0f - abs(a.s) * a.s_k) / (a.k + 1.0f);

    WeavePoint p;
    p.height = abs(r) < 1.0f ? arc + 0.25f * width * y.pitch * y.roundness * (1.0f - r * r) : WEAVE_NONE;
    p.weft = weft;
    p.thread = c;
    p.r = r;
    p.s = a.s;
    p.k = a.k;
    p.slope_x = y.roundness * r;
    p.slope_y = a.up * crimp * (a.s < 0.0f ? -a.s_k : a.s_k);
    p.fibre = dir(0.0f, 1.0f, 0.0f);
    p.dye = weave_slub_dye(y, slow.second);
    p.lit = 1.0f;
    return p;
}

FN void weave_take_higher(WeavePoint *best, WeavePoint p) {
    if (p.height > best->height) *best = p;
}

#define WEAVE_FIBRES      20.0f  /* side by side in a thread */
#define WEAVE_FIBRES_OWN  40.0f  /* their dye repeats after so many */
#define WEAVE_WAVES       8.0f   /* stripes a third of a thread wide; how fibres wind in them repeats after so many */
#define WEAVE_HAIR_RADIUS 0.018f /* half of the width of a loose fibre, in threads */

/* Returns how much of single fibres is left, 0 to 1. spacing: from point to point, in widths of the thread. At a
 * spacing of one fibre, 1 / 20, nothing is left. */
FN float weave_fineness(float spacing) { return clamp(1.5f - 30.0f * spacing, 0.0f, 1.0f); }

/* Returns half of the width of loose fibres, 0 where they have faded. They fade at larger spacings than other fibres,
 * since they differ in colour from what they cover. spacing: in threads. */
FN float weave_hair_radius(float spacing) { return WEAVE_HAIR_RADIUS * clamp(1.75f - 25.0f * spacing, 0.0f, 1.0f); }

/* Returns how the dye took on a thread, -1 to 1. cycle: number of threads after which that repeats. */
FN float weave_thread_dye(float seed, bool weft, float thread, float cycle) {
    return weave_first(weave_key(seed, WEAVE_OF_DYE + (weft ? 1 : 0), weave_wrap(thread, cycle), 0.0f));
}

/* Cosine and sine of an angle of at most 0.7, by their series: within 2e-5. */
STRUCT(WeaveRotation) { float c, s; };
FN WeaveRotation weave_rotation(float angle) {
    float a2 = angle * angle;
    WeaveRotation t;
    t.c = 1.0f - a2 * (0.5f - a2 * (1.0f / 24.0f - a2 / 720.0f));
    t.s = angle * (1.0f - a2 * (1.0f / 6.0f - a2 / 120.0f));
    return t;
}

/* The fibre at a place of a thread. */
STRUCT(WeaveFibre) {
    float wave; /* noise, -1 to 1: how far the fibre is aside, and how it is rotated */
    float f;    /* place across it, -1 to 1 */
    float dye;  /* how the dye took on it, -1 to 1 */
};

/* Returns the fibre at x, the place across the thread, and v, the place along it in crossings. Noise and fibres lie on
 * lattices that are turned by the twist. With X = x / w and Y = v crossing / w, both in widths of the thread, these
 * have the axes
 *   cos twist Y - sin twist X  along the fibres,  cos twist X + sin twist Y  across them
 * weave_frequency and weave_slant round the nodes per crossing, so that the lattices fit into a cycle. */
FN WeaveFibre weave_fibre(const Weave *m, WeaveYarn y, float sin_twist, int weft, float thread, float x, float v,
                          float cycle) {
    float c = y.cos_twist * y.per_width, s = sin_twist * y.per_width;
    float c_v = c * y.crossing, s_v = s * y.crossing;
    float t = weave_frequency(1.3f * c_v, cycle) * v - 1.3f * s * x;
    WeaveNodes along = weave_nodes(t, weave_node_count(1.3f * c_v, cycle));
    WeaveNodes over = weave_nodes(3.0f * c * x + weave_slant(3.0f * s_v, WEAVE_WAVES, cycle) * v, WEAVE_WAVES);
    WeaveFibre a;
    a.wave = mix(weave_noise_of(m->seed, WEAVE_OF_WAVES + weft, thread, over.low, WEAVE_WAVES, along),
                 weave_noise_of(m->seed, WEAVE_OF_WAVES + weft, thread, over.high, WEAVE_WAVES, along), over.part);
    float place = WEAVE_FIBRES * c * x + weave_slant(WEAVE_FIBRES * s_v, WEAVE_FIBRES_OWN, cycle) * v + 2.0f * a.wave;
    float number = floor(place);
    a.f = 2.0f * (place - number) - 1.0f;
    a.dye = weave_noise_of(m->seed, WEAVE_OF_FIBRES + weft, thread, weave_mod(number, WEAVE_FIBRES_OWN),
                           WEAVE_FIBRES_OWN, along);
    return a;
}

/* Returns c T + s (N x T), the direction of fibres on a surface with the slopes sx and sy. c and s are cosine and sine
 * of the twist, N = n (sx, sy, 1) is the normal, and T = q (0, 1, -sy) is the direction of the yarn. */
FN Dir weave_fibre_axis(float c, float s, float sx, float sy) {
    float n = 1.0f / sqrt(1.0f + sx * sx + sy * sy), q = 1.0f / sqrt(1.0f + sy * sy);
    return dir(-s * n * q * (1.0f + sy * sy), c * q + s * sx * sy * q * n, -c * q * sy + s * sx * q * n);
}

/* Adds fibres and the irregular dye to a point of weave_thread, and rotates it from the thread's frame to the cloth's.
 * u, v: as for weave_thread. spacing: from point to point, in threads. across: the place across a fibre, -1 to 1, of
 * points too far apart to have their own. At spacings in between it is mixed with their own, so that the variance of
 * slopes stays the same. A crevice takes the part crevice f^4 of the light, and `lit` is divided by its mean over f. */
FN void weave_add_fibres(const Weave *m, WeaveYarn y, float u, float v, float spacing, float across, WeavePoint *p) {
    float side = p->weft ? m->cycle_y : m->cycle_x, cycle = p->weft ? m->cycle_x : m->cycle_y;
    float thread = weave_wrap(p->thread, side);
    int weft = p->weft ? 1 : 0;
    float sin_twist = p->weft ? -y.sin_twist : y.sin_twist; /* the weft's frame is mirrored */
    WeaveFibre a = weave_fibre(m, y, sin_twist, weft, thread, u - p->thread, v, cycle);
    float fine = weave_fineness(spacing * y.per_width), streaks = y.streaks * fine, f = a.f;

    WeaveRotation wave = weave_rotation(0.35f * y.streaks * a.wave);
    float c = y.cos_twist * wave.c - sin_twist * wave.s, s = sin_twist * wave.c + y.cos_twist * wave.s;
    float sx = p->slope_x + y.streaks * mix(across, f, fine) / sqrt(fine * fine + (1.0f - fine) * (1.0f - fine)),
          sy = p->slope_y;
    Dir fibre = weave_fibre_axis(c, s, sx, sy);
    float crevice = min(2.0f * streaks, 0.6f);
    WeaveNoise along = weave_noise(m->seed, WEAVE_OF_STREAKS + weft, thread, weave_nodes_along(0.35f, v, cycle));
    p->dye = p->dye - y.dye * (0.7f * weave_thread_dye(m->seed, p->weft, p->thread, side) + 0.3f * along.first) -
             0.5f * min(streaks, 0.5f) * a.dye;
    p->dye = p->dye * weave_lot_dye(m, y, p->weft, u, v, 0.0f, 0.0f);
    p->lit = (1.0f - crevice * f * f * f * f) / (1.0f - 0.2f * crevice);
    p->slope_x = p->weft ? sy : sx;
    p->slope_y = p->weft ? sx : sy;
    p->fibre = dir(p->weft ? fibre.y : fibre.x, p->weft ? fibre.x : fibre.y, fibre.z);
}

/* Returns the hash of a crossing. It has two random numbers: weave_first is for the warp, weave_second for the weft. */
FN uint weave_crossing(const Weave *m, float i, float j) {
    return weave_key(m->seed, WEAVE_OF_CROSSINGS, weave_wrap(i, m->cycle_x), weave_wrap(j, m->cycle_y));
}

/* Returns the highest thread at x, y, in its own frame and without fibres. No thread reaches further than the middle of
 * its neighbour, so only the two nearest of each system can be on top. Noise is smoothly interpolated (weave_ease)
 * among the four nearest crossings, so that neighbouring threads agree on it. */
FN WeavePoint weave_top(const Weave *m, float x, float y) {
    float i = floor(x), j = floor(y), near_x = x - i - 0.5f, near_y = y - j - 0.5f;
    float beside = i + (near_x < 0.0f ? -1.0f : 1.0f), above = j + (near_y < 0.0f ? -1.0f : 1.0f);
    float part_x = weave_ease(abs(near_x)), part_y = weave_ease(abs(near_y));
    uint here = weave_crossing(m, i, j), right = weave_crossing(m, beside, j), up = weave_crossing(m, i, above),
         across = weave_crossing(m, beside, above);
    WeaveCell cell = weave_cell(m, i, j), cell_right = weave_cell(m, beside, j), cell_up = weave_cell(m, i, above);
    WeavePoint best = weave_thread(m, m->warp, false, i, x, y, cell.warp_since, cell.warp_run,
                                   mix(weave_first(here), weave_first(up), part_y));
    WeavePoint weft = weave_thread(m, m->weft, true, j, y, x, cell.weft_since, cell.weft_run,
                                   mix(weave_second(here), weave_second(right), part_x));
    weave_take_higher(&best, weave_thread(m, m->warp, false, beside, x, y, cell_right.warp_since, cell_right.warp_run,
                                          mix(weave_first(right), weave_first(across), part_y)));
    weave_take_higher(&weft, weave_thread(m, m->weft, true, above, y, x, cell_up.weft_since, cell_up.weft_run,
                                          mix(weave_second(up), weave_second(across), part_x)));
    bool is_weft = weft.height > best.height; /* a bool copied with the record would stop vectorisation */
    weave_take_higher(&best, weft);
    best.weft = is_weft;
    return best;
}

/* Returns the yarn of a system. It chooses number by number, without a branch. */
#define WEAVE_CHOOSE(name) y.name = weft ? m->weft.name : m->warp.name;
FN WeaveYarn weave_yarn_of(const Weave *m, bool weft) {
    WeaveYarn y;
    WEAVE_YARN_NUMBERS(WEAVE_CHOOSE)
    return y;
}

/* Returns weave_point without loose fibres. */
FN WeavePoint weave_point_bound(const Weave *m, float x, float y, float spacing, float across) {
    WeavePoint p = weave_top(m, x, y);
    weave_add_fibres(m, weave_yarn_of(m, p.weft), p.weft ? y : x, p.weft ? x : y, spacing, across, &p);
    p.slope_x = p.height > WEAVE_NONE ? p.slope_x : 0.0f;
    p.slope_y = p.height > WEAVE_NONE ? p.slope_y : 0.0f;
    return p;
}

/* A loose fibre beside or at a point. */
STRUCT(WeaveHair) {
    bool here;           /* the point is on it */
    bool weft;           /* the fibre comes from a pick */
    float thread;        /* number of the thread that it comes from */
    float along, across; /* the point's place on it, -1 to 1 */
    float c, s;          /* cosine and sine of its angle to that thread */
    float lean;          /* db / da of weave_hair: its slope against its own axis */
};

/* The cloth is divided into cells of about two threads by two, each with up to WEAVE_HAIRS loose fibres. They reach up
 * to 0.95 threads from their middles. Half a cell is 1 thread, or at least 0.94 in a cloth with a cycle. So a place
 * needs the fibres of its four nearest cells only: a few in a million lose 0.01 threads of a bend. */
#define WEAVE_HAIRS      4
#define WEAVE_HAIRS_NEAR (4 * WEAVE_HAIRS)

/* Returns fibre n of the WEAVE_HAIRS_NEAR that can be at x, y. The thread at its middle is the one that it comes from,
 * warp or weft in proportion to their visible shares. a along the fibre and b across it start at its middle and are in
 * threads of the finer system. The fibre has the form of an S that is l long to either side:
 *   t = a / l,  b = l (bend + wave t) (1 - t^2),  lean = db / da = wave (1 - 3 t^2) - 2 bend t
 * It is radius (1 - t^4) wide to either side. Each weave_bits is a random number from -1 to 1 out of a hash. */
FN WeaveHair weave_hair(const Weave *m, int n, float x, float y, float radius) {
    float per_x = weave_frequency(0.5f, m->cycle_x), per_y = weave_frequency(0.5f, m->cycle_y);
    int cell_x = n / (2 * WEAVE_HAIRS), cell_y = n / WEAVE_HAIRS % 2;
    float i = floor(x * per_x - 0.5f) + to_float(cell_x), j = floor(y * per_y - 0.5f) + to_float(cell_y);
    float column = weave_wrap(i, weave_node_count(per_x, m->cycle_x)),
          row = weave_wrap(j, weave_node_count(per_y, m->cycle_y));
    uint place = weave_key(m->seed, WEAVE_OF_HAIRS + n % WEAVE_HAIRS, column, row),
         shape = weave_hash(place + 0x9e3779b9u);

    float middle_x = (i + 0.5f + 0.5f * weave_bits(place, 21u, 11u)) / per_x;
    float middle_y = (j + 0.5f + 0.5f * weave_bits(place, 10u, 11u)) / per_y;
    float covers = m->warp_far.share + m->weft_far.share;
    bool weft = (0.5f + 0.5f * weave_bits(shape, 0u, 6u)) * covers > m->warp_far.share;

    float finer = 1.0f / min(m->warp.pitch, m->weft.pitch);
    float right = (x - middle_x) * m->warp.pitch * finer, up = (y - middle_y) * m->weft.pitch * finer;
    float p = weft ? right : up, q = weft ? up : right;
    float angle = 1.2f * weave_bits(shape, 6u, 7u), c = cos(angle), s = sin(angle);
    float bend = 0.6f * weave_bits(shape, 13u, 6u), wave = 1.2f * weave_bits(shape, 19u, 6u);
    float l = 0.6f + 0.3f * weave_bits(shape, 25u, 7u), t = (c * p + s * q) / l, t2 = t * t;
    float lean = wave * (1.0f - 3.0f * t2) - 2.0f * bend * t;
    float reach = radius * (1.0f - t2 * t2) * sqrt(1.0f + lean * lean), /* half of the width, across the fibre */
        off = c * q - s * p - l * (bend + wave * t) * (1.0f - t2);

    float exists = (weft ? m->weft.hairiness : m->warp.hairiness) - (0.5f + 0.5f * weave_bits(place, 0u, 10u));
    WeaveHair h;
    h.here = min(exists, min(1.0f - abs(t), reach - abs(off))) > 0.0f;
    h.weft = weft;
    h.thread = floor(weft ? middle_y : middle_x);
    h.c = c;
    h.s = s;
    h.lean = lean;
    h.along = t;
    h.across = off / max(reach, 1e-6f);
    return h;
}

/* Lays a loose fibre over the point. It is arched, on top of what it crosses, never below the middle of the cloth. */
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
    p->fibre = dir((h.weft ? fy : fx) * q, (h.weft ? fx : fy) * q, rise * q);
}

/* Returns the number of the loose fibre on top at x, y, among the first `count`, or -1 if there is none. ROUNDS is an
 * unrolled loop. */
FN int weave_hair_at(const Weave *m, float x, float y, float radius, int count) {
    int top = -1;
    ROUNDS(n, count) {
        WeaveHair h = weave_hair(m, n, x, y, radius);
        top = h.here ? n : top;
    }
    return top;
}

/* Returns the loose fibre on top itself. From its number, drivers that flatten branches would compute it once more. */
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

/* Returns half of the width of loose fibres over a point of that height, or 0 if there are none or they have faded.
 * They do not fade over a gap, where nothing else could take their place. */
FN float weave_hair_radius_over(const Weave *m, float height, float spacing) {
    float radius = height > WEAVE_NONE ? weave_hair_radius(spacing) : WEAVE_HAIR_RADIUS;
    return max(m->warp.hairiness, m->weft.hairiness) > 0.0f ? radius : 0.0f;
}

/* Returns the point at x, y. A place without a thread has no slopes. spacing, across: as for weave_add_fibres. If there
 * are no loose fibres, the loop over them has 0 rounds. A branch around the loop would not help, since some drivers run
 * both sides of branches. */
FN WeavePoint weave_point(const Weave *m, float x, float y, float spacing, float across) {
    WeavePoint p = weave_point_bound(m, x, y, spacing, across);
    float radius = weave_hair_radius_over(m, p.height, spacing);
    WeaveHair top = weave_hair_top(m, x, y, radius, radius > 0.0f ? WEAVE_HAIRS_NEAR : 0);
    if (top.here) weave_lay(top, &p);
    return p;
}

/* Returns true if the cloth is open at x, y: neither a thread nor a loose fibre is there. */
FN bool weave_gap(const Weave *m, float x, float y) {
    float height = weave_top(m, x, y).height, radius = weave_hair_radius_over(m, WEAVE_NONE, 0.0f);
    bool open = height <= WEAVE_NONE;
    return open && weave_hair_at(m, x, y, radius, open && radius > 0.0f ? WEAVE_HAIRS_NEAR : 0) < 0;
}

/* Returns the albedo of fibres with dye times as much dye. Fibres of albedo A absorb (1 - A) / A times what they
 * scatter, and this ratio is proportional to the dye. */
FN float weave_dyed(float albedo, float dye) { return albedo / max(albedo + (1.0f - albedo) * max(dye, 0.1f), 1e-6f); }

/* Returns the albedo of the fibres at a point in one channel, without the share `white`. */
FN float weave_albedo(const Weave *m, WeavePoint p, int channel) {
    float thread = weave_mod(p.thread, to_float(p.weft ? m->picks : m->warps));
    int row = to_int(thread) + (p.weft ? m->warps : 0);
    return weave_dyed(weave_texel(m->albedos, 3, row, channel), p.dye);
}

#define WEAVE_SHADE 0.7f /* the part of light that does not reach the lowest places */

/* Returns the light that reaches a point between threads, as a fraction of what reaches the highest point. */
FN float weave_depth(const Weave *m, WeavePoint p) {
    float depth = clamp((m->high - p.height) / max(m->high - m->low, 1e-6f), 0.0f, 1.0f);
    return 1.0f - WEAVE_SHADE * depth * depth;
}
/* Returns how far a point rises to where wear takes the dye off: 1 at the highest. */
FN float weave_raised(const Weave *m, WeavePoint p) {
    float t = clamp((p.height - m->low) / max(m->high - m->low, 1e-6f), 0.0f, 1.0f);
    return t * t * t;
}

/* Returns the light that reaches a point over its mean on the cloth, so that no cloth becomes darker as a whole. */
FN float weave_open(const Weave *m, WeavePoint p) { return p.lit * weave_depth(m, p) / m->openness; }
