/* match.h - the parameters of one lobe or material that come closest to another: conversion of a look from one
 * engine to the next
 *
 * The distance of two reflections is a sum over a fixed set of pairs of directions, of x = f cos_i:
 *
 *   error = sum w |g(x_to) - g(x_from)| / sum w g(x_from)       in each colour channel, w as below
 *
 *   COSINE:  g(x) = x, w the measure cos_o dwo dwi. That is the integral of |f_to - f_from| cos_i over all pairs of
 *            directions, weighted by the projected area of a sphere's points, over what that sphere reflects of
 *            uniform light. 0.1 is a tenth of the reflected light.
 *   LOG:     g(x) = ln(1 + x / m), m the mean of x_from, and the same w: dark directions count nearly as much
 *            as bright ones. After Alejandro Sztrajman, Gilles Rainer, Tobias Ritschel, Tim Weyrich, "Neural
 *            BRDF Representation and Importance Sampling", Computer Graphics Forum 40(6), 2021, where m is 1;
 *            with the mean, dark and light cloth are compared alike.
 *   PICTURE: g(x) = the sRGB value, 0 .. 1, of pi x, at most 1, and the sum over w alone below the line: the
 *            mean difference of display values over four pictures of a sphere, seen from far away under a
 *            directional light of irradiance pi, 15, 60, 105 and 150 degrees off the viewer.
 *
 * The set has 16 wo with 256 wi each, from a fixed Halton sequence over all azimuths; half of the wi follow the
 * cosine, the rest lie about the mirror direction. The same arguments give the same result, on any number of
 * threads. */
#ifndef WEFT_MATCH_H
#define WEFT_MATCH_H

#include <stdint.h>

#include "weft/lobe.h"
#include "weft/loss.h"
#include "weft/material.h"
#include "weft/reflection.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The metrics, as above. */
typedef enum WeftBrdfMetric {
    WEFT_BRDF_METRIC_COSINE = 0,
    WEFT_BRDF_METRIC_LOG,
    WEFT_BRDF_METRIC_PICTURE,
    WEFT_BRDF_METRIC_COUNT
} WeftBrdfMetric;

/* Returns "cosine", "log" or "picture". */
WEFT_API const char *weft_brdf_metric_name(WeftBrdfMetric metric);

/* Sets *distance to the distance of two reflections in one part (WeftPart; WEFT_PART_ALL: as wholes). 0 means
 * equal. Where `from` reflects nothing in that part, the distance is 0 if `to` reflects nothing either, else 1.
 * Fails with WEFT_MESSAGE_DESC or _MEMORY. */
WEFT_API WeftResult weft_brdf_distance(const WeftReflection *to, const WeftReflection *from, int part,
                                       WeftBrdfMetric metric, double *distance, WeftError *error);

/* The result of a search. */
typedef struct WeftMatch {
    double copied, matched; /* the error at the start, and of the result, which is never above it */
    long long evaluations;  /* of a lobe or material over the directions */
} WeftMatch;

/* Bits of `hold` beside bit k for parameter k: f0 and f90 stay as they are. */
enum { WEFT_HOLD_COLOR = 1 << 8, WEFT_HOLD_COLOR_2 = 1 << 9 };

/* Changes lobe so that it comes closest to `from`. The search begins at the lobe as given and varies all parameters
 * that are numbers, within their plausible range extended to the start; f0, and f90 with WEFT_LOBE_TWO_COLORS, which
 * are at least 0 and with WEFT_LOBE_TINTED at most 1. Choices stay, and so does what `hold` (may be 0) names. If `from`
 * and the start are isotropic, parameters that would make the lobe anisotropic stay. Parameters without influence stay.
 * Fails with WEFT_MESSAGE_LOBE_NAME, _DESC (a lobe with WEFT_LOBE_REFERENCE on either side: the search would fit its
 * noise; match fibre, which is the mean) or _MEMORY. */
WEFT_API WeftResult weft_match_lobe(const WeftReflection *from, WeftBrdfMetric metric, unsigned hold, WeftLobe *lobe,
                                    WeftMatch *out, WeftError *error);

/* Changes material so that it comes closest to `from`. The search begins at the material as given and varies those of
 * base_color, sheen_color, sheen_roughness, roughness (0.25 at least) and specular that it reads (weft_material_reads),
 * sheen and sheen_tint where it does not read sheen_color, and specular_color in workflow specular; all within their
 * plausible range extended to the start. held (may be NULL): WEFT_INPUTS_MAX values, not 0 for an input that stays.
 * Where both are grey, colours stay grey. Fails with WEFT_MESSAGE_PARAM_VALUE, _DESC (a lobe with WEFT_LOBE_REFERENCE
 * on either side) or _MEMORY. */
WEFT_API WeftResult weft_match_material(const WeftReflection *from, WeftBrdfMetric metric, const int *held,
                                        WeftMaterial *material, WeftMatch *out, WeftError *error);

/* Returns 1 if weft_match_material may change that input of the material, else 0. */
WEFT_API int weft_match_is_free(const WeftMaterial *material, int input);

/* One of many matches. */
typedef struct WeftMatchJob {
    const WeftReflection *from; /* borrowed */
    int is_lobe;                /* not 0: lobe is matched, else material */
    unsigned hold;              /* as in weft_match_lobe */
    const int *held;            /* as in weft_match_material; may be NULL */
    WeftLobe lobe;              /* the start, then the match */
    WeftMaterial material;      /* likewise */
    WeftMatch found;            /* the errors of start and match */
    WeftResult result;          /* of this match */
} WeftMatchJob;

/* Does jobs[0 .. count) on so many threads (0: one a processor). progress (may be NULL) is given user and can stop
 * the work in the midst of a search: WEFT_INTERRUPTED. Fails with the first failure of a job. */
WEFT_API WeftResult weft_match_many(WeftMatchJob *jobs, int count, WeftBrdfMetric metric, int threads,
                                    WeftProgress progress, void *user, WeftError *error);

/* The result for one material of an asset, in its glTF factors. With textures, the errors of `found` are means over some
 * texels. */
typedef struct WeftAssetMatch {
    char name[64];        /* of the material, truncated */
    int changed;          /* 0: it has no sheen, or is unlit, and stays as it is */
    int clipped;          /* not 0: a factor would have exceeded 1, the limit of glTF */
    int search;           /* number of the search, counted from 1; equal materials share one; 0: none */
    uint64_t maps;        /* bit k: input k has a new texture (weft_material_input_info) */
    WeftMatch found;      /* the errors of copy and match */
    WeftMaterial copied;  /* under profile `to`, with the factors of the file */
    WeftMaterial matched; /* under profile `to`, with the new factors */
} WeftAssetMatch;

/* Converts the glTF file at `path` for another engine and writes it to `out`. The factors base_color, roughness,
 * sheen_color, sheen_roughness and specular of materials that have a sheen change, so that under profile `to` they
 * come closest to what they are under profile `from` (indices of weft_profile_name). Textures of the first four are
 * rewritten as PNGs where a factor does not do: each texel by a curve through matches at seven roughnesses of sheen or
 * base and three brightnesses of the sheen, of the mean of the texels around each; specular then stays. A colour of
 * sheen or base that has no texture gets one if it has to follow the sheen's; where its texture has other coordinates
 * than the sheen's, its factor alone changes. At some texels, new textures are weighed against factors alone and
 * against the material as it is, and what is nearest is written. All else, old images included, stays as it is, byte
 * for byte. Materials whose textures have the same means and ranges share one search; the searches run on all
 * processors. progress (may be NULL) receives the finished fraction, reading and writing aside, and can stop the work
 * in the midst of a search or an image: WEFT_INTERRUPTED, and nothing is written. *report (report may be NULL) receives
 * a record of each of *count materials; on success it is owned by the caller: release it with weft_match_report_free.
 * Fails with WEFT_MESSAGE_DESC (no such profile), and as reading and writing a file do. */
WEFT_API WeftResult weft_match_asset(const char *path, const char *out, int from, int to, WeftBrdfMetric metric,
                                     WeftProgress progress, void *user, WeftAssetMatch **report, int *count,
                                     const WeftLog *log, WeftError *error);

WEFT_API void weft_match_report_free(WeftAssetMatch *report); /* may be NULL */

/* The maps of a cloth that weft_material_bake makes. All 0 and NULL: as given beside each. */
typedef struct WeftBaking {
    int pixels;          /* about pixels^2 texels, square ones, 16 .. 8192; 0: 1024 */
    double metres;       /* width of a unit of texture coordinates; 0: 1 */
    const char *profile; /* of the viewer, which must read glTF's metallic; NULL: khronos */
    int levels;   /* not 0: KTX 2 files with mip levels of their own in place of PNG, but of height and other face */
    int one_face; /* not 0: the front alone, for files that have no place for the other face */
    WeftLosses *losses; /* weft_scene_bake: is given what the textures lack; NULL: none */
    WeftProgress
        progress; /* receives the finished fraction of the search, and can stop it, WEFT_INTERRUPTED; NULL: none */
    void *user;   /* given to it */
} WeftBaking;

/* The distance of the maps from the cloth, as seen from afar: the mean over five directions of light and an even sky of
 * the difference over the light of the cloth. */
typedef struct WeftBaked {
    double copied; /* of maps that copy the threads' own numbers */
    double fitted; /* of the maps that are written */
    double sky;    /* what an even sky gives too much, over what it gives the cloth; of a viewer whose own sky is in the
                        fit (three, babylon, filament-sheen) with occlusion, of others without */
    double contrast; /* of squares of 4 by 4 texels with each other, over that of the threads */
    double levels;   /* the mean of the distance of mip levels of their own after the first; 0: there are none */
} WeftBaked;

/* Writes a woven material as tiling textures into a folder, which is made if it does not exist: base_color.png (sRGB,
 * coverage in alpha), normal.png, occlusion_roughness.png (occlusion in red, roughness in green, metallic in blue),
 * anisotropy.png (encoded as in KHR_materials_anisotropy), height.png, the same of its other face as
 * back-base_color.png and so on, and material.json, the material with both, which scales them to a surface of which one
 * unit of texture coordinates spans so many metres. The textures contain whole repeats of at least 16 threads; a side
 * has 16 to 8192 texels. The numbers of the material, and factors on the colours, roughness and anisotropy of the
 * textures, are fitted so that what a viewer of that profile shades is what the cloth reflects from afar, with the
 * sheen of `material`, and threads keep their contrast near by. Gaps are black where the material is opaque, else
 * holes. The rotation of the weave is left out. With `levels` sides are multiples of 4, the first four files of the
 * front end in .ktx2 (UASTC in Zstandard, as KHR_texture_basisu takes it), and each mip level is fitted like the
 * whole: its texels shade as the cloth does from afar, in the mean, with the contrast of the threads at that size.
 * found, of the front, may be NULL. What is stopped has written nothing. The same arguments give the same files. Fails
 * with WEFT_MESSAGE_DESC (no cloth, a number out of range, a profile that is not one or does not read metallic),
 * _PARAM_VALUE, _FILE_WRITE or _MEMORY. */
WEFT_API WeftResult weft_material_bake(const WeftMaterial *material, const WeftCloth *cloth, const WeftBaking *baking,
                                       const char *folder, WeftBaked *found, WeftError *error);

/* Bakes the weave of a material of a scene, 0 .. material_count - 1, into a folder as weft_material_bake does, and gives
 * the material the textures in its place. Fuzz, coat and emission stay as they are, and are left out of the fit. Dust, wear,
 * the rotation of the weave and textures of other inputs are left out of both (WeftBaking.losses). metres of 0 are those of the
 * weave. The scene has read the textures: the folder may be removed. Where it fails the material may be either. Fails as
 * weft_material_bake and weft_scene_assign_material do. */
WEFT_API WeftResult weft_scene_bake(WeftScene *scene, int material, const WeftBaking *baking, const char *folder,
                                    WeftBaked *found, WeftError *error);

#ifdef __cplusplus
}
#endif

#endif
