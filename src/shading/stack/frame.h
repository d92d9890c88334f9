/* frame.h - the shading frame at a point: about a normal that the viewer can see, x along the tangent
 *
 * Directions are in world space; frame_to returns them in the shading frame. */
#pragma once

#include "shading/stack/surface.h"

STRUCT(Frame) { Dir x, y, z; };

FN Dir dir_scale(Dir a, float k) { return dir(a.x * k, a.y * k, a.z * k); }
FN Dir dir_add(Dir a, Dir b) { return dir(a.x + b.x, a.y + b.y, a.z + b.z); }

FN Dir dir_choose(bool first, Dir a, Dir b) { return dir(first ? a.x : b.x, first ? a.y : b.y, first ? a.z : b.z); }

/* Returns a / |a|, or fallback if a has no direction. */
FN Dir dir_normal_or(Dir a, Dir fallback) {
    float s = dir_dot(a, a);
    bool any = s > 1e-30f && s < 1e30f;
    float r = 1.0f / sqrt(any ? s : 1.0f);
    return dir(any ? a.x * r : fallback.x, any ? a.y * r : fallback.y, any ? a.z * r : fallback.z);
}

FN Dir frame_to(Frame f, Dir w) { return dir(dir_dot(w, f.x), dir_dot(w, f.y), dir_dot(w, f.z)); }
FN Dir frame_from(Frame f, Dir w) {
    return dir(f.x.x * w.x + f.y.x * w.y + f.z.x * w.z, f.x.y * w.x + f.y.y * w.y + f.z.y * w.z,
               f.x.z * w.x + f.y.z * w.y + f.z.z * w.z);
}

/* Returns a frame about n with x along `tangent`, or along any direction if the tangent has none across n. Without a
 * tangent: Tom Duff et al., "Building an Orthonormal Basis, Revisited", JCGT 6(1), 2017. */
FN Frame frame_about(Dir n, Dir tangent, float handedness) {
    float sign = n.z < 0.0f ? -1.0f : 1.0f, a = -1.0f / (sign + n.z), b = n.x * n.y * a;
    Dir any = dir(1.0f + sign * n.x * n.x * a, sign * b, -sign * n.x);
    Frame f;
    f.z = n;
    f.x = dir_normal_or(dir_add(tangent, dir_scale(n, -dir_dot(tangent, n))), any);
    f.y = dir_scale(dir_cross(f.z, f.x), handedness < 0.0f ? -1.0f : 1.0f);
    return f;
}

/* Returns the frame rotated about z by the angle whose cosine and sine are c and s, from x towards y. */
FN Frame frame_rotate(Frame f, float c, float s) {
    Frame r;
    r.x = dir_add(dir_scale(f.x, c), dir_scale(f.y, s));
    r.y = dir_add(dir_scale(f.y, c), dir_scale(f.x, -s));
    r.z = f.z;
    return r;
}

/* Returns the normal nearest to n for which the mirror direction of wo is not below the surface; otherwise a normal map
 * would show black where it should reflect. Alexander Keller et al., "The Iray Light Transport Simulation and Rendering
 * System", 2017, A.3. */
FN Dir frame_reflecting_normal(Dir n, Dir geometric, Dir wo) {
    float cosine = dir_dot(wo, n);
    Dir mirror = dir_add(dir_scale(n, 2.0f * cosine), dir_scale(wo, -1.0f));
    float least = 0.05f * max(dir_dot(wo, geometric), 0.0f) + 1e-4f, below = dir_dot(mirror, geometric);
    Dir up = dir_normal_or(dir_add(mirror, dir_scale(geometric, max(least - below, 0.0f))), geometric);
    Dir m = dir_normal_or(dir_add(wo, up), geometric);
    m = dir_choose(dir_dot(wo, m) > 1e-4f, m, geometric);
    return dir_choose(cosine > 1e-4f && below >= least, n, m);
}

/* The surface at a hit or fragment, seen from the side of the viewer. */
STRUCT(Facing) {
    Dir geometric;    /* unit, towards the viewer */
    Dir normal;       /* unit, interpolated */
    Dir tangent;      /* of any length, 0 where there is none */
    float handedness; /* of the bitangent: n x t times this */
};

/* Returns the normal nearest to n that the viewer sees, at a cosine of at least about 1e-4: a mesh may have normals
 * that are smoother than its shape. */
FN Dir frame_visible_normal(Dir n, Dir wo) {
    float away = max(1e-4f - dir_dot(n, wo), 0.0f);
    Dir m = dir_add(n, dir_scale(wo, away));
    return dir_scale(m, 1.0f / sqrt(dir_dot(m, m)));
}

/* Returns the interpolated normal, or the geometric one if the interpolated one is damaged. */
FN Dir facing_normal(Facing at) { return dir_choose(dir_dot(at.normal, at.geometric) > 0.0f, at.normal, at.geometric); }

/* Returns the frame of a surface viewed from wo, with x along the direction of its anisotropy if it has one. */
FN Frame frame_of(Facing at, Surface s, Dir wo) {
    Dir normal = facing_normal(at), n = normal;
    if (s.normal.z < 1.0f)
        n = frame_reflecting_normal(frame_from(frame_about(normal, at.tangent, at.handedness), s.normal), at.geometric,
                                    wo);
    Frame f = frame_about(frame_visible_normal(n, wo), at.tangent, at.handedness);
    if (s.anisotropy > 0.0f) f = frame_about(f.z, frame_from(f, s.anisotropy_direction), at.handedness);
    return f;
}

/* Returns the surface with directions relative to x of its frame instead of the tangent. */
FN Surface frame_surface(Surface s) {
    if (s.anisotropy > 0.0f) {
        Dir a = s.anisotropy_direction, b = s.nap_direction, c = s.coat_anisotropy_direction;
        s.nap_direction = dir(a.x * b.x + a.y * b.y, a.x * b.y - a.y * b.x, 0.0f);
        s.coat_anisotropy_direction = dir(a.x * c.x + a.y * c.y, a.x * c.y - a.y * c.x, 0.0f);
    }
    return s;
}
