/* env_split.h - an environment split for real-time lighting: directional lights for its bright parts, and a smooth
 * residual
 *
 * A texel of luminance Y gives the fraction min(1, AMBIENT_CLIP mean(Y) / Y) to the residual, and the rest to the
 * lights, by k-means over directions: each light has the mean direction of its texels' light. Directions are those of
 * the image, before Environment.rotation; colours are without Environment.strength. */
#pragma once

#include "scene/record/scene.h"

enum { AMBIENT_LIGHTS_MAX = 16, AMBIENT_LIGHTS = 8, AMBIENT_TERMS = 25, AMBIENT_RESIDUAL_TERMS = 16 };

/* Points into which all lights together are divided, by their luminance. Each light has at least one. */
enum { AMBIENT_POINTS = 48, AMBIENT_POINTS_MAX = AMBIENT_POINTS + AMBIENT_LIGHTS_MAX };

#define AMBIENT_CLIP 1.25

/* log2 kappa of lights from which on no more are added. */
#define AMBIENT_LIGHT_KAPPA 9.0f

/* log2 kappa that the terms of the residual can represent. */
#define AMBIENT_EVEN_KAPPA 6.0f

typedef struct EnvLight {
    Vec3 direction; /* towards it, unit */
    float color[3]; /* irradiance on what faces it */
    float spread;   /* mean squared distance of its texels' light from `direction`, on the unit sphere */
    int points;     /* number of points that it is divided into, 1 or more */
} EnvLight;

/* A part of an EnvLight, found by k-means among its texels. Its points together show the shape of a light. */
typedef struct EnvPoint {
    Vec3 direction; /* towards it, unit */
    float color[3]; /* irradiance on what faces it */
    int light;      /* the number of its EnvLight */
} EnvPoint;

/* Luminance of a residual, means over the texels of a lat-long image. */
enum { AMBIENT_REST_WIDTH = 64, AMBIENT_REST_HEIGHT = 32 };
typedef struct AmbientRest {
    float luminance[AMBIENT_REST_HEIGHT][AMBIENT_REST_WIDTH];
} AmbientRest;

typedef struct AmbientParts {
    EnvLight env_lights[AMBIENT_LIGHTS_MAX];
    int env_light_count;
    EnvPoint points[AMBIENT_POINTS_MAX]; /* sorted by light */
    int point_count;
    /* log2 of 2 over the mean spread of the lights; AMBIENT_EVEN_KAPPA without lights. */
    float env_light_kappa;
    /* Irradiance over pi of the whole environment, lights and residual: sum_k terms[k] p_k(n), p of
     * ambient_polynomials. */
    float terms[AMBIENT_TERMS][3];
    float residual_sh[AMBIENT_TERMS][3]; /* radiance of the residual, likewise */
    AmbientRest rest;                    /* luminance of the residual, with more detail */
} AmbientParts;

/* Splits an environment into lights, at most env_lights (0, or 2 .. AMBIENT_LIGHTS_MAX), and a residual. Fails with
 * WEFT_MESSAGE_MEMORY. */
WeftResult ambient_split(const Environment *environment, int env_lights, AmbientParts *out, WeftError *error);

/* Returns the density of directions, 1/sr, of which each covers the solid angle of a point of this light: points kappa
 * / pi, kappa = 2 / spread. exp(kappa (mu - 1)) covers 2 pi / kappa, twice that of a light. */
float env_light_density(const EnvLight *light);

/* Evaluates the spherical harmonics of degrees 0 to 4, without their factors. The clamped cosine has no degree 3, and a
 * thousandth of degree 6: Ravi Ramamoorthi, Pat Hanrahan, "On the Relationship between Radiance and Irradiance", JOSA A
 * 18(10), 2001. */
void ambient_polynomials(Vec3 n, float p[AMBIENT_TERMS]);

/* Evaluates ambient_residual of ambient_source.h, from the first AMBIENT_RESIDUAL_TERMS of the residual's terms.
 * exp(kappa mu) has the Legendre coefficients a_0 = 1, a_1 = coth kappa - 1 / kappa, a_(l+1) = a_(l-1) - (2 l + 1) /
 * kappa a_l. */
void ambient_rest_about(const AmbientParts *parts, Vec3 w, float kappa, float color[3]);

/* Returns the luminance of the texel along a unit direction. */
float ambient_rest_at(const AmbientRest *rest, Vec3 direction);

/* Sets the radiance of an F32 lat-long image along a unit direction of its own frame, bilinear. */
void latlong_at(const WeftImage *image, Vec3 direction, float color[3]);

/* Resizes an image to F32 RGB: each texel is the mean over solid angle of those that it covers, or bilinear if either
 * side grows. Fails with WEFT_MESSAGE_MEMORY. */
WeftResult latlong_resize(const WeftImage *image, int width, int height, WeftImage *out, WeftError *error);

/* Returns the unit direction of a point of the image, u and v in [0, 1]. */
Vec3 latlong_direction(double u, double v);

/* Returns a direction of the image in the world, for Environment.rotation in radians; the negative rotation converts
 * back. */
Vec3 latlong_rotated(Vec3 direction, float rotation);
