/* weft_cloth.h - a draft woven of yarns, ready to be looked at point by point */
#ifndef WEFT_WEAVE_WEFT_CLOTH_H
#define WEFT_WEAVE_WEFT_CLOTH_H

#include "shading/weave_point.h"
#include "weft/weave.h"

struct WeftCloth {
    Weave weave; /* with the two tables below */
    float *runs, *albedos;
    WeftYarn yarns[2];
    char *text;       /* JSON: the weave of the material that it came from; NULL: of none */
    WeftDraft *draft; /* owned; NULL: the text has all of its words */
    char *path;       /* of the draft's file, absolute; NULL: it is in none */
    double size[2];   /* of the repeat, metres */
    float per_uv[2];  /* threads of warp and weft in one unit of texture coordinates */
};

/* Sets how many metres a unit of texture coordinates spans. */
void cloth_spread(WeftCloth *cloth, double metres);

/* Returns true if both came from the same text, and from the same draft where that is in a file. */
bool cloth_same(const WeftCloth *a, const WeftCloth *b);

#endif
