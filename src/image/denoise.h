/* denoise.h - denoising of a rendered picture by regression on albedo, normal and depth of its surfaces
 *
 * Benedikt Bitterli, Fabrice Rousselle, Bochang Moon, Jose A. Iglesias-Guitian, David Adler, Kenny Mitchell,
 * Wojciech Jarosz, Jan Novak, "Nonlinearly Weighted First-order Regression for Denoising Monte Carlo
 * Renderings", 2016; without its filter of the features, its choice among two widths, and its second pass. */
#pragma once

#include <stdbool.h>
#include <stddef.h>

enum {
    DENOISE_COLORS = 4,   /* radiance times coverage, coverage */
    DENOISE_FEATURES = 7, /* albedo, normal, depth */
};

/* The planes of a picture in two independent halves: pixel (x, y) is at [y * stride + x], with a margin around. */
typedef struct DenoisePlanes {
    int width, height;
    size_t stride;
    float *color[2][DENOISE_COLORS];
    float *feature[DENOISE_FEATURES]; /* of both halves, of about unit size */
    float *variance;                  /* of the radiance of a half, in all channels; made by denoise */
    float *out[DENOISE_COLORS];       /* the denoised picture, of both halves */
    float *memory;                    /* of all planes */
} DenoisePlanes;

/* Makes zeroed planes; returns false if memory is short. Release with denoise_planes_free. */
bool denoise_planes_create(DenoisePlanes *planes, int width, int height);
void denoise_planes_free(DenoisePlanes *planes);

/* Fills `out`, with the same bytes on any number of threads. Returns false if memory is short. */
bool denoise(DenoisePlanes *planes, int threads);
