/* yarn_draw.h - directions sampled on a surface of fibres, for lobes yarn and woven
 *
 *   pdf = c (F(wi) + F(wi')) + (1 - c) (q (max(n . wi, 0) + max(n . wi', 0)) + (1 - q) wi_z) / pi   [1/sr]
 *   F = 2 D(h) max(wo . g, 0) / (4 sigma_o |wo . h|),  wi' = (wi_x, wi_y, -wi_z)
 *
 *   D, sigma and the fibres' axis t are those of shading/media/yarn_medium.h; n is the unit normal of the yarn. A sample has
 * one of three densities: with chance c that of light that met one fibre, otherwise with chance q a cosine about n, as
 * light that comes along n has it, and else a cosine about z. Samples below the horizon are mirrored to above it: wi
 * and wi' are one sample.
 *   Light that met one fibre leaves a flake g that wo sees, as in section 4 of the SGGX paper. Half of these flakes
 * would send it down into the yarn. So g is rotated about t, half of the way to n, and reflects as h. Then a smooth
 * fibre sends light by the cosine of its angle about t, which is nearly what leaves a yarn. The angle of g about t is
 * twice that of h, which is the factor 2 of F, and D(g) = D(h). Own. */
#pragma once

#include "shading/dialect/warp.h"
#include "shading/media/yarn_medium.h"

STRUCT(YarnSurface) {
    Dir axis; /* t */
    float alpha;
    float slope_x, slope_y; /* of the yarn */
    float per_n;            /* 1 / |(slope_x, slope_y, 1)| */
};

/* The densities for one wo. */
STRUCT(YarnProposal) {
    float along; /* t . wo */
    float c, q;  /* chances of the densities, 0 to 1 */
};

/* Returns c: 0 if wo sees no yarn (p is P of wo). Found by trial for fibres of albedo 0.9. */
FN float yarn_flake_chance(float alpha, float p, float remainder) {
    return p > 0.0f ? clamp(1.3f - 0.6f * alpha - remainder, 0.0f, 0.9f) : 0.0f;
}

/* Returns F. d: wo + wi or wo + wi', whose direction is h. With b = n x t, and x, y, m the parts of d along n, b and t,
 *   F = D max(((n . wo) (x^2 - y^2) + 2 (b . wo) x y) / sqrt(x^2 + y^2) +- (t . wo) m, 0) / (sigma_o |d|^2)
 * with minus where h points into the yarn. No difference here loses digits that d has. */
FN float yarn_flake_pdf(YarnSurface s, YarnProposal w, Dir o, Dir n, Dir d) {
    Dir t = s.axis, b = dir_cross(n, t);
    float x = dir_dot(n, d), y = dir_dot(b, d), m = dir_dot(t, d), e = x * x + y * y, d2 = max(e + m * m, 1e-12f);
    float a2 = max(s.alpha * s.alpha, 1e-6f), along = w.along * m;
    float across = dir_dot(n, o) * (x * x - y * y) + 2.0f * dir_dot(b, o) * x * y;
    float seen = max(across / sqrt(max(e, 1e-6f * d2)) + (x < 0.0f ? -along : along), 0.0f);
    return yarn_d(a2, m, 1.0f / d2) * seen / (yarn_sigma(a2, w.along) * d2);
}

FN float yarn_draw_pdf(YarnSurface s, YarnProposal w, Angles a) {
    Dir n = dir(s.slope_x * s.per_n, s.slope_y * s.per_n, s.per_n);
    float x = a.o.x + a.i.x, y = a.o.y + a.i.y, up = dir_dot(n, a.i), down = up - 2.0f * n.z * a.i.z;
    float flakes =
        yarn_flake_pdf(s, w, a.o, n, dir(x, y, a.o.z + a.i.z)) + yarn_flake_pdf(s, w, a.o, n, dir(x, y, a.o.z - a.i.z));
    float about_n = (max(up, 0.0f) + max(down, 0.0f)) / PI;
    return mix(mix(warp_cosine_pdf(a.i), about_n, w.q), flakes, w.c);
}

/* Returns the normal of the flake that reflects the sample, of any length. g: a flake that wo sees, divided by the
 * stretch: its part along t is yet to be scaled by alpha. The rotation halves the angle of g about t. In the plane
 * across t the half angle has the cosine sqrt((1 + cos) / 2) and the sine sqrt((1 - cos) / 2). The smaller of both
 * comes from the sine of the whole angle, so that no digits are lost. */
FN Dir yarn_rotated_flake(YarnSurface s, Dir n, Dir g) {
    Dir t = s.axis, b = dir_cross(n, t);
    float along = s.alpha * dir_dot(t, g), near = dir_dot(n, g), side = dir_dot(b, g);
    float d = sqrt(near * near + side * side), root = sqrt(d), larger = sqrt(0.5f * (d + abs(near)));
    float smaller = 0.5f * abs(side) / max(larger, 1e-9f), c = root * (near < 0.0f ? smaller : larger);
    float e = root * (near < 0.0f ? larger : smaller) * (side < 0.0f ? -1.0f : 1.0f);
    return dir(c * n.x + e * b.x + along * t.x, c * n.y + e * b.y + along * t.y, c * n.z + e * b.z + along * t.z);
}

/* Returns wi for two random numbers in [0, 1). Divided by the stretch along t the flakes are a sphere, of which wo sees
 * those with a cosine about the stretched wo. So each of the three densities is a cosine about some axis, and the sum
 * of that unit axis and a uniform point of the unit sphere has such a density. */
FN Dir yarn_draw(YarnSurface s, YarnProposal w, Dir o, float u, float v) {
    float c = w.c, c_q = c + (1.0f - c) * w.q;
    bool by_flake = u < c, about_n = u < c_q;
    float low = by_flake ? 0.0f : about_n ? c : c_q, high = by_flake ? c : about_n ? c_q : 1.0f;
    float x = min((u - low) / max(high - low, 1e-6f), 0.999999f);
    float r = 2.0f * sqrt(x * (1.0f - x)), phi = 2.0f * PI * v;

    Dir t = s.axis, n = dir(s.slope_x * s.per_n, s.slope_y * s.per_n, s.per_n);
    float k = (s.alpha - 1.0f) * w.along;
    Dir about = dir(o.x + k * t.x, o.y + k * t.y, o.z + k * t.z);
    float unit = 1.0f / sqrt(max(dir_dot(about, about), 1e-12f));
    about = dir(about.x * unit, about.y * unit, about.z * unit);
    if (!by_flake) about = dir(about_n ? n.x : 0.0f, about_n ? n.y : 0.0f, about_n ? n.z : 1.0f);
    Dir g = dir(about.x + r * cos(phi), about.y + r * sin(phi), about.z + 1.0f - 2.0f * x);

    Dir h = yarn_rotated_flake(s, n, g);
    float m = 2.0f * dir_dot(o, h) / max(dir_dot(h, h), 1e-12f);
    unit = 1.0f / sqrt(max(dir_dot(g, g), 1e-12f));
    Dir i = dir(g.x * unit, g.y * unit, g.z * unit);
    if (by_flake) i = dir(m * h.x - o.x, m * h.y - o.y, m * h.z - o.z);
    i.z = abs(i.z);
    return i;
}
