#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "measure/ltc_cache.h"

#include "base/fail.h"
#include "base/file.h"
#include "base/memory.h"
#include "text/catalogue.h"
#include "text/dispatch.h"

/* Raised whenever the same lobe would be fitted otherwise. */
enum { FITTER = 2 };

enum { SIDE_MOST = 256 };
static const unsigned char magic[8] = {'w', 'e', 'f', 't', '-', 'l', 't', 'c'};

/* FNV-1a: Glenn Fowler, Landon Curt Noll, Kiem-Phong Vo, 1991. */
static uint64_t hash_bytes(uint64_t hash, const void *data, size_t size) {
    const unsigned char *bytes = data;
    for (size_t k = 0; k < size; k++) hash = (hash ^ bytes[k]) * 0x100000001b3u;
    return hash;
}
static const uint64_t hash_start = 0xcbf29ce484222325u;

WeftResult ltc_key(const WeftLtc *ltc, uint64_t *key, WeftError *error) {
    Text text;
    text_begin(&text, &(TextDesc){.language = TEXT_GLSL_330, .tables = true});
    text_lobe(&text, ltc->lobe.id);
    text_include(&text, "shading/ltc_table.h");
    WeftResult result = text_end(&text, error);
    if (result == WEFT_OK) {
        const int sizes[] = {FITTER, ltc->lobe.id, ltc->norm, ltc->rows, ltc->columns, ltc->level};
        const float ranges[] = {ltc->low, ltc->high, ltc->f0, ltc->second};
        uint64_t hash = hash_bytes(hash_start, text.bytes, text.size);
        for (int k = 0; k < text.table_count; k++)
            hash = hash_bytes(hash, text.tables[k].texels,
                              (size_t)text.tables[k].rows * (size_t)text.tables[k].columns * sizeof(float));
        hash = hash_bytes(hash, sizes, sizeof sizes);
        hash = hash_bytes(hash, ranges, sizeof ranges);
        *key = hash_bytes(hash, ltc->lobe.params + 1, sizeof ltc->lobe.params - sizeof *ltc->lobe.params);
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
    put(data + size - LTC_TAIL, hash_bytes(hash_start, data, size - LTC_TAIL), 8);
}

/* What ltc_table.h asks of its numbers, and what products of three of them can hold. */
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
    if (get(data + size - LTC_TAIL, 8) != hash_bytes(hash_start, data, size - LTC_TAIL)) return false;
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

/* The cache's folder as the XDG Base Directory Specification has it (freedesktop.org, version 0.8, 2021): a
 * path that is not absolute does not count. False where the user has none, or it is too long. */
static bool cache_folder(char *folder, size_t size) {
    const char *cache = getenv("XDG_CACHE_HOME"), *home = getenv("HOME");
    if (cache && cache[0] == '/') return (size_t)snprintf(folder, size, "%s/weft", cache) < size;
    return home && home[0] == '/' && (size_t)snprintf(folder, size, "%s/.cache/weft", home) < size;
}

enum { PATH_SIZE = 4096 };

static bool cache_path(char path[PATH_SIZE], uint64_t key) {
    char folder[PATH_SIZE - 32];
    if (!cache_folder(folder, sizeof folder)) return false;
    snprintf(path, PATH_SIZE, "%s/%016llx.ltc", folder, (unsigned long long)key);
    return true;
}

bool ltc_cache_read(WeftLtc *ltc, uint64_t key, const WeftLog *log) {
    char path[PATH_SIZE];
    FileBytes file;
    WeftError error;
    struct stat status;
    if (!cache_path(path, key) || stat(path, &status) != 0) return false;
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

/* Makes a folder and those it is in. What fails here fails again, with a reason, when the file is opened. */
static void make_folders(char *path) {
    for (char *c = path + 1; *c; c++)
        if (*c == '/') {
            *c = 0;
            mkdir(path, 0700);
            *c = '/';
        }
}

static bool write_packed(const WeftLtc *ltc, uint64_t key, FILE *stream) {
    size_t count = (size_t)ltc_cells(ltc) * WEFT_LTC_CHANNELS, size = LTC_HEAD + 4 * count + LTC_TAIL;
    unsigned char *data = alloc_array(size, 1);
    if (!data) return false;
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
    bool written = fwrite(data, 1, size, stream) == size;
    free(data);
    return written;
}

void ltc_cache_write(const WeftLtc *ltc, uint64_t key, const WeftLog *log) {
    char path[PATH_SIZE];
    OutputFile file;
    WeftError error;
    if (!cache_path(path, key)) {
        warn(log, WEFT_MESSAGE_CACHE_IGNORED, "$HOME", "it is no absolute path");
        return;
    }
    make_folders(path);
    WeftResult result = output_open(&file, path, &error);
    if (result == WEFT_OK && !write_packed(ltc, key, file.stream)) {
        result = fail(&error, WEFT_MESSAGE_FILE_WRITE, path, "%s", strerror(errno));
        output_discard(&file);
    } else if (result == WEFT_OK) {
        result = output_commit(&file, &error);
    }
    if (result != WEFT_OK) warn(log, WEFT_MESSAGE_CACHE_IGNORED, path, "it cannot be written");
}
