#include "cli/render/sums_file.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "weft/weft.h"

enum { SIDE = WEFT_RENDER_TILE, HEAD = WEFT_RENDER_TILE_HEAD };

/* Names the channels of layer k of those of a render with so many sums a pixel; returns how many there are. */
static int layer_names(int k, int numbers, char names[4][SUMS_NAME]) {
    const int first = 4 * (k - 1), left = numbers - first, channels = k == 0 ? HEAD : left < 4 ? left : 4;
    for (int c = 0; c < channels; c++)
        snprintf(names[c], SUMS_NAME, k == 0 ? "head.%d" : "sums.%03d", k == 0 ? c : first + c);
    return channels;
}

static int layer_count(int numbers) { return 1 + (numbers + 3) / 4; }

static size_t tile_size(int numbers) { return HEAD + (size_t)(SIDE * SIDE * numbers); }

/* Copies one tile between its numbers and the layers. */
static void tile_copy(TileSums *sums, int numbers, int tile, float *at, bool to_layers) {
    const int width = sums->images[0].width, height = sums->images[0].height, across = (width + SIDE - 1) / SIDE;
    for (int p = 0; p < SIDE * SIDE && across > 0; p++) {
        const int x = tile % across * SIDE + p % SIDE, y = tile / across * SIDE + p / SIDE;
        for (int k = 0; x < width && y < height && k < sums->count; k++) {
            const WeftImage *image = &sums->images[k];
            const size_t size = (size_t)image->channels * sizeof(float);
            if (!image->pixels) continue;
            float *pixel = (float *)image->pixels + ((size_t)y * (size_t)width + (size_t)x) * (size_t)image->channels;
            float *number = k == 0 ? at : at + HEAD + p * numbers + 4 * (k - 1);
            if (to_layers)
                memcpy(pixel, number, size);
            else
                memcpy(number, pixel, size);
        }
    }
}

WeftResult sums_make(const WeftRender *render, int width, int height, TileSums *sums, WeftError *error) {
    const int numbers = weft_render_tile_numbers(render), tiles = weft_render_tile_count(render);
    float *at = calloc(tile_size(numbers), sizeof *at);
    WeftResult result = WEFT_OK;
    *sums = (TileSums){.count = 0};
    if (!at) return failure(error, WEFT_RESOURCES, "out of memory");
    for (int k = 0; k < layer_count(numbers) && result == WEFT_OK; k++) {
        const int channels = layer_names(k, numbers, sums->names[k]);
        result = weft_image_create(width, height, channels, WEFT_PIXEL_F32, &sums->images[k], error);
        if (result == WEFT_OK) sums->count++;
    }
    for (int tile = 0; tile < tiles && result == WEFT_OK; tile++) {
        weft_render_tile(render, tile, at);
        tile_copy(sums, numbers, tile, at, true);
    }
    free(at);
    if (result != WEFT_OK) sums_free(sums);
    return result;
}

void sums_free(TileSums *sums) {
    for (int k = 0; k < sums->count; k++) weft_image_free(&sums->images[k]);
    sums->count = 0;
}

int sums_layers(const TileSums *sums, WeftImageLayer layers[SUMS_LAYERS]) {
    for (int k = 0; k < sums->count; k++) {
        layers[k] = (WeftImageLayer){.image = &sums->images[k]};
        for (int c = 0; c < sums->images[k].channels; c++) layers[k].channels[c] = sums->names[k][c];
    }
    return sums->count;
}

static WeftResult refuse(WeftError *error, const char *path, const char *text) {
    char line[sizeof error->text];
    snprintf(line, sizeof line, "%.300s: %.200s", path, text);
    return failure(error, WEFT_INPUT, line);
}

/* Reads the layers of a file. */
static WeftResult layers_read(const char *path, int width, int height, int numbers, TileSums *sums, WeftError *error) {
    WeftResult result = WEFT_OK;
    for (int k = 0; k < layer_count(numbers) && result == WEFT_OK; k++) {
        char names[4][SUMS_NAME];
        const char *const channels[4] = {names[0], names[1], names[2], names[3]};
        const int count = layer_names(k, numbers, names);
        result = weft_image_read_channels(path, channels, count, &sums->images[k], NULL, error);
        if (result == WEFT_OK) sums->count++;
        if (result == WEFT_OK && (sums->images[k].width != width || sums->images[k].height != height))
            result = refuse(error, path, "has not the size that it says: it is damaged");
    }
    return result;
}

/* Gives the render a tile, if that has more samples. mine: room for a tile. */
static WeftResult tile_give(const char *path, int block, WeftRender *render, int tile, const float *at, float *mine,
                            WeftError *error) {
    char text[120];
    if (!(at[0] + at[1] > 0.0f)) return WEFT_OK;
    weft_render_tile(render, tile, mine);
    if (!(at[0] + at[1] > mine[0] + mine[1])) return WEFT_OK;
    if (block && fmod((double)(at[0] + at[1]), (double)block) > 0.0) {
        snprintf(text, sizeof text, "ends at %.9g samples a pixel; more can be added after a multiple of %d only",
                 (double)(at[0] + at[1]), block);
        return refuse(error, path, text);
    }
    if (weft_render_tile_set(render, tile, at, NULL) == WEFT_OK) return WEFT_OK;
    return refuse(error, path, "has sums that are none: it is damaged");
}

WeftResult sums_read(const char *path, int width, int height, const unsigned char *wanted, int block,
                     WeftRender *render, WeftError *error) {
    const int numbers = weft_render_tile_numbers(render), tiles = weft_render_tile_count(render);
    float *at = calloc(2 * tile_size(numbers), sizeof *at);
    TileSums sums = {.count = 0};
    if (!at) return failure(error, WEFT_RESOURCES, "out of memory");
    WeftResult result = layers_read(path, width, height, numbers, &sums, error);
    for (int tile = 0; tile < tiles && result == WEFT_OK; tile++) {
        if (wanted && !wanted[tile]) continue;
        tile_copy(&sums, numbers, tile, at, false);
        result = tile_give(path, block, render, tile, at, at + tile_size(numbers), error);
    }
    sums_free(&sums);
    free(at);
    return result;
}
