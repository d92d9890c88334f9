/* sheet.h - pictures side by side on one labelled sheet, and pictures of how two of them differ */
#ifndef WEFT_SHEET_H
#define WEFT_SHEET_H

#include "weft/image.h"

#ifdef __cplusplus
extern "C" {
#endif

/* One place of a sheet. Texts are UTF-8, one line, and may be NULL; what is too long ends in an ellipsis. */
typedef struct WeftPanel {
    const WeftImage *image;   /* U8, 3 or 4 channels, shown pixel for pixel; NULL: none */
    const char *title, *note; /* below it: what it shows, and figures */
    float scale;              /* > 0 and no image: the colours of weft_difference_image of this scale */
    float none, most;         /* of an image of weft_heat_image: its colours below it; the same: not that */
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

/* Composes the sheet: U8 RGB. Where an image has alpha it lies over the sheet's dark grey. Fails with
 * WEFT_MESSAGE_DESC or _MEMORY. */
WEFT_API WeftResult weft_sheet_compose(const WeftSheetDesc *desc, WeftImage *out, WeftError *error);

/* The difference of an image from a reference. Both F32 RGBA or RGB of one size; colours count times their
 * alpha. */
typedef struct WeftDifference {
    double mean;   /* of |difference| over pixels and colour channels */
    double relmse; /* mean of difference^2 / (reference^2 + 1e-2) over the same */
    float high;    /* 99 of 100 pixels differ by no more in any channel */
} WeftDifference;

/* Fails with WEFT_MESSAGE_DESC or _MEMORY. */
WEFT_API WeftResult weft_difference(const WeftImage *image, const WeftImage *reference, WeftDifference *out,
                                    WeftError *error);

/* The greatest difference among a pixel's channels as a colour, U8 RGB: black where there is none, through
 * red to yellow where the image is brighter, through blue to pale cyan where it is darker; the ends are at
 * scale (> 0) and beyond. */
WEFT_API WeftResult weft_difference_image(const WeftImage *image, const WeftImage *reference, float scale,
                                          WeftImage *out, WeftError *error);

/* A map of one channel, F32, in the colours of what is brighter above, U8 RGB: black at `none`, through red
 * to yellow at `most` (below or above `none`) and beyond. Fails with WEFT_MESSAGE_DESC or _MEMORY. */
WEFT_API WeftResult weft_heat_image(const WeftImage *map, float none, float most, WeftImage *out,
                                    WeftError *error);

#ifdef __cplusplus
}
#endif

#endif
