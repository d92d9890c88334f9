#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "measure/ltc_cache.h"

#include "base/cache.h"
#include "base/fail.h"
#include "base/file.h"
#include "base/memory.h"
#include "text/catalogue.h"
#include "text/dispatch.h"

/* Raised whenever the same lobe would be fitted otherwise. */
enum { FITTER = 2 };

enum { SIDE_MOST = 256 };
static const unsigned char magic[8] = {'w', 'e', 'f', 't', '-', 'l', 't', 'c'};

WeftResult ltc_key(const WeftLtc *ltc, uint64_t *key, WeftError *error) {
    Text text;
    text_begin(&text, &(TextDesc){.language = TEXT_GLSL_330, .tables = true});
    text_lobe(&text, ltc->lobe.id);
    text_include(&text, "shading/ltc_table.h");
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

static void put(unsigned char *to, uint64_t value, int bytes) {
    for (int k = 0; k < bytes; k++) to[k] = (unsigned char)(value >> 8 * k);
}
static uint64_t get(const unsigned char *from, int bytes) {
    uint64_t value = 0;
    for (int k = 0; k < bytes; k++) value |= (uint64_t)from[k] << 8 * k;
    return value;
}

void ltc_seal(unsigned char *data, size_t size) {
    put(data + size - LTC_TAIL, cache_hash(CACHE_HASH, data, size - LTC_TAIL), 8);
}

/* Returns true if a number meets the conditions of ltc_table.h and products of three are finite. */
static bool may_be(int plane, float value) {
    if (!(fabsf(value) < 1e9f)) return false;
    return plane == WEFT_LTC_B || (plane == WEFT_LTC_Z ? value > 0.0f : value >= 0.0f);
}

bool ltc_unpack(const unsigned char *data, size_t size, uint64_t key, WeftLtc *out) {
    out->texels = NULL;
    if (size < LTC_HEAD + LTC_TAIL || memcmp(data, magic, sizeof magic) != 0 || get(data + 8, 8) != key)
        return false;
    uint64_t rows = get(data + 16, 4), columns = get(data + 20, 4);
    if (rows < 1 || rows > SIDE_MOST || columns < 2 || columns > SIDE_MOST) return false;
    size_t plane = (size_t)(rows * columns), count = plane * WEFT_LTC_CHANNELS;
    if (size != LTC_HEAD + 4 * count + LTC_TAIL) return false;
    if (get(data + size - LTC_TAIL, 8) != cache_hash(CACHE_HASH, data, size - LTC_TAIL)) return false;
    out->rows = (int)rows;
    out->columns = (int)columns;
    if (!ltc_create(out)) return false;
    bool good = true;
    for (size_t k = 0; k < count; k++) {
        uint32_t bits = (uint32_t)get(data + LTC_HEAD + 4 * k, 4);
        memcpy(&out->texels[k], &bits, 4);
        good = good && may_be((int)(k / plane), out->texels[k]);
    }
    if (!good) {
        free(out->texels);
        out->texels = NULL;
    }
    return good;
}

bool ltc_cache_read(WeftLtc *ltc, uint64_t key, const WeftLog *log) {
    char path[CACHE_PATH_SIZE];
    FileBytes file;
    WeftError error;
    struct stat status;
    if (!cache_path(path, key, "ltc") || stat(path, &status) != 0) return false;
    size_t most = LTC_HEAD + 4 * (size_t)ltc_cells(ltc) * WEFT_LTC_CHANNELS + LTC_TAIL;
    if (file_read(path, most, &file, &error) != WEFT_OK) {
        warn(log, WEFT_MESSAGE_CACHE_IGNORED, path, "%s", weft_message_text(error.message));
        return false;
    }
    WeftLtc read = *ltc;
    bool good = ltc_unpack(file.data, file.size, key, &read);
    free(file.data);
    if (good && read.rows == ltc->rows && read.columns == ltc->columns) {
        free(ltc->texels);
        ltc->texels = read.texels;
        return true;
    }
    if (good) free(read.texels);
    warn(log, WEFT_MESSAGE_CACHE_IGNORED, path, "it is damaged");
    return false;
}

void ltc_cache_write(const WeftLtc *ltc, uint64_t key, const WeftLog *log) {
    size_t count = (size_t)ltc_cells(ltc) * WEFT_LTC_CHANNELS, size = LTC_HEAD + 4 * count + LTC_TAIL;
    unsigned char *data = alloc_array(size, 1);
    if (!data) return;
    memcpy(data, magic, sizeof magic);
    put(data + 8, key, 8);
    put(data + 16, (uint64_t)ltc->rows, 4);
    put(data + 20, (uint64_t)ltc->columns, 4);
    for (size_t k = 0; k < count; k++) {
        uint32_t bits;
        memcpy(&bits, &ltc->texels[k], 4);
        put(data + LTC_HEAD + 4 * k, bits, 4);
    }
    ltc_seal(data, size);
    cache_write(key, "ltc", data, size, log);
    free(data);
}
