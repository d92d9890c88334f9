/* ambient.h - image-based lighting (IBL): the light of an environment map (HDRI) that a material reflects
 *
 * Of a lobe with colour 1, f cos_i against the light L of all directions, by one of four strategies:
 *
 *   irradiance   E(cos_o) ambient_irradiance(n)
 *   mirror       E(cos_o) ambient_radiance(r, kappa),  r: wo mirrored at the normal, kappa: of the lobe as
 *                wide as it is at normal incidence. The way of Brian Karis, "Real Shading in Unreal Engine
 *                4", SIGGRAPH 2013 course; engines filter sheens so too
 *   fitted       sum over lights of f cos_i + sum_k w_k ambient_residual(axis_k) for a broad lobe; for one that is
 *                less so, with one look-up of the residual, E(cos_o) ambient_residual(axis, kappa); and for one too
 *                narrow for the lights E(cos_o) (mean of ambient_radiance(axis, kappa) with a wider one for
 *                the tail of the lobe). The axis is the lobe's mean direction
 *   sampled      the mean over samples of the lobe of f cos_i / pdf L(i, kappa), kappa by their density:
 *                Jaroslav Krivanek, Mark Colbert, "Real-time Shading with Filtered Importance Sampling",
 *                Computer Graphics Forum 27(4), 2008; joined with the points of the lights where they are the
 *                denser. For a highlight that is drawn out, whose normals come in strips (terms/d_ggx.h), and for
 *                a lobe that is a ring, which one axis and one width say little of
 *
 * Why lights: a studio is dark but for a few boxes of light, and then only f itself is near enough to f. A few
 * lights for what is bright, as in Paul Debevec, "A Median Cut Algorithm for Light Probe Sampling", SIGGRAPH
 * 2005 posters, meet the material as any light does, with all that depends on wi; and what they leave is so
 * even that six wide look-ups of it are enough:
 *
 *   k   axis: angle to the normal, azimuth from that of wo     weight of the directions
 *   0   the normal                                             cosine
 *   1   60 degrees, 45 and -45 degrees                         kappa 3.125
 *   2   60 degrees, 180 degrees                                kappa 12.5
 *   3   80 degrees, 135 and -135 degrees                       kappa 12.5
 *
 *   w_k(cos_o, parameter) >= 0 and sum w_k = E(cos_o), from a table that ambient_table.h makes of any lobe.
 *
 * Where no texture changes the parameter the table is baked: one row of it, and that as polynomials, since a
 * texel costs as much as a dozen of these:
 *
 *   entry(y) = sum_k c_k (2 y - 1)^k,  k = 0 .. AMBIENT_DEGREE,  cos_o = (1 - (1 - y)^2)^2
 *
 * The E of a sheen that has a table of its own is taken from there, where it is mixed with more care.
 *
 * Occlusion is the part of the cosine-weighted sky that is seen. A lobe that is not spread as the cosine sees
 * more of the sky or less: each look-up is dimmed by what the source knows to be open about its direction,
 * and a light by what is seen of it. Of a source that knows the number alone it is a cone about the normal
 * (occlusion_cone.h), and the number itself for a light, of which a cone would hide all or nothing.
 *
 * Departures: of lobes that are brushed or lean, tables know wo along, across and against that, and take what
 * comes back to lie evenly about the plane of wo; lights have them as they are. What the lights leave meets a
 * layer rule that depends on wi with E on cosine average. */
#ifndef WEFT_SHADING_AMBIENT_H
#define WEFT_SHADING_AMBIENT_H

#include "shading/ambient_source.h"
#include "shading/compose.h"

#define AMBIENT_IRRADIANCE 0
#define AMBIENT_MIRROR     1
#define AMBIENT_FITTED     2
#define AMBIENT_SAMPLED    3
#define AMBIENT_STRATEGIES 4

/* Samples of a lobe that is a ring, and of one that has strips. */
#define AMBIENT_SAMPLES       32
#define AMBIENT_STRIP_SAMPLES 64

/* Factor on the density of samples before it is compared with that of points: samples lie where the lobe is,
 * points wherever the light is. Fitted to bench_ambient. */
#define AMBIENT_SAMPLE_TRUST 4.0f

/* A shader whose slots all have one strategy says so in place of this. */
#ifndef AMBIENT_STRATEGY
#define AMBIENT_STRATEGY(t) (t).strategy
#endif

/* Planes of a table, `rows` rows each, in groups of four: of the first colour w_1 .. w_3 as parts of E, and
 * E; the sine of the angle of the lobe's mean direction, which is above 0 on the side of wo, log2 of its
 * kappa, its tail, 0 of a Gaussian and 1 of ggx, and log2 of the kappa of a lobe as dense, which no strategy
 * reads; of the second colour w_0 .. w_3. The last plane is the sum of these. Parts of E are smooth where E
 * itself goes to 0. */
#define AMBIENT_GROUP_FIRST  0
#define AMBIENT_GROUP_SHAPE  1
#define AMBIENT_GROUP_SECOND 2
#define AMBIENT_GROUPS       3
#define AMBIENT_PLANES       13

#define AMBIENT_PLANE_E        3
#define AMBIENT_PLANE_E_SECOND 12

#define AMBIENT_DEGREE 9
#define AMBIENT_SIDE   (3 * (AMBIENT_DEGREE + 1)) /* coefficients of a table, each of a group */
#define AMBIENT_BAKED  (3 * AMBIENT_SIDE)         /* of one that turns: along, across and against */

/* log2 kappa from which on one look-up of the residual is better than those of a broad lobe. From a quarter
 * of the lights' own kappa on, log2 of it less AMBIENT_FINER, a lobe is narrow enough to show that they stand
 * in for spread light. Each is the middle of a range in which one goes over into the other, AMBIENT_BLEND to
 * both sides. */
#define AMBIENT_CLOSE 4.0f
#define AMBIENT_FINER 2.0f
#define AMBIENT_BLEND 1.0f

/* The table of one slot's lobe: nodes uniform in the root of its first parameter and in y with cos_o =
 * (1 - (1 - y)^2)^2. */
STRUCT(AmbientTable) {
    Table texels;
    int rows, columns; /* of a plane; rows: 1 where the parameter is baked */
    float low, high;   /* roots of the parameter in the first and the last row */
    bool focus;        /* somewhere it is not broad */
    bool narrow;       /* and somewhere too narrow for the lights */
    bool second;       /* the lobe has a second colour */
    bool lossless;     /* E is 1 everywhere */
    bool strips;       /* the lobe has its normals in strips */
    bool
        turning; /* the lobe depends on azimuth: planes for wo along, across and against the nap, below each other */
    int strategy;
    int baked; /* place of the first polynomial; below 0: not baked */
};

STRUCT(AmbientTables) { AmbientTable diffuse, specular, sheen, coat, dust; };

/* The place of a cosine and a parameter in a table, and for a lobe that depends on azimuth of the heading
 * (nap.h): between across, and along or against, by its square. */
STRUCT(AmbientCoord) {
    int row, column, side; /* side: the first plane of along or of against */
    float x, y, z, t;      /* t: of polynomials */
};

FN AmbientCoord ambient_coord(AmbientTable t, float cos_o, float heading, float p) {
    AmbientCoord s;
    float y_o = 1.0f - sqrt(max(1.0f - sqrt(clamp(cos_o, 0.0f, 1.0f)), 0.0f)),
          x = y_o * to_float(t.columns - 1);
    float left = clamp(floor(x), 0.0f, to_float(t.columns - 2));
    s.side = heading < 0.0f ? 2 * AMBIENT_PLANES : 0;
    s.z = heading * heading;
    s.t = 2.0f * y_o - 1.0f;
    s.column = to_int(left);
    s.x = clamp(x - left, 0.0f, 1.0f);
    s.row = 0;
    s.y = 0.0f;
    if (t.rows > 1) {
        float y = (sqrt(max(p, 0.0f)) - t.low) / (t.high - t.low) * to_float(t.rows - 1);
        float top = clamp(floor(y), 0.0f, to_float(t.rows - 2));
        s.row = to_int(top);
        s.y = clamp(y - top, 0.0f, 1.0f);
    }
    return s;
}

FN float ambient_plane(AmbientTable t, AmbientCoord s, int plane) {
    int row = plane * t.rows + s.row;
    float a = mix(table_texel(t.texels, t.columns, row, s.column),
                  table_texel(t.texels, t.columns, row, s.column + 1), s.x);
    if (t.rows < 2) return a;
    float b = mix(table_texel(t.texels, t.columns, row + 1, s.column),
                  table_texel(t.texels, t.columns, row + 1, s.column + 1), s.x);
    return mix(a, b, s.y);
}

FN float ambient_entry(AmbientTable t, AmbientCoord s, int plane) {
    if (!t.turning) return ambient_plane(t, s, plane);
    return mix(ambient_plane(t, s, AMBIENT_PLANES + plane), ambient_plane(t, s, s.side + plane), s.z);
}

FN AmbientWeights ambient_weights_zero(void) {
    AmbientWeights w;
    w.a = 0.0f;
    w.b = 0.0f;
    w.c = 0.0f;
    w.d = 0.0f;
    return w;
}

FN AmbientWeights ambient_polynomial(AmbientSource s, int first, float t) {
    AmbientWeights w = ambient_baked(s, first + AMBIENT_DEGREE);
    for (int k = AMBIENT_DEGREE - 1; k >= 0; k--) {
        AmbientWeights c = ambient_baked(s, first + k);
        w.a = w.a * t + c.a;
        w.b = w.b * t + c.b;
        w.c = w.c * t + c.c;
        w.d = w.d * t + c.d;
    }
    return w;
}

FN AmbientWeights ambient_weights_select(bool first, AmbientWeights x, AmbientWeights y) {
    AmbientWeights w;
    w.a = first ? x.a : y.a;
    w.b = first ? x.b : y.b;
    w.c = first ? x.c : y.c;
    w.d = first ? x.d : y.d;
    return w;
}

/* Polynomials that go to zero swing about it; what is a sum or a part of one is not below. Where a lobe
 * reflects next to nothing they do not keep to its shape: log2 of kappa stays where those of tables are. */
FN AmbientWeights ambient_clamp_weights(AmbientWeights a, int group) {
    AmbientWeights w = a;
    if (group == AMBIENT_GROUP_SHAPE) {
        w.b = clamp(a.b, -2.0f, 22.0f);
        return w;
    }
    w.a = max(a.a, 0.0f);
    w.b = max(a.b, 0.0f);
    w.c = max(a.c, 0.0f);
    w.d = max(a.d, 0.0f);
    return w;
}

/* A group of a table that is baked. */
FN AmbientWeights ambient_baked_group(AmbientTable t, AmbientSource s, AmbientCoord at, int group) {
    int first = t.baked + (AMBIENT_DEGREE + 1) * group;
    AmbientWeights w = ambient_polynomial(s, first, at.t);
    if (!t.turning) return ambient_clamp_weights(w, group);
    AmbientWeights across = ambient_polynomial(s, first + AMBIENT_SIDE, at.t),
                   against = ambient_polynomial(s, first + 2 * AMBIENT_SIDE, at.t);
    w = ambient_weights_select(at.side > 0, against, w);
    w.a = mix(across.a, w.a, at.z);
    w.b = mix(across.b, w.b, at.z);
    w.c = mix(across.c, w.c, at.z);
    w.d = mix(across.d, w.d, at.z);
    return ambient_clamp_weights(w, group);
}

/* All of a group. */
FN AmbientWeights ambient_group(AmbientTable t, AmbientSource s, AmbientCoord at, int group) {
    if (t.baked >= 0) return ambient_baked_group(t, s, at, group);
    AmbientWeights w;
    w.a = ambient_entry(t, at, 4 * group);
    w.b = ambient_entry(t, at, 4 * group + 1);
    w.c = ambient_entry(t, at, 4 * group + 2);
    w.d = ambient_entry(t, at, 4 * group + 3);
    return w;
}
FN float ambient_sum(AmbientWeights w) { return w.a + w.b + w.c + w.d; }

/* E of a lobe's two colours, and how each is spread over the four look-ups. */
STRUCT(AmbientLobe) {
    float first, second;
    AmbientWeights first_weights, second_weights; /* sums are of no meaning */
};

/* `albedo` is E of both colours together where the caller has it, else below 0. */
FN AmbientLobe ambient_lobe(AmbientTable t, AmbientSource s, AmbientCoord at, float albedo) {
    AmbientLobe l;
    AmbientWeights w = ambient_group(t, s, at, AMBIENT_GROUP_FIRST);
    l.second_weights = ambient_weights_zero();
    if (t.second) l.second_weights = ambient_group(t, s, at, AMBIENT_GROUP_SECOND);
    l.first = t.lossless ? 1.0f : w.d;
    l.second = ambient_sum(l.second_weights);
    l.first_weights.a = max(1.0f - w.a - w.b - w.c, 0.0f);
    l.first_weights.b = w.a;
    l.first_weights.c = w.b;
    l.first_weights.d = w.c;
    if (albedo >= 0.0f) {
        float part = l.second / max(l.first + l.second, 1e-20f);
        l.first = albedo * (1.0f - part);
        l.second = albedo * part;
    }
    return l;
}

/* From wo, and from the frame of the lobe to that of the source. */
STRUCT(AmbientView) {
    Dir o;         /* in the lobe's frame */
    float tx, ty;  /* the azimuth of wo */
    float heading; /* azimuth of wo from that of the lobe, as a cosine (nap.h) */
    Dir x, y, z;   /* the lobe's frame */
    float occlusion;
};

FN AmbientView ambient_view(Dir o, Dir x, Dir y, Dir z, float occlusion) {
    AmbientView v;
    float s = sqrt(o.x * o.x + o.y * o.y), r = 1.0f / max(s, 1e-6f);
    v.o = o;
    v.tx = s > 1e-6f ? o.x * r : 1.0f;
    v.ty = s > 1e-6f ? o.y * r : 0.0f;
    v.heading = v.tx;
    v.x = x;
    v.y = y;
    v.z = z;
    v.occlusion = occlusion;
    return v;
}

/* A direction of the lobe's frame. */
FN Dir ambient_to_source(AmbientView v, Dir w) {
    return dir(w.x * v.x.x + w.y * v.y.x + w.z * v.z.x, w.x * v.x.y + w.y * v.y.y + w.z * v.z.y,
               w.x * v.x.z + w.y * v.y.z + w.z * v.z.z);
}
/* One with x towards wo. */
FN Dir ambient_to_lobe(AmbientView v, Dir w) {
    return dir(w.x * v.tx - w.y * v.ty, w.x * v.ty + w.y * v.tx, w.z);
}

/* A look-up about w of the residual, as much of it as is seen towards m, the mean of its weight above the
 * horizon, and bent to where that is seen. */
FN Rgb ambient_visible_residual(AmbientSource s, AmbientView v, Dir w, float kappa, Dir m) {
    float open = ambient_sky_visibility(s, ambient_to_source(v, ambient_to_lobe(v, m)), w.z, v.occlusion);
    Dir bent = ambient_bent_direction(s, ambient_to_source(v, ambient_to_lobe(v, w)), kappa, open);
    return rgb_scale(ambient_residual(s, bent, kappa), open);
}

/* The light that the two colours of a lobe scale. */
STRUCT(LobeLight) { Rgb first, second; };

/* The look-ups of the residual, one for each weight: the same for all lobes of a frame. */
STRUCT(AmbientLookups) { Rgb a, b, c, d; };

FN AmbientLookups ambient_residual_lookups(AmbientSource s, AmbientView v) {
    AmbientLookups l;
    l.a =
        rgb_scale(ambient_residual(s, ambient_bent_direction(s, v.z, 4.0f, v.occlusion), 0.0f), v.occlusion);
    l.b = rgb_add(ambient_visible_residual(s, v, dir(0.612372436f, 0.612372436f, 0.5f), 3.125f,
                                           dir(0.3984f, 0.3984f, 0.5224f)),
                  ambient_visible_residual(s, v, dir(0.612372436f, -0.612372436f, 0.5f), 3.125f,
                                           dir(0.3984f, -0.3984f, 0.5224f)));
    l.c = ambient_visible_residual(s, v, dir(-0.866025404f, 0.0f, 0.5f), 12.5f, dir(-0.791f, 0.0f, 0.483f));
    l.d = rgb_add(ambient_visible_residual(s, v, dir(-0.696364240f, 0.696364240f, 0.173648178f), 12.5f,
                                           dir(-0.6334f, 0.6334f, 0.2856f)),
                  ambient_visible_residual(s, v, dir(-0.696364240f, -0.696364240f, 0.173648178f), 12.5f,
                                           dir(-0.6334f, -0.6334f, 0.2856f)));
    l.b = rgb_scale(l.b, 0.5f);
    l.d = rgb_scale(l.d, 0.5f);
    return l;
}

/* Their mean by weights, of which some are above 0 wherever the lobe reflects anything. */
FN Rgb ambient_mean(AmbientLookups l, AmbientWeights w) {
    Rgb sum = rgb_add(rgb_add(rgb_scale(l.a, w.a), rgb_scale(l.b, w.b)),
                      rgb_add(rgb_scale(l.c, w.c), rgb_scale(l.d, w.d)));
    return rgb_scale(sum, 1.0f / max(ambient_sum(w), 1e-20f));
}
FN LobeLight ambient_broad_light(AmbientLookups l, AmbientLobe lobe) {
    LobeLight p;
    p.first = rgb_scale(ambient_mean(l, lobe.first_weights), lobe.first);
    p.second = rgb_scale(ambient_mean(l, lobe.second_weights), lobe.second);
    return p;
}

/* One look-up for a whole lobe, whose colours have E first and second. */
FN LobeLight lobe_light_of(Rgb radiance, float first, float second) {
    LobeLight p;
    p.first = rgb_scale(radiance, first);
    p.second = rgb_scale(radiance, second);
    return p;
}
FN LobeLight lobe_light_mix(LobeLight a, LobeLight b, float t) {
    LobeLight p;
    p.first = rgb_mix(a.first, b.first, t);
    p.second = rgb_mix(a.second, b.second, t);
    return p;
}

/* The part of ggx facets beyond 1 - mu = t is 1 / (1 + kappa t / ln 2), half of it at ln 2 / kappa. This
 * is within 0.036 of 0.6 exp(-2.24 kappa t) + 0.4 exp(-0.245 kappa t), own fit. */
FN Rgb ambient_radiance_with_tail(AmbientSource s, Dir w, float kappa, float tail) {
    return rgb_mix(ambient_radiance(s, w, kappa * mix(1.0f, 2.24f, tail)),
                   ambient_radiance(s, w, kappa * mix(1.0f, 0.245f, tail)), 0.4f);
}

/* Returns the visible part of the mean `all` about w: of the residual the part `open`, and of what the lights
 * add to it the part `part`. */
FN Rgb ambient_visible_mean(AmbientSource s, Dir w, Rgb all, float kappa, float part, float open) {
    Rgb residual = ambient_residual(s, w, kappa);
    residual = rgb(min(residual.r, all.r), min(residual.g, all.g), min(residual.b, all.b));
    return rgb_add(rgb_scale(residual, open), rgb_scale(rgb_add(all, rgb_scale(residual, -1.0f)), part));
}

/* 0 below, 1 above, and smooth between. */
FN float ambient_kappa_blend(float log2_kappa, float edge) {
    float x = clamp(0.5f + 0.5f * (log2_kappa - edge) / AMBIENT_BLEND, 0.0f, 1.0f);
    return x * x * (3.0f - 2.0f * x);
}

/* The lights of those two ways to find them are weighed by the squares of their densities: Eric Veach,
 * Leonidas Guibas, "Optimally Combining Sampling Techniques for Monte Carlo Rendering", SIGGRAPH 1995, the
 * power heuristic. */
FN float ambient_power_heuristic(float a, float b) { return a * a / max(a * a + b * b, 1e-30f); }

/* Returns the part of the lights in a sample about w, times their visibility: the sample's weight against
 * their points. `drawn` is the density of samples, `open` the visible part of the sky. */
FN float ambient_sample_part(AmbientSource s, Dir w, float drawn, float open) {
    int nearest = ambient_nearest_light(s, w);
    if (nearest < 0) return open;
    AmbientLight l = ambient_light(s, nearest);
    return ambient_power_heuristic(AMBIENT_SAMPLE_TRUST * drawn, l.density) *
           ambient_light_visibility(s, nearest, open);
}

/* Returns what samples of the lobe find: the residual, and their part of the lights. A sample stands for the
 * solid angle 1 / (n pdf). The paper filters over twice that, so that neighbours overlap; exp(kappa (mu - 1))
 * covers 2 pi / kappa, hence kappa = pi n pdf. The sum is scaled to the albedo from the table, which has less
 * noise, except along strips, where the sum itself is within 0.015 of it and the table of an anisotropic lobe
 * within 0.05. */
FN LobeLight ambient_sample_lobe(AmbientSource s, AmbientView v, Lobe lobe, bool strips, float albedo) {
    LobeLight p;
    int count = strips ? AMBIENT_STRIP_SAMPLES : AMBIENT_SAMPLES;
    float e = 0.0f, n = to_float(count);
    p.first = rgb_grey(0.0f);
    p.second = p.first;
    for (int k = 0; k < count; k++) {
        float golden = to_float(k) * 0.618033989f + 0.25f, at = (to_float(k) + 0.5f) / n, dense = 1.0f;
        Dir i;
        if (strips) {
            Strip strip = lobe_strip(&lobe, v.o, at, golden - floor(golden));
            i = dir_mirror(v.o, strip.h);
            dense = strip.density;
        } else {
            i = lobe_sample(&lobe, v.o, at, golden - floor(golden));
        }
        if (i.z > 0.0f) {
            LobeValue x = lobe_value(&lobe, angles_between(v.o, i));
            float drawn = max(x.pdf * dense * n, 1e-20f), w = x.f * i.z / drawn;
            float kappa = clamp(PI * drawn, 0.5f, 1e4f);
            Dir out_i = ambient_to_source(v, i);
            Rgb all = ambient_radiance(s, out_i, kappa);
            float open = ambient_sky_visibility(s, out_i, i.z, v.occlusion);
            float part = ambient_sample_part(s, out_i, drawn, open);
            Rgb l = rgb_scale(ambient_visible_mean(s, out_i, all, kappa, part, open), w);
            p.first = rgb_add(p.first, rgb_scale(l, 1.0f - x.s));
            p.second = rgb_add(p.second, rgb_scale(l, x.s));
            e = e + w;
        }
    }
    float scale = strips ? 1.0f : albedo / max(e, 1e-20f);
    p.first = rgb_scale(p.first, scale);
    p.second = rgb_scale(p.second, scale);
    return p;
}

/* Returns the rest of the lights, of which each point is evaluated as a directional light. */
FN LobeLight ambient_sample_lights(AmbientSource s, AmbientView v, Lobe lobe, bool strips) {
    LobeLight p;
    p.first = rgb_grey(0.0f);
    p.second = p.first;
    int count = ambient_point_count(s);
    float n = AMBIENT_SAMPLE_TRUST * to_float(strips ? AMBIENT_STRIP_SAMPLES : AMBIENT_SAMPLES);
    for (int k = 0; k < count; k++) {
        AmbientLight l = ambient_point(s, k);
        Dir i = dir(dir_dot(l.w, v.x), dir_dot(l.w, v.y), dir_dot(l.w, v.z));
        if (i.z > 0.0f) {
            LobeValue x = lobe_value(&lobe, angles_between(v.o, i));
            float part = ambient_power_heuristic(l.density, x.pdf * n);
            Rgb c = rgb_scale(l.color, x.f * i.z * part * ambient_light_visibility(s, l.light, v.occlusion));
            p.first = rgb_add(p.first, rgb_scale(c, 1.0f - x.s));
            p.second = rgb_add(p.second, rgb_scale(c, x.s));
        }
    }
    return p;
}

/* One slot, lit by the environment. light_fraction: weight of the lights still to be added, 0 if
 * `reflected` contains them. */
STRUCT(SlotLight) {
    LobeLight reflected;
    float light_fraction;
};

/* `albedo`: see ambient_lobe. */
FN SlotLight ambient_slot_light(AmbientTable t, AmbientSource s, AmbientView v, AmbientLookups residual,
                                Lobe lobe, float albedo) {
    SlotLight a;
    float p = lobe.params[0];
    AmbientCoord spot = ambient_coord(t, v.o.z, v.heading, p);
    AmbientLobe l = ambient_lobe(t, s, spot, albedo);
    a.light_fraction = 0.0f;
    if (AMBIENT_STRATEGY(t) == AMBIENT_IRRADIANCE) {
        a.reflected = lobe_light_of(rgb_scale(ambient_irradiance(s, v.z), v.occlusion), l.first, l.second);
        return a;
    }
    if (AMBIENT_STRATEGY(t) == AMBIENT_MIRROR) {
        Dir r = ambient_to_source(v, dir(-v.o.x, -v.o.y, v.o.z));
        AmbientWeights facing =
            ambient_group(t, s, ambient_coord(t, 1.0f, v.heading, p), AMBIENT_GROUP_SHAPE);
        Rgb about = ambient_radiance(s, r, exp2(facing.b));
        a.reflected = lobe_light_of(rgb_scale(about, ambient_sky_visibility(s, r, v.o.z, v.occlusion)),
                                    l.first, l.second);
        return a;
    }
    if (AMBIENT_STRATEGY(t) == AMBIENT_SAMPLED) {
        LobeLight met = ambient_sample_lights(s, v, lobe, t.strips);
        a.reflected = ambient_sample_lobe(s, v, lobe, t.strips, l.first + l.second);
        a.reflected.first = rgb_add(a.reflected.first, met.first);
        a.reflected.second = rgb_add(a.reflected.second, met.second);
        return a;
    }
    a.light_fraction = 1.0f;
    a.reflected = ambient_broad_light(residual, l);
    if (!t.focus) return a;
    AmbientWeights shape = ambient_group(t, s, spot, AMBIENT_GROUP_SHAPE);
    float x = clamp(shape.a, -1.0f, 1.0f), log2_kappa = shape.b, kappa = exp2(log2_kappa);
    float close = ambient_kappa_blend(log2_kappa, AMBIENT_CLOSE);
    float narrow = t.narrow ? ambient_kappa_blend(log2_kappa, ambient_light_kappa(s) - AMBIENT_FINER) : 0.0f;
    Dir axis = ambient_to_lobe(v, dir(x, 0.0f, sqrt(max(1.0f - x * x, 0.0f)))),
        out_axis = ambient_to_source(v, axis);
    a.light_fraction = 1.0f - narrow;
    float seen = ambient_sky_visibility(s, out_axis, axis.z, v.occlusion);
    Rgb wide = rgb_scale(ambient_residual(s, out_axis, kappa), seen);
    a.reflected = lobe_light_mix(a.reflected, lobe_light_of(wide, l.first, l.second), close);
    if (!t.narrow) return a;
    Rgb sharp = ambient_radiance_with_tail(s, out_axis, kappa, clamp(shape.c, 0.0f, 1.0f));
    float lit = ambient_light_visibility(s, ambient_nearest_light(s, out_axis), seen);
    sharp = ambient_visible_mean(s, out_axis, sharp, kappa, lit, seen);
    a.reflected = lobe_light_mix(a.reflected, lobe_light_of(sharp, l.first, l.second), narrow);
    return a;
}

/* The colours of a slot against that. Where F enters squared (the f_quadratic) and where colour is no factor,
 * the share and the tint are those of the whole lobe. */
FN float ambient_apply_channel(SheenE e, float f0, float f90, float f_quadratic, float first, float second) {
    if (IS_TINTED(e.tint)) return first * f90 * tint_color(e.tint, f0 / max(f90, 1e-30f));
    return f0 * first + f90 * second - f_quadratic * first * second / max(first + second, 1e-30f);
}
FN Rgb ambient_apply_colors(SlotColors s, float scale, SheenE e, LobeLight p) {
    return rgb_scale(rgb(ambient_apply_channel(e, s.f0.r, s.f90.r, s.f_quadratic.r, p.first.r, p.second.r),
                         ambient_apply_channel(e, s.f0.g, s.f90.g, s.f_quadratic.g, p.first.g, p.second.g),
                         ambient_apply_channel(e, s.f0.b, s.f90.b, s.f_quadratic.b, p.first.b, p.second.b)),
                     scale);
}

/* Cosine average of schlick_s at the least of wi . h, cos_o and cos_i, which is the lesser of the cosines:
 * (1 - z)^5 for the cosines z below cos_o, (1 - cos_o)^5 above. */
FN float ambient_schlick_least(float cos_o) {
    float q = 1.0f - cos_o, q2 = q * q, q5 = q2 * q2 * q;
    return q5 * (1.0f - cos_o * cos_o) + 2.0f * ((1.0f - q5 * q) / 6.0f - (1.0f - q5 * q2) / 7.0f);
}

/* Returns the cosine average of schlick_s at wi . h: own fit, within 0.001. */
FN float ambient_schlick_half(float cos_o) {
    float q2 = (1.0f - cos_o) * (1.0f - cos_o);
    return q2 * (0.02f + 0.008f * q2);
}

/* Returns the transmittance of the interface for the diffuse lobe, on cosine average over wi. */
FN Rgb ambient_base_transmittance(const Stack *m, const StackView *w) {
    float cos_o = w->o.z;
    Rgb f = rgb_grey(0.0f);
    if (m->base_fresnel == BASE_FRESNEL_HALF || m->base_fresnel == BASE_FRESNEL_GAUSSIAN)
        f = rgb_mix(w->interface_f0, rgb_grey(w->interface_f90), ambient_schlick_half(cos_o));
    if (m->base_fresnel == BASE_FRESNEL_LEAST)
        f = rgb_grey(
            rgb_max3(rgb_mix(w->interface_f0, rgb_grey(w->interface_f90), ambient_schlick_least(cos_o))));
    return stack_one_minus(f);
}
FN Rgb ambient_interface_transmittance(const Stack *m, const StackView *w) {
    float s = ambient_schlick_least(w->o.z);
    if (m->layer == LAYER_SEED) s = ambient_schlick_half(w->o.z);
    return stack_interface_at(m, w, s);
}

FN Rgb ambient_reflect_lights(const Stack *m, const StackView *lit, Slots only, AmbientSource s,
                              float occlusion) {
    Rgb sum = rgb_grey(0.0f);
    int count = ambient_light_count(s);
    for (int k = 0; k < count; k++) {
        AmbientLight l = ambient_light(s, k);
        float seen = l.w.z > 0.0f ? ambient_light_visibility(s, k, occlusion) : 0.0f;
        if (seen > 0.0f) {
            Angles a = angles_between(lit->o, l.w), coat = a;
            if (only.coat) coat = angles_between(lit->coat_o, stack_to_coat(m, l.w));
            StackValue value = stack_value_of(m, lit, only, &a, &coat);
            sum = rgb_add(sum, rgb_scale(rgb_mul(l.color, value.f_cos), seen));
        }
    }
    return sum;
}

/* Returns the light that a stack reflects towards wo. t: the tables of its lobes. occlusion: the part of the
 * cosine-weighted sky that is seen, in [0, 1]. */
FN Rgb stack_ambient(const Stack *m, const StackView *w, AmbientTables t, AmbientSource s, float occlusion) {
    Rgb sum = rgb_grey(0.0f), over = rgb_grey(1.0f);
    StackView lit = *w; /* as the lights see it */
    Dir o = w->o;
    Slots only = slots_of(false, false, false, false, false);
    AmbientView v = ambient_view(o, dir(1.0f, 0.0f, 0.0f), dir(0.0f, 1.0f, 0.0f), dir(0.0f, 0.0f, 1.0f),
                                 clamp(occlusion, 0.0f, 1.0f));
    AmbientLookups residual = ambient_residual_lookups(s, v);
    bool layered = HAS_LAYERED_SHEEN(m);
    Rgb base_scale = rgb_grey(1.0f);
    if (layered) base_scale = stack_base_scale(m, w, m->e_avg);
    Rgb diffuse = rgb_mul(base_scale, ambient_base_transmittance(m, w));
    float matte = ambient_diffuse(s), other = ambient_reflection(s);
    if (IS_BELOW_F(m) && layered) {
        over = ambient_interface_transmittance(m, w);
        diffuse = rgb_mul(base_scale, over);
        base_scale = rgb_grey(1.0f);
    }
    SheenE plain = sheen_e_of(0.0f);
    if (HAS_DIFFUSE(m)) {
        SlotLight a = ambient_slot_light(t.diffuse, s, v, residual, m->diffuse.lobe, -1.0f);
        Rgb c = rgb_scale(
            ambient_apply_colors(slot_colors(&m->diffuse), w->scale.diffuse, plain, a.reflected), matte);
        if (SHOWS_DIFFUSE) sum = rgb_mul(diffuse, c);
        lit.scale.diffuse = w->scale.diffuse * a.light_fraction * matte;
        only.diffuse = SHOWS_DIFFUSE && a.light_fraction * matte > 0.0f;
    }
    if (HAS_SPECULAR(m)) {
        SlotLight a = ambient_slot_light(t.specular, s, v, residual, m->specular.lobe, -1.0f);
        float env_lights = a.light_fraction * other;
        Rgb c = rgb_scale(
            ambient_apply_colors(stack_specular_colors(m, w), w->scale.specular, plain, a.reflected), other);
        if (SHOWS_SPECULAR) sum = rgb_add(sum, rgb_mul(base_scale, c));
        only.specular = SHOWS_SPECULAR && env_lights > 0.0f;
        lit.scale.specular = w->scale.specular * env_lights;
    }
    if (HAS_SHEEN(m)) {
        AmbientView along = v;
        if (m->nap.tilt > 0.0f) along.heading = v.tx * m->nap.x + v.ty * m->nap.y;
        /* E of the stack is mixed with more care than that of the fit */
        float albedo = m->albedo == ALBEDO_TABLE && m->table.kind != TABLE_NONE ? w->e_o.e : -1.0f;
        SlotLight a = ambient_slot_light(t.sheen, s, along, residual, m->sheen.lobe, albedo);
        Rgb c = ambient_apply_colors(slot_colors(&m->sheen), w->scale.sheen, w->e_o, a.reflected);
        if (SHOWS_SHEEN) sum = rgb_add(sum, rgb_scale(rgb_mul(over, c), other));
        lit.scale.sheen = w->scale.sheen * a.light_fraction * other;
        only.sheen = SHOWS_SHEEN && a.light_fraction * other > 0.0f;
    }
    if (HAS_COAT(m)) {
        Dir oc = w->coat_o;
        if (oc.z > 0.0f) {
            AmbientView c = ambient_view(oc, m->coat_x, m->coat_y, m->coat_z, v.occlusion);
            SlotLight a =
                ambient_slot_light(t.coat, s, c, ambient_residual_lookups(s, c), m->coat.lobe, -1.0f);
            if (SHOWS_COAT)
                sum = rgb_add(sum, rgb_scale(ambient_apply_colors(slot_colors(&m->coat), w->scale.coat, plain,
                                                                  a.reflected),
                                             other));
            lit.scale.coat = w->scale.coat * a.light_fraction * other;
            only.coat = SHOWS_COAT && a.light_fraction * other > 0.0f;
        }
    }
    if (HAS_DUST(m)) {
        SlotLight a = ambient_slot_light(t.dust, s, v, residual, m->dust.lobe, -1.0f);
        if (SHOWS_DUST)
            sum = rgb_add(
                sum, rgb_scale(ambient_apply_colors(slot_colors(&m->dust), w->scale.dust, plain, a.reflected),
                               matte));
        lit.scale.dust = w->scale.dust * a.light_fraction * matte;
        only.dust = SHOWS_DUST && a.light_fraction * matte > 0.0f;
    }
    if (only.diffuse || only.specular || only.sheen || only.coat || only.dust)
        sum = rgb_add(sum, ambient_reflect_lights(m, &lit, only, s, v.occlusion));
    return sum;
}

#endif
