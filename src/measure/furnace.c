#include "measure/furnace.h"

#include "measure/grid.h"

double furnace_measure(const Lobe *lobe, float roughness, int layer, const AlbedoTable *e, Dir o, int cells) {
    const Rgb white = {1.0f, 1.0f, 1.0f};
    Surface surface = {.base_color = white,
                       .sheen_color = white,
                       .sheen_second = white,
                       .sheen = 1.0f,
                       .ior = 1.0f,
                       .sheen_roughness = roughness,
                       .normal = {0.0f, 0.0f, 1.0f},
                       .clearcoat_normal = {0.0f, 0.0f, 1.0f}};
#define CHOICE_UNMADE(name, help) .name = CHOICE_AUTO,
    Choices choices = {SURFACE_CHOICES(CHOICE_UNMADE)};
    choices.sheen_lobe = lobe->id;
    choices.layer = layer;
    Stack stack;
    stack_make(&stack, &surface, &choices, albedo_table_ref(e), o);
    for (int k = 1; k < LOBE_PARAMS_MAX; k++) stack.sheen.lobe.params[k] = lobe->params[k];

    Grid grid;
    Ring ring;
    double sum = 0.0;
    grid_make(&grid, o, cells);
    for (int row = 0; row < cells; row++) {
        grid_ring(&grid, row, &ring);
        for (int c = 0; c < cells; c++) {
            uint32_t seed = (uint32_t)(row * cells + c); /* a random layer rule: another walk in each cell */
            Dir i = dir(ring.x[c], ring.y[c], ring.z[c]);
            sum += (double)stack_eval(&stack, o, i, seed).f_cos.g * ring.area[c];
        }
    }
    return sum;
}
