/* ambient_source.h - the functions through which a material reads an environment, for callers in C
 *
 *   ambient_radiance(s, w, kappa)  radiance about w: mean of L(i) weighted by exp(kappa (i . w - 1))
 *   ambient_irradiance(s, w)       mean of L(i) weighted by max(i . w, 0)
 *   ambient_light(s, k)            light k of the directional lights that replace the brightest parts of L
 *   ambient_light_count(s)         number of these lights
 *   ambient_light_visibility(s, k, occlusion)
 *                                  visible part of light k, 0 to 1; in C it is `occlusion`, the visible part of the sky
 *   ambient_light_behind(s, k, open)
 *                                  the same of a light behind the surface; `open` is the visible part of the sky there
 *   ambient_nearest_light(s, w)    number of the light nearest to w; -1 if there is none
 *   ambient_point(s, k)            point k of those that the lights are divided into, for lobes so narrow that they
 *                                  show the shape of a light
 *   ambient_point_count(s)         number of these points
 *   ambient_sky_visibility(s, w, kappa, cos_i, occlusion)
 *                                  visible part of the sky about w under a filter of that kappa, 0 for a wide one;
 *                                  `occlusion` is the visible part of the cosine-weighted sky, cos_i the cosine of
 *                                  the look-up's axis to the normal
 *   ambient_bent_direction(s, w, kappa, open)
 *                                  mean direction of the visible sky under a filter of that kappa about w; in
 *                                  C it is w. `open` is the visible part of that filter. A cosine filter
 *                                  about the normal counts as kappa 4.
 *   ambient_light_kappa(s)         log2 of the kappa of a filter as wide as the region that a light replaces
 *   ambient_residual(s, w, kappa)  L without its lights, which is smooth, filtered as radiance is
 *   ambient_baked(s, k)            coefficients k of the baked tables (ambient_table.h)
 *   ambient_diffuse(s)             factor on the light that the diffuse lobe and dust reflect, 1 in C
 *   ambient_reflection(s)          factor on the light that every other lobe reflects, 1 in C
 *
 * ambient_residual with kappa 0 has the weight of irradiance. Directions are unit, in the shading frame (angles.h).
 * L = residual + lights; radiance and irradiance are of L. In GLSL a source is a Frame, and the program that draws
 * provides these functions in place of this file (raster/light/gl_environment.h). */
#pragma once

#include "shading/ambient/occlusion_cone.h"
#include "shading/dialect/rgb.h"

STRUCT(AmbientLight) {
    Dir w;
    Rgb color;     /* irradiance on a surface that faces it */
    float density; /* 1/sr: 1 / the solid angle of one point; for a light, of any of its points */
    int light;     /* number of the light, or of the light that a point is part of */
};

/* Four numbers of a table. */
STRUCT(AmbientWeights) { float a, b, c, d; };

typedef struct AmbientSourceCalls {
    Rgb (*radiance)(const void *user, Dir w, float kappa);
    Rgb (*irradiance)(const void *user, Dir w);
    Rgb (*residual)(const void *user, Dir w, float kappa);
    AmbientLight (*light)(const void *user, int k);
    const void *user;
    int count;
    float env_light_kappa;
    const AmbientWeights *baked;                    /* may be NULL where no table is */
    AmbientLight (*point)(const void *user, int k); /* may be NULL if point_count is 0 */
    int point_count;
} AmbientSourceCalls;

typedef const AmbientSourceCalls *AmbientSource;

FN Rgb ambient_radiance(AmbientSource s, Dir w, float kappa) { return s->radiance(s->user, w, kappa); }
FN Rgb ambient_irradiance(AmbientSource s, Dir w) { return s->irradiance(s->user, w); }
FN Rgb ambient_residual(AmbientSource s, Dir w, float kappa) { return s->residual(s->user, w, kappa); }
FN int ambient_light_count(AmbientSource s) { return s->count; }
FN float ambient_light_kappa(AmbientSource s) { return s->env_light_kappa; }
FN AmbientWeights ambient_baked(AmbientSource s, int k) { return s->baked[k]; }
FN AmbientLight ambient_light(AmbientSource s, int k) { return s->light(s->user, k); }
FN float ambient_light_visibility(AmbientSource s, int k, float occlusion) { return occlusion; }
FN float ambient_light_behind(AmbientSource s, int k, float open) { return open; }
FN AmbientLight ambient_point(AmbientSource s, int k) { return s->point(s->user, k); }
FN int ambient_point_count(AmbientSource s) { return s->point_count; }
FN int ambient_nearest_light(AmbientSource s, Dir w) {
    float most = -2.0f;
    int nearest = -1;
    for (int k = 0; k < s->count; k++) {
        float mu = dir_dot(w, ambient_light(s, k).w);
        if (mu > most) nearest = k;
        most = max(most, mu);
    }
    return nearest;
}
FN float ambient_sky_visibility(AmbientSource s, Dir w, float kappa, float cos_i, float occlusion) {
    return occlusion_cone(occlusion, cos_i);
}
FN Dir ambient_bent_direction(AmbientSource s, Dir w, float kappa, float open) { return w; }
FN float ambient_diffuse(AmbientSource s) { return 1.0f; }
FN float ambient_reflection(AmbientSource s) { return 1.0f; }
