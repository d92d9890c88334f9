#include <stdlib.h> /* before the dialect, whose abs() shadows its own */

#include "trace/light/lights.h"

#include "base/fail.h"
#include "shading/area/punctual.h"
#include "trace/light/emitters.h"
#include "trace/light/sky.h"

struct Lights {
    const WeftScene *scene;
    Arena arena;
    Sky sky;
    Emitters emitters;
    Distribution punctual;
    bool has_group[LIGHT_GROUPS];
};

static LightSample sample_punctual(const Lights *lights, Vec3 point, float w) {
    Choice choice = distribution_choose(&lights->punctual, w);
    const Light *light = &lights->scene->lights[choice.index];
    LightSample s = {.distance = INFINITY, .punctual = true, .pdf = choice.probability};
    float scale = light->intensity;
    if (light->kind == LIGHT_DIRECTIONAL) {
        s.wi = vec3_scale(light->direction, -1.0f);
    } else {
        Vec3 to = vec3_sub(light->position, point);
        float d2 = vec3_dot(to, to), d = sqrt(d2);
        if (!(d > 0.0f)) return (LightSample){0};
        s.wi = vec3_scale(to, 1.0f / d);
        s.distance = d;
        scale *= punctual_distance(d2, light->range);
        if (light->kind == LIGHT_SPOT)
            scale *= punctual_cone(-vec3_dot(s.wi, light->direction), light->cos_inner, light->cos_outer);
    }
    s.radiance = (Rgb){light->color[0] * scale, light->color[1] * scale, light->color[2] * scale};
    return s;
}

/* Makes the distribution of punctual lights by power, W; that of a directional light is what passes through a sphere
 * around the scene. Returns false if memory is short. */
static bool punctual_make(Lights *lights) {
    const WeftScene *scene = lights->scene;
    int count = scene->light_count;
    if (!count) return true;
    float radius = 0.5f * vec3_length(vec3_sub(scene->high, scene->low));
    if (!(radius > 1e-6f && radius < INFINITY)) radius = 1.0f; /* a point, or nothing at all */
    float *storage = distribution_alloc(&lights->arena, distribution_size(count));
    float *power = alloc_array((size_t)count, sizeof(float));
    for (int k = 0; storage && power && k < count; k++) {
        const Light *light = &scene->lights[k];
        const float *c = light->color;
        float spread = light->kind == LIGHT_DIRECTIONAL ? PI * radius * radius : 4.0f * PI;
        power[k] = max((c[0] + c[1] + c[2]) / 3.0f * light->intensity, 1e-6f) * spread;
    }
    bool made = storage && power;
    if (made) distribution_make(&lights->punctual, count, power, storage);
    free(power);
    return made;
}

WeftResult lights_create(const WeftScene *scene, Lights **out, WeftError *error) {
    Lights *lights = alloc_array(1, sizeof *lights);
    if (!lights) return fail(error, WEFT_MESSAGE_MEMORY, scene->name, NULL);
    lights->scene = scene;
    if (!sky_make(&lights->sky, &scene->environment, &lights->arena) ||
        !emitters_make(&lights->emitters, scene, &lights->arena) || !punctual_make(lights)) {
        lights_free(lights);
        return fail(error, WEFT_MESSAGE_MEMORY, scene->name, NULL);
    }
    lights->has_group[LIGHTS_SKY] = lights->sky.mean * (double)scene->environment.strength > 0.0;
    lights->has_group[LIGHTS_EMITTERS] = lights->emitters.count > 0;
    lights->has_group[LIGHTS_PUNCTUAL] = scene->light_count > 0;
    *out = lights;
    return WEFT_OK;
}

void lights_free(Lights *lights) {
    if (!lights) return;
    arena_free(&lights->arena);
    free(lights);
}

static LightSample from_sky(SkyPoint p) { return (LightSample){p.direction, INFINITY, p.radiance, p.pdf, false, true}; }

bool lights_has_group(const Lights *lights, LightGroup group) { return lights->has_group[group]; }

/* Samples the emitters by a row of which all lanes are this point. */
static LightSample sample_emitters(const Emitters *emitters, Vec3 point, Vec3 normal, float u, float v) {
    float same[8][ROW_LANES];
    const float of[] = {point.x, point.y, point.z, normal.x, normal.y, normal.z, u, v};
    for (int a = 0; a < 8; a++)
        for (int k = 0; k < ROW_LANES; k++) same[a][k] = of[a];
    const float *const points[] = {same[0], same[1], same[2]}, *const normals[] = {same[3], same[4], same[5]};
    LightRows rows;
    emitters_sample_rows(emitters, ROW_LANES, points, normals, same[6], same[7], &rows);
    return (LightSample){.wi = vec3(rows.wi[0][0], rows.wi[1][0], rows.wi[2][0]),
                         .distance = rows.distance[0],
                         .radiance = {rows.radiance[0][0], rows.radiance[1][0], rows.radiance[2][0]},
                         .pdf = rows.pdf[0]};
}

LightSample lights_sample(const Lights *lights, LightGroup group, Vec3 point, Vec3 normal, float u, float v) {
    if (group == LIGHTS_SKY) return from_sky(sky_sample(&lights->sky, u, v));
    if (group == LIGHTS_EMITTERS) return sample_emitters(&lights->emitters, point, normal, u, v);
    return sample_punctual(lights, point, u);
}

static void put_sample(LightRows *rows, int k, const LightSample *s) {
    rows->wi[0][k] = s->wi.x, rows->wi[1][k] = s->wi.y, rows->wi[2][k] = s->wi.z;
    rows->radiance[0][k] = s->radiance.r;
    rows->radiance[1][k] = s->radiance.g;
    rows->radiance[2][k] = s->radiance.b;
    rows->pdf[k] = s->pdf;
    rows->distance[k] = min(s->distance, LIGHT_FAR);
}

void lights_sample_rows(const Lights *lights, LightGroup group, int n, const float *const point[3],
                        const float *const normal[3], const float *u, const float *v, LightRows *samples) {
    if (group == LIGHTS_SKY) sky_sample_rows(&lights->sky, n, u, v, samples);
    if (group == LIGHTS_EMITTERS) emitters_sample_rows(&lights->emitters, n, point, normal, u, v, samples);
    for (int k = 0; group == LIGHTS_PUNCTUAL && k < n; k++) {
        Vec3 p = vec3(point[0][k], point[1][k], point[2][k]);
        LightSample s = sample_punctual(lights, p, u[k]);
        put_sample(samples, k, &s);
    }
}

void lights_environment_rows(const Lights *lights, int n, const float *const d[3], LightRows *found) {
    sky_at_rows(&lights->sky, n, d, found);
    for (int k = 0; !lights->has_group[LIGHTS_SKY] && k < n; k++) found->pdf[k] = 0.0f;
}

LightSample lights_environment(const Lights *lights, Vec3 direction) {
    LightSample s = from_sky(sky_at(&lights->sky, direction));
    if (!lights->has_group[LIGHTS_SKY]) s.pdf = 0.0f;
    return s;
}

float lights_triangle_pdf(const Lights *lights, uint32_t mesh, uint32_t triangle, Vec3 point, Vec3 normal, float t,
                          float cosine) {
    return emitters_pdf(&lights->emitters, mesh, triangle, point, normal, t, cosine);
}
