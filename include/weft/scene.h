/* scene.h - a scene to render: loaded from a file or built in, then dressed and lit
 *
 * World space is right-handed, +y up, metres. A WeftScene may be read by several renders at once; the calls
 * that change it must not run beside anything else on the same scene. */
#ifndef WEFT_SCENE_PUBLIC_H
#define WEFT_SCENE_PUBLIC_H

#include <stddef.h>

#include "weft/progress.h"
#include "weft/result.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Meshes, materials, lights, cameras and an environment. */
typedef struct WeftScene WeftScene;

/* Loads path: a .gltf or .glb file, or "builtin:NAME". log (may be NULL) receives warnings. On success *out
 * is owned by the caller: release it with weft_scene_free. */
WEFT_API WeftResult weft_scene_load(const char *path, WeftScene **out, const WeftLog *log, WeftError *error);

/* weft_scene_load, with progress (may be NULL), which can stop it: WEFT_INTERRUPTED. */
WEFT_API WeftResult weft_scene_load_watched(const char *path, WeftProgress progress, void *user,
                                            WeftScene **out, const WeftLog *log, WeftError *error);

/* Works as weft_scene_load, from size bytes of a .glb, or of a .gltf that refers to no other file. */
WEFT_API WeftResult weft_scene_load_memory(const void *data, size_t size, const char *name, WeftScene **out,
                                           const WeftLog *log, WeftError *error);

/* scene may be NULL. */
WEFT_API void weft_scene_free(WeftScene *scene);

/* The built-in scenes: the name without "builtin:" and a line on what it shows; NULL past the end. */
WEFT_API const char *weft_builtin_name(int index);
WEFT_API const char *weft_builtin_help(int index);

/* The counts and extent of a scene. */
typedef struct WeftSceneInfo {
    /* of each: indices run from 0 to one less */
    int mesh_count, material_count, light_count, camera_count, variant_count, image_count;
    long long triangle_count; /* of all meshes together */
    float low[3], high[3];    /* bounding box, m */
} WeftSceneInfo;

/* About a scene, as it is now. */
WEFT_API WeftSceneInfo weft_scene_info(const WeftScene *scene);

/* Names by index; "" where the file gives none, NULL out of range. Owned by the scene. */
WEFT_API const char *weft_scene_material_name(const WeftScene *scene, int index);
WEFT_API const char *weft_scene_camera_name(const WeftScene *scene, int index);
WEFT_API const char *weft_scene_variant_name(const WeftScene *scene, int index);

/* Returns 1 if any surface wears material index as the scene is now, else 0: what only a variant that is not
 * chosen has is worn by none. */
WEFT_API int weft_scene_material_used(const WeftScene *scene, int index);

/* Switches to a variant of KHR_materials_variants by name, NULL: to none. A surface of which the variant says
 * nothing wears what it does without one. Fails with WEFT_MESSAGE_VARIANT_NAME. */
WEFT_API WeftResult weft_scene_set_variant(WeftScene *scene, const char *name, WeftError *error);

/* The index of the variant that was switched to; -1: none. */
WEFT_API int weft_scene_variant(const WeftScene *scene);

/* Sets "MATERIAL.INPUT" to a number or "r,g,b" and drops its texture (a normal map stays and is scaled), or a
 * choice such as "MATERIAL.layer" to an id or "auto"; MATERIAL is a name, an index or "*" for all. Values
 * beyond the plausible range are taken with a warning; non-finite ones are refused. */
WEFT_API WeftResult weft_scene_set(WeftScene *scene, const char *target, const char *value,
                                   const WeftLog *log, WeftError *error);

/* Puts the material of a file (docs/materials.md) or of "preset:NAME" on material MAT: a name, an index, "*"
 * for all, or NULL for the cloth of the scene: what has a sheen, or, where nothing has, all that sends out no
 * light. A preset gives no warnings. Fails with WEFT_MESSAGE_MATERIAL_FILE, _MATERIAL_NAME, _PRESET_NAME and
 * with what reading a file or a picture can fail with; the scene is then as it was. */
WEFT_API WeftResult weft_scene_assign_material(WeftScene *scene, const char *material, const char *path,
                                               const WeftLog *log, WeftError *error);

/* Works as weft_scene_assign_material, from size bytes of a material file that names no texture. Messages begin
 * with name. */
WEFT_API WeftResult weft_scene_assign_material_memory(WeftScene *scene, const char *material,
                                                      const void *data, size_t size, const char *name,
                                                      const WeftLog *log, WeftError *error);

/* The presets: name, a line on what it looks like, and the text of its material file; NULL past the end. */
WEFT_API const char *weft_preset_name(int index);
WEFT_API const char *weft_preset_help(int index);
WEFT_API const char *weft_preset_text(int index);

/* From now on turns every material of workflow "metallic" into "specular", or the other way round, at each
 * point where it is shaded, so that textures are converted as exactly as numbers. losses (may be NULL) must
 * hold a number for each material: the greatest change, over a grid of 256 x 256 points of its textures, of a
 * channel of the diffuse colour or of the reflectance at normal incidence. Where the material stays it is
 * negative: -1 with another workflow, or a profile; -2 where it is of that workflow already. */
WEFT_API WeftResult weft_scene_convert(WeftScene *scene, const char *workflow, float *losses,
                                       WeftError *error);

/* The material inputs weft_scene_set takes: name and help, NULL past the end; and the index of a name, or -1. */
WEFT_API const char *weft_material_input_name(int index);
WEFT_API const char *weft_material_input_help(int index);
WEFT_API int weft_material_input_find(const char *name);

/* Its choices likewise, and the ids that a choice may take; NULL past the end. */
WEFT_API const char *weft_material_choice_name(int index);
WEFT_API int weft_material_choice_find(const char *name);
WEFT_API const char *weft_material_choice_help(int index);
WEFT_API const char *weft_material_choice_value(int index, int value);

/* Returns 1 if a material may have this value, else 0: a diffuse term is a diffuse lobe, any lobe is a
 * sheen. */
WEFT_API int weft_material_choice_fits(int index, int value);

/* Lights the scene from a lat-long image file (its columns run towards +x, row 0 is up), or from the six
 * faces of a cube: path is their folder or one of them, called posx negx posy negy posz negz or px nx py ny
 * pz nz in any case, square, of one size, and lying as OpenGL has them. */
WEFT_API WeftResult weft_scene_set_environment_file(WeftScene *scene, const char *path, const WeftLog *log,
                                                    WeftError *error);

/* Lights the scene by one radiance from everywhere. */
WEFT_API WeftResult weft_scene_set_environment_color(WeftScene *scene, const float color[3],
                                                     WeftError *error);

/* Lights the scene by the studio again, as one that was just loaded. */
WEFT_API WeftResult weft_scene_set_environment_studio(WeftScene *scene, WeftError *error);

/* Turns the environment about +y (degrees) and scales it. */
WEFT_API WeftResult weft_scene_set_environment_placement(WeftScene *scene, float rotation, float strength,
                                                         WeftError *error);

/* Scales what the diffuse lobe and dust reflect of the environment's light, and what the specular, sheen and
 * coat lobes do, where it is reflected first: neither the background nor what is reflected on. Finite, >= 0,
 * 1 of a fresh scene; other values are an artist's choice, which no light has. A raster or
 * render sees the change as that of any light. Fails with WEFT_MESSAGE_DESC, and nothing is changed. */
WEFT_API WeftResult weft_scene_set_environment_parts(WeftScene *scene, float ambient, float reflection,
                                                     WeftError *error);

/* The kinds of lights. */
typedef enum WeftLightKind {
    WEFT_LIGHT_DIRECTIONAL = 0,
    WEFT_LIGHT_POINT = 1,
    WEFT_LIGHT_SPOT = 2,
    WEFT_LIGHT_POLYGON = 3 /* flat, shines to one side */
} WeftLightKind;

/* A punctual light, that of KHR_lights_punctual (Khronos Group, 2018-2020) in radiometric units. */
typedef struct WeftLight {
    WeftLightKind kind; /* selects the members below that count */
    float position[3];  /* m; point, spot, middle of a polygon */
    float direction
        [3]; /* direction in which the light travels, of any length but 0; directional, spot; for a polygon its normal */
    float color[3]; /* >= 0: W/m^2 across the beam (directional), W/sr (point, spot), radiance (polygon) */
    float range;    /* m, where it ends; 0: nowhere */
    float inner, outer; /* spot: degrees from the axis, 0 <= inner <= outer <= 90; outer 0: 45 */
    float size[2];      /* polygon: m, along its two axes, > 0; the first one is level */
    int corners;        /* polygon: 3 .. 8, on the ellipse that fills size; 4 is the rectangle; 0: 4 */
    float roll;         /* polygon: degrees about its normal, from level */
} WeftLight;

/* Adds it to the scene, behind those that it has. Fails with WEFT_MESSAGE_DESC or _MEMORY. */
WEFT_API WeftResult weft_scene_add_light(WeftScene *scene, const WeftLight *light, WeftError *error);

/* The lights of the scene by index, WeftSceneInfo.light_count of them: those of its file, then those that
 * were added. What shines because its material does is a mesh and not among them. All fail with
 * WEFT_MESSAGE_DESC where there is no such light; weft_scene_put_light as weft_scene_add_light does. */
WEFT_API WeftResult weft_scene_light(const WeftScene *scene, int index, WeftLight *out, WeftError *error);
WEFT_API WeftResult weft_scene_put_light(WeftScene *scene, int index, const WeftLight *light,
                                         WeftError *error);
WEFT_API WeftResult weft_scene_remove_light(WeftScene *scene, int index, WeftError *error);

/* A camera in numbers: what text (as WeftRenderDesc.camera) means in a picture of that aspect, width over
 * height. */
typedef struct WeftCamera {
    float eye[3], target[3], up[3]; /* target: where its axis passes the middle of the scene */
    float fov;                      /* vertical, degrees; 0 of an orthographic camera */
} WeftCamera;

/* Makes the camera that the text describes. Fails with WEFT_MESSAGE_CAMERA_NAME. */
WEFT_API WeftResult weft_scene_camera(const WeftScene *scene, const char *text, float aspect, WeftCamera *out,
                                      WeftError *error);

#ifdef __cplusplus
}
#endif

#endif
