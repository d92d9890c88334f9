/* oidn.h - Intel's Open Image Denoise, where it is installed: found at run time, never linked */
#pragma once

#include "weft/result.h"

/* Linear pictures of three channels each. */
typedef struct OidnPicture {
    int width, height;
    float *color; /* denoised in place */
    float *albedo, *normal;
} OidnPicture;

/* Checks that the library can be loaded. Fails with WEFT_MESSAGE_DENOISER. */
WeftResult oidn_check(WeftError *error);

/* Denoises the colours in place. Fails with WEFT_MESSAGE_DENOISER if the library is not installed or reports an
 * error. */
WeftResult oidn_denoise(const OidnPicture *picture, int threads, WeftError *error);
