/* fibre_model.h - multiple scattering by fibres: a polynomial fitted to the solved slab
 *
 *   M(o, i) = 2^(A_o + A_i + h_o h_i - g_o g_i - k_o k_i (wo . wi - nu_o nu_i))  prod_b B_b(o, i)^-p_b [1/sr]
 *
 *   B: mu_o + mu_i + 0.04,  mu_o^2 - mu_o mu_i + mu_i^2 + ridge^2,  below alpha 0.19  mu_o + mu_i + 0.002
 *   and, where fibres lean, those of nu in parts of those of mu.
 *
 *   Own. A, h, g and k belong to one direction, so M is as reciprocal as floats are, above zero, and needs no
 * frame: no angle is taken, and nothing is singular at the normal. Each is a polynomial in
 * u(mu), which spreads the horizon out, and of powers of nu - mu, which vanish where fibres stand upright.
 * The numbers are those of tables/fibre_model.h. The middle base has its ridge where both directions are
 * equally steep: at low alpha light keeps nearly the angle that it has to the fibre, a walk of small steps
 * whose law is sqrt(mu_o mu_i) / (mu_o^3 + mu_i^3). */
#pragma once

#include "shading/dialect/angles.h"
#include "shading/dialect/tint.h"
#include "shading/tables/fibre_model.h"

/* The numbers of one material, without FibreNumbers: a record in this one would be too deep for WebGL, which takes
 * four levels. */
STRUCT(FibreModel) {
    float power, span, low; /* u = span (mu + 0.001)^power + low */
    float ridge, narrow;    /* squares */
    float s;                /* twice the square of the tilt's sine */
    float hold;             /* keeps E below 1 against the nap; set by hand after the fit, which has none */
};

/* The values of one direction: cosines to the normal and to the fibre, exponents of M, and for colour the
 * probability q that light meets another flake, and more exponents. */
STRUCT(FibreSide) { float mu, nu, a, h, g, k, q, v, u, c; };

/* Adds the terms of a lean that are alike for all directions of one u to those of upright fibres. */
FN FibreNumbers fibre_leaning(FibreNumbers n, float s) {
    n.a0 = n.a0 + s * n.na1;
    n.a1 = n.a1 + s * n.na4;
    n.a2 = n.a2 + s * n.na8;
    n.a3 = n.a3 + s * n.na13;
    n.h0 = n.h0 + s * n.nh1;
    n.h1 = n.h1 + s * n.nh4;
    n.h2 = n.h2 + s * n.nh8;
    n.g0 = n.g0 + s * n.ng1;
    n.g1 = n.g1 + s * n.ng4;
    n.g2 = n.g2 + s * n.ng8;
    n.k0 = n.k0 + s * n.nk1;
    n.na24 = s * n.na24;
    return n;
}

FN float fibre_coordinate(float alpha) { return 1.0f + 0.44703414f * log2(alpha); } /* -1 at 0.045, 1 at 1 */

FN FibreNumbers fibre_material_numbers(float alpha, float density, float s) {
    return fibre_leaning(fibre_numbers(fibre_coordinate(alpha), 0.5f * log2(density), s), s);
}

FN FibreModel fibre_model(float alpha, float tilt) {
    FibreModel m;
    float t = fibre_coordinate(alpha);
    float sine = sin(tilt), s2 = alpha * alpha;
    m.s = 2.0f * sine * sine;
    m.hold = 16.0f * m.s * ((1.0f - alpha) * (1.0f - alpha)) * ((1.0f - alpha) * (1.0f - alpha));
    m.power = 0.26f + 0.24f * max(t, -0.4f);
    m.low = pow(1e-3f, m.power);
    m.span = 2.0f / (pow(1.001f, m.power) - m.low);
    m.low = -1.0f - m.span * m.low;
    m.ridge = (0.3f * s2 + 0.01f) * (0.3f * s2 + 0.01f);
    m.narrow = 0.3f * s2 * s2 + 1e-3f;
    return m;
}

/* Adds the powers of d = nu - mu and of u by which a leaning fibre differs from an upright one. fibre_model has
 * included those without d. w fades from the horizon. */
FN FibreSide fibre_nap(FibreModel m, FibreNumbers n, FibreSide side, float mu, float nu, float u) {
    float d = nu - mu, w = 0.03f / (mu + 0.03f);
    float first = n.na0 + u * (n.na2 + u * (n.na7 + u * (n.na12 + u * n.na18)));
    float second = n.na3 + u * (n.na5 + u * (n.na11 + u * n.na17));
    float third = n.na6 + u * (n.na10 + u * n.na16), fourth = n.na9 + u * n.na15;
    float edge = d * (n.na19 + d * (n.na20 + d * (n.na21 + d * (n.na22 + d * n.na23)))) + n.na24;
    float against = max(-d, 0.0f); /* the nap nearly all light comes back, and no more may */
    edge = edge - m.hold * (against * against) * (against * against);
    side.a = side.a + d * (first + d * (second + d * (third + d * (fourth + d * n.na14)))) + w * edge;
    side.h = side.h + d * (n.nh0 + u * (n.nh2 + u * n.nh7) + d * (n.nh3 + u * n.nh5 + d * n.nh6));
    side.g = side.g + d * (n.ng0 + u * (n.ng2 + u * n.ng7) + d * (n.ng3 + u * n.ng5 + d * n.ng6));
    side.k = side.k + d * (n.nk0 + u * n.nk2);
    return side;
}

/* Adds the terms of thin fibres: sums of T_0 .. T_11 of u, whose powers would cancel. */
FN FibreSide fibre_thin(FibreNumbers n, FibreSide r, float u) {
    float x = 2.0f * u;
    float t2 = x * u - 1.0f, t3 = x * t2 - u, t4 = x * t3 - t2, t5 = x * t4 - t3, t6 = x * t5 - t4;
    float t7 = x * t6 - t5, t8 = x * t7 - t6, t9 = x * t8 - t7, t10 = x * t9 - t8, t11 = x * t10 - t9;
    r.a = r.a + n.ta0 + n.ta1 * u + n.ta2 * t2 + n.ta3 * t3 + n.ta4 * t4 + n.ta5 * t5 + n.ta6 * t6 + n.ta7 * t7 +
          n.ta8 * t8 + n.ta9 * t9 + n.ta10 * t10 + n.ta11 * t11;
    r.h = r.h + n.th0 + n.th1 * u + n.th2 * t2 + n.th3 * t3 + n.th4 * t4 + n.th5 * t5 + n.th6 * t6;
    r.g = r.g + n.tg0 + n.tg1 * u + n.tg2 * t2 + n.tg3 * t3 + n.tg4 * t4 + n.tg5 * t5 + n.tg6 * t6;
    r.k = r.k + n.tk0 + n.tk1 * u + n.tk2 * t2 + n.tk3 * t3 + n.tk4 * t4;
    r.q = r.q + n.tq0 + n.tq1 * u + n.tq2 * t2 + n.tq3 * t3 + n.tq4 * t4 + n.tq5 * t5 + n.tq6 * t6;
    r.v = r.v + n.tv0 + n.tv1 * u + n.tv2 * t2 + n.tv3 * t3 + n.tv4 * t4;
    r.u = r.u + n.tu0 + n.tu1 * u + n.tu2 * t2 + n.tu3 * t3 + n.tu4 * t4;
    r.c = r.c + n.tc0 + n.tc1 * u + n.tc2 * t2;
    return r;
}

/* Returns the part of one direction: polynomials in u, which runs from -1 at the horizon to 1, by Horner's rule. */
FN FibreSide fibre_side(FibreModel m, FibreNumbers n, float mu, float nu) {
    float u = m.span * pow(mu + 1e-3f, m.power) + m.low;
    FibreSide r;
    r.mu = mu;
    r.nu = nu;
    r.a = n.a0 + u * (n.a1 + u * (n.a2 + u * (n.a3 + u * (n.a4 + u * (n.a5 + u * (n.a6 + u * (n.a7 + u * n.a8)))))));
    r.h = n.h0 + u * (n.h1 + u * (n.h2 + u * (n.h3 + u * n.h4)));
    r.g = n.g0 + u * (n.g1 + u * (n.g2 + u * (n.g3 + u * (n.g4 + u * (n.g5 + u * n.g6)))));
    r.k = n.k0 + u * (n.k1 + u * (n.k2 + u * n.k3));
    r.q = n.q0 + u * (n.q1 + u * (n.q2 + u * (n.q3 + u * n.q4)));
    r.v = n.v0 + u * (n.v1 + u * (n.v2 + u * n.v3));
    r.u = n.u0 + u * (n.u1 + u * (n.u2 + u * n.u3));
    r.c = n.c0 + u * (n.c1 + u * n.c2);
    if (n.thin > 0.0f) r = fibre_thin(n, r, u);
    r.q = 1.0f / (1.0f + exp2(clamp(-r.q, -17.0f, 40.0f)));
    if (m.s > 0.0f) r = fibre_nap(m, n, r, mu, nu, u);
    return r;
}

/* Returns e less log2 of the bases to their powers. */
FN float fibre_bases(FibreModel m, FibreNumbers n, FibreSide o, FibreSide i, float e) {
    float sum = o.mu + i.mu, cross = sum * sum - 3.0f * (o.mu * i.mu);
    float l = e - n.p0 * log2(sum + 0.04f) - n.p1 * log2(cross + m.ridge);
    if (n.thin > 0.0f) l = l - n.tp0 * log2(sum + 0.04f) - n.tp1 * log2(cross + m.ridge) - n.tp2 * log2(sum + 0.002f);
    if (m.s > 0.0f) {
        float lean = o.nu + i.nu, mm = sum * sum, nn = lean * lean;
        l = l -
            0.5f * (n.np0 * log2((nn + 0.09f) / (mm + 0.09f)) + n.np1 * log2((nn + 0.5f) / (mm + 0.5f)) +
                    n.np2 * log2((nn + m.narrow) / (mm + m.narrow))) -
            n.np3 * log2((max(nn - 3.0f * (o.nu * i.nu), 0.0f) + 0.01f) / (cross + 0.01f));
        l = min(l, 40.0f);
    }
    return l;
}

/* Returns wo . wi - nu_o nu_i, the product of the parts of wo and wi across the fibre. */
FN float fibre_dot_across(FibreSide o, FibreSide i, Dir wo, Dir wi) { return dir_dot(wo, wi) - o.nu * i.nu; }

/* Returns M, the multiple scattering, 1/sr. */
FN float fibre_multiple(FibreModel m, FibreNumbers n, FibreSide o, FibreSide i, float dot_across) {
    float e = (o.a + i.a) + (o.h * i.h - o.g * i.g) - o.k * i.k * dot_across;
    return exp2(fibre_bases(m, n, o, i, e));
}

/* Returns e of the tint. */
FN float fibre_tint_order(FibreSide o, FibreSide i, float dot_across) {
    return 0.69314718f * (o.v * i.v - o.u * i.u - o.c * i.c * dot_across);
}
