#include <stdlib.h> /* before the dialect, whose abs() shadows its own */

#include "trace/lights.h"

#include "base/fail.h"
#include "scene/shade.h"
#include "trace/distribution.h"

#define TWO_PI 6.28318530717959f

/* The environment's importance map: mean luminance times solid angle on a grid that is never finer than this.
 */
enum { MAP_WIDTH_MAX = 512, MAP_HEIGHT_MAX = 256 };

typedef struct Emitter {
    uint32_t mesh, triangle;
    float area;
} Emitter;

typedef enum Group { GROUP_ENVIRONMENT, GROUP_EMITTER, GROUP_PUNCTUAL, GROUP_COUNT } Group;

struct Lights {
    const WeftScene *scene;
    Arena arena;
    float cos_turn, sin_turn; /* of the environment's rotation */
    int map_width, map_height;
    Distribution map_rows, *map_columns; /* columns: one a row */
    Emitter *emitters;
    int emitter_count;
    Distribution emitter_choice;
    uint32_t *mesh_first; /* emitter of a mesh's triangle 0, + 1; 0: emits nothing */
    Distribution punctual_choice;
    Distribution group_choice;
    bool dark; /* nothing shines */
};

/* Arrays for a distribution of n things; the weights go into cdf[1 .. n]. */
typedef struct Weights {
    float *cdf;
    uint32_t *guide;
} Weights;

static Weights weights_alloc(Arena *arena, int n) {
    return (Weights){arena_array(arena, (size_t)n + 1, sizeof(float)),
                     arena_array(arena, (size_t)n, sizeof(uint32_t))};
}

static float luminance(const float *c) { return 0.2126f * c[0] + 0.7152f * c[1] + 0.0722f * c[2]; }

/* --- environment --- */

/* World direction to the image's (u, v), and back. */
static void direction_to_map(const Lights *lights, Vec3 d, float *u, float *v) {
    float x = d.x * lights->cos_turn - d.z * lights->sin_turn,
          z = d.x * lights->sin_turn + d.z * lights->cos_turn;
    *u = 0.5f + atan2f(x, -z) / TWO_PI;
    *v = acosf(clamp(d.y, -1.0f, 1.0f)) / PI;
}

static Vec3 map_to_direction(const Lights *lights, float u, float v) {
    float phi = (u - 0.5f) * TWO_PI, theta = v * PI, s = sin(theta);
    float x = s * sin(phi), z = -s * cos(phi);
    return vec3(x * lights->cos_turn + z * lights->sin_turn, cos(theta),
                -x * lights->sin_turn + z * lights->cos_turn);
}

static Rgb environment_at(const Lights *lights, float u, float v) {
    static const Texture latlong = {.wrap_u = WRAP_REPEAT, .wrap_v = WRAP_CLAMP};
    const Environment *e = &lights->scene->environment;
    Texel t = texture_fetch(&latlong, &e->image, NULL, u, v);
    return (Rgb){t.c[0] * e->strength, t.c[1] * e->strength, t.c[2] * e->strength};
}

Rgb lights_environment(const Lights *lights, Vec3 direction) {
    const Environment *e = &lights->scene->environment;
    if (e->kind == ENVIRONMENT_CONSTANT)
        return (Rgb){e->color[0] * e->strength, e->color[1] * e->strength, e->color[2] * e->strength};
    float u, v;
    direction_to_map(lights, direction, &u, &v);
    return environment_at(lights, u, v);
}

static float group_share(const Lights *lights, Group group) {
    return lights->dark ? 0.0f : distribution_probability(&lights->group_choice, (int)group);
}

/* pdf over the sphere of a point of cell (row, column), from the density on the unit square. */
static float map_pdf(const Lights *lights, int row, int column, float v) {
    float square = distribution_probability(&lights->map_rows, row) *
                   distribution_probability(&lights->map_columns[row], column) * (float)lights->map_height *
                   (float)lights->map_width;
    return square / (TWO_PI * PI * max(sin(v * PI), 1e-6f));
}

float lights_environment_pdf(const Lights *lights, Vec3 direction) {
    float share = group_share(lights, GROUP_ENVIRONMENT);
    if (lights->scene->environment.kind == ENVIRONMENT_CONSTANT) return share / (2.0f * TWO_PI);
    if (!(share > 0.0f)) return 0.0f;
    float u, v;
    direction_to_map(lights, direction, &u, &v);
    int column = (int)clamp(u * (float)lights->map_width, 0.0f, (float)(lights->map_width - 1));
    int row = (int)clamp(v * (float)lights->map_height, 0.0f, (float)(lights->map_height - 1));
    return share * map_pdf(lights, row, column, v);
}

static LightSample sample_environment(const Lights *lights, float u, float v) {
    LightSample s = {.distance = INFINITY};
    float share = group_share(lights, GROUP_ENVIRONMENT);
    if (lights->scene->environment.kind == ENVIRONMENT_CONSTANT) {
        float z = 1.0f - 2.0f * u, r = sqrt(max(1.0f - z * z, 0.0f));
        s.wi = vec3(r * cos(TWO_PI * v), r * sin(TWO_PI * v), z);
        s.radiance = lights_environment(lights, s.wi);
        s.pdf = share / (2.0f * TWO_PI);
        return s;
    }
    Choice row = distribution_choose(&lights->map_rows, v);
    Choice column = distribution_choose(&lights->map_columns[row.index], u);
    float mu = ((float)column.index + column.rest) / (float)lights->map_width;
    float mv = ((float)row.index + row.rest) / (float)lights->map_height;
    s.wi = map_to_direction(lights, mu, mv);
    s.radiance = environment_at(lights, mu, mv);
    s.pdf = share * map_pdf(lights, row.index, column.index, mv);
    return s;
}

/* Weights of the map's cells; every cell of a map with any light gets a little, so that interpolation between
 * texels never shines where the pdf is 0. Returns the mean radiance over the sphere, or < 0 when memory is
 * short. */
static double map_make(Lights *lights) {
    const WeftImage *image = &lights->scene->environment.image;
    int w = image->width < MAP_WIDTH_MAX ? image->width : MAP_WIDTH_MAX;
    int h = image->height < MAP_HEIGHT_MAX ? image->height : MAP_HEIGHT_MAX;
    lights->map_width = w, lights->map_height = h;
    Weights rows = weights_alloc(&lights->arena, h);
    lights->map_columns = arena_array(&lights->arena, (size_t)h, sizeof(Distribution));
    double *sums = alloc_array((size_t)w * (size_t)h, sizeof(double));
    double mean = 0.0, total = 0.0;
    if (!rows.cdf || !rows.guide || !lights->map_columns || !sums) {
        free(sums);
        return -1.0;
    }
    size_t channels = (size_t)image->channels;
    for (int y = 0; y < image->height; y++) {
        const float *p = (const float *)image->pixels + (size_t)y * (size_t)image->width * channels;
        double solid = (sin)(3.14159265358979 * (y + 0.5) / image->height);
        double *row = sums + (size_t)((long long)y * h / image->height) * (size_t)w;
        for (int x = 0; x < image->width; x++, p += channels) {
            double value = (double)(channels >= 3 ? luminance(p) : p[0]) * solid;
            row[(long long)x * w / image->width] += value > 0.0 ? value : 0.0;
            total += solid;
            mean += value;
        }
    }
    mean /= total;
    for (int r = 0; r < h; r++) {
        double solid =
            (sin)(3.14159265358979 * (r + 0.5) / h) * image->width * image->height / ((double)w * h);
        Weights columns = weights_alloc(&lights->arena, w);
        if (!columns.cdf || !columns.guide) {
            mean = -1.0;
            break;
        }
        for (int c = 0; c < w; c++)
            columns.cdf[c + 1] = (float)(sums[(size_t)r * (size_t)w + (size_t)c] + 0.02 * mean * solid);
        rows.cdf[r + 1] = (float)distribution_make(&lights->map_columns[r], w, columns.cdf, columns.guide);
    }
    free(sums);
    if (mean >= 0.0) distribution_make(&lights->map_rows, h, rows.cdf, rows.guide);
    return mean;
}

/* --- emissive triangles --- */

Rgb lights_emission(const WeftScene *scene, const Material *material, float uv[2][2]) {
    static const float white[4] = {1.0f, 1.0f, 1.0f, 1.0f};
    Surface s = material_surface(scene, material, uv, white);
    float k = s.emission_strength;
    return (Rgb){s.emission.r * k, s.emission.g * k, s.emission.b * k};
}

static bool emits(const Material *material) {
    const float *e = material->inputs[INPUT_emission].value;
    return !material->unlit && (e[0] > 0.0f || e[1] > 0.0f || e[2] > 0.0f) &&
           material->inputs[INPUT_emission_strength].value[0] > 0.0f;
}

static Vec3 corner(const Mesh *mesh, uint32_t triangle, int k) {
    return vec3_load(mesh->position + 3 * (size_t)mesh->index[3 * (size_t)triangle + (size_t)k]);
}

static void corner_uv(const Mesh *mesh, uint32_t triangle, const float weight[3], float uv[2][2]) {
    for (int set = 0; set < 2; set++) {
        uv[set][0] = uv[set][1] = 0.0f;
        for (int k = 0; mesh->texcoord[set] && k < 3; k++) {
            const float *t = mesh->texcoord[set] + 2 * (size_t)mesh->index[3 * (size_t)triangle + (size_t)k];
            uv[set][0] += t[0] * weight[k], uv[set][1] += t[1] * weight[k];
        }
    }
}

/* Power of a triangle: a tenth from the plain factor, so that a texture's dark spot is never unsampled, the
 * rest from its value at four points. */
static float emitter_power(const WeftScene *scene, const Mesh *mesh, uint32_t triangle, float area) {
    static const float points[4][3] = {
        {0.333f, 0.333f, 0.334f}, {0.6f, 0.2f, 0.2f}, {0.2f, 0.6f, 0.2f}, {0.2f, 0.2f, 0.6f}};
    const Material *material = &scene->materials[mesh->material];
    const float *factor = material->inputs[INPUT_emission].value;
    float strength = material->inputs[INPUT_emission_strength].value[0], mean = 0.0f;
    for (int k = 0; k < 4; k++) {
        float uv[2][2];
        corner_uv(mesh, triangle, points[k], uv);
        Rgb e = lights_emission(scene, material, uv);
        mean += 0.25f * (0.2126f * e.r + 0.7152f * e.g + 0.0722f * e.b);
    }
    return PI * area * (0.1f * luminance(factor) * strength + 0.9f * mean) *
           (material->double_sided ? 2.0f : 1.0f);
}

static size_t count_emissive(const WeftScene *scene) {
    size_t count = 0;
    for (int m = 0; m < scene->mesh_count; m++)
        if (emits(&scene->materials[scene->meshes[m].material])) count += scene->meshes[m].triangle_count;
    return count;
}

static bool emitters_make(Lights *lights, double *power) {
    const WeftScene *scene = lights->scene;
    size_t count = count_emissive(scene);
    *power = 0.0;
    if (!count) return true;
    if (count > 1 << 30) return false;
    Weights weights = weights_alloc(&lights->arena, (int)count);
    lights->emitters = arena_array(&lights->arena, count, sizeof(Emitter));
    lights->mesh_first = arena_array(&lights->arena, (size_t)scene->mesh_count, sizeof(uint32_t));
    if (!lights->emitters || !weights.cdf || !weights.guide || !lights->mesh_first) return false;
    for (int m = 0; m < scene->mesh_count; m++) {
        const Mesh *mesh = &scene->meshes[m];
        if (!emits(&scene->materials[mesh->material])) continue;
        lights->mesh_first[m] = (uint32_t)lights->emitter_count + 1;
        for (uint32_t t = 0; t < mesh->triangle_count; t++) {
            Vec3 a = corner(mesh, t, 0);
            float area = 0.5f * vec3_length(vec3_cross(vec3_sub(corner(mesh, t, 1), a),
                                                       vec3_sub(corner(mesh, t, 2), a)));
            int k = lights->emitter_count++;
            lights->emitters[k] = (Emitter){(uint32_t)m, t, area};
            weights.cdf[k + 1] = area > 0.0f ? emitter_power(scene, mesh, t, area) : 0.0f;
        }
    }
    *power = distribution_make(&lights->emitter_choice, lights->emitter_count, weights.cdf, weights.guide);
    if (*power <= 0.0) lights->emitter_count = 0;
    return true;
}

static LightSample sample_emitter(const Lights *lights, Vec3 point, float u, float v, float w) {
    Choice choice = distribution_choose(&lights->emitter_choice, w);
    const Emitter *emitter = &lights->emitters[choice.index];
    const Mesh *mesh = &lights->scene->meshes[emitter->mesh];
    const Material *material = &lights->scene->materials[mesh->material];
    /* the square folded onto the triangle keeps well-spread points well spread better than a square root
     * does; Eric Heitz, "A Low-Distortion Map Between Triangle and Square", 2019 */
    float b1 = u, b2 = v;
    if (b2 > b1) {
        b1 *= 0.5f;
        b2 -= b1;
    } else {
        b2 *= 0.5f;
        b1 -= b2;
    }
    float weight[3] = {1.0f - b1 - b2, b1, b2}, uv[2][2];
    Vec3 a = corner(mesh, emitter->triangle, 0), b = corner(mesh, emitter->triangle, 1);
    Vec3 c = corner(mesh, emitter->triangle, 2);
    Vec3 to = vec3_sub(vec3_lerp3(a, b, c, weight[0], weight[1], weight[2]), point);
    float d2 = vec3_dot(to, to), d = sqrt(d2);
    LightSample s = {.distance = d};
    if (!(d > 0.0f)) return s;
    s.wi = vec3_scale(to, 1.0f / d);
    Vec3 n = vec3_normal_or(vec3_cross(vec3_sub(b, a), vec3_sub(c, a)), s.wi);
    float cosine = -vec3_dot(n, s.wi);
    if (cosine <= 0.0f && !material->double_sided) return s;
    corner_uv(mesh, emitter->triangle, weight, uv);
    s.radiance = lights_emission(lights->scene, material, uv);
    s.pdf = lights_triangle_pdf(lights, emitter->mesh, emitter->triangle, d, cosine);
    return s;
}

float lights_triangle_pdf(const Lights *lights, uint32_t mesh, uint32_t triangle, float t, float cosine) {
    if (!lights->emitter_count || !lights->mesh_first[mesh]) return 0.0f;
    uint32_t k = lights->mesh_first[mesh] - 1 + triangle;
    float choice = distribution_probability(&lights->emitter_choice, (int)k);
    float area = lights->emitters[k].area;
    if (!(area > 0.0f)) return 0.0f;
    return group_share(lights, GROUP_EMITTER) * choice * t * t / (area * max(abs(cosine), 1e-6f));
}

/* --- punctual lights --- */

/* The cone and window of KHR_lights_punctual (Khronos Group, 2018-2020). */
static LightSample sample_punctual(const Lights *lights, Vec3 point, float w) {
    Choice choice = distribution_choose(&lights->punctual_choice, w);
    const Light *light = &lights->scene->lights[choice.index];
    LightSample s = {.distance = INFINITY, .punctual = true};
    s.pdf = group_share(lights, GROUP_PUNCTUAL) * choice.probability;
    float scale = light->intensity;
    if (light->kind == LIGHT_DIRECTIONAL) {
        s.wi = vec3_scale(light->direction, -1.0f);
    } else {
        Vec3 to = vec3_sub(light->position, point);
        float d2 = vec3_dot(to, to), d = sqrt(d2);
        if (!(d > 0.0f)) return (LightSample){0};
        s.wi = vec3_scale(to, 1.0f / d);
        s.distance = d;
        scale /= d2;
        if (light->range > 0.0f) {
            float x = d2 / (light->range * light->range);
            scale *= clamp(1.0f - x * x, 0.0f, 1.0f);
        }
        if (light->kind == LIGHT_SPOT) {
            float c = -vec3_dot(s.wi, light->direction);
            float t =
                clamp((c - light->cos_outer) / max(light->cos_inner - light->cos_outer, 1e-3f), 0.0f, 1.0f);
            scale *= t * t;
        }
    }
    s.radiance = (Rgb){light->color[0] * scale, light->color[1] * scale, light->color[2] * scale};
    return s;
}

static bool punctual_make(Lights *lights, float radius, double *power) {
    const WeftScene *scene = lights->scene;
    *power = 0.0;
    if (!scene->light_count) return true;
    Weights weights = weights_alloc(&lights->arena, scene->light_count);
    if (!weights.cdf || !weights.guide) return false;
    for (int k = 0; k < scene->light_count; k++) {
        const Light *light = &scene->lights[k];
        float spread = light->kind == LIGHT_DIRECTIONAL ? PI * radius * radius : 2.0f * TWO_PI;
        weights.cdf[k + 1] = max(luminance(light->color) * light->intensity, 1e-6f) * spread;
    }
    *power = distribution_make(&lights->punctual_choice, scene->light_count, weights.cdf, weights.guide);
    return true;
}

/* --- all together --- */

WeftResult lights_create(const WeftScene *scene, Lights **out, WeftError *error) {
    Lights *lights = alloc_array(1, sizeof *lights);
    if (!lights) return fail(error, WEFT_MESSAGE_MEMORY, scene->name, NULL);
    const Environment *e = &scene->environment;
    lights->scene = scene;
    lights->cos_turn = cos(e->rotation);
    lights->sin_turn = sin(e->rotation);
    float radius = 0.5f * vec3_length(vec3_sub(scene->high, scene->low));
    if (!(radius > 1e-6f && radius < INFINITY)) radius = 1.0f; /* a point, or nothing at all */
    double power[GROUP_COUNT] = {0};
    double mean = e->kind == ENVIRONMENT_CONSTANT ? (double)luminance(e->color) : map_make(lights);
    bool made = mean >= 0.0 && emitters_make(lights, &power[GROUP_EMITTER]) &&
                punctual_make(lights, radius, &power[GROUP_PUNCTUAL]);
    if (!made) {
        lights_free(lights);
        return fail(error, WEFT_MESSAGE_MEMORY, scene->name, NULL);
    }
    /* what the environment sends through a sphere around the scene */
    power[GROUP_ENVIRONMENT] = mean * (double)e->strength * 4.0 * 9.8696 * (double)radius * (double)radius;
    double total = 0.0;
    for (int g = 0; g < GROUP_COUNT; g++) total += power[g];
    /* power says little about what reaches a point: no group that shines gets less than a fifth of an equal
     * share */
    Weights groups = weights_alloc(&lights->arena, GROUP_COUNT);
    if (!groups.cdf || !groups.guide) {
        lights_free(lights);
        return fail(error, WEFT_MESSAGE_MEMORY, scene->name, NULL);
    }
    for (int g = 0; g < GROUP_COUNT; g++)
        groups.cdf[g + 1] = power[g] > 0.0 ? (float)(power[g] / total + 0.2) : 0.0f;
    lights->dark = !(total > 0.0);
    distribution_make(&lights->group_choice, GROUP_COUNT, groups.cdf, groups.guide);
    *out = lights;
    return WEFT_OK;
}

void lights_free(Lights *lights) {
    if (!lights) return;
    arena_free(&lights->arena);
    free(lights);
}

LightSample lights_sample(const Lights *lights, Vec3 point, float u, float v, float w) {
    if (lights->dark) return (LightSample){0};
    Choice group = distribution_choose(&lights->group_choice, w);
    switch ((Group)group.index) {
    case GROUP_ENVIRONMENT: return sample_environment(lights, u, v);
    case GROUP_EMITTER: return sample_emitter(lights, point, u, v, group.rest);
    case GROUP_PUNCTUAL: return sample_punctual(lights, point, group.rest);
    case GROUP_COUNT: break;
    }
    return (LightSample){0};
}
