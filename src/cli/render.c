/* render.c - `weft render`: a scene becomes pictures */
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include "clock.h"
#include "interrupt.h"
#include "json.h"
#include "names.h"
#include "progress.h"
#include "report.h"
#include "verbs.h"
#include "weft/weft.h"

enum { SPP_MOST = 1 << 24 }; /* "until the time is up" */

static const Option render_options[] = {
    {NULL, NULL, "Pictures", NULL, 0, 0, false},
    {"-o", "OUT", "write OUT: .exr and .hdr linear, .png as displayed", NULL, 0, 0, true},
    {"--width", "PIXELS", "width of the picture", "960", 1, 65536, false},
    {"--height", "PIXELS", "height of the picture", "720", 1, 65536, false},
    {"--crop", "X,Y,W,H", "render these pixels only, from the top left", NULL, 0, 0, false},
    {"--exposure", "STOPS", "brighten a display-referred picture by 2^STOPS", "0", -32, 32, false},
    {"--tonemap", "CURVE", "none, pbr-neutral or aces", "pbr-neutral", 0, 0, false},
    {"--background", "WHAT", "auto, environment, transparent or a linear r,g,b", "auto", 0, 0, false},

    {NULL, NULL, "View and light", NULL, 0, 0, false},
    {"--camera", "CAMERA",
     "auto, which frames the scene, a camera's name or index, or \"eye;target;fov\" as "
     "\"x,y,z;x,y,z;degrees\" "
     "[auto; the first camera of a built-in scene]",
     NULL, 0, 0, false},
    {"--env", "FILE|r,g,b", "light from a lat-long picture, or one radiance from everywhere [a studio]", NULL,
     0, 0, false},
    {"--env-rotation", "DEGREES", "turn the environment about the vertical", "0", -1e6, 1e6, false},
    {"--env-strength", "FACTOR", "scale the environment", "1", 0, 1e6, false},

    {NULL, NULL, "Materials", NULL, 0, 0, false},
    {"--variant", "NAME", "switch to a material variant of the file", NULL, 0, 0, false},
    {"--sheen", "LOBE", "the lobe of every sheen; `weft models` lists them", NULL, 0, 0, false},
    {"--layer", "RULE", "how every sheen sits on its base", NULL, 0, 0, false},
    {"--set", "MAT.INPUT=VALUE",
     "set an input of material MAT (name, index or *) to a number or r,g,b; goes before all else", NULL, 0, 0,
     true},

    {NULL, NULL, "Sampling", NULL, 0, 0, false},
    {"--spp", "COUNT", "samples a pixel; without end where only --time-limit is given", "64", 1, SPP_MOST,
     false},
    {"--time-limit", "SECONDS", "stop then and write what there is", NULL, 1e-3, 1e9, false},
    {"--max-depth", "COUNT", "scattering events on a path; 1 is direct light", "9", 1, 1000, false},
    {"--sampling", "STRATEGY", "find lights by mis, light or lobe", "mis", 0, 0, false},
    {"--seed", "NUMBER", "another seed, other noise", "0", 0, 2147483647, false},
    {"--threads", "COUNT", "processors to use; no influence on the picture [all]", NULL, 1, 1024, false},

    {NULL, NULL, "Reports", NULL, 0, 0, false},
    {"--quiet", NULL, "no progress, no warnings, no summary", NULL, 0, 0, false},
    {"--json", NULL, "print a JSON object with figures on standard output", NULL, 0, 0, false},
    {0},
};

/* What the command line asks for, checked. */
typedef struct Request {
    const Options *options;
    const char *scene;
    WeftRenderDesc desc;
    int spp; /* 0: until the time is up */
    double time_limit, exposure, env_rotation, env_strength;
    int tonemap; /* WeftTonemap */
    bool env_is_color;
    float env_color[3];
    bool quiet;
} Request;

/* A request at work, and what is told of it in the end. */
typedef struct Job {
    const Request *request;
    WeftScene *scene;
    WeftRender *render;
    WeftRenderInfo info;
    double load_seconds, pixels;
    bool interrupted;
    char **warnings;
    int warning_count;
} Job;

/* --- the command line ---------------------------------------------------------------------------------- */

static bool colors(const char *text, float color[3]) {
    double c[3];
    if (!numbers_parse(text, 3, c) || c[0] < 0.0 || c[1] < 0.0 || c[2] < 0.0) return false;
    for (int k = 0; k < 3; k++) color[k] = (float)c[k];
    return true;
}

static bool read_crop(const Options *options, WeftRenderDesc *desc) {
    const char *text = option_text(options, "--crop");
    double v[4];
    if (!text) return true;
    bool good = numbers_parse(text, 4, v);
    for (int k = 0; good && k < 4; k++) {
        good = v[k] >= (k < 2 ? 0.0 : 1.0) && v[k] <= (k % 2 ? desc->height : desc->width) &&
               !(v[k] > floor(v[k]));
        if (good) desc->crop[k] = (int)v[k];
    }
    if (good && desc->crop[0] + desc->crop[2] <= desc->width && desc->crop[1] + desc->crop[3] <= desc->height)
        return true;
    report(WEFT_USAGE, "--crop: \"%s\" is not X,Y,W,H within %d x %d pixels", text, desc->width,
           desc->height);
    return false;
}

static bool read_background(const Options *options, WeftRenderDesc *desc) {
    static const char *const names[] = {"auto", "environment", "transparent", "a linear r,g,b", NULL};
    int choice = WEFT_BACKGROUND_COLOR;
    bool good = colors(option_text(options, "--background"), desc->background_color) ||
                (option_choice(options, "--background", names, &choice) && choice != WEFT_BACKGROUND_COLOR);
    desc->background = (WeftBackground)choice;
    return good;
}

static bool read_desc(const Options *options, WeftRenderDesc *desc) {
    static const char *const strategies[] = {"mis", "light", "lobe", NULL};
    int seed = 0, sampling = 0;
    bool good = option_integer(options, "--width", &desc->width) &&
                option_integer(options, "--height", &desc->height) && read_crop(options, desc) &&
                option_integer(options, "--max-depth", &desc->max_depth) &&
                option_integer(options, "--seed", &seed) &&
                option_integer(options, "--threads", &desc->threads) && read_background(options, desc) &&
                option_choice(options, "--sampling", strategies, &sampling);
    desc->seed = (uint32_t)seed;
    desc->sampling = (WeftSampling)sampling;
    desc->camera = option_text(options, "--camera");
    return good;
}

static bool check_sets(const Options *options) {
    int cursor = 0;
    for (const char *text; (text = option_next(options, "--set", &cursor));)
        if (!strchr(text, '.') || !strchr(text, '=')) {
            report(WEFT_USAGE, "--set: \"%s\" is not MATERIAL.INPUT=VALUE", text);
            return false;
        }
    return true;
}

static bool read_request(const Options *options, Request *request) {
    static const char *const curves[] = {"pbr-neutral", "aces", "none", NULL}; /* as WeftTonemap */
    *request = (Request){
        .options = options, .scene = options->operands[0], .quiet = option_given(options, "--quiet")};
    const char *env = option_text(options, "--env"), *sheen = option_text(options, "--sheen"),
               *layer = option_text(options, "--layer");
    request->env_is_color = env && colors(env, request->env_color);
    bool good = read_desc(options, &request->desc) && option_integer(options, "--spp", &request->spp) &&
                option_number(options, "--time-limit", &request->time_limit) &&
                option_number(options, "--exposure", &request->exposure) &&
                option_number(options, "--env-rotation", &request->env_rotation) &&
                option_number(options, "--env-strength", &request->env_strength) &&
                option_choice(options, "--tonemap", curves, &request->tonemap) &&
                (!sheen || lobe_named(sheen) >= 0) && (!layer || layer_named(layer) >= 0) &&
                check_sets(options);
    if (option_given(options, "--time-limit") && !option_given(options, "--spp")) request->spp = 0;
    return good;
}

/* Whether a file can come to be beside path, found out by making one. */
static int output_possible(const char *path) {
    struct stat status;
    size_t size = strlen(path) + 16;
    char *probe = malloc(size);
    if (!probe) return report(WEFT_RESOURCES, "out of memory");
    snprintf(probe, size, "%s.XXXXXX", path);
    int handle = -1, reason = EISDIR;
    if (stat(path, &status) != 0 || !S_ISDIR(status.st_mode)) {
        handle = mkstemp(probe);
        reason = errno;
    }
    if (handle >= 0) {
        close(handle);
        unlink(probe);
    }
    free(probe);
    if (handle >= 0) return 0;
    return report(WEFT_RESOURCES, "%s: %s: %s", path, weft_message_text(WEFT_MESSAGE_FILE_WRITE),
                  strerror(reason));
}

/* What can be known of the outputs before hours of rendering. */
static int outputs_check(const Options *options) {
    int cursor = 0, result = 0;
    if (!option_given(options, "-o"))
        return report(WEFT_USAGE, "render: needs -o OUT, a .png, .exr or .hdr file");
    for (const char *path; (path = option_next(options, "-o", &cursor));)
        if (!weft_image_suffix_known(path))
            return report(WEFT_USAGE, "%s: %s", path, weft_message_text(WEFT_MESSAGE_OUTPUT_SUFFIX));
    for (cursor = 0; result == 0;) {
        const char *path = option_next(options, "-o", &cursor);
        if (!path) break;
        result = output_possible(path);
    }
    return result;
}

/* --- the work ------------------------------------------------------------------------------------------ */

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
    if (result == WEFT_OK && sheen) result = weft_scene_set_sheen(job->scene, sheen, error);
    if (result == WEFT_OK && layer) result = weft_scene_set_layer(job->scene, layer, error);
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

/* Gathers the samples. */
static WeftResult trace(Job *job, WeftError *error) {
    const Request *request = job->request;
    WeftRenderDesc desc = request->desc;
    bool builtin = strncmp(request->scene, "builtin:", 8) == 0;
    if (!desc.camera && builtin && weft_scene_info(job->scene).camera_count > 0) desc.camera = "0";
    WeftResult result = weft_render_create(job->scene, &desc, &job->render, error);
    if (result != WEFT_OK) return result;

    job->pixels = desc.crop[2] ? (double)desc.crop[2] * desc.crop[3] : (double)desc.width * desc.height;
    int spp = request->spp ? request->spp : SPP_MOST;
    Progress progress = progress_start(request->quiet, request->spp, spp, job->pixels, request->time_limit);
    result = weft_render_run(job->render, spp, request->time_limit, on_progress, &progress);
    progress_finish(&progress);
    job->interrupted = result == WEFT_INTERRUPTED;
    job->info = weft_render_info(job->render);
    return job->interrupted ? WEFT_OK : result;
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

/* --- what is told -------------------------------------------------------------------------------------- */

static double rate(double count, double seconds) { return seconds > 0.0 ? count / seconds : 0.0; }

static void summary(const Job *job) {
    const Request *request = job->request;
    const WeftRenderInfo *info = &job->info;
    int cursor = 0;
    fprintf(stderr, "weft: %s%.4g samples/pixel in %.2f s, %.2f M samples/s;",
            job->interrupted ? "interrupted at " : "", info->samples_per_pixel, info->render_seconds,
            1e-6 * rate(info->samples_per_pixel * job->pixels, info->render_seconds));
    for (const char *path, *before = " wrote "; (path = option_next(request->options, "-o", &cursor));
         before = ", ")
        fprintf(stderr, "%s%s", before, path);
    fputc('\n', stderr);
}

static long long peak_memory(void) {
    struct rusage usage;
    return getrusage(RUSAGE_SELF, &usage) == 0 ? (long long)usage.ru_maxrss * 1024 : 0; /* Linux counts KiB */
}

static void figures(const Job *job) {
    const Request *request = job->request;
    const WeftRenderInfo *info = &job->info;
    const WeftRenderDesc *desc = &request->desc;
    int cursor = 0;
    Json json = {.stream = stdout};
    json_open(&json, NULL, '{');
    json_text(&json, "scene", request->scene);
    json_integer(&json, "triangles", weft_scene_info(job->scene).triangle_count);
    json_integer(&json, "width", desc->crop[2] ? desc->crop[2] : desc->width);
    json_integer(&json, "height", desc->crop[3] ? desc->crop[3] : desc->height);
    json_number(&json, "samples_per_pixel", info->samples_per_pixel);
    json_bool(&json, "interrupted", job->interrupted);
    json_open(&json, "seconds", '{');
    json_number(&json, "load", job->load_seconds);
    json_number(&json, "build", info->build_seconds);
    json_number(&json, "render", info->render_seconds);
    json_close(&json, '}');
    json_integer(&json, "rays", info->rays);
    json_number(&json, "samples_per_second",
                rate(info->samples_per_pixel * job->pixels, info->render_seconds));
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

/* --- the verb ------------------------------------------------------------------------------------------ */

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
    if (job->interrupted && !(job->info.samples_per_pixel > 0.0)) {
        snprintf(error->text, sizeof error->text, "interrupted before the first sample; nothing was written");
        return error->result = WEFT_INTERRUPTED;
    }
    return outputs_write(job, error);
}

static int render_run(const Options *options) {
    Request request;
    if (!read_request(options, &request)) return WEFT_USAGE;
    int result = outputs_check(options);
    if (result != 0) return result;

    interrupt_watch();
    Job job = {.request = &request};
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
    .options = render_options,
    .notes = "SCENE is a .gltf or .glb file or builtin:NAME. Ctrl-C writes what there is and exits with\n"
             "130. A picture appears under its name complete or not at all.\n\n"
             "Examples\n"
             "  weft render builtin:cloth -o cloth.png\n"
             "  weft render SheenChair.gltf -o chair.png -o chair.exr --spp 256\n"
             "  weft render SheenChair.glb -o chair.png --variant \"Peacock Velvet\" --time-limit 30\n"
             "  weft render cloth.glb -o cloth.png --sheen charlie-neubelt --set '*.sheen_roughness=0.3'\n"
             "  weft render cloth.glb -o cloth.png --camera \"0,1,3;0,0.5,0;30\" --env studio.hdr\n",
    .run = render_run,
};
