/* kind.h - vertices of paths shaded many at once, for materials whose stack has a structure fixed at compile time
 *
 * A kind is a row of kinds.list: the lobe that each slot may have, the layer rule, the interface rule, the source of
 * E. Its loops are the text of stacks (stack_value.h) compiled with these as constants, one vertex in each lane: the
 * arithmetic is that of material_stack.h but for the last bits. */
#pragma once

#include "shading/material/material_stack.h"
#include "shading/stack/surface_rows.h"

/* Points of threads, or facets of them from afar: the parameters of lobe yarn, and the colours of single and of
 * multiple scattering. */
typedef struct YarnRows {
    float params[LOBE_PARAMS_MAX][ROW_CAPACITY]; /* of lobe yarn */
    float single[3][ROW_CAPACITY];               /* colour of light that met one fibre, */
    float multiple[3][ROW_CAPACITY];             /* and of all other light */
} YarnRows;

enum { KIND_LIGHTS = 3, KIND_DRAWN = KIND_LIGHTS, KIND_DIRECTIONS };

/* Vertices of surfaces in the shading frame; each wi is unit, in [KIND_DRAWN] the one that is sampled. */
typedef struct KindVertices {
    SurfaceRows surface;
    YarnRows yarn;            /* the bases, where they are woven */
    float o[3][ROW_CAPACITY]; /* wo, z > 0 */
    float u[ROW_CAPACITY], v[ROW_CAPACITY];
    float i[KIND_DIRECTIONS][3][ROW_CAPACITY];
    float f[KIND_DIRECTIONS][3][ROW_CAPACITY], pdf[KIND_DIRECTIONS][ROW_CAPACITY];   /* f cos and pdf; 0 below */
    float e_o[ROW_CAPACITY], base_scale[3][ROW_CAPACITY], select_p[5][ROW_CAPACITY]; /* of the StackView */
} KindVertices;

/* Returns the base lobe of a woven vertex. */
FN Lobe yarn_of_row(const YarnRows *rows, size_t k) {
    Lobe lobe;
    lobe.id = LOBE_YARN;
    ROUNDS(p, LOBE_PARAMS_MAX) lobe.params[p] = rows->params[p][k];
    return lobe;
}

typedef struct StackKind StackKind;

/* Returns the kind of a material, or NULL if none has its structure. untextured: the stack of the material if all its
 * textures are 1, which is their maximum. */
const StackKind *stack_kind(const Stack *untextured, const Choices *choices);

/* Samples wi for the first n vertices, n a multiple of ROW_LANES, and gives f cos and pdf of it and of the
 * directions [k] with lights[k]. e: as for stack_make. */
void kind_shade(const StackKind *kind, KindVertices *vertices, TableRef e, const bool lights[KIND_LIGHTS], int n);
