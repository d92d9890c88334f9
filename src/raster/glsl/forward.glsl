/* forward.glsl - a fragment: its surface, its stack of lobes, and the light that they reflect to the eye
 *
 * The text before it supplies MATERIAL_..., material_surface, material_choices and material_table, SHOWS_... of
 * a part of the light, HAIR_OPEN, the part of it that hair on the surface lets through, and PROPERTY where a property is
 * shown in its place. */
in highp vec3 from_eye;
centroid in highp vec3 vertex_normal; /* centroid: inside the triangle at outlines too */
#ifdef NEEDS_TANGENT
in highp vec4 vertex_tangent;
#else
const vec4 vertex_tangent = vec4(0.0, 0.0, 0.0, 1.0);
#endif
#ifdef COARSE
layout(location = 0) out highp vec4 fragment;
layout(location = 1) out highp vec4 fragment_polygons; /* what coarse_filter.glsl reads */
layout(location = 2) out highp vec4 fragment_guide;
uniform highp float surface_number;
#else
out highp vec4 fragment;
#endif
#ifdef BLENDED
uniform highp float least_opacity; /* 0, or SOLID_OPACITY of passes.c where solid points alone are drawn */
#endif

#include "raster/glsl/light.glsl"
#ifdef COARSE
#include "raster/glsl/coarse_guide.glsl"
#endif
#include "raster/glsl/horizon.glsl"
#include "raster/glsl/lifted.glsl"
#include "shading/material/dust.h"

/* Returns normals and tangent of the side that is seen. The geometric normal is that of the plane through neighbouring
 * pixels, towards the eye. */
Facing fragment_facing(Dir wo) {
    float side = gl_FrontFacing ? 1.0 : -1.0;
    Facing at;
    at.geometric = dir_normal_or(dir_of(cross(dFdx(from_eye), dFdy(from_eye))), wo);
    at.normal = dir_normal_or(dir_of(side * vertex_normal), at.geometric);
    at.tangent = dir_of(side * vertex_tangent.xyz);
    at.handedness = side * vertex_tangent.w;
    return at;
}

/* Returns the light that comes through, black without the diffuse lobe. */
StackValue stack_seen_through(Stack m, StackView w, Slots only, Angles a) {
    StackValue v = stack_transmitted(m, w, a);
    if (!only.diffuse) v.f_cos = rgb_grey(0.0);
    return v;
}

/* Returns the light of a beam that the slots in `only` reflect or transmit, without shadows. */
Rgb beam_light(Beam beam, Stack m, StackView w, Slots only, Frame f) {
    Dir i = frame_to(f, beam.wi);
    float cosine = dir_dot(beam.wi, smooth_normal);
    bool behind = HAS_TRANSMITTED(m) && cosine < 0.0;
    float side = behind ? -1.0 : 1.0;
    i.z = side * i.z;
    bool lit = i.z > 0.0 && side * cosine > 0.0;
    i.z = max(i.z, 1e-6); /* an unlit point is evaluated and then dropped: a branch costs more */
    Angles a = angles_between(w.o, i), coat = a;
    if (HAS_COAT(m)) coat = angles_between(w.coat_o, stack_to_coat(m, i));
    StackValue v = stack_value_of(m, w, only, a, coat);
    if (behind) v = stack_seen_through(m, w, only, a);
    Rgb sum = rgb_mul(v.f_cos, beam.radiance);
    return rgb(lit ? sum.r : 0.0, lit ? sum.g : 0.0, lit ? sum.b : 0.0);
}

/* Returns the light of punctual light k that the slots in `only` reflect or transmit. map: its shadow map, or -1. */
Rgb light_from(int k, int kind, int map, Stack m, StackView w, Slots only, Facing at, Frame f) {
    Beam beam = light_beam(k, kind);
    float cosine = dir_dot(beam.wi, smooth_normal), side = HAS_TRANSMITTED(m) && cosine < 0.0 ? -1.0 : 1.0;
    vec3 normal = side * vec_of_dir(smooth_normal);
    float reaches = light_reaches(map, lifted(normal), normal, side * cosine);
    return rgb_scale(beam_light(beam, m, w, only, f), reaches);
}

/* EACH_LIGHT(L) is L(k, kind, map) for each light. */
#define ONE_LIGHT(k, kind, map) sum = rgb_add(sum, light_from(k, kind, map, m, w, only, at, f));
Rgb punctual_light(Stack m, StackView w, Slots only, Facing at, Frame f) {
    Rgb sum = rgb_grey(0.0);
    EACH_LIGHT(ONE_LIGHT)
    return sum;
}

const Slots SHOWN = Slots(SHOWS_DIFFUSE, SHOWS_SPECULAR, SHOWS_SHEEN, SHOWS_COAT, SHOWS_DUST);

#ifdef COARSE
/* The light of polygons in the pixel, as it is and without shadows, and the part of the pixel that the next counts for. */
vec3 polygons_shadowed = vec3(0.0), polygons_open = vec3(0.0);
float polygons_weight = 1.0;
int polygons_first = 0, polygons_number = POLYGON_POINTS / 2; /* the points on a polygon that light what is drawn */
#endif

#ifdef POLYGONS
#include "raster/glsl/polygons.glsl"
#else
struct PolygonReach {
    float none;
};
PolygonReach polygon_reach(bool transmits, Facing at) { return PolygonReach(0.0); }
Rgb polygon_light(Stack m, StackView w, PolygonReach reach, Frame f) { return rgb_grey(0.0); }
#endif

#ifdef AMBIENT
/* Returns the visible fraction of the sky on this side and behind. Of an even sky about the shading normal, (1 + cos) / 2
 * lies above the smooth surface. */
vec2 sky_open(Frame f) {
    vec2 rays = gl_FrontFacing ? vertex_occlusion.xy : vertex_occlusion.yx;
    return (0.5 + 0.5 * dir_dot(smooth_normal, f.z)) * min(vec2(texture_occlusion), rays);
}
#endif

#ifdef WOVEN
#include "raster/glsl/weave.glsl"
#else
/* Returns the light that a stack reflects and transmits towards o. */
Rgb stack_light(Stack m, Dir o, Facing at, Frame f, float occlusion) {
    StackView w;
    stack_view(m, o, w);
    Rgb sum = punctual_light(m, w, SHOWN, at, f);
    sum = rgb_add(sum, polygon_light(m, w, polygon_reach(HAS_TRANSMITTED(m) && SHOWS_DIFFUSE, at), f));
#ifdef AMBIENT
    occlude_by_texture(occlusion);
    vec2 open = sky_open(f);
    sum = rgb_add(sum, stack_ambient(m, w, material_ambient(), f, open.x, open.y));
#endif
    return sum;
}
#endif

/* Turns a frame so that x is the direction in which slopes vary most, with what is relative to it. */
void turn_to_slopes(inout Frame f, inout Surface s, inout vec3 covariance) {
#ifdef SLOPES_TURN
    vec2 axis = slopes_axis(covariance);
    f = frame_rotate(f, axis.x, axis.y);
    s.nap_direction = slopes_rotated(s.nap_direction, axis);
    s.clearcoat_normal = slopes_rotated(s.clearcoat_normal, axis);
    float trace = covariance.x + covariance.z;
    float along = axis.x * axis.x * covariance.x + 2.0 * axis.x * axis.y * covariance.y +
                  axis.y * axis.y * covariance.z;
    covariance = vec3(along, 0.0, trace - along);
#endif
}

/* Returns the light that a surface reflects and transmits, and in a the part of the pixel that its threads cover. rest:
 * covariance of its slopes; coat: twice the variance of those of the coat. */
vec4 surface_light(Surface from, Facing at, Dir wo, vec3 rest, float coat) {
    Surface s = from;
    Frame f = frame_of(at, s, wo);
#ifdef WOVEN
    f = frame_rotate(f, weave_number(CLOTH_ROTATION_COS), weave_number(CLOTH_ROTATION_SIN));
#endif
    s = dust_accumulate(frame_surface(s), f.z, dir_of(eye.xyz + from_eye));
    vec3 covariance = slopes_turned(rest, from.normal);
    turn_to_slopes(f, s, covariance);
    Dir o = frame_to(f, wo);
    Stack m;
    surface_stack(m, s, material_choices(), material_table());
#ifdef WIDENED
    stack_widen(m, 2.0 * covariance.x, 2.0 * covariance.z, coat);
#endif
#ifdef WOVEN
    return woven_light(m, o, at, f, s.occlusion, s.wear);
#else
    return vec4(vec_of(stack_light(m, o, at, f, s.occlusion)), 1.0);
#endif
}

/* Returns the mean light of the points of a pixel, as surface_light has it. */
vec4 pixel_light(Surface s, Facing at, Dir wo) {
    vec4 coat = slopes_of_clearcoat_normal(s.clearcoat_normal);
    float coat_more = coat.x + coat.z;
#ifdef SLOPES
    vec4 own = slopes_of_normal(s.normal);
#ifdef WOVEN
    return surface_light(s, at, wo, own.xyz, coat_more);
#else
    Slopes slopes = slopes_of(own);
    int points = slopes.along * slopes.across;
    vec4 sum = vec4(0.0);
#ifdef COARSE
    polygons_weight = 1.0 / float(points);
#endif
    for (int k = 0; k < points; k++)
        sum += surface_light(slopes_surface(s, slopes, k), at, wo, slopes.rest, coat_more);
    return sum / float(points);
#endif
#else
    return surface_light(s, at, wo, vec3(0.0), coat_more);
#endif
}

void main() {
    Dir wo = dir_of(-forward.xyz);
    if (eye.w > 0.5) wo = dir_of(-normalize(from_eye));
    Facing at = fragment_facing(wo);
    Surface s = material_surface();
    float opacity = coverage_of(s.opacity);
    smooth_normal = frame_visible_normal(facing_normal(at), wo);
#ifdef PROPERTY
    Frame f = frame_of(at, s, wo);
#ifdef WOVEN
    f = frame_rotate(f, weave_number(CLOTH_ROTATION_COS), weave_number(CLOTH_ROTATION_SIN));
#endif
    fragment = vec4(PROPERTY * opacity, opacity);
#else
    Rgb sum = rgb_scale(s.base_color, SHOWS_EMISSION);
    if (!MATERIAL_UNLIT) {
        float strength = gl_FrontFacing || MATERIAL_DOUBLE_SIDED ? s.emission_strength : 0.0;
        sum = rgb_scale(s.emission, SHOWS_EMISSION * strength);
        vec4 light = pixel_light(s, at, wo);
        sum = rgb_add(sum, rgb_scale(rgb(light.r, light.g, light.b), HAIR_OPEN));
#ifdef WOVEN
#ifdef MASKED
        opacity = light.a < 0.5 ? 0.0 : opacity;
#else
        opacity = opacity * light.a;
#endif
#endif
    }
    fragment = vec4(vec_of(sum) * opacity, opacity);
#endif
#ifdef COARSE
    /* Keep below what halves hold: one infinite point would spread over its neighbours. */
    fragment.rgb = min(fragment.rgb, 65000.0);
    fragment_polygons = min(vec4(polygons_open, dot(polygons_shadowed, LUMINANCE)) * HAIR_OPEN * opacity, 65000.0);
    fragment_guide = coarse_guide(vec_of_dir(at.normal), surface_number);
#endif
    /* discard comes last, since derivatives of its neighbours need a fragment until here */
#ifdef MASKED
    if (opacity < 0.5) discard;
#endif
#ifdef BLENDED
    if (opacity < least_opacity) discard;
#endif
}
