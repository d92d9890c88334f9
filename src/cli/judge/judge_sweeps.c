/* judge_sweeps.c - `weft judge --write`: spheres of weave, nap and measured fabric, and what is expected of them */
#define _XOPEN_SOURCE 700 /* folder.h */
#include <errno.h>
#include <stdio.h>
#include <string.h>

#include "base/folder.h"
#include "cli/console/output.h"
#include "cli/console/report.h"
#include "cli/judge/judge_verb.h"
#include "weft/weft.h"

enum { BALLS = 10, ROW = BALLS / 2, WORDS = 64, PATH_MOST = 4096 };

/* A file of spheres. */
typedef struct SphereSweep {
    const Options *options;
    const char *folder;
    char name[32];
    char words[BALLS][WORDS]; /* of each ball */
} SphereSweep;

/* Writes what ball k of the built-in scene is called. */
static void ball_name(int k, char name[16]) { snprintf(name, 16, "%s-%d", k < ROW ? "dark" : "light", k % ROW); }

static int path_make(const SphereSweep *sweep, const char *suffix, char path[PATH_MOST]) {
    if (snprintf(path, PATH_MOST, "%s/%s%s", sweep->folder, sweep->name, suffix) < PATH_MOST) return 0;
    return report(WEFT_USAGE, "--write: the name of the folder is too long");
}

/* Writes what is expected of the file at path, as it was saved. */
static int expected_write(const SphereSweep *sweep, const char *scene) {
    char path[PATH_MOST];
    JudgeRun run = {0};
    Output output;
    int result = path_make(sweep, ".json", path);
    if (result == 0 && !judge_read(&run, sweep->options, scene)) result = WEFT_USAGE;
    if (result == 0) result = judge_load(&run);
    if (result == 0) result = judge_make(&run);
    if (result == 0) result = output_begin(&output, path);
    if (result == 0) {
        judge_json(&run, output.stream, (const char(*)[WORDS])sweep->words, BALLS);
        result = output_end(&output);
    }
    if (result == 0 && !run.quiet) printf("%s and .json: %d objects\n", scene, weft_judge_info(run.judge).object_count);
    judge_close(&run);
    return result;
}

/* Saves the scene and writes what is expected of it. */
static int sweep_write(const SphereSweep *sweep, const WeftScene *scene) {
    char path[PATH_MOST];
    WeftError error;
    int result = path_make(sweep, ".glb", path);
    if (result != 0) return result;
    if (weft_scene_save(scene, path, &error) != WEFT_OK) return report_error(&error);
    return expected_write(sweep, path);
}

/* Puts a preset on ball k. */
static WeftResult preset_put(SphereSweep *sweep, WeftScene *scene, int k, const char *preset, WeftError *error) {
    char ball[16], path[WORDS];
    ball_name(k, ball);
    snprintf(path, sizeof path, "preset:%s", preset);
    snprintf(sweep->words[k], WORDS, "%s", preset);
    return weft_scene_assign_material(scene, ball, path, NULL, error);
}

/* Leans the fibres of a pile on ball k: more from ball to ball, in one row towards the tangent, in the other across. */
static WeftResult nap_put(SphereSweep *sweep, WeftScene *scene, int k, WeftError *error) {
    static const char *const inputs[] = {"nap", "nap_direction"};
    const int values[] = {10 * (k % ROW), k < ROW ? 0 : 90};
    char ball[16], target[48], value[16];
    ball_name(k, ball);
    WeftResult result = weft_scene_assign_material(scene, ball, "preset:velvet", NULL, error);
    for (int j = 0; j < 2 && result == WEFT_OK; j++) {
        snprintf(target, sizeof target, "%s.%s", ball, inputs[j]);
        snprintf(value, sizeof value, "%d", values[j]);
        result = weft_scene_set(scene, target, value, NULL, error);
    }
    snprintf(sweep->words[k], WORDS, "velvet, nap %d, nap_direction %d degrees", values[0], values[1]);
    return result;
}

static int group_size(const char *group) {
    int count = 0;
    for (int k = 0; weft_preset_name(k); k++) count += strcmp(weft_preset_group(k), group) == 0;
    return count;
}

/* Returns preset number `number` of a group, which begins again after its last one; NULL where it has none. */
static const char *preset_of(const char *group, int number) {
    const int count = group_size(group);
    for (int k = 0, seen = 0; count > 0 && weft_preset_name(k); k++)
        if (strcmp(weft_preset_group(k), group) == 0 && seen++ == number % count) return weft_preset_name(k);
    return NULL;
}

/* Makes one file; group NULL: of nap. */
static int sweep_make(SphereSweep *sweep, const char *group, int first) {
    WeftError error;
    WeftScene *scene;
    WeftResult result = weft_scene_load("builtin:spheres", &scene, NULL, &error);
    for (int k = 0; k < BALLS && result == WEFT_OK; k++)
        result =
            group ? preset_put(sweep, scene, k, preset_of(group, first + k), &error) : nap_put(sweep, scene, k, &error);
    int code = result == WEFT_OK ? sweep_write(sweep, scene) : report_error(&error);
    weft_scene_free(scene);
    return code;
}

static int group_make(SphereSweep *sweep, const char *name, const char *group) {
    int count = 0, result = 0;
    for (int k = 0; weft_preset_name(k); k++) count += strcmp(weft_preset_group(k), group) == 0;
    for (int k = 0; k < count && result == 0; k += BALLS) {
        snprintf(sweep->name, sizeof sweep->name, "%s-%d", name, 1 + k / BALLS);
        result = sweep_make(sweep, group, k);
    }
    return result;
}

int judge_sweeps(const Options *options, const char *folder) {
    SphereSweep sweep = {.options = options, .folder = folder, .name = "nap-1"};
    if (folder_create(folder) < 0)
        return report(WEFT_RESOURCES, "%.300s: the folder cannot be made: %s", folder, strerror(errno));
    int result = sweep_make(&sweep, NULL, 0);
    if (result == 0) result = group_make(&sweep, "weave", "woven");
    return result == 0 ? group_make(&sweep, "measured", "measured") : result;
}
