/* judge.h - expected values of the objects of a scene, and what sets a picture of it apart
 *
 *   weft_judge_create(scene, &desc, NULL, NULL, &judge, &error);
 *   weft_judge_pictures(judge, &picture, 1, NULL, NULL, &verdict, &error);
 *   if (verdict.failed) puts(weft_judge_cause(verdict.causes[0].cause).help);
 *   weft_verdict_free(&verdict);
 *   weft_judge_free(judge);
 *
 * The path tracer renders the reference. An object is a set of triangles with one material, as a glTF primitive of one
 * node is. Its interior are the pixels around which all within WEFT_JUDGE_MARGIN pixels show the same object, so that
 * neither silhouettes nor filters of pixels count.
 *
 * A cell is what an object covers of a square of WEFT_JUDGE_CELL x WEFT_JUDGE_CELL pixels. With p, r and v the means of
 * picture, reference and another rendering over a cell of n pixels, s the standard error of r from the noise of its
 * samples, m the mean of the reference over the object and M over all of them, the error of the other rendering is
 *
 *   error(v) = sum n ((p - v)^2 - s^2) / (p^2 + v^2 + (0.1 m)^2 + (0.01 M)^2 + (10 s)^2)     over cells and channels
 *
 * or 0 where this is below 0: a cell counts by its relative difference, less where it is noisy, and what noise adds is
 * taken off. Its share of what sets the picture apart is 1 - error(v) / error(r): 1 where it is the picture, 0 where it
 * is no closer than the reference, less where it is further away. */
#ifndef WEFT_JUDGE_H
#define WEFT_JUDGE_H

#include "weft/image.h"
#include "weft/render.h"
#include "weft/scene.h"

#ifdef __cplusplus
extern "C" {
#endif

enum { WEFT_JUDGE_MARGIN = 2, WEFT_JUDGE_CELL = 4, WEFT_JUDGE_PIXELS_LEAST = 16 };

/* The reference, and what counts as a fault. Zero means default, in every member. */
typedef struct WeftJudgeDesc {
    /* size, camera, seed, threads, no_shadows and max_depth (0: 1, direct light) of all renderings; the rest is not
     * read */
    WeftRenderDesc render;
    int spp;          /* samples a pixel of all renderings; 0: 64 */
    double tolerance; /* largest relative difference of a mean; 0: 0.05 */
    double spread;    /* largest relative root of the mean squared difference over the cells; 0: 0.2 */
    double explained; /* least share of a cause that explains a picture, below 1; 0: 0.75 */
} WeftJudgeDesc;

/* A scene with its reference. */
typedef struct WeftJudge WeftJudge;

/* Renders the reference of a scene and finds its objects. The scene must outlive the judge; weft_judge_pictures changes
 * it and leaves it as it was. Fails with WEFT_MESSAGE_DESC where no object has an interior of WEFT_JUDGE_PIXELS_LEAST
 * pixels, and as weft_render_create does. progress (may be NULL) can stop it: WEFT_INTERRUPTED. */
WEFT_API WeftResult weft_judge_create(WeftScene *scene, const WeftJudgeDesc *desc, WeftProgress progress, void *user,
                                      WeftJudge **out, WeftError *error);

WEFT_API void weft_judge_free(WeftJudge *judge); /* may be NULL */

/* The counts of a reference, and what it was rendered with. */
typedef struct WeftJudgeInfo {
    int width, height;                                 /* pixels */
    int object_count;                                  /* objects with an interior */
    int left_out;                                      /* objects in the picture that are too small to be judged */
    int spp;                                           /* samples a pixel */
    WeftJudgeDesc desc;                                /* with the defaults filled in */
    float camera_eye[3], camera_target[3], camera_fov; /* what the camera resolved to; vertical, degrees */
} WeftJudgeInfo;

/* Returns the counts of a reference. */
WEFT_API WeftJudgeInfo weft_judge_info(const WeftJudge *judge);

/* An object and what is expected of it. */
typedef struct WeftJudgeObject {
    const char *name, *material; /* "" where the file gives none; owned by the scene */
    int mesh, material_index;    /* indices in the scene */
    int pixels;                  /* of its interior */
    float x, y;                  /* middle of the interior, pixels from the top left */
    float value[3];              /* mean of the reference over the interior, linear Rec. 709 radiance */
    float noise[3];              /* standard error of that mean, from the noise of the samples */
} WeftJudgeObject;

/* Fills in an object by its index and returns 1; returns 0 past the end. */
WEFT_API int weft_judge_object(const WeftJudge *judge, int index, WeftJudgeObject *out);

/* Returns the reference: F32 RGBA, linear. Owned by the judge. */
WEFT_API const WeftImage *weft_judge_reference(const WeftJudge *judge);

/* The kinds of causes: a term of the material, the composition of an engine, the lights, the values of the picture. */
typedef enum WeftCauseKind {
    WEFT_CAUSE_TERM = 0,
    WEFT_CAUSE_ENGINE,
    WEFT_CAUSE_LIGHT,
    WEFT_CAUSE_PICTURE,
    WEFT_CAUSE_KIND_COUNT
} WeftCauseKind;

/* Returns "term", "engine", "light" or "picture"; NULL beyond. */
WEFT_API const char *weft_cause_kind_name(int kind);

/* A cause of a difference between a picture and the reference. */
typedef struct WeftCause {
    const char *name, *help; /* live as long as the program; NULL past the last cause */
    WeftCauseKind kind;      /* what it is about */
} WeftCause;

/* Returns the cause at index; its name is NULL past the end. The engines are the profiles of weft_profile_name. */
WEFT_API WeftCause weft_judge_cause(int index);

/* A picture to judge. */
typedef struct WeftJudgePicture {
    /* of the reference's size; F32: linear radiance; else displayed values in sRGB, as `tone` shows the reference */
    const WeftImage *image;
    WeftTone tone;
    int linear_integers; /* not 0: integers are linear, 1 the largest, and `tone` is not used */
} WeftJudgePicture;

/* The share of a cause. */
typedef struct WeftCauseShare {
    int cause;    /* index of weft_judge_cause */
    double share; /* as above */
} WeftCauseShare;

/* The findings about an object. All values are linear light; of a displayed picture they are what the display emits. */
typedef struct WeftVerdictObject {
    float value[3];       /* mean of the picture over the interior */
    float expected[3];    /* of the reference, as the picture would show it */
    float off[3];         /* value - expected */
    double spread;        /* root of the mean squared difference over the cells, relative to max(m, 0.01 M) */
    int failed;           /* not 0: a mean or the spread is beyond its limit */
    WeftCauseShare cause; /* the best of this object where it failed; cause -1: none was sought */
} WeftVerdictObject;

/* The findings about a picture. */
typedef struct WeftVerdict {
    WeftVerdictObject *objects; /* those of the judge, in their order; owned */
    int object_count, failed;   /* failed: objects that did */
    WeftCauseShare *causes;     /* those tried, the best first; owned; none where no object failed */
    int cause_count;            /* of causes */
    int explained;              /* not 0: the share of the best is at least WeftJudgeDesc.explained */
} WeftVerdict;

/* Judges pictures. Where one has an object that fails, the scene is rendered under every cause that changes it, and all
 * such pictures are compared with each. verdicts receives `count` records, which weft_verdict_free releases. An object
 * fails where a channel of its mean is off by more than
 *
 *   tolerance max(expected, 0.1 e, 0.01 M) + 3 standard errors,        e the largest channel expected of it
 *
 * or its spread is above its limit by more than noise explains. Fails with WEFT_MESSAGE_DESC (another size) or _MEMORY,
 * and as weft_render_run does; WEFT_INTERRUPTED where progress (may be NULL) stopped it. *verdicts are then zero. */
WEFT_API WeftResult weft_judge_pictures(WeftJudge *judge, const WeftJudgePicture *pictures, int count,
                                        WeftProgress progress, void *user, WeftVerdict *verdicts, WeftError *error);

WEFT_API void weft_verdict_free(WeftVerdict *verdict); /* may be NULL */

#ifdef __cplusplus
}
#endif

#endif
