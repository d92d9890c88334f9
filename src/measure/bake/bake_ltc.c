/* bake_ltc.c - kinds "ltc", "ltc-amplitude" and "ltc-level": linearly transformed cosines of a lobe (weft/ltc.h)
 *
 * The table has axes of its own, columns uniform in the root of cos_o and rows in that of the parameter. */
#include <stdio.h>

#include "measure/bake/bake_texels.h"
#include "weft/ltc.h"

/* Bakes the channels `channels[0 .. count - 1]` of ltc.h; level: r is 0. */
static WeftResult bake(const WeftBakeDesc *desc, const int *channels, int count, bool level, WeftBakeInfo *info,
                       WeftImage *out, WeftError *error) {
    WeftLtc *ltc;
    WeftLtcDesc fit = {.rows = desc->height,
                       .columns = desc->width,
                       .level = level,
                       .threads = desc->threads,
                       .progress = desc->progress,
                       .user = desc->user};
    WeftResult result = weft_ltc_create(desc->lobe, &fit, &ltc, desc->log, error);
    if (result != WEFT_OK) return result;
    WeftLtcInfo made = weft_ltc_info(ltc);
    result = weft_image_create(made.columns, made.rows, count, WEFT_PIXEL_F32, out, error);
    for (int c = 0; result == WEFT_OK && c < count; c++) {
        const float *from = weft_ltc_channel(ltc, channels[c]);
        for (int n = 0; n < made.rows * made.columns; n++) ((float *)out->pixels)[n * count + c] = from[n];
    }
    snprintf(info->words, sizeof info->words,
             "linearly transformed cosines of %s, sqrt(cos_o) to the right, sqrt(parameter) downwards from "
             "%g to %g",
             weft_lobe_info(desc->lobe->lobe)->id, (double)made.low, (double)made.high);
    int used = 0;
    for (int c = 0; c < count; c++)
        used += snprintf(info->channels + used, sizeof info->channels - (size_t)used, "%s%s", c ? ", " : "",
                         weft_ltc_channel_name(channels[c]));
    info->error = (double)made.mean_error;
    weft_ltc_free(ltc);
    return result;
}

WeftResult bake_ltc(const WeftBakeDesc *desc, WeftBakeInfo *info, WeftImage *out, WeftError *error) {
    static const int channels[] = {WEFT_LTC_Z, WEFT_LTC_Q, WEFT_LTC_B, WEFT_LTC_R};
    return bake(desc, channels, 4, false, info, out, error);
}

WeftResult bake_ltc_amplitude(const WeftBakeDesc *desc, WeftBakeInfo *info, WeftImage *out, WeftError *error) {
    static const int channels[] = {WEFT_LTC_AMPLITUDE, WEFT_LTC_AMPLITUDE_F90, WEFT_LTC_ERROR};
    return bake(desc, channels, 3, false, info, out, error);
}

WeftResult bake_ltc_level(const WeftBakeDesc *desc, WeftBakeInfo *info, WeftImage *out, WeftError *error) {
    static const int channels[] = {WEFT_LTC_Z, WEFT_LTC_Q, WEFT_LTC_B, WEFT_LTC_AMPLITUDE};
    return bake(desc, channels, 4, true, info, out, error);
}
