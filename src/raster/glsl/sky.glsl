/* sky.glsl - directions of the environment drawn in proportion to about its radiance, as trace/light/sky.h does */
#include "raster/glsl/picture.glsl"
#include "raster/glsl/background.glsl"

uniform highp sampler2D sky_table; /* raster/light/gl_sky.h */

const float SKY_PI = 3.14159265;

/* A direction, the radiance from there, and the density with which it is drawn, 1/sr. */
struct SkyPoint {
    vec3 wi, radiance;
    float pdf;
};

float sky_end(int row, int column) { return column < 0 ? 0.0 : texelFetch(sky_table, ivec2(column, row), 0).r; }
float sky_row_end(int row, int columns) { return row < 0 ? 0.0 : texelFetch(sky_table, ivec2(columns, row), 0).r; }

/* Returns the number of the interval that has u. row below 0: of the rows. */
int sky_find(int row, int columns, int count, float u) {
    int low = 0, high = count - 1;
    for (int k = 0; k < 12; k++) {
        int middle = (low + high) / 2;
        float end = row < 0 ? sky_row_end(middle, columns) : sky_end(row, middle);
        low = end <= u ? min(middle + 1, high) : low;
        high = end <= u ? high : middle;
    }
    return low;
}

bool sky_is_map() { return sky_place.w > 1.5; }

vec3 sky_radiance(vec3 wi) { return sky_is_map() ? environment_background(wi, sky_place) : sky_color.rgb; }

/* Returns the density over the sphere, from the probability of a cell. */
float sky_density(ivec2 size, float cell, float sine) {
    return cell * float(size.x * size.y) / (2.0 * SKY_PI * SKY_PI * max(sine, 1e-7));
}

/* Returns the density with which sky_sample draws a direction. */
float sky_pdf(vec3 wi) {
    if (!sky_is_map()) return 1.0 / (4.0 * SKY_PI);
    ivec2 size = textureSize(sky_table, 0) - ivec2(1, 0);
    float x = wi.x * sky_place.x - wi.z * sky_place.y, z = wi.x * sky_place.y + wi.z * sky_place.x;
    float u = 0.5 + atan(x, -z) / (2.0 * SKY_PI), v = acos(clamp(wi.y, -1.0, 1.0)) / SKY_PI;
    int column = clamp(int(u * float(size.x)), 0, size.x - 1), row = clamp(int(v * float(size.y)), 0, size.y - 1);
    float wide = sky_end(row, column) - sky_end(row, column - 1);
    float tall = sky_row_end(row, size.x) - sky_row_end(row - 1, size.x);
    return sky_density(size, wide * tall, sqrt(wi.x * wi.x + wi.z * wi.z));
}

SkyPoint sky_sample(float u, float v) {
    SkyPoint p;
    if (!sky_is_map()) {
        float y = 1.0 - 2.0 * u, r = sqrt(max(1.0 - y * y, 0.0));
        p.wi = vec3(r * cos(2.0 * SKY_PI * v), y, r * sin(2.0 * SKY_PI * v));
        p.radiance = sky_color.rgb;
        p.pdf = 1.0 / (4.0 * SKY_PI);
        return p;
    }
    ivec2 size = textureSize(sky_table, 0) - ivec2(1, 0);
    int row = sky_find(-1, size.x, size.y, v), column = sky_find(row, size.x, size.x, u);
    float left = sky_end(row, column - 1), wide = sky_end(row, column) - left;
    float top = sky_row_end(row - 1, size.x), tall = sky_row_end(row, size.x) - top;
    float mu = (float(column) + min((u - left) / wide, 0.99999994)) / float(size.x);
    float mv = (float(row) + min((v - top) / tall, 0.99999994)) / float(size.y);
    float phi = (mu - 0.5) * 2.0 * SKY_PI, theta = mv * SKY_PI, sine = sin(theta);
    float x = sine * sin(phi), z = -sine * cos(phi);
    p.wi = vec3(x * sky_place.x + z * sky_place.y, cos(theta), z * sky_place.x - x * sky_place.y);
    p.radiance = textureLod(environment_map, vec2(mu, mv), 0.0).rgb * sky_place.z;
    p.pdf = sky_density(size, wide * tall, abs(sine));
    return p;
}
