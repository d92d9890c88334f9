/* ambient_lobe.h - the light of an environment that one lobe reflects
 *
 * Integrates f cos_i L over the hemisphere for a lobe of colour 1, by one of four strategies. E is the directional
 * albedo of the lobe. A filter of concentration kappa has the weight exp(kappa (mu - 1)), mu = cosine to its axis.
 *
 *   irradiance   E(cos_o) ambient_irradiance(n)
 *   mirror       E(cos_o) ambient_radiance(r, kappa), the split sum of Brian Karis, "Real Shading in Unreal Engine 4",
 *                SIGGRAPH 2013 course. r mirrors wo at n; kappa is that of the lobe at normal incidence.
 *   fitted       The environment is split into a few directional lights and a smooth residual. Each light is shaded with
 *                f itself. A broad lobe adds sum_k w_k ambient_residual(axis_k), see below. A narrower one adds
 *                E(cos_o) ambient_residual(axis, kappa) along its mean direction. A lobe narrower than a light ignores
 *                the split: E(cos_o) ambient_radiance_with_tail(axis, kappa, tail).
 *   sampled      importance sampling of the lobe and of the lights (ambient_samples.h)
 *
 * Lights keep small, bright sources sharp, which wide filters cannot. Paul Debevec, "A Median Cut Algorithm for Light
 * Probe Sampling", SIGGRAPH 2005 posters, splits an environment for the same purpose. The residual is so smooth that
 * six wide look-ups with four weights are enough for a broad lobe:
 *
 *   k   axes: angle to the normal, azimuth from that of wo     filter
 *   0   the normal                                             cosine
 *   1   60 degrees, 45 and -45 degrees                         kappa 3.125
 *   2   60 degrees, 180 degrees                                kappa 12.5
 *   3   80 degrees, 135 and -135 degrees                       kappa 12.5
 *
 * The weights w_k(cos_o, parameter) are in the table (ambient_table.h): w_k >= 0, sum_k w_k = E.
 *
 * Departure: look-ups assume that the lobe is symmetric about the plane of wo, which is false for a brushed lobe or a
 * leaning nap. Lights do not need this assumption. */
#pragma once

#include "shading/ambient/ambient_samples.h"
#include "shading/ambient/ambient_table.h"

#define AMBIENT_IRRADIANCE 0
#define AMBIENT_MIRROR     1
#define AMBIENT_FITTED     2
#define AMBIENT_SAMPLED    3
#define AMBIENT_STRATEGIES 4

/* A shader defines IS_... as false for a strategy that no slot has, and LIGHT_OF_SLOT as the function that serves a slot
 * (raster/material/shader.c): compilers copy all that a slot might do before they see that it does not. */
#ifndef IS_IRRADIANCE
#define IS_IRRADIANCE(t) ((t).strategy == AMBIENT_IRRADIANCE)
#endif
#ifndef IS_MIRROR
#define IS_MIRROR(t) ((t).strategy == AMBIENT_MIRROR)
#endif
#ifndef LIGHT_OF_SLOT
#define LIGHT_OF_SLOT(slot) ambient_slot_light
#endif

/* The fitted strategy blends from the four look-ups to one look-up of the residual around log2 kappa =
 * AMBIENT_CLOSE. A second blend, to look-ups of the whole environment, is centred at ambient_light_kappa -
 * AMBIENT_FINER: a narrower lobe would show that a directional light has no extent. Both blends reach
 * AMBIENT_BLEND to either side. */
#define AMBIENT_CLOSE 4.0f
#define AMBIENT_FINER 2.0f
#define AMBIENT_BLEND 1.0f

/* Returns a smooth step: 0 for log2_kappa <= edge - AMBIENT_BLEND, 1 for log2_kappa >= edge +
 * AMBIENT_BLEND. */
FN float ambient_kappa_blend(float log2_kappa, float edge) {
    float x = clamp(0.5f + 0.5f * (log2_kappa - edge) / AMBIENT_BLEND, 0.0f, 1.0f);
    return x * x * (3.0f - 2.0f * x);
}

/* Returns a look-up of the visible residual about w. The visibility is that in direction m, the mean of the
 * part of the filter above the horizon. The look-up's axis w is bent towards the visible sky. Both are in the
 * frame whose x axis points towards wo (ambient_to_lobe). */
FN Rgb ambient_visible_residual(AmbientSource s, AmbientView v, Dir w, float kappa, Dir m) {
    float open = ambient_sky_visibility(s, ambient_to_source(v, ambient_to_lobe(v, m)), kappa, w.z, v.occlusion);
    Dir bent = ambient_bent_direction(s, ambient_to_source(v, ambient_to_lobe(v, w)), kappa, open);
    return rgb_scale(ambient_residual(s, bent, kappa), open);
}

/* Axes and filters of the six look-ups above, in the frame whose x axis points towards wo. */
#define AMBIENT_AXIS_0       0.0f, 0.0f, 1.0f
#define AMBIENT_AXIS_1_LEFT  0.612372436f, 0.612372436f, 0.5f
#define AMBIENT_AXIS_1_RIGHT 0.612372436f, -0.612372436f, 0.5f
#define AMBIENT_AXIS_2       -0.866025404f, 0.0f, 0.5f
#define AMBIENT_AXIS_3_LEFT  -0.696364240f, 0.696364240f, 0.173648178f
#define AMBIENT_AXIS_3_RIGHT -0.696364240f, -0.696364240f, 0.173648178f
#define AMBIENT_KAPPA_1      3.125f
#define AMBIENT_KAPPA_2      12.5f
#define AMBIENT_KAPPA_3      12.5f

/* The look-ups of the residual for the weights w_0 to w_3. Lobes with the same shading frame share them; the
 * coat has its own. */
STRUCT(AmbientLookups) { Rgb a, b, c, d; };

FN AmbientLookups ambient_residual_lookups(AmbientSource s, AmbientView v) {
    AmbientLookups l;
    l.a = rgb_scale(ambient_residual(s, v.z, 0.0f), v.occlusion);
    l.b = rgb_add(
        ambient_visible_residual(s, v, dir(AMBIENT_AXIS_1_LEFT), AMBIENT_KAPPA_1, dir(0.3984f, 0.3984f, 0.5224f)),
        ambient_visible_residual(s, v, dir(AMBIENT_AXIS_1_RIGHT), AMBIENT_KAPPA_1, dir(0.3984f, -0.3984f, 0.5224f)));
    l.c = ambient_visible_residual(s, v, dir(AMBIENT_AXIS_2), AMBIENT_KAPPA_2, dir(-0.791f, 0.0f, 0.483f));
    l.d = rgb_add(
        ambient_visible_residual(s, v, dir(AMBIENT_AXIS_3_LEFT), AMBIENT_KAPPA_3, dir(-0.6334f, 0.6334f, 0.2856f)),
        ambient_visible_residual(s, v, dir(AMBIENT_AXIS_3_RIGHT), AMBIENT_KAPPA_3, dir(-0.6334f, -0.6334f, 0.2856f)));
    l.b = rgb_scale(l.b, 0.5f);
    l.d = rgb_scale(l.d, 0.5f);
    return l;
}

/* Returns the weighted mean of the look-ups. The sum of the weights is positive wherever the lobe reflects light. */
FN Rgb ambient_mean(AmbientLookups l, AmbientWeights w) {
    Rgb sum =
        rgb_add(rgb_add(rgb_scale(l.a, w.a), rgb_scale(l.b, w.b)), rgb_add(rgb_scale(l.c, w.c), rgb_scale(l.d, w.d)));
    return rgb_scale(sum, 1.0f / max(ambient_weights_sum(w), 1e-20f));
}
FN LobeLight ambient_broad_light(AmbientLookups l, AmbientAlbedo e) {
    LobeLight p;
    p.first = rgb_scale(ambient_mean(l, e.first_weights), e.first);
    p.second = rgb_scale(ambient_mean(l, e.second_weights), e.second);
    return p;
}

/* Returns the radiance about w, filtered like a lobe of concentration kappa. tail is 0 for a Gaussian lobe, 1
 * for ggx. Half of the lobe's energy lies within 1 - mu = ln 2 / kappa. The share of a ggx lobe's energy with
 * 1 - mu > t is 1 / (1 + kappa t / ln 2). Two Gaussian filters approximate it: 0.6 exp(-2.24 kappa t) + 0.4
 * exp(-0.245 kappa t), own fit, largest error 0.036. */
FN Rgb ambient_radiance_with_tail(AmbientSource s, Dir w, float kappa, float tail) {
    return rgb_mix(ambient_radiance(s, w, kappa * mix(1.0f, 2.24f, tail)),
                   ambient_radiance(s, w, kappa * mix(1.0f, 0.245f, tail)), 0.4f);
}

/* One slot, lit by the environment. */
STRUCT(SlotLight) {
    LobeLight reflected;
    float light_fraction; /* weight of the lights still to be added, 0 if `reflected` contains them */
};

FN SlotLight ambient_irradiance_light(AmbientSource s, AmbientView v, AmbientAlbedo e) {
    SlotLight a;
    a.reflected = lobe_light_of(rgb_scale(ambient_irradiance(s, v.z), v.occlusion), e.first, e.second);
    a.light_fraction = 0.0f;
    return a;
}

/* Returns the light by strategy `mirror`. p: the lobe's first parameter. */
FN SlotLight ambient_mirror_light(AmbientTable t, AmbientSource s, AmbientView v, float p, AmbientAlbedo e) {
    SlotLight a;
    Dir r = ambient_to_source(v, dir(-v.o.x, -v.o.y, v.o.z));
    AmbientWeights facing = ambient_group(t, s, ambient_coord(t, 1.0f, v.heading, p), AMBIENT_GROUP_SHAPE);
    float kappa = exp2(facing.b);
    Rgb radiance = ambient_radiance(s, r, kappa);
    float open = ambient_sky_visibility(s, r, kappa, v.o.z, v.occlusion);
    a.reflected = lobe_light_of(rgb_scale(radiance, open), e.first, e.second);
    a.light_fraction = 0.0f;
    return a;
}

/* Returns the light by strategy `sampled`. The table of a brushed lobe is exact at its headings; between them it is
 * less exact than the sum over strips, which is within 5 %. The table therefore scales the sum near headings only: w is
 * the position between two headings, and the factor 16 was fitted to ggx and silk. */
FN SlotLight ambient_sampled_light(AmbientTable t, AmbientSource s, AmbientView v, AmbientLookups residual, Lobe lobe,
                                   AmbientTint tint, float albedo) {
    AmbientCoord at = ambient_coord(t, v.o.z, v.heading, lobe.params[0]);
    AmbientAlbedo e = ambient_albedo(t, s, at, albedo);
    SlotLight a;
    float w = at.outer_weight, own = t.strips && t.by_azimuth ? min(16.0f * w * (1.0f - w), 1.0f) : 0.0f;
    a.reflected = lobe_light_add(ambient_sample_lobe(s, v, lobe, tint.flakes, t.strips, e.first + e.second, own),
                                 ambient_sample_lights(s, v, lobe, tint.flakes, t.strips));
    a.light_fraction = 0.0f;
    return a;
}

FN SlotLight ambient_fitted_light(AmbientTable t, AmbientSource s, AmbientView v, AmbientLookups residual,
                                  AmbientCoord at, AmbientAlbedo e) {
    SlotLight a;
    a.light_fraction = 1.0f;
    a.reflected = ambient_broad_light(residual, e);
    if (!t.focus) return a;
    AmbientWeights shape = ambient_group(t, s, at, AMBIENT_GROUP_SHAPE);
    float sine = clamp(shape.a, -1.0f, 1.0f), log2_kappa = shape.b, kappa = exp2(log2_kappa);
    Dir axis = ambient_to_lobe(v, dir(sine, 0.0f, sqrt(max(1.0f - sine * sine, 0.0f)))), w = ambient_to_source(v, axis);
    float open = ambient_sky_visibility(s, w, kappa, axis.z, v.occlusion);
    Rgb wide = rgb_scale(ambient_residual(s, w, kappa), open);
    a.reflected = lobe_light_mix(a.reflected, lobe_light_of(wide, e.first, e.second),
                                 ambient_kappa_blend(log2_kappa, AMBIENT_CLOSE));
    if (!t.narrow) return a;
    float narrow = ambient_kappa_blend(log2_kappa, ambient_light_kappa(s) - AMBIENT_FINER);
    Rgb sharp = ambient_radiance_with_tail(s, w, kappa, clamp(shape.c, 0.0f, 1.0f));
    float lights = ambient_light_visibility(s, ambient_nearest_light(s, w), open);
    sharp = ambient_visible_radiance(s, w, sharp, kappa, lights, open);
    a.reflected = lobe_light_mix(a.reflected, lobe_light_of(sharp, e.first, e.second), narrow);
    a.light_fraction = 1.0f - narrow;
    return a;
}

/* Works as ambient_slot_light for a slot that is not sampled. The light of a tinted lobe is that of its flakes. */
FN SlotLight ambient_lookup_light(AmbientTable t, AmbientSource s, AmbientView v, AmbientLookups residual, Lobe lobe,
                                  AmbientTint tint, float albedo) {
    float p = lobe.params[0];
    AmbientCoord at = ambient_coord(t, v.o.z, v.heading, p);
    AmbientAlbedo e = ambient_albedo(t, s, at, albedo);
    SlotLight a;
    if (IS_IRRADIANCE(t))
        a = ambient_irradiance_light(s, v, e);
    else if (IS_MIRROR(t))
        a = ambient_mirror_light(t, s, v, p, e);
    else
        a = ambient_fitted_light(t, s, v, residual, at, e);
    a.reflected.first = ambient_tinted(ambient_tint_at(t, s, at, tint.whole), tint.flakes, a.reflected.first);
    return a;
}

/* Returns the light of an environment that a slot's lobe reflects, by the strategy of its table. residual: the look-ups
 * in this view, which strategy `sampled` does not read. albedo: see ambient_albedo. */
FN SlotLight ambient_slot_light(AmbientTable t, AmbientSource s, AmbientView v, AmbientLookups residual, Lobe lobe,
                                AmbientTint tint, float albedo) {
    if (t.strategy == AMBIENT_SAMPLED) return ambient_sampled_light(t, s, v, residual, lobe, tint, albedo);
    return ambient_lookup_light(t, s, v, residual, lobe, tint, albedo);
}
