/* weave_seen.h - a point of a pixel on a woven cloth: what it sees, and what that reflects, for engines that shade point by
 * point
 *
 *   f = (1 - w) yarn + w (warp + weft)
 *
 * w is that of weave_base.h: near a point is one of a thread, and from afar it is both systems in the colours of the
 * crossings around it. Layers above the cloth are not in f. A point is seen once, and serves all lights. */
#pragma once

#include "shading/weave/weave_base.h"
#include "shading/weave/weave_place.h"

/* The colours of a repeat as mipmaps in one table: levels one below the other, and in each the four layers of a cloth
 * (weave/weft_cloth.h). A texel is four numbers in a row: a colour, and the share that the system covers. */
STRUCT(WeaveColors) {
    Table texels;
    int stride;        /* numbers in a row */
    int width, height; /* of level 0, in texels */
    int last;          /* the level of one texel */
};

STRUCT(WeaveColor) {
    Rgb color;
    float covers;
};

/* Returns the colour at t of the way from a to b. */
FN WeaveColor weave_color_mix(WeaveColor a, WeaveColor b, float t) {
    WeaveColor c;
    c.color = rgb_mix(a.color, b.color, t);
    c.covers = mix(a.covers, b.covers, t);
    return c;
}

/* A level of the colours: its first row, and its sides in texels. */
STRUCT(WeaveLevel) { int first, width, height; };
FN WeaveLevel weave_level(const WeaveColors *c, int level) {
    WeaveLevel l;
    l.first = 0;
    l.width = c->width;
    l.height = c->height;
    ROUNDS(k, level) {
        l.first = l.first + 4 * l.height;
        l.width = l.width > 1 ? l.width / 2 : 1;
        l.height = l.height > 1 ? l.height / 2 : 1;
    }
    return l;
}

FN WeaveColor weave_color_texel(const WeaveColors *c, WeaveLevel l, int layer, int column, int row) {
    int down = l.first + layer * l.height + row, at = 4 * column;
    WeaveColor t;
    t.color = rgb(table_texel(c->texels, c->stride, down, at), table_texel(c->texels, c->stride, down, at + 1),
                  table_texel(c->texels, c->stride, down, at + 2));
    t.covers = table_texel(c->texels, c->stride, down, at + 3);
    return t;
}

/* The two texels around a place, of which the repeat has so many, and how far it is from the first to the second. */
STRUCT(WeaveTexels) {
    int first, second;
    float part;
};
FN WeaveTexels weave_texels_around(float part, int side) {
    float at = (part - floor(part)) * to_float(side) - 0.5f, low = floor(at);
    int k = to_int(low);
    WeaveTexels t;
    t.first = k < 0 ? side - 1 : k;
    t.second = k + 1 < side ? k + 1 : 0;
    t.part = at - low;
    return t;
}

/* Returns the colour of a layer at x, y, in parts of the repeat, between the four texels around it. */
FN WeaveColor weave_color_in(const WeaveColors *c, int level, int layer, float x, float y) {
    WeaveLevel l = weave_level(c, level);
    WeaveTexels across = weave_texels_around(x, l.width), up = weave_texels_around(y, l.height);
    WeaveColor low = weave_color_mix(weave_color_texel(c, l, layer, across.first, up.first),
                                     weave_color_texel(c, l, layer, across.second, up.first), across.part);
    WeaveColor high = weave_color_mix(weave_color_texel(c, l, layer, across.first, up.second),
                                      weave_color_texel(c, l, layer, across.second, up.second), across.part);
    return weave_color_mix(low, high, up.part);
}

/* Returns the colour between the two levels around `level`. */
FN WeaveColor weave_color_at(const WeaveColors *c, float level, int layer, float x, float y) {
    float at = clamp(level, 0.0f, to_float(c->last)), fine = floor(at);
    int k = to_int(fine), coarser = k < c->last ? k + 1 : k;
    return weave_color_mix(weave_color_in(c, k, layer, x, y), weave_color_in(c, coarser, layer, x, y), at - fine);
}

/* A point of a pixel. */
STRUCT(WeaveSeen) {
    float afar;           /* w */
    float covers;         /* the part of the point that threads cover; the rest are gaps, which reflect nothing */
    YarnPrepared yarn;    /* near: the thread */
    Rgb single, multiple; /* near: colours of light that met one fibre, and of all other light */
    Rgb warp_single, warp_multiple, weft_single, weft_multiple; /* the same of both systems from afar */
};

/* Returns a point where there is no thread. */
FN WeavePoint weave_no_point(void) {
    WeavePoint p;
    p.height = WEAVE_NONE;
    p.weft = false;
    p.thread = 0.0f;
    p.r = 0.0f;
    p.s = 0.0f;
    p.k = 1.0f;
    p.slope_x = 0.0f;
    p.slope_y = 0.0f;
    p.fibre = dir(0.0f, 1.0f, 0.0f);
    p.dye = 1.0f;
    p.lit = 1.0f;
    return p;
}

/* Returns the place across a fibre, -1 to 1, of a point too far from others to have its own: random from place to
 * place, at 32 places a thread. weave_noise_over does not use this number of a key. */
FN float weave_across(const Weave *m, float x, float y) {
    return weave_second(weave_key(m->seed, WEAVE_OF_LOTS, floor(32.0f * x), floor(32.0f * y)));
}

/* Sets what is seen near by: a point of a thread. points: in the pixel. */
FN void weave_see_near(const Weave *m, Dir at, WeaveFootprint f, float points, float wear, WeaveSeen *s) {
    WeavePoint p = weave_no_point();
    if (s->afar < 1.0f) p = weave_point(m, at.x, at.y, f.longest / sqrt(points), weave_across(m, at.x, at.y));
    yarn_prepare(weave_yarn(m, p), &s->yarn);
    s->yarn.axis = p.fibre; /* exactly, instead of through the azimuth */
    s->single = weave_worn_single(m, p, wear);
    s->multiple = weave_worn_multiple(m, p, wear);
    s->covers = p.height > WEAVE_NONE ? 1.0f : 0.0f;
}

/* Sets what is seen from afar: both systems in the colours of the crossings over a point. A texel is as wide as the
 * pixel, or half of that where several points are averaged. */
FN void weave_see_far(const Weave *m, const WeaveColors *c, Dir at, WeaveFootprint f, float points, float wear,
                      WeaveSeen *s) {
    float warps = to_float(m->warps), picks = to_float(m->picks), texels = points > 1.0f ? 2.0f : 1.0f;
    float level = weave_far_level(f, texels * warps / to_float(c->width), texels * picks / to_float(c->height));
    float x = at.x / warps, y = at.y / picks;
    float warp_dye = weave_far_dye(m, false, at.x, at.y, f), weft_dye = weave_far_dye(m, true, at.x, at.y, f);
    WeaveColor warp_single = weave_color_at(c, level, 0, x, y), warp_multiple = weave_color_at(c, level, 1, x, y),
               weft_single = weave_color_at(c, level, 2, x, y), weft_multiple = weave_color_at(c, level, 3, x, y);
    s->warp_single = weave_fitted_single(m, false, warp_single.color, warp_single.covers, warp_dye, wear);
    s->warp_multiple = weave_fitted_multiple(m, false, warp_multiple.color, warp_single.covers, warp_dye, wear);
    s->weft_single = weave_fitted_single(m, true, weft_single.color, weft_single.covers, weft_dye, wear);
    s->weft_multiple = weave_fitted_multiple(m, true, weft_multiple.color, weft_single.covers, weft_dye, wear);
    s->covers = mix(s->covers, min(m->warp_far.share + m->weft_far.share, 1.0f), s->afar);
}

/* Returns what a point sees at texture coordinates u, v. du_dx and so on: how they change to the next pixel across and
 * down. points: how many points of the pixel the caller averages. wear: the input of the material. */
FN WeaveSeen weave_see(const Weave *m, const WeaveColors *c, WeavePlacing placing, float u, float v, float du_dx,
                       float dv_dx, float du_dy, float dv_dy, int points, float wear) {
    Dir at = weave_place_of(placing, u, v), across = weave_threads(placing, du_dx, dv_dx),
        up = weave_threads(placing, du_dy, dv_dy);
    WeaveFootprint f = weave_footprint(across.x, across.y, up.x, up.y);
    float number = to_float(points > 1 ? points : 1);
    WeaveSeen s;
    s.afar = points > 1 ? weave_far_weight(f) : weave_far_weight_alone(f);
    weave_see_near(m, at, f, number, wear, &s);
    s.warp_single = rgb_grey(0.0f);
    s.warp_multiple = rgb_grey(0.0f);
    s.weft_single = rgb_grey(0.0f);
    s.weft_multiple = rgb_grey(0.0f);
    if (s.afar > 0.0f) weave_see_far(m, c, at, f, number, wear, &s);
    return s;
}

/* Returns f of the thread, and of one system from afar, 1/sr in each channel. */
FN Rgb weave_thread_value(const WeaveSeen *s, Angles a) {
    YarnView w = yarn_view_of(&s->yarn, a.o);
    LobeValue v = yarn_value(&s->yarn, &w, a);
    return rgb_scale(rgb_mix(s->single, s->multiple, v.s), v.f);
}
FN Rgb weave_system_value(const WovenPrepared *p, Rgb single, Rgb multiple, Angles a) {
    WovenView w = woven_view_of(p, a.o);
    LobeValue v = woven_value(p, &w, a);
    return rgb_scale(rgb_mix(single, multiple, v.s), v.f);
}

/* Returns f of the cloth without layers above it, 1/sr in each channel. warp, weft: lobe woven of both systems
 * (weave/woven_fit.h), in which colours contain the share. */
FN Rgb weave_value(const WeaveSeen *s, const WovenPrepared *warp, const WovenPrepared *weft, Angles a) {
    Rgb f = rgb_grey(0.0f);
    if (s->afar < 1.0f) f = rgb_scale(weave_thread_value(s, a), 1.0f - s->afar);
    if (s->afar > 0.0f)
        f = rgb_add(f, rgb_scale(rgb_add(weave_system_value(warp, s->warp_single, s->warp_multiple, a),
                                         weave_system_value(weft, s->weft_single, s->weft_multiple, a)),
                                 s->afar));
    return f;
}
