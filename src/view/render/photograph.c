#define _POSIX_C_SOURCE 200809L
#include "view/render/photograph.h"

#include <pthread.h>
#include <stdatomic.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct PhotographLoad {
    char *path;
    WeftTonemap tonemap;
    float exposure;
    Window *window;
    WeftImage image;
    WeftError error;
    bool good;
    pthread_t thread;
    atomic_bool done;
};

/* Returns the mean of a block of texels' channel, 0 to 255 for integers. */
static float mean_of(const WeftImage *in, int x, int y, int step, int channel) {
    double sum = 0.0;
    int count = 0;
    for (int row = y * step; row < (y + 1) * step && row < in->height; row++)
        for (int column = x * step; column < (x + 1) * step && column < in->width; column++, count++) {
            const size_t at = ((size_t)row * (size_t)in->width + (size_t)column) * (size_t)in->channels;
            const size_t k = at + (size_t)channel;
            sum += in->type == WEFT_PIXEL_U8    ? (double)((const unsigned char *)in->pixels)[k]
                   : in->type == WEFT_PIXEL_U16 ? (double)((const uint16_t *)in->pixels)[k] / 257.0
                                                : (double)((const float *)in->pixels)[k];
        }
    return count ? (float)(sum / (double)count) : 0.0f;
}

/* Makes RGB of one to four channels, reduced by whole steps; integers become U8. */
static WeftResult reduce(const WeftImage *in, WeftImage *out, WeftError *error) {
    const int longer = in->width > in->height ? in->width : in->height,
              step = (longer + PHOTOGRAPH_SIDE - 1) / PHOTOGRAPH_SIDE;
    const bool linear = in->type == WEFT_PIXEL_F32;
    WeftResult result = weft_image_create((in->width + step - 1) / step, (in->height + step - 1) / step, 3,
                                          linear ? WEFT_PIXEL_F32 : WEFT_PIXEL_U8, out, error);
    for (int y = 0; result == WEFT_OK && y < out->height; y++)
        for (int x = 0; x < out->width; x++)
            for (int c = 0; c < 3; c++) {
                const size_t k = 3 * ((size_t)y * (size_t)out->width + (size_t)x) + (size_t)c;
                const float value = mean_of(in, x, y, step, in->channels >= 3 ? c : 0);
                if (linear)
                    ((float *)out->pixels)[k] = value;
                else
                    ((unsigned char *)out->pixels)[k] = (unsigned char)(value + 0.5f);
            }
    return result;
}

static WeftResult load(PhotographLoad *self) {
    WeftImage read, small = {0};
    WeftResult result = weft_image_read(self->path, &read, NULL, &self->error);
    if (result != WEFT_OK) return result;
    result = reduce(&read, &small, &self->error);
    weft_image_free(&read);
    if (result != WEFT_OK || small.type == WEFT_PIXEL_U8) {
        self->image = small;
        return result;
    }
    result = weft_image_tonemap(&small, self->tonemap, self->exposure, &self->image, &self->error);
    weft_image_free(&small);
    return result;
}

static void *work(void *user) {
    PhotographLoad *self = user;
    self->good = load(self) == WEFT_OK;
    atomic_store(&self->done, true);
    window_wake(self->window);
    return NULL;
}

PhotographLoad *photograph_start(const char *path, WeftTonemap tonemap, float exposure, Window *window) {
    PhotographLoad *self = calloc(1, sizeof *self);
    if (!self) return NULL;
    self->path = strdup(path);
    self->tonemap = tonemap;
    self->exposure = exposure;
    self->window = window;
    atomic_init(&self->done, false);
    if (self->path && pthread_create(&self->thread, NULL, work, self) == 0) return self;
    free(self->path);
    free(self);
    return NULL;
}

bool photograph_done(PhotographLoad *self) { return atomic_load(&self->done); }

bool photograph_end(PhotographLoad *self, WeftImage *out, char why[512]) {
    *out = (WeftImage){0};
    if (!self) return false;
    pthread_join(self->thread, NULL);
    const bool good = self->good;
    if (good)
        *out = self->image;
    else
        snprintf(why, 512, "%s", self->error.text[0] ? self->error.text : "out of memory");
    free(self->path);
    free(self);
    return good;
}
