/* diff.h - difference of two images: as one number, and pixel by pixel
 *
 * Integer pixels are display-referred (sRGB), F32 pixels linear radiance. Where only one of the two is
 * linear, it is first tone-mapped by weft_image_tonemap. Colours are multiplied by their alpha, as over black;
 * grey counts as a colour. Pixels that are not finite count as 0. */
#ifndef WEFT_DIFF_H
#define WEFT_DIFF_H

#include "weft/image.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Every metric's number is the mean of its map.
 *
 * RELMSE: (a - b)^2 / (b^2 + 1e-2), the mean of three channels, linear; b is the reference. 0 means equal.
 *
 * FLIP: what an eye sees when the two alternate, 0 (equal) to 1. Andersson, Nilsson, Akenine-Moeller,
 *   Oskarsson, Astroem, Fairchild, "FLIP: A Difference Evaluator for Alternating Images", 2020. Of two linear
 *   pictures each pixel's largest FLIP over a range of exposures: Andersson, Nilsson, Shirley,
 *   Akenine-Moeller, "Visualizing Errors in Rendered High Dynamic Range Images", 2021.
 *
 * SSIM: similarity of brightness, contrast and structure in windows about a pixel, -1 to 1 (equal), computed on the
 *   luma of the displayed image. Wang, Bovik, Sheikh, Simoncelli, "Image Quality Assessment: From Error
 *   Visibility to Structural Similarity", 2004. The mean is over the windows that lie inside the picture. */
typedef enum WeftMetric {
    WEFT_METRIC_RELMSE = 0,
    WEFT_METRIC_FLIP = 1,
    WEFT_METRIC_SSIM = 2,
    WEFT_METRIC_COUNT
} WeftMetric;

/* Returns "relmse", "flip" or "ssim". */
WEFT_API const char *weft_metric_name(WeftMetric metric);

/* Describes a comparison. Zero-initialise for the defaults. */
typedef struct WeftDiffDesc {
    const WeftImage *image, *reference; /* of one size */
    WeftMetric metric;                  /* what is measured */
    /* flip: of the viewer's sight, 1 .. 500; 0: 67, a 0.7 m wide 4K screen at 0.7 m */
    float pixels_per_degree;
    WeftTonemap tonemap; /* of linear pictures, where they must be displayed */
    float exposure;      /* stops, before the tone mapping */
    int exposed;         /* flip: not 0: two linear pictures are compared at this exposure, not over a range */
    int threads;         /* 0: as many as there are processors; no influence on the result */
} WeftDiffDesc;

/* The differences of two images. */
typedef struct WeftDiff {
    double value;                      /* the metric */
    float worst;                       /* the largest value of the map; for ssim the least */
    int worst_x, worst_y;              /* the first pixel with that value */
    float high;                        /* 99 of 100 pixels are no worse */
    int exposures;                     /* number of exposures in flip of two linear pictures, else 0 */
    float exposure_low, exposure_high; /* range of these, stops */
} WeftDiff;

/* Compares two images. map (may be NULL) receives the metric of every pixel, F32 of one channel and that size. Fails
 * with WEFT_MESSAGE_DESC or _MEMORY; *map is then zero. */
WEFT_API WeftResult weft_diff(const WeftDiffDesc *desc, WeftDiff *out, WeftImage *map, WeftError *error);

/* Returns the fraction of a map's pixels, 0 .. 1, that are worse than limit: above it, for ssim below it. The map
 * is that of weft_diff. */
WEFT_API double weft_diff_beyond(const WeftImage *map, WeftMetric metric, double limit);

#ifdef __cplusplus
}
#endif

#endif
