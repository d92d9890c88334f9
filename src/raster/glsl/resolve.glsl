/* resolve.glsl - a pixel of a moving picture: the light of the shading points around it that lie on its surface
 *
 * The text before it defines covered(), false in holes. Points of the same surface count by distance, where their depth
 * is that of the pixel's plane; if there are none, any of the same surface near by, and else any point that is there. Solid
 * points have opacity 1, so the light has the guide in its place. */
#include "raster/glsl/picture.glsl"
#include "raster/glsl/coarse_guide.glsl"

uniform highp sampler2D coarse_light;
uniform highp float surface_number;
out highp vec4 fragment;

/* Adds the light of a point. fits: how well it fits if it is of the same surface. */
void add_point(ivec2 place, float fits, float depth, inout vec4 sum) {
    vec4 point = texelFetch(coarse_light, clamp(place, ivec2(0), textureSize(coarse_light, 0) - 1), 0);
    float number = floor(point.a / 65536.0), off = abs(point.a - 65536.0 * number - coarse_steps(depth));
    float same = fits * max(1.0 - 0.0085 * off, 0.0) + 1e-4, there = number > 0.0 ? 1e-9 : 0.0;
    sum += vec4(point.rgb, 1.0) * (number == surface_number ? same : there);
}

void main() {
    float depth = coarse_depth();
    vec2 at = gl_FragCoord.xy / coarse.y - 0.5, corner = floor(at), part = at - corner;
    vec2 slope = coarse.y * vec2(dFdx(depth), dFdy(depth));
    ivec2 first = ivec2(corner);
    vec4 sum = vec4(0.0);
    for (int k = 0; k < 4; k++) {
        ivec2 by = ivec2(k & 1, k >> 1);
        vec2 near = 1.0 - abs(vec2(by) - part);
        add_point(first + by, near.x * near.y, depth + dot(slope, vec2(by) - part), sum);
    }
    int more = sum.a < 1e-4 ? 16 : 0;
    for (int k = 0; k < more; k++) add_point(first + ivec2(k & 3, k >> 2) - 1, 0.0, depth, sum);
    fragment = vec4(sum.rgb / max(sum.a, 1e-12), 1.0);
    if (!covered()) discard;
}
