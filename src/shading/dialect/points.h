/* points.h - Owen-scrambled Sobol points, padded two dimensions at a time
 *
 * In each pair of dimensions, the points of a pixel are the (0, 2)-sequence of Sobol', its order shuffled and its
 * digits scrambled by keys made from pixel, seed and pair. A value is a function of its key: it depends neither on
 * threads nor on order, and loops over many of them are loops of vectors.
 *
 *   I. M. Sobol', "On the distribution of points in a cube and the approximate evaluation of integrals",
 * 1967. Brent Burley, "Practical Hash-based Owen Scrambling", JCGT 9(4), 2020. */
#pragma once

#include "shading/dialect/lang.h"

STRUCT(Point) { float u, v; /* in [0, 1) */ };

/* Mixes 32 bits by a bijection with low bias: the two-round "lowbias32" of Chris Wellons, "Hash Prospector", 2018. */
FN uint point_hash(uint x) {
    uint y = (x ^ (x >> 16u)) * 0x7feb352du;
    y = (y ^ (y >> 15u)) * 0x846ca68bu;
    return y ^ (y >> 16u);
}

FN uint point_hash_two(uint a, uint b) { return point_hash(a ^ (b * 0x9e3779b9u + 0x85ebca6bu)); }

/* Returns 24 bits of x as a float in [0, 1). */
FN float point_fraction(uint x) { return to_float(to_int(x >> 8u)) * (1.0f / 16777216.0f); }

FN uint reverse_bits(uint x) {
    uint y = (x >> 16u) | (x << 16u);
    y = ((y >> 8u) & 0x00ff00ffu) | ((y & 0x00ff00ffu) << 8u);
    y = ((y >> 4u) & 0x0f0f0f0fu) | ((y & 0x0f0f0f0fu) << 4u);
    y = ((y >> 2u) & 0x33333333u) | ((y & 0x33333333u) << 2u);
    return ((y >> 1u) & 0x55555555u) | ((y & 0x55555555u) << 1u);
}

/* Applies a nested uniform scramble to digits stored lowest first: each bit is flipped by a hash of the bits below it.
 * Samuli Laine, Tero Karras, "Stratified Sampling for Stochastic Transparency", EGSR 2011, with the constants of Nathan
 * Vegdahl, "Building a Better LK Hash", 2021. */
FN uint owen_scramble(uint x, uint key) {
    uint y = x ^ (x * 0x3d20adeau);
    y = y + key;
    y = y * ((key >> 16u) | 1u);
    y = y ^ (y * 0x05526c56u);
    return y ^ (y * 0x53a22864u);
}

/* Multiplies by the generator matrix of the second dimension: Pascal's triangle modulo 2, the fivefold Kronecker power
 * of [1 1; 0 1], one step a level. */
FN uint pascal_bits(uint i) {
    uint j = i ^ ((i >> 1u) & 0x55555555u);
    j = j ^ ((j >> 2u) & 0x33333333u);
    j = j ^ ((j >> 4u) & 0x0f0f0f0fu);
    j = j ^ ((j >> 8u) & 0x00ff00ffu);
    return j ^ (j >> 16u);
}

/* Returns the key of a pixel, which all of its samples share. */
FN uint sampler_key(uint x, uint y, uint seed) { return point_hash_two(point_hash_two(point_hash(seed), x), y); }

/* Returns the index of a sample of a pixel: its number with reversed bits. */
FN uint sampler_index(uint number) { return reverse_bits(number); }

/* Returns the point in a pair of dimensions. Each pair has its own order, and its own scramble of either coordinate. */
FN Point sampler_point(uint key, uint index, uint pair) {
    uint own = point_hash(key + 0x9e3779b9u * (pair + 1u)), i = reverse_bits(owen_scramble(index, own));
    uint scramble = own * 0x2c1b3c6du;
    Point p;
    p.u = point_fraction(reverse_bits(owen_scramble(i, scramble + 0x297a2d39u)));
    p.v = point_fraction(reverse_bits(owen_scramble(pascal_bits(i), scramble + 0x7feb352du)));
    return p;
}
