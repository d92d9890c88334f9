/* catcher.h - the floor that catches shadow and reflection of the scene along camera rays
 *
 * With B the background behind a point of the floor, seen with coverage a, M what is mirrored at the share r
 * of the rays that meet the scene, c = r where one does, and V the part of the light that reaches the point,
 *
 *   radiance = B a V (1 - c) + r M,   coverage = 1 - (1 - a) V (1 - c),   V = sum reached / sum whole
 *
 * over all samples of the pixel, since a mean of quotients is not the quotient of means. */
#ifndef WEFT_TRACE_CATCHER_H
#define WEFT_TRACE_CATCHER_H

#include "scene/light/floor.h"
#include "trace/path_context.h"

/* Sums over the samples of a pixel that meet the floor. */
typedef struct Caught {
    float behind[3];      /* B a (1 - c) */
    float clear;          /* (1 - a) (1 - c) */
    float whole, reached; /* luminance of the light: were nothing in its way, and as it is */
} Caught;

/* A camera ray that meets the floor, t away, and the random numbers it takes. */
typedef struct CatcherRay {
    Ray ray;
    float t;
    PathKey key;
} CatcherRay;

/* The part of the scene that the floor mirrors: the ray, its hit, and the share c of the light from there. */
typedef struct Mirrored {
    Ray ray;
    Hit hit;
    float share;
} Mirrored;

/* Adds what a camera ray finds on the floor, but for c M, and returns true where the mirror shows the scene.
 * `behind` is B a and a. What is added to `sum`, radiance and coverage, is without V: catcher_resolve puts
 * that right. */
bool catcher_sample(const PathContext *context, const Floor *floor, const CatcherRay *ray,
                    const float behind[4], Caught *caught, float sum[4], Mirrored *mirrored, long long *rays);

/* Turns sum, radiance times coverage and coverage of all samples of a pixel, into what V makes of them. */
void catcher_resolve(const Caught *caught, float sum[4]);

#endif
