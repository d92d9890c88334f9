#include "job.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>

#include "clock.h"
#include "interrupt.h"
#include "progress.h"
#include "report.h"
#include "weft/weft.h"

/* Keeps the line for --json and shows it. Short of memory it is only shown. */
void warnings_add(Warnings *warnings, bool grave, const char *text) {
    for (int k = 0; k < warnings->count; k++)
        if (strcmp(warnings->lines[k], text) == 0) return;
    if (!warnings->quiet) report(0, "%s%s", grave ? "warning: " : "", text);
    char **grown = realloc(warnings->lines, (size_t)(warnings->count + 1) * sizeof *grown);
    if (!grown) return;
    warnings->lines = grown;
    if ((grown[warnings->count] = strdup(text))) warnings->count++;
}

void warnings_free(Warnings *warnings) {
    for (int k = 0; k < warnings->count; k++) free(warnings->lines[k]);
    free(warnings->lines);
    *warnings = (Warnings){0};
}

static void warn(void *user, WeftMessage message, const char *text) {
    warnings_add(user, message != WEFT_MESSAGE_NONE, text);
}

WeftResult failure(WeftError *error, WeftResult result, const char *text) {
    error->result = result;
    snprintf(error->text, sizeof error->text, "%s", text);
    return result;
}

/* Loads the scene and dresses and lights it: the asset first, then ever more particular wishes. */
static WeftResult scene_open(Job *job, WeftScene **scene, WeftError *error) {
    const Request *request = job->request;
    const WeftLog log = {.fn = warn, .user = job->warnings};
    const char *env = option_text(request->options, "--env");
    WeftResult result = weft_scene_load(request->scene, scene, &log, error);
    if (result == WEFT_OK) result = dress_apply(&request->dress, job->number, *scene, &log, error);
    if (result == WEFT_OK && request->env_is_color)
        result = weft_scene_set_environment_color(*scene, request->env_color, error);
    else if (result == WEFT_OK && env)
        result = weft_scene_set_environment_file(*scene, env, &log, error);
    if (result == WEFT_OK)
        result = weft_scene_set_environment_placement(*scene, (float)request->env_rotation,
                                                      (float)request->env_strength, error);
    return result;
}

static int on_progress(void *user, double fraction) {
    progress_draw(user, fraction);
    return interrupt_seen();
}

static double job_pixels(const Job *job) { return (double)job->width * job->height; }

static WeftResult nothing_gathered(WeftError *error) {
    return failure(error, WEFT_INTERRUPTED, "interrupted before the first sample; nothing was written");
}

/* Gathers the samples. */
static WeftResult gather(Job *job, WeftRender *render, WeftError *error) {
    const Request *request = job->request;
    int spp = request->spp ? request->spp : REQUEST_SPP_MOST;
    double limit = request->time_limit / request->dress.count;
    char prefix[32] = "";
    if (request->dress.count > 1)
        snprintf(prefix, sizeof prefix, "%d/%d ", job->number + 1, request->dress.count);
    Progress progress = progress_start(request->quiet, prefix, request->spp, spp, job_pixels(job), limit);
    WeftResult result = weft_render_run(render, spp, limit, on_progress, &progress);
    progress_finish(&progress);
    job->info = weft_render_info(render);
    job->interrupted = result == WEFT_INTERRUPTED;
    if (job->interrupted && !(job->info.samples_per_pixel > 0.0)) return nothing_gathered(error);
    if (job->interrupted) result = WEFT_OK;
    return result == WEFT_OK ? result : failure(error, result, "the render could not be finished");
}

static WeftResult trace(Job *job, const WeftScene *scene, WeftRender **render, WeftError *error) {
    WeftRenderDesc desc = job->request->desc;
    bool builtin = strncmp(job->request->scene, "builtin:", 8) == 0;
    if (interrupt_seen()) return nothing_gathered(error);
    if (!desc.camera && builtin && weft_scene_info(scene).camera_count > 0) desc.camera = "0";
    WeftResult result = weft_render_create(scene, &desc, render, error);
    if (result != WEFT_OK) return result;
    if (interrupt_seen()) return nothing_gathered(error);
    result = gather(job, *render, error);
    if (result == WEFT_OK) result = weft_render_image(*render, &job->linear, error);
    if (result == WEFT_OK)
        result = weft_image_tonemap(&job->linear, (WeftTonemap)job->request->tonemap,
                                    (float)job->request->exposure, &job->display, error);
    return result;
}

WeftResult job_run(Job *job, WeftError *error) {
    const WeftRenderDesc *desc = &job->request->desc;
    WeftScene *scene = NULL;
    WeftRender *render = NULL;
    double started = clock_seconds();
    job->width = desc->crop[2] ? desc->crop[2] : desc->width;
    job->height = desc->crop[3] ? desc->crop[3] : desc->height;
    WeftResult result = scene_open(job, &scene, error);
    job->load_seconds = clock_seconds() - started;
    if (result == WEFT_OK) {
        job->triangles = weft_scene_info(scene).triangle_count;
        result = trace(job, scene, &render, error);
    }
    if (result == WEFT_OK && job->info.non_finite > 0) {
        char text[96];
        snprintf(text, sizeof text, "%lld samples were not finite and were left out", job->info.non_finite);
        warnings_add(job->warnings, true, text);
    }
    weft_render_free(render);
    weft_scene_free(scene);
    return result;
}

void job_free(Job *job) {
    weft_image_free(&job->linear);
    weft_image_free(&job->display);
}

static double rate(double count, double seconds) { return seconds > 0.0 ? count / seconds : 0.0; }

double job_samples_per_second(const Job *job) {
    return rate(job->info.samples_per_pixel * job_pixels(job), job->info.render_seconds);
}

static long long peak_memory(void) {
    struct rusage usage;
    return getrusage(RUSAGE_SELF, &usage) == 0 ? (long long)usage.ru_maxrss * 1024 : 0; /* Linux counts KiB */
}

void job_json(const Job *job, Json *json) {
    const Request *request = job->request;
    const WeftRenderInfo *info = &job->info;
    int cursor = 0;
    json_text(json, "scene", request->scene);
    json_integer(json, "triangles", job->triangles);
    json_integer(json, "width", job->width);
    json_integer(json, "height", job->height);
    json_number(json, "samples_per_pixel", info->samples_per_pixel);
    json_bool(json, "interrupted", job->interrupted);
    json_open(json, "seconds", '{');
    json_number(json, "load", job->load_seconds);
    json_number(json, "build", info->build_seconds);
    json_number(json, "render", info->render_seconds);
    json_close(json, '}');
    json_integer(json, "rays", info->rays);
    json_number(json, "samples_per_second", job_samples_per_second(job));
    json_number(json, "rays_per_second", rate((double)info->rays, info->render_seconds));
    json_open(json, "camera", '{');
    json_floats(json, "eye", info->camera_eye, 3);
    json_floats(json, "target", info->camera_target, 3);
    json_float(json, "fov", info->camera_fov);
    json_close(json, '}');
    json_integer(json, "peak_memory_bytes", peak_memory());
    json_open(json, "outputs", '[');
    for (const char *path; (path = option_next(request->options, "-o", &cursor));)
        json_text(json, NULL, path);
    json_close(json, ']');
    json_open(json, "warnings", '[');
    for (int k = 0; k < job->warnings->count; k++) json_text(json, NULL, job->warnings->lines[k]);
    json_close(json, ']');
}
