/* yarn_draw.h - directions drawn at a surface of fibres: of the light that lobes yarn and woven reflect there
 *
 *   pdf = c (F(wi) + F(wi')) + (1 - c) (q ((n . wi)+ + (n . wi')+) + (1 - q) wi_z) / pi            [1/sr]
 *   F = 2 D(h) (wo . g)+ / (4 sigma_o |wo . h|),  wi' = (wi_x, wi_y, -wi_z)
 *
 *   D, sigma, t, P and V are those of shading/yarn_medium.h; n is the normal of the yarn.
 *   Light that met one fibre is drawn by the flakes that are seen, as section 4 of the SGGX paper has it. Half of
 * them would send light down into the yarn. So a flake g is turned about t, half way to n: then a smooth fibre sends light
 * by the cosine of its angle about t, which is nearly what leaves a yarn. g has twice the angle of h, and F is the density
 * of what h reflects. Other light is drawn by the cosine about n, as P_i has it, or about z. What would go below the
 * horizon is mirrored there. Own. */
#ifndef WEFT_SHADING_YARN_DRAW_H
#define WEFT_SHADING_YARN_DRAW_H

#include "shading/warp.h"
#include "shading/yarn_medium.h"

/* A surface: t, a, s_x, s_y and 1 / |(s_x, s_y, 1)|. */
STRUCT(YarnSurface) {
    Dir axis;
    float alpha, slope_x, slope_y, over_n;
};

/* A view adds P, t . wo, c and q. */
STRUCT(YarnProposal) { float p, along, flakes, slope; };

/* c, found by trial for fibres of albedo 0.9. left: as yarn_left has it. */
FN float yarn_by_flakes(float alpha, float p, float left) {
    return p > 0.0f ? clamp(1.3f - 0.6f * alpha - left, 0.0f, 0.9f) : 0.0f;
}

/* F, from P_i without its bound, m = t . (wi + wo) and k = |wi + wo|^2:
 * F = D (r (P_i k + m^2 P_o - 2 (t . wo) m (P_i + P_o)) / sqrt(k - m^2) +- (t . wo) m)+ / (sigma_o k),
 * r = 1 / |(s_x, s_y, 1)|, minus where h points into the yarn. */
FN float yarn_turned_pdf(YarnSurface s, YarnProposal w, float p_i, float m, float k) {
    float a2 = max(s.alpha * s.alpha, 1e-6f), q = max(k, 1e-12f), on = w.along * m, both = w.p + p_i;
    float across = s.over_n * (p_i * q + m * m * w.p - 2.0f * on * both) / sqrt(max(q - m * m, 1e-6f * q));
    float seen = max(across + (both < 0.0f ? -on : on), 0.0f);
    return yarn_flakes(a2, m, 1.0f / q) * seen / (yarn_flake_area(a2, w.along) * q);
}

/* along: t . wi. The differences are found from directions, since in those of squares nothing would be left of a small k. */
FN float yarn_draw_pdf(YarnSurface s, YarnProposal w, float along, Angles a) {
    float up = a.i.z + s.slope_x * a.i.x + s.slope_y * a.i.y, down = up - 2.0f * a.i.z;
    float x = a.o.x + a.i.x, y = a.o.y + a.i.y, z = a.o.z - a.i.z, m = w.along + along;
    float flakes = yarn_turned_pdf(s, w, up, m, 4.0f * a.d * a.d) +
                   yarn_turned_pdf(s, w, down, m - 2.0f * a.i.z * s.axis.z, x * x + y * y + z * z);
    float slope = (max(up, 0.0f) + max(down, 0.0f)) * s.over_n / PI;
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

    Dir b = dir(n.y * t.z - n.z * t.y, n.z * t.x - n.x * t.z, n.x * t.y - n.y * t.x);
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
