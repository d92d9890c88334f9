#include "cli/render/request.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/path.h"
#include "cli/console/names.h"
#include "cli/console/output.h"
#include "cli/console/report.h"
#include "cli/files/save.h"
#include "cli/operands/root.h"
#include "cli/render/crew.h"
#include "weft/isa.h"

const Option request_options[] = {
    OPTION_HEADING("Pictures"),
    OPTION_LIST("-o", "OUT",
                "write OUT: .exr, .hdr and .npy linear, .png as displayed; of several pictures a sheet with "
                "their differences, .png"),
    OPTION_LIST("--save", "FILE",
                "write the scene with its materials and lights, .glb or .gltf, or the cloth's material, .json, .mtlx, "
                ".u3m or .u3ma; without -o nothing else"),
    OPTION_TEXT("--mtlx", "NODE", "open_pbr_surface",
                "the surface that --save writes into a .mtlx: open_pbr_surface, gltf_pbr or standard_surface"),
    OPTION_WHOLE("--width", "PIXELS", "960", 1, 65536, "width of the picture"),
    OPTION_WHOLE("--height", "PIXELS", "720", 1, 65536, "height of the picture"),
    OPTION_TEXT("--crop", "X,Y,W,H", NULL, "render these pixels only, from the top left"),

    OPTION_ROOT,

    SCENE_OPTIONS,

    OPTION_HEADING("Several pictures"),
    OPTION_WHOLE("--turntable", "COUNT", NULL, 1, 10000,
                 "so many pictures on a circle around the scene; OUT gets a number before its suffix"),

    OPTION_HEADING("Several machines"),
    OPTION_TEXT(
        "--chunk", "I/N", NULL,
        "path trace part I of N of the picture, counted from 1, to an .exr; `weft merge` joins the parts to the "
        "bytes of one run. Of a turntable, its I-th picture and every N-th after it"),
    OPTION_LIST("--from", "PART",
                "begin with the samples of a part of the same picture with a smaller --spp, a multiple of 16, and "
                "render only those that it lacks"),
    OPTION_TEXT("--checkpoint", "FILE", NULL,
                "keep what there is in FILE, an .exr, from which the same command goes on after it was stopped; "
                "removed at the end"),
    OPTION_NUMBER("--checkpoint-every", "SECONDS", "60", 1e-3, 1e6, "and how often"),

    OPTION_HEADING("Engine"),
    OPTION_TEXT("--engine", "ENGINE", "trace",
                "trace, the reference; raster, OpenGL; or both on a sheet, with their difference"),
    OPTION_TEXT("--gl", "KIND", "desktop", "raster: desktop, OpenGL 3.3, or es, OpenGL ES 3.0"),
    OPTION_WHOLE("--msaa", "COUNT", "4", 1, 64, "raster: samples a pixel at edges, as far as the driver goes"),
    OPTION_WHOLE("--accumulate", "COUNT", NULL, 1, WEFT_RASTER_FRAMES_MOST,
                 "raster: the mean of so many frames with random light and shadow rays, which converges to the path "
                 "tracer's --max-depth 1"),
    OPTION_WHOLE("--bounces", "COUNT", "0", 0, 1,
                 "raster, with --accumulate: 1 lets light bounce once between surfaces, about as --max-depth 2"),
    OPTION_TEXT("--ambient", "STRATEGY", "best",
                "raster: light from the environment by irradiance, mirror or fitted, by the best of them for each "
                "lobe, or none"),
    OPTION_WHOLE("--occlusion", "RAYS", "64", 0, 4096,
                 "raster: look from each vertex along so many rays, for what lies in creases and in shadow of a map"),
    OPTION_WHOLE("--polygons", "COUNT", "8", 0, WEFT_RASTER_POLYGONS,
                 "raster: light by so many of the scene's emissive polygons, the strongest"),
    OPTION_TEXT("--part", "PART", "all",
                "raster: all, or the light of one slot: diffuse, specular, sheen, coat or dust; or a property: "
                "base-color, normal, roughness, sheen-color, sheen-roughness or texcoord"),
    OPTION_TEXT("--shader-dir", "DIR", NULL, "raster: shader text found here wins over the built-in one"),

    OPTION_HEADING("Sampling of the path tracer"),
    OPTION_WHOLE("--spp", "COUNT", "64", 1, REQUEST_SPP_MOST,
                 "samples a pixel; without end where only --time-limit is given"),
    OPTION_NUMBER("--time-limit", "SECONDS", NULL, 1e-3, 1e9, "stop then and write what there is"),
    OPTION_SWITCH("--halves", "take the samples in two independent halves, by which the picture's relMSE is estimated"),
    OPTION_NUMBER("--noise", "LEVEL", NULL, 1e-9, 1e9,
                  "stop as soon as the picture's relMSE, estimated from two halves of its samples, is at "
                  "most LEVEL; --spp is "
                  "then the most samples, without end where it is not given"),
    OPTION_WHOLE("--max-depth", "COUNT", "9", 1, 1000, "scattering events on a path; 1 is direct light"),
    OPTION_TEXT("--sampling", "STRATEGY", "mis", "find lights by mis, light or lobe"),
    OPTION_WHOLE("--seed", "NUMBER", "0", 0, 2147483647, "another seed, other noise"),
    OPTION_WHOLE("--threads", "COUNT", NULL, 1, WEFT_THREADS_MAX,
                 "processors to use, 1 to 256; no influence on the picture [all]"),
    OPTION_TEXT("--isa", "NAME", NULL,
                "instructions to use: sse2, avx2 or avx512; no influence but on last bits, an .exr names "
                "them [the widest that the processor has]"),

    OPTION_HEADING("Output of the path tracer"),
    OPTION_TEXT(
        "--aov", "NAMES", NULL,
        "more channels in an .exr, with a comma between: albedo, normal, depth, position, uv, variance, "
        "samples; object and material, as Cryptomattes; diffuse, specular, sheen, coat, dust, other, whose light "
        "adds up to the picture; or all"),
    OPTION_SWITCH("--denoise", "take noise out of the picture; to look at, never to measure by"),
    OPTION_TEXT("--denoiser", "NAME", "regression", "and how: regression, or oidn where it is installed"),

    OPTION_HEADING("Reports"),
    OPTION_SWITCH("--quiet", "no progress, no warnings, no summary"),
    OPTION_SWITCH("--stages", "print ns a sample of each stage of the path tracer, of all threads"),
    OPTION_SWITCH("--json", "print figures on standard output: a JSON object, of a sheet an array of them"),
    OPTION_END,
};

static bool read_crop(const Options *options, WeftRenderDesc *desc) {
    const char *text = option_text(options, "--crop");
    double v[4];
    if (!text) return true;
    bool good = numbers_parse(text, 4, v);
    for (int k = 0; good && k < 4; k++) {
        good = v[k] >= (k < 2 ? 0.0 : 1.0) && v[k] <= (k % 2 ? desc->height : desc->width) && !(v[k] > floor(v[k]));
        if (good) desc->crop[k] = (int)v[k];
    }
    if (good && desc->crop[0] + desc->crop[2] <= desc->width && desc->crop[1] + desc->crop[3] <= desc->height)
        return true;
    report(WEFT_USAGE, "--crop: \"%.80s\" is not X,Y,W,H within %d x %d pixels", text, desc->width, desc->height);
    return false;
}

/* Reads the engine and checks the options that go with it. */
static bool read_engine(const Options *options, Request *request) {
    static const char *const engines[] = {"trace", "raster", "both", NULL};                         /* as Engine */
    static const char *const gl_versions[] = {"desktop", "es", NULL};                               /* as WeftGl */
    static const char *const ambients[] = {"best", "irradiance", "mirror", "fitted", "none", NULL}; /* as WeftAmbient */
    const char *parts[WEFT_PART_COUNT + 1];
    int engine = 0, kind = 0, ambient = 0, part = 0, occlusion = 0;
    for (int k = 0; k <= WEFT_PART_COUNT; k++) parts[k] = weft_part_name(k);
    bool good = option_choice(options, "--engine", engines, &engine) &&
                option_choice(options, "--gl", gl_versions, &kind) &&
                option_choice(options, "--ambient", ambients, &ambient) &&
                option_choice(options, "--part", parts, &part) && option_integer(options, "--msaa", &request->msaa) &&
                option_integer(options, "--accumulate", &request->accumulate) &&
                option_integer(options, "--bounces", &request->bounces) &&
                option_integer(options, "--polygons", &request->polygons) &&
                option_integer(options, "--occlusion", &occlusion) &&
                option_integer(options, "--turntable", &request->turntable);
    request->engine = (Engine)engine;
    request->ambient = (WeftAmbient)ambient;
    request->part = (WeftPart)part;
    request->raster = (WeftRasterDesc){.gl = (WeftGl)kind,
                                       .shader_dir = option_text(options, "--shader-dir"),
                                       .threads = request->desc.threads,
                                       .occlusion = request->accumulate ? 0 : occlusion};
    if (good && request->accumulate && request->engine == ENGINE_TRACE) {
        report(WEFT_USAGE, "--accumulate: needs --engine raster or both; the path tracer has --spp");
        return false;
    }
    if (good && request->bounces && !request->accumulate) {
        report(WEFT_USAGE,
               "--bounces: light bounces only in the sums of frames of --engine raster: add --accumulate 256; "
               "the path tracer has --max-depth");
        return false;
    }
    if (good && part && request->engine != ENGINE_RASTER) {
        report(WEFT_USAGE, "--part: needs --engine raster, the path tracer has no parts");
        return false;
    }
    if (good && request->engine == ENGINE_BOTH && request->scene_options.assignment.count > 1) {
        report(WEFT_USAGE, "--engine both: %s has several values already; one option may",
               request->scene_options.assignment.varied[0].option);
        return false;
    }
    const bool metered = request->scene_options.meter_exposure || request->scene_options.find_white;
    if (good && metered && request_count(request) > 1) {
        report(WEFT_USAGE, "%s auto: not for a sheet, whose pictures have to be shown alike",
               request->scene_options.meter_exposure ? "--exposure" : "--white-balance");
        return false;
    }
    if (good && request->turntable && request_count(request) > 1) {
        report(WEFT_USAGE, "--turntable: turns one picture, not a sheet of several");
        return false;
    }
    return good;
}

int request_count(const Request *request) {
    return request->engine == ENGINE_BOTH ? 2 : request->scene_options.assignment.count;
}

static bool read_desc(const Options *options, WeftRenderDesc *desc) {
    static const char *const strategies[] = {"mis", "light", "lobe", NULL};
    int seed = 0, sampling = 0;
    bool good = option_integer(options, "--width", &desc->width) &&
                option_integer(options, "--height", &desc->height) && read_crop(options, desc) &&
                option_integer(options, "--max-depth", &desc->max_depth) && option_integer(options, "--seed", &seed) &&
                option_integer(options, "--threads", &desc->threads) &&
                option_choice(options, "--sampling", strategies, &sampling);
    desc->seed = (uint32_t)seed;
    desc->sampling = (WeftSampling)sampling;
    desc->stages = option_given(options, "--stages");
    return good;
}

/* Reads names with a comma between. */
static bool read_aovs(const char *text, unsigned *aovs) {
    while (text && *text) {
        size_t length = strcspn(text, ",");
        int found = -1;
        if (length == 3 && strncmp(text, "all", 3) == 0) *aovs |= (1u << WEFT_AOV_COUNT) - 1u, found = 0;
        for (int k = 0; k < WEFT_AOV_COUNT && found < 0; k++)
            if (strlen(weft_aov_name(k)) == length && strncmp(text, weft_aov_name(k), length) == 0) found = k;
        if (found < 0) {
            report(WEFT_USAGE,
                   "--aov: \"%.*s\" is not albedo, normal, depth, position, uv, variance, samples, object, "
                   "material, diffuse, specular, sheen, coat, dust, other or all",
                   (int)(length < 80 ? length : 80), text);
            return false;
        }
        *aovs |= 1u << found;
        text += length + (text[length] == ',');
    }
    return true;
}

/* Pins the instructions of loops. */
static bool use_isa(const Options *options) {
    WeftError error;
    if (weft_isa_use(option_text(options, "--isa"), &error) == WEFT_OK) return true;
    report_error(&error);
    return false;
}

/* Reads the options of the path tracer alone, and checks that it is the engine. */
static bool read_extras(const Options *options, Request *request) {
    static const char *const of_tracer[] = {"--halves", "--noise", "--aov", "--denoise", "--denoiser"};
    const char *denoisers[WEFT_DENOISER_COUNT + 1];
    int denoiser = 0;
    double noise = 0.0;
    for (int k = 0; k <= WEFT_DENOISER_COUNT; k++) denoisers[k] = weft_denoiser_name(k);
    for (size_t k = 0; k < sizeof of_tracer / sizeof *of_tracer; k++)
        if (option_given(options, of_tracer[k]) && request->engine == ENGINE_RASTER) {
            report(WEFT_USAGE, "%s: needs --engine trace, OpenGL has no samples to judge", of_tracer[k]);
            return false;
        }
    if (!read_aovs(option_text(options, "--aov"), &request->aovs) ||
        !option_choice(options, "--denoiser", denoisers, &denoiser) || !option_number(options, "--noise", &noise))
        return false;
    request->denoiser = (WeftDenoiser)denoiser;
    request->denoise = option_given(options, "--denoise") || option_given(options, "--denoiser");
    if (request->denoise && request_count(request) > 1) {
        report(WEFT_USAGE, "--denoise: not for a sheet, whose differences would not be those of its pictures");
        return false;
    }
    if (option_given(options, "--noise") && !option_given(options, "--spp")) request->spp = 0;
    request->desc.noise = option_given(options, "--noise") ? (float)noise : 0.0f;
    bool judged = option_given(options, "--halves") || request->desc.noise > 0.0f;
    request->desc.halves = judged ? WEFT_HALVES_INDEPENDENT : request->denoise ? WEFT_HALVES_SHARED : 0;
    request->desc.first_hits = request->denoise;
    weft_render_record(&request->desc, request->aovs);
    return true;
}

/* Takes part of the pictures of a turntable, which are whole. */
static bool read_frames(Request *request, int index, int count) {
    const bool metered = request->scene_options.meter_exposure || request->scene_options.find_white;
    if (metered) report(WEFT_USAGE, "--chunk: the pictures of a turntable are metered by the first; give numbers");
    if (count > request->turntable)
        report(WEFT_USAGE, "--chunk: a turntable of %d pictures has at most %d parts", request->turntable,
               request->turntable);
    request->frame_index = index;
    request->frame_count = count;
    return !metered && count <= request->turntable;
}

bool request_cut(Request *request, int index, int count) {
    static const char *const whole[] = {"--noise", "--time-limit", "--denoise", "--denoiser", "--stages"};
    if (request->turntable) return read_frames(request, index, count);
    for (size_t k = 0; k < sizeof whole / sizeof *whole; k++)
        if (option_given(request->options, whole[k])) {
            report(WEFT_USAGE, "--chunk: not with %s, which needs the whole picture", whole[k]);
            return false;
        }
    if (request->aovs & (1u << WEFT_AOV_OBJECT | 1u << WEFT_AOV_MATERIAL)) {
        report(WEFT_USAGE, "--chunk: not with --aov object or material, whose lists of names are the whole picture's");
        return false;
    }
    const int height = request->desc.crop[3] ? request->desc.crop[3] : request->desc.height, most = (height + 15) / 16;
    if (count > most) {
        report(WEFT_USAGE, "--chunk: a picture of %d rows of pixels has at most %d parts", height, most);
        return false;
    }
    if (request->engine != ENGINE_TRACE || request_count(request) > 1) {
        report(WEFT_USAGE, "--chunk: needs one picture of --engine trace");
        return false;
    }
    request->chunk_index = index;
    request->chunk_count = count;
    return true;
}

/* Reads the part of the picture. */
static bool read_chunk(const Options *options, Request *request) {
    const char *text = option_text(options, "--chunk");
    int index = 0, count = 0, end = 0;
    if (!text) return true;
    if (sscanf(text, "%5d/%5d%n", &index, &count, &end) != 2 || text[end] || index < 1 || count < 1 || index > count ||
        count > CHUNKS_MOST) {
        report(WEFT_USAGE, "--chunk: \"%.40s\" is not I/N, part I of N parts, 1 to %d", text, CHUNKS_MOST);
        return false;
    }
    return request_cut(request, index - 1, count);
}

/* Reads what to go on from. */
static bool read_earlier(const Options *options, Request *request) {
    const char *const option = crew_place() ? "weft-mpi" : option_given(options, "--from") ? "--from" : "--checkpoint";
    request->checkpoint = option_text(options, "--checkpoint");
    if (!option_number(options, "--checkpoint-every", &request->checkpoint_every)) return false;
    if (option_given(options, "--checkpoint-every") && !request->checkpoint) {
        report(WEFT_USAGE, "--checkpoint-every: needs --checkpoint FILE");
        return false;
    }
    if (!crew_place() && !option_given(options, option)) return true;
    if (crew_place() && (request->chunk_count || request->desc.noise > 0.0f || !option_given(options, "-o"))) {
        report(WEFT_USAGE, "weft-mpi: needs -o OUT, and has neither --chunk nor --noise");
        return false;
    }
    if (request->engine != ENGINE_TRACE || request_count(request) > 1 || request->turntable) {
        report(WEFT_USAGE, "%s: needs one picture of --engine trace", option);
        return false;
    }
    if (option_given(options, "--time-limit")) {
        report(WEFT_USAGE, "%s: not with --time-limit, by which the samples differ from run to run", option);
        return false;
    }
    if (request->checkpoint && !path_ends(request->checkpoint, ".exr")) {
        report(WEFT_USAGE, "--checkpoint: \"%.200s\" must be an .exr", request->checkpoint);
        return false;
    }
    return true;
}

bool request_read(const Options *options, Request *request) {
    *request = (Request){.options = options, .quiet = option_given(options, "--quiet") || crew_follows()};
    bool good = read_desc(options, &request->desc) &&
                scene_options_read(options, options->operands[0], &request->scene_options) &&
                option_integer(options, "--spp", &request->spp) &&
                option_number(options, "--time-limit", &request->time_limit) && read_engine(options, request) &&
                read_extras(options, request) && read_chunk(options, request) && read_earlier(options, request) &&
                use_isa(options);
    request->desc.camera = request->scene_options.camera;
    bool laid_behind = request->scene_options.background == WEFT_BACKGROUND_COLOR; /* by job_draw */
    request->desc.background = laid_behind ? WEFT_BACKGROUND_TRANSPARENT : request->scene_options.background;
    request->desc.hide_lights = request->scene_options.hide_lights;
    if (option_given(options, "--time-limit") && !option_given(options, "--spp")) request->spp = 0;
    return good;
}

int request_outputs_check(const Request *request) {
    const Options *options = request->options;
    int cursor = 0, result = 0;
    bool layered = false;
    WeftError error;
    result = save_check(options);
    if (result != 0) return result;
    if (request->denoise && weft_denoiser_check(request->denoiser, &error) != WEFT_OK) return report_error(&error);
    if (!option_given(options, "-o") && !option_given(options, "--save"))
        return report(WEFT_USAGE, "render: needs -o OUT, a .png, .exr, .hdr or .npy file");
    for (const char *path; (path = option_next(options, "-o", &cursor));)
        if (!weft_image_suffix_known(path))
            return report(WEFT_USAGE, "%s: %s", path, weft_message_text(WEFT_MESSAGE_OUTPUT_SUFFIX));
        else if (request_count(request) > 1 && weft_image_suffix_linear(path))
            return report(WEFT_USAGE, "%s: a sheet of several images must be a .png", path);
        else if (request->chunk_count && !path_ends(path, ".exr"))
            return report(WEFT_USAGE, "%s: a part of a picture must be an .exr, which weft merge makes others of",
                          path);
        else if (request->denoise && !path_ends(path, ".png") && !path_ends(path, ".exr"))
            return report(WEFT_USAGE, "%s: cannot say that it was denoised; .png and .exr can", path);
        else if (path_ends(path, ".exr"))
            layered = true;
    if (request->aovs && option_given(options, "-o") && !layered)
        return report(WEFT_USAGE, "--aov: needs an .exr among -o, other formats have no channels for it");
    for (cursor = 0; result == 0;) {
        const char *path = option_next(options, "-o", &cursor);
        if (!path) break;
        if (request->checkpoint && strcmp(path, request->checkpoint) == 0)
            return report(WEFT_USAGE, "%s: is both -o and --checkpoint", path);
        result = output_probe(path);
    }
    if (result == 0 && request->checkpoint) result = output_probe(request->checkpoint);
    return result;
}

/* Makes "out-007.png" of "out.png" and "007". Release with free; NULL where memory is short. */
static char *numbered(const char *path, const char *number) {
    const size_t size = strlen(path) + strlen(number) + 2;
    char *name = malloc(size);
    if (name) path_numbered(path, number, name, size);
    return name;
}

WeftResult request_outputs_write(const Request *request, const char *number, const Outputs *outputs, WeftError *error) {
    int cursor = 0;
    WeftError other;
    WeftResult result = WEFT_OK;
    for (const char *path; (path = option_next(request->options, "-o", &cursor));) {
        const WeftImage *image = weft_image_suffix_linear(path) ? outputs->linear : outputs->display;
        char *name = number ? numbered(path, number) : NULL;
        WeftResult written = number && !name ? (WeftResult)report(WEFT_RESOURCES, "out of memory")
                                             : weft_image_write_as(name ? name : path, image, &outputs->how,
                                                                   result == WEFT_OK ? error : &other);
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
