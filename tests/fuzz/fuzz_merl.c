/* fuzz_merl - the reader of measured BRDFs
 *
 * The format has one size, 35 MB, which no input here has: so an input's bytes are also laid over a file of
 * that size, over and over. Any input must be read or refused with one line; what is read must be finite. */
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "measure/merl.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static void demand(int condition) {
    if (!condition) abort();
}

static void take(const void *data, size_t size) {
    Merl merl;
    WeftError error;
    float f[3];
    if (merl_read_memory(data, size, "fuzz", &merl, &error) == WEFT_OK)
        for (int k = 0; k < 64; k++) {
            float z = (float)(k + 1) / 64.0f, r = (float)(sqrt)((fmax)(1.0 - (double)z * (double)z, 0.0));
            Dir o = {.x = r, .y = 0.0f, .z = z}, i = {.x = 0.0f, .y = r, .z = z};
            merl_at(&merl, o, i, f);
            for (int c = 0; c < 3; c++) demand(isfinite(f[c]) && f[c] >= 0.0f);
        }
    else
        demand(error.text[0] && !strchr(error.text, '\n'));
    merl_free(&merl);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    static uint8_t whole[12 + 3 * MERL_BINS * 8];
    static const uint8_t header[12] = {90, 0, 0, 0, 90, 0, 0, 0, 180};
    take(data, size);
    if (size < 8 || size > 64) return 0; /* a whole file takes its time */
    memcpy(whole, header, sizeof header);
    for (size_t k = sizeof header; k < sizeof whole; k++) whole[k] = data[(k - sizeof header) % size];
    take(whole, sizeof whole);
    return 0;
}
