/* lobe_value.h - the value of a lobe for a pair of directions, and its product with the lobe's colours */
#pragma once

#include "shading/dialect/angles.h"
#include "shading/dialect/tint.h"
#include "shading/lobe/fresnel_weight.h"

STRUCT(LobeValue) {
    float f;   /* 1/sr, of the white lobe */
    float s;   /* share of the second colour, or a cosine (fresnel_weight.h); 0 without TRAIT_TWO_COLORS */
    float pdf; /* density of lobe_sample at a.i, 1/sr */
    Tint tint; /* tint_none without TRAIT_TINTED */
};

FN LobeValue lobe_value_of(float f, float s, float pdf) {
    LobeValue v;
    v.f = f;
    v.s = s;
    v.pdf = pdf;
    v.tint = tint_none();
    return v;
}

/* Returns the factor of f in one channel. second is the colour of lobe_second times the weight of the first.
 * With a tinted lobe second is the weight, and first / second the albedo of its flakes. */
FN float lobe_color(LobeValue v, float first, float second) {
    if (IS_TINTED(v.tint)) return second * tint_color(v.tint, first / max(second, 1e-30f));
    return fresnel_weight_mix(v.s, first, second);
}

/* A value in three channels of two colours. */
STRUCT(LobeReflected) {
    Rgb f;      /* 1/sr, in these colours */
    float pdf;  /* 1/sr */
    float f_s2; /* f of the white lobe times s (1 - s) */
};
FN LobeReflected lobe_reflected(LobeValue v, Rgb f0, Rgb f90) {
    LobeReflected x;
    float s = fresnel_weight_uncolored(v.s);
    x.f.r = v.f * lobe_color(v, f0.r, f90.r);
    x.f.g = v.f * lobe_color(v, f0.g, f90.g);
    x.f.b = v.f * lobe_color(v, f0.b, f90.b);
    x.pdf = v.pdf;
    x.f_s2 = v.f * s * (1.0f - s);
    return x;
}

/* Works as lobe_reflected, for a lobe of one colour. */
FN LobeReflected lobe_reflected_single(LobeValue v, Rgb color) {
    LobeReflected x;
    x.f.r = v.f * color.r;
    x.f.g = v.f * color.g;
    x.f.b = v.f * color.b;
    x.pdf = v.pdf;
    x.f_s2 = 0.0f;
    return x;
}
