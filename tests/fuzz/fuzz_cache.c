/* fuzz_cache - the reader of files of the cache, once as the bytes are and once with a right hash, and its numbers as
 * an LTC table
 *
 * Any input must be read or refused; sanitizers watch the rest. A table that is called sound must be fit to look up
 * in. */
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "base/cache.h"
#include "measure/ltc/ltc_cache.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static void demand(int condition) {
    if (!condition) abort();
}

static void look_up(float *texels, int cells) {
    WeftLtc ltc = {.low = 0.01f, .high = 1.0f, .rows = cells % 3 ? 1 : 3, .texels = texels};
    ltc.columns = cells / ltc.rows;
    if (ltc.columns < 2 || !ltc_is_sound(&ltc)) return;
    for (int k = 0; k < 9; k++) {
        LtcLobe l = ltc_table_at(ltc_table_ref(&ltc), (float)(k % 3) / 2.0f, (float)k / 8.0f);
        demand(isfinite(l.m.det) && l.m.det > 0.0f && l.m.z > 0.0f && l.m.m11 > 0.0f && l.f0 >= 0.0f && l.f90 >= 0.0f);
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    const size_t cell = WEFT_LTC_CHANNELS * sizeof(float);
    size_t room = size + CACHE_EXTRA;
    uint64_t key = 0;
    uint8_t *back = malloc(room), *file = malloc(room);
    float *texels = malloc(room);
    if (back && file && texels) {
        memcpy(&key, data + (size >= 16 ? 8 : 0), size >= 16 ? 8 : 0);
        for (size_t n = 0; n <= size; n += 1 + size / 7)
            if (cache_unpack(data, size, key, back, n)) demand(n == size - CACHE_EXTRA);
        cache_pack(key, data, size, file);
        demand(cache_unpack(file, room, key, back, size) && memcmp(back, data, size) == 0);
        demand(!cache_unpack(file, room, key + 1, back, size));
        memcpy(texels, data, size);
        if (size >= cell) look_up(texels, (int)(size / cell));
    }
    free(texels);
    free(file);
    free(back);
    return 0;
}
