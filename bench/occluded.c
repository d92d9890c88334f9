/* occluded - prints what neighbours leave of a sheen's light from an environment: how the raster engine's sum
 * over a picture differs from the path tracer's direct light, in hundredths
 *
 *   bench_occluded [--only LOBE] [--rays N] MAP.hdr ...
 *
 * On builtin:spheres and builtin:cloth, whose lobes below the sheen are black and whose lights are off. First
 * the sums, below 0 where the drawing is darker, then sum |difference| over sum. --rays: those of a vertex.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "weft/weft.h"

enum { WIDTH = 160, HEIGHT = 120, SAMPLES = 64 };

static void check(WeftResult result, const WeftError *error) {
    if (result == WEFT_OK) return;
    fprintf(stderr, "bench_occluded: %s\n", error->text);
    exit(1);
}

static WeftScene *scene_of(const char *name, const char *map, const char *lobe) {
    static const char *const settings[][2] = {
        {"*.base_color", "0"}, {"*.specular", "0"}, {"*.layer", "additive"}};
    WeftScene *scene;
    WeftError error;
    check(weft_scene_load(name, &scene, NULL, &error), &error);
    while (weft_scene_info(scene).light_count > 0) check(weft_scene_remove_light(scene, 0, &error), &error);
    check(weft_scene_set_environment_file(scene, map, NULL, &error), &error);
    for (int k = 0; k < 3; k++)
        check(weft_scene_set(scene, settings[k][0], settings[k][1], NULL, &error), &error);
    check(weft_scene_set(scene, "*.sheen_lobe", lobe, NULL, &error), &error);
    return scene;
}

static WeftImage traced(const WeftScene *scene) {
    const WeftRenderDesc desc = {.width = WIDTH,
                                 .height = HEIGHT,
                                 .max_depth = 1,
                                 .camera = "0",
                                 .background = WEFT_BACKGROUND_TRANSPARENT};
    WeftRender *render;
    WeftImage image;
    WeftError error;
    check(weft_render_create(scene, &desc, &render, &error), &error);
    check(weft_render_run(render, SAMPLES, 0.0, NULL, NULL), &error);
    check(weft_render_image(render, &image, &error), &error);
    weft_render_free(render);
    return image;
}

static WeftImage drawn(const WeftScene *scene, int rays) {
    const WeftRasterDesc desc = {.occlusion = rays, .no_cache = 1};
    const WeftRasterView view = {
        .width = WIDTH, .height = HEIGHT, .camera = "0", .background = WEFT_BACKGROUND_TRANSPARENT};
    WeftRaster *raster;
    WeftImage image;
    WeftError error;
    check(weft_raster_create(scene, &desc, &raster, NULL, &error), &error);
    check(weft_raster_wait(raster, &error), &error);
    check(weft_raster_draw(raster, &view, &error), &error);
    check(weft_raster_image(raster, &image, &error), &error);
    weft_raster_free(raster);
    return image;
}

/* Of means over blocks, in which noise is small. */
static void compare(const WeftImage *image, const WeftImage *reference, double *sum, double *apart) {
    enum { BLOCK = 4 };
    const float *p = image->pixels, *q = reference->pixels;
    double more = 0.0, off = 0.0, all = 0.0;
    for (int block = 0; block < WIDTH / BLOCK * (HEIGHT / BLOCK) * 3; block++) {
        int b = block / 3, x = b % (WIDTH / BLOCK) * BLOCK, y = b / (WIDTH / BLOCK) * BLOCK;
        double difference = 0.0;
        for (int k = 0; k < BLOCK * BLOCK; k++) {
            int at = 4 * ((y + k / BLOCK) * WIDTH + x + k % BLOCK), c = at + block % 3;
            difference += (double)(p[c] * p[at + 3] - q[c] * q[at + 3]);
            all += (double)(q[c] * q[at + 3]);
        }
        more += difference;
        off += fabs(difference);
    }
    *sum = more / all;
    *apart = off / all;
}

int main(int argc, char **argv) {
    static const char *const scenes[] = {"builtin:spheres", "builtin:cloth"};
    const char *maps[8], *only = NULL;
    int map_count = 0, rays = 64;
    for (int k = 1; k < argc; k++) {
        if (strcmp(argv[k], "--only") == 0 && k + 1 < argc)
            only = argv[++k];
        else if (strcmp(argv[k], "--rays") == 0 && k + 1 < argc)
            rays = atoi(argv[++k]);
        else if (map_count < 8)
            maps[map_count++] = argv[k];
    }
    for (int m = 0; m < map_count; m++) {
        const char *slash = strrchr(maps[m], '/');
        printf("\n%s\n%-27s  spheres    cloth  spheres    cloth\n", slash ? slash + 1 : maps[m], "lobe");
        for (int lobe = 0; weft_lobe_info(lobe); lobe++) {
            const WeftLobeInfo *info = weft_lobe_info(lobe);
            double sum[2], apart[2];
            if (info->traits & (WEFT_LOBE_REFERENCE | WEFT_LOBE_DIFFUSE)) continue;
            if (only && strcmp(only, info->id) != 0) continue;
            for (int s = 0; s < 2; s++) {
                WeftScene *scene = scene_of(scenes[s], maps[m], info->id);
                WeftImage reference = traced(scene), image = drawn(scene, rays);
                compare(&image, &reference, &sum[s], &apart[s]);
                weft_image_free(&reference);
                weft_image_free(&image);
                weft_scene_free(scene);
            }
            printf("%-27s %8.1f %8.1f %8.1f %8.1f\n", info->id, 100.0 * sum[0], 100.0 * sum[1],
                   100.0 * apart[0], 100.0 * apart[1]);
            fflush(stdout);
        }
    }
    return 0;
}
