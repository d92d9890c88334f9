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

const float DEPTH_NEAR = 0.04; /* points are as good as not on a plane that is this part of their depth away */

/* Adds the light of a point. fits: how well it fits if it is of the same surface; depth: that of the plane there; per_depth:
 * 1 over the depths within which points are near. */
void add_point(int x, int y, float fits, float depth, float per_depth, inout vec4 sum) {
    vec4 point = texelFetch(coarse_light, ivec2(x, y), 0);
    float same = fits * max(1.0 - per_depth * abs(point.a - depth), 0.0) + 1e-4;
    sum += vec4(point.rgb, 1.0) * (coarse_number(point.a) == uint(surface_number) ? same : min(point.a, 1e-9));
}

void main() {
    float depth = coarse_depth(), per_depth = 1.0 / (DEPTH_NEAR * depth);
    vec2 at = gl_FragCoord.xy / coarse.y - 0.5, corner = floor(at), part = at - corner;
    vec2 slope = coarse.y * vec2(dFdx(depth), dFdy(depth));
    float here = depth - dot(slope, part);
    ivec2 last = textureSize(coarse_light, 0) - 1, low = max(ivec2(corner), ivec2(0)), high = min(ivec2(corner) + 1, last);
    vec4 sum = vec4(0.0);
    add_point(low.x, low.y, (1.0 - part.x) * (1.0 - part.y), here, per_depth, sum);
    add_point(high.x, low.y, part.x * (1.0 - part.y), here + slope.x, per_depth, sum);
    add_point(low.x, high.y, (1.0 - part.x) * part.y, here + slope.y, per_depth, sum);
    add_point(high.x, high.y, part.x * part.y, here + slope.x + slope.y, per_depth, sum);
    int more = sum.a < 1e-4 ? 16 : 0;
    for (int k = 0; k < more; k++) {
        ivec2 place = clamp(ivec2(corner) + ivec2(k & 3, k >> 2) - 1, ivec2(0), last);
        add_point(place.x, place.y, 0.0, depth, per_depth, sum);
    }
    fragment = vec4(sum.rgb / max(sum.a, 1e-12), 1.0);
    if (!covered()) discard;
}
