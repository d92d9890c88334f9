/* judge_json.c - the report of `weft judge` as JSON, for a build server */
#include <string.h>

#include "cli/console/json_writer.h"
#include "cli/judge/judge_verb.h"
#include "weft/weft.h"

/* Returns the name of the scene; of a sweep, which may be moved with its numbers, without its folder. */
static const char *name_of(const JudgeRun *run) {
    const char *path = run->scene_options.scene, *slash = strrchr(path, '/');
    return slash && option_given(run->options, "--write") ? slash + 1 : path;
}

static void scene_json(const JudgeRun *run, Json *json) {
    const WeftJudgeInfo info = weft_judge_info(run->judge);
    const char *profile = option_text(run->options, "--profile");
    char text[LIGHT_TEXT];
    WeftLight light;
    json_text(json, "scene", name_of(run));
    json_whole(json, "width", info.width);
    json_whole(json, "height", info.height);
    json_whole(json, "spp", info.spp);
    json_whole(json, "max_depth", info.desc.render.max_depth);
    json_bool(json, "shadows", !info.desc.render.no_shadows);
    json_text(json, "profile", profile ? profile : "none");
    json_open(json, "camera", '{');
    json_floats(json, "eye", info.camera_eye, 3);
    json_floats(json, "target", info.camera_target, 3);
    json_float(json, "fov", info.camera_fov);
    json_close(json, '}');
    json_open(json, "lights", '[');
    for (int k = 0; k < weft_scene_info(run->scene).light_count; k++) {
        if (weft_scene_light(run->scene, k, &light, NULL) != WEFT_OK) continue;
        judge_light_text(&light, text);
        json_text(json, NULL, text);
    }
    json_close(json, ']');
    judge_environment_text(run, text);
    json_text(json, "environment", text);
    json_number(json, "tolerance", info.desc.tolerance);
    json_number(json, "spread", info.desc.spread);
    json_number(json, "explained", info.desc.explained);
    json_whole(json, "left_out", info.left_out);
}

static void objects_json(const JudgeRun *run, Json *json, const char (*sweep)[64], int sweep_count) {
    WeftJudgeObject object;
    json_open(json, "objects", '[');
    for (int k = 0; weft_judge_object(run->judge, k, &object); k++) {
        const float middle[2] = {object.x, object.y};
        json_open(json, NULL, '{');
        json_text(json, "name", object.name);
        json_text(json, "material", object.material);
        if (sweep && object.material_index < sweep_count) json_text(json, "is", sweep[object.material_index]);
        json_whole(json, "mesh", object.mesh);
        json_whole(json, "pixels", object.pixels);
        json_floats(json, "middle", middle, 2);
        json_floats(json, "expected", object.value, 3);
        json_floats(json, "noise", object.noise, 3);
        json_close(json, '}');
    }
    json_close(json, ']');
}

static void cause_json(Json *json, const char *key, const WeftCauseShare *share) {
    const WeftCause cause = weft_judge_cause(share->cause);
    json_open(json, key, '{');
    json_text(json, "name", cause.name);
    json_text(json, "kind", weft_cause_kind_name((int)cause.kind));
    json_number(json, "share", share->share);
    json_text(json, "help", cause.help);
    json_close(json, '}');
}

static void found_json(Json *json, const WeftVerdictObject *found) {
    json_open(json, NULL, '{');
    json_floats(json, "value", found->value, 3);
    json_floats(json, "expected", found->expected, 3);
    json_floats(json, "off", found->off, 3);
    json_number(json, "spread", found->spread);
    json_bool(json, "failed", found->failed);
    if (found->cause.cause >= 0) cause_json(json, "cause", &found->cause);
    json_close(json, '}');
}

static void verdict_json(const JudgeRun *run, Json *json, int index) {
    const WeftVerdict *verdict = &run->verdicts[index];
    json_open(json, NULL, '{');
    json_text(json, "picture", run->paths[index]);
    json_whole(json, "failed", verdict->failed);
    if (verdict->failed) json_bool(json, "explained", verdict->explained);
    json_open(json, "objects", '[');
    for (int k = 0; k < verdict->object_count; k++) found_json(json, &verdict->objects[k]);
    json_close(json, ']');
    json_open(json, "causes", '[');
    for (int k = 0; k < verdict->cause_count; k++) cause_json(json, NULL, &verdict->causes[k]);
    json_close(json, ']');
    json_close(json, '}');
}

void judge_json(const JudgeRun *run, FILE *stream, const char (*sweep)[64], int sweep_count) {
    Json json = {.stream = stream};
    json_open(&json, NULL, '{');
    scene_json(run, &json);
    objects_json(run, &json, sweep, sweep_count);
    if (run->count) {
        json_open(&json, "pictures", '[');
        for (int k = 0; k < run->count; k++) verdict_json(run, &json, k);
        json_close(&json, ']');
    }
    json_close(&json, '}');
}
