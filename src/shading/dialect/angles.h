/* angles.h - the conventions, and a pair of directions as a lobe sees it
 *
 * Local frame: +z is the shading normal, x the tangent, y the bitangent. wo points to the viewer, wi to the
 * light, both away from the surface, unit length. f is in 1/sr and excludes the cosine; its 1/pi is inside.
 * pdf is over solid angle, 1/sr; pdf == 0 means no sample. E(cos_o) is the directional albedo, the integral
 * of f cos_i over wi. Angles are radians inside, degrees at the command line. Colours are linear Rec. 709. */
#pragma once

#include "shading/dialect/lang.h"

STRUCT(Dir) { float x, y, z; };
STRUCT(Rgb) { float r, g, b; };

/* The values that a lobe may read. Those that it does not read cost nothing after inlining. */
STRUCT(Angles) {
    Dir o, i;     /* wo, wi: z is the cosine to the normal */
    Dir h;        /* half vector, unit */
    float d;      /* wi . h = wo . h */
    float sin2_h; /* sin^2 from the normal to h: 1 - h.z^2 has no digits left where this is small */
};

FN Dir dir(float x, float y, float z) {
    Dir v;
    v.x = x;
    v.y = y;
    v.z = z;
    return v;
}

FN float dir_dot(Dir a, Dir b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
FN Dir dir_cross(Dir a, Dir b) { return dir(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x); }

/* Returns the angles between two directions above the horizon. If these graze from opposite sides, their sum cancels:
 * the floor on z keeps h a unit vector (the normal in the worst case) and d above 0. */
FN Angles angles_between(Dir o, Dir i) {
    Angles a;
    a.o = o;
    a.i = i;
    float x = o.x + i.x, y = o.y + i.y, z = max(o.z + i.z, 1e-12f);
    float t2 = x * x + y * y, s2 = t2 + z * z, s = sqrt(s2), r = 1.0f / s;
    a.h = dir(x * r, y * r, z * r);
    a.d = 0.5f * s;
    a.sin2_h = t2 / s2;
    return a;
}

/* Returns w turned about the normal by half a turn, the mirror direction of w. */
FN Dir dir_opposite(Dir w) { return dir(-w.x, -w.y, w.z); }

/* Returns wo mirrored about the unit half vector h. */
FN Dir dir_mirror(Dir o, Dir h) {
    float d = 2.0f * dir_dot(o, h);
    return dir(d * h.x - o.x, d * h.y - o.y, d * h.z - o.z);
}
