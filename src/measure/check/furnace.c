#include "measure/check/furnace.h"

#include "measure/bsdf/draw.h"
#include "measure/bsdf/grid.h"
#include "scene/record/material_at.h"
#include "shading/dialect/warp.h"

/* Returns the reflected light as a midpoint sum, without the part that a random layer rule walks. */
static double still(const SeenStack *seen, int cells, bool random) {
    Grid grid;
    Ring ring;
    double sum = 0.0;
    grid_make(&grid, seen->view.o, cells);
    for (int row = 0; row < cells; row++) {
        grid_ring(&grid, row, &ring);
        for (int c = 0; c < cells; c++) {
            Dir i = dir(ring.x[c], ring.y[c], ring.z[c]);
            /* seen_eval walks by the same seed */
            float bounces = random ? layer_walk_bounces(&seen->stack, &seen->view, slots_all(), i, 0).g : 0.0f;
            sum += (double)(seen_eval(seen, i, 0).f_cos.g - bounces) * ring.area[c];
        }
    }
    return sum;
}

enum { LEAST = 10000 };

/* Returns f cos / pdf of one sample: of all light by the stack's own sampling, or of what a random layer rule
 * walks by the cosine. */
static double weighed(const SeenStack *seen, bool all, float u, float v, uint32_t seed) {
    Dir i = all ? seen_sample(seen, u, v) : warp_cosine(u, v);
    if (!all)
        return (double)(layer_walk_bounces(&seen->stack, &seen->view, slots_all(), i, seed).g / warp_cosine_pdf(i));
    StackValue value = seen_eval(seen, i, seed);
    return value.pdf > 0.0f ? (double)(value.f_cos.g / value.pdf) : 0.0;
}

/* Returns the mean of the samples and its standard error. */
static Furnace walked(const SeenStack *seen, bool all, int walks) {
    Furnace f = {0};
    Draw draw = draw_start(3, 0);
    double squares = 0.0; /* of the distances from the mean: B. P. Welford, Technometrics 4, 1962 */
    for (int n = 1; n <= walks && (n <= LEAST || f.noise > 5e-4); n++) {
        float u = draw_unit(&draw), v = draw_unit(&draw);
        double e = weighed(seen, all, u, v, (uint32_t)n), off = e - f.e;
        f.e += off / n;
        squares += off * (e - f.e);
        f.noise = (sqrt)(squares / n / n);
    }
    return f;
}

Furnace furnace_measure(const Lobe *lobe, float roughness, int layer, const AlbedoTable *e, Dir o, int cells,
                        int walks) {
    Surface surface = surface_default();
    surface.base_color = surface.sheen_color = (Rgb){1.0f, 1.0f, 1.0f};
    surface.sheen_roughness = roughness;
    surface.ior = 1.0f;
    surface.specular = 0.0f; /* no highlight */
    int tilt = weft_lobe_param_find(lobe->id, "tilt"), azimuth = weft_lobe_param_find(lobe->id, "azimuth");
    if (tilt > 0 && azimuth > 0) {
        surface.nap = lobe->params[tilt];
        surface.nap_direction = dir(cos(lobe->params[azimuth]), sin(lobe->params[azimuth]), 0.0f);
    }
    Choices choices = choices_unmade();
    choices.sheen_lobe = lobe->id;
    choices.layer = layer;
    SeenStack seen;
    stack_make(&seen.stack, &surface, &choices, albedo_table_ref(e));
    for (int k = 1; k < LOBE_PARAMS_MAX; k++) seen.stack.sheen.lobe.params[k] = lobe->params[k];
    seen_prepare(&seen, o);

    if (weft_lobe_info(lobe->id)->traits & TRAIT_REFERENCE) return walked(&seen, true, walks / 4);
    bool random = layer == LAYER_STOCHASTIC;
    Furnace f = random ? walked(&seen, false, walks) : (Furnace){0};
    f.e += still(&seen, cells, random);
    return f;
}
