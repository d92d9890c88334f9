/* vertex.glsl - a vertex, given in world space */
#include "raster/glsl/picture.glsl"

layout(location = 0) in highp vec3 at_position;
layout(location = 1) in highp vec3 at_normal;
layout(location = 2) in highp vec4 at_tangent;
layout(location = 3) in highp vec2 at_texcoord_0;
layout(location = 4) in highp vec2 at_texcoord_1;
layout(location = 5) in highp vec4 at_color;
layout(location = 6) in highp vec3 at_occlusion; /* z: 1 where the buffer, which has two numbers, is not there */
layout(location = 7) in highp vec4 at_open_front;
layout(location = 8) in highp vec4 at_open_back;
layout(location = 9) in highp vec4 at_lights_0;
layout(location = 10) in highp vec4 at_lights_1;
#ifdef HAIRY
layout(location = 11) in highp vec4 at_across; /* unit vector from the middle of a fibre; w: its random number */
layout(location = 12) in highp vec3 at_root;   /* normal of the cloth */
uniform highp float hair_half;                 /* half the width of a fibre, m */
uniform highp float least_opacity;             /* as in forward.glsl */
out highp float hair_covers;
#endif

out highp vec3 from_eye;
centroid out highp vec3 vertex_normal;
out highp vec4 vertex_tangent;
out highp vec2 texcoord_0;
out highp vec2 texcoord_1;
out highp vec4 vertex_color;
out highp vec3 vertex_occlusion;
#ifdef SHADOWED
/* Rows of n n^T, and n n^T times the place: lifted.glsl. */
out highp vec3 lift_x;
out highp vec3 lift_yz;
out highp vec3 lift_from;
#endif
out highp vec4 vertex_open_front;
out highp vec4 vertex_open_back;
out highp vec4 vertex_lights_0;
out highp vec4 vertex_lights_1;

#ifdef HAIRY
/* Opacities of fibres begin here: below it fewer of them are drawn. */
const float HAIR_LEAST = 1.0 / 32.0;

/* Returns a vertex of a fibre that is at least a pixel wide, and sets what it covers of that: as much as the fibre itself
 * on the mean. Fibres that are not drawn, or left to the pass that blends, have no width. Robert L. Cook, John Halstead,
 * Maxwell Planck, David Ryu, "Stochastic Simplification of Aggregate Detail", SIGGRAPH 2007. */
vec3 vertex_place() {
    vec3 place = at_position - eye.xyz;
    float wider = max(coarse.z * (to_clip * vec4(place, 1.0)).w / (2.0 * hair_half), 1.0);
    float chance = min(1.0 / (HAIR_LEAST * wider), 1.0);
    bool drawn = at_across.w <= chance && (least_opacity < 0.5 || wider < 1.05);
    hair_covers = 1.0 / (chance * wider);
    return place + at_across.xyz * (hair_half * ((drawn ? wider : 0.0) - 1.0));
}
#else
vec3 vertex_place() { return at_position - eye.xyz; }
#endif

void main() {
    from_eye = vertex_place();
    vertex_normal = at_normal;
    vertex_tangent = at_tangent;
    texcoord_0 = at_texcoord_0;
    texcoord_1 = at_texcoord_1;
    vertex_color = at_color;
    vertex_occlusion = at_occlusion;
#ifdef SHADOWED
    lift_x = at_normal.x * at_normal;
    lift_yz = at_normal.yzz * at_normal.yyz;
    lift_from = dot(at_normal, from_eye) * at_normal;
#endif
    vertex_open_front = at_open_front;
    vertex_open_back = at_open_back;
#ifdef HAIRY
    /* The cloth hides half of the sky: as a ramp, with slope 3/4 (light_visibility.glsl). */
    float front = 0.5 + 0.5 * dot(at_normal, at_root);
    vertex_occlusion = vec3(front, 1.0 - front, 0.0);
    vertex_open_front = vec4(0.5, 0.75 * at_root);
    vertex_open_back = vertex_open_front;
#endif
    vertex_lights_0 = at_lights_0;
    vertex_lights_1 = at_lights_1;
    gl_Position = to_clip * vec4(from_eye, 1.0);
}
