/* slopes.glsl - the slopes of a normal map within a pixel (material/slopes.h)
 *
 * A narrow lobe takes variance as width (shading/material/widen.h). But slopes of threads and ribs are not normally
 * distributed: their sides are more frequent than their tops, and their diffuse light falls with the cosine of either
 * side. So a part x of the variance becomes points that are shaded by themselves, one on each side, and the rest widens
 * lobes:
 *
 *   slope = mean +- sqrt(x) a +- sqrt(x) b,   a a^T + b b^T = covariance (Cholesky)
 *
 * x follows from the fourth moment q of the slopes, which the points with a normal distribution around each have too:
 * q = t^2 + 2 s (1 - x^2), t and s the sums of the eigenvalues and of their squares. It is 0 of grains and .87 of a sine,
 * and there is no more: points that nothing widens would be sparks. The points of a and of b each fade below a deviation of
 * SLOPES_SEEN. */
#include "raster/glsl/picture.glsl"
#include "shading/material/widen.h"

/* Returns the level of a texture of which a pixel covers one texel. at: place in texels of the first level. */
float slopes_level(vec2 at) {
    vec2 x = dFdx(at), y = dFdy(at);
    return 0.5 * log2(max(max(dot(x, x), dot(y, y)), 1e-12));
}

/* Returns covariance xx, xy, yy of the slopes about their mean, that of `normal`, and the root of their fourth moment.
 * raw: as slopes.h has it, of a map of that strength. part: 0 where a pixel is a texel of the map, 1 from twice that on;
 * below, what varies is the normal across the pixel, whose filter has the variance 1 / (2 pi). Yusuke Tokuyoshi, Anton S.
 * Kaplanyan, "Improved Geometric Specular Antialiasing", I3D 2019, widen lobes by a normal's derivatives likewise.
 * The fourth moment takes the slopes as symmetric about their mean. A mean of 8 bits is SLOPE_STEP uncertain. */
const float SLOPE_STEP = 0.008;
vec4 slopes_about(vec4 raw, float strength, float part, Dir normal) {
    float square = strength * strength, fourth = raw.w * square * square;
    vec2 m = vec2(normal.x, normal.y) / max(normal.z, 1e-3), x = dFdx(m), y = dFdy(m);
    float length_2 = dot(m, m), unsure = SLOPE_STEP * sqrt(length_2);
    float xx = max(raw.x * square - m.x * m.x - unsure, 0.0), yy = max(raw.z * square - m.y * m.y - unsure, 0.0);
    float most = sqrt(xx * yy), xy = clamp(raw.y * square - m.x * m.y, -most, most), sum = xx + yy;
    float along = m.x * m.x * xx + 2.0 * m.x * m.y * xy + m.y * m.y * yy;
    fourth = max(fourth - length_2 * (length_2 + 2.0 * sum) - 4.0 * along, sum * sum);
    vec3 near = vec3(dot(vec2(x.x, y.x), vec2(x.x, y.x)), dot(vec2(x.x, y.x), vec2(x.y, y.y)),
                     dot(vec2(x.y, y.y), vec2(x.y, y.y))) / (2.0 * PI);
    float across = near.x + near.z;
    near = near / max(across, 1.0);
    return texture_levels.x * mix(vec4(near, 1.5 * min(across, 1.0)), vec4(xx, xy, yy, sqrt(fourth)), part);
}

/* The slopes of a pixel. */
struct Slopes {
    vec2 a, b;         /* to the points, in slopes */
    int along, across; /* how many points a and b make: 1 or 2 */
    vec3 rest;         /* covariance xx, xy, yy around each point */
};

const float SLOPES_SEEN = 0.1, SLOPES_EVEN = 0.75;

/* Returns how much of an axis of this variance points show, 0 to 1. */
float slopes_seen(float variance) {
    float seen = SLOPES_SEEN * SLOPES_SEEN;
    return smoothstep(seen, 4.0 * seen, variance);
}

/* m: as slopes.h has it. */
Slopes slopes_of(vec4 m) {
    float xx = max(m.x, 0.0), yy = max(m.z, 0.0), squares = xx * xx + 2.0 * m.y * m.y + yy * yy, sum = xx + yy;
    float less = 2.0 * squares - m.w * m.w + sum * sum, length_a = sqrt(max(xx, 1e-12));
    float x = sqrt(clamp(less / max(2.0 * squares, 1e-12), 0.0, SLOPES_EVEN));
    vec2 a = vec2(length_a, m.y / length_a), b = vec2(0.0, sqrt(max(yy - a.y * a.y, 0.0)));
    float seen_a = x * slopes_seen(dot(a, a)), seen_b = x * slopes_seen(dot(b, b));
    Slopes s;
    s.a = sqrt(seen_a) * a;
    s.b = sqrt(seen_b) * b;
    s.along = seen_a > 0.0 ? 2 : 1;
    s.across = seen_b > 0.0 ? 2 : 1;
    s.rest = vec3(xx, m.y, yy) - vec3(s.a.x * s.a.x, s.a.x * s.a.y, s.a.y * s.a.y + s.b.y * s.b.y);
    return s;
}

/* Returns the surface at point k, with its normal in the tangent frame. */
Surface slopes_surface(Surface s, Slopes p, int k) {
    int across = k / p.along;
    vec2 slope = vec2(s.normal.x, s.normal.y) / max(s.normal.z, 1e-3);
    slope += (k - across * p.along == 0 ? 1.0 : -1.0) * p.a + (across == 0 ? 1.0 : -1.0) * p.b;
    float z = inversesqrt(1.0 + dot(slope, slope));
    s.normal = dir(slope.x * z, slope.y * z, z);
    return s;
}

/* Returns the covariance of slopes about a point, xx, xy, yy in its own tangent plane. d tan(angle) is as large a turn
 * of the normal as its square cosine across the plane, and as its cosine along it. */
vec3 slopes_turned(vec3 c, Dir normal) {
    vec2 n = vec2(normal.x, normal.y);
    float z = max(normal.z, 1e-3), t = z * (z - 1.0) / max(dot(n, n), 1e-12);
    float a = z + t * n.x * n.x, b = t * n.x * n.y, d = z + t * n.y * n.y;
    vec2 p = vec2(a * c.x + b * c.y, a * c.y + b * c.z), q = vec2(b * c.x + d * c.y, b * c.y + d * c.z);
    return vec3(a * p.x + b * p.y, a * q.x + b * q.y, b * q.x + d * q.y);
}

/* Returns cosine and sine of the direction in which a covariance is longest. */
vec2 slopes_axis(vec3 c) {
    float half_off = 0.5 * (c.x - c.z), size = sqrt(half_off * half_off + c.y * c.y);
    float cosine = sqrt(clamp(0.5 + 0.5 * half_off / max(size, 1e-12), 0.0, 1.0));
    float sine = sqrt(max(1.0 - cosine * cosine, 0.0));
    return size > 1e-9 ? vec2(cosine, c.y < 0.0 ? -sine : sine) : vec2(1.0, 0.0);
}

/* Returns a direction of a frame in the frame rotated by an angle. */
Dir slopes_rotated(Dir d, vec2 angle) {
    return dir(angle.x * d.x + angle.y * d.y, angle.x * d.y - angle.y * d.x, d.z);
}
