/* judge.h - a scene with its reference, its objects and their cells */
#pragma once

#include <stdbool.h>

#include "scene/record/scene.h"
#include "weft/judge.h"

enum { JUDGE_CHANNELS = 3 };

/* The part of an object in a square of pixels. */
typedef struct JudgeCell {
    int object, pixels;
} JudgeCell;

/* The means of a picture over the cells: one number a channel. */
typedef struct CellMean {
    double c[JUDGE_CHANNELS];
} CellMean;

struct WeftJudge {
    WeftScene *scene;
    WeftJudgeDesc desc; /* with defaults; desc.render is that of the reference */
    WeftRender *render;
    WeftImage reference;
    WeftJudgeObject *objects; /* object_count */
    int *cell_of;             /* index into cells of each pixel; -1: in no interior */
    JudgeCell *cells;         /* cell_count */
    CellMean *noise;          /* squared standard error of the reference over each cell */
    int object_count, left_out, cell_count;
};

/* Finds the objects, their interiors and cells. Fails with WEFT_MESSAGE_DESC where there is none. */
WeftResult judge_find_objects(WeftJudge *judge, WeftError *error);

/* Fills the means over the cells of an F32 picture of the reference's size; grey counts as a colour. */
void judge_cells(const WeftJudge *judge, const WeftImage *image, CellMean *means);

/* Fills the mean over an object of means over its cells. */
void judge_object_mean(const WeftJudge *judge, int object, const CellMean *means, double mean[JUDGE_CHANNELS]);

/* Makes an F32 picture of a linear one as `picture` would show it; of a picture that is linear, a copy. */
WeftResult judge_show(const WeftJudgePicture *picture, const WeftImage *linear, WeftImage *out, WeftError *error);

/* Makes the linear light of a picture to judge. */
WeftResult judge_linear(const WeftJudgePicture *picture, WeftImage *out, WeftError *error);

/* Renders the scene as it is now. */
WeftResult judge_render(WeftJudge *judge, const WeftRenderDesc *desc, unsigned changed, WeftProgress progress,
                        void *user, WeftImage *out, WeftError *error);

/* The scene as it was given, to be put back: what causes change of it. */
typedef struct SceneKept {
    Material *materials; /* material_count of them, owned */
    Light *lights;       /* light_count of them, owned */
    int material_count, light_count;
    Environment environment; /* with the pixels of the scene */
    SrgbTable srgb;
} SceneKept;

/* Copies what causes change. Release with scene_kept_free. */
WeftResult scene_keep(const WeftScene *scene, SceneKept *kept, WeftError *error);
void scene_kept_free(SceneKept *kept);

/* Returns the count of causes. */
int judge_cause_count(void);

/* Makes the picture that a cause gives. *made becomes false, and *out zero, where the cause changes nothing in this
 * scene. The scene is as it was afterwards. */
WeftResult judge_cause_render(WeftJudge *judge, int cause, const SceneKept *kept, WeftProgress progress, void *user,
                              WeftImage *out, bool *made, WeftError *error);

/* Returns true if a cause has no picture of its own, but changes the values of the reference as it is shown. */
bool judge_cause_is_of_values(int cause);

/* Returns true if a cause has a number that is fitted to the picture. */
bool judge_cause_is_fitted(int cause);

/* Fills the means over the cells as such a cause has them: r of the reference, p of the picture, scales
 * what the error divides by without r^2. */
void judge_cause_values(const WeftJudge *judge, int cause, const CellMean *p, const CellMean *r, const CellMean *scales,
                        CellMean *out);
