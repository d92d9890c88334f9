/* render.c - `weft render`: a scene becomes pictures */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>

#include "clock.h"
#include "interrupt.h"
#include "json.h"
#include "progress.h"
#include "report.h"
#include "request.h"
#include "verbs.h"
#include "weft/weft.h"

/* A request at work, and what is told of it in the end. */
typedef struct Job {
    const Request *request;
    WeftScene *scene;
    WeftRender *render;
    WeftRenderInfo info;
    double load_seconds;
    int width, height; /* of the picture, which a crop makes smaller */
    bool interrupted;
    char **warnings;
    int warning_count;
} Job;

/* Keeps the warning for --json and shows it. Short of memory it is only shown. */
static void job_warn(void *user, WeftMessage message, const char *text) {
    (void)message;
    Job *job = user;
    if (!job->request->quiet) report(0, "warning: %s", text);
    char **grown = realloc(job->warnings, (size_t)(job->warning_count + 1) * sizeof *grown);
    if (!grown) return;
    job->warnings = grown;
    if ((grown[job->warning_count] = strdup(text))) job->warning_count++;
}

/* Every --set. A material's name may hold '=' and '.', so the last of each divides. */
static WeftResult apply_sets(const Job *job, const WeftLog *log, WeftError *error) {
    WeftResult result = WEFT_OK;
    int cursor = 0;
    for (const char *text;
         result == WEFT_OK && (text = option_next(job->request->options, "--set", &cursor));) {
        char target[512];
        const char *equals = strrchr(text, '=');
        snprintf(target, sizeof target, "%.*s", (int)(equals - text), text);
        result = weft_scene_set(job->scene, target, equals + 1, log, error);
    }
    return result;
}

/* Loads the scene and dresses and lights it: the asset first, then ever more particular wishes. */
static WeftResult scene_open(Job *job, const WeftLog *log, WeftError *error) {
    const Request *request = job->request;
    const Options *options = request->options;
    const char *variant = option_text(options, "--variant"), *sheen = option_text(options, "--sheen"),
               *layer = option_text(options, "--layer"), *env = option_text(options, "--env");
    WeftResult result = weft_scene_load(request->scene, &job->scene, log, error);
    if (result == WEFT_OK && variant) result = weft_scene_set_variant(job->scene, variant, error);
    if (result == WEFT_OK && sheen) result = weft_scene_set(job->scene, "*.sheen_lobe", sheen, log, error);
    if (result == WEFT_OK && layer) result = weft_scene_set(job->scene, "*.layer", layer, log, error);
    if (result == WEFT_OK) result = apply_sets(job, log, error);
    if (result == WEFT_OK && request->env_is_color)
        result = weft_scene_set_environment_color(job->scene, request->env_color, error);
    else if (result == WEFT_OK && env)
        result = weft_scene_set_environment_file(job->scene, env, log, error);
    if (result == WEFT_OK)
        result = weft_scene_set_environment_placement(job->scene, (float)request->env_rotation,
                                                      (float)request->env_strength, error);
    return result;
}

static int on_progress(void *user, double fraction) {
    progress_draw(user, fraction);
    return interrupt_seen();
}

/* A failure that is this file's own. */
static WeftResult failure(WeftError *error, WeftResult result, const char *text) {
    error->result = result;
    snprintf(error->text, sizeof error->text, "%s", text);
    return result;
}

static double job_pixels(const Job *job) { return (double)job->width * job->height; }

static WeftResult nothing_written(WeftError *error) {
    return failure(error, WEFT_INTERRUPTED, "interrupted before the first sample; nothing was written");
}

/* Gathers the samples. An interruption is noted; only one before the first sample is a failure, for there is
 * nothing to write. */
static WeftResult trace(Job *job, WeftError *error) {
    const Request *request = job->request;
    WeftRenderDesc desc = request->desc;
    bool builtin = strncmp(request->scene, "builtin:", 8) == 0;
    if (interrupt_seen()) return nothing_written(error);
    if (!desc.camera && builtin && weft_scene_info(job->scene).camera_count > 0) desc.camera = "0";
    WeftResult result = weft_render_create(job->scene, &desc, &job->render, error);
    if (result != WEFT_OK) return result;
    if (interrupt_seen()) return nothing_written(error);

    int spp = request->spp ? request->spp : REQUEST_SPP_MOST;
    Progress progress =
        progress_start(request->quiet, request->spp, spp, job_pixels(job), request->time_limit);
    result = weft_render_run(job->render, spp, request->time_limit, on_progress, &progress);
    progress_finish(&progress);
    job->info = weft_render_info(job->render);
    job->interrupted = result == WEFT_INTERRUPTED;
    if (job->interrupted && !(job->info.samples_per_pixel > 0.0)) return nothing_written(error);
    if (job->interrupted) result = WEFT_OK;
    return result == WEFT_OK ? result : failure(error, result, "the render could not be finished");
}

/* Writes all outputs; one that fails does not keep the others from being written. */
static WeftResult outputs_write(const Job *job, WeftError *error) {
    WeftImage linear = {0}, display = {0};
    WeftResult result = weft_render_image(job->render, &linear, error);
    if (result == WEFT_OK)
        result = weft_image_tonemap(&linear, (WeftTonemap)job->request->tonemap,
                                    (float)job->request->exposure, &display, error);
    int cursor = 0;
    const char *path;
    WeftError other;
    bool made = result == WEFT_OK;
    while (made && (path = option_next(job->request->options, "-o", &cursor))) {
        WeftResult written = weft_image_write(path, weft_image_suffix_linear(path) ? &linear : &display,
                                              result == WEFT_OK ? error : &other);
        if (result == WEFT_OK) result = written;
    }
    weft_image_free(&linear);
    weft_image_free(&display);
    return result;
}

static double rate(double count, double seconds) { return seconds > 0.0 ? count / seconds : 0.0; }

static double samples_per_second(const Job *job) {
    return rate(job->info.samples_per_pixel * job_pixels(job), job->info.render_seconds);
}

static void summary(const Job *job) {
    char files[512] = "";
    int cursor = 0;
    for (const char *path; (path = option_next(job->request->options, "-o", &cursor));) {
        size_t used = strlen(files);
        snprintf(files + used, sizeof files - used, "%s%s", used ? ", " : "", path);
    }
    report(0, "%s%.4g samples/pixel in %.2f s, %.2f M samples/s; wrote %s",
           job->interrupted ? "interrupted at " : "", job->info.samples_per_pixel, job->info.render_seconds,
           1e-6 * samples_per_second(job), files);
}

static long long peak_memory(void) {
    struct rusage usage;
    return getrusage(RUSAGE_SELF, &usage) == 0 ? (long long)usage.ru_maxrss * 1024 : 0; /* Linux counts KiB */
}

static void figures(const Job *job) {
    const Request *request = job->request;
    const WeftRenderInfo *info = &job->info;
    int cursor = 0;
    Json json = {.stream = stdout};
    json_open(&json, NULL, '{');
    json_text(&json, "scene", request->scene);
    json_integer(&json, "triangles", weft_scene_info(job->scene).triangle_count);
    json_integer(&json, "width", job->width);
    json_integer(&json, "height", job->height);
    json_number(&json, "samples_per_pixel", info->samples_per_pixel);
    json_bool(&json, "interrupted", job->interrupted);
    json_open(&json, "seconds", '{');
    json_number(&json, "load", job->load_seconds);
    json_number(&json, "build", info->build_seconds);
    json_number(&json, "render", info->render_seconds);
    json_close(&json, '}');
    json_integer(&json, "rays", info->rays);
    json_number(&json, "samples_per_second", samples_per_second(job));
    json_number(&json, "rays_per_second", rate((double)info->rays, info->render_seconds));
    json_open(&json, "camera", '{');
    json_floats(&json, "eye", info->camera_eye, 3);
    json_floats(&json, "target", info->camera_target, 3);
    json_float(&json, "fov", info->camera_fov);
    json_close(&json, '}');
    json_integer(&json, "peak_memory_bytes", peak_memory());
    json_open(&json, "outputs", '[');
    for (const char *path; (path = option_next(request->options, "-o", &cursor));)
        json_text(&json, NULL, path);
    json_close(&json, ']');
    json_open(&json, "warnings", '[');
    for (int k = 0; k < job->warning_count; k++) json_text(&json, NULL, job->warnings[k]);
    json_close(&json, ']');
    json_close(&json, '}');
}

static WeftResult job_run(Job *job, WeftError *error) {
    WeftLog log = {.fn = job_warn, .user = job};
    double started = clock_seconds();
    WeftResult result = scene_open(job, &log, error);
    job->load_seconds = clock_seconds() - started;
    if (result == WEFT_OK) result = trace(job, error);
    if (result != WEFT_OK) return result;
    if (job->info.non_finite > 0) {
        char text[96];
        snprintf(text, sizeof text, "%lld samples were not finite and were left out", job->info.non_finite);
        job_warn(job, WEFT_MESSAGE_NONE, text);
    }
    return outputs_write(job, error);
}

static int render_run(const Options *options) {
    Request request;
    if (!request_read(options, &request)) return WEFT_USAGE;
    int result = request_outputs_check(options);
    if (result != 0) return result;

    interrupt_watch();
    const WeftRenderDesc *desc = &request.desc;
    Job job = {.request = &request,
               .width = desc->crop[2] ? desc->crop[2] : desc->width,
               .height = desc->crop[3] ? desc->crop[3] : desc->height};
    WeftError error = {0};
    result = (int)job_run(&job, &error);
    if (result != WEFT_OK) {
        report_error(&error);
    } else {
        if (!request.quiet) summary(&job);
        if (option_given(options, "--json")) figures(&job);
        if (job.interrupted) result = WEFT_INTERRUPTED;
    }
    weft_render_free(job.render);
    weft_scene_free(job.scene);
    for (int k = 0; k < job.warning_count; k++) free(job.warnings[k]);
    free(job.warnings);
    return result;
}

const Verb verb_render = {
    .name = "render",
    .operands = "SCENE -o OUT [options]",
    .help = "path traces a scene into pictures",
    .operands_least = 1,
    .operands_most = 1,
    .options = request_options,
    .notes = "SCENE is a .gltf or .glb file or builtin:NAME. Ctrl-C writes what there is and\n"
             "exits with 130. A picture appears under its name complete or not at all.\n\n"
             "Examples\n"
             "  weft render builtin:cloth -o cloth.png\n"
             "  weft render SheenChair.glb -o chair.png -o chair.exr --spp 256\n"
             "  weft render SheenChair.glb -o chair.png --variant \"Peacock Velvet\"\n"
             "  weft render velvet.glb -o velvet.png --time-limit 30 --env studio.hdr\n"
             "  weft render velvet.glb -o velvet.png --camera \"0,1,3;0,0.5,0;30\"\n"
             "  weft render velvet.glb -o velvet.png --sheen charlie-neubelt \\\n"
             "       --set '*.sheen_roughness=0.3'\n",
    .run = render_run,
};
