#include "raster/light/merged_lights.h"

#include <math.h>

#include "shading/dialect/rgb.h"

/* A light, with the luminance that it has of each of the environment's. */
typedef struct LightCluster {
    EnvLight light;
    float luminance, of[AMBIENT_LIGHTS_MAX];
} LightCluster;

/* Returns how much further the light of two groups lies from their mean direction than from that of each. */
static float added_spread(const LightCluster *a, const LightCluster *b) {
    const Vec3 d = vec3_sub(a->light.direction, b->light.direction);
    return a->luminance * b->luminance / fmaxf(a->luminance + b->luminance, 1e-30f) * vec3_dot(d, d);
}

static LightCluster merged(const LightCluster *a, const LightCluster *b) {
    LightCluster sum = *a;
    const float all = fmaxf(a->luminance + b->luminance, 1e-30f);
    const Vec3 both =
        vec3_add(vec3_scale(a->light.direction, a->luminance), vec3_scale(b->light.direction, b->luminance));
    sum.luminance = a->luminance + b->luminance;
    sum.light.spread = (a->luminance * a->light.spread + b->luminance * b->light.spread + added_spread(a, b)) / all;
    sum.light.direction = vec3_normal_or(both, a->light.direction);
    for (int c = 0; c < 3; c++) sum.light.color[c] += b->light.color[c];
    for (int k = 0; k < AMBIENT_LIGHTS_MAX; k++) sum.of[k] += b->of[k];
    return sum;
}

/* Merges the two groups that spread least together. */
static void merge_two(LightCluster *groups, int count) {
    int first = 0, second = 1;
    for (int a = 0; a < count; a++)
        for (int b = a + 1; b < count; b++)
            if (added_spread(&groups[a], &groups[b]) < added_spread(&groups[first], &groups[second]))
                first = a, second = b;
    groups[first] = merged(&groups[first], &groups[second]);
    groups[second] = groups[count - 1];
}

_Static_assert((int)AMBIENT_LIGHTS <= (int)MERGED_OF, "each light of a picture is known to its group");

int merged_lights(const AmbientParts *parts, MergedLight out[MERGED_LIGHTS]) {
    LightCluster groups[AMBIENT_LIGHTS_MAX];
    int count = parts->env_light_count;
    for (int k = 0; k < count; k++) {
        const EnvLight *light = &parts->env_lights[k];
        const float *c = light->color;
        groups[k] = (LightCluster){.light = *light, .luminance = rgb_luminance(rgb(c[0], c[1], c[2]))};
        groups[k].of[k] = groups[k].luminance;
    }
    for (; count > MERGED_LIGHTS; count--) merge_two(groups, count);
    for (int j = 0; j < count; j++) {
        float known = 1e-30f;
        out[j].light = groups[j].light;
        for (int k = 0; k < MERGED_OF; k++) known += groups[j].of[k];
        for (int k = 0; k < MERGED_OF; k++) out[j].of[k] = groups[j].of[k] / known;
    }
    return count;
}
