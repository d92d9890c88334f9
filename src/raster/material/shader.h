/* shader.h - the text of a shader for a material, from the catalogue
 *
 * The text contains a material's lobes and the way its inputs are read; its numbers are uniforms. One key, one
 * program. */
#pragma once

#include "raster/material/fits.h"
#include "scene/record/scene.h"
#include "shading/lobe/table.h"
#include "shading/material/material_stack.h"
#include "text/assemble/text.h"

/* The way a shader reads an input. Numbers that disable a part are constants in the text, so that the part is
 * removed. */
typedef enum InputState {
    INPUT_VALUE,
    INPUT_ZERO,
    INPUT_ONE,
    INPUT_MAP,
    INPUT_MAYBE /* a map of some of the materials that share the program: those whose uniform has w = 1 */
} InputState;

typedef struct ShaderInput {
    int16_t state;
    int16_t slot, channel, texcoord; /* of a map: sampler, channel of a number, UV set */
    int16_t like;                    /* earlier input that reads the same texel, or -1 */
    int16_t slopes;                  /* of a normal map: sampler of its slopes (slopes.h), from 1; 0: none */
} ShaderInput;

/* Up to so many punctual lights are unrolled in the text, which is fastest. There are no more polygons. */
enum { SHADER_LIGHTS = 8 };

/* Compared byte by byte: zero-initialise. */
typedef struct ShaderKey {
    Choices choices;
    ShaderInput inputs[INPUT_COUNT];
    int depth;     /* 1: only coverage, for shadow maps */
    int coarse;    /* 1: a shading point of a moving picture (glsl/coarse_guide.glsl) */
    int resolve;   /* 1: coverage, and light of a moving picture's shading points (glsl/resolve.glsl) */
    int floor;     /* 1: no material, but the floor under the scene */
    int reference; /* 1: a frame of a sum (glsl/reference.glsl); 2: with two factors on light of the environment */
    int bounces;   /* 1: of which light bounces once (glsl/bounce.glsl) */
    int panes;     /* 1: whose rays pass panes (raster/light/ray_panes.h) */
    int shadowed;  /* 1: with shadow maps */
    int lights;    /* number of punctual lights; kind and shadow map, or -1, of each up to SHADER_LIGHTS */
    int16_t light_kind[SHADER_LIGHTS], light_map[SHADER_LIGHTS];
    int focus, narrow, by_azimuth; /* bit k: those of AmbientTable for slot k, whose table is baked */
    int dense;                     /* bit k: the lobe of slot k, whose table is baked, exceeds AMBIENT_DENSER */
    int ranged;                    /* 1: no table is baked, since there are too many materials to fit one for each */
    int ambient;  /* 0: no light from the environment; 1: each lobe's best strategy; else a strategy plus 2 */
    int polygons; /* number of polygon lights; then the corners of each, whether both sides emit, and the shadow map */
    int16_t polygon_corners[SHADER_LIGHTS], polygon_two_sided[SHADER_LIGHTS], polygon_map[SHADER_LIGHTS];
    int part; /* WeftPart */
    int alpha_mode, unlit, double_sided, colored;
    int haired; /* 1: hair stands on its front */
    int hairy;  /* 1: fibres of hair, widened to a pixel and blended (glsl/vertex.glsl) */
    int woven;  /* 1: a cloth is in the place of the base */
    int table_kind, table_rows, table_columns, table_tilts; /* of the sheen's E */
} ShaderKey;

enum {
    FIT_VECTORS = AMBIENT_BAKED * SLOT_COUNT,
    SHADER_CLOTH_SKY =
        AMBIENT_BAKED * PLACE_SPECULAR /* a woven material has the numbers of cloth_sky.h in place of a table */
};
typedef float MaterialVector[4];

/* Lists the uniform block "Material" behind a vector for each input (w: 1 where it has a map; y: of a normal map,
 * textures_slopes_level): the type in C of a vector of four, name, number of vectors. */
#define MATERIAL_BLOCK(M)                                                                                              \
    M(MaterialVector, places,                                                                                          \
      2 * INPUT_COUNT)         /* of each input: rows of its transform; layers of its map and slopes */                \
    M(MaterialVector, e, 1)    /* of the sheen's E: layer, low, high, tilt */                                          \
    M(MaterialVector, more, 1) /* alpha cutoff; part of the light that comes through its hair */                       \
    M(MaterialVector, weave, CLOTH_NUMBERS / 4)                                                                        \
    M(AmbientWeights, fits, FIT_VECTORS) /* shading/ambient/ambient.h */

/* Makes *key a key that serves both: inputs that differ become INPUT_VALUE or INPUT_MAYBE, with `slot` and `like` left
 * to the caller. Returns false, with *key unchanged, if the text would then contain a part that one of the two
 * omits. */
bool shader_join(ShaderKey *key, const ShaderKey *other);

/* Returns true if two inputs without a map read the same value in place of a texel. */
bool shader_same_neutral(int input, int other);

/* Begins text and writes the fragment shader, which the caller ends and frees. weft_tables must contain the text's
 * tables and then those of the scene's sheens. fits must live until the text's tables are uploaded. */
void shader_text(const ShaderKey *key, const TextDesc *desc, Fits *fits, Text *text);

/* Returns true if the environment table of a slot's lobe is baked (shading/ambient/ambient.h), which needs a constant
 * first parameter. Its polynomials are then material_fits from slot times AMBIENT_BAKED on. Departure: other textured
 * parameters, nap and anisotropy enter it with half of their number; a table that is not baked leaves them out. `focus`
 * is not read. */
bool shader_bakes(const ShaderKey *key, int slot);

/* Begins both texts and writes the shaders that draw the environment behind the scene. */
void shader_background_text(const TextDesc *desc, Text *vertex, Text *fragment);

/* Begins text and writes the vertex shader, which the caller ends and frees. */
void shader_vertex_text(const ShaderKey *key, const TextDesc *desc, Text *text);
