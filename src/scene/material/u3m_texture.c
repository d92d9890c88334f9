#include "scene/material/u3m_texture.h"

#include <math.h>
#include <string.h>

#include "base/equal.h"
#include "base/pi.h"
#include "image/pixel.h"

const char *const u3m_modes[U3M_MODES + 1] = {"add", "subtract", "multiply", "divide", "max", "min", "overlay", NULL};

/* Returns a mixed with b, both linear, as "Additional specification of U3M", 2020, has it. */
static float mixed(U3mMode mode, float a, float b) {
    switch (mode) {
    case U3M_ADD: return a + b;
    case U3M_SUBTRACT: return a - b;
    case U3M_DIVIDE: return b > 0.0f ? a / b : 1.0f;
    case U3M_MAX: return fmaxf(a, b);
    case U3M_MIN: return fminf(a, b);
    case U3M_OVERLAY: return a < 0.5f ? 2.0f * a * b : 1.0f - 2.0f * (1.0f - a) * (1.0f - b);
    case U3M_MULTIPLY:
    case U3M_MODES: break;
    }
    return a * b;
}

bool u3m_texture_grey(const WeftImage *image) {
    if (image->channels < 3) return true;
    const size_t size = pixel_type_size(image->type), step = size * (size_t)image->channels,
                 pixels = (size_t)image->width * (size_t)image->height;
    const unsigned char *p = image->pixels;
    for (size_t k = 0; k < pixels; k++, p += step)
        if (memcmp(p, p + size, size) != 0 || memcmp(p, p + 2 * size, size) != 0) return false;
    return true;
}

bool u3m_texture_plain(const U3mField *field, const U3mFormula *formula, const WeftImage *image, float value[3]) {
    const WeftInputInfo *info = &input_infos[field->input];
    if (field->kind == U3M_NORMAL) {
        value[0] = fminf(fmaxf(formula->factor[0], info->hard_low), info->hard_high);
        return true;
    }
    if (field->kind == U3M_COLOR) {
        memcpy(value, formula->factor, 3 * sizeof *value);
        return formula->mode == U3M_MULTIPLY;
    }
    value[0] = formula->factor[0];
    return is_equal(formula->offset, 0.0f) && is_equal(field->scale, 1.0f) && is_equal(field->offset, 0.0f) &&
           value[0] >= info->hard_low && value[0] <= info->hard_high && u3m_texture_grey(image);
}

static float number_of(const U3mField *field, const U3mFormula *formula, const float *p, int channels) {
    const float mean = channels < 3 ? p[0] : (p[0] + p[1] + p[2]) / 3.0f,
                x = field->offset + field->scale * (formula->offset + formula->factor[0] * mean);
    const WeftInputInfo *info = &input_infos[field->input];
    return isfinite(x) ? fminf(fmaxf(x, info->hard_low), info->hard_high) : field->offset;
}

/* Computes one texel: a colour, a number, or a direction as the two channels of a map of directions. */
static void make_texel(const U3mField *field, const U3mFormula *formula, const float *p, int channels, float *to) {
    if (field->kind == U3M_COLOR) {
        for (int c = 0; c < 3; c++)
            to[c] = fminf(fmaxf(mixed(formula->mode, p[channels < 3 ? 0 : c], formula->factor[c]), 0.0f), 1.0f);
        return;
    }
    to[0] = number_of(field, formula, p, channels);
    if (input_infos[field->input].kind != WEFT_INPUT_DIRECTION) return;
    const float angle = to[0] * (PI_FLOAT / 180.0f);
    to[0] = 0.5f + 0.5f * cosf(angle);
    to[1] = 0.5f + 0.5f * sinf(angle);
    to[2] = 0.5f;
}

WeftResult u3m_texture_make(const U3mField *field, const U3mFormula *formula, WeftImage *image, float value[3],
                            WeftError *error) {
    const bool direction = input_infos[field->input].kind == WEFT_INPUT_DIRECTION;
    const int channels = field->kind == U3M_COLOR || direction ? 3 : 1;
    WeftImage from = {0}, to = {0};
    WeftResult result = weft_image_convert_f32(image, field->kind == U3M_COLOR, &from, error);
    if (result == WEFT_OK) result = weft_image_create(from.width, from.height, channels, WEFT_PIXEL_F32, &to, error);
    const size_t pixels = (size_t)from.width * (size_t)from.height;
    const float *read = from.pixels;
    float *write = to.pixels;
    for (size_t k = 0; k < pixels && result == WEFT_OK; k++)
        make_texel(field, formula, read + k * (size_t)from.channels, from.channels, write + k * (size_t)channels);
    weft_image_free(&from);
    if (result != WEFT_OK) return result;
    weft_image_free(image);
    *image = to;
    for (int c = 0; c < 3; c++) value[c] = direction ? 0.0f : 1.0f;
    return WEFT_OK;
}
