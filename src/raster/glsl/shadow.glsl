/* shadow.glsl - the fraction of a punctual light that reaches a point, by its shadow map */
#include "raster/glsl/picture.glsl"

uniform highp sampler2DArrayShadow shadow_map;

/* Returns a vector from a light in the frame of the face of a cube that it meets, which looks along z, and in w the
 * number of the face (raster/light/shadow.h). */
vec4 shadow_face(vec3 p) {
    vec3 a = abs(p);
    float axis = a.x >= max(a.y, a.z) ? 0.0 : a.y >= a.z ? 1.0 : 2.0;
    vec3 w = axis < 0.5 ? p.yzx : axis < 1.5 ? p.zxy : p;
    float side = w.z < 0.0 ? -1.0 : 1.0;
    return vec4(side * w.x, w.y, side * w.z, 2.0 * axis + (0.5 - 0.5 * side));
}

/* Returns the mean of four comparisons on a rotated square, each itself a mean of four texels. The point is moved out
 * along its normal, further for grazing light, so that a surface does not shade itself: Daniel Holbert, "Normal Offset
 * Shadows", GDC 2011. */
float shadow_light(int map, vec3 place, vec3 normal, float cosine) {
    vec3 p = eye.xyz + place - shadow_eye[map].xyz;
    float texel = shadow_eye[map].w;
    bool amid = shadow_soft[map].z > 0.5;
    vec3 from = p;
    if (amid) from = shadow_face(p).xyz;
    if (texel < 0.0) texel = -texel * (shadow_clip[map] * vec4(from, 1.0)).w;
    p = p + normal * (texel * (1.0 + 2.5 * sqrt(max(1.0 - cosine * cosine, 0.0))));
    float face = 0.0;
    if (amid) {
        vec4 met = shadow_face(p);
        p = met.xyz;
        face = met.w;
    }
    vec4 clip = shadow_clip[map] * vec4(p, 1.0);
    vec3 at = 0.5 + 0.5 * clip.xyz / clip.w;
    if (clip.w <= 0.0 || abs(at.x - 0.5) > 0.5 || abs(at.y - 0.5) > 0.5) return 1.0;
    at.z = min(at.z, 1.0); /* a point beyond the map's depths */
    if (amid) at.xy = (at.xy + vec2(mod(face, 3.0), floor(face / 3.0))) * shadow_soft[map].w;
    float step = 1.0 / 2048.0, layer = float(map), sum = 0.0;
    sum += texture(shadow_map, vec4(at.x - 0.4 * step, at.y - 1.1 * step, layer, at.z));
    sum += texture(shadow_map, vec4(at.x + 1.1 * step, at.y - 0.4 * step, layer, at.z));
    sum += texture(shadow_map, vec4(at.x + 0.4 * step, at.y + 1.1 * step, layer, at.z));
    sum += texture(shadow_map, vec4(at.x - 1.1 * step, at.y + 0.4 * step, layer, at.z));
    return 0.25 * sum;
}
