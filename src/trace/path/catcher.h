/* catcher.h - the floor that catches shadow and reflection of the scene along camera rays
 *
 * B is the background behind a point of the floor, seen with coverage a. M is the radiance that the floor mirrors with
 * reflectance r, and c = r for samples whose mirrored ray meets the scene, else 0. V is the part of the light that
 * reaches the point:
 *
 *   radiance = B a V (1 - c) + r M,   coverage = 1 - (1 - a) V (1 - c),   V = sum reached / sum whole
 *
 * V is a quotient of sums over all samples of the pixel, since the mean of quotients is not the quotient of means. */
#pragma once

#include "scene/light/floor.h"
#include "trace/path/path_context.h"

/* Sums over the samples of a pixel that meet the floor. */
typedef struct Caught {
    float behind[3];      /* B a (1 - c) */
    float clear;          /* (1 - a) (1 - c) */
    float whole, reached; /* luminance of the light without and with occlusion */
} Caught;

/* A camera ray that meets the floor at distance t, and the key of its random numbers. */
typedef struct CatcherRay {
    Ray ray;
    float t;
    PathKey key;
} CatcherRay;

/* The mirrored ray, its hit, and c. */
typedef struct Mirrored {
    Ray ray;
    Hit hit;
    float share;
} Mirrored;

/* Adds what a camera ray finds on the floor, except c M, and returns true if the mirrored ray meets the scene.
 * `behind` is B a and a. The radiance and coverage added to `sum` lack the factor V, which catcher_resolve applies.
 * *rays counts the rays traced. */
bool catcher_sample(const PathContext *context, const Floor *floor, const CatcherRay *ray, const float behind[4],
                    Caught *caught, float sum[4], Mirrored *mirrored, long long *rays);

/* Applies V to sum: radiance times coverage, and coverage, of all samples of a pixel. */
void catcher_resolve(const Caught *caught, float sum[4]);
