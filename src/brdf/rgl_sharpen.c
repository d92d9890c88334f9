#include <stdlib.h>

#include "base/memory.h"
#include "brdf/rgl_make.h"

/* Numbers of R along one axis, which are `stride` apart. */
typedef struct TableAxis {
    size_t count, stride;
} TableAxis;

/* The second difference at a node; at an end, that of the node beside it. */
static float second_difference(const float *line, size_t count, size_t at) {
    const size_t k = at == 0 ? 1 : at == count - 1 ? count - 2 : at;
    return line[k - 1] - 2.0f * line[k] + line[k + 1];
}

/* Returns true if `first` begins a line along the axis. */
static bool begins(size_t first, TableAxis axis) { return first / axis.stride % axis.count == 0; }

static void axis_sharpen(float *color, size_t count, TableAxis axis, float *line) {
    for (size_t first = 0; first < count; first++) {
        if (!begins(first, axis)) continue;
        for (size_t k = 0; k < axis.count; k++) line[k] = color[first + k * axis.stride];
        for (size_t k = 0; k < axis.count; k++)
            color[first + k * axis.stride] -= second_difference(line, axis.count, k) / 12.0f;
    }
}

bool rgl_sharpen(Rgl *rgl) {
    const size_t side = (size_t)rgl->side, thetas = (size_t)rgl->thetas, phis = (size_t)rgl->phis,
                 slice = 3 * side * side, most = side > thetas ? side : thetas;
    const TableAxis axes[] = {{side, 1}, {side, side}, {thetas, slice}, {phis, slice * thetas}};
    float *line = alloc_array(most > phis ? most : phis, sizeof *line);
    for (size_t k = 0; line && k < sizeof axes / sizeof *axes; k++)
        if (axes[k].count > 2) axis_sharpen(rgl->color, slice * thetas * phis, axes[k], line);
    free(line);
    return line != NULL;
}
