/* export.h - a shading model as text for an engine: GLSL, HLSL, WGSL, C, a Shadertoy, or a file of Godot, Unity or Unreal,
 * with its tables
 *
 *   WeftExport text;
 *   weft_export(&(WeftExportDesc){.lobe = &lobe, .target = WEFT_EXPORT_HLSL}, &text, &error);
 *   fwrite(text.text, 1, text.size, file);
 *   weft_export_free(&text);
 *
 * The text is that of the catalogue, so it computes what this library computes. Its first lines describe the
 * model, its conventions, its licence and how to call it. Directions are in the shading frame of weft/lobe.h.
 *
 *   of a lobe       ID_eval (colour times f), ID_pdf, ID_sample, ID_default, ID_rough; on request ID_albedo, and
 *                   ID_ambient, ID_ambient_axis, ID_ambient_kappa for the light of an environment map
 *   of a material   NAME_surface (its numbers), NAME_shade (f times the cosine)
 *   of a cloth      NAME_see too: what a point of a pixel sees of its threads, which NAME_shade takes
 *
 * Textures, normal maps, emission, environments and area lights are left to the engine. */
#ifndef WEFT_EXPORT_H
#define WEFT_EXPORT_H

#include <stddef.h>

#include "weft/image.h"
#include "weft/lobe.h"
#include "weft/material.h"
#include "weft/weave.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The language of the text, and the code around the functions. */
typedef enum WeftExportTarget {
    WEFT_EXPORT_GLSL = 0,  /* functions for GLSL 3.30 core and later */
    WEFT_EXPORT_ESSL,      /* for GLSL ES 3.00: OpenGL ES 3, WebGL 2 */
    WEFT_EXPORT_HLSL,      /* for shader model 5 and later: Unreal, Unity */
    WEFT_EXPORT_C,         /* one header, C99 and C++, that includes nothing but math.h and stdbool.h */
    WEFT_EXPORT_SHADERTOY, /* one whole shader: a ball, the mouse moves roughness and light */
    WEFT_EXPORT_WGSL,      /* for WebGPU: tables are textures of its bind group 0 */
    WEFT_EXPORT_GODOT,     /* a .gdshaderinc of Godot 4: tables are uniforms without filter */
    WEFT_EXPORT_UNITY,     /* HLSL for a Custom Function node, with void ID_float and ID_half for its file */
    WEFT_EXPORT_UNREAL, /* a .ush for a Custom node; of it and UNITY, tables of 4,096 texels in all are in the text */
    WEFT_EXPORT_TARGETS
} WeftExportTarget;

/* Returns "glsl", "essl", "hlsl", "c", "shadertoy", "wgsl", "godot", "unity" or "unreal", and a line on each; NULL past
 * the end. */
WEFT_API const char *weft_export_target_name(int target);
WEFT_API const char *weft_export_target_help(int target);

/* The form in which tables reach the program. Only PNG16 changes their numbers. */
typedef enum WeftExportLut {
    WEFT_EXPORT_LUT_C = 0, /* arrays of C; inside the text of targets C and SHADERTOY, of WGSL up to 2,047
                              texels, the longest array expression there, and of UNITY and UNREAL 4,096 in all */
    WEFT_EXPORT_LUT_PNG16, /* 16 bits; the text multiplies by a power of two and adds an offset */
    WEFT_EXPORT_LUT_EXR,
    WEFT_EXPORT_LUT_DDS,
    WEFT_EXPORT_LUT_NPY,
    WEFT_EXPORT_LUTS
} WeftExportLut;

/* Returns "c", "png16", "exr", "dds" or "npy"; NULL past the end. */
WEFT_API const char *weft_export_lut_name(int lut);

/* Zero means default, in every member. Exactly one of lobe, profile and material is given, or profile and
 * material together: then the text is that of the profile, for any inputs, with the material's choices and inputs
 * as defaults. */
typedef struct WeftExportDesc {
    const WeftLobe *lobe;         /* ID_default returns these parameters */
    const WeftLobe *right;        /* SHADERTOY: a second lobe, for the right half of the picture */
    const char *profile;          /* the id of an engine profile, or of a workflow */
    const WeftMaterial *material; /* the default inputs; the text may leave out a lobe whose weight is 0 */
    const char *name;             /* of the material, in names of the text; NULL: "material" */
    WeftExportTarget target;      /* language of the text */
    WeftExportLut lut;            /* form of the tables */
    int albedo;                   /* not 0: with ID_albedo of a lobe, which reads a table */
    int fold_pi;                  /* not 0: f is multiplied by pi, for lights whose unit contains the 1/pi */
    const char *prefix;           /* of every name: a C identifier, 24 characters at most; NULL: weft_, in C weftx_ */
    const char *call;             /* the command that made the text, for its first lines; may be NULL */
    int ambient;                  /* not 0: with ID_ambient of a lobe, the light of a map, and ID_albedo */
    const WeftCloth *cloth;       /* the cloth of the material, threads near by and a lobe from afar; NULL: the material
                                     is not woven, or its weave is left out */
} WeftExportDesc;

/* The most models and tables of a text, and the size of a name with its zero. */
enum { WEFT_EXPORT_MODELS_MAX = 16, WEFT_EXPORT_TABLES_MAX = 32, WEFT_EXPORT_NAME = 96 };

/* A table that the text reads: F32, one channel. Upload it as it is, without filtering or mipmaps. */
typedef struct WeftExportTable {
    char name[WEFT_EXPORT_NAME]; /* of the sampler, texture or array in the text */
    WeftImage texels;            /* owned */
    float scale, offset;         /* PNG16: texels are in [0, 1], and the text reads texel scale + offset; else 1, 0 */
} WeftExportTable;

/* A text, and the tables that it reads. */
typedef struct WeftExport {
    char *text;                                     /* owned; ends with a zero byte that size does not count */
    size_t size;                                    /* bytes */
    WeftExportTable tables[WEFT_EXPORT_TABLES_MAX]; /* tables outside the text */
    int table_count;                                /* of these */
} WeftExport;

/* Makes a text. Fails with WEFT_MESSAGE_EXPORT_LOBE (a lobe that is a random walk), _CHECK_NAME (no such
 * profile), _DESC (also of a lobe that `ambient` is not for, and of a draft too large for the target's tables) or
 * _MEMORY; *out is then zero. A table of E takes up to seconds. */
WEFT_API WeftResult weft_export(const WeftExportDesc *desc, WeftExport *out, WeftError *error);

/* Makes one text of `count` models, 1 to WEFT_EXPORT_MODELS_MAX, of one target, lut, prefix and fold_pi. Code that
 * models share is in it once; where they differ, names begin with the model's id, such as WeftKhronosSurface. No two
 * models may have one name, and a Shadertoy takes one model. Fails as weft_export. */
WEFT_API WeftResult weft_export_all(const WeftExportDesc *descs, int count, WeftExport *out, WeftError *error);

/* Releases what the export owns and zeroes it. text may be NULL or all zero. */
WEFT_API void weft_export_free(WeftExport *text);

#ifdef __cplusplus
}
#endif

#endif
