/* denoise.h - denoising of a rendered picture by regression on albedo, normal and depth of its surfaces
 *
 * Benedikt Bitterli, Fabrice Rousselle, Bochang Moon, Jose A. Iglesias-Guitian, David Adler, Kenny Mitchell,
 * Wojciech Jarosz, Jan Novak, "Nonlinearly Weighted First-order Regression for Denoising Monte Carlo
 * Renderings", 2016; without its choice among two widths and its second pass. Where the fit misses more of the picture
 * than it takes of its noise, the picture is kept. */
#pragma once

#include <stdbool.h>
#include <stddef.h>

enum {
    DENOISE_COLORS = 4,                   /* radiance times coverage, coverage */
    DENOISE_NOISY = 6,                    /* features with noise of their own: albedo, normal */
    DENOISE_FEATURES = DENOISE_NOISY + 1, /* these, and depth */
};

/* The planes of a picture in two independent halves: pixel (x, y) is at [y * stride + x], with a margin around. */
typedef struct DenoisePlanes {
    int width, height;
    size_t stride;
    float *color[2][DENOISE_COLORS];
    float *noisy[2][DENOISE_NOISY];   /* features of each half, of about unit size */
    float *feature[DENOISE_FEATURES]; /* of both halves; the last is given, the others are made by denoise */
    float *variance;                  /* of a half, in all channels; made by denoise */
    float *own;                       /* the weight of a pixel in the fit to it; made by denoise */
    float *out[DENOISE_COLORS];       /* the denoised picture, of both halves */
    float *memory;                    /* of all planes */
} DenoisePlanes;

/* Makes zeroed planes; returns false if memory is short. Release with denoise_planes_free. */
bool denoise_planes_create(DenoisePlanes *planes, int width, int height);
void denoise_planes_free(DenoisePlanes *planes);

/* Fills `out`, with the same bytes on any number of threads. Returns false if memory is short. */
bool denoise(DenoisePlanes *planes, int threads);
