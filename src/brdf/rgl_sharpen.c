/* rgl_sharpen.c - correction of R for linear interpolation */
#include <stdlib.h>

#include "base/memory.h"
#include "brdf/rgl_make.h"

/* An axis of R. */
typedef struct TableAxis {
    size_t count, stride;
    const float *at; /* coordinates of the nodes; NULL: uniform */
} TableAxis;

static double step(TableAxis axis, size_t k) { return axis.at ? (double)axis.at[k + 1] - (double)axis.at[k] : 1.0; }

/* The weights of the correction before (f(middle - 1) - f(middle)) + behind (f(middle + 1) - f(middle)) of a node. */
typedef struct NodeTaps {
    size_t middle;
    double before, behind;
} NodeTaps;

/* Returns the weights for h^2 f'' / 12, with the mean of h^2 over the steps on both sides. At an end, f'' is that of
 * the next node. */
static NodeTaps taps_of(TableAxis axis, size_t k) {
    const size_t last = axis.count - 1, middle = k == 0 ? 1 : k == last ? last - 1 : k;
    const double left = step(axis, k > 0 ? k - 1 : 0), right = step(axis, k < last ? k : k - 1);
    const double before = step(axis, middle - 1), behind = step(axis, middle);
    const double scale = (left * left + right * right) / 12.0 / (before + behind);
    return (NodeTaps){middle, scale / before, scale / behind};
}

/* Returns true if `first` begins a line along the axis. */
static bool begins(size_t first, TableAxis axis) { return first / axis.stride % axis.count == 0; }

static void axis_sharpen(float *color, size_t count, TableAxis axis, NodeTaps *taps, float *line) {
    for (size_t k = 0; k < axis.count; k++) taps[k] = taps_of(axis, k);
    for (size_t first = 0; first < count; first++) {
        if (!begins(first, axis)) continue;
        for (size_t k = 0; k < axis.count; k++) line[k] = color[first + k * axis.stride];
        for (size_t k = 0; k < axis.count; k++) {
            const float *f = line + taps[k].middle;
            color[first + k * axis.stride] -=
                (float)(taps[k].before * (double)(f[-1] - f[0]) + taps[k].behind * (double)(f[1] - f[0]));
        }
    }
}

bool rgl_sharpen(Rgl *rgl) {
    const size_t side = (size_t)rgl->side, thetas = (size_t)rgl->thetas, phis = (size_t)rgl->phis,
                 slice = 3 * side * side, longer = side > thetas ? side : thetas, most = longer > phis ? longer : phis;
    const TableAxis axes[] = {
        {side, 1, NULL}, {side, side, NULL}, {thetas, slice, rgl->theta}, {phis, slice * thetas, NULL}};
    NodeTaps *taps = alloc_array(most, sizeof *taps);
    float *line = taps ? alloc_array(most, sizeof *line) : NULL;
    for (size_t k = 0; line && k < sizeof axes / sizeof *axes; k++)
        if (axes[k].count > 2) axis_sharpen(rgl->color, slice * thetas * phis, axes[k], taps, line);
    const bool done = line != NULL;
    free(line);
    free(taps);
    return done;
}
