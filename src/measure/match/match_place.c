#include "measure/match/match_place.h"

#include <math.h>

bool place_same(const Input *a, const Input *b) {
    bool same = a->texcoord == b->texcoord;
    for (int k = 0; k < 6; k++) same = same && fabsf(a->transform[k] - b->transform[k]) < 1e-6f;
    return same;
}

Texel place_texel(const WeftScene *scene, const WeftMaterial *material, InputId id, float u, float v) {
    const Input *input = &material->inputs[id];
    const SrgbTable *srgb = input_value_count(id) > 1 ? &scene->srgb : NULL;
    if (!input->texture) return (Texel){{1.0f, 1.0f, 1.0f, 1.0f}};
    return texture_fetch(&scene->textures[input->texture - 1], scene->images, srgb, u, v);
}

double place_number(const WeftScene *scene, const WeftMaterial *material, InputId id, float u, float v) {
    const Input *input = &material->inputs[id];
    return (double)(place_texel(scene, material, id, u, v).c[input->channel] * input->value[0]);
}

double place_brightness(const WeftScene *scene, const WeftMaterial *material, float u, float v) {
    const Input *color = &material->inputs[INPUT_sheen_color];
    const Texel texel = place_texel(scene, material, INPUT_sheen_color, u, v);
    double most = 0.0;
    for (int c = 0; c < 3; c++) most = fmax(most, (double)(texel.c[c] * color->value[c]));
    return most;
}

InputId place_driver(const MatchCurves *curves) {
    return curves->columns > 1 ? INPUT_sheen_roughness : INPUT_sheen_color;
}

/* The inputs of which a node has a mean. */
static const InputId inputs[] = {INPUT_base_color, INPUT_sheen_color, INPUT_roughness, INPUT_metallic};
enum { INPUTS = sizeof inputs / sizeof *inputs };

/* Adds a place to the sums of a node. */
static void mean_add(NodeMean *mean, double weight, double value[INPUTS][3]) {
    mean->weight += weight;
    for (int c = 0; c < 3; c++) {
        mean->base_color[c] += weight * value[0][c];
        mean->sheen_color[c] += weight * value[1][c];
    }
    mean->roughness += weight * value[2][0];
    mean->metallic += weight * value[3][0];
}

static void mean_divide(NodeMean *mean) {
    if (!(mean->weight > 0.0)) return;
    for (int c = 0; c < 3; c++) {
        mean->base_color[c] /= mean->weight;
        mean->sheen_color[c] /= mean->weight;
    }
    mean->roughness /= mean->weight;
    mean->metallic /= mean->weight;
}

void place_means(const WeftScene *scene, const WeftMaterial *material, const WeftMaterial *average,
                 MatchCurves *curves) {
    enum { SIDE = 256 };
    const Input *driver = &material->inputs[place_driver(curves)];
    for (int k = 0; k < SIDE * SIDE && curves_vary_sheen(curves); k++) {
        const int row = k / SIDE, column = k % SIDE;
        const float u = ((float)column + 0.5f) / SIDE, v = ((float)row + 0.5f) / SIDE;
        double value[INPUTS][3] = {{0.0}};
        for (int n = 0; n < INPUTS; n++) {
            const Input *input = &material->inputs[inputs[n]];
            const int count = input_value_count(inputs[n]);
            const bool here = input->texture && place_same(input, driver);
            const Texel texel = here ? place_texel(scene, material, inputs[n], u, v) : (Texel){{0.0f}};
            for (int c = 0; c < count; c++)
                value[n][c] = here ? (double)(input->value[c] * texel.c[count > 1 ? c : input->channel])
                                   : (double)average->inputs[inputs[n]].value[c];
        }
        CurvePlace at[4];
        curves_around(curves, place_number(scene, material, INPUT_sheen_roughness, u, v),
                      place_brightness(scene, material, u, v), at);
        for (int n = 0; n < 4; n++) mean_add(&curves->mean[at[n].row][at[n].column], at[n].weight, value);
    }
    for (int r = 0; r < curves->rows; r++)
        for (int k = 0; k < curves->columns; k++) mean_divide(&curves->mean[r][k]);
}
