#include <stdlib.h> /* before the dialect, whose abs() shadows its own */

#include "trace/lights.h"

#include "base/fail.h"
#include "shading/punctual.h"
#include "trace/emitters.h"
#include "trace/sky.h"

typedef enum Group { GROUP_SKY, GROUP_EMITTERS, GROUP_PUNCTUAL, GROUP_COUNT } Group;

struct Lights {
    const WeftScene *scene;
    Arena arena;
    Sky sky;
    Emitters emitters;
    Distribution punctual;
    Distribution groups;
    bool dark; /* nothing shines */
};

static float share(const Lights *lights, Group group) {
    return lights->dark ? 0.0f : distribution_probability(&lights->groups, (int)group);
}

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

/* radius: of the scene, through which a directional light's beam passes. */
static bool punctual_make(Lights *lights, float radius, double *power) {
    const WeftScene *scene = lights->scene;
    if (!scene->light_count) return true;
    Step *steps = arena_array(&lights->arena, (size_t)scene->light_count + 1, sizeof(Step));
    if (!steps) return false;
    for (int k = 0; k < scene->light_count; k++) {
        const Light *light = &scene->lights[k];
        const float *c = light->color;
        float spread = light->kind == LIGHT_DIRECTIONAL ? PI * radius * radius : 4.0f * PI;
        steps[k + 1].cdf = max((c[0] + c[1] + c[2]) / 3.0f * light->intensity, 1e-6f) * spread;
    }
    *power = distribution_make(&lights->punctual, scene->light_count, steps);
    return true;
}

/* Power says little about what reaches a point: every group that shines gets the same part on top of its own.
 */
static bool groups_make(Lights *lights, const double power[GROUP_COUNT]) {
    double total = 0.0;
    Step *steps = arena_array(&lights->arena, GROUP_COUNT + 1, sizeof(Step));
    if (!steps) return false;
    for (int g = 0; g < GROUP_COUNT; g++) total += power[g];
    for (int g = 0; g < GROUP_COUNT; g++)
        steps[g + 1].cdf = power[g] > 0.0 ? (float)(power[g] / total + 0.2) : 0.0f;
    lights->dark = !(distribution_make(&lights->groups, GROUP_COUNT, steps) > 0.0);
    return true;
}

WeftResult lights_create(const WeftScene *scene, Lights **out, WeftError *error) {
    Lights *lights = alloc_array(1, sizeof *lights);
    if (!lights) return fail(error, WEFT_MESSAGE_MEMORY, scene->name, NULL);
    lights->scene = scene;
    float radius = 0.5f * vec3_length(vec3_sub(scene->high, scene->low));
    if (!(radius > 1e-6f && radius < INFINITY)) radius = 1.0f; /* a point, or nothing at all */
    double power[GROUP_COUNT] = {0};
    bool made = sky_make(&lights->sky, &scene->environment, &lights->arena) &&
                emitters_make(&lights->emitters, scene, &lights->arena) &&
                punctual_make(lights, radius, &power[GROUP_PUNCTUAL]);
    /* what the environment sends through a sphere around the scene */
    power[GROUP_SKY] = lights->sky.mean * (double)scene->environment.strength * 4.0 * 9.8696 *
                       (double)radius * (double)radius;
    power[GROUP_EMITTERS] = lights->emitters.power;
    if (!made || !groups_make(lights, power)) {
        lights_free(lights);
        return fail(error, WEFT_MESSAGE_MEMORY, scene->name, NULL);
    }
    *out = lights;
    return WEFT_OK;
}

void lights_free(Lights *lights) {
    if (!lights) return;
    arena_free(&lights->arena);
    free(lights);
}

static LightSample from_sky(SkyPoint p) {
    return (LightSample){p.direction, INFINITY, p.radiance, p.pdf, false, true};
}

LightSample lights_sample(const Lights *lights, Vec3 point, float u, float v) {
    LightSample s = {0};
    if (lights->dark) return s;
    Choice group = distribution_choose(&lights->groups, u);
    switch ((Group)group.index) {
    case GROUP_SKY: s = from_sky(sky_sample(&lights->sky, group.rest, v)); break;
    case GROUP_EMITTERS: {
        /* u goes on to choose the triangle; what it has left after that is u of the point */
        Choice triangle = distribution_choose(&lights->emitters.choice, group.rest);
        EmitterPoint p = emitters_sample(&lights->emitters, triangle.index, point, triangle.rest, v);
        s = (LightSample){p.direction, p.distance, p.radiance, p.pdf, false, false};
        break;
    }
    case GROUP_PUNCTUAL: s = sample_punctual(lights, point, group.rest); break;
    case GROUP_COUNT: break;
    }
    s.pdf *= group.probability;
    return s;
}

LightSample lights_environment(const Lights *lights, Vec3 direction) {
    LightSample s = from_sky(sky_at(&lights->sky, direction));
    s.pdf *= share(lights, GROUP_SKY);
    return s;
}

float lights_triangle_pdf(const Lights *lights, uint32_t mesh, uint32_t triangle, float t, float cosine) {
    return share(lights, GROUP_EMITTERS) * emitters_pdf(&lights->emitters, mesh, triangle, t, cosine);
}
