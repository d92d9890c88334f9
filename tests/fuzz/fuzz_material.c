/* fuzz_material - the material file reader: JSON from memory, without textures, which need a file to lie
 * beside
 *
 * Any input must be read or refused with one line; sanitizers watch the rest. What was read must be fit to
 * shade with: finite, in its hard range, choices that there are. Use the dictionary material.dict. */
#include "material_input.h"
#include "shading/material/choice.h"

static void check(const MaterialFile *file) {
    const Material *material = &file->material;
    demand_ranges(material);
    for (int k = 0; k < INPUT_COUNT; k++) {
        const Input *input = &material->inputs[k];
        demand(input->texture == 0 && input->texcoord <= 1 && input->channel <= 3);
        demand(!(file->keep[k] && file->named[k]));
    }
    for (int k = 0; k < CHOICE_COUNT; k++) {
        int value = material->choices[k];
        demand(value == CHOICE_AUTO || (value >= 0 && choice_id((ChoiceId)k, value)));
    }
    demand(isfinite(material->alpha_cutoff) && file->image_count == 0 && file->texture_count == 0);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    const WeftLog log = {.fn = note};
    MaterialFile file;
    WeftError error;
    WeftResult result = material_file_read(data, size, "fuzz", NULL, &file, &log, &error);
    demand_outcome(result, &error);
    if (result == WEFT_OK) check(&file);
    material_file_free(&file);
    return 0;
}
