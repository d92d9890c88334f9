/* fuzz_ltc - the reader of cached LTC tables, once as the bytes are and once with a right hash
 *
 * Any input must be read or refused; sanitizers watch the rest. What was read must be fit to look up in. */
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "measure/ltc_cache.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static void demand(int condition) {
    if (!condition) abort();
}

static void read_and_look_up(const uint8_t *data, size_t size) {
    uint64_t key = 0;
    for (int k = 0; k < 8 && size >= 16; k++) key |= (uint64_t)data[8 + k] << 8 * k;
    WeftLtc ltc = {.low = 0.01f, .high = 1.0f};
    if (!ltc_unpack(data, size, key, &ltc)) {
        demand(!ltc.texels);
        return;
    }
    for (int k = 0; k < 9; k++) {
        float cos_o = (float)(k % 3) / 2.0f;
        LtcLobe l = ltc_table_at(ltc_table_ref(&ltc), cos_o, (float)k / 8.0f);
        demand(isfinite(l.m.det) && l.m.det > 0.0f && l.m.z > 0.0f && l.m.m11 > 0.0f && l.f0 >= 0.0f &&
               l.f90 >= 0.0f);
    }
    free(ltc.texels);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    read_and_look_up(data, size);
    if (size < LTC_TAIL) return 0;
    uint8_t *sealed = malloc(size);
    if (!sealed) return 0;
    memcpy(sealed, data, size);
    ltc_seal(sealed, size);
    read_and_look_up(sealed, size);
    free(sealed);
    return 0;
}
