/* white.c - the white of a picture: chromaticities of lights by temperature, and their adaptation */
#include <math.h>

#include "image/primaries.h"
#include "weft/image.h"

/* CIE 1960 u, v of light, and x, y of them. */
typedef struct Chromaticity {
    double u, v;
} Chromaticity;

static Chromaticity of_xy(double x, double y) {
    const double d = 12.0 * y - 2.0 * x + 3.0;
    return (Chromaticity){4.0 * x / d, 6.0 * y / d};
}

/* Returns that of daylight, CIE 15:2004, Equations 3.1 to 3.4; T from 4000 to 25000 K. */
static Chromaticity daylight(double t) {
    const double k = 1e3 / t;
    const double x = t <= 7000.0 ? 0.244063 + k * (0.09911 + k * (2.9678 - 4.6070 * k))
                                 : 0.237040 + k * (0.24748 + k * (1.9018 - 2.0064 * k));
    return of_xy(x, -3.0 * x * x + 2.87 * x - 0.275);
}

/* Returns that of a black body, Krystek 1985; T from 1000 to 15000 K. */
static Chromaticity black_body(double t) {
    return (Chromaticity){
        (0.860117757 + t * (1.54118254e-4 + t * 1.28641212e-7)) / (1.0 + t * (8.42420235e-4 + t * 7.08145163e-7)),
        (0.317398726 + t * (4.22806245e-5 + t * 4.20481691e-8)) / (1.0 - t * (2.89741816e-5 - t * 1.61456053e-7))};
}

static Chromaticity of_temperature(double t) {
    const double part = fmin(fmax((t - 3000.0) / 2000.0, 0.0), 1.0);
    const Chromaticity warm = black_body(fmin(t, 5000.0)), cool = daylight(fmax(t, 4000.0));
    if (part <= 0.0) return warm;
    /* below 4000 K daylight is not defined: its offset from the black body there goes on */
    const Chromaticity at = black_body(fmax(t, 4000.0));
    const double u = t < 4000.0 ? warm.u + cool.u - at.u : cool.u, v = t < 4000.0 ? warm.v + cool.v - at.v : cool.v;
    return (Chromaticity){warm.u + part * (u - warm.u), warm.v + part * (v - warm.v)};
}

void weft_white(float kelvin, float tint, float white[2]) {
    const double t = fmin(fmax((double)kelvin, 1700.0), 25000.0), step = 1e-3 * t;
    Chromaticity c = of_temperature(t);
    const Chromaticity a = of_temperature(t - step), b = of_temperature(t + step);
    const double du = b.u - a.u, dv = b.v - a.v, length = hypot(du, dv);
    c.u += 1e-3 * (double)tint * dv / length; /* cooler is down and left, so greener is up and left */
    c.v -= 1e-3 * (double)tint * du / length;
    const double d = 2.0 * c.u - 8.0 * c.v + 4.0;
    white[0] = (float)(3.0 * c.u / d);
    white[1] = (float)(2.0 * c.v / d);
}

void weft_white_matrix(const float white[2], float matrix[9]) {
    const double xy[2] = {(double)white[0], (double)white[1]};
    const bool given = xy[0] > 0.0 && xy[1] > 0.0;
    ColorConversion m;
    const bool made = given && primaries_adapted(xy, &m);
    for (int k = 0; k < 9; k++) matrix[k] = made ? (float)m.m[k] : k % 4 == 0 ? 1.0f : 0.0f;
}
