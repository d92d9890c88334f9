#include "request.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "names.h"
#include "output.h"
#include "report.h"

const Option request_options[] = {
    OPTION_HEADING("Pictures"),
    OPTION_LIST("-o", "OUT",
                "write OUT: .exr, .hdr and .npy linear, .png as displayed; of several pictures a sheet with "
                "their differences, .png"),
    OPTION_NUMBER("--width", "PIXELS", "960", 1, 65536, "width of the picture"),
    OPTION_NUMBER("--height", "PIXELS", "720", 1, 65536, "height of the picture"),
    OPTION_TEXT("--crop", "X,Y,W,H", NULL, "render these pixels only, from the top left"),
    OPTION_NUMBER("--exposure", "STOPS", "0", -32, 32, "brighten a .png by 2^STOPS"),
    OPTION_TEXT("--tonemap", "CURVE", "pbr-neutral", "of a .png: none, pbr-neutral or aces"),
    OPTION_TEXT("--background", "WHAT", "auto", "auto, environment, transparent or a linear r,g,b"),

    OPTION_HEADING("View and light"),
    OPTION_TEXT("--camera", "CAMERA", NULL,
                "auto, which frames the scene, a camera's name or index, or \"eye;target;fov\" as "
                "\"x,y,z;x,y,z;degrees\" [auto; the first camera of a built-in scene]"),
    OPTION_TEXT(
        "--env", "FILE|r,g,b", NULL,
        "light from a lat-long picture, or one radiance (r,g,b or a number) from everywhere [a studio]"),
    OPTION_NUMBER("--env-rotation", "DEGREES", "0", -1e6, 1e6, "turn the environment about the vertical"),
    OPTION_NUMBER("--env-strength", "FACTOR", "1", 0, 1e6, "scale the environment"),
    OPTION_LIST(
        "--light", "LIGHT",
        "add a light: \"sun;DIRECTION;COLOR\", \"point;POSITION;COLOR\", "
        "\"spot;POSITION;DIRECTION;COLOR;INNER,OUTER\" or "
        "\"polygon;POSITION;DIRECTION;W,H;COLOR;CORNERS,ROLL\", each x,y,z or r,g,b, cones and roll in "
        "degrees, 3 to 8 corners; none drops those before it, the file's too"),
    OPTION_NUMBER("--turntable", "COUNT", NULL, 1, 10000,
                  "so many pictures on a circle around the scene; OUT gets a number before its suffix"),

    DRESS_OPTIONS,

    OPTION_HEADING("Engine"),
    OPTION_TEXT("--engine", "ENGINE", "trace",
                "trace, the reference; raster, OpenGL; or both on a sheet, with their difference"),
    OPTION_TEXT("--gl", "KIND", "desktop", "raster: desktop, OpenGL 3.3, or es, OpenGL ES 3.0"),
    OPTION_NUMBER("--msaa", "COUNT", "4", 1, 64,
                  "raster: samples a pixel at edges, as far as the driver goes"),
    OPTION_TEXT(
        "--ambient", "STRATEGY", "best",
        "raster: light from the environment by irradiance, mirror or fitted, by the best of them for each "
        "lobe, or none"),
    OPTION_NUMBER(
        "--occlusion", "RAYS", "64", 0, 4096,
        "raster: look from each vertex along so many rays, for what lies in creases and in shadow of a map"),
    OPTION_NUMBER("--polygons", "COUNT", "8", 0, WEFT_RASTER_POLYGONS,
                  "raster: light by so many of the scene's emissive polygons, the strongest"),
    OPTION_TEXT(
        "--part", "PART", "all",
        "raster: all, or the light of one slot: diffuse, specular, sheen, coat or dust; or a property: "
        "base-color, normal, roughness, sheen-color, sheen-roughness or texcoord"),
    OPTION_TEXT("--shader-dir", "DIR", NULL, "raster: shader text found here wins over the built-in one"),

    OPTION_HEADING("Sampling of the path tracer"),
    OPTION_NUMBER("--spp", "COUNT", "64", 1, REQUEST_SPP_MOST,
                  "samples a pixel; without end where only --time-limit is given"),
    OPTION_NUMBER("--time-limit", "SECONDS", NULL, 1e-3, 1e9, "stop then and write what there is"),
    OPTION_NUMBER("--max-depth", "COUNT", "9", 1, 1000, "scattering events on a path; 1 is direct light"),
    OPTION_TEXT("--sampling", "STRATEGY", "mis", "find lights by mis, light or lobe"),
    OPTION_NUMBER("--seed", "NUMBER", "0", 0, 2147483647, "another seed, other noise"),
    OPTION_NUMBER("--threads", "COUNT", NULL, 1, WEFT_THREADS_MAX,
                  "processors to use, 1 to 256; no influence on the picture [all]"),

    OPTION_HEADING("Reports"),
    OPTION_SWITCH("--quiet", "no progress, no warnings, no summary"),
    OPTION_SWITCH("--json", "print figures on standard output: a JSON object, of a sheet an array of them"),
    OPTION_END,
};

/* "r,g,b", or one number for all three. */
static bool colors_parse(const char *text, double c[3]) {
    if (!numbers_parse(text, 1, c)) return numbers_parse(text, 3, c);
    c[1] = c[2] = c[0];
    return true;
}

static bool colors(const char *text, float color[3]) {
    double c[3];
    bool good = colors_parse(text, c);
    for (int k = 0; good && k < 3; k++) {
        good = c[k] >= 0.0 && c[k] <= 1e30;
        if (good) color[k] = (float)c[k];
    }
    return good;
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
    report(WEFT_USAGE, "--crop: \"%.80s\" is not X,Y,W,H within %d x %d pixels", text, desc->width,
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

/* The next part of a text, up to a semicolon, as numbers. */
static bool take_numbers(const char **text, int count, float *out) {
    char part[128];
    double v[3];
    size_t size = strcspn(*text, ";");
    if (size == 0 || size >= sizeof part) return false;
    memcpy(part, *text, size);
    part[size] = '\0';
    *text += size + ((*text)[size] == ';');
    if (!numbers_parse(part, count, v)) return false;
    for (int k = 0; k < count; k++) out[k] = (float)v[k];
    return true;
}

static bool parse_light(const char *text, WeftLight *light) {
    static const char *const prefixes[] = {"sun;", "point;", "spot;", "polygon;"}; /* as WeftLightKind */
    float cone[2] = {0.0f, 45.0f}, shape[2] = {4.0f, 0.0f};
    int kind = 0;
    while (kind <= WEFT_LIGHT_POLYGON && strncmp(text, prefixes[kind], strlen(prefixes[kind])) != 0) kind++;
    if (kind > WEFT_LIGHT_POLYGON) return false;
    *light = (WeftLight){.kind = (WeftLightKind)kind};
    text += strlen(prefixes[kind]);
    bool polygon = kind == WEFT_LIGHT_POLYGON;
    bool good = (kind == WEFT_LIGHT_DIRECTIONAL || take_numbers(&text, 3, light->position)) &&
                (kind == WEFT_LIGHT_POINT || take_numbers(&text, 3, light->direction)) &&
                (!polygon || take_numbers(&text, 2, light->size)) && take_numbers(&text, 3, light->color);
    if (good && kind == WEFT_LIGHT_SPOT && *text) good = take_numbers(&text, 2, cone);
    if (good && polygon && *text) good = take_numbers(&text, 2, shape);
    good = good && shape[0] >= 3.0f && shape[0] <= 8.0f && !(shape[0] > floorf(shape[0]));
    if (!good || *text) return false;
    light->inner = cone[0];
    light->outer = cone[1];
    light->corners = polygon ? (int)shape[0] : 0;
    light->roll = shape[1];
    return true;
}

static bool read_lights(const Options *options, Request *request) {
    int cursor = 0;
    for (const char *text; (text = option_next(options, "--light", &cursor));) {
        if (strcmp(text, "none") == 0) {
            request->light_count = 0;
            request->no_lights = true;
            continue;
        }
        if (request->light_count == REQUEST_LIGHTS_MOST) {
            report(WEFT_USAGE, "--light: more than %d", REQUEST_LIGHTS_MOST);
            return false;
        }
        if (!parse_light(text, &request->lights[request->light_count++])) {
            report(WEFT_USAGE,
                   "--light: \"%.80s\" is not none, sun;x,y,z;r,g,b, point;x,y,z;r,g,b, "
                   "spot;x,y,z;x,y,z;r,g,b;inner,outer or polygon;x,y,z;x,y,z;w,h;r,g,b;corners,roll",
                   text);
            return false;
        }
    }
    return true;
}

/* What goes with a choice of engine, and what does not. */
static bool read_engine(const Options *options, Request *request) {
    static const char *const engines[] = {"trace", "raster", "both", NULL}; /* as Engine */
    static const char *const gl_versions[] = {"desktop", "es", NULL};       /* as WeftGl */
    static const char *const ambients[] = {"best",   "irradiance", "mirror",
                                           "fitted", "none",       NULL}; /* as WeftAmbient */
    const char *parts[WEFT_PART_COUNT + 1];
    int engine = 0, kind = 0, ambient = 0, part = 0, occlusion = 0;
    for (int k = 0; k <= WEFT_PART_COUNT; k++) parts[k] = weft_part_name(k);
    bool good = option_choice(options, "--engine", engines, &engine) &&
                option_choice(options, "--gl", gl_versions, &kind) &&
                option_choice(options, "--ambient", ambients, &ambient) &&
                option_choice(options, "--part", parts, &part) &&
                option_integer(options, "--msaa", &request->msaa) &&
                option_integer(options, "--polygons", &request->polygons) &&
                option_integer(options, "--occlusion", &occlusion) &&
                option_integer(options, "--turntable", &request->turntable) && read_lights(options, request);
    request->engine = (Engine)engine;
    request->ambient = (WeftAmbient)ambient;
    request->part = (WeftPart)part;
    request->raster = (WeftRasterDesc){.gl = (WeftGl)kind,
                                       .shader_dir = option_text(options, "--shader-dir"),
                                       .threads = request->desc.threads,
                                       .occlusion = occlusion};
    if (good && part && request->engine != ENGINE_RASTER) {
        report(WEFT_USAGE, "--part: needs --engine raster, the path tracer has no parts");
        return false;
    }
    if (good && request->engine == ENGINE_BOTH && request->dress.count > 1) {
        report(WEFT_USAGE, "--engine both: %s has several ids already; one option may",
               request->dress.varied);
        return false;
    }
    if (good && request->turntable && request_count(request) > 1) {
        report(WEFT_USAGE, "--turntable: turns one picture, not a sheet of several");
        return false;
    }
    return good;
}

int request_count(const Request *request) {
    return request->engine == ENGINE_BOTH ? 2 : request->dress.count;
}

/* What reads as a color is a radiance and never the name of a file. */
static bool read_env(const Options *options, Request *request) {
    const char *text = option_text(options, "--env");
    double c[3];
    request->env_is_color = text && colors_parse(text, c);
    if (!request->env_is_color || colors(text, request->env_color)) return true;
    report(WEFT_USAGE, "--env: \"%.80s\" is not a radiance, which is from 0 to 1e30", text);
    return false;
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

/* Whether what begins with "builtin:" is built in. */
static bool check_scene(const char *scene) {
    static const char prefix[] = "builtin:";
    if (strncmp(scene, prefix, strlen(prefix)) != 0) return true;
    const char *name = scene + strlen(prefix);
    Nearest nearest = {.typed = name};
    char list[256] = "", hint[96];
    for (int k = 0; weft_builtin_name(k); k++) {
        if (strcmp(weft_builtin_name(k), name) == 0) return true;
        nearest_offer(&nearest, weft_builtin_name(k));
        snprintf(list + strlen(list), sizeof list - strlen(list), "%s%s", k ? ", " : "",
                 weft_builtin_name(k));
    }
    report(WEFT_USAGE, "%.200s: %s: there is %s%s", scene, weft_message_text(WEFT_MESSAGE_SCENE_NAME), list,
           nearest_hint(&nearest, hint, sizeof hint));
    return false;
}

bool request_read(const Options *options, Request *request) {
    static const char *const curves[] = {"pbr-neutral", "aces", "none", NULL}; /* as WeftTonemap */
    *request = (Request){
        .options = options, .scene = options->operands[0], .quiet = option_given(options, "--quiet")};
    bool good = check_scene(request->scene) && read_desc(options, &request->desc) &&
                read_env(options, request) && option_integer(options, "--spp", &request->spp) &&
                option_number(options, "--time-limit", &request->time_limit) &&
                option_number(options, "--exposure", &request->exposure) &&
                option_number(options, "--env-rotation", &request->env_rotation) &&
                option_number(options, "--env-strength", &request->env_strength) &&
                option_choice(options, "--tonemap", curves, &request->tonemap) &&
                dress_read(options, &request->dress) && read_engine(options, request);
    if (option_given(options, "--time-limit") && !option_given(options, "--spp")) request->spp = 0;
    return good;
}

int request_outputs_check(const Request *request) {
    const Options *options = request->options;
    int cursor = 0, result = 0;
    if (!option_given(options, "-o"))
        return report(WEFT_USAGE, "render: needs -o OUT, a .png, .exr, .hdr or .npy file");
    for (const char *path; (path = option_next(options, "-o", &cursor));)
        if (!weft_image_suffix_known(path))
            return report(WEFT_USAGE, "%s: %s", path, weft_message_text(WEFT_MESSAGE_OUTPUT_SUFFIX));
        else if (request_count(request) > 1 && weft_image_suffix_linear(path))
            return report(WEFT_USAGE, "%s: a sheet of several pictures is for looking at; write a .png",
                          path);
    for (cursor = 0; result == 0;) {
        const char *path = option_next(options, "-o", &cursor);
        if (!path) break;
        result = output_probe(path);
    }
    return result;
}

/* "out.png" and "007" as "out-007.png"; NULL where memory is short. */
static char *numbered(const char *path, const char *number) {
    const char *slash = strrchr(path, '/'), *dot = strrchr(path, '.');
    size_t size = strlen(path) + strlen(number) + 2;
    int stem = dot && (!slash || dot > slash) ? (int)(dot - path) : (int)strlen(path);
    char *name = malloc(size);
    if (name) snprintf(name, size, "%.*s-%s%s", stem, path, number, path + stem);
    return name;
}

WeftResult request_outputs_write(const Request *request, const char *number, const WeftImage *linear,
                                 const WeftImage *display, WeftError *error) {
    int cursor = 0;
    WeftError other;
    WeftResult result = WEFT_OK;
    for (const char *path; (path = option_next(request->options, "-o", &cursor));) {
        const WeftImage *image = weft_image_suffix_linear(path) ? linear : display;
        char *name = number ? numbered(path, number) : NULL;
        WeftResult written =
            number && !name ? (WeftResult)report(WEFT_RESOURCES, "out of memory")
                            : weft_image_write(name ? name : path, image, result == WEFT_OK ? error : &other);
        free(name);
        if (result == WEFT_OK) result = written;
    }
    return result;
}

const char *request_outputs_text(const Request *request, char files[REQUEST_FILES]) {
    int cursor = 0;
    files[0] = '\0';
    for (const char *path; (path = option_next(request->options, "-o", &cursor));) {
        size_t used = strlen(files);
        snprintf(files + used, REQUEST_FILES - used, "%s%s", used ? ", " : "", path);
    }
    return files;
}
