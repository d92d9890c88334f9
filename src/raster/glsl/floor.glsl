/* floor.glsl - the floor: the scene's shadow and its mirror image
 *
 * The background is multiplied by V (1 - c), and M is added: V is the fraction of the light, in luminance, that reaches
 * the floor; M is the mirrored scene and c its coverage, both times the reflection of the floor (trace/path/catcher.h). */
in highp vec3 from_eye;
out highp vec4 fragment;

#include "raster/glsl/disc.glsl"
#include "raster/glsl/light.glsl"
#include "shading/ltc/polygon.h"

uniform highp sampler2D floor_sky;    /* fraction of the environment's light that arrives: raster/light/ground.h */
uniform highp sampler2D floor_mirror; /* the scene from below, premultiplied, with mipmaps */
uniform highp sampler2D floor_depth;  /* depth of floor_mirror */

float whole = 0.0, reached = 0.0;
void add_light(float light, float reaches) {
    whole += light;
    reached += light * reaches;
}

#define ONE_LIGHT(k, kind, map)                                                                              \
    beam = light_beam(k, kind);                                                                              \
    add_light(rgb_luminance(beam.radiance) * max(beam.wi.y, 0.0),                                            \
              light_reaches(map, from_eye, vec3(0.0, 1.0, 0.0), beam.wi.y));
void add_lights() {
    Beam beam;
    EACH_LIGHT(ONE_LIGHT)
}

#ifdef POLYGONS
/* Adds the light of polygon k, with corners in the floor's frame, where z is up. */
void add_polygon(int k, int corners, bool two_sided, int map) {
    vec3 here = eye.xyz + from_eye, c = polygon_radiance[k].rgb;
    Polygon p;
    p.count = corners;
    for (int j = 0; j < corners; j++) {
        vec3 to = polygon_corners[PICTURE_CORNERS * k + j].xyz - here;
        p.corners[j] = dir(to.x, to.z, to.y);
    }
    if (!two_sided && dot(polygon_normals[k].xyz, here - polygon_corners[PICTURE_CORNERS * k].xyz) <= 0.0) return;
    float reaches = polygon_reaches(map, from_eye, vec3(0.0, 1.0, 0.0), polygon_normals[k].xyz);
    add_light(rgb_luminance(rgb(c.r, c.g, c.b)) * PI * polygon_cosine(p), reaches);
}
#define ONE_POLYGON(k, corners, two_sided, map) add_polygon(k, corners, two_sided, map);
void add_polygons() { EACH_POLYGON(ONE_POLYGON) }
#else
void add_polygons() {}
#endif

/* Returns the fraction of the environment's light that reaches point p of the floor, in units of its radius. The
 * texture is finer towards the middle: point q of its disc is point |q| q of the floor. */
float sky_reaches(vec2 p) { return texture(floor_sky, 0.5 + 0.5 * p / sqrt(max(length(p), 1e-6))).r; }

/* Returns the mean of the mirror image over the cone of a rough floor, with its coverage. A cone of half width h, from
 * a point at distance w to an object at distance w' along the mirrored ray, appears h (1 - w / w') wide to the eye; the
 * mean of that is found first. */
vec4 mirrored() {
    vec4 clip = to_clip * vec4(from_eye, 1.0);
    vec2 at = 0.5 + 0.5 * clip.xy / clip.w, aspect = vec2(1.0, floor_lens.w);
    at.x = 1.0 - at.x; /* ground_view mirrors x */
    float w = eye.w > 0.5 ? clip.w : dot(forward.xyz, from_eye);
    float found = 0.0, sum = 0.0, half_width = min(floor_lens.z, 0.25 / max(aspect.y, 1.0));
    for (int k = 0; k < 12; k++) {
        float d = texture(floor_depth, at + half_width * aspect * disc_point(float(k), 12.0)).r;
        float ndc = 2.0 * d - 1.0;
        float far = eye.w > 0.5 ? floor_lens.y / (ndc - floor_lens.x) : (ndc - floor_lens.y) / floor_lens.x;
        if (d < 1.0) {
            found += 1.0;
            sum += eye.w > 0.5 ? max(1.0 - w / far, 0.0) : max(far - w, 0.0);
        }
    }
    if (found < 0.5) return vec4(0.0);
    float spread = min(floor_lens.z * sum / found, half_width);
    float level = max(log2(0.5 * spread * float(textureSize(floor_mirror, 0).x)), 0.0);
    vec4 mean = vec4(0.0);
    for (int k = 0; k < 16; k++)
        mean += textureLod(floor_mirror, at + spread * aspect * disc_point(float(k), 16.0), level);
    return mean / 16.0;
}

void main() {
    vec2 p = (eye.xz + from_eye.xz - floor_place.xz) / floor_place.w;
    float s = clamp(2.0 - 2.0 * length(p), 0.0, 1.0), share = s * s * (3.0 - 2.0 * s);
    add_lights();
    add_polygons();
    add_light(floor_light.x, mix(1.0, sky_reaches(p), floor_light.z));
    float seen = whole > 0.0 ? 1.0 - share * (1.0 - reached / whole) : 1.0;
    vec4 mirror = floor_light.y > 0.0 ? share * floor_light.y * mirrored() : vec4(0.0);
    fragment = vec4(mirror.rgb, 1.0 - seen * (1.0 - mirror.a));
}
