#include <stdlib.h>

#include "base/memory.h"
#include "brdf/rgl_make.h"

/* Numbers of R along one axis, which are `stride` apart; at: where they are, NULL if evenly. */
typedef struct TableAxis {
    size_t count, stride;
    const float *at;
} TableAxis;

static double step(TableAxis axis, size_t k) {
    return axis.at ? (double)axis.at[k + 1] - (double)axis.at[k] : 1.0;
}

/* f'' at a node; at an end, that of the node beside it. */
static double second_derivative(const float *line, TableAxis axis, size_t at) {
    const size_t k = at == 0 ? 1 : at == axis.count - 1 ? axis.count - 2 : at;
    const double before = step(axis, k - 1), behind = step(axis, k);
    const double rise = ((double)line[k + 1] - (double)line[k]) / behind,
                 fall = ((double)line[k] - (double)line[k - 1]) / before;
    return 2.0 * (rise - fall) / (before + behind);
}

/* h^2 / 12, its mean over the steps on both sides. */
static double mean_error(TableAxis axis, size_t k) {
    const double before = step(axis, k > 0 ? k - 1 : 0), behind = step(axis, k + 1 < axis.count ? k : k - 1);
    return (before * before + behind * behind) / 24.0;
}

/* Returns true if `first` begins a line along the axis. */
static bool begins(size_t first, TableAxis axis) { return first / axis.stride % axis.count == 0; }

static void axis_sharpen(float *color, size_t count, TableAxis axis, float *line) {
    for (size_t first = 0; first < count; first++) {
        if (!begins(first, axis)) continue;
        for (size_t k = 0; k < axis.count; k++) line[k] = color[first + k * axis.stride];
        for (size_t k = 0; k < axis.count; k++)
            color[first + k * axis.stride] -= (float)(mean_error(axis, k) * second_derivative(line, axis, k));
    }
}

bool rgl_sharpen(Rgl *rgl) {
    const size_t side = (size_t)rgl->side, thetas = (size_t)rgl->thetas, phis = (size_t)rgl->phis,
                 slice = 3 * side * side, most = side > thetas ? side : thetas;
    const TableAxis axes[] = {
        {side, 1, NULL}, {side, side, NULL}, {thetas, slice, rgl->theta}, {phis, slice * thetas, NULL}};
    float *line = alloc_array(most > phis ? most : phis, sizeof *line);
    for (size_t k = 0; line && k < sizeof axes / sizeof *axes; k++)
        if (axes[k].count > 2) axis_sharpen(rgl->color, slice * thetas * phis, axes[k], line);
    free(line);
    return line != NULL;
}
