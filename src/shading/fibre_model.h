/* fibre_model.h - light that met more than one fibre: a closed form fitted to the solved slab
 *
 *   M(o, i) = 2^(A_o + A_i + h_o h_i - g_o g_i - k_o k_i (wo . wi - nu_o nu_i))  prod_b B_b(o, i)^-p_b [1/sr]
 *
 *   B: mu_o + mu_i + 0.04,  mu_o^2 - mu_o mu_i + mu_i^2 + ridge^2,  mu_o + mu_i + 0.002
 *   and, where fibres lean, those of nu in parts of those of mu.
 *
 *   Own. A, h, g and k belong to one direction, so M is as reciprocal as floats are, above zero, and needs no
 * frame: no angle is taken, and nothing is singular at the normal. Each is a sum of Chebyshev polynomials of
 * u(mu), which spreads the horizon out, and of powers of nu - mu, which vanish where fibres stand upright.
 * The numbers are those of tables/fibre_model.h. The middle base has its ridge where both directions are
 * equally steep: at low alpha light keeps nearly the angle that it has to the fibre, a walk of small steps
 * whose law is sqrt(mu_o mu_i) / (mu_o^3 + mu_i^3). */
#ifndef WEFT_FIBRE_MODEL_H
#define WEFT_FIBRE_MODEL_H

#include "shading/angles.h"
#include "shading/tables/fibre_model.h"
#include "shading/tint.h"

/* All that a material knows. */
STRUCT(FibreModel) {
    FibreNumbers n;
    float power, low, span; /* of u(mu) */
    float ridge, narrow;    /* squares */
    float s;                /* twice the square of the tilt's sine */
};

/* What one direction has of its own: cosines to the normal and to the fibre, exponents of M, and for colour
 * the chance q that light meets a flake more, and exponents again. */
STRUCT(FibreSide) { float mu, nu, a, h, g, k, q, v, u, c; };

FN FibreModel fibre_model(float alpha, float density, float tilt) {
    FibreModel m;
    float t = 1.0f + 0.44703414f * log2(alpha); /* -1 at 0.045, 1 at 1 */
    float sine = sin(tilt), s2 = alpha * alpha;
    m.s = 2.0f * sine * sine;
    m.n = fibre_numbers(t, 0.5f * log2(density), m.s);
    m.power = 0.26f + 0.24f * t;
    m.low = pow(1e-3f, m.power);
    m.span = 2.0f / (pow(1.001f, m.power) - m.low);
    m.ridge = (0.3f * s2 + 0.01f) * (0.3f * s2 + 0.01f);
    m.narrow = 0.3f * s2 * s2 + 1e-3f;
    return m;
}

/* The powers of d = nu - mu and of u that tell a leaning fibre from an upright one; w fades from the horizon.
 */
FN FibreSide fibre_nap(FibreModel m, FibreSide side, float mu, float nu, float u) {
    FibreNumbers n = m.n;
    float d = nu - mu, s = m.s, w = 0.03f / (mu + 0.03f);
    float low = d * (n.a12 + d * (n.a15 + d * n.a18) + u * (n.a14 + d * n.a17 + u * n.a19)) +
                s * (n.a13 + u * (n.a16 + u * (n.a20 + u * n.a25)));
    float fourth = d * (d * (d * (n.a21 * d + n.a22 * u) + n.a23 * u * u) + n.a24 * u * u * u);
    float fifth = d * (d * (d * (d * (n.a26 * d + n.a27 * u) + n.a28 * u * u) + n.a29 * u * u * u) +
                       n.a30 * u * u * u * u);
    float edge = w * (d * (n.a31 + d * (n.a32 + d * (n.a33 + d * (n.a34 + d * n.a35)))) + s * n.a36);
    float against = max(-d, 0.0f); /* the nap: nearly all light comes back, and no more may */
    edge = edge - 2.3f * w * s * (against * against) * (against * against);
    side.a = side.a + low + fourth + fifth + edge;
    side.h = side.h + d * (n.h7 + d * (n.h10 + d * n.h13) + u * (n.h9 + d * n.h12 + u * n.h14)) +
             s * (n.h8 + u * (n.h11 + u * n.h15));
    side.g = side.g + d * (n.g7 + d * (n.g10 + d * n.g13) + u * (n.g9 + d * n.g12 + u * n.g14)) +
             s * (n.g8 + u * (n.g11 + u * n.g15));
    side.k = side.k + d * (n.k5 + u * n.k7) + s * n.k6;
    return side;
}

/* T_0 .. T_11 of u, once, and what each part makes of them. */
FN FibreSide fibre_side(FibreModel m, float mu, float nu) {
    FibreNumbers n = m.n;
    float u = m.span * (pow(mu + 1e-3f, m.power) - m.low) - 1.0f, x = 2.0f * u;
    float t2 = x * u - 1.0f, t3 = x * t2 - u, t4 = x * t3 - t2, t5 = x * t4 - t3, t6 = x * t5 - t4;
    float t7 = x * t6 - t5, t8 = x * t7 - t6, t9 = x * t8 - t7, t10 = x * t9 - t8, t11 = x * t10 - t9;
    FibreSide r;
    r.mu = mu;
    r.nu = nu;
    r.a = n.a0 + n.a1 * u + n.a2 * t2 + n.a3 * t3 + n.a4 * t4 + n.a5 * t5 + n.a6 * t6 + n.a7 * t7 +
          n.a8 * t8 + n.a9 * t9 + n.a10 * t10 + n.a11 * t11;
    r.h = n.h0 + n.h1 * u + n.h2 * t2 + n.h3 * t3 + n.h4 * t4 + n.h5 * t5 + n.h6 * t6;
    r.g = n.g0 + n.g1 * u + n.g2 * t2 + n.g3 * t3 + n.g4 * t4 + n.g5 * t5 + n.g6 * t6;
    r.k = n.k0 + n.k1 * u + n.k2 * t2 + n.k3 * t3 + n.k4 * t4;
    float again = n.q0 + n.q1 * u + n.q2 * t2 + n.q3 * t3 + n.q4 * t4;
    r.q = 1.0f / (1.0f + exp2(clamp(-again, -17.0f, 40.0f)));
    r.v = n.v0 + n.v1 * u + n.v2 * t2 + n.v3 * t3;
    r.u = n.u0 + n.u1 * u + n.u2 * t2 + n.u3 * t3;
    r.c = n.c0 + n.c1 * u + n.c2 * t2;
    if (m.s > 0.0f) r = fibre_nap(m, r, mu, nu, u);
    return r;
}

/* log2 of the bases to their powers. */
FN float fibre_bases(FibreModel m, FibreSide o, FibreSide i) {
    float sum = o.mu + i.mu, cross = sum * sum - 3.0f * (o.mu * i.mu);
    float l = m.n.p0 * log2(sum + 0.04f) + m.n.p1 * log2(cross + m.ridge) + m.n.p2 * log2(sum + 0.002f);
    if (m.s > 0.0f) {
        float lean = o.nu + i.nu, mm = sum * sum, nn = lean * lean;
        l = l +
            0.5f * (m.n.p3 * log2((nn + 0.09f) / (mm + 0.09f)) + m.n.p4 * log2((nn + 0.5f) / (mm + 0.5f)) +
                    m.n.p5 * log2((nn + m.narrow) / (mm + m.narrow))) +
            m.n.p6 * log2((max(nn - 3.0f * (o.nu * i.nu), 0.0f) + 0.01f) / (cross + 0.01f));
    }
    return l;
}

/* wo . wi - nu_o nu_i: the cosine of the azimuth about the fibre, times both sines. */
FN float fibre_turn(FibreSide o, FibreSide i, Dir wo, Dir wi) { return dir_dot(wo, wi) - o.nu * i.nu; }

/* M, 1/sr. */
FN float fibre_multiple(FibreModel m, FibreSide o, FibreSide i, Dir wo, Dir wi) {
    float e = (o.a + i.a) + (o.h * i.h - o.g * i.g) - o.k * i.k * fibre_turn(o, i, wo, wi);
    return exp2(min(e - fibre_bases(m, o, i), 40.0f));
}

/* e of the colour. */
FN float fibre_deepen(FibreModel m, FibreSide o, FibreSide i, Dir wo, Dir wi) {
    return 0.69314718f * (o.v * i.v - o.u * i.u - o.c * i.c * fibre_turn(o, i, wo, wi));
}

#endif
