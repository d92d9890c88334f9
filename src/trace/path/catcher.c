#include "trace/path/catcher.h"

#include "shading/dialect/rgb.h"
#include "shading/terms/d_ggx.h"
#include "trace/geometry/sampler.h"

/* Adds one light sample of a group at a point of a white floor. share: the floor's coverage there. */
static void add_light(const PathContext *context, LightGroup group, Vec3 point, float share, Point uv, uint32_t key,
                      Caught *caught, long long *rays) {
    LightSample light = lights_sample(context->lights, group, point, vec3(0, 1, 0), uv.u, uv.v);
    if (!(light.pdf > 0.0f) || !(light.wi.y > 0.0f)) return;
    float whole = rgb_luminance(light.radiance) * light.wi.y / light.pdf;
    if (!(whole > 0.0f && whole < INFINITY)) return;
    Ray shadow = {point, light.wi, 0.0f, light.distance * (1.0f - 1e-4f), key, false};
    *rays += context->shadows;
    bool hidden = context->shadows && geometry_occluded(context->geometry, shadow);
    caught->whole += whole;
    caught->reached += hidden ? whole * (1.0f - share) : whole;
}

/* Traces a ray that the floor mirrors, spread by its roughness; returns false if it misses the scene. */
static bool mirror(const PathContext *context, const Floor *floor, Vec3 point, const Ray *ray, Point uv,
                   Mirrored *found, long long *rays) {
    float alpha = max(floor->roughness * floor->roughness, 0.001f);
    Dir o = dir(-ray->direction.x, -ray->direction.z, -ray->direction.y); /* z is up here */
    Dir i = dir_mirror(o, ggx_sample_h(alpha, alpha, o, uv.u, uv.v));
    found->ray = (Ray){point, vec3(i.x, i.z, i.y), 0.0f, INFINITY, hash32(ray->key + 0x9e3779b9u), ray->past_lights};
    if (!(i.z > 0.0f)) return false;
    ++*rays;
    return geometry_hit(context->geometry, found->ray, &found->hit);
}

static Point draw_numbers(PathKey key, uint32_t place) {
    return sampler_point(key.pixel, key.sample, SAMPLER_FLOOR + place);
}

bool catcher_sample(const PathContext *context, const Floor *floor, const CatcherRay *from, const float behind[4],
                    Caught *caught, float sum[4], Mirrored *mirrored, long long *rays) {
    const Ray *ray = &from->ray;
    Vec3 point = vec3_madd(ray->origin, ray->direction, from->t);
    float share = floor_coverage(floor, point), r = share * floor->reflection, c = 0.0f;
    for (uint32_t g = 0; g < LIGHT_GROUPS; g++)
        if (lights_has_group(context->lights, (LightGroup)g))
            add_light(context, (LightGroup)g, point, share, draw_numbers(from->key, g), hash32(ray->key), caught, rays);
    if (r > 0.0f && mirror(context, floor, point, ray, draw_numbers(from->key, LIGHT_GROUPS), mirrored, rays)) c = r;
    for (int k = 0; k < 3; k++) {
        float seen = behind[k] * (1.0f - c);
        caught->behind[k] += seen;
        sum[k] += seen;
    }
    caught->clear += (1.0f - behind[3]) * (1.0f - c);
    sum[3] += 1.0f - (1.0f - behind[3]) * (1.0f - c);
    mirrored->share = c;
    return c > 0.0f;
}

void catcher_resolve(const Caught *caught, float sum[4]) {
    if (!(caught->whole > 0.0f)) return;
    float lost = 1.0f - caught->reached / caught->whole;
    for (int k = 0; k < 3; k++) sum[k] -= caught->behind[k] * lost;
    sum[3] += caught->clear * lost;
}
