/* coarse_filter.glsl - the light of a moving picture's shading points with smooth shadows of polygons
 *
 * Each of coarse_side x coarse_side points has seen a part of the points on a polygon (soft_shadow.glsl). The light without
 * shadows has no noise, and is multiplied by the ratio of the means of both: Eric Heitz, Stephen Hill and Morgan McGuire,
 * "Combining Analytic Direct Illumination and Stochastic Shadows", I3D 2018. */
#include "raster/glsl/picture.glsl"
#include "raster/glsl/coarse_guide.glsl"

uniform highp sampler2D coarse_light;
uniform highp sampler2D coarse_polygons;
uniform highp sampler2D coarse_guides;
uniform int coarse_side;
out highp vec4 fragment;

/* Returns how alike two normals are: 1, or 0 from a right angle on. */
float alike(vec2 a, vec2 b) {
    vec2 d = a - b;
    return max(1.0 - 4.0 * dot(d, d), 0.0);
}

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy), last = textureSize(coarse_light, 0) - 1;
    vec4 light = texelFetch(coarse_light, at, 0), own = texelFetch(coarse_polygons, at, 0);
    vec4 guide = texelFetch(coarse_guides, at, 0);
    float open = dot(own.rgb, LUMINANCE), all = 1e-12, seen = 0.0;
    int count = open > 0.0 ? coarse_side * coarse_side : 0;
    for (int k = 0; k < count; k++) {
        ivec2 by = ivec2(k % coarse_side, k / coarse_side) - (coarse_side - 1) / 2;
        ivec2 place = clamp(at + by, ivec2(0), last);
        vec4 other = texelFetch(coarse_guides, place, 0), p = texelFetch(coarse_polygons, place, 0);
        bool same = other.w == guide.w && abs(other.z - guide.z) < 0.1 * guide.z;
        float weight = same ? alike(other.xy, guide.xy) : 0.0;
        all += weight * dot(p.rgb, LUMINANCE);
        seen += weight * p.a;
    }
    float change = open > 0.0 ? seen / all - own.a / open : 0.0;
    fragment = vec4(max(light.rgb + change * own.rgb, 0.0), coarse_packed(guide));
}
