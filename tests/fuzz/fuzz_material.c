/* fuzz_material - the material file reader: JSON from memory, without textures, which need a file to lie
 * beside
 *
 * Any input must be read or refused with one line; sanitizers watch the rest. What was read must be fit to
 * shade with: finite, in its hard range, choices that there are. Use the dictionary material.dict. */
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "scene/material/material_file.h"
#include "shading/material/choice.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static void demand(int condition) {
    if (!condition) abort();
}

static void check(const MaterialFile *file) {
    const Material *material = &file->material;
    for (int k = 0; k < INPUT_COUNT; k++) {
        const WeftInputInfo *info = &input_infos[k];
        const Input *input = &material->inputs[k];
        for (int c = 0; c < (info->kind == WEFT_INPUT_COLOR ? 3 : 1); c++)
            demand(isfinite(input->value[c]) && input->value[c] >= info->hard_low &&
                   input->value[c] <= info->hard_high);
        demand(input->texture == 0 && input->texcoord <= 1 && input->channel <= 3);
        demand(!(file->keep[k] && file->named[k]));
    }
    for (int k = 0; k < CHOICE_COUNT; k++) {
        int value = material->choices[k];
        demand(value == CHOICE_AUTO || (value >= 0 && choice_id((ChoiceId)k, value)));
    }
    demand(isfinite(material->alpha_cutoff) && file->image_count == 0 && file->texture_count == 0);
}

static void note(void *user, WeftMessage message, const char *text) {
    (void)user;
    (void)message;
    demand(text[0] && !strchr(text, '\n'));
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    const WeftLog log = {.fn = note};
    MaterialFile file;
    WeftError error;
    WeftResult result = material_file_read(data, size, "fuzz", NULL, &file, &log, &error);
    if (result == WEFT_OK)
        check(&file);
    else
        demand(error.result == result && error.text[0] && !strchr(error.text, '\n'));
    material_file_free(&file);
    return 0;
}
