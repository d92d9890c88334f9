#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/fail.h"
#include "base/little_endian.h"
#include "base/memory.h"
#include "base/pi.h"
#include "brdf/merl.h"

enum { HEADER = 12 };

static size_t bins_of(MerlShape shape) { return (size_t)shape.theta_h * (size_t)shape.theta_d * (size_t)shape.phi_d; }

static const double units[3] = {1.0 / 1500.0, 1.15 / 1500.0, 1.66 / 1500.0};

static WeftResult check_size(const unsigned char *bytes, size_t size, MerlShape shape, const char *name,
                             WeftError *error) {
    if (size < HEADER) return fail(error, WEFT_MESSAGE_MEASURED, name, "it has %zu bytes", size);
    const size_t whole = HEADER + 3 * 8 * bins_of(shape);
    unsigned n[3];
    for (int k = 0; k < 3; k++) n[k] = (unsigned)little_endian(bytes + (size_t)4 * (size_t)k, 4);
    if (n[0] != (unsigned)shape.theta_h || n[1] != (unsigned)shape.theta_d || n[2] != (unsigned)shape.phi_d)
        return fail(error, WEFT_MESSAGE_MEASURED, name, "it has %u x %u x %u bins; %d x %d x %d are expected", n[0],
                    n[1], n[2], shape.theta_h, shape.theta_d, shape.phi_d);
    if (size != whole)
        return fail(error, WEFT_MESSAGE_MEASURED, name, "it has %zu bytes, and %s: %zu would be right", size,
                    size < whole ? "was cut short" : "goes on behind its end", whole);
    return WEFT_OK;
}

WeftResult merl_read_shape(const void *data, size_t size, MerlShape shape, const char *name, Merl *out,
                           WeftError *error) {
    const unsigned char *bytes = data;
    const size_t bins = bins_of(shape);
    *out = (Merl){.shape = shape};
    WeftResult result = check_size(bytes, size, shape, name, error);
    if (result != WEFT_OK) return result;
    bool any = false;
    for (int c = 0; c < 3; c++) {
        out->f[c] = alloc_array(bins, sizeof **out->f);
        if (!out->f[c]) return fail(error, WEFT_MESSAGE_MEMORY, name, NULL);
        for (size_t k = 0; k < bins; k++) {
            double f = little_endian_double(bytes + HEADER + ((size_t)c * bins + k) * 8) * units[c];
            if (!isfinite(f) || f > 1e30)
                return fail(error, WEFT_MESSAGE_MEASURED, name, "number %zu is not finite", k + 1);
            out->f[c][k] = f < 0.0 ? -1.0f : (float)f;
            any |= f > 0.0;
        }
    }
    if (!any) return fail(error, WEFT_MESSAGE_MEASURED, name, "nothing in it is above 0");
    return WEFT_OK;
}

WeftResult merl_read_memory(const void *data, size_t size, const char *name, Merl *out, WeftError *error) {
    const unsigned char *bytes = data;
    MerlShape shape = {MERL_THETA_H, MERL_THETA_D, MERL_PHI_D, false};
    if (size >= HEADER && little_endian(bytes + 8, 4) == MERL_ALL_AROUND)
        shape.phi_d = MERL_ALL_AROUND, shape.around = true;
    return merl_read_shape(data, size, shape, name, out, error);
}

void merl_free(Merl *merl) {
    for (int c = 0; c < 3; c++) free(merl->f[c]);
    *merl = (Merl){0};
}

/* Half vector and difference angles, radians; phi_d in [0, period). */
typedef struct HalfDiff {
    double theta_h, theta_d, phi_d;
} HalfDiff;

static HalfDiff half_diff(Dir o, Dir i, double period) {
    double hx = (double)o.x + (double)i.x, hy = (double)o.y + (double)i.y, hz = (double)o.z + (double)i.z;
    double flat = (sqrt)(hx * hx + hy * hy), length = (sqrt)(flat * flat + hz * hz);
    double c = flat > 1e-9 ? hx / flat : 1.0, s = flat > 1e-9 ? hy / flat : 0.0;
    double ch = hz / length, sh = flat / length;
    /* wi rotated by -phi_h about z, then by -theta_h about y */
    double x = c * (double)i.x + s * (double)i.y, y = c * (double)i.y - s * (double)i.x, z = (double)i.z;
    double dx = ch * x - sh * z, dz = sh * x + ch * z;
    HalfDiff angles = {
        .theta_h = (atan2)(sh, ch), .theta_d = (atan2)((sqrt)(dx * dx + y * y), dz), .phi_d = (atan2)(y, dx)};
    if (angles.phi_d < 0.0) angles.phi_d += period;
    if (angles.phi_d >= period) angles.phi_d = 0.0;
    return angles;
}

/* The two bins between whose middles a place lies, and the weight of the second. */
typedef struct Between {
    int bin[2];
    double weight;
} Between;

static Between between(double place, int bins, bool round_it) {
    double at = place - 0.5, low = (floor)(at);
    int k = (int)low;
    Between b = {.bin = {k, k + 1}, .weight = at - low};
    for (int end = 0; end < 2; end++) {
        if (b.bin[end] < 0) b.bin[end] = round_it ? bins - 1 : 0;
        if (b.bin[end] >= bins) b.bin[end] = round_it ? 0 : bins - 1;
    }
    return b;
}

bool merl_at(const Merl *merl, Dir o, Dir i, float f[3]) {
    f[0] = f[1] = f[2] = 0.0f;
    if (!(o.z > 0.0f) || !(i.z > 0.0f)) return false;
    const MerlShape s = merl->shape;
    /* if the table covers half of the circle, f(wo, wi) = f(wi, wo) adds pi to phi_d */
    const double period = s.around ? 2.0 * PI_DOUBLE : PI_DOUBLE;
    HalfDiff a = half_diff(o, i, period);
    /* bins of theta_h are uniform in its square root, so that they are narrow near the mirror direction */
    Between h = between((sqrt)(a.theta_h / (0.5 * PI_DOUBLE)) * s.theta_h, s.theta_h, false);
    Between d = between(a.theta_d / (0.5 * PI_DOUBLE) * s.theta_d, s.theta_d, false);
    Between p = between(a.phi_d / period * s.phi_d, s.phi_d, true);
    double sum[3] = {0.0}, weights = 0.0;
    for (int corner = 0; corner < 8; corner++) {
        int u = corner & 1, v = corner >> 1 & 1, w = corner >> 2;
        size_t at = ((size_t)h.bin[u] * (size_t)s.theta_d + (size_t)d.bin[v]) * (size_t)s.phi_d + (size_t)p.bin[w];
        double weight =
            (u ? h.weight : 1.0 - h.weight) * (v ? d.weight : 1.0 - d.weight) * (w ? p.weight : 1.0 - p.weight);
        if (merl->f[0][at] < 0.0f || merl->f[1][at] < 0.0f || merl->f[2][at] < 0.0f) continue;
        for (int c = 0; c < 3; c++) sum[c] += weight * (double)merl->f[c][at];
        weights += weight;
    }
    if (!(weights > 1e-6)) return false;
    for (int c = 0; c < 3; c++) f[c] = (float)(sum[c] / weights);
    return true;
}
