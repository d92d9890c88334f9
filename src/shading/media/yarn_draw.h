/* yarn_draw.h - directions drawn at a surface of fibres: of the light that lobes yarn and woven reflect there
 *
 *   pdf = c (F(wi) + F(wi')) + (1 - c) (q ((n . wi)+ + (n . wi')+) + (1 - q) wi_z) / pi            [1/sr]
 *   F = 2 D(h) (wo . g)+ / (4 sigma_o |wo . h|),  wi' = (wi_x, wi_y, -wi_z)
 *
 *   D, sigma, t, P and V are those of shading/media/yarn_medium.h; n is the normal of the yarn.
 *   Light that met one fibre is drawn by the flakes that are seen, as section 4 of the SGGX paper has it. Half of
 * them would send light down into the yarn. So a flake g is turned about t, half way to n: then a smooth fibre sends light
 * by the cosine of its angle about t, which is nearly what leaves a yarn. g has twice the angle of h, and F is the density
 * of what h reflects. Other light is drawn by the cosine about n, as P_i has it, or about z. What would go below the
 * horizon is mirrored there. Own. */
#ifndef WEFT_SHADING_YARN_DRAW_H
#define WEFT_SHADING_YARN_DRAW_H

#include "shading/dialect/warp.h"
#include "shading/media/yarn_medium.h"

/* A surface: t, a, s_x, s_y and 1 / |(s_x, s_y, 1)|. */
STRUCT(YarnSurface) {
    Dir axis;
    float alpha, slope_x, slope_y, over_n;
};

/* A view adds t . wo, c and q. */
STRUCT(YarnProposal) { float along, flakes, slope; };

/* c, found by trial for fibres of albedo 0.9. left: as yarn_left has it. */
FN float yarn_by_flakes(float alpha, float p, float left) {
    return p > 0.0f ? clamp(1.3f - 0.6f * alpha - left, 0.0f, 0.9f) : 0.0f;
}

/* F from the sum d of wo and wi or wi', whose direction is h. With b = n x t, and x, y, m the parts of d along n, b, t,
 * F = D (((n . wo) (x^2 - y^2) + 2 (b . wo) x y) / sqrt(x^2 + y^2) +- (t . wo) m)+ / (sigma_o |d|^2),
 * minus where h points into the yarn. Nothing cancels but what cancels in d. */
FN float yarn_turned_pdf(YarnSurface s, YarnProposal w, Dir o, Dir n, Dir d) {
    Dir t = s.axis, b = dir_cross(n, t);
    float x = dir_dot(n, d), y = dir_dot(b, d), m = dir_dot(t, d), e = x * x + y * y,
          q = max(e + m * m, 1e-12f);
    float a2 = max(s.alpha * s.alpha, 1e-6f), on = w.along * m;
    float across = dir_dot(n, o) * (x * x - y * y) + 2.0f * dir_dot(b, o) * x * y;
    float seen = max(across / sqrt(max(e, 1e-6f * q)) + (x < 0.0f ? -on : on), 0.0f);
    return yarn_flakes(a2, m, 1.0f / q) * seen / (yarn_flake_area(a2, w.along) * q);
}

FN float yarn_draw_pdf(YarnSurface s, YarnProposal w, Angles a) {
    Dir n = dir(s.slope_x * s.over_n, s.slope_y * s.over_n, s.over_n);
    float x = a.o.x + a.i.x, y = a.o.y + a.i.y, up = dir_dot(n, a.i), down = up - 2.0f * n.z * a.i.z;
    float flakes = yarn_turned_pdf(s, w, a.o, n, dir(x, y, a.o.z + a.i.z)) +
                   yarn_turned_pdf(s, w, a.o, n, dir(x, y, a.o.z - a.i.z));
    float slope = (max(up, 0.0f) + max(down, 0.0f)) / PI;
    return mix(mix(warp_cosine_pdf(a.i), slope, w.slope), flakes, w.flakes);
}

/* Flakes are a sphere if the stretch of t is taken back, and what wo sees of it has a density of the cosine about the
 * stretched wo. A unit vector and a point of the unit sphere have a sum of such a density: about stretched wo, n or z.
 * In the plane across t, half an angle has the cosine sqrt((1 + cos) / 2) and the sine sqrt((1 - cos) / 2); the smaller of
 * both is found from the sine of the whole, so that nothing cancels. */
FN Dir yarn_draw(YarnSurface s, YarnProposal w, Dir o, float u, float v) {
    float flakes = w.flakes, slope = flakes + (1.0f - flakes) * w.slope;
    bool once = u < flakes, leans = u < slope;
    float low = once ? 0.0f : leans ? flakes : slope, high = once ? flakes : leans ? slope : 1.0f;
    float x = min((u - low) / max(high - low, 1e-6f), 0.999999f);
    float r = 2.0f * sqrt(x * (1.0f - x)), phi = 2.0f * PI * v;

    Dir t = s.axis, n = dir(s.slope_x * s.over_n, s.slope_y * s.over_n, s.over_n);
    float k = (s.alpha - 1.0f) * w.along;
    Dir about = dir(o.x + k * t.x, o.y + k * t.y, o.z + k * t.z);
    float over = 1.0f / sqrt(max(dir_dot(about, about), 1e-12f));
    about = dir(about.x * over, about.y * over, about.z * over);
    if (!once) about = dir(leans ? n.x : 0.0f, leans ? n.y : 0.0f, leans ? n.z : 1.0f);
    Dir g = dir(about.x + r * cos(phi), about.y + r * sin(phi), about.z + 1.0f - 2.0f * x);

    Dir b = dir_cross(n, t);
    float along = s.alpha * dir_dot(t, g), near = dir_dot(n, g), side = dir_dot(b, g);
    float d = sqrt(near * near + side * side), root = sqrt(d), wide = sqrt(0.5f * (d + abs(near)));
    float thin = 0.5f * abs(side) / max(wide, 1e-9f), c = root * (near < 0.0f ? thin : wide);
    float e = root * (near < 0.0f ? wide : thin) * (side < 0.0f ? -1.0f : 1.0f);
    Dir h = dir(c * n.x + e * b.x + along * t.x, c * n.y + e * b.y + along * t.y,
                c * n.z + e * b.z + along * t.z);
    float m = 2.0f * dir_dot(o, h) / max(dir_dot(h, h), 1e-12f);
    float unit = 1.0f / sqrt(max(dir_dot(g, g), 1e-12f));
    Dir i = dir(g.x * unit, g.y * unit, g.z * unit);
    if (once) i = dir(m * h.x - o.x, m * h.y - o.y, m * h.z - o.z);
    i.z = abs(i.z);
    return i;
}

#endif
