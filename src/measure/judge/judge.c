/* judge.c - the reference of a scene, and the values that are expected of its objects (weft/judge.h) */
#include "measure/judge/judge.h"

#include <math.h>
#include <stdlib.h>

#include "base/fail.h"
#include "base/memory.h"

static WeftResult desc_read(const WeftJudgeDesc *given, WeftJudgeDesc *desc, WeftError *error) {
    *desc = *given;
    desc->render = (WeftRenderDesc){.width = given->render.width ? given->render.width : 640,
                                    .height = given->render.height ? given->render.height : 480,
                                    .camera = given->render.camera,
                                    .seed = given->render.seed,
                                    .threads = given->render.threads,
                                    .no_shadows = given->render.no_shadows,
                                    .max_depth = given->render.max_depth ? given->render.max_depth : 1,
                                    .background = WEFT_BACKGROUND_TRANSPARENT,
                                    .halves = WEFT_HALVES_INDEPENDENT};
    weft_render_record(&desc->render, 1u << WEFT_AOV_VARIANCE);
    if (desc->spp == 0) desc->spp = 64;
    if (!(desc->tolerance > 0.0) && !(desc->tolerance < 0.0)) desc->tolerance = 0.05;
    if (!(desc->spread > 0.0) && !(desc->spread < 0.0)) desc->spread = 0.2;
    if (!(desc->explained > 0.0) && !(desc->explained < 0.0)) desc->explained = 0.75;
    if (desc->spp < 2) return fail(error, WEFT_MESSAGE_DESC, "samples a pixel", "%d; at least 2", desc->spp);
    if (desc->tolerance > 0.0 && desc->spread > 0.0 && desc->explained > 0.0 && desc->explained < 1.0) return WEFT_OK;
    return fail(error, WEFT_MESSAGE_DESC, "limits of a judge", "%g, %g and %g", desc->tolerance, desc->spread,
                desc->explained);
}

WeftResult judge_render(WeftJudge *judge, const WeftRenderDesc *desc, unsigned changed, WeftProgress progress,
                        void *user, WeftImage *out, WeftError *error) {
    *out = (WeftImage){0};
    WeftResult result = weft_render_restart(judge->render, desc, changed, error);
    if (result == WEFT_OK) result = weft_render_run(judge->render, judge->desc.spp, 0.0, progress, user);
    return result == WEFT_OK ? weft_render_image(judge->render, out, error) : result;
}

/* Fills the expected values of the objects from means over the cells, and the standard errors of both. */
static void expect_objects(WeftJudge *judge, const CellMean *means) {
    for (int k = 0; k < judge->object_count; k++) {
        WeftJudgeObject *object = &judge->objects[k];
        double mean[JUDGE_CHANNELS], variance[JUDGE_CHANNELS];
        judge_object_mean(judge, k, means, mean);
        judge_object_mean(judge, k, judge->noise, variance); /* of a pixel, on average */
        for (int c = 0; c < JUDGE_CHANNELS; c++) {
            object->value[c] = (float)mean[c];
            object->noise[c] = (float)sqrt(variance[c] / object->pixels);
        }
    }
    for (int k = 0; k < judge->cell_count; k++)
        for (int c = 0; c < JUDGE_CHANNELS; c++) judge->noise[k].c[c] /= judge->cells[k].pixels;
}

static WeftResult expect(WeftJudge *judge, WeftError *error) {
    WeftImage variance;
    CellMean *means = alloc_array((size_t)judge->cell_count, sizeof(CellMean));
    judge->noise = alloc_array((size_t)judge->cell_count, sizeof(CellMean));
    WeftResult result = means && judge->noise ? weft_render_aov(judge->render, WEFT_AOV_VARIANCE, &variance, error)
                                              : fail(error, WEFT_MESSAGE_MEMORY, judge->scene->name, NULL);
    if (result == WEFT_OK && means && judge->noise) {
        judge_cells(judge, &variance, judge->noise);
        judge_cells(judge, &judge->reference, means);
        expect_objects(judge, means);
        weft_image_free(&variance);
    }
    free(means);
    return result;
}

static WeftResult judge_make(WeftJudge *judge, WeftProgress progress, void *user, WeftError *error) {
    WeftResult result = weft_render_create(judge->scene, &judge->desc.render, &judge->render, error);
    if (result == WEFT_OK) result = judge_find_objects(judge, error);
    if (result == WEFT_OK)
        result = judge_render(judge, &judge->desc.render, 0, progress, user, &judge->reference, error);
    return result == WEFT_OK ? expect(judge, error) : result;
}

WeftResult weft_judge_create(WeftScene *scene, const WeftJudgeDesc *desc, WeftProgress progress, void *user,
                             WeftJudge **out, WeftError *error) {
    *out = NULL;
    WeftJudge *judge = alloc_array(1, sizeof *judge);
    if (!judge) return fail(error, WEFT_MESSAGE_MEMORY, scene->name, NULL);
    judge->scene = scene;
    WeftResult result = desc_read(desc, &judge->desc, error);
    if (result == WEFT_OK) result = judge_make(judge, progress, user, error);
    if (result == WEFT_OK)
        *out = judge;
    else
        weft_judge_free(judge);
    return result;
}

void weft_judge_free(WeftJudge *judge) {
    if (!judge) return;
    weft_render_free(judge->render);
    weft_image_free(&judge->reference);
    free(judge->objects);
    free(judge->cell_of);
    free(judge->cells);
    free(judge->noise);
    free(judge);
}

WeftJudgeInfo weft_judge_info(const WeftJudge *judge) {
    const WeftRenderInfo render = weft_render_info(judge->render);
    WeftJudgeInfo info = {.width = judge->desc.render.width,
                          .height = judge->desc.render.height,
                          .object_count = judge->object_count,
                          .left_out = judge->left_out,
                          .spp = judge->desc.spp,
                          .desc = judge->desc,
                          .camera_fov = render.camera_fov};
    for (int k = 0; k < 3; k++) {
        info.camera_eye[k] = render.camera_eye[k];
        info.camera_target[k] = render.camera_target[k];
    }
    return info;
}

int weft_judge_object(const WeftJudge *judge, int index, WeftJudgeObject *out) {
    if (index < 0 || index >= judge->object_count) return 0;
    *out = judge->objects[index];
    return 1;
}

const WeftImage *weft_judge_reference(const WeftJudge *judge) { return &judge->reference; }
