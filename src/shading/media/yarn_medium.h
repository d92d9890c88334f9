/* yarn_medium.h - light on the surface of a yarn: fibres that lie in it, seen between the yarns around
 *
 *   single = D(h) / 4  P_i P_o / (sigma_i P_o + sigma_o P_i) / (V_i V_o)                            [1/sr]
 *   many   = t_i t_o / (pi t_mean) (P_i / V_i + P_o / V_o) / 2                                      [1/sr]
 *   P = (w . (s_x, s_y, 1))+,  sigma = sqrt(1 - (1 - a^2) (t . w)^2),  V = w_z + sum share_k C_k
 *   C = [(A + B - w_z)+^3 - (|A - B| - w_z)+^3] / (24 A B)
 *
 * A yarn is a height field with slopes s_x, s_y to a flat cloth, filled with flakes of Eric Heitz, Jonathan
 * Dupuy, Cyril Crassin, Carsten Dachsbacher, "The SGGX Microflake Distribution", ACM TOG 34(4), 2015, along
 * the fibres t: D is theirs, and single is exact for such a medium without a lower end. P is the area of
 * yarn that w sees, per area of cloth; V is its mean over all yarn that faces w, and w_z / V the share that
 * is not hidden by other yarns (Bruce G. Smith, "Geometrical Shadowing of a Random Rough Surface", IEEE
 * Transactions on Antennas and Propagation 15(5), 1967). C is that mean where the slopes of a family are
 * uniform within A / |w_x| across it and B / |w_y| along: so the mean of P / V over the cloth is 1.
 *   many: light that met two fibres or more, diffuse. t = 1 - E_1 is what the first one leaves, fitted to the
 * albedo of single on a level surface; error at most 0.018. Fibres of albedo A leave rho(A) of it,
 * fitted to random walks through a plain weave of tubes of flakes: own fit. */
#ifndef WEFT_SHADING_YARN_MEDIUM_H
#define WEFT_SHADING_YARN_MEDIUM_H

#include "shading/dialect/angles.h"

/* C: yarn slopes that face away, over a family whose slopes reach so far across it and along. */
FN float yarn_cube(float x) {
    float y = max(x, 0.0f);
    return y * y * y;
}
FN float yarn_hidden(float across, float along, float z, float roundness, float crimp) {
    float a = max(roundness * abs(across), 1e-3f), b = max(crimp * abs(along), 1e-3f);
    return (yarn_cube(a + b - z) - yarn_cube(abs(a - b) - z)) / (24.0f * a * b);
}

/* V over two families: `share` of yarn that runs along y with slopes up to crimp, the rest along x. */
FN float yarn_area(Dir w, float share, float roundness, float crimp, float cross_crimp) {
    return w.z + share * yarn_hidden(w.x, w.y, w.z, roundness, crimp) +
           (1.0f - share) * yarn_hidden(w.y, w.x, w.z, roundness, cross_crimp);
}

/* P over a facet of these slopes. */
FN float yarn_facet(Dir w, float slope_x, float slope_y) {
    return max(w.z + slope_x * w.x + slope_y * w.y, 0.0f);
}

/* D and sigma by a^2; m: t . wi + t . wo, q: |wi + wo|^-2. */
FN float yarn_flakes(float a2, float m, float q) {
    float c = a2 + (1.0f - a2) * min(m * m * q, 1.0f);
    return a2 * sqrt(a2) / (PI * c * c);
}
FN float yarn_flake_area(float a2, float along) { return sqrt(max(1.0f - (1.0f - a2) * along * along, a2)); }

/* Returns |wi + wo|^-2, from the directions themselves: a.d would ask for a root. */
FN float yarn_half(Angles a) {
    float x = a.o.x + a.i.x, y = a.o.y + a.i.y, z = a.o.z + a.i.z;
    return 1.0f / max(x * x + y * y + z * z, 4e-6f);
}

/* single times 4 pi a^2 V_i V_o, from e = (1 - a^2) / a^2, m = t . wi + t . wo and P and t . w of each, with one division:
 * a pi D = (1 + e m^2 q)^-2, sigma / a = sqrt(1 + e (1 - (t . w)^2)). */
FN float yarn_met_once(float e, float q, float m, float p_o, float p_i, float t_o, float t_i) {
    float d = 1.0f + e * min(m * m * q, 1.0f);
    float wait = sqrt(1.0f + e * max(1.0f - t_i * t_i, 0.0f)) * p_o +
                 sqrt(1.0f + e * max(1.0f - t_o * t_o, 0.0f)) * p_i;
    return p_o * p_i / max(d * d * wait, 1e-6f);
}

/* Light that one fibre leaves for others, and its mean over the cosine. */
FN float yarn_left(float a, float cosine) {
    return 0.459f + 0.0157f * a + (0.3419f + 0.1186f * a) * sqrt(cosine) - 0.0911f * cosine;
}
FN float yarn_left_mean(float a) { return 0.672f + 0.111f * a; }

/* rho: what comes back of light that met two fibres or more. */
FN float yarn_reflectance(float albedo) {
    float g = sqrt(max(1.0f - albedo, 0.0f)), r = (1.0f - g) / (1.0f + 0.32f * g);
    return r * r;
}

#endif
