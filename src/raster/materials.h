/* materials.h - a scene's materials as shader keys, uniforms and tables
 *
 * All calls are for the context that is current. */
#ifndef WEFT_RASTER_MATERIALS_H
#define WEFT_RASTER_MATERIALS_H

#include "raster/shader.h"
#include "raster/textures.h"
#include "scene/sheen_tables.h"

typedef struct GlMaterial {
    ShaderKey key;
    int groups[TEXTURE_SLOTS]; /* of textures, bound to the samplers in this order */
    int group_count;
    bool worn;                  /* by some mesh */
    float finest[SHADER_SLOTS]; /* AmbientFit.finest where a table is held, else 0 */
} GlMaterial;

typedef struct GlMaterials {
    GlMaterial *all; /* one a material of the scene */
    int count;
    unsigned uniforms; /* buffer of one block a material, `stride` bytes apart */
    int stride;
    SheenTables *sheens; /* what programs read behind their own tables */
} GlMaterials;

/* Zero on failure: WEFT_MESSAGE_MEMORY or _GL_MEMORY. */
WeftResult materials_create(const WeftScene *scene, const GlTextures *textures, int threads, GlMaterials *out,
                            WeftError *error);
void materials_destroy(GlMaterials *materials);

/* What of a key depends on the environment's lamps: log2 of their kappa. */
void material_in_light(const GlMaterial *material, float lamp_kappa, ShaderKey *key);

/* Binds a material's uniforms to block `block` and its textures to units from 0 on. */
void materials_bind(const GlMaterials *materials, const GlTextures *textures, int material, int block);

#endif
