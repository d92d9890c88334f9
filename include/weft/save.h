/* save.h - writing what was made: a material as a small JSON, a scene as glTF */
#ifndef WEFT_SAVE_H
#define WEFT_SAVE_H

#include "weft/scene.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Writes material index as a material file (docs/materials.md): what is not at its default. Textures that
 * have no file of their own are written beside it as .png, by the name of the file and of the input; it names
 * textures by paths from its folder. weft_scene_assign_material of it gives the same material. Appears complete or not
 * at all. Fails with WEFT_MESSAGE_MATERIAL_NAME, _FILE_WRITE or _MEMORY. */
WEFT_API WeftResult weft_scene_save_material(const WeftScene *scene, int index, const char *path,
                                             WeftError *error);

/* Writes the scene as it is as .glb, or as .gltf beside which are a .bin and pictures: meshes in the world,
 * materials with the extensions KHR_materials_sheen, _clearcoat, _anisotropy, _specular, _ior,
 * _diffuse_transmission, _emissive_strength, _unlit, KHR_texture_transform and KHR_materials_variants where they say it, and in the
 * extras of a material, under "weft", what they do not; lights of KHR_lights_punctual, cameras. Read again it
 * gives the same picture. Environment and node hierarchy are not kept, and of a measurement only the numbers fitted
 * to it. Fails with WEFT_MESSAGE_SCENE_KIND (another suffix), _FILE_WRITE or _MEMORY. */
WEFT_API WeftResult weft_scene_save(const WeftScene *scene, const char *path, WeftError *error);

#ifdef __cplusplus
}
#endif

#endif
