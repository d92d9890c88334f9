/* dust - dust accumulated on a surface: most where it faces up, none below, in patches
 *
 *   lies  = max(n . d, 0)^falloff (1 - noise + noise N(p)),  dust lies,  sheen mix(1, lies, sheen_upward)
 *   d     = (sin(tilt) cos(direction), cos(tilt), sin(tilt) sin(direction))
 *
 *   n is the shading normal and p the point in the world, whose +y is up. What falls along -d meets a surface
 * by the cosine, as light does (Johann Heinrich Lambert, "Photometria", 1760): falloff 1 is dust that stays
 * where it fell, more is dust that slides off slopes. Occlusion is ignored: below an overhang, what faces up is
 * dusty too.
 *   N is noise between 0 and 1 whose largest patches are `scale` metres apart. It repeats after 289 of them
 * and is fixed to the world, so that things which move change their patches.
 *
 *   What lies there is a layer over the whole stack, coat and all (compose.h, dust_lobe.h). */
#pragma once

#include "shading/stack/surface.h"

/* The lobe of a slab of it (dust_lobe.h). */
#define DUST_LOBE LOBE_LTC_FIBRE

/* Less dust than this is invisible: it counts as none and gets no samples. */
#define DUST_LEAST 1e-5f

/* Returns x mod 289 of a whole number, |x| < 2^22. It is exact in floats on every machine: the 1/2 that is added is
 * more than the rounding of the product. */
FN float dust_mod(float x) { return x - floor((x + 0.5f) * 0.00346020761f) * 289.0f; }

/* Works as dust_mod, for a sum of two numbers below 289. */
FN float dust_sum(float a, float b) { return a + b < 289.0f ? a + b : a + b - 289.0f; }

/* Returns a permutation of 0 .. 288: 34 x^2 + 10 x mod 17^2. Ian McEwan, David Sheets, Mark Richardson, Stefan
 * Gustavson, "Efficient Computational Noise in GLSL", Journal of Graphics Tools 16(2), 2012. */
FN float dust_hash(float x) { return dust_mod((34.0f * x + 10.0f) * x); }

/* Interpolates between lattice points of one line; dust_plane does so for one plane. h: the hash of the coordinates
 * that are hashed already. */
FN float dust_line(float h, Dir a, Dir b, Dir t) {
    return mix(dust_hash(dust_sum(h, a.z)), dust_hash(dust_sum(h, b.z)), t.z);
}
FN float dust_plane(float h, Dir a, Dir b, Dir t) {
    return mix(dust_line(dust_hash(dust_sum(h, a.y)), a, b, t), dust_line(dust_hash(dust_sum(h, b.y)), a, b, t), t.y);
}

FN float dust_ease(float t) { return t * t * (3.0f - 2.0f * t); }

/* Returns noise, 0 to 1: a random number at each whole point of space, interpolated smoothly. */
FN float dust_octave(Dir p) {
    float most = 2097152.0f; /* 2^21: floats of this size have few fractions left */
    float x = clamp(p.x, -most, most), y = clamp(p.y, -most, most), z = clamp(p.z, -most, most);
    float i = floor(x), j = floor(y), k = floor(z);
    Dir a = dir(dust_mod(i), dust_mod(j), dust_mod(k));
    Dir b = dir(dust_sum(a.x, 1.0f), dust_sum(a.y, 1.0f), dust_sum(a.z, 1.0f));
    Dir t = dir(dust_ease(x - i), dust_ease(y - j), dust_ease(z - k));
    return mix(dust_plane(dust_hash(a.x), a, b, t), dust_plane(dust_hash(b.x), a, b, t), t.x) / 288.0f;
}

/* Returns three octaves of noise, rotated so that no table or wall is parallel to the lattice, with the middle of their
 * range stretched to [0, 1]. */
FN float dust_noise(Dir p, float scale) {
    float k = 1.0f / max(3.0f * scale, 1e-6f); /* a texture may make scale 0 */
    Dir q = dir((2.0f * p.x - p.y + 2.0f * p.z) * k, (2.0f * p.x + 2.0f * p.y - p.z) * k,
                (2.0f * p.y - p.x + 2.0f * p.z) * k);
    float n = 4.0f * dust_octave(q) +
              2.0f * dust_octave(dir(2.0f * q.x + 31.5f, 2.0f * q.y + 7.25f, 2.0f * q.z + 19.75f)) +
              dust_octave(dir(4.0f * q.x + 73.25f, 4.0f * q.y + 11.5f, 4.0f * q.z + 47.75f));
    return clamp(2.0f * n / 7.0f - 0.5f, 0.0f, 1.0f);
}

/* Returns the part of what falls that lies there. */
FN float dust_lies(float cosine, float falloff, float mask) {
    return cosine > 0.0f ? mask * pow(min(max(cosine, 1e-6f), 1.0f), falloff) : 0.0f;
}

/* Returns the direction from which dust falls, in the world. */
FN Dir dust_source(Surface s) {
    float across = sin(s.dust_tilt);
    return dir(across * s.dust_direction.x, cos(s.dust_tilt), across * s.dust_direction.y);
}

/* Tests whether the surface depends on where it faces. */
FN bool dust_settles(Surface s) { return s.dust > 0.0f || s.sheen_upward > 0.0f; }

/* Returns the surface at a point p of the world, metres, with the world's shading normal n there: its dust and its sheen
 * become the amounts at this point. Both renderers call this before they make the stack. */
FN Surface dust_accumulate(Surface s, Dir n, Dir p) {
    if (!dust_settles(s)) return s;
    Surface t = s;
    float mask = 1.0f;
    if (s.dust_noise > 0.0f) mask = 1.0f - s.dust_noise + s.dust_noise * dust_noise(p, s.dust_scale);
    float lies = dust_lies(dir_dot(n, dust_source(s)), s.dust_falloff, mask);
    t.dust = s.dust * lies;
    t.sheen = s.sheen * mix(1.0f, lies, s.sheen_upward);
    return t;
}
