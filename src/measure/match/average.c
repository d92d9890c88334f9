#include "measure/match/average.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "image/pixel.h"

static double linear_of(double x) { return x <= 0.04045 ? x / 12.92 : pow((x + 0.055) / 1.055, 2.4); }

/* Returns the place of red, green, blue or alpha among an image's channels, -1 if there is none. */
static int place_of(int channel, int channels) {
    if (channel == 3) return channels & 1 ? -1 : channels - 1;
    return channels < 3 ? 0 : channel;
}

double texture_value(const WeftImage *image, size_t pixel, int channel, bool color) {
    const int at = place_of(channel, image->channels);
    const double x = at < 0 ? 1.0 : pixel_value(image, pixel * (size_t)image->channels + (size_t)at);
    return color && at >= 0 && image->type != WEFT_PIXEL_F32 ? linear_of(x) : x;
}

TextureChannel texture_channel(const WeftImage *image, int channel, bool color) {
    TextureChannel out = {true, 1.0, 1.0, 1.0};
    double sum = 0.0;
    const size_t pixels = (size_t)image->width * (size_t)image->height;
    if (place_of(channel, image->channels) < 0 || pixels == 0) return out;
    out.low = (double)INFINITY;
    out.high = -(double)INFINITY;
    for (size_t k = 0; k < pixels; k++) {
        const double x = texture_value(image, k, channel, color);
        sum += x;
        out.low = fmin(out.low, x);
        out.high = fmax(out.high, x);
    }
    out.mean = sum / (double)pixels;
    return out;
}

/* Makes room for the means of that many textures. */
static bool make_room(Averages *averages, int textures) {
    if (textures <= averages->count) return true;
    TextureChannel(*grown)[2][4] = realloc_array(averages->means, (size_t)textures, sizeof *grown);
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
        TextureChannel *kept = &averages->means[of->texture - 1][color][channel];
        if (!kept->done) *kept = texture_channel(&image, channel, color);
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
