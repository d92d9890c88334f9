/* sheet.h - pictures side by side on one labelled sheet, and difference images of two of them */
#ifndef WEFT_SHEET_H
#define WEFT_SHEET_H

#include "weft/image.h"

#ifdef __cplusplus
extern "C" {
#endif

/* One place of a sheet. Texts are UTF-8, one line, and may be NULL; a text that is too long ends in an ellipsis. */
typedef struct WeftPanel {
    const WeftImage *image;   /* U8, 3 or 4 channels, shown pixel for pixel; NULL: none */
    const char *title, *note; /* below it: a title, and figures */
    float scale;              /* > 0 and no image: a legend of weft_difference_image with this scale */
    float none, most;         /* not equal: a legend of weft_heat_image with this range, below its image */
} WeftPanel;

/* The most places of a sheet. */
enum { WEFT_SHEET_PANELS_MAX = 256 };

/* A sheet. */
typedef struct WeftSheetDesc {
    const char *caption;     /* above everything; may be NULL */
    const WeftPanel *panels; /* row after row */
    int count;               /* 1 .. WEFT_SHEET_PANELS_MAX */
    int columns;             /* 1 .. count */
} WeftSheetDesc;

/* Composes the sheet: U8 RGB. Images with alpha are blended over the sheet's dark grey. Fails with WEFT_MESSAGE_DESC
 * or _MEMORY. */
WEFT_API WeftResult weft_sheet_compose(const WeftSheetDesc *desc, WeftImage *out, WeftError *error);

/* The difference of an image from a reference. */
typedef struct WeftDifference {
    double mean;   /* of |difference| over pixels and colour channels */
    double relmse; /* mean of difference^2 / (reference^2 + 1e-2) over the same */
    float high;    /* 99 of 100 pixels differ by no more in any channel */
} WeftDifference;

/* Measures the difference of an image from a reference, both F32 RGBA or RGB of one size; colours are multiplied by
 * their alpha. Fails with WEFT_MESSAGE_DESC or _MEMORY. */
WEFT_API WeftResult weft_difference(const WeftImage *image, const WeftImage *reference, WeftDifference *out,
                                    WeftError *error);

/* Draws the greatest difference among a pixel's channels as a colour, U8 RGB: black where there is none, through red to
 * yellow where the image is brighter, through blue to pale cyan where it is darker. The last colours are at scale (> 0)
 * and beyond. */
WEFT_API WeftResult weft_difference_image(const WeftImage *image, const WeftImage *reference, float scale,
                                          WeftImage *out, WeftError *error);

/* Draws a map of one channel, F32, as U8 RGB: black at `none`, through red to yellow at `most` (below or above `none`)
 * and beyond. Fails with WEFT_MESSAGE_DESC or _MEMORY. */
WEFT_API WeftResult weft_heat_image(const WeftImage *map, float none, float most, WeftImage *out, WeftError *error);

#ifdef __cplusplus
}
#endif

#endif
