/* materials.h - a scene's materials as shader keys, uniforms and tables
 *
 * All calls are for the context that is current. */
#pragma once

#include "raster/material/cloths.h"
#include "raster/material/shader.h"
#include "raster/material/textures.h"
#include "scene/light/sheen_tables.h"

/* The baked table of a slot, or the last one that the slot needed. */
typedef struct MaterialFit {
    bool made, by_azimuth; /* as AmbientFit has it */
    bool dense;            /* true if the fit's `denser` exceeds AMBIENT_DENSER */
    float finest;          /* as AmbientFit has it */
    Lobe lobe;
    int cloth; /* number of the cloth that the table is of; 0: it is of the lobe */
} MaterialFit;

typedef struct GlMaterial {
    ShaderKey key;
    int groups[TEXTURE_SLOTS]; /* of textures, bound to the samplers in this order */
    int group_count;
    bool used;                /* by some mesh */
    bool emits;               /* true if it emits light */
    bool pane;                /* light goes straight on through it (scene/light/pane.h) */
    bool clear;               /* a pane that lets through more than half of light wherever it is met */
    int cloth;                /* number of the scene's cloth, from 1, below 0 its other face; 0: none */
    float finest[SLOT_COUNT]; /* AmbientFit.finest of baked tables, the greatest of the family; 0 without a table */
    MaterialFit fits[SLOT_COUNT];
} GlMaterial;

typedef struct GlMaterials {
    GlMaterial *all; /* one a material of the scene */
    int count;
    bool panes;        /* a mesh has one that is a pane */
    unsigned uniforms; /* buffer of one block a material, `stride` bytes apart */
    int stride;
    unsigned char *blocks; /* contents of the buffer, if uploaded */
    bool uploaded;
    int *of_mesh; /* material of each of mesh_count meshes */
    int mesh_count;
    SheenTables *sheens; /* programs read them behind their own tables */
    GlCloths cloths;
} GlMaterials;

/* Uploads a scene's materials. Fails with WEFT_MESSAGE_MEMORY or _GL_MEMORY; *out is then zero. */
WeftResult materials_create(const WeftScene *scene, const GlTextures *textures, int threads, GlMaterials *out,
                            WeftError *error);

/* The changes that an update has found. */
typedef struct MaterialsChange {
    bool tables;   /* tables of sheens */
    bool coverage; /* where light passes through meshes */
    bool emission; /* what emits light, or how */
} MaterialsChange;

/* Uploads changed materials; only those of lights may be added or removed, and textures_serve must be true. Unchanged
 * tables and blocks are neither fitted nor uploaded again. Fails as materials_create does; the materials are then as
 * they were. */
WeftResult materials_update(GlMaterials *materials, const WeftScene *scene, const GlTextures *textures, int threads,
                            MaterialsChange *change, WeftError *error);

void materials_destroy(GlMaterials *materials);

/* Sets the members of a key that depend on the environment's lights; env_light_kappa is log2 of their kappa. */
void material_in_light(const GlMaterial *material, float env_light_kappa, ShaderKey *key);

/* Binds a material's uniforms to block `block` and its textures to units from 0 on. */
void materials_bind(const GlMaterials *materials, const GlTextures *textures, int material, int block);
