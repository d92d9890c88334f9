/* ambient_samples.h - importance sampling of environment light for one lobe
 *
 * Used for lobes that one axis and one width describe badly: a ring around the normal, or an elongated
 * highlight. Samples of the latter are placed in strips (terms/d_ggx.h). Two estimates are combined:
 *
 *   samples of the lobe   the mean of (f cos_i / pdf) L(i, kappa), where kappa follows from the density of
 *                         samples: Jaroslav Krivanek, Mark Colbert, "Real-time Shading with Filtered
 *                         Importance Sampling", Computer Graphics Forum 27(4), 2008
 *   points of the lights  f cos_i of each of the points into which the environment lights are divided
 *
 * Both see the lights. Each light is weighted by the squares of the two densities, the power heuristic of Eric Veach,
 * Leonidas Guibas, "Optimally Combining Sampling Techniques for Monte Carlo Rendering", SIGGRAPH 1995. */
#pragma once

#include "shading/ambient/ambient_view.h"
#include "shading/catalogue/registry.h"

/* Number of samples of a lobe without strips and of a lobe with strips. The place of strip k on its arc is the
 * fraction of k AMBIENT_STRIP_STEP, so that strips are a lattice: N. M. Korobov, "The Approximate Computation of Multiple
 * Integrals", 1959. Of all lattices of 14 to 26 strips this number and step have the sums nearest to E of brushed lobes. */
#define AMBIENT_SAMPLES       32
#define AMBIENT_STRIP_SAMPLES 24
#define AMBIENT_STRIP_STEP    (7.0f / 24.0f)

/* Factor on the density of samples in the power heuristic, fitted with study_ambient. It favours samples, which follow
 * the lobe; points only follow the lights. A strip is narrower than the space between points for longer. */
#define AMBIENT_SAMPLE_TRUST 4.0f
#define AMBIENT_STRIP_TRUST  6.0f

/* Returns the number of samples, and what the density of one of them is multiplied by in the power heuristic. */
FN int ambient_sample_count(bool strips) { return strips ? AMBIENT_STRIP_SAMPLES : AMBIENT_SAMPLES; }
FN float ambient_sample_trust(bool strips) { return strips ? AMBIENT_STRIP_TRUST : AMBIENT_SAMPLE_TRUST; }

/* The colour of a tinted lobe (tint.h), by which the lobe itself tints light that has a direction. */
STRUCT(AmbientTint) {
    Tint whole; /* of all light that goes to wo */
    Rgb flakes; /* albedo of what the lobe is made of; white for a lobe that is not tinted */
};

FN AmbientTint ambient_untinted(void) {
    AmbientTint t;
    t.whole = tint_none();
    t.flakes = rgb_grey(1.0f);
    return t;
}

FN Rgb ambient_tinted(Tint t, Rgb flakes, Rgb light) {
    if (!IS_TINTED(t)) return rgb_mul(light, flakes);
    return rgb(light.r * tint_color(t, flakes.r), light.g * tint_color(t, flakes.g), light.b * tint_color(t, flakes.b));
}

FN float ambient_power_heuristic(float a, float b) { return a * a / max(a * a + b * b, 1e-30f); }

/* Returns the weight of the lights in a sample of the lobe about w, times the visibility of the nearest light.
 * density: of samples, 1/sr, times the trust in them. open: the visible part of the sky about w. */
FN float ambient_sample_weight(AmbientSource s, Dir w, float density, float open) {
    int nearest = ambient_nearest_light(s, w);
    if (nearest < 0) return open;
    AmbientLight l = ambient_light(s, nearest);
    return ambient_power_heuristic(density, l.density) * ambient_light_visibility(s, nearest, open);
}

/* One sample of a lobe. */
STRUCT(AmbientSample) {
    Dir i;
    float density; /* relative to the pdf of the lobe */
};

FN AmbientSample ambient_sample(Lobe lobe, Dir o, bool strips, float u, float v) {
    AmbientSample x;
    if (strips) {
        Strip strip = lobe_strip(&lobe, o, u, v);
        x.i = dir_mirror(o, strip.h);
        x.density = strip.density;
    } else {
        x.i = lobe_sample(&lobe, o, u, v);
        x.density = 1.0f;
    }
    return x;
}

/* Returns the place of sample k across its strip, or of a sample that has none, 0 to 1. */
FN float ambient_sample_place(bool strips, int k) {
    float v = strips ? to_float(k) * AMBIENT_STRIP_STEP : to_float(k) * 0.618033989f + 0.25f;
    return v - floor(v);
}

/* Returns the estimate from samples of the lobe: the residual, plus the lights weighted by the power
 * heuristic. A sample stands for the solid angle 1 / (n pdf). The paper filters over twice that angle, so
 * that neighbours overlap; a filter exp(kappa (mu - 1)) covers 2 pi / kappa, hence kappa = pi n pdf. Strips
 * are a lattice and cover that angle once, hence twice that kappa. The sum
 * is scaled to `albedo`, which has less noise, but for the part `own` of it. */
FN LobeLight ambient_sample_lobe(AmbientSource s, AmbientView v, Lobe lobe, Rgb flakes, bool strips, float albedo,
                                 float own) {
    LobeLight sum = lobe_light_of(rgb_grey(0.0f), 0.0f, 0.0f);
    int count = ambient_sample_count(strips);
    float e = 0.0f, n = to_float(count);
    for (int k = 0; k < count; k++) {
        AmbientSample one =
            ambient_sample(lobe, v.o, strips, (to_float(k) + 0.5f) / n, ambient_sample_place(strips, k));
        Dir i = one.i;
        if (i.z > 0.0f) {
            LobeValue x = lobe_value(&lobe, angles_between(v.o, i));
            float density = max(x.pdf * one.density * n, 1e-20f), weight = x.f * i.z / density;
            float kappa = clamp((strips ? 2.0f * PI : PI) * density, 0.5f, 1e4f);
            Dir w = ambient_to_source(v, i);
            Rgb all = ambient_radiance(s, w, kappa);
            /* as wide as the lobe: with kappa of one sample light of fibres past folds is further off (study_occluded) */
            float open = ambient_sky_visibility(s, w, 0.0f, i.z, v.occlusion);
            float lights = ambient_sample_weight(s, w, density * ambient_sample_trust(strips), open);
            Rgb l = rgb_scale(ambient_visible_radiance(s, w, all, kappa, lights, open), weight);
            sum = lobe_light_add(sum, lobe_light_of(ambient_tinted(x.tint, flakes, l), 1.0f - x.s, x.s));
            e = e + weight;
        }
    }
    return lobe_light_scale(sum, mix(albedo / max(e, 1e-20f), 1.0f, own));
}

/* Returns the estimate from points of the lights, with the complementary weight. Each point is evaluated as a
 * directional light. */
FN LobeLight ambient_sample_lights(AmbientSource s, AmbientView v, Lobe lobe, Rgb flakes, bool strips) {
    LobeLight sum = lobe_light_of(rgb_grey(0.0f), 0.0f, 0.0f);
    int count = ambient_point_count(s);
    float n = ambient_sample_trust(strips) * to_float(ambient_sample_count(strips));
    for (int k = 0; k < count; k++) {
        AmbientLight l = ambient_point(s, k);
        Dir i = dir(dir_dot(l.w, v.x), dir_dot(l.w, v.y), dir_dot(l.w, v.z));
        if (i.z > 0.0f) {
            LobeValue x = lobe_value(&lobe, angles_between(v.o, i));
            float weight = ambient_power_heuristic(l.density, x.pdf * n);
            Rgb c = rgb_scale(l.color, x.f * i.z * weight * ambient_light_visibility(s, l.light, v.occlusion));
            sum = lobe_light_add(sum, lobe_light_of(ambient_tinted(x.tint, flakes, c), 1.0f - x.s, x.s));
        }
    }
    return sum;
}
