/* raster.c - what a frame of the raster engine takes: milliseconds for each sheen lobe on builtin:cloth under
 * one directional light, its softbox and the environment, with shadows, and nanoseconds a pixel over the bare base
 *
 *   bench_raster [--quick]
 *   bench_raster --moving [NAME | SCENE MAP.hdr]
 *   bench_raster --sampled [--shader-dir DIR] [--only NAME]... [MAP.hdr]
 *   bench_raster --woven [--shader-dir DIR] [--width N]
 *
 * Every lobe is drawn in turn, several rounds; the least time of a frame counts. The processor's own part is
 * that of a frame whose draw calls do nothing. --moving: frames of an orbit of builtin:cloth as it comes (NAME: that row
 * alone), or of a scene under a map, as the window draws them in motion, beside those at rest (docs/raster.md).
 * --sampled: what lobes that are sampled take under an environment and no other light, against the strategy `fitted`
 * for the same lobe (docs/environment.md). --woven: what the cloth takes in denim, in both engines, against the scene
 * as it comes, from threads close up to all of the cloth (docs/weave-evidence.md). With shaders of a folder or a width
 * (640 without) only the raster engine is measured: a graphics card takes so little for 640 that the processor's part
 * counts, so give it 3840; 16 to 16384 are taken. */
#define _POSIX_C_SOURCE 200809L
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include <epoxy/gl.h>

#include "base/steady_clock.h"
#include "weft/weft.h"

enum { LOBES_MOST = 64 };

typedef struct Size {
    int width, height;
} Size;

typedef struct Entry {
    const char *name;
    WeftScene *scene;
    WeftRaster *raster;
    double best; /* s a frame */
} Entry;

static void check(WeftResult result, const WeftError *error) {
    if (result == WEFT_OK) return;
    fprintf(stderr, "bench_raster: %s\n", error->text);
    exit(1);
}

static _Noreturn void refuse(const char *argument) {
    fprintf(stderr, "bench_raster: \"%s\" is no option here; see the first lines of bench/raster.c\n", argument);
    exit(2);
}

/* builtin:cloth under a sun and the studio. */
static WeftScene *sunlit_cloth(void) {
    WeftScene *scene;
    WeftError error;
    const WeftLight sun = {.direction = {-1.0f, -2.0f, -1.0f}, .color = {3.0f, 3.0f, 3.0f}};
    check(weft_scene_load("builtin:cloth", &scene, NULL, &error), &error);
    check(weft_scene_add_light(scene, &sun, &error), &error);
    return scene;
}

static WeftRaster *raster_of(const WeftScene *scene, const char *shader_dir) {
    WeftRaster *raster;
    WeftError error;
    check(weft_raster_create(scene, &(WeftRasterDesc){.shader_dir = shader_dir}, &raster, NULL, &error), &error);
    return raster;
}

/* Without a name no material has a sheen. */
static Entry entry_of(const char *lobe) {
    Entry entry = {.name = lobe ? lobe : "no sheen", .best = 1e9, .scene = sunlit_cloth()};
    WeftError error;
    check(weft_scene_set(entry.scene, lobe ? "*.sheen_lobe" : "*.sheen_color", lobe ? lobe : "0", NULL, &error),
          &error);
    entry.raster = raster_of(entry.scene, NULL);
    return entry;
}

/* Returns a view without polygons and shadows. */
static WeftRasterView view_of(Size size) {
    return (WeftRasterView){
        .width = size.width, .height = size.height, .samples = 1, .camera = "0", .polygons = -1, .no_shadows = 1};
}

static double frame(WeftRaster *raster, const WeftRasterView *view) {
    WeftError error;
    double start = clock_now();
    check(weft_raster_draw(raster, view, &error), &error);
    weft_raster_finish(raster);
    return clock_now() - start;
}

static void measure(Entry *entries, int count, Size size, int rounds, int frames) {
    const WeftRasterView view = {.width = size.width, .height = size.height, .samples = 1, .camera = "0"};
    for (int k = 0; k < count; k++) {
        entries[k].best = 1e9;
        frame(entries[k].raster, &view); /* compiles */
    }
    for (int round = 0; round < rounds; round++)
        for (int k = 0; k < count; k++)
            for (int f = 0; f < frames; f++) {
                double t = frame(entries[k].raster, &view);
                if (t < entries[k].best) entries[k].best = t;
            }
    printf("\n%d x %d\nlobe                          ms a frame   frames/s   ns a pixel over no sheen\n", size.width,
           size.height);
    for (int k = 0; k < count; k++)
        printf("%-28s %10.2f %10.1f %12.2f\n", entries[k].name, 1e3 * entries[k].best, 1.0 / entries[k].best,
               1e9 * (entries[k].best - entries[0].best) / ((double)size.width * size.height));
}

static void no_draw(GLenum mode, GLsizei count, GLenum type, const void *indices) {}
static void no_clear(GLbitfield mask) {}
static void no_blit(GLint a, GLint b, GLint c, GLint d, GLint e, GLint f, GLint g, GLint h, GLbitfield mask,
                    GLenum filter) {}
static void no_data(GLenum target, GLintptr offset, GLsizeiptr size, const void *data) {}

/* A frame whose calls that cost the driver much do nothing. */
static void measure_processor(WeftRaster *raster) {
    enum { FRAMES = 2000 };
    const WeftRasterView view = view_of((Size){1280, 720});
    WeftError error;
    epoxy_glDrawElements = no_draw;
    epoxy_glClear = no_clear;
    epoxy_glBlitFramebuffer = no_blit;
    epoxy_glBufferSubData = no_data;
    double start = clock_now();
    for (int k = 0; k < FRAMES; k++) check(weft_raster_draw(raster, &view, &error), &error);
    printf("\nprocessor's own part of a frame: %.3f ms\n", 1e3 * (clock_now() - start) / FRAMES);
}

/* A material whose highlight is elongated or a ring. */
typedef struct SampledCase {
    const char *name, *settings[5][2];
} SampledCase;

static const SampledCase sampled_cases[] = {
    {"ggx 0.3", {{"*.metallic", "1"}, {"*.roughness", "0.3"}, {"*.anisotropy", "0.9"}, {"*.sheen_color", "0"}}},
    {"disney 0.3", {{"*.workflow", "disney"}, {"*.metallic", "1"}, {"*.roughness", "0.3"}, {"*.anisotropy", "0.9"}}},
    {"silk 0.3", {{"*.sheen_lobe", "silk"}, {"*.sheen_roughness", "0.3"}, {"*.anisotropy", "0.9"}}},
    {"fibre 0.3", {{"*.sheen_lobe", "fibre"}, {"*.sheen_roughness", "0.3"}}},
    {"fibre-table 0.4", {{"*.sheen_lobe", "fibre-table"}, {"*.sheen_roughness", "0.4"}}},
    {"ltc-fibre 0.3", {{"*.sheen_lobe", "ltc-fibre"}, {"*.sheen_roughness", "0.3"}}},
    {"patry 0.2", {{"*.sheen_lobe", "patry"}, {"*.sheen_roughness", "0.2"}}},
};

/* Seconds of the best of some frames. */
static double best_frame(WeftRaster *raster, const WeftRasterView *view) {
    enum { FRAMES = 3 };
    double best = frame(raster, view);
    for (int k = 0; k < FRAMES; k++) {
        double t = frame(raster, view);
        if (t < best) best = t;
    }
    return best;
}

static void measure_sampled(const SampledCase *c, const char *map, const char *shader_dir) {
    enum { ROUNDS = 2 };
    WeftRasterView view = view_of((Size){640, 360});
    WeftScene *scene;
    WeftRaster *raster;
    WeftError error;
    double best[2] = {1e9, 1e9};
    check(weft_scene_load("builtin:cloth", &scene, NULL, &error), &error);
    while (weft_scene_info(scene).light_count > 0) check(weft_scene_remove_light(scene, 0, &error), &error);
    if (map) check(weft_scene_set_environment_file(scene, map, NULL, &error), &error);
    for (int k = 0; k < 5 && c->settings[k][0]; k++)
        check(weft_scene_set(scene, c->settings[k][0], c->settings[k][1], NULL, &error), &error);
    raster = raster_of(scene, shader_dir);
    for (int round = 0; round < ROUNDS; round++)
        for (int k = 0; k < 2; k++) {
            view.ambient = k ? WEFT_AMBIENT_BEST : WEFT_AMBIENT_FITTED;
            double t = best_frame(raster, &view);
            if (t < best[k]) best[k] = t;
        }
    printf("%-20s %10.1f %10.1f %8.2f\n", c->name, 1e3 * best[0], 1e3 * best[1], best[1] / best[0]);
    fflush(stdout);
    weft_raster_free(raster);
    weft_scene_free(scene);
}

static bool is_named(const char *name, const char *const *only, int count) {
    bool named = count == 0;
    for (int k = 0; k < count; k++) named |= strncmp(name, only[k], strlen(only[k])) == 0;
    return named;
}

static int sampled_main(int argc, char **argv) {
    const char *map = NULL, *shader_dir = NULL, *only[LOBES_MOST];
    int only_count = 0;
    for (int k = 2; k < argc; k++) {
        if (strcmp(argv[k], "--shader-dir") == 0 && k + 1 < argc)
            shader_dir = argv[++k];
        else if (strcmp(argv[k], "--only") == 0 && k + 1 < argc && only_count < LOBES_MOST)
            only[only_count++] = argv[++k];
        else if (argv[k][0] == '-' || map)
            refuse(argv[k]);
        else
            map = argv[k];
    }
    printf("builtin:cloth, 640 x 360, ms a frame\n%-20s %10s %10s %8s\n", "lobe and roughness", "fitted", "default",
           "times");
    for (size_t k = 0; k < sizeof sampled_cases / sizeof *sampled_cases; k++)
        if (is_named(sampled_cases[k].name, only, only_count)) measure_sampled(&sampled_cases[k], map, shader_dir);
    return 0;
}

static const char denim[] = "{\"weave\": {\"draft\": \"twill 3/1 z; warp 1#26375c; weft 1#d8d4c8; sett 26 18\", "
                            "\"warp\": \"cotton\", \"weft\": \"cotton\", \"metres\": 0.5}}";

/* The least seconds of a frame, of as many as fill a twentieth of a second. */
static double best_of_many(WeftRaster *raster, const WeftRasterView *view) {
    double best = 1e9, sum = 0.0;
    while (sum < 0.05) {
        const double t = frame(raster, view);
        sum += t;
        if (t < best) best = t;
    }
    return best;
}

/* Seconds for four samples a pixel of the path tracer, the scene's tree apart. */
static double trace(const WeftScene *scene, const char *camera) {
    WeftRender *render;
    WeftError error;
    const WeftRenderDesc desc = {.width = 320, .height = 180, .camera = camera, .threads = 1};
    check(weft_render_create(scene, &desc, &render, &error), &error);
    const double start = clock_now();
    check(weft_render_run(render, 4, 0.0, NULL, NULL), &error);
    const double seconds = clock_now() - start;
    weft_render_free(render);
    return seconds;
}

/* The times of the frames of an orbit. */
typedef struct Orbit {
    double median, worst, processor; /* s; processor: time of the process a frame, over two cores */
} Orbit;

static int by_size(const void *a, const void *b) {
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* Draws frames of a quarter turn about the scene, after two that compile. */
static Orbit orbit(WeftRaster *raster, WeftRasterView view) {
    enum { FRAMES = 24 };
    double times[FRAMES];
    frame(raster, &view);
    frame(raster, &view);
    const WeftRasterInfo seen = weft_raster_info(raster);
    const float *t = seen.camera_target, x = seen.camera_eye[0] - t[0], z = seen.camera_eye[2] - t[2];
    const clock_t start = clock();
    for (int k = 0; k < FRAMES; k++) {
        char camera[256];
        const double angle = 1.57 * k / FRAMES, c = cos(angle), s = sin(angle);
        snprintf(camera, sizeof camera, "%.6g,%.6g,%.6g;%.6g,%.6g,%.6g;%.6g",
                 (double)t[0] + c * (double)x + s * (double)z, (double)seen.camera_eye[1],
                 (double)t[2] + c * (double)z - s * (double)x, (double)t[0], (double)t[1], (double)t[2],
                 (double)seen.camera_fov);
        view.camera = camera;
        times[k] = frame(raster, &view);
    }
    const double processor = (double)(clock() - start) / CLOCKS_PER_SEC / (2.0 * FRAMES);
    qsort(times, FRAMES, sizeof times[0], by_size);
    return (Orbit){times[FRAMES / 2], times[FRAMES - 1], processor};
}

/* Returns the sum of absolute differences over the sum, of the first frame with that rate to one at rest. */
static double difference(WeftRaster *raster, WeftRasterView view) {
    WeftImage images[2];
    WeftError error;
    double off = 0.0, sum = 0.0;
    for (int k = 0; k < 2; k++) {
        check(weft_raster_draw(raster, &view, &error), &error);
        check(weft_raster_image(raster, &images[k], &error), &error);
        view.shading_rate = 1;
    }
    const float *a = images[0].pixels, *b = images[1].pixels;
    for (size_t k = 0; k < 4 * (size_t)view.width * (size_t)view.height; k++) {
        const size_t opacity = k - k % 4 + 3;
        if (k == opacity) continue;
        off += fabs((double)(a[k] * a[opacity]) - (double)(b[k] * b[opacity]));
        sum += (double)(b[k] * b[opacity]);
    }
    weft_image_free(&images[0]);
    weft_image_free(&images[1]);
    return off / sum;
}

/* Prints a row: a scene at rest and in motion. name: of the row. */
static void measure_moving(const char *name, WeftScene *scene) {
    WeftRaster *raster = raster_of(scene, NULL);
    WeftRasterView view = {
        .width = 1280, .height = 720, .samples = 1, .camera = weft_scene_info(scene).camera_count ? "0" : NULL};
    WeftError error;
    check(weft_raster_wait(raster, &error), &error);
    frame(raster, &view);
    const double rest = frame(raster, &view);
    for (int rate = 4; rate <= 6; rate++) {
        view.shading_rate = rate;
        const Orbit moving = orbit(raster, view);
        printf("| %s | %d x %d | %.0f | %.0f | %.0f | %.1f | %.3f |\n", name, rate, rate, 1e3 * rest,
               1e3 * moving.median, 1e3 * moving.processor, moving.worst / moving.median, difference(raster, view));
        fflush(stdout);
    }
    weft_raster_free(raster);
    weft_scene_free(scene);
}

/* Returns builtin:cloth with a row's sheen, or the last row's weave. */
static WeftScene *moving_cloth(const char *name, bool woven) {
    WeftScene *scene;
    WeftError error;
    check(weft_scene_load("builtin:cloth", &scene, NULL, &error), &error);
    if (woven)
        check(weft_scene_assign_material(scene, "Cloth", "preset:woven-denim", NULL, &error), &error);
    else
        check(weft_scene_set(scene, "*.sheen_lobe", name, NULL, &error), &error);
    return scene;
}

static int moving_main(int argc, char **argv) {
    enum { ROWS = 3 };
    static const char *const rows[ROWS] = {"charlie-neubelt", "fibre-table", "woven-denim"};
    bool known = argc != 3;
    WeftScene *scene;
    WeftError error;
    for (int k = 0; k < ROWS; k++) known |= argc == 3 && strcmp(argv[2], rows[k]) == 0;
    if (!known || argc > 4) refuse(argv[argc - 1]);
    printf(
        "1280 x 720, one sample a pixel, softbox with soft shadow, ms a frame; of an orbit the median, the time of the "
        "process over two cores, and the worst over the median; the difference is that to the picture at rest\n\n"
        "| scene | pixels a point | at rest | orbit | processor | worst | difference "
        "|\n|---|---|---|---|---|---|---|\n");
    if (argc == 4) {
        check(weft_scene_load(argv[2], &scene, NULL, &error), &error);
        check(weft_scene_set_environment_file(scene, argv[3], NULL, &error), &error);
        measure_moving(argv[2], scene);
        return 0;
    }
    for (int k = 0; k < ROWS; k++)
        if (argc < 3 || strcmp(argv[2], rows[k]) == 0) measure_moving(rows[k], moving_cloth(rows[k], k == ROWS - 1));
    return 0;
}

/* A width of pixels, or 0. */
static int width_of(const char *text) {
    char *end;
    const long width = strtol(text, &end, 10);
    return *end == '\0' && width >= 16 && width <= 16384 ? (int)width : 0;
}

static int woven_main(int argc, char **argv) {
    static const struct {
        const char *name, *camera;
    } distances[] = {
        {"threads", "0.25,0.62,0.65;0.03,0.42,0.15;1.5"}, {"near", "0.25,0.62,0.65;0.03,0.42,0.15;8"}, {"all", "0"}};
    enum { ROUNDS = 3 };
    const char *shader_dir = NULL;
    int width = 0;
    for (int k = 2; k + 1 < argc; k += 2) {
        if (strcmp(argv[k], "--shader-dir") == 0)
            shader_dir = argv[k + 1];
        else if (strcmp(argv[k], "--width") != 0)
            refuse(argv[k]);
        else if (!(width = width_of(argv[k + 1])))
            refuse(argv[k + 1]);
    }
    if (argc % 2) refuse(argv[argc - 1]);
    const bool traced = !shader_dir && !width;
    if (!width) width = 640;
    Entry entries[2] = {{.scene = sunlit_cloth()}, {.scene = sunlit_cloth()}};
    WeftError error;
    check(weft_scene_assign_material_memory(entries[1].scene, NULL, denim, sizeof denim - 1, "denim", NULL, &error),
          &error);
    for (int k = 0; k < 2; k++) entries[k].raster = raster_of(entries[k].scene, shader_dir);
    printf("builtin:cloth as it comes and in denim, ms a frame; raster: %d wide, by %s\n%-20s %10s %10s %8s\n", width,
           weft_raster_info(entries[1].raster).driver, "engine and distance", "as is", "denim", "times");
    for (int engine = !traced; engine < 2; engine++)
        for (size_t d = 0; d < sizeof distances / sizeof *distances; d++) {
            WeftRasterView view = view_of((Size){width, width * 9 / 16});
            view.camera = distances[d].camera;
            double best[2] = {1e9, 1e9};
            for (int round = 0; round < ROUNDS; round++)
                for (int k = 0; k < 2; k++) {
                    if (engine && round == 0) frame(entries[k].raster, &view); /* compiles */
                    const double t =
                        engine ? best_of_many(entries[k].raster, &view) : trace(entries[k].scene, view.camera);
                    if (t < best[k]) best[k] = t;
                }
            printf("%-7s %-12s %10.2f %10.2f %8.2f\n", engine ? "raster" : "traced", distances[d].name, 1e3 * best[0],
                   1e3 * best[1], best[1] / best[0]);
        }
    for (int k = 0; k < 2; k++) {
        weft_raster_free(entries[k].raster);
        weft_scene_free(entries[k].scene);
    }
    return 0;
}

int main(int argc, char **argv) {
    if (argc > 1 && strcmp(argv[1], "--woven") == 0) return woven_main(argc, argv);
    if (argc > 1 && strcmp(argv[1], "--moving") == 0) return moving_main(argc, argv);
    if (argc > 1 && strcmp(argv[1], "--sampled") == 0) return sampled_main(argc, argv);
    const bool quick = argc > 1 && strcmp(argv[1], "--quick") == 0;
    if (argc > 1 + (int)quick) refuse(argv[1 + (int)quick]);
    static Entry entries[LOBES_MOST];
    int count = 0;
    entries[count++] = entry_of(NULL);
    for (int k = 0; weft_lobe_info(k) && count < LOBES_MOST; k++) {
        const WeftLobeInfo *info = weft_lobe_info(k);
        if (info->traits & WEFT_LOBE_REFERENCE || (quick && strncmp(info->id, "charlie", 7) != 0)) continue;
        entries[count++] = entry_of(info->id);
    }
    printf("builtin:cloth, a directional light, its softbox and the environment, with shadows, one sample a pixel, by "
           "%s\n",
           weft_raster_info(entries[0].raster).driver);
    measure(entries, count, (Size){1280, 720}, quick ? 2 : 4, 4);
    measure(entries, count, (Size){3840, 2160}, 1, 2);
    measure_processor(entries[0].raster);
    for (int k = 0; k < count; k++) {
        weft_raster_free(entries[k].raster);
        weft_scene_free(entries[k].scene);
    }
    return 0;
}
