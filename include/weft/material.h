/* material.h - a scene's materials as numbers: to read, to keep, to change and to put back
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
    float initial, low, high;  /* default and plausible range; angles in degrees */
    float hard_low, hard_high; /* values are clamped to this */
} WeftInputInfo;

/* Fills in the input at index, in the order of weft_material_input_name, and returns 1; returns 0 past the end. */
WEFT_API int weft_material_input_info(int index, WeftInputInfo *out);

/* An input of one material: a number or a colour, and the texture that multiplies it. */
typedef struct WeftInput {
    float value[3];     /* angles in radians */
    int texture;        /* of the scene, counted from 1, by which the value is multiplied; 0: none */
    int texcoord;       /* UV set, 0 or 1 */
    int channel;        /* of the texture, for SCALAR and ANGLE: 0 r, 1 g, 2 b, 3 a */
    int given;          /* not 0: it was set, so a workflow does not replace it by its own default */
    float transform[6]; /* (u', v') = (m0 u + m1 v + m2, m3 u + m4 v + m5) before the texture is read */
} WeftInput;

/* The numbers of the hair of a cloth: loose fibres that stand off its front and break its outline. Both engines draw them
 * as ribbons of triangles. Without length, density or thickness there is none. */
enum {
    WEFT_HAIR_LENGTH = 0, /* of the longest fibres, m; they are half as long and more */
    WEFT_HAIR_DENSITY,    /* fibres that stand on 1 m2 */
    WEFT_HAIR_THICKNESS,  /* width of a fibre, m */
    WEFT_HAIR_NUMBERS
};

/* Fills in the number of hair at index, and returns 1; returns 0 past the end. weft_scene_set takes its name. */
WEFT_API int weft_material_hair_info(int index, WeftInputInfo *out);

/* Returns the name of a number of hair and its help; NULL past the end. */
WEFT_API const char *weft_material_hair_name(int index);
WEFT_API const char *weft_material_hair_help(int index);

/* The effect of opacity: none, a cut-out, or blending with the background. */
typedef enum WeftAlphaMode { WEFT_ALPHA_OPAQUE = 0, WEFT_ALPHA_MASK, WEFT_ALPHA_BLEND } WeftAlphaMode;

/* A material in numbers. */
typedef struct WeftMaterial {
    WeftAlphaMode alpha_mode;      /* effect of opacity */
    float alpha_cutoff;            /* MASK: the surface is cut out where opacity is below it */
    int double_sided;              /* 0: visible only from the front */
    int unlit;                     /* not 0: base_color is shown as it is */
    int cloth;                     /* of the scene, counted from 1, in place of diffuse and specular; 0: none */
    int measured;                  /* of the scene, counted from 1, in place of all lobes in the path tracer; 0: none */
    float hair[WEFT_HAIR_NUMBERS]; /* length, density and thickness of loose fibres; length 0: there are none */
    int choices[WEFT_CHOICES_MAX]; /* as weft_material_choice_value counts; -1: auto */
    WeftInput inputs[WEFT_INPUTS_MAX]; /* in the order of weft_material_input_name */
} WeftMaterial;

/* Fills in the material of a file that has none: a grey dielectric without a sheen, all choices auto. */
WEFT_API void weft_material_default(WeftMaterial *out);

/* Reads the material of a file (docs/materials.md) or of "preset:NAME", without its textures, which a warning
 * names. Fails with WEFT_MESSAGE_MATERIAL_FILE, _PRESET_NAME and as reading a file does. */
WEFT_API WeftResult weft_material_read(const char *path, WeftMaterial *out, const WeftLog *log, WeftError *error);

/* Works as weft_material_read, and makes the cloth of the material: release it with weft_cloth_free; NULL where the
 * material is not woven. */
WEFT_API WeftResult weft_material_read_woven(const char *path, WeftMaterial *out, WeftCloth **cloth, const WeftLog *log,
                                             WeftError *error);

/* Sets an input or a choice by name, as weft_scene_set does. Fails with WEFT_MESSAGE_PARAM_NAME or
 * _PARAM_VALUE; the material is then as it was. */
WEFT_API WeftResult weft_material_set(WeftMaterial *material, const char *name, const char *value, const WeftLog *log,
                                      WeftError *error);

/* Sets the value of an input by its index, as weft_scene_set does by name: values points to one number, of a
 * COLOR to three; angles are in radians. Values are clamped to the hard range. Fails with
 * WEFT_MESSAGE_PARAM_NAME if there is no such input, or _PARAM_VALUE if a value is not finite; the material is
 * then as it was. */
WEFT_API WeftResult weft_material_set_number(WeftMaterial *material, int input, const float *values, WeftError *error);

/* Fills in material index as it is now; entries past the last choice and input are zero. Fails with
 * WEFT_MESSAGE_MATERIAL_NAME where there is none of that index. */
WEFT_API WeftResult weft_scene_material(const WeftScene *scene, int index, WeftMaterial *out, WeftError *error);

/* Replaces material index. Numbers are clamped as weft_scene_set clamps them, without a warning. Fails with
 * WEFT_MESSAGE_MATERIAL_NAME, _PARAM_VALUE (not finite, or no such choice, texture, channel or mode) or _MEMORY;
 * the scene is then as it was. */
WEFT_API WeftResult weft_scene_put_material(WeftScene *scene, int index, const WeftMaterial *material,
                                            WeftError *error);

/* Gives material index a measurement, a file that weft_reflection_read reads. The path tracer evaluates it in place of
 * all lobes of the material, which still draw half of the samples; everything else renders the lobes. Opacity, normal
 * map and emission of the material stay. Fails with WEFT_MESSAGE_MATERIAL_NAME, _MEASURED where the suffix names no
 * format, and as weft_reflection_read; the scene is then as it was. */
WEFT_API WeftResult weft_scene_put_measured(WeftScene *scene, int index, const char *path, WeftError *error);

/* Sets a choice, as weft_scene_set does: inputs that mean something else in the new workflow change from its old
 * default to its new one. choice and value out of range change nothing. */
WEFT_API void weft_material_choose(WeftMaterial *material, int choice, int value);

/* Warns of implausible inputs, as weft_scene_set does; messages begin with name. */
WEFT_API void weft_material_plausible(const WeftMaterial *material, const char *name, const WeftLog *log);

/* Warns where a material is not shown as its inputs say: where the lobe of the sheen replaces a parameter outside its
 * fitted range, as weft_lobe_fitted does (a texture counts as reaching down to 0), and where its profile or workflow
 * shows glass, of input transmission, as opaque. weft_material_plausible warns of these too. */
WEFT_API void weft_material_fitted(const WeftMaterial *material, const char *name, const WeftLog *log);

/* Returns 1 if the input has any influence on the material, else 0: its workflow or profile must read it, and
 * no other input may hide it, as a black sheen hides its roughness. */
WEFT_API int weft_material_reads(const WeftMaterial *material, int input);

/* Reads an image file as the texture of an input: target is "MATERIAL.INPUT" as in weft_scene_set. The value of
 * the input becomes 1 (a colour white, a direction 0), its channel the one that target may end in (".r", ".g",
 * ".b", ".a"), else the first. If the scene has an image of that path, it is reloaded and shared. Fails as
 * weft_scene_set and weft_image_read do; the scene is then as it was. */
WEFT_API WeftResult weft_scene_set_texture(WeftScene *scene, const char *target, const char *path, const WeftLog *log,
                                           WeftError *error);

/* Returns the path of a texture's file, counted from 1: as it was given, or beside its .gltf; NULL where it has no
 * file (in a .glb), or index is out of range. Owned by the scene. */
WEFT_API const char *weft_scene_texture_path(const WeftScene *scene, int index);

/* Replaces the pixels of a texture, counted from 1: takes over image and zeroes it. All textures that share the
 * pixels change. Fails with WEFT_MESSAGE_DESC; image then still belongs to the caller. */
WEFT_API WeftResult weft_scene_put_texture(WeftScene *scene, int index, WeftImage *image, WeftError *error);

/* Reloads the file of a texture, counted from 1. Fails as weft_image_read does, or with WEFT_MESSAGE_DESC where it
 * has none; the scene is then as it was. */
WEFT_API WeftResult weft_scene_read_texture(WeftScene *scene, int index, const WeftLog *log, WeftError *error);

/* Returns the pixels of a texture, counted from 1: all zero where there is none. Owned by the scene. */
WEFT_API WeftImage weft_scene_texture(const WeftScene *scene, int index);

/* Adds a texture that repeats and is filtered linearly: takes over image and zeroes it. Returns its number,
 * counted from 1; 0 with *error on failure (WEFT_MESSAGE_DESC, _MEMORY). */
WEFT_API int weft_scene_add_texture(WeftScene *scene, WeftImage *image, WeftError *error);

/* Reads the maps in a folder onto `material`, named as in weft_scene_assign_material (NULL: the cloth of the scene).
 * Maps are found by file name, in any case, with the suffix of a picture that is read; docs/materials.md
 * lists the names. An input that already has its map keeps its factor, so that a folder can be read again. count (may
 * be NULL) receives the number of maps; none is WEFT_MESSAGE_FILE_OPEN. */
WEFT_API WeftResult weft_scene_bind_maps(WeftScene *scene, const char *material, const char *folder, int *count,
                                         const WeftLog *log, WeftError *error);

#ifdef __cplusplus
}
#endif

#endif
