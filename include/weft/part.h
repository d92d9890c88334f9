/* part.h - the parts of a picture or a reflection: the light of one lobe, or one property of a surface */
#ifndef WEFT_PART_H
#define WEFT_PART_H

#include "weft/version.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The content of an image: all light; one part of it, where the parts of a material's lobes sum up to all but
 * emission; or one property of the surface, as linear data. */
typedef enum WeftPart {
    WEFT_PART_ALL = 0,
    WEFT_PART_DIFFUSE,
    WEFT_PART_SPECULAR,
    WEFT_PART_SHEEN,
    WEFT_PART_COAT,
    WEFT_PART_DUST,
    WEFT_PART_BASE_COLOR,
    WEFT_PART_NORMAL,    /* in the world, (n + 1) / 2 */
    WEFT_PART_ROUGHNESS, /* of the base */
    WEFT_PART_SHEEN_COLOR,
    WEFT_PART_SHEEN_ROUGHNESS,
    WEFT_PART_TEXCOORD, /* UV set 0, less its whole part */
    WEFT_PART_COUNT
} WeftPart;

/* Returns "all", "diffuse" and so on; NULL out of range. */
WEFT_API const char *weft_part_name(int part);

#ifdef __cplusplus
}
#endif

#endif
