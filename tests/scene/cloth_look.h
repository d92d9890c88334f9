/* cloth_look.h - a look at one place of a woven cloth, for tests: the product looks at many at once */
#ifndef WEFT_TEST_SCENE_CLOTH_LOOK_H
#define WEFT_TEST_SCENE_CLOTH_LOOK_H

#include "scene/cloth_base.h"

/* The fields are those of ClothLooks, for one place. */
typedef struct ClothLook {
    float uv[2];
    WeaveFootprint footprint;
    float level, facet;
} ClothLook;

/* Puts into the place of the stack's base what is there. */
static inline void cloth_base(const WeftCloth *cloth, const ClothLook *look, Stack *stack) {
    static ClothLooks looks;
    static YarnRows yarn;
    looks.uv[0][0] = look->uv[0], looks.uv[1][0] = look->uv[1];
    looks.footprint_x[0] = look->footprint.x;
    looks.footprint_y[0] = look->footprint.y;
    looks.longest[0] = look->footprint.longest;
    looks.level[0] = look->level, looks.facet[0] = look->facet;
    cloth_bases(cloth, &looks, 1, &yarn);
    const Lobe lobe = yarn_of_row(&yarn, 0);
    stack_put_base(stack, &lobe, ROW_RGB(yarn.once, 0), ROW_RGB(yarn.again, 0));
}

#endif
