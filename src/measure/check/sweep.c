#include "measure/check/sweep.h"

#include "base/pi.h"
#include "measure/bsdf/draw.h"
#include "measure/bsdf/grid.h"

static const double cosines[12] = {1e-30, 1e-7, 1e-6, 1e-4, 1e-3, 0.01, 0.1, 0.3, 0.7, 0.95, 0.99999, 1.0};
static const double azimuths[6] = {0.0, 0.3, 0.5 * PI_DOUBLE, 2.0, PI_DOUBLE, -(0.5 * PI_DOUBLE)};

Dir sweep_dir(int k) {
    /* exact axes: a sine of pi that is not 0 would be a kinder case */
    static const float axes[6][2] = {{1, 0}, {0, 0}, {0, 1}, {0, 0}, {-1, 0}, {0, -1}};
    int c = k / 6 % 12, a = k % 6;
    Dir w = grid_direction(cosines[c], azimuths[a]);
    if (a != 1 && a != 3) {
        float s = (float)(sqrt)(1.0 - cosines[c] * cosines[c]);
        w = dir(s * axes[a][0], s * axes[a][1], (float)cosines[c]);
    }
    return w;
}

static void add(Partners *partners, Dir i) {
    int k = partners->count++;
    partners->x[k] = i.x, partners->y[k] = i.y, partners->z[k] = i.z;
}

void sweep_partners(Dir o, int k, bool below, Partners *partners) {
    partners->count = 0;
    for (int j = 0; j < SWEEP_DIRS; j++) add(partners, sweep_dir(j));
    add(partners, o);
    add(partners, dir(-o.x, -o.y, o.z));
    add(partners, dir(-o.x, -o.y, o.z > 0.5f ? o.z : 1e-7f));
    add(partners, dir(o.x, o.y, o.z > 0.5f ? o.z : 1e-7f));
    Draw draw = draw_start(5, (uint32_t)k);
    for (int j = 0; j < 12; j++) {
        double z = 1.0 - (double)draw_unit(&draw), phi = 2.0 * PI_DOUBLE * (double)draw_unit(&draw);
        add(partners, grid_direction(z, phi));
    }
    if (!below) return;
    add(partners, dir(1.0f, 0.0f, 0.0f));
    add(partners, dir(-o.x, -o.y, -o.z));
    add(partners, dir(o.x, o.y, -o.z));
    add(partners, dir(0.0f, 0.0f, -1.0f));
    add(partners, dir(0.6f, 0.0f, -0.8f));
    add(partners, dir(0.0f, 1.0f, -1e-7f));
    add(partners, dir(0.0f, -1.0f, -0.0f));
    add(partners, dir(-0.8f, 0.0f, -0.6f));
}

static void judge(Sweep *sweep, float value, float z) {
    sweep->count++;
    if (!sweep_finite(value))
        sweep->infinite++;
    else if (value < 0.0f)
        sweep->negative++;
    else if (!(z > 0.0f) && value > 0.0f)
        sweep->below++;
}

Sweep sweep_setting(const Bsdf *bsdf, int setting) {
    static const float corners[4] = {0.0f, 0.3f, 0.5f, 0x1.fffffep-1f};
    Sweep sweep = {0};
    Partners partners;
    float f[SWEEP_PARTNERS], pdf[SWEEP_PARTNERS];
    for (int k = 0; k < SWEEP_DIRS; k++) {
        BsdfView view;
        Dir o = sweep_dir(k);
        bsdf->prepare(bsdf, setting, o, &view);
        sweep_partners(o, k, true, &partners);
        Dirs dirs = {(size_t)partners.count, partners.x, partners.y, partners.z};
        bsdf->f(&view, dirs, f);
        bsdf->pdf(&view, dirs, pdf);
        for (int j = 0; j < partners.count; j++) {
            judge(&sweep, f[j], partners.z[j]);
            judge(&sweep, pdf[j], partners.z[j]);
        }
        for (int j = 0; j < 16; j++) {
            Dir i = bsdf->sample(&view, corners[j & 3], corners[j >> 2]);
            sweep.count++;
            sweep.infinite += !(sweep_finite(i.x) && sweep_finite(i.y) && sweep_finite(i.z));
        }
    }
    return sweep;
}
