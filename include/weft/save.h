/* save.h - saving a material as a small JSON file, as MaterialX or as U3M, and a scene as glTF */
#ifndef WEFT_SAVE_H
#define WEFT_SAVE_H

#include "weft/scene.h"
#include "weft/weave.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Writes the inputs of material index that are not at their defaults as a material file (docs/materials.md). Textures
 * without a file of their own are written beside it as .png, named after the file and the input; the file refers to
 * textures by paths from its folder. weft_scene_assign_material of the file gives the same material. The file appears
 * complete or not at all. Fails with WEFT_MESSAGE_MATERIAL_NAME, _FILE_WRITE or _MEMORY. */
WEFT_API WeftResult weft_scene_save_material(const WeftScene *scene, int index, const char *path, WeftError *error);

/* The surface nodes of MaterialX 1.39 that a material can be written as. */
typedef enum WeftMtlxNode {
    WEFT_MTLX_OPEN_PBR = 0, /* open_pbr_surface, whose rim is fuzz: sheen_bsdf of mode zeltner */
    WEFT_MTLX_GLTF,         /* gltf_pbr, whose rim is sheen: sheen_bsdf of mode conty_kulla */
    WEFT_MTLX_STANDARD,     /* standard_surface, with the same sheen and another unit of roughness */
    WEFT_MTLX_NODES
} WeftMtlxNode;

/* Returns "open_pbr_surface", "gltf_pbr" or "standard_surface"; NULL past the end. */
WEFT_API const char *weft_mtlx_node_name(int node);

/* Writes material index as a MaterialX document, .mtlx: one surface node with a graph of its textures, which lie as
 * weft_scene_save_material leaves them. A line of log (may be NULL) says each part that the node cannot express: threads,
 * nap, lobes. Fails as weft_scene_save_material. */
WEFT_API WeftResult weft_scene_save_mtlx(const WeftScene *scene, int index, const char *path, WeftMtlxNode node,
                                         const WeftLog *log, WeftError *error);

/* A draft and its yarns, by which a U3M tells the construction and composition of a cloth. */
typedef struct WeftTextile {
    const WeftDraft *draft; /* borrowed */
    const char *yarns[2];   /* of warp and weft, by the names of weft_yarn_name */
    double metres;          /* width of a unit of texture coordinates; 0: as the mesh has it */
} WeftTextile;

/* Writes material index in the textile industry's format U3M (Vizoo and Browzwear, schema 1.1; docs/u3m.md): a .u3m with
 * its pictures beside it in the folder textures, or a .u3ma with all of them, by the suffix of path. Of a material that
 * was read from a U3M each member that has not changed is written byte for byte, also what weft does not understand, and
 * every file of an archive stays. A material that is not of workflow disney is written in the parameters of that. textile
 * (may be NULL) fills in the physics of a file that has none; where it is NULL the material's own cloth does. log (may be
 * NULL) receives a warning for each thing that U3M cannot say. Fails with WEFT_MESSAGE_MATERIAL_NAME, _OUTPUT_SUFFIX,
 * _FILE_OPEN and _MATERIAL_FILE (the pictures of the U3M that was read), _FILE_WRITE or _MEMORY. */
WEFT_API WeftResult weft_scene_save_u3m(const WeftScene *scene, int index, const char *path, const WeftTextile *textile,
                                        const WeftLog *log, WeftError *error);

/* Writes the scene as it is as .glb, or as .gltf with a .bin and images beside it: meshes in world space; materials
 * with the extensions KHR_materials_sheen, _clearcoat, _anisotropy, _specular, _ior, _diffuse_transmission,
 * _emissive_strength, _unlit, KHR_texture_transform and KHR_materials_variants, and in the extras of a material, under
 * "weft", what these cannot express; lights of KHR_lights_punctual; cameras. The file renders the same picture.
 * Environment and node hierarchy are lost, and of a measurement only the numbers fitted to it are kept. Fails with
 * WEFT_MESSAGE_SCENE_KIND (another suffix), _FILE_WRITE or _MEMORY. */
WEFT_API WeftResult weft_scene_save(const WeftScene *scene, const char *path, WeftError *error);

#ifdef __cplusplus
}
#endif

#endif
