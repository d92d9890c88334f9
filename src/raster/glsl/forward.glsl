/* forward.glsl - a fragment: its surface, its stack of lobes, and the light that they send to the eye
 *
 * The text before it supplies MATERIAL_..., material_surface, material_choices and material_table. */
in highp vec3 from_eye;
in highp vec3 vertex_normal;
in highp vec4 vertex_tangent;
out highp vec4 fragment;

#include "raster/glsl/picture.glsl"
#ifdef SHADOWED
#include "raster/glsl/shadow.glsl"
#endif
#include "shading/frame.h"
#include "shading/punctual.h"

Dir dir_of(vec3 v) { return dir(v.x, v.y, v.z); }
vec3 vec_of(Rgb c) { return vec3(c.r, c.g, c.b); }
vec3 vec_of_dir(Dir d) { return vec3(d.x, d.y, d.z); }

/* The geometric normal is that of the plane through neighbouring pixels, which faces the eye. */
Facing fragment_facing(Dir wo) {
    float side = gl_FrontFacing ? 1.0 : -1.0;
    Facing at;
    at.geometric = dir_normal_or(dir_of(cross(dFdx(from_eye), dFdy(from_eye))), wo);
    at.normal = dir_normal_or(dir_of(side * vertex_normal), at.geometric);
    at.tangent = dir_of(side * vertex_tangent.xyz);
    at.handedness = side * vertex_tangent.w;
    return at;
}

/* Light from one direction. */
struct Beam {
    Dir wi; /* in the world */
    Rgb radiance;
};

Beam light_beam(int k) {
    vec4 where = lights[4 * k], along = lights[4 * k + 1], cone = lights[4 * k + 3];
    vec3 to = where.xyz - eye.xyz - from_eye;
    float d2 = dot(to, to), scale = 1.0;
    Beam beam;
    beam.wi = dir_of(-along.xyz);
    if (where.w > 0.5) {
        scale = d2 > 0.0 ? punctual_distance(d2, along.w) : 0.0;
        beam.wi = dir_normal_or(dir_of(to), beam.wi);
        if (where.w > 1.5)
            scale = scale * punctual_cone(-dir_dot(beam.wi, dir_of(along.xyz)), cone.x, cone.y);
    }
    vec3 c = lights[4 * k + 2].rgb * scale;
    beam.radiance = rgb(c.r, c.g, c.b);
    return beam;
}

#ifdef SHADOWED
float light_reaches(int map, vec3 normal, float cosine) {
    return shadow_light(map, from_eye, normal, cosine);
}
#else
float light_reaches(int map, vec3 normal, float cosine) { return 1.0; }
#endif

Rgb punctual_light(Stack m, Facing at, Frame f, Dir o) {
    Rgb sum = rgb_grey(0.0);
    int count = int(forward.w);
    for (int k = 0; k < count; k++) {
        Beam beam = light_beam(k);
        Dir i = frame_to(f, beam.wi);
        if (i.z > 0.0 && dir_dot(beam.wi, at.geometric) > 0.0) {
            Angles a = angles_between(o, i), coat = a;
            if (m.coat.pick > 0.0) coat = angles_between(stack_to_coat(m, o), stack_to_coat(m, i));
            StackValue v = stack_value(m, a, coat);
            float reaches = 1.0;
            int map = int(lights[4 * k + 2].w);
            if (MATERIAL_SHADOWED && map >= 0)
                reaches = light_reaches(map, vec_of_dir(at.geometric), dir_dot(beam.wi, at.geometric));
            sum = rgb_add(sum, rgb_scale(rgb_mul(v.f_cos, beam.radiance), reaches));
        }
    }
    return sum;
}

void main() {
    Dir wo = eye.w > 0.5 ? dir_of(-normalize(from_eye)) : dir_of(-forward.xyz);
    Facing at = fragment_facing(wo);
    Surface s = material_surface();
    float opacity = coverage_of(s.opacity);
    Rgb sum = s.base_color;
    if (!MATERIAL_UNLIT) {
        sum = rgb_scale(s.emission, gl_FrontFacing || MATERIAL_DOUBLE_SIDED ? s.emission_strength : 0.0);
        Frame f = frame_of(at, s, wo);
        Dir o = frame_to(f, wo);
        s = dust_settle(frame_surface(s), f.z, dir_of(eye.xyz + from_eye));
        Stack m = surface_stack(s, material_choices(), material_table(), o);
        sum = rgb_add(sum, punctual_light(m, at, f, o));
    }
    fragment = vec4(vec_of(sum) * opacity, opacity);
}
