/* bake_ltc.c - kinds "ltc" and "ltc-amplitude": linearly transformed cosines of a lobe (weft/ltc.h)
 *
 * The table has axes of its own, columns uniform in the root of cos_o and rows in that of the parameter. */
#include <stdio.h>

#include "measure/bake.h"
#include "weft/ltc.h"

static WeftResult bake(const WeftBakeDesc *desc, int first, int channels, WeftBakeInfo *info, WeftImage *out,
                       WeftError *error) {
    WeftLtc *ltc;
    WeftLtcDesc fit = {.rows = desc->height,
                       .columns = desc->width,
                       .threads = desc->threads,
                       .progress = desc->progress,
                       .user = desc->user};
    WeftResult result = weft_ltc_make(desc->lobe, &fit, &ltc, NULL, error);
    if (result != WEFT_OK) return result;
    WeftLtcInfo made = weft_ltc_info(ltc);
    result = weft_image_create(made.columns, made.rows, channels, WEFT_PIXEL_F32, out, error);
    for (int c = 0; result == WEFT_OK && c < channels; c++) {
        const float *from = weft_ltc_channel(ltc, first + c);
        for (int n = 0; n < made.rows * made.columns; n++) ((float *)out->pixels)[n * channels + c] = from[n];
    }
    snprintf(info->words, sizeof info->words,
             "linearly transformed cosines of %s, sqrt(cos_o) to the right, sqrt(parameter) downwards from "
             "%g to %g",
             weft_lobe_info(desc->lobe->lobe)->id, (double)made.low, (double)made.high);
    int used = 0;
    for (int c = 0; c < channels; c++)
        used += snprintf(info->channels + used, sizeof info->channels - (size_t)used, "%s%s", c ? ", " : "",
                         weft_ltc_channel_name(first + c));
    info->error = (double)made.mean_error;
    weft_ltc_free(ltc);
    return result;
}

WeftResult bake_ltc(const WeftBakeDesc *desc, WeftBakeInfo *info, WeftImage *out, WeftError *error) {
    return bake(desc, WEFT_LTC_Z, 4, info, out, error);
}

WeftResult bake_ltc_amplitude(const WeftBakeDesc *desc, WeftBakeInfo *info, WeftImage *out,
                              WeftError *error) {
    return bake(desc, WEFT_LTC_AMPLITUDE, 3, info, out, error);
}
