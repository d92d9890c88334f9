#include "gltf/save/fuzz_sheen.h"

#include "scene/record/material_at.h"

/* The sheen of profile khronos that is nearest to white fuzz, by roughness R of the fuzz from 0 to 1 in equal steps, on a
 * base of 0.2: `weft match khr-fuzz:sheen_color=1,sheen_roughness=R khronos --metric picture --hold base_color --hold
 * roughness --hold specular`. */
static const struct {
    float roughness, color;
} sheens[] = {{0.0042f, 0.0002f}, {0.05f, 0.0078f},   {0.1120f, 0.1434f}, {0.1784f, 0.3375f},
              {0.2544f, 0.5253f}, {0.3622f, 0.6995f}, {0.5532f, 0.7911f}, {0.9317f, 0.7657f},
              {1.0f, 0.9511f},    {1.0f, 1.0f},       {1.0f, 1.0f}};
enum { SHEENS = sizeof sheens / sizeof *sheens };

static bool is_black(const Input *input) {
    return !(input->value[0] > 0.0f || input->value[1] > 0.0f || input->value[2] > 0.0f);
}

void fuzz_sheen_put(Material *material) {
    Input *inputs = material->inputs, *color = &inputs[INPUT_sheen_color], *roughness = &inputs[INPUT_sheen_roughness];
    if (material_choices(material).rim != RIM_FUZZ || is_black(&inputs[INPUT_fuzz]) || !is_black(color)) return;
    const float at = clamp(inputs[INPUT_fuzz_roughness].value[0], 0.0f, 1.0f) * (SHEENS - 1);
    const int k = (int)at < SHEENS - 2 ? (int)at : SHEENS - 2;
    const float t = at - (float)k, amount = inputs[INPUT_fuzz].value[0] * mix(sheens[k].color, sheens[k + 1].color, t);
    *color = inputs[INPUT_fuzz_color];
    *roughness = inputs[INPUT_fuzz_roughness];
    for (int c = 0; c < 3; c++) color->value[c] *= amount;
    roughness->value[0] = mix(sheens[k].roughness, sheens[k + 1].roughness, t);
}
