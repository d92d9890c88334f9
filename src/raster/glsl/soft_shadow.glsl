/* soft_shadow.glsl - how much of a light that has a size reaches a point
 *
 * A point of the light that is s from its middle meets the plane at distance b, on its way to a receiver at
 * distance r, at s (1 - b / r) from the line to the middle: on the map, whose half width at distance 1 is h, at
 * s (1 / b - 1 / r) / h. So the mean distance b of what is in the way says how far to look. Randima Fernando,
 * "Percentage-Closer Soft Shadows", SIGGRAPH Sketches 2005.
 *
 * Not all that is nearer to the light is in the way: a floor before a wall is not. What is seen at t on the map hides
 * the point s = t h / (1 / b - 1 / r), if that is on the light. It counts wholly there, and less outside, down to
 * nothing at twice the light's radius. Gael Guennebaud, Loic Barthe and Mathias Paulin, "Real-time Soft Shadow Mapping
 * by Backprojection", Eurographics Symposium on Rendering 2006, project what the map shows on the light so. */
#include "raster/glsl/disc.glsl"
#include "raster/glsl/shadow.glsl"

uniform highp sampler2DArray shadow_depth;

/* The mean over the four pixels of a quad, between which a fine derivative is the difference; to be asked of
 * all four. Each looks in every fourth place of one pattern. A coarse derivative may be of one pair for all
 * four, which is no mean: then each pixel has its own places. */
#ifdef FINE_DERIVATIVES
float quad_mean(float v) {
    vec2 side = 0.5 - mod(floor(gl_FragCoord.xy), 2.0);
    v += side.x * dFdxFine(v);
    return v + side.y * dFdyFine(v);
}
const float QUAD = 4.0;
float quad_place() { return dot(mod(floor(gl_FragCoord.xy), 2.0), vec2(1.0, 2.0)); }
#else
const float QUAD = 1.0;
float quad_place() { return 0.0; }
float quad_mean(float v) { return v; }
#endif

/* Returns how the depth of the plane through a point p from the light, with normal n, changes over the map.
 * There 1 / w = (n.f + X n.x + Y n.y) / n.p, f the axis of the light and x, y the halves of its map at
 * distance 1; and depth is linear in 1 / w. */
vec2 shadow_slope(int map, vec3 p, vec3 n) {
    mat4 m = shadow_clip[map];
    float h2 = shadow_disc[map].y * shadow_disc[map].y, through = min(dot(n, p), -1e-3 * length(p));
    vec2 across = h2 * vec2(dot(n, vec3(m[0].x, m[1].x, m[2].x)), dot(n, vec3(m[0].y, m[1].y, m[2].y)));
    return m[3].z * across / through;
}

/* Quads share what they look for, which is how far the light is spread, but not what they find: a shadow that
 * is the same for four pixels shows. All look in the same places about themselves, for grain shows too, and
 * swims where the view moves. Places are densest in the middle, where alone what nearly touches the receiver hides the
 * light, and a shadow fades in with what is found. */
float soft_shadow(int map, vec3 normal, float cosine) {
    vec4 at = shadow_place(map, normal, cosine, 2.5);
    bool there = at.w > 0.0 && cosine > 0.0;
    if (quad_mean(there ? 1.0 : 0.0) < 0.1) return 1.0; /* of one quad all return or none */
    at.w = max(at.w, 1e-6);
    vec2 slope = shadow_slope(map, eye.xyz + from_eye - shadow_eye[map].xyz, normal);
    float size = 0.5 * shadow_disc[map].x / shadow_disc[map].y, place = quad_place();
    /* depth = 1/2 + (a + c / w) / 2 */
    float c = shadow_clip[map][3].z, a = 2.0 * at.z - 1.0 - c / at.w, layer = float(map);
    float inverse = 0.0, found = 0.0, look = min(size / at.w, 0.1);
    for (int k = 0; k < 16; k++) {
        vec2 to = disc_point(QUAD * float(k) + place, 16.0 * QUAD);
        to = look * dot(to, to) * dot(to, to) * to;
        float d = texture(shadow_depth, vec3(at.xy + to, layer)).r;
        float nearer = (2.0 * d - 1.0 - a) / c, reach = size * (nearer - 1.0 / at.w);
        if (d < at.z + dot(slope, to) && reach > 0.0) {
            float weight = clamp(2.0 - length(to) / reach, 0.0, 1.0);
            inverse += weight * nearer;
            found += weight;
        }
    }
    found = quad_mean(there ? found : 0.0);
    inverse = quad_mean(there ? inverse : 0.0);
    if (found < 0.01) return 1.0;
    float spread = clamp(size * (inverse / found - 1.0 / at.w), 1.0 / 2048.0, 0.1), sum = 0.0;
    for (int k = 0; k < 32; k++) {
        vec2 to = spread * disc_point(float(k), 32.0);
        sum += texture(shadow_map, vec4(at.xy + to, layer, at.z + dot(slope, to)));
    }
    return there ? mix(1.0, sum / 32.0, min(found, 1.0)) : 1.0;
}
