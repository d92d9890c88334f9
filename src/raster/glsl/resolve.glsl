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

const float STEPS = 2048.0 / 0.693147; /* of coarse_steps, for a factor of e */

/* Adds the light of a point. fits: how well it fits if it is of the same surface; guide: that of the plane there, as
 * coarse_packed has it. Guides of two surfaces are further apart than depths are. */
void add_point(int x, int y, float fits, float guide, inout vec4 sum) {
    vec4 point = texelFetch(coarse_light, ivec2(x, y), 0);
    float off = abs(point.a - guide), same = fits * max(1.0 - 0.0085 * off, 0.0) + 1e-4;
    sum += vec4(point.rgb, 1.0) * (off < 32768.0 ? same : min(point.a, 1e-9));
}

/* Returns ln(1 + x) within 2.2 % for x from -0.4 to 0.6. */
float log_1_and(float x) { return x / (1.0 + 0.5 * max(x, -1.0)); }

void main() {
    float depth = coarse_depth(), guide = 65536.0 * surface_number + coarse_steps(depth);
    vec2 at = gl_FragCoord.xy / coarse.y - 0.5, corner = floor(at), part = at - corner;
    vec2 slope = coarse.y / depth * vec2(dFdx(depth), dFdy(depth));
    float here = dot(slope, part);
    ivec2 last = textureSize(coarse_light, 0) - 1, low = max(ivec2(corner), ivec2(0)), high = min(ivec2(corner) + 1, last);
    vec4 sum = vec4(0.0);
    add_point(low.x, low.y, (1.0 - part.x) * (1.0 - part.y), guide + STEPS * log_1_and(-here), sum);
    add_point(high.x, low.y, part.x * (1.0 - part.y), guide + STEPS * log_1_and(slope.x - here), sum);
    add_point(low.x, high.y, (1.0 - part.x) * part.y, guide + STEPS * log_1_and(slope.y - here), sum);
    add_point(high.x, high.y, part.x * part.y, guide + STEPS * log_1_and(slope.x + slope.y - here), sum);
    int more = sum.a < 1e-4 ? 16 : 0;
    for (int k = 0; k < more; k++) {
        ivec2 place = clamp(ivec2(corner) + ivec2(k & 3, k >> 2) - 1, ivec2(0), last);
        add_point(place.x, place.y, 0.0, guide, sum);
    }
    fragment = vec4(sum.rgb / max(sum.a, 1e-12), 1.0);
    if (!covered()) discard;
}
