/* fuzz_merl - the reader of measured BRDFs
 *
 * The format has one size, 35 MB: an input would be read twice in a second. So inputs are also read as files
 * of 3 x 4 x 6 bins, by the same code, and the first one laid over a file of the real size. Any input must
 * be read or refused with one line; what is read must be finite. */
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "brdf/merl.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static void demand(int condition) {
    if (!condition) abort();
}

static void take(const void *data, size_t size, MerlShape shape) {
    Merl merl;
    WeftError error;
    float f[3];
    if (merl_read_shape(data, size, shape, "fuzz", &merl, &error) == WEFT_OK)
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

/* A file of a shape whose numbers are the input's bytes, over and over. */
static void take_filled(const uint8_t *data, size_t size, MerlShape shape, uint8_t *file) {
    const int bins[3] = {shape.theta_h, shape.theta_d, shape.phi_d};
    const size_t end = 12 + 24 * (size_t)bins[0] * (size_t)bins[1] * (size_t)bins[2];
    memset(file, 0, 12);
    for (int k = 0; k < 3; k++) file[4 * k] = (uint8_t)bins[k];
    for (size_t k = 12; k < end; k += size) memcpy(file + k, data, end - k < size ? end - k : size);
    take(file, end, shape);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    static const MerlShape real = {MERL_THETA_H, MERL_THETA_D, MERL_PHI_D, false}, small = {3, 4, 6, false};
    static uint8_t file[12 + 24 * 3 * 4 * 6], whole[12 + 24 * MERL_BINS];
    static bool whole_done; /* one takes as long as thousands of small ones */
    take(data, size, real);
    take(data, size, small);
    if (size < 8) return 0;
    take_filled(data, size, small, file);
    if (!whole_done) take_filled(data, size, real, whole);
    whole_done = true;
    return 0;
}
