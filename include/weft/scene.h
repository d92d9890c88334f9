/* scene.h - a scene to render: loaded from a file or built in, with materials and lights
 *
 * World space is right-handed, +y up, metres. A WeftScene may be read by several renders at once; the calls
 * that change it must not run beside anything else on the same scene. */
#ifndef WEFT_SCENE_PUBLIC_H
#define WEFT_SCENE_PUBLIC_H

#include <stddef.h>
#include <stdint.h>

#include "weft/progress.h"
#include "weft/result.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Meshes, materials, lights, cameras and an environment. */
typedef struct WeftScene WeftScene;

/* Loads path: a .gltf or .glb file, "builtin:NAME", or a material .u3m or .u3ma, which builtin:cloth then has. log (may
 * be NULL) receives warnings. On success *out is owned by the caller: release it with weft_scene_free. */
WEFT_API WeftResult weft_scene_load(const char *path, WeftScene **out, const WeftLog *log, WeftError *error);

/* Works as weft_scene_load, with progress (may be NULL), which can stop it: WEFT_INTERRUPTED. */
WEFT_API WeftResult weft_scene_load_watched(const char *path, WeftProgress progress, void *user, WeftScene **out,
                                            const WeftLog *log, WeftError *error);

/* A moment of an animation of a file. */
typedef struct WeftMoment {
    const char *animation; /* the name of the animation, or its index in digits; NULL: the first */
    double time;           /* seconds; before the first key of a value and after its last one it stands still */
} WeftMoment;

/* Works as weft_scene_load_watched, and shows a moment of an animation: what moves nodes, morph targets and, by
 * KHR_animation_pointer, other numbers. moment may be NULL: the file at rest. Fails with WEFT_MESSAGE_GLTF_REFERENCE
 * where the file has no such animation. */
WEFT_API WeftResult weft_scene_load_moment(const char *path, const WeftMoment *moment, WeftProgress progress,
                                           void *user, WeftScene **out, const WeftLog *log, WeftError *error);

/* Works as weft_scene_load, from size bytes of a .glb, or of a .gltf that refers to no other file. */
WEFT_API WeftResult weft_scene_load_memory(const void *data, size_t size, const char *name, WeftScene **out,
                                           const WeftLog *log, WeftError *error);

WEFT_API void weft_scene_free(WeftScene *scene); /* may be NULL */

/* Returns the name of a built-in scene without "builtin:", and a line on what it shows; NULL past the end. */
WEFT_API const char *weft_builtin_name(int index);
WEFT_API const char *weft_builtin_help(int index);

/* The counts and extent of a scene. */
typedef struct WeftSceneInfo {
    /* indices of each run from 0 to one less */
    int mesh_count, material_count, light_count, camera_count, variant_count, image_count;
    long long triangle_count; /* of all meshes together */
    float low[3], high[3];    /* bounding box, m */
} WeftSceneInfo;

/* Returns the present counts and extent of a scene. */
WEFT_API WeftSceneInfo weft_scene_info(const WeftScene *scene);

/* Returns a hash of all that a picture of the scene depends on, as it is now: shapes, materials and their textures,
 * lights, environment and cameras. Equal scenes have equal hashes on every machine of one byte order. */
WEFT_API uint64_t weft_scene_hash(const WeftScene *scene);

/* Returns names by index; "" where the file gives none, NULL out of range. Owned by the scene. */
WEFT_API const char *weft_scene_material_name(const WeftScene *scene, int index);
WEFT_API const char *weft_scene_camera_name(const WeftScene *scene, int index);
WEFT_API const char *weft_scene_variant_name(const WeftScene *scene, int index);

/* Returns 1 if any surface has material index in the present variant, else 0. */
WEFT_API int weft_scene_material_used(const WeftScene *scene, int index);

/* Switches to a variant of KHR_materials_variants by name, NULL: to none. A surface that the variant does not list
 * has its material without a variant. Fails with WEFT_MESSAGE_VARIANT_NAME. */
WEFT_API WeftResult weft_scene_set_variant(WeftScene *scene, const char *name, WeftError *error);

/* Returns the index of the present variant; -1: none. */
WEFT_API int weft_scene_variant(const WeftScene *scene);

/* Sets "MATERIAL.INPUT" to a number or "r,g,b" and drops its texture (a normal map stays and is scaled), or a
 * choice such as "MATERIAL.layer" to an id or "auto"; MATERIAL is a name, an index or "*" for all. Values beyond the
 * plausible range are a warning and are clamped to the hard range; non-finite values are refused. */
WEFT_API WeftResult weft_scene_set(WeftScene *scene, const char *target, const char *value, const WeftLog *log,
                                   WeftError *error);

/* Replaces materials by that of a file (docs/materials.md) or of "preset:NAME". material is a name, an index, "*" for
 * all, or NULL for the cloth of the scene: materials that have a sheen or, where none has, all that do not emit. A
 * preset gives no warnings. Fails with WEFT_MESSAGE_MATERIAL_FILE, _MATERIAL_NAME, _PRESET_NAME and as reading a file
 * or an image does; the scene is then as it was. */
WEFT_API WeftResult weft_scene_assign_material(WeftScene *scene, const char *material, const char *path,
                                               const WeftLog *log, WeftError *error);

/* Works as weft_scene_assign_material, from size bytes of a material file that names no texture. Messages begin
 * with name. */
WEFT_API WeftResult weft_scene_assign_material_memory(WeftScene *scene, const char *material, const void *data,
                                                      size_t size, const char *name, const WeftLog *log,
                                                      WeftError *error);

/* Returns the name of a preset, the name of its group, a line on its appearance, and the text of its material file; NULL
 * past the end. */
WEFT_API const char *weft_preset_name(int index);
WEFT_API const char *weft_preset_group(int index);
WEFT_API const char *weft_preset_help(int index);
WEFT_API const char *weft_preset_text(int index);

/* Returns the name of a group of presets and what they have in common, in the order to show them; NULL past the end. */
WEFT_API const char *weft_preset_group_name(int index);
WEFT_API const char *weft_preset_group_help(int index);

/* Converts every material of workflow "metallic" to "specular", or the other way round. The conversion is done at each
 * shaded point, so that textures are converted as exactly as numbers. losses (may be NULL) has a number for each
 * material, which becomes the greatest change, over a grid of 256 x 256 points of its textures, of a channel of the
 * diffuse colour or of the reflectance at normal incidence; or, where the material stays as it is, -1 for another
 * workflow or a profile, -2 for the target workflow. */
WEFT_API WeftResult weft_scene_convert(WeftScene *scene, const char *workflow, float *losses, WeftError *error);

/* Returns the name, the help and the label of a slider of a material input that weft_scene_set takes, NULL past the end; and
 * the index of a name, or -1. */
WEFT_API const char *weft_material_input_name(int index);
WEFT_API const char *weft_material_input_help(int index);
WEFT_API const char *weft_material_input_label(int index);
WEFT_API int weft_material_input_find(const char *name);

/* Returns the choices of a material likewise, and the ids that a choice may take; NULL past the end. */
WEFT_API const char *weft_material_choice_name(int index);
WEFT_API int weft_material_choice_find(const char *name);
WEFT_API const char *weft_material_choice_help(int index);
WEFT_API const char *weft_material_choice_value(int index, int value);

/* Returns 1 if that choice may have this value, else 0: a diffuse term must be a diffuse lobe, a sheen may be any
 * lobe. */
WEFT_API int weft_material_choice_fits(int index, int value);

/* Lights the scene from an environment image (HDRI): a lat-long image file (columns run towards +x, row 0 is up), or
 * the six faces of a cube. path is then their folder or one of them; they are called posx negx posy negy posz negz or
 * px nx py ny pz nz in any case, are square, of one size, and oriented as in OpenGL. */
WEFT_API WeftResult weft_scene_set_environment_file(WeftScene *scene, const char *path, const WeftLog *log,
                                                    WeftError *error);

/* Lights the scene by uniform radiance from all directions. */
WEFT_API WeftResult weft_scene_set_environment_color(WeftScene *scene, const float color[3], WeftError *error);

/* Lights the scene by the studio, the default of a loaded scene. */
WEFT_API WeftResult weft_scene_set_environment_studio(WeftScene *scene, WeftError *error);

/* Rotates the environment about +y (degrees) and scales it. */
WEFT_API WeftResult weft_scene_set_environment_placement(WeftScene *scene, float rotation, float strength,
                                                         WeftError *error);

/* Scales the environment's light at its first reflection: `ambient` where the diffuse lobe and dust reflect it,
 * `reflection` where the specular, sheen and coat lobes do. The background and further bounces do not change. Both are
 * finite, >= 0, and 1 in a new scene; other values are not physical. For a raster or render this is a change of
 * lights. Fails with WEFT_MESSAGE_DESC, and nothing is changed. */
WEFT_API WeftResult weft_scene_set_environment_parts(WeftScene *scene, float ambient, float reflection,
                                                     WeftError *error);

/* The kinds of lights. */
typedef enum WeftLightKind {
    WEFT_LIGHT_DIRECTIONAL = 0,
    WEFT_LIGHT_POINT = 1,
    WEFT_LIGHT_SPOT = 2,
    WEFT_LIGHT_POLYGON = 3 /* flat, emits to one side */
} WeftLightKind;

/* A punctual light of KHR_lights_punctual (Khronos Group, 2018-2020) in radiometric units, or a polygon light. */
typedef struct WeftLight {
    WeftLightKind kind; /* selects the members below that are used */
    float position[3];  /* m; point, spot, middle of a polygon */
    float direction[3]; /* in which light travels, of any length but 0: directional, spot; normal of a polygon */
    float color[3];     /* >= 0: W/m^2 across the beam (directional), W/sr (point, spot), radiance (polygon) */
    float range;        /* m, distance beyond which there is no light; 0: unlimited */
    float inner, outer; /* spot: degrees from the axis, 0 <= inner <= outer <= 90; outer 0: 45 */
    float size[2];      /* polygon: m, along its two axes, > 0; the first one is horizontal */
    int corners;        /* polygon: 3 .. 8, on the ellipse that fills size; 4 is the rectangle; 0: 4 */
    float roll;         /* polygon: degrees about its normal, from horizontal */
} WeftLight;

/* Adds a light after those of the scene. Fails with WEFT_MESSAGE_DESC or _MEMORY. */
WEFT_API WeftResult weft_scene_add_light(WeftScene *scene, const WeftLight *light, WeftError *error);

/* Reads, replaces or removes a light by index, below WeftSceneInfo.light_count: first those of the file, then those
 * that were added. Meshes with an emissive material are not among them. All fail with WEFT_MESSAGE_DESC where there is
 * no such light; weft_scene_put_light fails as weft_scene_add_light does. */
WEFT_API WeftResult weft_scene_light(const WeftScene *scene, int index, WeftLight *out, WeftError *error);
WEFT_API WeftResult weft_scene_put_light(WeftScene *scene, int index, const WeftLight *light, WeftError *error);
WEFT_API WeftResult weft_scene_remove_light(WeftScene *scene, int index, WeftError *error);

/* A camera in numbers. */
typedef struct WeftCamera {
    float eye[3], target[3], up[3]; /* target: the point of its axis nearest to the middle of the scene */
    float fov;                      /* vertical, degrees; 0 of an orthographic camera */
} WeftCamera;

/* Makes the camera that the text (as WeftRenderDesc.camera) describes, for a picture of that aspect, width over height.
 * Fails with WEFT_MESSAGE_CAMERA_NAME. */
WEFT_API WeftResult weft_scene_camera(const WeftScene *scene, const char *text, float aspect, WeftCamera *out,
                                      WeftError *error);

#ifdef __cplusplus
}
#endif

#endif
