/* oidn.h - Intel's Open Image Denoise, where it is installed: found at run time, never linked */
#ifndef WEFT_IMAGE_OIDN_H
#define WEFT_IMAGE_OIDN_H

#include "weft/result.h"

/* Linear pictures of three channels each. */
typedef struct OidnPicture {
    int width, height;
    float *color; /* denoised in place */
    float *albedo, *normal;
} OidnPicture;

/* Fails with WEFT_MESSAGE_DENOISER where the library is not there. */
WeftResult oidn_check(WeftError *error);

/* Fails with WEFT_MESSAGE_DENOISER where the library is not there, or complains. */
WeftResult oidn_denoise(const OidnPicture *picture, int threads, WeftError *error);

#endif
