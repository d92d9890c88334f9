/* rays.glsl - rays against the scene's triangles, which raster/light/ray_scene.h has put into a texture
 *
 * Triangles are met as by Tomas Moeller and Ben Trumbore, "Fast, Minimum Storage Ray/Triangle Intersection", Journal of
 * Graphics Tools 2(1), 1997. */
#include "raster/glsl/picture.glsl"
#include "shading/dialect/points.h"
#include "shading/terms/f_schlick.h"

uniform highp sampler2D ray_texels;
uniform highp sampler2DArray ray_masks; /* raster/light/ray_masks.h */

/* Returns a texel of the texture, RAY_ROW a row. */
vec4 ray_texel(int k) { return texelFetch(ray_texels, ivec2(k & 2047, k >> 11), 0); }

struct Ray {
    vec3 origin, direction; /* unit */
    float near, far;        /* distances between which hits count */
};

struct RayHit {
    float t;      /* distance */
    int triangle; /* below 0: none */
    float u, v;   /* weights of the second and third corner */
    vec3 through; /* what panes before it let through */
};

/* The corners of a triangle, and the last numbers of its texels. */
struct RayTriangle {
    vec3 a, b, c;
    float surface, emitter, mask;
};

RayTriangle ray_triangle(int k) {
    int at = int(ray_first.y) + 3 * k;
    vec4 a = ray_texel(at), b = ray_texel(at + 1), c = ray_texel(at + 2);
    return RayTriangle(a.xyz, b.xyz, c.xyz, a.w, b.w, c.w);
}

vec3 ray_normal(int triangle, int corner) { return ray_texel(int(ray_first.z) + 3 * triangle + corner).xyz; }

/* Returns the hit of the plane of a triangle, with t below 0 if it is beside the triangle. */
RayHit ray_meet(Ray r, RayTriangle p) {
    vec3 ab = p.b - p.a, ac = p.c - p.a, h = cross(r.direction, ac), s = r.origin - p.a, q = cross(s, ab);
    float det = dot(ab, h), inverse = 1.0 / (det == 0.0 ? 1.0 : det);
    float u = dot(s, h) * inverse, v = dot(r.direction, q) * inverse, t = dot(ac, q) * inverse;
    bool beside = det == 0.0 || u < 0.0 || v < 0.0 || u + v > 1.0;
    return RayHit(beside ? -1.0 : t, -1, u, v, vec3(1.0));
}

/* Wraps a coordinate: 0 repeats, 1 mirrors, 2 clamps. The last two end half a texel from the edges, past which the array
 * of masks repeats. */
float ray_wrap(float x, float how) {
    float mirrored = 1.0 - abs(fract(0.5 * x) * 2.0 - 1.0), edge = 0.5 / float(textureSize(ray_masks, 0).x);
    return how > 0.5 ? clamp(how > 1.5 ? x : mirrored, edge, 1.0 - edge) : x;
}

/* Returns the opacity of mask k at a hit. */
float ray_opacity(int k, RayHit hit) {
    int at = int(ray_count.z) + 3 * k;
    vec4 p = ray_texel(at), q = ray_texel(at + 1), r = ray_texel(at + 2);
    float w = 1.0 - hit.u - hit.v, wraps = floor(r.w / 64.0);
    vec2 uv = w * p.xy + hit.u * p.zw + hit.v * q.xy;
    uv.x = ray_wrap(uv.x, mod(wraps, 3.0));
    uv.y = ray_wrap(uv.y, floor(wraps / 3.0));
    float alpha = w * q.z + hit.u * q.w + hit.v * r.x;
    float opacity = textureLod(ray_masks, vec3(uv, mod(r.w, 64.0)), 0.0).r * r.y * alpha;
    return r.z < 0.0 ? opacity : opacity < r.z ? 0.0 : 1.0;
}

/* Returns true if the ray meets a triangle from a side that it has, at a point that is not transparent: a random number
 * that depends on the ray and the triangle decides partial opacity. */
bool ray_counts(Ray r, RayTriangle p, RayHit hit, int triangle, uint key) {
    bool single = p.surface >= 4.0;
    float opacity = single ? p.surface - 4.0 : p.surface;
    if (p.mask > 0.5) opacity = ray_opacity(int(p.mask) - 1, hit);
    if (single && dot(cross(p.b - p.a, p.c - p.a), r.direction) > 0.0) return false;
    return opacity >= 1.0 || point_fraction(point_hash_two(key, uint(triangle))) < opacity;
}

#ifdef PANES
/* Returns what a pane lets through along a ray (raster/light/ray_panes.h). */
vec3 ray_pane(Ray r, RayTriangle p) {
    int at = int(-p.emitter);
    vec3 n = cross(p.b - p.a, p.c - p.a);
    float cosine = abs(dot(n, r.direction)) * inversesqrt(max(dot(n, n), 1e-30));
    return mix(ray_texel(at).rgb, ray_texel(at + 1).rgb, schlick_s(cosine));
}
#endif

/* Returns the nearest hit, or if `any` the first one that is found. Rays pass panes; those before the nearest hit are
 * found in a second walk, if there are any. near_to: the distance to which hits are to be near, or 0; all triangles count
 * if it is more. */
RayHit ray_trace(Ray r, bool any, float near_to, uint key) {
    vec3 safe = mix(r.direction, vec3(1e-20), lessThan(abs(r.direction), vec3(1e-20)));
    vec3 inverse = 1.0 / safe;
    int node = 0, count = int(ray_first.x);
    RayHit found = RayHit(r.far, -1, 0.0, 0.0, vec3(1.0));
    float near = r.near, far = r.far;
#ifdef PANES
    bool panes = false, again = any;
#endif
    while (node < count) {
        vec4 low = ray_texel(2 * node), high = ray_texel(2 * node + 1);
        vec3 x = (low.xyz - r.origin) * inverse, y = (high.xyz - r.origin) * inverse;
        vec3 least = min(x, y), most = max(x, y);
        float enter = max(max(least.x, least.y), max(least.z, near));
        float leave = min(min(most.x, most.y), min(most.z, far));
        bool inside = enter <= leave * 1.0000004;
        bool leaf = high.w >= 0.0;
        int first = int(high.w), end = inside && leaf ? first + int(low.w) : first;
        for (int k = first; k < end; k++) {
            RayTriangle p = ray_triangle(k);
            RayHit hit = ray_meet(r, p);
            if (hit.t < near || hit.t > far) continue;
            if (near_to == 0.0 && !ray_counts(r, p, hit, k, key)) continue;
#ifdef PANES
            bool pane = p.emitter < -0.5 && near_to == 0.0;
            panes = panes || pane;
            if (pane && again) found.through *= ray_pane(r, p);
            if (pane || (again && !any)) continue;
#endif
            found = RayHit(hit.t, k, hit.u, hit.v, found.through);
            float off = abs(hit.t - near_to);
            far = near_to > 0.0 ? near_to + off : hit.t;
            near = near_to > 0.0 ? near_to - off : near;
        }
        node = inside || leaf ? node + 1 : int(low.w);
        if (any && found.triangle >= 0) node = count;
#ifdef PANES
        bool repeats = node >= count && panes && !again;
        again = again || repeats;
        node = repeats ? 0 : node;
#endif
    }
    return found;
}
