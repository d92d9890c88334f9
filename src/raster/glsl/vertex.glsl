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

void main() {
    from_eye = at_position - eye.xyz;
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
    vertex_lights_0 = at_lights_0;
    vertex_lights_1 = at_lights_1;
    gl_Position = to_clip * vec4(from_eye, 1.0);
}
