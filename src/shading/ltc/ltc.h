/* ltc.h - a linearly transformed cosine: a density over directions that can be evaluated, sampled and, over a
 * polygon, integrated in closed form
 *
 *   v = M^-1 w,   D(w) = max(v_z, 0) |M^-1| / (pi |v|^4)                                         [1/sr]
 *
 *   Eric Heitz, Jonathan Dupuy, Stephen Hill, David Neubelt, "Real-Time Polygonal-Light Shading with Linearly
 * Transformed Cosines", ACM Transactions on Graphics 35(4), 2016, equation (1) with a clamped cosine as D_o.
 * Over the sphere D integrates to 1. What a lobe sends on, f cos_i, is an amplitude times D.
 *
 *   An isotropic lobe is the same on both sides of the plane of incidence, so with x along the tangential
 * part o of wo, whose length is s = sin(theta_o), and a common factor free, M^-1 is
 *
 *     ( m11    0   b s )
 *     (  0     1    0  )     m11 = 1 + e s^2
 *     ( d s    0    z  )
 *
 *   The powers of s are those that a function of o without an edge at o = 0 must have: a round lobe at normal
 * incidence, and corners that are odd. So x is only ever seen as s x, which is o itself:
 *
 *   v_xy = w_xy + (e t + b w_z) o,   v_z = z w_z + d t,   t = w_xy . o
 *
 *   That takes no tangent of unit length and no angle; neither has a value at normal incidence. With e = d =
 * 0 it is the transform of Tizian Zeltner, Brent Burley, Matt Jen-Yuan Chiang, "Practical Multiple-Scattering
 * Sheen Using Linearly Transformed Cosines", SIGGRAPH Talks 2022, whose rotation cancels.
 *
 *   |M^-1| = z m11 - s^2 b d = z + s^2 k,   k = z e - b d
 *   |M^-1| M v = ( |M^-1| v_xy - (k t + b v_z) o,   m11 v_z - d t ),   t = v_xy . o
 *
 *   A table holds z, q, b and r:  e = q - 1,  so  m11 = cos_o^2 + q s^2;  d = -r b,  so the pole of the
 * hemisphere that is not cut off leans to the side of the peak. Then |M^-1| = z m11 + r b^2 s^2 is a sum of
 * what is never below 0, for z > 0, q >= 0 and r >= 0, and any mixing that keeps these three keeps the matrix
 * regular. A mirror's limit is simple: q = 0, b = cos_o, r and z / cos_o^2 twice its alpha. */
#pragma once

#include "shading/dialect/warp.h"

STRUCT(Ltc) {
    float e, b, d, z, m11; /* of M^-1 */
    float k, det;          /* det = |M^-1| */
};

/* Returns the transform for a wo of that cosine; z > 0, q >= 0, r >= 0. The floors prevent rounding to 0. */
FN Ltc ltc_of(float z, float q, float b, float r, float cos_o) {
    float c2 = min(cos_o * cos_o, 1.0f), s2 = 1.0f - c2;
    Ltc m;
    m.e = q - 1.0f;
    m.b = b;
    m.d = -r * b;
    m.z = max(z, 1e-12f);
    m.m11 = max(c2 + q * s2, 1e-10f);
    m.k = m.z * m.e + r * b * b;
    m.det = m.z * m.m11 + r * b * b * s2;
    return m;
}

/* Evaluates v = M^-1 w, which transforms the corners of a light. */
FN Dir ltc_inverse(Ltc m, Dir o, Dir w) {
    float t = w.x * o.x + w.y * o.y, c = m.e * t + m.b * w.z;
    return dir(w.x + c * o.x, w.y + c * o.y, m.z * w.z + m.d * t);
}

/* Evaluates |M^-1| M v, the inverse of ltc_inverse but for the length. */
FN Dir ltc_forward(Ltc m, Dir o, Dir v) {
    float t = v.x * o.x + v.y * o.y, c = m.k * t + m.b * v.z;
    return dir(m.det * v.x - c * o.x, m.det * v.y - c * o.y, m.m11 * v.z - m.d * t);
}

/* Returns D(i), the density of the samples. */
FN float ltc_pdf(Ltc m, Dir o, Dir i) {
    Dir v = ltc_inverse(m, o, i);
    float r2 = max(dir_dot(v, v), 1e-18f); /* keeps its square a normal number */
    return max(v.z, 0.0f) * m.det / (PI * r2 * r2);
}

/* Returns a direction with density D. If it is below the horizon, there is no sample. */
FN Dir ltc_sample(Ltc m, Dir o, float u, float v) {
    Dir w = ltc_forward(m, o, warp_cosine(u, v));
    float r = 1.0f / sqrt(max(dir_dot(w, w), 1e-36f));
    return dir(w.x * r, w.y * r, w.z * r);
}

/* Returns the part of D above the horizon, (1 + n_z / |n|) / 2. M maps the horizon to a plane with the normal n =
 * (-d s, 0, m11), the last row of M, and half a clamped cosine is on each side of its axis. */
FN float ltc_above(Ltc m, Dir o) {
    float n2 = m.m11 * m.m11 + m.d * m.d * (o.x * o.x + o.y * o.y);
    return 0.5f + 0.5f * m.m11 / sqrt(max(n2, 1e-36f));
}
