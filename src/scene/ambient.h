/* ambient.h - an environment taken apart for real-time light: lamps for what is bright, and an even rest
 *
 * Of a texel of luminance Y the part min(1, AMBIENT_CLIP mean(Y) / Y) is the rest's; what is above goes to
 * the lamps, by k-means over directions: each stands where the light of its texels has its mean. Directions
 * are those of the image, before Environment.rotation; colours do without Environment.strength. */
#ifndef WEFT_SCENE_AMBIENT_H
#define WEFT_SCENE_AMBIENT_H

#include "scene/scene.h"

enum { AMBIENT_LAMPS_MAX = 16, AMBIENT_LAMPS = 8, AMBIENT_TERMS = 25, AMBIENT_REST_TERMS = 16 };

#define AMBIENT_CLIP 1.25

/* log2 kappa of lamps that is fine enough: then there are no more of them. */
#define AMBIENT_LAMP_KAPPA 9.0f

/* The rest tells no more than that. */
#define AMBIENT_EVEN_KAPPA 6.0f

typedef struct AmbientLamp {
    Vec3 direction; /* towards it, unit */
    float color[3]; /* irradiance on what faces it */
    float spread;   /* mean squared distance of its light from it, on the unit sphere */
} AmbientLamp;

typedef struct AmbientParts {
    AmbientLamp lamps[AMBIENT_LAMPS_MAX];
    int lamp_count;
    /* log2 of it: 2 over the mean squared distance of light to its lamp; AMBIENT_EVEN_KAPPA where all is even
     * and there is none. */
    float lamp_kappa;
    /* Irradiance over pi of all of the environment, lamps and rest: sum_k terms[k] p_k(n), p of
     * ambient_polynomials. */
    float terms[AMBIENT_TERMS][3];
    float rest_terms[AMBIENT_TERMS][3]; /* radiance of the rest */
} AmbientParts;

/* As many lamps as are enough, but at most `lamps`: 0, or 2 .. AMBIENT_LAMPS_MAX. Fails with
 * WEFT_MESSAGE_MEMORY. */
WeftResult ambient_split(const Environment *environment, int lamps, AmbientParts *out, WeftError *error);

/* Spherical harmonics of degrees 0 to 4, without their factors. The cosine has none of degree 3, and of
 * degree 6 a thousandth: Ravi Ramamoorthi, Pat Hanrahan, "On the Relationship between Radiance and
 * Irradiance", JOSA A 18(10), 2001. */
void ambient_polynomials(Vec3 n, float p[AMBIENT_TERMS]);

/* ambient_rest of ambient_source.h by the first AMBIENT_REST_TERMS of the rest's terms. exp(kappa mu) has the
 * Legendre coefficients a_0 = 1, a_1 = coth kappa - 1 / kappa, a_(l+1) = a_(l-1) - (2 l + 1) / kappa a_l. */
void ambient_rest_about(const AmbientParts *parts, Vec3 w, float kappa, float color[3]);

/* Radiance of an F32 lat-long image along a unit direction of its own frame, bilinear. */
void latlong_at(const WeftImage *image, Vec3 direction, float color[3]);

/* The image in another size, F32 RGB: each texel the mean over solid angle of those that it covers, or, where
 * either side grows, bilinear. */
WeftResult latlong_resize(const WeftImage *image, int width, int height, WeftImage *out, WeftError *error);

/* The unit direction of a point of the image, u and v in [0, 1]. */
Vec3 latlong_direction(double u, double v);

#endif
