/* samples.h - f at many pairs of directions, which something else is to come close to
 *
 * The metrics and their formulas are in weft/match.h. Everything here is in x = f cos_i. */
#ifndef WEFT_MEASURE_SAMPLES_H
#define WEFT_MEASURE_SAMPLES_H

#include <stdbool.h>

#include "weft/match.h"

typedef struct Samples {
    int count;
    int outs;           /* > 0: sample k has direction wo number k % outs; 0: each its own */
    int first;          /* samples [0, first) stand for all where that is enough */
    int channels;       /* 3, or 1 where the others are the same */
    float *o[3], *i[3]; /* unit vectors, above the horizon */
    float *weight;
    float *x[3];    /* what is to be met */
    float *goal[3]; /* g of it */
    WeftBrdfMetric metric;
    float scale;     /* the m of LOG */
    double whole[2]; /* what is below the line: of `first` samples, of all */
    float *block;
} Samples;

/* Room for count samples, all zero. False where memory is short; release with samples_free in any case. */
bool samples_create(Samples *samples, int count, WeftBrdfMetric metric);
void samples_free(Samples *samples);

/* The directions and weights that the metric is defined by. */
bool samples_spread(Samples *samples, WeftBrdfMetric metric);

/* Fills x with a reflection's. */
void samples_ask(const Samples *samples, const WeftReflection *reflection, int part, float *const x[3]);

/* Returns true if the reflection is isotropic. */
bool samples_isotropic(const Samples *samples, const WeftReflection *reflection);

/* To be called when directions, weights and x are there, before all that follows. */
void samples_finish(Samples *samples);

/* g(x). */
float samples_goal(const Samples *samples, float x);

/* The error of x over the first count samples: `first` or all of them. */
double samples_distance(const Samples *samples, int count, const float *const x[3]);

/* Returns what x of channel c adds to that error, where channels differ. */
double samples_channel_error(const Samples *samples, int count, int c, const float *x);

#endif
