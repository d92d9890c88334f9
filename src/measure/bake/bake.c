/* bake.c - weft_bake: the table of kinds, and the checks that all of them share */
#include "measure/bake/bake_texels.h"

#include "base/fail.h"

#define KIND(id, maker, lobe, formed, width, height, help) {id, help, lobe, formed, width, height},
static const WeftBakeKind kinds[] = {BAKE_KINDS(KIND)};
#define MAKER(id, maker, lobe, formed, width, height, help) maker,
static BakeMaker *const makers[] = {BAKE_KINDS(MAKER)};
enum { KINDS = sizeof kinds / sizeof kinds[0] };

const WeftBakeKind *weft_bake_kind(int index) { return index >= 0 && index < KINDS ? &kinds[index] : NULL; }

static int kind_find(const char *id) {
    for (int k = 0; id && k < KINDS; k++)
        if (strcmp(kinds[k].id, id) == 0) return k;
    return -1;
}

static WeftResult size_check(int width, int height, WeftError *error) {
    if (width >= 1 && height >= 1 && width <= 65536 && height <= 65536 &&
        (int64_t)width * height <= WEFT_BAKE_TEXELS_MAX)
        return WEFT_OK;
    return fail(error, WEFT_MESSAGE_DESC, "size", "%d x %d; a table has 1 to %d texels and sides up to 65536", width,
                height, WEFT_BAKE_TEXELS_MAX);
}

WeftResult weft_bake(const WeftBakeDesc *desc, WeftBakeInfo *info, WeftImage *out, WeftError *error) {
    WeftBakeDesc full = *desc;
    WeftBakeInfo own;
    if (!info) info = &own;
    *info = (WeftBakeInfo){0};
    *out = (WeftImage){0};
    int k = kind_find(desc->kind);
    if (k < 0) return fail(error, WEFT_MESSAGE_BAKE_KIND, desc->kind ? desc->kind : "kind", NULL);
    if (!full.width) full.width = kinds[k].width;
    if (!full.height) full.height = kinds[k].height;
    if (!(full.tolerance > 0.0)) full.tolerance = 1e-4;
    WeftResult result = size_check(full.width, full.height, error);
    if (result != WEFT_OK) return result;
    if (desc->lobe ? !weft_lobe_info(desc->lobe->lobe) || !kinds[k].lobe : kinds[k].lobe == 2)
        return fail(error, WEFT_MESSAGE_DESC, kinds[k].id, desc->lobe ? "a lobe it does not take" : "it needs a lobe");
    if (desc->threads < 0 || desc->threads > WEFT_THREADS_MAX)
        return fail(error, WEFT_MESSAGE_DESC, "threads", "%d", desc->threads);
    result = makers[k](&full, info, out, error);
    if (result != WEFT_OK) return result;
    const float *values = out->pixels;
    const size_t count = (size_t)out->width * (size_t)out->height * (size_t)out->channels;
    info->low = info->high = values[0];
    for (size_t n = 1; n < count; n++) {
        info->low = fminf(info->low, values[n]);
        info->high = fmaxf(info->high, values[n]);
    }
    return WEFT_OK;
}
