/* lamps.glsl - points of emissive triangles, chosen by their power (raster/light/lamps.h) */
#include "raster/glsl/rays.glsl"

/* A direction towards a lamp from a point, the radiance from there, the density with which it is drawn, 1/sr, and the
 * distance of the lamp; density 0: no sample. */
struct LampPoint {
    vec3 wi, radiance;
    float pdf, distance;
};

vec4 lamp_texel(int lamp, int k) { return ray_texel(int(ray_first.w) + 4 * lamp + k); }

/* Returns the lamp that u in [0, 1) chooses. */
int lamp_find(float u) {
    int low = 0, high = int(ray_count.x) - 1;
    while (low < high) {
        int middle = (low + high) / 2;
        bool right = lamp_texel(middle, 0).w <= u;
        low = right ? middle + 1 : low;
        high = right ? high : middle;
    }
    return low;
}

/* Returns the density over solid angle with which a point of a lamp is drawn. */
float lamp_pdf(float probability, float area, float t, float cosine) {
    return probability * t * t / (area * max(abs(cosine), 1e-6));
}

/* Draws a point of a lamp, as emitters.c of the path tracer does. */
LampPoint lamp_sample(vec3 here, float u, float v) {
    int lamp = lamp_find(u);
    vec4 a = lamp_texel(lamp, 0), ab = lamp_texel(lamp, 1), ac = lamp_texel(lamp, 2), light = lamp_texel(lamp, 3);
    float before = a.w - light.w, part = clamp((u - before) / max(light.w, 1e-20), 0.0, 0.99999994);
    float half_least = 0.5 * min(part, v);
    vec3 to = a.xyz + (part - half_least) * ab.xyz + (v - half_least) * ac.xyz - here;
    float t2 = dot(to, to), t = sqrt(max(t2, 1e-30));
    vec3 wi = to / t, normal = cross(ab.xyz, ac.xyz);
    float cosine = -dot(wi, normal) * inversesqrt(max(dot(normal, normal), 1e-38));
    bool live = t2 > 1e-30 && (cosine > 0.0 || ab.w > 0.5);
    return LampPoint(wi, light.rgb, live ? lamp_pdf(light.w, ac.w, t, cosine) : 0.0, t);
}
