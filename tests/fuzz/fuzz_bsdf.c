/* fuzz_bsdf - the reader of RGL's .bsdf
 *
 * Any input must be read or refused with one line; what is read must answer with finite numbers, and its samples
 * with directions of length 1. */
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "brdf/rgl.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static void demand(int condition) {
    if (!condition) abort();
}

static void ask(const Rgl *rgl, Dir o, Dir i) {
    float f[3];
    rgl_at(rgl, o, i, f);
    for (int c = 0; c < 3; c++) demand(isfinite(f[c]) && f[c] >= 0.0f);
    float pdf = rgl_pdf(rgl, o, i);
    demand(isfinite(pdf) && pdf >= 0.0f);
    Dir drawn = rgl_sample(rgl, o, 0.5f * (i.x + 1.0f), 0.5f * (i.y + 1.0f));
    float length = dir_dot(drawn, drawn);
    demand(length > 0.99f && length < 1.01f);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    Rgl rgl;
    WeftError error;
    if (rgl_read_memory(data, size, "fuzz", &rgl, &error) == WEFT_OK)
        for (int k = 0; k < 6; k++) {
            float z = (float)(k + 1) / 6.0f, r = (float)(sqrt)((fmax)(1.0 - (double)z * (double)z, 0.0));
            ask(&rgl, dir(r, 0.0f, z), dir(0.0f, -r, z));
            ask(&rgl, dir(-0.6f * r, 0.8f * r, z), dir(0.48f, 0.64f, 0.6f));
        }
    else
        demand(error.text[0] && !strchr(error.text, '\n'));
    rgl_free(&rgl);
    return 0;
}
