#include "measure/match/average.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "image/pixel.h"

static double linear_of(double x) { return x <= 0.04045 ? x / 12.92 : pow((x + 0.055) / 1.055, 2.4); }

/* Returns the place of red, green, blue or alpha among an image's channels, -1 if there is none. With one channel or
 * two, the first is grey and is used for all three colours; with two or four, the last is alpha. */
static int place_of(int channel, int channels) {
    if (channel == 3) return channels & 1 ? -1 : channels - 1;
    return channels < 3 ? 0 : channel;
}

/* Returns the mean of a channel over a texture's pixels. color: integers are decoded from sRGB. */
static double texture_mean(const WeftImage *image, int channel, bool color) {
    const size_t pixels = (size_t)image->width * (size_t)image->height;
    const int at = place_of(channel, image->channels);
    double sum = 0.0;
    if (at < 0 || pixels == 0) return 1.0;
    for (size_t k = 0; k < pixels; k++) {
        const double x = pixel_value(image, k * (size_t)image->channels + (size_t)at);
        sum += color && image->type != WEFT_PIXEL_F32 ? linear_of(x) : x;
    }
    return sum / (double)pixels;
}

/* Makes room for the means of that many textures. */
static bool make_room(Averages *averages, int textures) {
    if (textures <= averages->count) return true;
    TextureMean(*grown)[2][4] = realloc_array(averages->means, (size_t)textures, sizeof *grown);
    if (!grown) return false;
    memset(grown + averages->count, 0, (size_t)(textures - averages->count) * sizeof *grown);
    averages->means = grown;
    averages->count = textures;
    return true;
}

bool averages_of(Averages *averages, const WeftMaterial *material, int input, double means[3]) {
    const WeftInput *of = &material->inputs[input];
    WeftInputInfo info;
    for (int c = 0; c < 3; c++) means[c] = 1.0;
    if (!of->texture || !weft_material_input_info(input, &info)) return true;
    if (info.kind == WEFT_INPUT_NORMAL || info.kind == WEFT_INPUT_DIRECTION) return true;
    if (!make_room(averages, of->texture)) return false;
    const WeftImage image = weft_scene_texture(averages->scene, of->texture);
    const bool color = info.kind == WEFT_INPUT_COLOR;
    for (int c = 0; c < (color ? 3 : 1); c++) {
        const int channel = color ? c : of->channel;
        TextureMean *kept = &averages->means[of->texture - 1][color][channel];
        if (!kept->done) *kept = (TextureMean){true, texture_mean(&image, channel, color)};
        means[c] = kept->mean;
    }
    return true;
}

bool averages_take(Averages *averages, WeftMaterial *material) {
    double means[3];
    for (int k = 0; weft_material_input_name(k); k++) {
        if (!averages_of(averages, material, k, means)) return false;
        for (int c = 0; c < 3; c++) {
            float *value = &material->inputs[k].value[c];
            *value = (float)((double)*value * means[c]);
        }
    }
    for (int k = 0; k < WEFT_INPUTS_MAX; k++) material->inputs[k].texture = 0;
    return true;
}

void averages_free(Averages *averages) {
    free(averages->means);
    *averages = (Averages){.scene = NULL};
}
