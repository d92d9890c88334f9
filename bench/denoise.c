/* denoise - prints how near the estimated error of a render comes to its error, and what denoising leaves of it:
 *
 *   bench_denoise SCENE [HDRI]
 *   spp  relMSE: plain  halves  estimated  denoised  share left  bias  mean  denoised in s
 *
 * Means of SEEDS renders of 320 x 240 against one of many more samples. Denoised pictures of other seeds are off in
 * the same way and by noise of their own; with M the relMSE of their mean and E the mean of their relMSE, the
 * first, the bias, is M - (E - M) / (SEEDS - 1). `mean` is that of all denoised values over that of the reference.
 *
 * Then comes how many pixels of a render of 64 samples are fireflies: more than 10 times as bright as the mean of the
 * eight beside them.
 *
 * Last comes the most that adaptive sampling could gain: with v the relative variance of a pixel that sees a surface, n
 * samples each leave mean(v) / n, and as many of them in proportion to sqrt(v) leave mean(sqrt(v))^2 / n. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/steady_clock.h"
#include "weft/weft.h"

enum { SEEDS = 4, REFERENCE = 1024 };

static _Noreturn void give_up(const WeftError *error) {
    fprintf(stderr, "bench_denoise: %s\n", error->text);
    exit(1);
}

static double relmse(const WeftImage *image, const WeftImage *reference) {
    WeftError error;
    WeftDiff found;
    const WeftDiffDesc desc = {.image = image, .reference = reference};
    if (weft_diff(&desc, &found, NULL, &error) != WEFT_OK) give_up(&error);
    return found.value;
}

typedef struct Shot {
    WeftImage image, denoised, variance, depth; /* but for image: of halves only */
    double noise, seconds;
} Shot;

static Shot shoot(const WeftScene *scene, int spp, unsigned seed, int halves) {
    const WeftRenderDesc desc = {
        .width = 320, .height = 240, .seed = seed, .camera = "0", .halves = halves, .first_hits = halves};
    WeftRenderDesc framed = desc;
    WeftError error;
    WeftRender *render;
    Shot shot = {.noise = -1.0};
    if (weft_scene_info(scene).camera_count == 0) framed.camera = NULL;
    if (weft_render_create(scene, &framed, &render, &error) != WEFT_OK ||
        weft_render_run(render, spp, 0.0, NULL, NULL) != WEFT_OK ||
        weft_render_image(render, &shot.image, &error) != WEFT_OK)
        give_up(&error);
    double start = clock_now();
    if (halves && weft_render_denoised(render, WEFT_DENOISER_REGRESSION, &shot.denoised, &error) != WEFT_OK)
        give_up(&error);
    shot.seconds = clock_now() - start;
    if (halves && (weft_render_aov(render, WEFT_AOV_VARIANCE, &shot.variance, &error) != WEFT_OK ||
                   weft_render_aov(render, WEFT_AOV_DEPTH, &shot.depth, &error) != WEFT_OK))
        give_up(&error);
    shot.noise = weft_render_noise(render);
    weft_render_free(render);
    return shot;
}

static void shot_free(Shot *shot) {
    weft_image_free(&shot->image);
    weft_image_free(&shot->denoised);
    weft_image_free(&shot->variance);
    weft_image_free(&shot->depth);
}

static double sum_of(const WeftImage *image) {
    double sum = 0.0;
    for (int k = 0; k < image->width * image->height * 4; k++) sum += (double)((const float *)image->pixels)[k];
    return sum;
}

/* Adds a share of an image to another one. */
static void add(WeftImage *to, const WeftImage *image, float share) {
    for (int k = 0; k < image->width * image->height * 4; k++)
        ((float *)to->pixels)[k] += share * ((const float *)image->pixels)[k];
}

static void row(const WeftScene *scene, const WeftImage *reference, int spp) {
    double plain = 0.0, halves = 0.0, noise = 0.0, denoised = 0.0, seconds = 0.0;
    WeftImage mean;
    WeftError error;
    if (weft_image_create(320, 240, 4, WEFT_PIXEL_F32, &mean, &error) != WEFT_OK) give_up(&error);
    for (unsigned seed = 1; seed <= SEEDS; seed++) {
        Shot a = shoot(scene, spp, seed, 0), b = shoot(scene, spp, seed, WEFT_HALVES_INDEPENDENT),
             c = shoot(scene, spp, seed, WEFT_HALVES_SHARED);
        plain += relmse(&a.image, reference) / SEEDS;
        halves += relmse(&b.image, reference) / SEEDS;
        denoised += relmse(&c.denoised, reference) / SEEDS;
        noise += b.noise / SEEDS, seconds += c.seconds / SEEDS;
        add(&mean, &c.denoised, 1.0f / SEEDS);
        shot_free(&a);
        shot_free(&b);
        shot_free(&c);
    }
    double of_mean = relmse(&mean, reference), bias = of_mean - (denoised - of_mean) / (SEEDS - 1);
    printf("%5d  %.2e  %.2e  %.2e  %.2e  %.3f  %.2e  %.5f  %.2f\n", spp, plain, halves, noise, denoised,
           denoised / plain, bias, sum_of(&mean) / sum_of(reference), seconds);
    fflush(stdout);
    weft_image_free(&mean);
}

/* Adds the relative variances of a shot. */
static void add_relative(double *to, const Shot *shot, const WeftImage *reference) {
    const float *variance = shot->variance.pixels, *value = reference->pixels;
    for (int k = 0; k < reference->width * reference->height; k++)
        for (int c = 0; c < 3; c++) {
            double r = (double)value[4 * k + c];
            to[k] += (double)variance[3 * k + c] / (r * r + 1e-2);
        }
}

/* The variances of several seeds, smoothed over 5 x 5 pixels: what is left of their own scatter makes the gain look larger. */
static double adaptive_gain(const WeftScene *scene, const WeftImage *reference) {
    enum { R = 2 };
    int w = reference->width, h = reference->height, count = 0;
    double *v = calloc((size_t)w * (size_t)h, sizeof *v), sum = 0.0, roots = 0.0;
    Shot last = {0};
    for (unsigned seed = 1; v && seed <= SEEDS; seed++) {
        shot_free(&last);
        last = shoot(scene, 64, seed, WEFT_HALVES_INDEPENDENT);
        add_relative(v, &last, reference);
    }
    for (int y = R; v && y < h - R; y++)
        for (int x = R; x < w - R; x++) {
            double around = 0.0;
            if (((const float *)last.depth.pixels)[y * w + x] > 1e9f) continue;
            for (int j = -R; j <= R; j++)
                for (int i = -R; i <= R; i++) around += v[(y + j) * w + x + i];
            sum += around, roots += sqrt(around), count++;
        }
    shot_free(&last);
    free(v);
    return sum * count / (roots * roots);
}

static double light_of(const WeftImage *image, int x, int y) {
    const float *p = (const float *)image->pixels + 4 * (y * image->width + x);
    return (double)(p[0] + p[1] + p[2]);
}

/* Their mean number over the seeds. */
static double fireflies(const WeftScene *scene) {
    int count = 0;
    for (unsigned seed = 1; seed <= SEEDS; seed++) {
        Shot shot = shoot(scene, 64, seed, 0);
        for (int y = 1; y + 1 < shot.image.height; y++)
            for (int x = 1; x + 1 < shot.image.width; x++) {
                double mean = 1e-6;
                for (int k = 0; k < 9; k++)
                    if (k != 4) mean += light_of(&shot.image, x + k % 3 - 1, y + k / 3 - 1) / 8.0;
                count += light_of(&shot.image, x, y) > 10.0 * mean;
            }
        shot_free(&shot);
    }
    return (double)count / SEEDS;
}

int main(int count, char **arguments) {
    WeftScene *scene;
    WeftError error;
    const WeftLog silent = {0};
    if (count < 2) {
        fprintf(stderr, "usage: bench_denoise SCENE [HDRI]\n");
        return 2;
    }
    if (weft_scene_load(arguments[1], &scene, &silent, &error) != WEFT_OK ||
        (count > 2 && weft_scene_set_environment_file(scene, arguments[2], &silent, &error) != WEFT_OK))
        give_up(&error);
    Shot reference = shoot(scene, REFERENCE, 99, 0);
    printf("  spp  plain     halves    estimated denoised  left   bias      mean     s\n");
    for (int spp = 4; spp <= 64; spp *= 4) row(scene, &reference.image, spp);
    printf("fireflies at 64: %.2f of %d pixels\n", fireflies(scene), 320 * 240);
    printf("adaptive sampling at 64 gains %.2f at most\n", adaptive_gain(scene, &reference.image));
    shot_free(&reference);
    weft_scene_free(scene);
    return 0;
}
