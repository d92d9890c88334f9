/* behind.glsl - the environment behind the scene */
#include "raster/glsl/picture.glsl"
#include "raster/glsl/background.glsl"

in highp vec2 screen;
out highp vec4 fragment;

uniform highp vec4 background_place; /* cosine and sine of the rotation, factor on radiance */

void main() {
    /* to_clip has across / |across|^2 in its first row, and up likewise in its second */
    vec3 x = vec3(to_clip[0].x, to_clip[1].x, to_clip[2].x), y = vec3(to_clip[0].y, to_clip[1].y, to_clip[2].y);
    vec3 axis = vec3(to_clip[0].w, to_clip[1].w, to_clip[2].w); /* `forward` may be oblique to it */
    x -= dot(x, axis) * axis;
    y -= dot(y, axis) * axis;
    vec3 ray = forward.xyz;
    if (eye.w > 0.5) ray = ray + screen.x * x / dot(x, x) + screen.y * y / dot(y, y);
    fragment = vec4(environment_background(ray, background_place), 1.0);
}
