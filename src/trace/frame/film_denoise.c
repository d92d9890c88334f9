/* film_denoise.c - the sums of a film as the planes of a denoiser, and back as a picture */
#include <stdlib.h> /* before the dialect, whose abs() shadows its own */

#include "trace/frame/film.h"

#include "base/fail.h"
#include "image/denoise.h"
#include "image/oidn.h"

static const char *const denoisers[WEFT_DENOISER_COUNT] = {"regression", "oidn"};

const char *weft_denoiser_name(int denoiser) {
    return denoiser >= 0 && denoiser < WEFT_DENOISER_COUNT ? denoisers[denoiser] : NULL;
}

WeftResult weft_denoiser_check(WeftDenoiser denoiser, WeftError *error) {
    if (!weft_denoiser_name((int)denoiser)) return fail(error, WEFT_MESSAGE_DESC, "denoiser", "%d", (int)denoiser);
    return denoiser == WEFT_DENOISER_OIDN ? oidn_check(error) : WEFT_OK;
}

/* Copies a pixel to the planes. A half without samples of it gets the other's mean. */
static void put_planes(const Film *film, int x, int y, DenoisePlanes *planes) {
    size_t at = (size_t)y * planes->stride + (size_t)x;
    float rgba[4], hits[FIRST_NUMBERS];
    for (int h = 0; h < 2; h++) {
        if (!film_pixel(film, h, x, y, rgba)) film_pixel(film, 1 - h, x, y, rgba);
        for (int c = 0; c < 4; c++) planes->color[h][c][at] = rgba[c];
        if (!film_hits(film, h, x, y, hits)) film_hits(film, 1 - h, x, y, hits);
        for (int f = 0; f < DENOISE_NOISY; f++) planes->noisy[h][f][at] = hits[f];
    }
    film_hits(film, FILM_BOTH, x, y, hits);
    planes->feature[FIRST_DEPTH][at] = hits[FIRST_DEPTH];
}

/* Scales depths so that the greatest is 1. */
static void scale_depth(DenoisePlanes *planes) {
    float most = 1e-20f, *depth = planes->feature[FIRST_DEPTH];
    for (int y = 0; y < planes->height; y++)
        for (int x = 0; x < planes->width; x++) most = fmaxf(most, depth[(size_t)y * planes->stride + (size_t)x]);
    for (int y = 0; y < planes->height; y++)
        for (int x = 0; x < planes->width; x++) depth[(size_t)y * planes->stride + (size_t)x] /= most;
}

/* Writes a denoised pixel with straight alpha. */
static void put_pixel(const DenoisePlanes *planes, int x, int y, float *pixel) {
    size_t at = (size_t)y * planes->stride + (size_t)x;
    float alpha = fminf(fmaxf(planes->out[3][at], 0.0f), 1.0f);
    bool full = planes->color[0][3][at] >= 1.0f && planes->color[1][3][at] >= 1.0f;
    bool none = planes->color[0][3][at] <= 0.0f && planes->color[1][3][at] <= 0.0f;
    alpha = full ? 1.0f : none ? 0.0f : alpha;
    for (int c = 0; c < 3 && alpha > 0.0f; c++) pixel[c] = fmaxf(planes->out[c][at], 0.0f) / alpha;
    pixel[3] = alpha;
}

static WeftResult by_regression(const Film *film, int threads, WeftImage *out, WeftError *error) {
    DenoisePlanes planes;
    if (!denoise_planes_create(&planes, film->width, film->height))
        return fail(error, WEFT_MESSAGE_MEMORY, "denoising", NULL);
    for (int y = 0; y < film->height; y++)
        for (int x = 0; x < film->width; x++) put_planes(film, x, y, &planes);
    scale_depth(&planes);
    bool done = denoise(&planes, threads);
    float *pixel = out->pixels;
    for (int y = 0; done && y < film->height; y++)
        for (int x = 0; x < film->width; x++, pixel += 4) put_pixel(&planes, x, y, pixel);
    denoise_planes_free(&planes);
    return done ? WEFT_OK : fail(error, WEFT_MESSAGE_MEMORY, "denoising", NULL);
}

/* Denoises by Open Image Denoise, which takes no coverage: that stays noisy. */
static WeftResult by_oidn(const Film *film, int threads, WeftImage *out, WeftError *error) {
    size_t pixels = (size_t)film->width * (size_t)film->height;
    float *values = alloc_array(pixels, 9 * sizeof(float)), *pixel = out->pixels, rgba[4], hits[FIRST_NUMBERS];
    if (!values) return fail(error, WEFT_MESSAGE_MEMORY, "denoising", NULL);
    const OidnPicture picture = {film->width, film->height, values, values + 3 * pixels, values + 6 * pixels};
    for (size_t k = 0; k < pixels; k++) {
        int x = (int)(k % (size_t)film->width), y = (int)(k / (size_t)film->width);
        film_pixel(film, FILM_BOTH, x, y, rgba);
        film_hits(film, FILM_BOTH, x, y, hits);
        memcpy(picture.color + 3 * k, rgba, 3 * sizeof(float));
        memcpy(picture.albedo + 3 * k, hits + FIRST_ALBEDO, 3 * sizeof(float));
        memcpy(picture.normal + 3 * k, hits + FIRST_NORMAL, 3 * sizeof(float));
        pixel[4 * k + 3] = rgba[3];
    }
    WeftResult result = oidn_denoise(&picture, threads, error);
    for (size_t k = 0; k < pixels; k++)
        for (size_t c = 0; c < 3; c++) {
            float alpha = pixel[4 * k + 3];
            pixel[4 * k + c] = alpha > 0.0f ? picture.color[3 * k + c] / alpha : 0.0f;
        }
    free(values);
    return result;
}

WeftResult film_denoise(const Film *film, WeftDenoiser denoiser, int threads, WeftImage *out, WeftError *error) {
    *out = (WeftImage){0};
    if (film->halves < 2 || !film->hits)
        return fail(error, WEFT_MESSAGE_DESC, "denoising", "it needs halves and first_hits");
    WeftResult result = weft_denoiser_check(denoiser, error);
    if (result == WEFT_OK) result = weft_image_create(film->width, film->height, 4, WEFT_PIXEL_F32, out, error);
    if (result == WEFT_OK)
        result = (denoiser == WEFT_DENOISER_OIDN ? by_oidn : by_regression)(film, threads, out, error);
    if (result != WEFT_OK) weft_image_free(out);
    return result;
}
