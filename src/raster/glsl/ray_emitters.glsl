/* ray_emitters.glsl - points of emissive triangles, chosen by their power (raster/light/ray_emitters.h) */
#include "raster/glsl/rays.glsl"

/* A direction towards a emitter from a point, the radiance from there, the density with which it is drawn, 1/sr, and the
 * distance of the emitter; density 0: no sample. */
struct EmitterPoint {
    vec3 wi, radiance;
    float pdf, distance;
};

vec4 emitter_texel(int emitter, int k) { return ray_texel(int(ray_first.w) + 4 * emitter + k); }

/* Returns the emitter that u in [0, 1) chooses. */
int emitter_find(float u) {
    int low = 0, high = int(ray_count.x) - 1;
    while (low < high) {
        int middle = (low + high) / 2;
        bool right = emitter_texel(middle, 0).w <= u;
        low = right ? middle + 1 : low;
        high = right ? high : middle;
    }
    return low;
}

/* Returns the density over solid angle with which a point of a emitter is drawn. */
float emitter_pdf(float probability, float area, float t, float cosine) {
    return probability * t * t / (area * max(abs(cosine), 1e-6));
}

/* Draws a point of a emitter, as emitters.c of the path tracer does. */
EmitterPoint emitter_sample(vec3 here, float u, float v) {
    int emitter = emitter_find(u);
    vec4 a = emitter_texel(emitter, 0), ab = emitter_texel(emitter, 1), ac = emitter_texel(emitter, 2), light = emitter_texel(emitter, 3);
    float before = a.w - light.w, part = clamp((u - before) / max(light.w, 1e-20), 0.0, 0.99999994);
    float half_least = 0.5 * min(part, v);
    vec3 to = a.xyz + (part - half_least) * ab.xyz + (v - half_least) * ac.xyz - here;
    float t2 = dot(to, to), t = sqrt(max(t2, 1e-30));
    vec3 wi = to / t, normal = cross(ab.xyz, ac.xyz);
    float cosine = -dot(wi, normal) * inversesqrt(max(dot(normal, normal), 1e-30));
    bool live = t2 > 1e-30 && (cosine > 0.0 || ab.w > 0.5);
    return EmitterPoint(wi, light.rgb, live ? emitter_pdf(light.w, ac.w, t, cosine) : 0.0, t);
}
