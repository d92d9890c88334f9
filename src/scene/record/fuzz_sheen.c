#include "scene/record/fuzz_sheen.h"

#include <math.h>

#include "scene/record/material_at.h"

/* The sheen of profile khronos that is nearest to white fuzz of profile khr-fuzz, by roughness of the fuzz from 0 to 1 in
 * equal steps: the least mean of |colour E of the sheen - R of the fuzz| over a sphere in even light. The mean is at most
 * 0.011 from roughness 0.2 to 0.8 (tests/shading/test_fuzz.c). Above 0.8 no sheen is as bright: one of roughness 1 and
 * colour 1 has a mean E of .31, fuzz of roughness 1 a mean R of .46. */
static const struct {
    float roughness, color;
} sheens[] = {{0.083f, 0.0f},  {0.083f, 0.1956f}, {0.117f, 0.5390f}, {0.2f, 0.7920f},
              {0.3f, 0.9477f}, {0.417f, 1.0636f}, {0.55f, 1.0870f},  {0.75f, 1.0231f},
              {1.0f, 1.0658f}, {1.0f, 1.2491f},   {1.0f, 1.4003f}};
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
    for (int c = 0; c < 3; c++) color->value[c] = fminf(color->value[c] * amount, 1.0f);
    roughness->value[0] = mix(sheens[k].roughness, sheens[k + 1].roughness, t);
}

void sheen_fuzz_put(Material *material) {
    Input *inputs = material->inputs, *color = &inputs[INPUT_fuzz_color], *roughness = &inputs[INPUT_fuzz_roughness];
    const float amount = inputs[INPUT_sheen].value[0], *s = inputs[INPUT_sheen_color].value;
    if (material_choices(material).rim == RIM_FUZZ) return;
    const float most = fmaxf(fmaxf(s[0], s[1]), s[2]), wanted = inputs[INPUT_sheen_roughness].value[0];
    inputs[INPUT_fuzz].value[0] = 0.0f;
    if (!(amount * most > 0.0f)) return;
    int k = 1;
    while (k < SHEENS - 4 && sheens[k + 1].roughness < wanted) k++;
    const float step = sheens[k + 1].roughness - sheens[k].roughness;
    const float t = clamp((wanted - sheens[k].roughness) / step, 0.0f, 1.0f);
    *color = inputs[INPUT_sheen_color];
    for (int c = 0; c < 3; c++) color->value[c] /= most;
    *roughness = inputs[INPUT_sheen_roughness];
    roughness->value[0] = (to_float(k) + t) / (SHEENS - 1);
    inputs[INPUT_fuzz].value[0] = fminf(amount * most / mix(sheens[k].color, sheens[k + 1].color, t), 1.0f);
    inputs[INPUT_fuzz].texture = 0;
}
