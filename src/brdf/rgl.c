#include <math.h>
#include <stdlib.h>

#include "base/pi.h"
#include "brdf/rgl.h"

void rgl_free(Rgl *self) {
    free(self->phi);
    free(self->theta);
    free(self->ndf.value);
    free(self->sigma.value);
    free(self->color);
    square_warp_free(&self->normals);
    square_warp_free(&self->luminance);
    *self = (Rgl){0};
}

bool rgl_isotropic(const Rgl *self) { return self->phis <= 2; }

SquarePoint rgl_square_of(double theta, double phi) {
    return (SquarePoint){(sqrt)(2.0 * theta / PI_DOUBLE), (phi + PI_DOUBLE) / (2.0 * PI_DOUBLE)};
}

void rgl_angles_of(SquarePoint u, double *theta, double *phi) {
    *theta = u.x * u.x * 0.5 * PI_DOUBLE;
    *phi = (2.0 * u.y - 1.0) * PI_DOUBLE;
}

double rgl_table_at(const RglTable *table, SquarePoint u) {
    static const SliceBlend only = {.count = 1, .weight = {1.0}};
    return square_table_at(table->value, table->width, table->height, &only, 1, 0, u);
}

/* A wo, mirrored into the measured part of the circle. */
typedef struct RglView {
    Dir o;            /* mirrored */
    float x, y;       /* the signs that mirror a direction */
    double phi;       /* azimuth of o, radians */
    SquarePoint u;    /* of o */
    SliceBlend blend; /* slices of o */
} RglView;

static double angle_to_normal(Dir w) { return (atan2)((hypot)((double)w.x, (double)w.y), (double)w.z); }

static void view_make(const Rgl *self, Dir o, RglView *view) {
    *view = (RglView){.x = 1.0f, .y = 1.0f};
    if (self->parts > 1 && o.y > 0.0f) view->x = view->y = -1.0f;
    if (self->parts == 4) view->x = o.x > 0.0f ? -1.0f : 1.0f;
    view->o = dir(o.x * view->x, o.y * view->y, o.z);
    /* if only a part was measured, y is at most -0, so that the azimuth of -x is -pi and not pi */
    double y = self->parts > 1 ? -(fabs)((double)view->o.y) : (double)view->o.y;
    view->phi = (atan2)(y, (double)view->o.x);
    double theta = angle_to_normal(o);
    view->u = rgl_square_of(theta, view->phi);
    view->blend = slice_blend(self->phi, self->phis, self->theta, self->thetas, view->phi, theta);
}

/* Returns u of the half vector. */
static SquarePoint square_of_half(const Rgl *self, const RglView *view, Dir i) {
    Dir m = dir(view->o.x + i.x * view->x, view->o.y + i.y * view->y, view->o.z + i.z);
    double phi = (atan2)((double)m.y, (double)m.x) - (rgl_isotropic(self) ? view->phi : 0.0);
    SquarePoint u = rgl_square_of(angle_to_normal(m), phi);
    u.y -= (floor)(u.y);
    return u;
}

void rgl_at(const Rgl *self, Dir o, Dir i, float f[3]) {
    f[0] = f[1] = f[2] = 0.0f;
    if (!(o.z > 0.0f) || !(i.z > 0.0f)) return;
    RglView view;
    view_make(self, o, &view);
    SquarePoint u = square_of_half(self, &view, i);
    SquarePoint s = square_warp_inverse(&self->normals, &view.blend, u);
    double below = 4.0 * rgl_table_at(&self->sigma, view.u) * (double)i.z;
    double scale = below > 0.0 ? rgl_table_at(&self->ndf, u) / below : 0.0;
    for (int c = 0; c < 3; c++) {
        double color = square_table_at(self->color, self->side, self->side, &view.blend, 3, c, s);
        f[c] = (float)(fmin)((fmax)(color * scale, 0.0), 1e30);
    }
}

/* Returns du / dwi at the half vector of u, whose cosine with wi is cos_d. */
static double stretch(SquarePoint u, double cos_d) {
    double theta, phi;
    rgl_angles_of(u, &theta, &phi);
    return 1.0 / ((fmax)(2.0 * PI_DOUBLE * PI_DOUBLE * u.x * (sin)(theta), 1e-6) * 4.0 * cos_d);
}

float rgl_pdf(const Rgl *self, Dir o, Dir i) {
    if (!(o.z > 0.0f) || !(i.z > 0.0f)) return 0.0f;
    RglView view;
    view_make(self, o, &view);
    SquarePoint u = square_of_half(self, &view, i);
    SquarePoint s = square_warp_inverse(&self->normals, &view.blend, u);
    double cos_d = (fmax)((sqrt)(0.5 * (1.0 + (double)dir_dot(o, i))), 1e-6);
    double pdf = square_warp_density(&self->normals, &view.blend, u) *
                 square_warp_density(&self->luminance, &view.blend, s) * stretch(u, cos_d);
    return (float)(fmin)(pdf, 1e30);
}

Dir rgl_sample(const Rgl *self, Dir o, float u, float v) {
    if (!(o.z > 0.0f)) return dir(0.0f, 0.0f, 0.0f);
    RglView view;
    view_make(self, o, &view);
    SquarePoint s = square_warp_point(&self->luminance, &view.blend, (double)u, (double)v);
    double theta, phi;
    rgl_angles_of(square_warp_point(&self->normals, &view.blend, s.x, s.y), &theta, &phi);
    if (rgl_isotropic(self)) phi += view.phi;
    Dir m = dir((float)((sin)(theta) * (cos)(phi)), (float)((sin)(theta) * (sin)(phi)), (float)(cos)(theta));
    Dir i = dir_mirror(view.o, m);
    return dir(i.x * view.x, i.y * view.y, i.z);
}
