/* ambient_source.h - the light of an environment, as a material asks for it, for callers in C
 *
 *   ambient_radiance(s, w, kappa)  radiance about w: mean of L(i) weighted by exp(kappa (i . w - 1))
 *   ambient_irradiance(s, w)       mean of L(i) weighted by max(i . w, 0)
 *   ambient_light(s, k)            lamp k of those that stand for the brightest of L
 *   ambient_count(s)               how many there are
 *   ambient_seen(s, k, occlusion)  the part of lamp k that is seen, where that part of the sky is: no more is
 *                                  known of it in C
 *   ambient_seen_at(s, w, open)    the same of the lamp nearest to w; `open` where that is not known
 *   ambient_open(s, w, cos_i, occlusion)
 *                                  the part of the sky about w that is seen, where that part of the
 *                                  cosine-weighted sky is; cos_i is that of its look-up's axis to the normal
 *   ambient_bent(s, w, kappa, open)
 *                                  the mean direction of what is seen about w, which of a weight as wide as
 *                                  kappa is the part `open`; the cosine's kappa is 4
 *   ambient_lamp_kappa(s)          log2 of the kappa of a weight as wide as what a lamp stands for
 *   ambient_rest(s, w, kappa)      what the lamps leave of L, which is smooth, weighted as radiance is
 *   ambient_held(s, k)             coefficients k of tables that are held (ambient.h)
 *   ambient_diffuse(s)             a factor on what the diffuse lobe and dust reflect of it all, 1 in C
 *   ambient_reflection(s)          the same of every other lobe
 *
 * ambient_rest takes kappa 0 for the weight of irradiance. Directions are unit, in the shading frame
 * (angles.h). So L = rest + lamps, and radiance and irradiance are of L. In GLSL a source is a Frame, and
 * whoever draws provides these functions in this file's place (raster/environment.h). */
#ifndef WEFT_SHADING_AMBIENT_SOURCE_H
#define WEFT_SHADING_AMBIENT_SOURCE_H

#include "shading/occlusion_cone.h"
#include "shading/rgb.h"

STRUCT(AmbientLight) {
    Dir w;
    Rgb color; /* irradiance on a surface that faces it */
};

/* Four numbers of a table. */
STRUCT(AmbientWeights) { float a, b, c, d; };

typedef struct AmbientSourceCalls {
    Rgb (*radiance)(const void *user, Dir w, float kappa);
    Rgb (*irradiance)(const void *user, Dir w);
    Rgb (*rest)(const void *user, Dir w, float kappa);
    AmbientLight (*light)(const void *user, int k);
    const void *user;
    int count;
    float lamp_kappa;
    const AmbientWeights *held; /* may be NULL where no table is */
} AmbientSourceCalls;

typedef const AmbientSourceCalls *AmbientSource;

FN Rgb ambient_radiance(AmbientSource s, Dir w, float kappa) { return s->radiance(s->user, w, kappa); }
FN Rgb ambient_irradiance(AmbientSource s, Dir w) { return s->irradiance(s->user, w); }
FN Rgb ambient_rest(AmbientSource s, Dir w, float kappa) { return s->rest(s->user, w, kappa); }
FN int ambient_count(AmbientSource s) { return s->count; }
FN float ambient_lamp_kappa(AmbientSource s) { return s->lamp_kappa; }
FN AmbientWeights ambient_held(AmbientSource s, int k) { return s->held[k]; }
FN AmbientLight ambient_light(AmbientSource s, int k) { return s->light(s->user, k); }
FN float ambient_seen(AmbientSource s, int k, float occlusion) { return occlusion; }
FN float ambient_seen_at(AmbientSource s, Dir w, float open) { return open; }
FN float ambient_open(AmbientSource s, Dir w, float cos_i, float occlusion) {
    return occlusion_cone(occlusion, cos_i);
}
FN Dir ambient_bent(AmbientSource s, Dir w, float kappa, float open) { return w; }
FN float ambient_diffuse(AmbientSource s) { return 1.0f; }
FN float ambient_reflection(AmbientSource s) { return 1.0f; }

#endif
