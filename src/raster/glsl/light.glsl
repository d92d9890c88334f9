/* light.glsl - the light that arrives at a fragment from punctual lights, and the fraction that is not in shadow
 *
 * The text before it defines EACH_LIGHT, and SHADOWED if there are shadow maps. */
#include "raster/glsl/picture.glsl"
#include "shading/stack/frame.h"
#include "shading/area/punctual.h"
#include "shading/dialect/rgb.h"
#ifdef SHADOWED
#include "raster/glsl/shadow.glsl"
#include "raster/glsl/soft_shadow.glsl"
#endif

Dir dir_of(vec3 v) { return dir(v.x, v.y, v.z); }
vec3 vec_of(Rgb c) { return vec3(c.r, c.g, c.b); }
vec3 vec_of_dir(Dir d) { return vec3(d.x, d.y, d.z); }

/* Light from one direction. */
struct Beam {
    Dir wi; /* in the world */
    Rgb radiance;
};

/* Returns the light of punctual light k at a place. */
Beam light_beam_at(int k, int kind, vec3 here) {
    vec4 along = lights[4 * k + 1];
    vec3 to = lights[4 * k].xyz - here;
    float d2 = dot(to, to), scale = 1.0;
    Beam beam;
    beam.wi = dir_of(-along.xyz);
    if (kind > 0) {
        scale = d2 > 0.0 ? punctual_distance(d2, along.w) : 0.0;
        beam.wi = dir_normal_or(dir_of(to), beam.wi);
    }
    if (kind > 1) {
        vec4 cone = lights[4 * k + 3];
        scale = scale * punctual_cone(-dir_dot(beam.wi, dir_of(along.xyz)), cone.x, cone.y);
    }
    vec3 c = lights[4 * k + 2].rgb * scale;
    beam.radiance = rgb(c.r, c.g, c.b);
    return beam;
}
Beam light_beam(int k, int kind) { return light_beam_at(k, kind, eye.xyz + from_eye); }

/* Return the fraction of a light, punctual or of a polygon, that reaches a place, less eye, on a surface of that normal.
 * cosine: of the light to the normal. */
#ifdef SHADOWED
float light_reaches(int map, vec3 place, vec3 normal, float cosine) {
    return map < 0 ? 1.0 : shadow_light(map, place, normal, cosine);
}
float polygon_reaches(int map, vec3 place, vec3 normal, vec3 light_normal) {
    return map < 0 ? 1.0 : soft_shadow(map, place, normal, light_normal);
}
#else
float light_reaches(int map, vec3 place, vec3 normal, float cosine) { return 1.0; }
float polygon_reaches(int map, vec3 place, vec3 normal, vec3 light_normal) { return 1.0; }
#endif
