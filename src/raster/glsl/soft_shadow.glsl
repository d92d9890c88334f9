/* soft_shadow.glsl - the fraction of a polygon's light that reaches a point
 *
 * It is the mean visibility of points on the polygon, weighted by the light that they send, w = (n.d) (l.d) / |d|^4,
 * with d from here to the point and the normals n here and l there. The light without shadows is multiplied by it. Eric
 * Heitz, Stephen Hill and Morgan McGuire, "Combining Analytic Direct Illumination and Stochastic Shadows", I3D 2018.
 *
 * While the camera moves, the pixels of a square share every other point, each a part of them, and coarse_filter.glsl takes
 * the mean: Alexander Keller, Wolfgang Heidrich, "Interleaved Sampling", Rendering Techniques 2001. */
#include "raster/glsl/picture.glsl"

uniform highp sampler2DArrayShadow soft_map;

/* Returns the fraction by map `map`. Axes are those of the light's view. With all x and y divided by half the width of
 * the map at distance 1, h, a point o of the light sees q at ((q - o).xy / (q - o).z + o.xy / (d - o.z)), d the
 * distance of the plane that all maps have at the same place; the depth in clip space is a + b / (q - o).z, stored in
 * steps of 1 / 65535. */
float soft_shadow(int map, vec3 place, vec3 normal, vec3 light_normal) {
    float h = shadow_soft[map].x;
    mat4 m = shadow_clip[map];
    vec3 x = vec3(m[0].x, m[1].x, m[2].x), y = vec3(m[0].y, m[1].y, m[2].y), z = vec3(m[0].w, m[1].w, m[2].w);
    vec3 p = eye.xyz + place - shadow_eye[map].xyz;
    float cosine = dot(normal, p) * inversesqrt(max(dot(p, p), 1e-12));
    p += normal * (-shadow_eye[map].w * dot(z, p) * (0.5 + 1.5 * sqrt(max(1.0 - cosine * cosine, 0.0))));
    vec3 q = vec3(dot(x, p), dot(y, p), dot(z, p)), scale = vec3(h * h, h * h, 1.0);
    vec3 n = scale * vec3(dot(x, normal), dot(y, normal), dot(z, normal));
    vec3 l = scale * vec3(dot(x, light_normal), dot(y, light_normal), dot(z, light_normal));
    float a = dot(vec3(m[0].z, m[1].z, m[2].z), z), b = m[3].z, sum = 0.0, all = 0.0;
    int side = int(coarse.x), every = int(coarse.w);
    int first = int(gl_FragCoord.x) % side + side * (int(gl_FragCoord.y) % side);
    for (int k = every * first; k < SHADOW_POINTS; k += every * side * side) {
        vec4 o = shadow_points[SHADOW_POINTS * map + k];
        vec3 to = o.xyz - q;
        float d2 = dot(scale * to, to), weight = max(dot(n, to), 0.0) * abs(dot(l, to)) / max(d2 * d2, 1e-24);
        vec2 at = to.xy / to.z + o.xy * o.w;
        vec4 place = vec4(0.5 + 0.5 * at, shadow_soft[map].y + float(k), 0.5 + 0.5 * (a - b / to.z) - 1.0 / 65535.0);
        bool outside = weight <= 0.0 || to.z >= 0.0 || max(abs(at.x), abs(at.y)) > 1.0;
        sum += outside ? weight : weight * texture(soft_map, place);
        all += weight;
    }
    return all > 0.0 ? sum / all : 1.0;
}
