/* yarn_medium.h - light on the surface of a yarn: fibres that lie in it, seen between the yarns around
 *
 *   single   = D(h) / 4  P_i P_o / (sigma_i P_o + sigma_o P_i) / (V_i V_o)                          [1/sr]
 *   multiple = R_i R_o / (pi R_mean) (P_i / V_i + P_o / V_o) / 2                                    [1/sr]
 *
 *   A yarn is a height field over a flat cloth, filled with fibres along t. Its normal is (s_x, s_y, 1): the slopes s_x
 * and s_y are how fast it falls along x and y. An area 1 of cloth has yarn on it that covers the area P towards w:
 *
 *   p = w . (s_x, s_y, 1),  P = max(p, 0)
 *
 *   V is the mean of P over all yarns of the cloth. Slopes are 0 on the mean, so p is w_z, and V = w_z + C with C the
 * mean of max(-p, 0), the area that faces away. Other yarns leave the share w_z / V of the area visible: Bruce G.
 * Smith, "Geometrical Shadowing of a Random Rough Surface", IEEE Transactions on Antennas and Propagation 15(5), 1967.
 * The mean of P / V over the cloth is 1. A family of yarns has slopes that are uniform up to roundness across it and up
 * to crimp along it. With X = roundness |w_x| and Y = crimp |w_y| for yarns along y, its part of C is
 *
 *   C = [max(X + Y - w_z, 0)^3 - max(|X - Y| - w_z, 0)^3] / (24 X Y)
 *
 *   The fibres are flakes of Eric Heitz, Jonathan Dupuy, Cyril Crassin, Carsten Dachsbacher, "The SGGX Microflake
 * Distribution", ACM TOG 34(4), 2015. Alpha, here a, is the area that a fibre shows along its axis over that across it:
 *
 *   D(h) = a^3 / (pi (a^2 + (1 - a^2) (t . h)^2)^2),  sigma(w) = sqrt(1 - (1 - a^2) (t . w)^2)
 *
 *   single is light that met one fibre. It is exact for a medium without a lower end. multiple is light that met two
 * fibres or more, and diffuse. R = 1 - E_1 is the remainder that single scattering leaves to it: E_1, the albedo of
 * single on a level surface, is fitted with an error of at most 0.018. Fibres of albedo A reflect rho(A) of the
 * remainder, fitted to random walks through a plain weave of tubes of flakes. Both fits are our own. */
#pragma once

#include "shading/dialect/angles.h"

FN float yarn_cube_above_0(float x) {
    float y = max(x, 0.0f);
    return y * y * y;
}

/* Returns C of a family of yarns. across, along: the components of w across and along the yarns; z: w_z. The floors
 * keep the quotient finite where one of X and Y is 0. */
FN float yarn_averted_area(float across, float along, float z, float roundness, float crimp) {
    float x = max(roundness * abs(across), 1e-3f), y = max(crimp * abs(along), 1e-3f);
    return (yarn_cube_above_0(x + y - z) - yarn_cube_above_0(abs(x - y) - z)) / (24.0f * x * y);
}

/* Returns V of a cloth of two families: a share of the cloth has yarns along y with slopes up to crimp, the rest yarns
 * along x with slopes up to cross_crimp. */
FN float yarn_mean_area(Dir w, float share, float roundness, float crimp, float cross_crimp) {
    return w.z + share * yarn_averted_area(w.x, w.y, w.z, roundness, crimp) +
           (1.0f - share) * yarn_averted_area(w.y, w.x, w.z, roundness, cross_crimp);
}

/* Returns P. */
FN float yarn_seen_area(Dir w, float slope_x, float slope_y) { return max(w.z + slope_x * w.x + slope_y * w.y, 0.0f); }

/* Returns D of the direction of wi + wo. m: t . (wi + wo); q: 1 / |wi + wo|^2. So (t . h)^2 is m^2 q. */
FN float yarn_d(float a2, float m, float q) {
    float c = a2 + (1.0f - a2) * min(m * m * q, 1.0f);
    return a2 * sqrt(a2) / (PI * c * c);
}
/* Returns sigma. along: t . w. */
FN float yarn_sigma(float a2, float along) { return sqrt(max(1.0f - (1.0f - a2) * along * along, a2)); }

/* Returns 1 / |wi + wo|^2. The sum is made of wi and wo themselves, since a.d took a square root. */
FN float yarn_per_sum2(Angles a) {
    float x = a.o.x + a.i.x, y = a.o.y + a.i.y, z = a.o.z + a.i.z;
    return 1.0f / max(x * x + y * y + z * z, 4e-6f);
}

/* Returns 4 pi a^2 V_i V_o single with one division, by e = (1 - a^2) / a^2:
 *   pi a D = 1 / (1 + e (t . h)^2)^2,  sigma / a = sqrt(1 + e (1 - (t . w)^2))
 * m, q: as for yarn_d; p_o, p_i: P of wo and wi; t_o, t_i: t . wo and t . wi. */
FN float yarn_single(float e, float q, float m, float p_o, float p_i, float t_o, float t_i) {
    float d = 1.0f + e * min(m * m * q, 1.0f);
    float sigma_p =
        sqrt(1.0f + e * max(1.0f - t_i * t_i, 0.0f)) * p_o + sqrt(1.0f + e * max(1.0f - t_o * t_o, 0.0f)) * p_i;
    return p_o * p_i / max(d * d * sigma_p, 1e-6f);
}

/* Returns R of a direction with that cosine to the normal of the cloth. */
FN float yarn_remainder(float a, float cosine) {
    return 0.459f + 0.0157f * a + (0.3419f + 0.1186f * a) * sqrt(cosine) - 0.0911f * cosine;
}
/* Returns R_mean, the mean of R weighted by the cosine. */
FN float yarn_remainder_mean(float a) { return 0.672f + 0.111f * a; }

/* Returns the factor of multiple that does not depend on directions, 1 / (2 pi R_mean). Where threads are nearly flat
 * ribbons, they hide no light from each other that would make up for the error of R, by which E would be up to 1.006:
 * there it is up to 0.011 less. Own fit: E <= 1 for every alpha, crimp, twist and power of floats. */
FN float yarn_multiple(float a, float roundness) {
    return 0.5f * (1.0f - 0.011f * max(1.0f - roundness / 0.3f, 0.0f)) / (PI * yarn_remainder_mean(a));
}

/* Returns rho(A). */
FN float yarn_reflectance(float albedo) {
    float g = sqrt(max(1.0f - albedo, 0.0f)), r = (1.0f - g) / (1.0f + 0.32f * g);
    return r * r;
}
