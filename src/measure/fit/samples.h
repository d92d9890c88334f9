/* samples.h - f at many pairs of directions, the goal of a fit
 *
 * The metrics and their formulas are in weft/match.h. Everything here is in x = f cos_i. */
#pragma once

#include <stdbool.h>

#include "weft/match.h"

typedef struct Samples {
    int count;
    int outs;           /* > 0: sample k has direction wo number k % outs; 0: each sample has its own */
    int first;          /* samples [0, first) represent all where a rough error is enough */
    int channels;       /* 3, or 1 if all channels are equal */
    float *o[3], *i[3]; /* unit vectors, above the horizon */
    float *weight;
    float *x[3];    /* the goal in x */
    float *goal[3]; /* g(x) of the goal */
    WeftBrdfMetric metric;
    float scale;     /* the m of metric LOG */
    double whole[2]; /* the denominator of the error: of the first `first` samples, of all */
    float *block;
} Samples;

/* Allocates count samples, all zero. Returns false if memory is short; release with samples_free in any case. */
bool samples_create(Samples *samples, int count, WeftBrdfMetric metric);
void samples_free(Samples *samples);

/* Makes samples with the directions and weights that define the metric. */
bool samples_spread(Samples *samples, WeftBrdfMetric metric);

/* Evaluates part of a reflection at all samples, as x = f cos_i. */
void samples_eval(const Samples *samples, const WeftReflection *reflection, int part, float *const x[3]);

/* Returns true if the reflection is isotropic. */
bool samples_isotropic(const Samples *samples, const WeftReflection *reflection);

/* Computes all that follows from directions, weights and x. Call it when these are set, before the functions below. */
void samples_finish(Samples *samples);

/* Returns g(x). */
float samples_goal(const Samples *samples, float x);

/* Returns the error of x over the first count samples, which are `first` or all of them. */
double samples_distance(const Samples *samples, int count, const float *const x[3]);

/* Returns what x of channel c adds to that error, if channels differ. */
double samples_channel_error(const Samples *samples, int count, int c, const float *x);
