/* fibre-walk - fuzz as it is: light walking among fibres, for the path tracer to compare other sheens with
 *
 *   f = color (f1 + f2 + f3 + ...),   f1: fibre_medium.h, with H = density and s = alpha^2       [1/sr]
 *   f2 + f3 + ... = mean over walks of   sum over flakes from the second on of
 *                   D(h) exp(-sigma(b) z / mu_b) / (4 sigma(d) mu_b)
 *
 *   Tizian Zeltner, Brent Burley, Matt Jen-Yuan Chiang, "Practical Multiple-Scattering Sheen Using Linearly
 * Transformed Cosines", SIGGRAPH Talks 2022; the medium is that of Eric Heitz et al., "The SGGX Microflake
 * Distribution", ACM TOG 34(4), 2015.
 *   One walk is taken, whose random numbers are a hash of the two directions: f is a function of them, but
 *     one that jumps, and only its mean over a neighbourhood is the f of the slab. The walk starts at the
 *     direction that sees less deep, and each of its flakes is connected to the other, b: z is its depth, d
 *     where light comes to it from. So large terms are rare, and f(wo, wi) is f(wi, wo) for each pair.
 *   Departures: the talk's walk ends after 16 flakes and, inside the slab, is counted by its last direction; here it
 *     goes on until it leaves. Density and fibres that lean are not in the talk.
 *   roughness: alpha = roughness^2; alpha is the talk's, and s the cross-section of a fibre along its axis.
 *   reciprocal: yes, since the walk does not depend on which direction is wo.
 *   energy: E <= 1; what does not come back goes through. E itself is the share of many walks.
 *   sampling: x = (wi + wo) . t by b / (b + |x|)^2, b = max(mu_o, s), and evenly around t; a share of
 *     alpha half by the cosine, half uniformly.
 *   Not for: the GPU, arrays and 16-bit floats. E has a standard error of 0.0025 in the tables of layer rules.
 *   measured by weft check fibre-walk, other parameters at default: E at most 0.79 (alpha 0.09, cos_o 0.001);
 *     reciprocal to 1e-3; weight variance 0.31 of the cosine's;
 *     half precision: not measured, since the lobe is for the path tracer only. */
#pragma once

#include "base/random.h"
#include "shading/dialect/warp.h"
#include "shading/lobe/lobe.h"
#include "shading/media/fibre_medium.h"

#define FIBRE_WALK_PARAMS(P)                                                                                           \
    P(float, alpha, 0.5f, 0.05f, 1.0f, 0.03f, 1.0f, "square root of what a fibre shows along its axis")                \
    P(float, density, 1.0f, 0.25f, 4.0f, 0.01f, 8.0f, "of fibres, times the thickness of the fuzz")                    \
    P(float, tilt, 0.0f, 0.0f, 0.785398163f, 0.0f, 1.57079633f, "how far fibres lean over, radians")                   \
    P(float, azimuth, 0.0f, 0.0f, 6.28318531f, 0.0f, 6.28318531f, "where to, from the tangent, radians")
#define FIBRE_WALK_TRAITS (TRAIT_RECIPROCAL | TRAIT_CONSERVES | TRAIT_ANISOTROPIC | TRAIT_REFERENCE)

STRUCT(FibreWalk){FIBRE_WALK_PARAMS(FIELD)};
PREPARED_AS_IT_IS(fibre_walk, FibreWalk)
SEEN_AS_IT_IS(fibre_walk, FibreWalk)

/* Returns the first state of the random numbers, from the bits of a direction. */
FN uint64_t fibre_walk_bits(Dir w) {
    uint32_t x, y, z;
    memcpy(&x, &w.x, 4);
    memcpy(&y, &w.y, 4);
    memcpy(&z, &w.z, 4);
    return stream_start((uint64_t)x << 32 | y, z);
}
FN float fibre_walk_unit(uint64_t *stream) { return unit_float((uint32_t)(stream_next(stream) >> 32)); }

/* Returns a random point of the unit sphere. George Marsaglia, "Choosing a Point from the Surface of a Sphere",
 * 1972. */
FN Dir fibre_walk_point(uint64_t *stream) {
    for (;;) {
        uint64_t bits = stream_next(stream);
        float x = 2.0f * unit_float((uint32_t)(bits >> 32)) - 1.0f;
        float y = 2.0f * unit_float((uint32_t)bits) - 1.0f;
        float square = x * x + y * y, k = 2.0f * sqrt(max(1.0f - square, 0.0f));
        if (square < 1.0f) return dir(k * x, k * y, 1.0f - 2.0f * square);
    }
}

/* Light on its way, and how deep it is. */
STRUCT(FibreWalker) {
    Dir d;
    float depth, sigma;
};

FN FibreWalker fibre_walk_start(Dir o) {
    FibreWalker w = {{-o.x, -o.y, -o.z}, 0.0f, 0.0f};
    return w;
}

/* Moves the walker to its next flake, which exists if 0 < depth < density. */
FN FibreWalker fibre_walk_fly(FibreWalker w, float s, Dir t, uint64_t *stream) {
    Dir v = flake_stretch(s, t, w.d);
    w.sigma = sqrt(dir_dot(v, v));
    w.depth = w.depth + w.d.z * 0.693147181f * log2(1.0f - fibre_walk_unit(stream)) / w.sigma;
    return w;
}
FN bool fibre_walk_inside(FibreWalker w, float density) { return w.depth > 0.0f && w.depth < density; }
FN FibreWalker fibre_walk_scatter(FibreWalker w, float s, Dir t, uint64_t *stream) {
    w.d = flake_scatter(s, t, dir(-w.d.x, -w.d.y, -w.d.z), fibre_walk_point(stream));
    return w;
}

/* Returns an estimate of f2 + f3 + ... by one walk from a, connected to b at each flake. */
FN_NOINLINE float fibre_walk_more(FibreWalk m, Dir a, Dir b, uint64_t stream) {
    float s = m.alpha * m.alpha, sum = 0.0f;
    Dir t = flake_axis(m.tilt, m.azimuth);
    float nu_b = dir_dot(b, t), sigma_b = flake_sigma(s, nu_b);
    FibreWalker w = fibre_walk_fly(fibre_walk_start(a), s, t, &stream);
    while (fibre_walk_inside(w, m.density)) {
        w = fibre_walk_fly(fibre_walk_scatter(w, s, t, &stream), s, t, &stream);
        if (!fibre_walk_inside(w, m.density)) break;
        Dir h = dir(b.x - w.d.x, b.y - w.d.y, b.z - w.d.z);
        float phase = 0.25f * flake_d(s, dir_dot(h, h), nu_b - dir_dot(w.d, t)) / w.sigma;
        sum = sum + phase * exp(-sigma_b * w.depth / b.z) / b.z;
    }
    return sum;
}

/* Returns true if the walk starts at a and not at b: it starts where the slab looks thicker. Ties are broken
 * by an order of directions that is symmetric in a and b. */
FN bool fibre_walk_first(FibreWalk m, Dir a, Dir b) {
    float s = m.alpha * m.alpha;
    Dir t = flake_axis(m.tilt, m.azimuth);
    float k = flake_sigma(s, dir_dot(a, t)) * b.z, l = flake_sigma(s, dir_dot(b, t)) * a.z;
    if (k < l || k > l) return k > l;
    if (a.x < b.x || a.x > b.x) return a.x > b.x;
    return a.y < b.y || a.y > b.y ? a.y > b.y : a.z > b.z;
}

FN float fibre_walk_f(FibreWalk m, Angles a) {
    bool first = fibre_walk_first(m, a.o, a.i);
    Dir from = first ? a.o : a.i, to = first ? a.i : a.o;
    uint64_t stream = stream_start(fibre_walk_bits(from), fibre_walk_bits(to));
    return flake_single(m.alpha * m.alpha, flake_axis(m.tilt, m.azimuth), m.density, a.o, a.i) +
           fibre_walk_more(m, from, to, stream);
}

/* Returns E: the share of walks that leave upwards. All wo use the same random numbers, so E is smooth. */
FN_NOINLINE float fibre_walk_albedo(FibreWalk m, Dir o, int walks) {
    float s = m.alpha * m.alpha;
    Dir t = flake_axis(m.tilt, m.azimuth);
    int back = 0;
    for (int k = 0; k < walks; k++) {
        uint64_t stream = stream_start((uint64_t)k, 0u);
        FibreWalker w = fibre_walk_fly(fibre_walk_start(o), s, t, &stream);
        while (fibre_walk_inside(w, m.density)) w = fibre_walk_fly(fibre_walk_scatter(w, s, t, &stream), s, t, &stream);
        back += w.depth <= 0.0f ? 1 : 0;
    }
    return to_float(back) / to_float(walks);
}

/* Returns b, the width of the samples. A flake scatters light to about nu = -nu_o, within s, and multiple scattering is
 * spread by about the mu_o under which the light enters. With x = nu + nu_o, x / (b + |x|) is uniform from nu = -sin
 * tilt, the lowest above the horizon, to nu = 1. The share alpha of the samples is by the cosine and uniform. */
FN float fibre_walk_width(FibreWalk m, Dir o) { return max(o.z, m.alpha * m.alpha); }
FN float fibre_walk_place(float x, float b) { return x / (b + abs(x)); }

FN float fibre_walk_pdf(FibreWalk m, Angles a) {
    Dir t = flake_axis(m.tilt, m.azimuth);
    float nu_o = dir_dot(a.o, t), b = fibre_walk_width(m, a.o), c = b + abs(nu_o + dir_dot(a.i, t));
    float low = fibre_walk_place(nu_o - sin(m.tilt), b), high = fibre_walk_place(nu_o + 1.0f, b);
    return mix(0.5f / PI * b / (c * c * (high - low)), warp_uniform_cosine_pdf(0.5f, a.i), m.alpha);
}

FN LobeValue fibre_walk_value(const FibreWalkPrepared *p, const FibreWalkView *w, Angles a) {
    return lobe_value_of(fibre_walk_f(p->m, a), 0.0f, fibre_walk_pdf(p->m, a));
}

FN Dir fibre_walk_sample(const FibreWalkPrepared *p, const FibreWalkView *view, Dir o, float u, float v) {
    FibreWalk m = p->m;
    if (u < m.alpha) return warp_uniform_cosine(0.5f, u / m.alpha, v);
    Dir t = flake_axis(m.tilt, m.azimuth);
    float nu_o = dir_dot(o, t), b = fibre_walk_width(m, o);
    float low = fibre_walk_place(nu_o - sin(m.tilt), b), high = fibre_walk_place(nu_o + 1.0f, b);
    float place = mix(low, high, (u - m.alpha) / (1.0f - m.alpha));
    float nu = clamp(b * place / (1.0f - abs(place)) - nu_o, -1.0f, 1.0f);
    float r = sqrt(max(1.0f - nu * nu, 0.0f)), x = r * cos(2.0f * PI * v), y = r * sin(2.0f * PI * v);
    float c = cos(m.azimuth), k = sin(m.azimuth), along = nu * sin(m.tilt) + x * cos(m.tilt);
    return dir(along * c - y * k, along * k + y * c, nu * cos(m.tilt) - x * sin(m.tilt));
}
