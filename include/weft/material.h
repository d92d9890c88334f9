/* material.h - a scene's materials as plain numbers: to read, to keep, to change and to put back
 *
 *   weft_scene_material(scene, 0, &material, &error);
 *   material.inputs[k].value[0] = 0.3f;
 *   weft_scene_put_material(scene, 0, &material, &error);
 *
 * A WeftMaterial owns nothing: it may be copied and compared byte by byte. Its textures are those of the
 * scene it came from. */
#ifndef WEFT_MATERIAL_H
#define WEFT_MATERIAL_H

#include "weft/image.h"
#include "weft/scene.h"
#include "weft/weave.h"

#ifdef __cplusplus
extern "C" {
#endif

/* No material has more inputs or choices. */
enum { WEFT_INPUTS_MAX = 64, WEFT_CHOICES_MAX = 16 };

/* SCALAR: value[0]. COLOR: value[0 .. 2], linear Rec. 709. NORMAL: value[0] scales a normal map. DIRECTION:
 * value[0] is an angle from the tangent towards the bitangent. ANGLE: value[0]. */
typedef enum WeftInputKind {
    WEFT_INPUT_SCALAR = 0,
    WEFT_INPUT_COLOR,
    WEFT_INPUT_NORMAL,
    WEFT_INPUT_DIRECTION,
    WEFT_INPUT_ANGLE
} WeftInputKind;

/* An input that every material has, such as "sheen_roughness". */
typedef struct WeftInputInfo {
    const char *name, *help;   /* live as long as the program */
    WeftInputKind kind;        /* what its value means */
    float initial, low, high;  /* what it is unless it is set, and what is plausible; angles in degrees */
    float hard_low, hard_high; /* values are clamped to this */
} WeftInputInfo;

/* About the input at index, in the order of weft_material_input_name. Returns 0 past the end. */
WEFT_API int weft_material_input_info(int index, WeftInputInfo *out);

/* An input of one material: a number or a colour, and what multiplies it. */
typedef struct WeftInput {
    float value[3];     /* angles in radians */
    int texture;        /* of the scene, counted from 1, by which the value is multiplied; 0: none */
    int texcoord;       /* UV set, 0 or 1 */
    int channel;        /* of the texture, for SCALAR and ANGLE: 0 r, 1 g, 2 b, 3 a */
    int given;          /* not 0: it was set, so that no workflow puts a default of its own in its place */
    float transform[6]; /* (u', v') = (m0 u + m1 v + m2, m3 u + m4 v + m5) before the texture is read */
} WeftInput;

/* The effect of opacity: none, a cut-out, or blending with the background. */
typedef enum WeftAlphaMode { WEFT_ALPHA_OPAQUE = 0, WEFT_ALPHA_MASK, WEFT_ALPHA_BLEND } WeftAlphaMode;

/* A material in numbers. */
typedef struct WeftMaterial {
    WeftAlphaMode alpha_mode; /* what opacity does */
    float alpha_cutoff;       /* MASK: opacity below it is nothing, from it on everything */
    int double_sided;         /* 0: seen only from the front */
    int unlit;                /* not 0: base_color is shown as it is */
    int cloth;                /* of the scene, counted from 1, in place of diffuse and specular; 0: none */
    int measured; /* of the scene, counted from 1, in place of all lobes in the path tracer; 0: none */
    int choices[WEFT_CHOICES_MAX];     /* as weft_material_choice_value counts; -1: auto */
    WeftInput inputs[WEFT_INPUTS_MAX]; /* in the order of weft_material_input_name */
} WeftMaterial;

/* The material that a file is without one: a grey dielectric without a sheen, all choices auto. */
WEFT_API void weft_material_default(WeftMaterial *out);

/* The material of a file (docs/materials.md) or of "preset:NAME", without its textures, which a
 * warning names. Fails with WEFT_MESSAGE_MATERIAL_FILE, _PRESET_NAME and with what reading a file can fail with. */
WEFT_API WeftResult weft_material_read(const char *path, WeftMaterial *out, const WeftLog *log,
                                       WeftError *error);

/* Likewise with the cloth that it is woven of, for weft_cloth_free; NULL where it is not woven. */
WEFT_API WeftResult weft_material_read_woven(const char *path, WeftMaterial *out, WeftCloth **cloth,
                                             const WeftLog *log, WeftError *error);

/* Sets an input or a choice by name, as weft_scene_set does. Fails with WEFT_MESSAGE_PARAM_NAME or
 * _PARAM_VALUE; the material is then as it was. */
WEFT_API WeftResult weft_material_set(WeftMaterial *material, const char *name, const char *value,
                                      const WeftLog *log, WeftError *error);

/* Sets the value of an input by its index, as weft_scene_set does by name: values points to one number, of a
 * COLOR to three; angles are in radians. Values are clamped to the hard range. Fails with
 * WEFT_MESSAGE_PARAM_NAME if there is no such input, or _PARAM_VALUE if a value is not finite; the material is
 * then as it was. */
WEFT_API WeftResult weft_material_set_number(WeftMaterial *material, int input, const float *values,
                                             WeftError *error);

/* Material index as it is; what is past the last choice and input is zero. Fails with
 * WEFT_MESSAGE_MATERIAL_NAME where there is no such. */
WEFT_API WeftResult weft_scene_material(const WeftScene *scene, int index, WeftMaterial *out,
                                        WeftError *error);

/* Puts it on material index. Numbers are clamped as weft_scene_set clamps them, without a word. Fails with
 * WEFT_MESSAGE_MATERIAL_NAME, _PARAM_VALUE (not finite, or a choice, texture, channel or mode that there is
 * not) or _MEMORY; the scene is then as it was. */
WEFT_API WeftResult weft_scene_put_material(WeftScene *scene, int index, const WeftMaterial *material,
                                            WeftError *error);

/* Gives material index a measurement, a file as weft_reflection_read has them: the path tracer reflects by it in
 * place of all lobes of the material, whose numbers are what everything else shows and which draw half of the
 * samples. Its opacity, normal map and emission stay. Fails with WEFT_MESSAGE_MATERIAL_NAME, _MEASURED where
 * the name is of no format, and as weft_reflection_read; the scene is then as it was. */
WEFT_API WeftResult weft_scene_put_measured(WeftScene *scene, int index, const char *path, WeftError *error);

/* Makes a choice in it, as weft_scene_set does: inputs that mean something else to the new workflow move from
 * default to default. choice and value out of range change nothing. */
WEFT_API void weft_material_choose(WeftMaterial *material, int choice, int value);

/* Says what is hardly real in it, as weft_scene_set does; messages begin with name. */
WEFT_API void weft_material_plausible(const WeftMaterial *material, const char *name, const WeftLog *log);

/* Says where the lobe of its sheen takes another number than it was given, as weft_lobe_fitted does; a
 * texture counts as reaching down to 0. weft_material_plausible says this too. */
WEFT_API void weft_material_fitted(const WeftMaterial *material, const char *name, const WeftLog *log);

/* Returns 1 if the input has any influence on the material, else 0: its workflow or profile must read it, and
 * no other input may hide it, as a black sheen hides its roughness. */
WEFT_API int weft_material_reads(const WeftMaterial *material, int input);

/* Puts a picture of a file in the place of an input's texture: target is "MATERIAL.INPUT" as in
 * weft_scene_set. Its value becomes 1 (a colour's white; a direction's 0), its channel the one that target
 * may end in (".r", ".g", ".b", ".a"), else the first. A picture of that path that the scene has is read
 * again and serves. Fails as weft_scene_set and weft_image_read do; the scene is then as it was. */
WEFT_API WeftResult weft_scene_set_texture(WeftScene *scene, const char *target, const char *path,
                                           const WeftLog *log, WeftError *error);

/* The file of a texture, counted from 1: as it was given, or beside its .gltf; NULL where it is none of its
 * own (in a .glb), or index is out of range. Owned by the scene. */
WEFT_API const char *weft_scene_texture_path(const WeftScene *scene, int index);

/* Puts other pixels in place of a texture's, counted from 1: takes image over and zeroes it. All textures of
 * that picture have them. Fails with WEFT_MESSAGE_DESC; image is then the caller's still. */
WEFT_API WeftResult weft_scene_put_texture(WeftScene *scene, int index, WeftImage *image, WeftError *error);

/* Reads a texture's own file again, counted from 1, as it does where the file has changed. Fails as
 * weft_image_read does, or with WEFT_MESSAGE_DESC where it has none; the scene is then as it was. */
WEFT_API WeftResult weft_scene_read_texture(WeftScene *scene, int index, const WeftLog *log,
                                            WeftError *error);

/* A texture's pixels, counted from 1, of the scene: all zero where there is none. Not to be freed. */
WEFT_API WeftImage weft_scene_texture(const WeftScene *scene, int index);

/* Adds an empty texture of one layer, repeated, not nearest: takes image over and zeroes it. Returns its
 * number, counted from 1; 0 with *error on failure (WEFT_MESSAGE_DESC, _MEMORY). */
WEFT_API int weft_scene_add_texture(WeftScene *scene, WeftImage *image, WeftError *error);

/* Reads the maps in a folder onto material MAT as weft_scene_assign_material has it (NULL: the cloth of the scene): by
 * file name, in any case, with any of the suffixes .tga .png .jpg .jpeg .exr .hdr: docs/materials.md has the
 * names. An input that has its map already keeps the number beside it, so that a folder can be read again.
 * count (may be NULL) receives how many there were; none is WEFT_MESSAGE_FILE_OPEN. */
WEFT_API WeftResult weft_scene_bind_maps(WeftScene *scene, const char *material, const char *folder,
                                         int *count, const WeftLog *log, WeftError *error);

#ifdef __cplusplus
}
#endif

#endif
