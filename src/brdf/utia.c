#include <math.h>
#include <stdbool.h>
#include <stdlib.h>

#include "brdf/utia.h"

#include "base/fail.h"
#include "base/little_endian.h"
#include "base/memory.h"
#include "base/pi.h"

enum { BINS = UTIA_SIDE * UTIA_SIDE, FILE_SIZE = 3 * 8 * BINS };

void utia_free(Utia *utia) {
    for (int c = 0; c < 3; c++) free(utia->f[c]);
    *utia = (Utia){0};
}

WeftResult utia_read_memory(const void *data, size_t size, const char *name, Utia *out, WeftError *error) {
    const unsigned char *bytes = data;
    bool any = false;
    *out = (Utia){0};
    if (size != FILE_SIZE)
        return fail(error, WEFT_MESSAGE_UTIA, name, "it has %zu bytes: %d would be right", size, FILE_SIZE);
    for (size_t c = 0; c < 3; c++) {
        out->f[c] = alloc_array(BINS, sizeof **out->f);
        if (!out->f[c]) return fail(error, WEFT_MESSAGE_MEMORY, name, NULL);
        for (size_t k = 0; k < BINS; k++) {
            double f = little_endian_double(bytes + 8 * (c * BINS + k));
            if (!isfinite(f) || f > 1e30)
                return fail(error, WEFT_MESSAGE_UTIA, name, "number %zu is not finite", c * BINS + k + 1);
            out->f[c][k] = f > 0.0 ? (float)f : 0.0f;
            any |= f > 0.0;
        }
    }
    return any ? WEFT_OK : fail(error, WEFT_MESSAGE_UTIA, name, "nothing in it is above 0");
}

/* The four measured directions around a direction, and their weights. */
typedef struct Surrounding {
    size_t place[4];
    double weight[4];
} Surrounding;

static Surrounding surrounding(Dir w) {
    double theta = (atan2)((hypot)((double)w.x, (double)w.y), (double)w.z) / RADIANS / 15.0;
    double phi = (atan2)((double)w.y, (double)w.x) / RADIANS / 7.5;
    if (phi < 0.0) phi += UTIA_PHIS;
    theta = (fmin)(theta, UTIA_THETAS - 1.0);
    size_t t = (size_t)(fmin)(theta, UTIA_THETAS - 2.0), p = (size_t)phi % UTIA_PHIS;
    double part_t = theta - (double)t, part_p = phi - (floor)(phi);
    Surrounding a;
    for (size_t corner = 0; corner < 4; corner++) {
        size_t up = corner >> 1, on = corner & 1;
        a.place[corner] = (t + up) * UTIA_PHIS + (p + on) % UTIA_PHIS;
        a.weight[corner] = (up ? part_t : 1.0 - part_t) * (on ? part_p : 1.0 - part_p);
    }
    return a;
}

void utia_at(const Utia *utia, Dir o, Dir i, float f[3]) {
    f[0] = f[1] = f[2] = 0.0f;
    if (!(o.z > 0.0f) || !(i.z > 0.0f)) return;
    Surrounding light = surrounding(i), view = surrounding(o);
    for (int c = 0; c < 3; c++) {
        double sum = 0.0;
        for (int k = 0; k < 16; k++)
            sum += light.weight[k >> 2] * view.weight[k & 3] *
                   (double)utia->f[c][light.place[k >> 2] * UTIA_SIDE + view.place[k & 3]];
        f[c] = (float)sum;
    }
}
