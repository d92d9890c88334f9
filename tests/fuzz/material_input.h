/* material_input.h - what the fuzz targets of material files share: what is said, an outcome, and numbers in their ranges */
#ifndef WEFT_TESTS_FUZZ_MATERIAL_INPUT_H
#define WEFT_TESTS_FUZZ_MATERIAL_INPUT_H

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "scene/material/material_file.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static inline void demand(int condition) {
    if (!condition) abort();
}

/* Demands that a message is one line. */
static inline void note(void *user, WeftMessage message, const char *text) {
    (void)user;
    (void)message;
    demand(text[0] && !strchr(text, '\n'));
}

/* Demands that a failure says why in one line. */
static inline void demand_outcome(WeftResult result, const WeftError *error) {
    if (result != WEFT_OK) demand(error->result == result && error->text[0] && !strchr(error->text, '\n'));
}

/* Demands that the numbers of a material are finite and in their hard ranges. */
static inline void demand_ranges(const Material *material) {
    for (int k = 0; k < INPUT_COUNT; k++) {
        const WeftInputInfo *info = &input_infos[k];
        const float *value = material->inputs[k].value;
        for (int c = 0; c < (info->kind == WEFT_INPUT_COLOR ? 3 : 1); c++)
            demand(isfinite(value[c]) && value[c] >= info->hard_low && value[c] <= info->hard_high);
    }
}

#endif
