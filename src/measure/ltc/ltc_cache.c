#include <string.h>

#include "measure/ltc/ltc_cache.h"

#include "base/cache.h"
#include "text/assemble/catalogue.h"
#include "text/assemble/dispatch.h"

/* Increased whenever the fit of the same lobe changes. */
enum { FITTER = 3 };

WeftResult ltc_key(const WeftLtc *ltc, uint64_t *key, WeftError *error) {
    Text text;
    text_begin(&text, &(TextDesc){.language = TEXT_GLSL_330, .tables = true});
    text_lobe(&text, ltc->lobe.id);
    text_include(&text, "shading/ltc/ltc_table.h");
    WeftResult result = text_end(&text, error);
    if (result == WEFT_OK) {
        const int sizes[] = {FITTER, ltc->lobe.id, ltc->norm, ltc->rows, ltc->columns, ltc->level};
        const float ranges[] = {ltc->low, ltc->high, ltc->f0, ltc->second};
        uint64_t hash = cache_hash(CACHE_HASH, text.bytes, text.size);
        for (int k = 0; k < text.table_count; k++)
            hash = cache_hash(hash, text.tables[k].texels,
                              (size_t)text.tables[k].rows * (size_t)text.tables[k].columns * sizeof(float));
        hash = cache_hash(hash, sizes, sizeof sizes);
        hash = cache_hash(hash, ranges, sizeof ranges);
        *key = cache_hash(hash, ltc->lobe.params + 1, sizeof ltc->lobe.params - sizeof *ltc->lobe.params);
    }
    text_free(&text);
    return result;
}

/* Returns true if a value meets the conditions of ltc_table.h and products of three are finite. */
static bool is_sound(int plane, float value) {
    if (!(fabsf(value) < 1e9f)) return false;
    return plane == WEFT_LTC_B || (plane == WEFT_LTC_Z ? value > 0.0f : value >= 0.0f);
}

bool ltc_is_sound(const WeftLtc *ltc) {
    size_t plane = (size_t)ltc_cells(ltc), count = plane * WEFT_LTC_CHANNELS;
    bool sound = true;
    for (size_t k = 0; k < count; k++) sound = sound && is_sound((int)(k / plane), ltc->texels[k]);
    return sound;
}

static size_t texels_size(const WeftLtc *ltc) {
    return (size_t)ltc_cells(ltc) * WEFT_LTC_CHANNELS * sizeof *ltc->texels;
}

bool ltc_cache_read(WeftLtc *ltc, uint64_t key, const WeftLog *log) {
    if (!cache_find(key, "ltc", ltc->texels, texels_size(ltc), log)) return false;
    if (ltc_is_sound(ltc)) return true;
    cache_distrust(key, "ltc", log);
    memset(ltc->texels, 0, texels_size(ltc));
    return false;
}

void ltc_cache_write(const WeftLtc *ltc, uint64_t key, const WeftLog *log) {
    cache_keep(key, "ltc", ltc->texels, texels_size(ltc), log);
}
