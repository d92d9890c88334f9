/* environment.glsl - the light around a scene, for shading/ambient/ambient.h: a filtered cube, terms and lights
 *
 * The source of ambient.h is here the frame that directions are given in. Level m of environment_cube is the radiance
 * filtered by exp(3200 / 4^m (mu - 1)). The terms are those of scene/light/env_split.h: environment_terms of the whole
 * image's irradiance over pi, without degree 3; environment_residual of the image without its lights. The texts around
 * this one define ambient_baked and ambient_light_visibility. */
#include "shading/stack/frame.h"
#include "shading/dialect/rgb.h"

uniform highp samplerCube environment_cube;
layout(std140) uniform Environment {
    highp vec4 environment_place;     /* cosine and sine of its rotation, factor on radiance, number of lights */
    highp vec4 environment_parts;     /* factor on diffuse lobe and dust, on the other lobes, number of points */
    highp vec4 environment_terms[18]; /* w of the first: ambient_light_kappa */
    highp vec4 environment_residual[16];
    highp vec4 environment_lights[32];  /* two each: direction and density, irradiance */
    highp vec4 environment_points[128]; /* two each: direction and number of the light, irradiance */
    highp vec4 environment_merged[8];   /* lights of a moving picture, as environment_lights */
    highp vec4 environment_merged_of[8]; /* two each: the parts that they have of environment_lights */
    highp vec4 environment_merged_count;
};
#ifdef COARSE
#define ENVIRONMENT_LIGHTS environment_merged
#define ENVIRONMENT_LIGHTS_MOST 4
#else
#define ENVIRONMENT_LIGHTS environment_lights
#define ENVIRONMENT_LIGHTS_MOST 16
#endif

struct AmbientWeights {
    float a, b, c, d;
};
struct AmbientLight {
    Dir w;
    Rgb color;
    float density;
    int light;
};

/* Return a direction of the image in the world, and a direction of a frame in the image. */
vec3 environment_world(vec3 d) {
    return vec3(d.x * environment_place.x + d.z * environment_place.y, d.y,
                d.z * environment_place.x - d.x * environment_place.y);
}
vec3 environment_image(Frame f, Dir w) {
    Dir d = frame_from(f, w);
    return vec3(d.x * environment_place.x - d.z * environment_place.y, d.y,
                d.x * environment_place.y + d.z * environment_place.x);
}

Rgb environment_rgb(vec3 c) {
    return rgb(c.r * environment_place.z, c.g * environment_place.z, c.b * environment_place.z);
}

Rgb ambient_radiance(Frame f, Dir w, float kappa) {
    float level = 0.5 * (11.6438562 - log2(max(kappa, 0.25)));
    return environment_rgb(textureLod(environment_cube, environment_image(f, w), max(level, 0.0)).rgb);
}

/* Returns the radiance of the image without its lights, filtered about w: degrees 0 to 3, each times the Legendre
 * coefficient of the filter, as ambient_rest_about (scene/light/env_split.h) has it. */
Rgb ambient_residual(Frame f, Dir w, float kappa) {
    float k = max(kappa, 0.25), q = 1.0 / k, a = 1.0 + 2.0 / (exp(min(2.0 * k, 60.0)) - 1.0) - q, b = 1.0 - 3.0 * q * a;
    vec3 d = kappa > 0.0 ? vec3(a, b, a - 5.0 * q * b) : vec3(2.0 / 3.0, 0.25, 0.0);
    vec3 n = environment_image(f, w), s = n * n;
    vec3 one = environment_residual[1].rgb * n.x + environment_residual[2].rgb * n.y + environment_residual[3].rgb * n.z;
    vec3 two = environment_residual[4].rgb * (n.x * n.y) + environment_residual[5].rgb * (n.y * n.z) +
               environment_residual[6].rgb * (n.z * n.x) + environment_residual[7].rgb * (s.x - s.y) +
               environment_residual[8].rgb * (3.0 * s.z - 1.0);
    vec3 three = environment_residual[9].rgb * (n.y * (3.0 * s.x - s.y)) + environment_residual[10].rgb * (n.x * n.y * n.z) +
                 environment_residual[11].rgb * (n.y * (5.0 * s.z - 1.0)) +
                 environment_residual[12].rgb * (n.z * (5.0 * s.z - 3.0)) +
                 environment_residual[13].rgb * (n.x * (5.0 * s.z - 1.0)) +
                 environment_residual[14].rgb * (n.z * (s.x - s.y)) +
                 environment_residual[15].rgb * (n.x * (s.x - 3.0 * s.y));
    return environment_rgb(max(environment_residual[0].rgb + d.x * one + d.y * two + d.z * three, vec3(0.0)));
}

float ambient_light_kappa(Frame f) { return environment_terms[0].w; }

Rgb ambient_irradiance(Frame f, Dir w) {
    vec3 n = environment_image(f, w), s = n * n;
    float d = s.x - s.y, q = 7.0 * s.z - 1.0, r = 7.0 * s.z - 3.0;
    vec3 c = environment_terms[0].rgb + environment_terms[1].rgb * n.x + environment_terms[2].rgb * n.y +
             environment_terms[3].rgb * n.z + environment_terms[4].rgb * (n.x * n.y) +
             environment_terms[5].rgb * (n.y * n.z) + environment_terms[6].rgb * (n.z * n.x) +
             environment_terms[7].rgb * d + environment_terms[8].rgb * (3.0 * s.z - 1.0) +
             environment_terms[9].rgb * (n.x * n.y * d) +
             environment_terms[10].rgb * (n.y * n.z * (3.0 * s.x - s.y)) +
             environment_terms[11].rgb * (n.x * n.y * q) + environment_terms[12].rgb * (n.y * n.z * r) +
             environment_terms[13].rgb * (s.z * (35.0 * s.z - 30.0) + 3.0) +
             environment_terms[14].rgb * (n.z * n.x * r) + environment_terms[15].rgb * (d * q) +
             environment_terms[16].rgb * (n.z * n.x * (s.x - 3.0 * s.y)) +
             environment_terms[17].rgb * (s.x * (s.x - 3.0 * s.y) - s.y * (3.0 * s.x - s.y));
    return environment_rgb(max(c, vec3(0.0)));
}

#ifdef COARSE
int ambient_light_count(Frame f) { return int(environment_merged_count.x); }
#else
int ambient_light_count(Frame f) { return int(environment_place.w); }
#endif

float ambient_diffuse(Frame f) { return environment_parts.x; }
float ambient_reflection(Frame f) { return environment_parts.y; }

/* Returns the index of the light nearest to w, or -1. The number of rounds is constant, so that compilers unroll them:
 * a variable index costs a software driver a load for each pixel. */
int ambient_nearest_light(Frame f, Dir w) {
    vec3 d = environment_image(f, w);
    float most = -2.0;
    int nearest = -1, count = ambient_light_count(f);
    for (int k = 0; k < ENVIRONMENT_LIGHTS_MOST; k++) {
        float mu = k < count ? dot(d, ENVIRONMENT_LIGHTS[2 * k].xyz) : -2.0;
        if (mu > most) nearest = k;
        most = max(most, mu);
    }
    return nearest;
}

AmbientLight ambient_light(Frame f, int k) {
    vec3 d = environment_world(ENVIRONMENT_LIGHTS[2 * k].xyz);
    AmbientLight l;
    l.w = frame_to(f, dir(d.x, d.y, d.z));
    l.color = environment_rgb(ENVIRONMENT_LIGHTS[2 * k + 1].rgb);
    l.density = ENVIRONMENT_LIGHTS[2 * k].w;
    l.light = k;
    return l;
}

int ambient_point_count(Frame f) { return int(environment_parts.z); }

AmbientLight ambient_point(Frame f, int k) {
    vec4 p = environment_points[2 * k];
    vec3 d = environment_world(p.xyz);
    AmbientLight l;
    l.light = int(p.w);
    l.w = frame_to(f, dir(d.x, d.y, d.z));
    l.color = environment_rgb(environment_points[2 * k + 1].rgb);
    l.density = environment_lights[2 * l.light].w;
    return l;
}
