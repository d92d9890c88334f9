/* occluded - prints what neighbours leave of a sheen's light from an environment: how the raster engine's sum
 * over a picture differs from the path tracer's direct light, in hundredths
 *
 *   study_occluded [--only LOBE]... [--rays N] [--width N] [--fine N] [--centre] MAP.hdr|white ...
 *
 * Scenes: builtin:spheres and builtin:cloth, without lights, with black base and specular; their sheens have the
 * lobe. `sum` is the difference of the sums, below 0 where the raster image is darker. `apart` is sum |difference|
 * over sum, of means over 4 x 4 pixels. `noise` is the standard deviation of the path tracer's sum: two renders of
 * different seeds run until it is below 0.5, or to 4096 samples each. --rays: occlusion rays of a vertex. --fine: the
 * raster engine draws N x N pixels for one, 4 unless told, since it shades a pixel once and the path tracer shades all
 * of its area. --centre: both engines take one sample in the centre of each pixel. `white` is an even sky, under which
 * only occlusion and E can be wrong. */
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "raster/sheens.h"
#include "weft/weft.h"

enum { BLOCK = 4, SAMPLES = 32, SAMPLES_MOST = 4096, LOBES_MOST = 64 };

/* Settings that both engines draw with. */
typedef struct How {
    int width, height, rays;
    int fine; /* pixels of the raster image along a pixel's side */
    bool centre;
} How;

static void check(WeftResult result, const WeftError *error) {
    if (result == WEFT_OK) return;
    fprintf(stderr, "study_occluded: %s\n", error->text);
    exit(1);
}

static WeftScene *scene_of(const char *name, const char *map) {
    static const char *const settings[][2] = {
        {"*.base_color", "0"}, {"*.specular", "0"}, {"*.layer", "additive"}, {"*.emission_strength", "0"}};
    static const float white[3] = {1.0f, 1.0f, 1.0f};
    WeftScene *scene;
    WeftError error;
    check(weft_scene_load(name, &scene, NULL, &error), &error);
    while (weft_scene_info(scene).light_count > 0) check(weft_scene_remove_light(scene, 0, &error), &error);
    if (strcmp(map, "white") == 0)
        check(weft_scene_set_environment_color(scene, white, &error), &error);
    else
        check(weft_scene_set_environment_file(scene, map, NULL, &error), &error);
    for (size_t k = 0; k < sizeof settings / sizeof *settings; k++)
        check(weft_scene_set(scene, settings[k][0], settings[k][1], NULL, &error), &error);
    return scene;
}

static WeftRender *render_of(const WeftScene *scene, const How *how, uint32_t seed) {
    const WeftRenderDesc desc = {.width = how->width,
                                 .height = how->height,
                                 .max_depth = 1,
                                 .seed = seed,
                                 .camera = "0",
                                 .background = WEFT_BACKGROUND_TRANSPARENT,
                                 .pixel_centre = how->centre};
    WeftRender *render;
    WeftError error;
    check(weft_render_create(scene, &desc, &render, &error), &error);
    return render;
}

static WeftImage image_of(const WeftRender *render) {
    WeftImage image;
    WeftError error;
    check(weft_render_image(render, &image, &error), &error);
    return image;
}

/* Rays are traced once for all lobes. */
static WeftRaster *raster_of(const WeftScene *scene, const How *how) {
    const WeftRasterDesc desc = {.occlusion = how->rays, .no_cache = 1};
    WeftRaster *raster;
    WeftError error;
    check(weft_raster_create(scene, &desc, &raster, NULL, &error), &error);
    check(weft_raster_wait(raster, &error), &error);
    return raster;
}

static WeftImage drawn(WeftRaster *raster, const How *how) {
    const WeftRasterView view = {.width = how->width * how->fine,
                                 .height = how->height * how->fine,
                                 .samples = how->centre ? 1 : 0,
                                 .camera = "0",
                                 .background = WEFT_BACKGROUND_TRANSPARENT};
    WeftImage image;
    WeftError error;
    check(weft_raster_update(raster, NULL, &error), &error);
    check(weft_raster_draw(raster, &view, &error), &error);
    check(weft_raster_image(raster, &image, &error), &error);
    return image;
}

/* Mean of a colour over a block that is `side` pixels wide, of straight alpha. */
static double block_mean(const WeftImage *image, int side, int block, int c) {
    int across = image->width / side, x = block % across * side, y = block / across * side;
    const float *p = image->pixels;
    double sum = 0.0;
    for (int k = 0; k < side * side; k++) {
        int at = 4 * ((y + k / side) * image->width + x + k % side);
        sum += (double)(p[at + c] * p[at + 3]);
    }
    return sum / (side * side);
}

/* Ratios to the sum of the path traced image. */
typedef struct Error {
    double sum, apart, noise;
} Error;

/* Two path traced images, of which the mean counts, and the raster image. */
static Error error_of(const WeftImage reference[2], const WeftImage *image, int fine) {
    Error e = {0.0, 0.0, 0.0};
    double all = 0.0;
    int blocks = reference->width / BLOCK * (reference->height / BLOCK);
    for (int k = 0; k < 3 * blocks; k++) {
        double a = 0.5 * block_mean(&reference[0], BLOCK, k / 3, k % 3),
               b = 0.5 * block_mean(&reference[1], BLOCK, k / 3, k % 3);
        double difference = block_mean(image, fine * BLOCK, k / 3, k % 3) - a - b;
        e.sum += difference;
        e.apart += fabs(difference);
        e.noise += (a - b) * (a - b);
        all += a + b;
    }
    return (Error){e.sum / all, e.apart / all, sqrt(e.noise) / all};
}

static Error measure(const WeftScene *scene, WeftRaster *raster, const How *how) {
    WeftRender *renders[2] = {render_of(scene, how, 0), render_of(scene, how, 1)};
    WeftImage image = drawn(raster, how);
    Error e = {0.0, 0.0, 1.0};
    for (int samples = SAMPLES; e.noise > 0.005 && samples <= SAMPLES_MOST; samples *= 2) {
        WeftImage reference[2];
        for (int k = 0; k < 2; k++) {
            int done = samples > SAMPLES ? samples / 2 : 0;
            WeftError error = {0};
            check(weft_render_run(renders[k], samples - done, 0.0, NULL, NULL), &error);
            reference[k] = image_of(renders[k]);
        }
        e = error_of(reference, &image, how->fine);
        for (int k = 0; k < 2; k++) weft_image_free(&reference[k]);
    }
    weft_image_free(&image);
    for (int k = 0; k < 2; k++) weft_render_free(renders[k]);
    return e;
}

static bool is_named(const char *id, const char *const *only, int count) {
    bool named = count == 0;
    for (int k = 0; k < count; k++) named |= strcmp(only[k], id) == 0;
    return named;
}

static void print_lobe(const char *id, WeftScene *const scenes[2], WeftRaster *const rasters[2], const How *how) {
    Error e[2];
    WeftError error;
    for (int s = 0; s < 2; s++) {
        check(sheens_set_lobe(scenes[s], id, &error), &error);
        e[s] = measure(scenes[s], rasters[s], how);
    }
    printf("%-27s", id);
    for (int s = 0; s < 2; s++) printf(" %8.1f %8.1f %8.1f", 100.0 * e[s].sum, 100.0 * e[s].apart, 100.0 * e[s].noise);
    printf("\n");
    fflush(stdout);
}

int main(int argc, char **argv) {
    const char *maps[8], *only[LOBES_MOST];
    int map_count = 0, only_count = 0;
    How how = {.width = 160, .rays = 64, .fine = 4};
    for (int k = 1; k < argc; k++) {
        if (strcmp(argv[k], "--only") == 0 && k + 1 < argc && only_count < LOBES_MOST)
            only[only_count++] = argv[++k];
        else if (strcmp(argv[k], "--rays") == 0 && k + 1 < argc)
            how.rays = atoi(argv[++k]);
        else if (strcmp(argv[k], "--width") == 0 && k + 1 < argc)
            how.width = atoi(argv[++k]);
        else if (strcmp(argv[k], "--centre") == 0)
            how.centre = true, how.fine = 1;
        else if (strcmp(argv[k], "--fine") == 0 && k + 1 < argc)
            how.fine = atoi(argv[++k]);
        else if (map_count < 8)
            maps[map_count++] = argv[k];
    }
    how.height = how.width * 3 / 4;
    for (int m = 0; m < map_count; m++) {
        static const char *const names[] = {"builtin:spheres", "builtin:cloth"};
        const char *slash = strrchr(maps[m], '/');
        WeftScene *scenes[2];
        WeftRaster *rasters[2];
        for (int s = 0; s < 2; s++) {
            scenes[s] = scene_of(names[s], maps[m]);
            rasters[s] = raster_of(scenes[s], &how);
        }
        printf("\n%-27s %26s %26s\n", slash ? slash + 1 : maps[m], "spheres", "cloth");
        printf("%-27s %8s %8s %8s %8s %8s %8s\n", "lobe", "sum", "apart", "noise", "sum", "apart", "noise");
        for (int lobe = 0; weft_lobe_info(lobe); lobe++) {
            const WeftLobeInfo *info = weft_lobe_info(lobe);
            if (info->traits & (WEFT_LOBE_REFERENCE | WEFT_LOBE_DIFFUSE)) continue;
            if (is_named(info->id, only, only_count)) print_lobe(info->id, scenes, rasters, &how);
        }
        for (int s = 0; s < 2; s++) {
            weft_raster_free(rasters[s]);
            weft_scene_free(scenes[s]);
        }
    }
    return 0;
}
