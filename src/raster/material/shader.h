/* shader.h - the text of a shader for a material, from the catalogue
 *
 * What a material is made from is in the text, its numbers are uniforms: one key, one program. */
#ifndef WEFT_RASTER_SHADER_H
#define WEFT_RASTER_SHADER_H

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
    INPUT_MAYBE /* a map of some of the materials that share the program: those that say so in w */
} InputState;

typedef struct ShaderInput {
    int16_t state;
    int16_t slot, channel, texcoord; /* of a map: sampler, channel of a number, UV set */
    int16_t like;                    /* the earlier input whose texel this is, or -1 */
} ShaderInput;

/* Up to so many punctual lights are written out one by one, which is the fastest way to light by them. There are no more
 * polygons. */
enum { SHADER_LIGHTS = 8 };

/* Compared byte by byte: zero-initialise. */
typedef struct ShaderKey {
    Choices choices;
    ShaderInput inputs[INPUT_COUNT];
    int depth;    /* only where the surface is: for shadow maps */
    int floor;    /* no material: the floor under the scene */
    int shadowed; /* by shadow maps */
    int lights;   /* punctual; their kind and shadow map, or -1, where there are few */
    int16_t light_kind[SHADER_LIGHTS], light_map[SHADER_LIGHTS];
    int focus, narrow, turning; /* bit k: those of AmbientTable for slot k, whose table is baked */
    int dense;                  /* bit k: so is the lobe of slot k, by AMBIENT_DENSER, whose table is baked */
    int ranged;                 /* no table is baked: there are too many materials to fit one for each */
    int ambient;  /* 0: no light from the environment; 1: by each lobe's best strategy; else it less 2 */
    int polygons; /* and the corners of each, whether both sides shine, and the shadow map */
    int16_t polygon_corners[SHADER_LIGHTS], polygon_two_sided[SHADER_LIGHTS], polygon_map[SHADER_LIGHTS];
    int part; /* WeftPart */
    int alpha_mode, unlit, double_sided, colored;
    int woven;                                              /* of a cloth, in the place of a base */
    int table_kind, table_rows, table_columns, table_tilts; /* of the sheen's E */
} ShaderKey;

/* Makes a key that does for both: inputs that differ become numbers or maybe maps, their `slot` and `like`
 * left for the caller. False, and *key as it was, where the text would then hold what one of the two leaves
 * out. */
bool shader_join(ShaderKey *key, const ShaderKey *other);

/* Returns true if two inputs without a map read the same value in place of a texel. */
bool shader_same_rest(int input, int other);

/* Puts the fragment shader into text, which the caller ends and frees. Behind the tables that the text names,
 * weft_tables is to hold those of the scene's sheens. fits must outlive what the text's tables are uploaded
 * to. */
void shader_text(const ShaderKey *key, const TextDesc *desc, Fits *fits, Text *text);

/* Returns true if the environment table of a slot's lobe is baked (shading/ambient/ambient.h), which needs a constant
 * first parameter. Its polynomials are then material_fits from slot times AMBIENT_BAKED on. Departure: what
 * textures make of the other parameters, of nap and anisotropy, is not known to it, which takes half of their
 * number; a table that is not baked takes none. `focus` is not read. */
bool shader_holds(const ShaderKey *key, int slot);

/* Makes the shaders that draw the environment behind everything. */
void shader_background_text(const TextDesc *desc, Text *vertex, Text *fragment);

/* The vertex shader likewise. */
void shader_vertex_text(const ShaderKey *key, const TextDesc *desc, Text *text);

#endif
