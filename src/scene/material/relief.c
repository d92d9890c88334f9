#include "scene/material/relief.h"
#include "scene/material/backs.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/equal.h"
#include "base/fail.h"
#include "base/thread.h"
#include "scene/material/cloth_fit.h"
#include "scene/material/hair.h"
#include "scene/material/pictures.h"
#include "scene/record/tangents.h"
#include "shading/dialect/texel.h"
#include "weave/weft_cloth.h"

/* One side of an image and of its smoothed copy, which has fewer texels where these are enough. */
typedef struct SmoothedSide {
    int from, to;  /* texels */
    int taps;      /* texels of the image that one of the copy is the mean of */
    int *texels;   /* taps for each texel of the copy, wrapped */
    float *weight; /* of each; the sum of a texel's is 1 */
} SmoothedSide;

typedef struct Smoothing {
    const WeftScene *scene;
    Texture source; /* of the scene, read without interpolation */
    SmoothedSide across, down;
    float *decoded;   /* a row of the image for each thread, 3 numbers a texel */
    float *narrowed;  /* all rows of the image, smoothed across */
    uint16_t *texels; /* of the copy */
} Smoothing;

static int wrapped(int texel, int count, TextureWrap wrap) {
    if (wrap == WRAP_CLAMP) return texel < 0 ? 0 : texel < count ? texel : count - 1;
    const int period = wrap == WRAP_MIRROR ? 2 * count : count, at = (texel % period + period) % period;
    return at < count ? at : period - 1 - at;
}

/* Makes the taps of a side. sigma: of the Gaussian, as a part of the side. Two texels of the copy are as far apart as
 * sigma at most, more than its detail needs. Returns false if memory is short. */
static bool smoothed_side_make(SmoothedSide *side, int from, float sigma, TextureWrap wrap) {
    const float texels = fminf(sigma * (float)from, (float)from);
    *side = (SmoothedSide){.from = from, .to = from, .taps = 2 * (int)ceilf(3.0f * texels) + 1};
    if (texels > 2.0f) side->to = (int)ceilf(2.0f * (float)from / texels);
    side->texels = alloc_array((size_t)side->to * (size_t)side->taps, sizeof *side->texels);
    side->weight = alloc_array((size_t)side->to * (size_t)side->taps, sizeof *side->weight);
    if (!side->texels || !side->weight) return false;
    for (int k = 0; k < side->to; k++) {
        const float centre = ((float)k + 0.5f) * (float)from / (float)side->to - 0.5f;
        const int first = (int)floorf(centre + 0.5f) - side->taps / 2;
        float sum = 0.0f;
        for (int tap = 0; tap < side->taps; tap++) {
            const float x = ((float)(first + tap) - centre) / fmaxf(texels, 0.1f);
            side->texels[k * side->taps + tap] = wrapped(first + tap, from, wrap);
            sum += side->weight[k * side->taps + tap] = expf(-0.5f * x * x);
        }
        for (int tap = 0; tap < side->taps; tap++) side->weight[k * side->taps + tap] /= sum;
    }
    return true;
}

/* Computes texel k of the copy from a line of the image; `step` numbers lie between neighbours. */
static void take_mean(const SmoothedSide *side, int k, const float *line, size_t step, float mean[3]) {
    mean[0] = mean[1] = mean[2] = 0.0f;
    for (int tap = k * side->taps; tap < (k + 1) * side->taps; tap++)
        for (int c = 0; c < 3; c++) mean[c] += side->weight[tap] * line[step * (size_t)side->texels[tap] + (size_t)c];
}

/* Decodes a row of the image and smooths it across. */
static void narrow_row(void *user, int row, int thread) {
    Smoothing *self = user;
    const SmoothedSide *across = &self->across;
    float *line = self->decoded + 3 * (size_t)across->from * (size_t)thread;
    for (int x = 0; x < across->from; x++) {
        const Texel t = texture_fetch(&self->source, self->scene->images, NULL, ((float)x + 0.5f) / (float)across->from,
                                      ((float)row + 0.5f) / (float)self->down.from);
        const Dir n = texel_normal(t.c[0], t.c[1], t.c[2], 1.0f);
        line[3 * x] = n.x, line[3 * x + 1] = n.y, line[3 * x + 2] = n.z;
    }
    float *to = self->narrowed + 3 * (size_t)across->to * (size_t)row;
    for (int k = 0; k < across->to; k++) take_mean(across, k, line, 3, to + 3 * k);
}

static uint16_t encoded(float x) { return (uint16_t)(fminf(fmaxf(0.5f + 0.5f * x, 0.0f), 1.0f) * 65535.0f + 0.5f); }

/* Smooths a row of the copy down the image, and encodes it. */
static void shorten_row(void *user, int row, int thread) {
    Smoothing *self = user;
    const size_t width = (size_t)self->across.to;
    (void)thread;
    for (size_t x = 0; x < width; x++) {
        float n[3];
        take_mean(&self->down, row, self->narrowed + 3 * x, 3 * width, n);
        const float length = fmaxf(sqrtf(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]), 1e-6f);
        for (size_t c = 0; c < 3; c++) self->texels[3 * ((size_t)row * width + x) + c] = encoded(n[c] / length);
    }
}

static void smoothing_free(Smoothing *self) {
    free(self->across.texels);
    free(self->across.weight);
    free(self->down.texels);
    free(self->down.weight);
    free(self->decoded);
    free(self->narrowed);
}

/* Makes the picture of a flat surface: one texel. */
static bool make_flat(WeftImage *out) {
    static const float up[3] = {0.5f, 0.5f, 1.0f};
    if (weft_image_create(1, 1, 3, WEFT_PIXEL_F32, out, NULL) != WEFT_OK) return false;
    memcpy(out->pixels, up, sizeof up);
    return true;
}

/* Makes the smoothed picture of a texture. sigma: of the Gaussian along u and v, as parts of the sides; infinite: a flat
 * surface. Returns false if memory is short. */
static bool smooth(const WeftScene *scene, const Texture *source, const float sigma[2], WeftImage *out) {
    *out = (WeftImage){0};
    if (isinf(sigma[0])) return make_flat(out);
    const WeftImage *image = &scene->images[source->image];
    const size_t width = (size_t)image->width, height = (size_t)image->height;
    Smoothing self = {.scene = scene, .source = *source};
    self.source.nearest = true;
    bool whole = smoothed_side_make(&self.across, image->width, sigma[0], source->wrap_u) &&
                 smoothed_side_make(&self.down, image->height, sigma[1], source->wrap_v);
    if (whole) {
        self.decoded = alloc_array(3 * width * (size_t)thread_count(), sizeof *self.decoded);
        self.narrowed = alloc_array(3 * (size_t)self.across.to * height, sizeof *self.narrowed);
        whole = self.decoded && self.narrowed &&
                weft_image_create(self.across.to, self.down.to, 3, WEFT_PIXEL_U16, out, NULL) == WEFT_OK;
    }
    if (whole) {
        self.texels = out->pixels;
        parallel_for(0, image->height, narrow_row, &self);
        parallel_for(0, self.down.to, shorten_row, &self);
    }
    smoothing_free(&self);
    return whole;
}

/* Computes the Gaussian of a material's relief as parts of the sides of its normal map. Returns false where the map stays
 * as it is, since nothing says how large it is, or its texels are larger than that. */
static bool wanted(const WeftScene *scene, int material, const WeftImage *image, float sigma[2]) {
    const Material *m = &scene->materials[material];
    const Input *input = &m->inputs[INPUT_normal];
    const WeftCloth *cloth = m->cloth ? scene->cloths[m->cloth - 1] : NULL;
    if (!cloth || !(cloth->relief > 0.0f)) return false;
    sigma[0] = sigma[1] = INFINITY;
    if (isinf(cloth->relief)) return true;
    const double metres = input->texcoord ? cloth_uv_metres(scene, material, input->texcoord, NULL) : cloth->metres;
    const float *a = input->transform, area = fabsf(a[0] * a[4] - a[1] * a[3]);
    /* a step of 1 in u of the map is (a4, -a3) / area in texture coordinates, one in v (-a1, a0) / area */
    const float step[2] = {hypotf(a[4], a[3]) / area, hypotf(a[1], a[0]) / area};
    bool finer = false;
    for (int k = 0; k < 2; k++) {
        sigma[k] = cloth->relief / (float)(metres * (double)step[k]);
        if (!isfinite(sigma[k])) return false;
        finer |= sigma[k] * (float)(k ? image->height : image->width) > 0.5f;
    }
    return finer;
}

/* Returns the number of the texture that a material's normal map is to be; 0 if memory is short. source: its number. */
static int fitting(WeftScene *scene, int material, int source) {
    float sigma[2];
    const Texture from = scene->textures[source - 1];
    if (!wanted(scene, material, &scene->images[from.image], sigma)) return source;
    for (int k = 0; k < scene->texture_count; k++) {
        const Texture *t = &scene->textures[k];
        if (t->source == source && is_equal(t->sigma[0], sigma[0]) && is_equal(t->sigma[1], sigma[1])) return k + 1;
    }
    WeftImage image;
    if (!smooth(scene, &from, sigma, &image)) return 0;
    const Texture smoothed = {
        .wrap_u = from.wrap_u, .wrap_v = from.wrap_v, .source = source, .sigma = {sigma[0], sigma[1]}};
    const int number = picture_add(scene, &image, smoothed);
    weft_image_free(&image);
    return number;
}

WeftResult reliefs_fit(WeftScene *scene, WeftError *error) {
    for (int k = 0; k < scene_own_materials(scene); k++) {
        int *texture = &scene->materials[k].inputs[INPUT_normal].texture;
        if (!*texture) continue;
        const int number = fitting(scene, k, relief_source(scene, *texture));
        if (!number) return fail(error, WEFT_MESSAGE_MEMORY, scene->name, NULL);
        *texture = number;
    }
    return WEFT_OK;
}

void reliefs_renew(WeftScene *scene, int image) {
    for (int k = 0; k < scene->texture_count; k++) {
        const Texture smoothed = scene->textures[k];
        WeftImage fresh;
        if (!smoothed.source || scene->textures[smoothed.source - 1].image != image) continue;
        if (smooth(scene, &scene->textures[smoothed.source - 1], smoothed.sigma, &fresh))
            picture_replace(scene, smoothed.image, &fresh, NULL, NULL);
    }
}

WeftResult materials_complete(WeftScene *scene, WeftError *error) {
    WeftResult result = reliefs_fit(scene, error);
    if (result == WEFT_OK) result = backs_fit(scene, error);
    if (result == WEFT_OK) result = tangents_complete(scene, error);
    return result == WEFT_OK ? hairs_fit(scene, error) : result;
}

Material relief_given(const WeftScene *scene, int material) {
    Material given = scene->materials[material];
    int *texture = &given.inputs[INPUT_normal].texture;
    *texture = relief_source(scene, *texture);
    return given;
}
