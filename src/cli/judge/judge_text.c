/* judge_text.c - the report of `weft judge` for people */
#include <stdio.h>
#include <string.h>

#include "base/printable.h"
#include "cli/console/report.h"
#include "cli/console/two_columns.h"
#include "cli/judge/judge_verb.h"
#include "weft/weft.h"

enum { COLUMN = 15, NAME = 22 };

/* Writes a name in a column of NAME bytes, cut where it is longer. */
static void name_column(const char *name) {
    char text[NAME + 1];
    snprintf(text, sizeof text, "%s", *name ? name : "unnamed");
    make_printable(text);
    printf("  %-*s", NAME, text);
}

static void lights_text(const JudgeRun *run) {
    char text[LIGHT_TEXT];
    WeftLight light;
    const int count = weft_scene_info(run->scene).light_count;
    for (int k = 0; k < count; k++) {
        if (weft_scene_light(run->scene, k, &light, NULL) != WEFT_OK) continue;
        judge_light_text(&light, text);
        layout_entry(stdout, COLUMN, "light", text);
    }
    judge_environment_text(run, text);
    make_printable(text);
    layout_entry(stdout, COLUMN, "environment", text);
}

static void head_text(const JudgeRun *run, const WeftJudgeInfo *info) {
    char text[LIGHT_TEXT];
    const float *e = info->camera_eye, *t = info->camera_target;
    const char *profile = option_text(run->options, "--profile");
    print_name(run->scene_options.scene);
    printf(": %d objects, %d x %d pixels, %d samples a pixel\n", info->object_count, info->width, info->height,
           info->spp);
    snprintf(text, sizeof text, "%.6g,%.6g,%.6g;%.6g,%.6g,%.6g;%.6g", (double)e[0], (double)e[1], (double)e[2],
             (double)t[0], (double)t[1], (double)t[2], (double)info->camera_fov);
    layout_entry(stdout, COLUMN, "camera", text);
    lights_text(run);
    snprintf(text, sizeof text, "%s, %s, profile %s",
             info->desc.render.max_depth > 1 ? "with light between surfaces" : "direct light alone",
             info->desc.render.no_shadows ? "without shadows" : "with shadows", profile ? profile : "none");
    layout_entry(stdout, COLUMN, "shading", text);
    if (info->left_out) {
        snprintf(text, sizeof text, "%d objects, of fewer than %d pixels without their outline", info->left_out,
                 WEFT_JUDGE_PIXELS_LEAST);
        layout_entry(stdout, COLUMN, "left out", text);
    }
}

static void expected_text(const JudgeRun *run) {
    WeftJudgeObject object;
    printf("\n  %3s  %-*s  %-*s  %5s %5s  %7s  %-26s  %s\n", "#", NAME, "object", NAME, "material", "x", "y", "pixels",
           "expected r, g, b, linear", "noise");
    for (int k = 0; weft_judge_object(run->judge, k, &object); k++) {
        printf("  %3d", k);
        name_column(object.name);
        name_column(object.material);
        float noise = object.noise[0];
        for (int c = 1; c < 3; c++)
            if (object.noise[c] > noise) noise = object.noise[c];
        printf("  %5.0f %5.0f  %7d  %8.5f %8.5f %8.5f  %.1g\n", (double)object.x, (double)object.y, object.pixels,
               (double)object.value[0], (double)object.value[1], (double)object.value[2], (double)noise);
    }
}

static double percent(float off, float expected) { return expected > 0.0f ? 100.0 * (double)(off / expected) : 0.0; }

static void object_text(const JudgeRun *run, const WeftVerdictObject *found, int index) {
    WeftJudgeObject object;
    weft_judge_object(run->judge, index, &object);
    printf("  %3d", index);
    name_column(object.name);
    for (int c = 0; c < 3; c++) printf(" %+8.5f", (double)found->off[c]);
    for (int c = 0; c < 3; c++) printf(" %+6.1f", percent(found->off[c], found->expected[c]));
    printf("  %6.3f  %s", found->spread, found->failed ? "fails" : "good");
    if (found->cause.cause >= 0)
        printf(": %s %.0f %%", weft_judge_cause(found->cause.cause).name, 100.0 * found->cause.share);
    printf("\n");
}

static void share_text(const char *title, const WeftCauseShare *share) {
    char text[240];
    const WeftCause cause = weft_judge_cause(share->cause);
    snprintf(text, sizeof text, "%s (%s), %.1f %% of the squared error: %s", cause.name,
             weft_cause_kind_name((int)cause.kind), 100.0 * share->share, cause.help);
    layout_entry(stdout, COLUMN, title, text);
}

/* Writes the likely cause, the runner-up, and the best term where an engine or a light is ahead of it. */
static void causes_text(const WeftVerdict *verdict) {
    const WeftCauseShare *term = judge_best(verdict, WEFT_CAUSE_TERM);
    if (verdict->cause_count == 0) return;
    if (!verdict->explained) layout_entry(stdout, COLUMN, "cause", "none explains it; the closest are:");
    share_text(verdict->explained ? "cause" : "closest", &verdict->causes[0]);
    if (verdict->cause_count > 1) share_text("next", &verdict->causes[1]);
    if (term && term > &verdict->causes[1]) share_text("best term", term);
}

static void verdict_text(const JudgeRun *run, int index) {
    const WeftVerdict *verdict = &run->verdicts[index];
    const WeftJudgePicture *picture = &run->pictures[index];
    const bool integers = picture->image->type != WEFT_PIXEL_F32;
    printf("\n");
    print_name(run->paths[index]);
    if (integers && !picture->linear_integers)
        printf(": sRGB, shown through %s at %+g stops\n", weft_tonemap_name((int)picture->tone.curve),
               (double)picture->tone.exposure);
    else
        printf(": linear%s\n", integers ? " integers" : "");
    printf("  %3s  %-*s %-27s %-21s %7s\n", "#", NAME, "object", " off by r, g, b, linear", " off by, %", "spread");
    for (int k = 0; k < verdict->object_count; k++) object_text(run, &verdict->objects[k], k);
    causes_text(verdict);
}

void judge_text(const JudgeRun *run) {
    const WeftJudgeInfo info = weft_judge_info(run->judge);
    head_text(run, &info);
    expected_text(run);
    for (int k = 0; k < run->count; k++) verdict_text(run, k);
}
