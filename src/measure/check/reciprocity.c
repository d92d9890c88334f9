#include "measure/check/reciprocity.h"

#include "base/pi.h"
#include "measure/bsdf/draw.h"
#include "measure/bsdf/exceeds.h"
#include "measure/bsdf/grid.h"

static const double full_circle = 2.0 * PI_DOUBLE;

static float f_of(const Bsdf *bsdf, int setting, Dir o, Dir i) {
    BsdfView view;
    float f;
    bsdf->prepare(bsdf, setting, o, &view);
    bsdf->f(&view, (Dirs){1, &i.x, &i.y, &i.z}, &f);
    return f;
}

/* Draws a cosine in (0, 1], or one near 0. */
static double any_cosine(Draw *draw, bool grazes) {
    double u = 1.0 - (double)draw_unit(draw);
    return grazes ? u * u * u * u : u;
}

Reciprocity reciprocity_measure(const Bsdf *bsdf, int setting, int pairs) {
    Draw draw = draw_start(2, (uint32_t)setting);
    Reciprocity worst = {0};
    for (int k = 0; k < pairs; k++) {
        double z_o = any_cosine(&draw, k % 4 == 0), z_i = any_cosine(&draw, k % 4 == 1);
        double phi = full_circle * (double)draw_unit(&draw), phi_o = full_circle * (double)draw_unit(&draw);
        Dir o = grid_direction(z_o, phi_o), i = grid_direction(z_i, phi_o + phi);
        float f = f_of(bsdf, setting, o, i), g = f_of(bsdf, setting, i, o);
        float error = fabsf(f - g) / max(max(f, g), 1e-3f);
        if (!exceeds_or_nan((double)error, (double)worst.error)) continue;
        float value = setting < bsdf->rows ? bsdf->values[setting] : 0.0f;
        worst = (Reciprocity){error, {value, o.z, i.z, (float)(phi * (360.0 / full_circle))}};
    }
    return worst;
}
