/* floor_vertex.glsl - a corner of the square about the floor */
#include "raster/glsl/picture.glsl"

out highp vec3 from_eye;

void main() {
    vec2 corner = vec2(float(gl_VertexID & 1), float(gl_VertexID >> 1)) * 2.0 - 1.0;
    from_eye = floor_place.xyz + floor_place.w * vec3(corner.x, 0.0, corner.y) - eye.xyz;
    gl_Position = to_clip * vec4(from_eye, 1.0);
}
