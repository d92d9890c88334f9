/* summed - prints how far the mean of frames of the raster engine is from the path tracer's direct light
 *
 *   study_summed [--frames N] [--spp N] [--width N] [--keep FOLDER] [--light MAP.hdr|softbox]... SCENE[@PRESET]...
 *
 * Each scene is lit by each of the maps, and by a softbox: a polygon above the camera's side of it. Its own lights are
 * taken away. `pixels` and `8 x 8` are sum |difference| over sum, of pixels and of means over 8 x 8 pixels, in
 * hundredths, `mean` is the difference of the sums. After `/` is what as many samples of the path tracer, of another
 * seed, have: the noise that no strategy of theirs avoids. --keep: a folder for path traced pictures, which are read
 * from there the next time. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "weft/weft.h"

enum { LIGHTS_MOST = 8, BLOCK = 8, PATH = 1024 };

/* Settings of all pictures. */
typedef struct How {
    int width, height, frames, spp;
    const char *keep; /* a folder, or NULL */
} How;

/* Ratios to the sum of the path traced picture. */
typedef struct Off {
    double pixels, blocks, mean;
} Off;

static void check(WeftResult result, const WeftError *error) {
    if (result == WEFT_OK) return;
    fprintf(stderr, "study_summed: %s\n", error->text);
    exit(1);
}

/* Returns what follows the last slash. */
static const char *last_part(const char *path) {
    const char *slash = strrchr(path, '/');
    return slash ? slash + 1 : path;
}

/* Adds a panel as large as the scene, half a scene above it, on the side of a camera that looks along -z. */
static void add_softbox(WeftScene *scene) {
    const WeftSceneInfo info = weft_scene_info(scene);
    const float black[3] = {0.0f, 0.0f, 0.0f};
    float side = 0.0f;
    for (int k = 0; k < 3; k++) side = fmaxf(side, info.high[k] - info.low[k]);
    const WeftLight panel = {.kind = WEFT_LIGHT_POLYGON,
                             .position = {0.5f * (info.low[0] + info.high[0]) - 0.3f * side, info.high[1] + 0.5f * side,
                                          info.high[2] + 0.3f * side},
                             .direction = {0.3f, -1.0f, -0.6f},
                             .color = {6.0f, 5.7f, 5.2f},
                             .size = {side, 0.7f * side}};
    WeftError error;
    check(weft_scene_set_environment_color(scene, black, &error), &error);
    check(weft_scene_add_light(scene, &panel, &error), &error);
}

/* Loads SCENE[@PRESET] under a light. */
static WeftScene *scene_of(const char *what, const char *light) {
    char name[PATH], preset[PATH];
    const char *at = strchr(what, '@');
    WeftScene *scene;
    WeftError error;
    snprintf(name, sizeof name, "%.*s", at ? (int)(at - what) : (int)strlen(what), what);
    check(weft_scene_load(name, &scene, NULL, &error), &error);
    while (weft_scene_info(scene).light_count > 0) check(weft_scene_remove_light(scene, 0, &error), &error);
    check(weft_scene_set(scene, "*.emission_strength", "0", NULL, &error), &error);
    if (strcmp(light, "softbox") == 0)
        add_softbox(scene);
    else
        check(weft_scene_set_environment_file(scene, light, NULL, &error), &error);
    snprintf(preset, sizeof preset, "preset:%s", at ? at + 1 : "");
    if (at) check(weft_scene_assign_material(scene, NULL, preset, NULL, &error), &error);
    return scene;
}

/* Returns the first camera, or that which frames a scene without any. */
static const char *camera_of(const WeftScene *scene) { return weft_scene_info(scene).camera_count ? "0" : NULL; }

static WeftImage render(const WeftScene *scene, const How *how, uint32_t seed, int spp) {
    const WeftRenderDesc desc = {.width = how->width,
                                 .height = how->height,
                                 .max_depth = 1,
                                 .seed = seed,
                                 .camera = camera_of(scene),
                                 .background = WEFT_BACKGROUND_TRANSPARENT};
    WeftRender *render;
    WeftImage image;
    WeftError error = {0};
    check(weft_render_create(scene, &desc, &render, &error), &error);
    check(weft_render_run(render, spp, 0.0, NULL, NULL), &error);
    check(weft_render_image(render, &image, &error), &error);
    weft_render_free(render);
    return image;
}

/* Returns a path traced picture, kept or new. */
static WeftImage traced(const WeftScene *scene, const How *how, uint32_t seed, int spp) {
    char path[PATH];
    WeftImage image;
    WeftError error;
    snprintf(path, sizeof path, "%s/%016llx-%dx%d-%u-%d.npy", how->keep ? how->keep : "",
             (unsigned long long)weft_scene_hash(scene), how->width, how->height, seed, spp);
    if (how->keep && weft_image_read(path, &image, NULL, NULL) == WEFT_OK) return image;
    image = render(scene, how, seed, spp);
    if (how->keep) check(weft_image_write(path, &image, &error), &error);
    return image;
}

static WeftImage summed(const WeftScene *scene, const How *how) {
    const WeftRasterView view = {.camera = camera_of(scene),
                                 .width = how->width,
                                 .height = how->height,
                                 .background = WEFT_BACKGROUND_TRANSPARENT};
    WeftRaster *raster;
    WeftImage image;
    WeftError error;
    int done = 0;
    check(weft_raster_create(scene, &(WeftRasterDesc){.occlusion = 0}, &raster, NULL, &error), &error);
    check(weft_raster_accumulate_begin(raster, &view, how->frames, &error), &error);
    while (done < how->frames) check(weft_raster_accumulate(raster, 1.0, &done, &error), &error);
    check(weft_raster_image(raster, &image, &error), &error);
    weft_raster_free(raster);
    return image;
}

/* Returns a colour times its alpha. */
static double seen(const WeftImage *image, int x, int y, int c) {
    const float *p = (const float *)image->pixels + 4 * ((size_t)y * (size_t)image->width + (size_t)x);
    return (double)p[c] * (double)p[3];
}

static Off compare(const WeftImage *a, const WeftImage *b) {
    double sum = 0.0, pixels = 0.0, blocks = 0.0, all = 0.0;
    for (int k = 0; k < 3 * (a->width / BLOCK) * (a->height / BLOCK); k++) {
        const int left = k / 3 % (a->width / BLOCK) * BLOCK, top = k / 3 / (a->width / BLOCK) * BLOCK;
        double block = 0.0;
        for (int at = 0; at < BLOCK * BLOCK; at++) {
            const int x = left + at % BLOCK, y = top + at / BLOCK;
            const double p = seen(a, x, y, k % 3), q = seen(b, x, y, k % 3);
            sum += q, pixels += fabs(p - q), block += p - q;
        }
        blocks += fabs(block), all += block;
    }
    return (Off){100.0 * pixels / sum, 100.0 * blocks / sum, 100.0 * all / sum};
}

static void print_row(const char *what, const char *light, const How *how) {
    WeftScene *scene = scene_of(what, light);
    WeftImage image = summed(scene, how), reference = traced(scene, how, 0, how->spp),
              noisy = traced(scene, how, 1, how->frames);
    const Off off = compare(&image, &reference), noise = compare(&noisy, &reference);
    printf("| %s | %s | %.2f / %.2f | %.2f / %.2f | %+.2f |\n", last_part(what), last_part(light), off.pixels,
           noise.pixels, off.blocks, noise.blocks, off.mean);
    fflush(stdout);
    weft_image_free(&image);
    weft_image_free(&reference);
    weft_image_free(&noisy);
    weft_scene_free(scene);
}

int main(int argc, char **argv) {
    const char *lights[LIGHTS_MOST];
    int light_count = 0, k = 1;
    How how = {.width = 96, .frames = 256, .spp = 4096};
    for (; k + 1 < argc && strncmp(argv[k], "--", 2) == 0; k += 2) {
        if (strcmp(argv[k], "--frames") == 0) how.frames = atoi(argv[k + 1]);
        if (strcmp(argv[k], "--spp") == 0) how.spp = atoi(argv[k + 1]);
        if (strcmp(argv[k], "--width") == 0) how.width = atoi(argv[k + 1]);
        if (strcmp(argv[k], "--keep") == 0) how.keep = argv[k + 1];
        if (strcmp(argv[k], "--light") == 0 && light_count < LIGHTS_MOST) lights[light_count++] = argv[k + 1];
    }
    how.height = how.width * 2 / 3;
    printf("| scene | light | pixels | 8 x 8 | mean |\n|---|---|---|---|---|\n");
    for (; k < argc; k++)
        for (int at = 0; at < light_count; at++) print_row(argv[k], lights[at], &how);
    return 0;
}
