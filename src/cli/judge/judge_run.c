/* judge_run.c - options, scene, lights and pictures of `weft judge` */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/path.h"
#include "cli/console/interrupt.h"
#include "cli/console/progress.h"
#include "cli/console/report.h"
#include "cli/judge/judge_verb.h"
#include "weft/weft.h"

/* The light of a scene that has none of its own and is given none. */
static const WeftLight sun = {
    .kind = WEFT_LIGHT_DIRECTIONAL, .direction = {-1.0f, -1.0f, -2.0f}, .color = {3.1415927f, 3.1415927f, 3.1415927f}};

/* Refuses what a comparison with one reference cannot have. */
static bool check_scene_options(const JudgeRun *run) {
    static const char *const placements[] = {"--env-rotation", "--env-strength", "--env-ambient", "--env-reflection"};
    const SceneOptions *scene_options = &run->scene_options;
    if (scene_options->assignment.count > 1) {
        report(WEFT_USAGE, "%s: has several values; there is one reference",
               scene_options->assignment.varied[0].option);
        return false;
    }
    if (scene_options->meter_exposure || scene_options->find_white) {
        report(WEFT_USAGE, "%s: auto depends on the picture, which is judged; give the number it was shown with",
               scene_options->meter_exposure ? "--exposure" : "--white-balance");
        return false;
    }
    for (size_t k = 0; k < sizeof placements / sizeof *placements; k++)
        if (option_given(run->options, placements[k]) && !scene_options->env) {
            report(WEFT_USAGE, "%s: needs --env", placements[k]);
            return false;
        }
    return true;
}

bool judge_read(JudgeRun *run, const Options *options, const char *scene) {
    WeftJudgeDesc *desc = &run->desc;
    int seed = 0;
    run->options = options;
    run->quiet = option_given(options, "--quiet");
    bool good =
        scene_options_read(options, scene, &run->scene_options) && check_scene_options(run) &&
        option_integer(options, "--width", &desc->render.width) &&
        option_integer(options, "--height", &desc->render.height) &&
        option_integer(options, "--max-depth", &desc->render.max_depth) &&
        option_integer(options, "--threads", &desc->render.threads) && option_integer(options, "--seed", &seed) &&
        option_integer(options, "--spp", &desc->spp) && option_number(options, "--tolerance", &desc->tolerance) &&
        option_number(options, "--spread", &desc->spread) && option_number(options, "--explained", &desc->explained);
    desc->render.seed = (uint32_t)seed;
    desc->render.no_shadows = option_given(options, "--no-shadows");
    return good;
}

/* Lights the scene by what is given alone: without an environment there is none, and without any light the sun. */
static WeftResult light(JudgeRun *run, WeftError *error) {
    static const float black[3] = {0.0f, 0.0f, 0.0f};
    if (run->scene_options.env) return WEFT_OK;
    WeftResult result = weft_scene_set_environment_color(run->scene, black, error);
    const bool dark = weft_scene_info(run->scene).light_count == 0 && !option_given(run->options, "--light");
    return result == WEFT_OK && dark ? weft_scene_add_light(run->scene, &sun, error) : result;
}

int judge_load(JudgeRun *run) {
    WeftError error;
    const WeftLog log = {.fn = run->quiet ? NULL : report_warning};
    const SceneOptions *scene_options = &run->scene_options;
    WeftResult result =
        weft_scene_load_moment(scene_options->scene, scene_options->moves ? &scene_options->moment : NULL, NULL, NULL,
                               &run->scene, &log, &error);
    if (result == WEFT_OK) result = scene_options_apply(scene_options, 0, run->scene, &log, &error);
    if (result == WEFT_OK) result = light(run, &error);
    if (result != WEFT_OK) return report_error(&error);
    const bool has_camera = weft_scene_info(run->scene).camera_count > 0;
    run->desc.render.camera = scene_options->camera ? scene_options->camera : has_camera ? "0" : "auto";
    return 0;
}

static int interrupted(void) { return report(WEFT_INTERRUPTED, "interrupted; nothing was judged"); }

int judge_make(JudgeRun *run) {
    WeftError error;
    Progress progress = progress_start_count(run->quiet, "of the reference", 0.0);
    interrupt_watch();
    WeftResult result = weft_judge_create(run->scene, &run->desc, progress_heed, &progress, &run->judge, &error);
    progress_finish(&progress);
    return result == WEFT_OK ? 0 : result == WEFT_INTERRUPTED ? interrupted() : report_error(&error);
}

/* Gives the reference the size of the pictures, and refuses one of another size. */
static int check_sizes(JudgeRun *run) {
    WeftRenderDesc *render = &run->desc.render;
    if (!render->width && run->count > 0) render->width = run->images[0].width;
    if (!render->height && run->count > 0) render->height = run->images[0].height;
    if (!render->width) render->width = 640;
    if (!render->height) render->height = 480;
    for (int k = 0; k < run->count; k++)
        if (run->images[k].width != render->width || run->images[k].height != render->height)
            return report(WEFT_USAGE,
                          "%.300s: is %d x %d pixels, but the reference %d x %d; judge pictures of one size",
                          run->paths[k], run->images[k].width, run->images[k].height, render->width, render->height);
    return 0;
}

int judge_pictures_read(JudgeRun *run, const char *const *paths, int count) {
    WeftError error;
    const WeftLog log = {.fn = report_warning};
    const size_t places = count > 0 ? (size_t)count : 1;
    run->paths = paths;
    run->images = calloc(places, sizeof(WeftImage));
    run->pictures = calloc(places, sizeof(WeftJudgePicture));
    run->verdicts = calloc(places, sizeof(WeftVerdict));
    if (!run->images || !run->pictures || !run->verdicts) return report(WEFT_RESOURCES, "out of memory");
    for (int k = 0; k < count; k++) {
        if (weft_image_read(paths[k], &run->images[k], &log, &error) != WEFT_OK) return report_error(&error);
        run->pictures[k] = (WeftJudgePicture){.image = &run->images[k],
                                              .tone = run->scene_options.tone,
                                              .linear_integers = option_given(run->options, "--linear")};
        run->count = k + 1;
    }
    return check_sizes(run);
}

int judge_pictures(JudgeRun *run) {
    WeftError error;
    if (run->count == 0) return 0;
    Progress progress = progress_start_count(run->quiet, "of the causes", 0.0);
    WeftResult result =
        weft_judge_pictures(run->judge, run->pictures, run->count, progress_heed, &progress, run->verdicts, &error);
    progress_finish(&progress);
    return result == WEFT_OK ? 0 : result == WEFT_INTERRUPTED ? interrupted() : report_error(&error);
}

void judge_close(JudgeRun *run) {
    for (int k = 0; k < run->count; k++) {
        weft_image_free(&run->images[k]);
        weft_verdict_free(&run->verdicts[k]);
    }
    free(run->images);
    free(run->pictures);
    free(run->verdicts);
    weft_judge_free(run->judge);
    weft_scene_free(run->scene);
}

const WeftCauseShare *judge_best(const WeftVerdict *verdict, WeftCauseKind kind) {
    for (int k = 0; k < verdict->cause_count; k++)
        if (weft_judge_cause(verdict->causes[k].cause).kind == kind) return &verdict->causes[k];
    return NULL;
}

void judge_light_text(const WeftLight *light, char text[LIGHT_TEXT]) {
    static const char *const kinds[] = {"sun", "point", "spot", "polygon"};
    const float *p = light->position, *d = light->direction, *c = light->color;
    char place[120] = "", way[120] = "", end[64] = "";
    if (light->kind != WEFT_LIGHT_DIRECTIONAL)
        snprintf(place, sizeof place, ";%.6g,%.6g,%.6g", (double)p[0], (double)p[1], (double)p[2]);
    if (light->kind != WEFT_LIGHT_POINT)
        snprintf(way, sizeof way, ";%.6g,%.6g,%.6g", (double)d[0], (double)d[1], (double)d[2]);
    if (light->kind == WEFT_LIGHT_SPOT)
        snprintf(end, sizeof end, ";%.6g,%.6g", (double)light->inner, (double)light->outer);
    if (light->kind == WEFT_LIGHT_POLYGON)
        snprintf(end, sizeof end, ";%d,%.6g", light->corners ? light->corners : 4, (double)light->roll);
    char size[64] = "";
    if (light->kind == WEFT_LIGHT_POLYGON)
        snprintf(size, sizeof size, ";%.6g,%.6g", (double)light->size[0], (double)light->size[1]);
    snprintf(text, LIGHT_TEXT, "%s%s%s%s;%.6g,%.6g,%.6g%s", kinds[light->kind], place, way, size, (double)c[0],
             (double)c[1], (double)c[2], end);
}

void judge_environment_text(const JudgeRun *run, char text[LIGHT_TEXT]) {
    const SceneOptions *scene_options = &run->scene_options;
    const float *c = scene_options->env_color;
    if (!scene_options->env)
        snprintf(text, LIGHT_TEXT, "none");
    else if (scene_options->env_is_color)
        snprintf(text, LIGHT_TEXT, "radiance %.6g, %.6g, %.6g times %.6g", (double)c[0], (double)c[1], (double)c[2],
                 scene_options->env_strength);
    else
        snprintf(text, LIGHT_TEXT, "%.200s, rotated by %.6g degrees, times %.6g", scene_options->env,
                 scene_options->env_rotation, scene_options->env_strength);
}
