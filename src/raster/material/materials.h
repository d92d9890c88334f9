/* materials.h - a scene's materials as shader keys, uniforms and tables
 *
 * All calls are for the context that is current. */
#ifndef WEFT_RASTER_MATERIALS_H
#define WEFT_RASTER_MATERIALS_H

#include "raster/material/cloths.h"
#include "raster/material/shader.h"
#include "raster/material/textures.h"
#include "scene/light/sheen_tables.h"

/* The table of a slot that is baked in the uniforms, or was when the slot last asked for one. */
typedef struct MaterialFit {
    bool made, by_azimuth; /* as AmbientFit has it */
    bool dense;            /* true if the fit's `denser` exceeds AMBIENT_DENSER */
    float finest;          /* as AmbientFit has it */
    Lobe lobe;
} MaterialFit;

typedef struct GlMaterial {
    ShaderKey key;
    int groups[TEXTURE_SLOTS]; /* of textures, bound to the samplers in this order */
    int group_count;
    bool used;                /* by some mesh */
    bool emits;               /* light */
    int cloth;                /* of the scene, counted from 1; 0: none */
    float finest[SLOT_COUNT]; /* of the tables that are baked, or a finer one's; 0 where none is */
    MaterialFit fits[SLOT_COUNT];
} GlMaterial;

typedef struct GlMaterials {
    GlMaterial *all; /* one a material of the scene */
    int count;
    unsigned uniforms; /* buffer of one block a material, `stride` bytes apart */
    int stride;
    unsigned char *blocks; /* what is in it, once it is uploaded */
    bool uploaded;
    int *of_mesh; /* the material of each mesh, of which there are so many */
    int mesh_count;
    SheenTables *sheens; /* what programs read behind their own tables */
    GlCloths cloths;
} GlMaterials;

/* Zero on failure: WEFT_MESSAGE_MEMORY or _GL_MEMORY. */
WeftResult materials_create(const WeftScene *scene, const GlTextures *textures, int threads, GlMaterials *out,
                            WeftError *error);

/* The changes that an update has found. */
typedef struct MaterialsChange {
    bool tables;   /* the sheens' are others */
    bool coverage; /* light may pass where it did not, or the other way round */
    bool emission; /* what sends out light is another, or does it otherwise */
} MaterialsChange;

/* Takes the materials as they are now, of which only lights' may come and go; textures must serve them. What
 * is the same is neither fitted nor uploaded again. Fails as materials_create does; the materials are then as
 * they were.
 */
WeftResult materials_update(GlMaterials *materials, const WeftScene *scene, const GlTextures *textures,
                            int threads, MaterialsChange *change, WeftError *error);

void materials_destroy(GlMaterials *materials);

/* Sets the part of a key that depends on the environment's lights; env_light_kappa is log2 of their kappa. */
void material_in_light(const GlMaterial *material, float env_light_kappa, ShaderKey *key);

/* Binds a material's uniforms to block `block` and its textures to units from 0 on. */
void materials_bind(const GlMaterials *materials, const GlTextures *textures, int material, int block);

#endif
