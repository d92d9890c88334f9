#include "measure/bsdf/grid.h"

#include "base/pi.h"

/* Maps x in (0, 1) to (0, 1), flat at both ends. Its derivative and its inverse follow. */
static double stretch(double x) {
    double a = x * x * x * x, y = 1.0 - x, b = y * y * y * y;
    return a / (a + b);
}
static double stretch_slope(double x) {
    double y = 1.0 - x, xy = x * y, n = x * x * x * x + y * y * y * y;
    return 4.0 * xy * xy * xy / (n * n);
}
static double unstretch(double m) {
    if (m >= 1.0) return 1.0;
    double r = (sqrt)((sqrt)(m / (1.0 - m)));
    return r / (1.0 + r);
}

Dir grid_direction(double cosine, double phi) {
    double s = (sqrt)(fmax(1.0 - cosine * cosine, 0.0));
    return dir((float)(s * (cos)(phi)), (float)(s * (sin)(phi)), (float)cosine);
}

static double polar(Dir w) { return atan2(hypot((double)w.x, (double)w.y), (double)w.z); }

GridLine grid_column(const Grid *grid, double t) {
    double side = t < 0.0 ? -1.0 : 1.0, phi = grid->phi + side * PI_DOUBLE * stretch(fabs(t));
    return (GridLine){(float)(cos)(phi), (float)(sin)(phi), PI_DOUBLE * stretch_slope(fabs(t))};
}

GridLine grid_row(const Grid *grid, double s) {
    double side = s < 0.0 ? -1.0 : 1.0, range = s < 0.0 ? grid->theta : PI_DOUBLE / 2.0 - grid->theta;
    double theta = grid->theta + side * range * stretch(fabs(s));
    return (GridLine){(float)(cos)(theta), (float)(sin)(theta), range * stretch_slope(fabs(s)) * (sin)(theta)};
}

/* Returns the middle of a cell along a side. */
static double middle(int k, int cells) { return -1.0 + 2.0 * (k + 0.5) / cells; }

void grid_make(Grid *grid, Dir o, int cells) {
    grid->cells = cells;
    grid->theta = polar(o);
    grid->phi = atan2(-(double)o.y, -(double)o.x);
    for (int k = 0; k < cells; k++) {
        GridLine column = grid_column(grid, middle(k, cells));
        grid->cos_phi[k] = column.cosine;
        grid->sin_phi[k] = column.sine;
        grid->width[k] = column.slope * 2.0 / cells;
    }
}

Dirs grid_ring(const Grid *grid, int k, Ring *ring) {
    GridLine row = grid_row(grid, middle(k, grid->cells));
    double height = row.slope * 2.0 / grid->cells;
    for (int c = 0; c < grid->cells; c++) {
        ring->x[c] = row.sine * grid->cos_phi[c];
        ring->y[c] = row.sine * grid->sin_phi[c];
        ring->z[c] = row.cosine;
        ring->area[c] = height * grid->width[c];
    }
    return (Dirs){(size_t)grid->cells, ring->x, ring->y, ring->z};
}

static int cell(double place, int bins) {
    int k = (int)((place + 1.0) * 0.5 * bins);
    return k < 0 ? 0 : k < bins ? k : bins - 1;
}

int grid_bin(const Grid *grid, Dir i, int bins) {
    double theta = polar(i) - grid->theta, range = theta < 0.0 ? grid->theta : PI_DOUBLE / 2.0 - grid->theta;
    double phi = atan2((double)i.y, (double)i.x) - grid->phi;
    phi -= 2.0 * PI_DOUBLE * (floor)(phi / (2.0 * PI_DOUBLE) + 0.5);
    double s = range > 0.0 ? (theta < 0.0 ? -1.0 : 1.0) * unstretch(fabs(theta) / range) : 0.0;
    double t = (phi < 0.0 ? -1.0 : 1.0) * unstretch(fabs(phi) / PI_DOUBLE);
    return cell(s, bins) * bins + cell(t, bins);
}
