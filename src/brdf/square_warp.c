#include "brdf/square_warp.h"

#include <math.h>
#include <stdlib.h>

#include "base/memory.h"

/* Returns the interval of ascending numbers that contains x; *part is the place of x in it, 0 .. 1. */
static int interval(const float *ascending, int count, double x, double *part) {
    int low = 0, high = count - 1;
    *part = 0.0;
    if (count < 2) return 0;
    while (high - low > 1) {
        int middle = (low + high) / 2;
        if ((double)ascending[middle] <= x)
            low = middle;
        else
            high = middle;
    }
    double from = (double)ascending[low], to = (double)ascending[high];
    *part = fmin(fmax((x - from) / (to - from), 0.0), 1.0);
    return low;
}

SliceBlend slice_blend(const float *phi, int phis, const float *theta, int thetas, double at_phi, double at_theta) {
    SliceBlend blend = {.count = 0};
    double part[2];
    int p = interval(phi, phis, at_phi, &part[0]), t = interval(theta, thetas, at_theta, &part[1]);
    for (int corner = 0; corner < 4; corner++) {
        int a = corner >> 1, b = corner & 1;
        double weight = (a ? part[0] : 1.0 - part[0]) * (b ? part[1] : 1.0 - part[1]);
        if (!(weight > 0.0)) continue;
        blend.slice[blend.count] = (size_t)(p + a) * (size_t)thetas + (size_t)(t + b);
        blend.weight[blend.count++] = weight;
    }
    return blend;
}

/* Scales a slice to an integral of 1 and fills its running integrals. */
static void integrate(SquareWarp *self, size_t slice) {
    const size_t width = (size_t)self->width, height = (size_t)self->height, n = width * height;
    float *density = self->density + slice * n, *along = self->along + slice * n, *up = self->up + slice * height;
    const double dx = 1.0 / (double)(width - 1), dy = 1.0 / (double)(height - 1);
    double most = 0.0, sum = 0.0, before = 0.0, all = 0.0;
    for (size_t k = 0; k < n; k++) most = fmax(most, (double)density[k]);
    const bool uniform = !(most > 0.0);
    for (size_t y = 0; y < height && !uniform; y++) {
        const float *row = density + y * width;
        double row_sum = 0.0;
        for (size_t x = 0; x < width; x++)
            row_sum += (x > 0 && x + 1 < width ? 1.0 : 0.5) * fmax((double)row[x], 0.0) / most;
        sum += (y > 0 && y + 1 < height ? 1.0 : 0.5) * row_sum;
    }
    const double whole = uniform ? 1.0 : sum * dx * dy; /* integral of the numbers over the largest */
    for (size_t y = 0; y < height; y++) {
        double row_sum = 0.0;
        for (size_t x = 0; x < width; x++) {
            float *d = &density[y * width + x];
            *d = uniform ? 1.0f : (float)(fmax((double)*d, 0.0) / most / whole);
            if (x > 0) row_sum += 0.5 * dx * ((double)d[-1] + (double)*d);
            along[y * width + x] = (float)row_sum;
        }
        if (y > 0) all += 0.5 * dy * (before + row_sum);
        up[y] = (float)all;
        before = row_sum;
    }
}

bool square_warp_create(SquareWarp *self, int width, int height, size_t slices, float *density) {
    const size_t rows = slices * (size_t)height;
    *self = (SquareWarp){.width = width, .height = height, .density = density};
    self->along = alloc_array(rows * (size_t)width, sizeof *self->along);
    self->up = alloc_array(rows, sizeof *self->up);
    if (!self->along || !self->up || !density) return false;
    for (size_t slice = 0; slice < slices; slice++) integrate(self, slice);
    return true;
}

void square_warp_free(SquareWarp *self) {
    free(self->density);
    free(self->along);
    free(self->up);
    *self = (SquareWarp){0};
}

/* Blends entry `at` of the slices, each of `size` numbers. */
static double mixed(const float *table, size_t size, const SliceBlend *blend, size_t at) {
    double sum = 0.0;
    for (int k = 0; k < blend->count; k++) sum += blend->weight[k] * (double)table[blend->slice[k] * size + at];
    return sum;
}

/* Returns the cell of x among count - 1; *part is the place of x in it, 0 .. 1. */
static size_t cell_of(double x, int count, double *part) {
    double at = fmin(fmax(x, 0.0), 1.0) * (count - 1), low = fmin(floor(at), count - 2);
    *part = at - low;
    return (size_t)low;
}

double square_table_at(const float *table, int width, int height, const SliceBlend *blend, int channels, int channel,
                       SquarePoint at) {
    double s, t;
    const size_t w = (size_t)width, n = w * (size_t)height, x = cell_of(at.x, width, &s), y = cell_of(at.y, height, &t),
                 from = (size_t)channel * n + y * w + x;
    const size_t size = n * (size_t)channels;
    return (1.0 - t) * ((1.0 - s) * mixed(table, size, blend, from) + s * mixed(table, size, blend, from + 1)) +
           t * ((1.0 - s) * mixed(table, size, blend, from + w) + s * mixed(table, size, blend, from + w + 1));
}

double square_warp_density(const SquareWarp *self, const SliceBlend *blend, SquarePoint at) {
    return square_table_at(self->density, self->width, self->height, blend, 1, 0, at);
}

/* Returns the integral from 0 to t of a density that is linear from a to b over 0 .. 1, and inversely the t of an
 * integral `area`. */
static double ramp_area(double a, double b, double t) { return t * (a + 0.5 * (b - a) * t); }
static double ramp_place(double a, double b, double area) {
    double root = a + sqrt(fmax(a * a + 2.0 * (b - a) * area, 0.0));
    return root > 0.0 ? fmin(fmax(2.0 * area / root, 0.0), 1.0) : 0.0;
}

/* A row between row y of the table and the next, at t in [0, 1]. */
typedef struct BetweenRows {
    const SquareWarp *warp;
    const SliceBlend *blend;
    size_t y;
    double t;
} BetweenRows;

static double between_rows(const BetweenRows *rows, const float *table, size_t x) {
    const size_t w = (size_t)rows->warp->width, n = w * (size_t)rows->warp->height, at = rows->y * w + x;
    return (1.0 - rows->t) * mixed(table, n, rows->blend, at) + rows->t * mixed(table, n, rows->blend, at + w);
}

static double row_integral(const SquareWarp *self, const SliceBlend *blend, size_t y) {
    const size_t w = (size_t)self->width;
    return mixed(self->along, w * (size_t)self->height, blend, y * w + w - 1);
}

SquarePoint square_warp_point(const SquareWarp *self, const SliceBlend *blend, double u, double v) {
    const size_t height = (size_t)self->height;
    size_t low = 0, high = height - 1;
    v = fmin(fmax(v, 0.0), 1.0) * mixed(self->up, height, blend, height - 1);
    while (high - low > 1) {
        size_t middle = (low + high) / 2;
        *(mixed(self->up, height, blend, middle) <= v ? &low : &high) = middle;
    }
    const double dy = 1.0 / (self->height - 1), dx = 1.0 / (self->width - 1);
    double area = (v - mixed(self->up, height, blend, low)) / dy;
    BetweenRows rows = {.warp = self, .blend = blend, .y = low};
    rows.t = ramp_place(row_integral(self, blend, low), row_integral(self, blend, low + 1), area);
    SquarePoint point = {.y = ((double)low + rows.t) * dy};
    size_t left = 0, right = (size_t)self->width - 1;
    u = fmin(fmax(u, 0.0), 1.0) * between_rows(&rows, self->along, right);
    while (right - left > 1) {
        size_t middle = (left + right) / 2;
        *(between_rows(&rows, self->along, middle) <= u ? &left : &right) = middle;
    }
    area = (u - between_rows(&rows, self->along, left)) / dx;
    point.x = ((double)left + ramp_place(between_rows(&rows, self->density, left),
                                         between_rows(&rows, self->density, left + 1), area)) *
              dx;
    return point;
}

SquarePoint square_warp_inverse(const SquareWarp *self, const SliceBlend *blend, SquarePoint at) {
    const double dy = 1.0 / (self->height - 1), dx = 1.0 / (self->width - 1);
    BetweenRows rows = {.warp = self, .blend = blend};
    double s;
    size_t x = cell_of(at.x, self->width, &s);
    rows.y = cell_of(at.y, self->height, &rows.t);
    double whole = between_rows(&rows, self->along, (size_t)self->width - 1);
    double part = between_rows(&rows, self->along, x) +
                  dx * ramp_area(between_rows(&rows, self->density, x), between_rows(&rows, self->density, x + 1), s);
    double below = mixed(self->up, (size_t)self->height, blend, rows.y);
    double above = dy * ramp_area(row_integral(self, blend, rows.y), row_integral(self, blend, rows.y + 1), rows.t);
    return (SquarePoint){.x = whole > 0.0 ? fmin(part / whole, 1.0) : at.x, .y = fmin(below + above, 1.0)};
}
