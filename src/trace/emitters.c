#include <stdlib.h> /* before the dialect, whose abs() shadows its own */

#include "trace/emitters.h"

#include "scene/shade.h"
#include "trace/geometry.h"

typedef struct Emitter {
    uint32_t mesh, triangle;
    float area;
    Vec3 a, ab, ac, normal; /* a corner, two edges; unit, or 0 */
    bool even, two_sided;   /* even: it sends out the same everywhere */
    Rgb radiance;           /* if it is even */
} Emitter;

/* Returns the emission of a point times its opacity. */
static Rgb emission(const WeftScene *scene, const Material *material, const Attributes *at) {
    static const float white[4] = {1.0f, 1.0f, 1.0f, 1.0f};
    float uv[2][2];
    memcpy(uv, at->uv, sizeof uv);
    Surface s = material_plain(material);
    material_textures(scene, material, uv, white, &s);
    float k = s.emission_strength * material_opacity(scene, material, uv, at->color[3]);
    return (Rgb){s.emission.r * k, s.emission.g * k, s.emission.b * k};
}

static bool emits(const Material *material) {
    const float *e = material->inputs[INPUT_emission].value;
    return !material->unlit && (e[0] > 0.0f || e[1] > 0.0f || e[2] > 0.0f) &&
           material->inputs[INPUT_emission_strength].value[0] > 0.0f;
}

/* Returns true if neither a texture nor a vertex colour changes the emission. */
static bool is_even(const Mesh *mesh, const Material *material) {
    return !material->inputs[INPUT_emission].texture && !material->inputs[INPUT_emission_strength].texture &&
           (material->alpha_mode == WEFT_ALPHA_OPAQUE ||
            (!material->inputs[INPUT_opacity].texture && !mesh->color));
}

typedef struct Corners {
    Vec3 a, b, c;
} Corners;

static Corners corners(const Mesh *mesh, uint32_t triangle) {
    const uint32_t *index = mesh->index + 3 * (size_t)triangle;
    return (Corners){vec3_load(mesh->position + 3 * (size_t)index[0]),
                     vec3_load(mesh->position + 3 * (size_t)index[1]),
                     vec3_load(mesh->position + 3 * (size_t)index[2])};
}

static Vec3 normal_area(Corners c) { return vec3_cross(vec3_sub(c.b, c.a), vec3_sub(c.c, c.a)); }

/* A tenth from the plain factor, so that a texture's dark spot is never unsampled, the rest from its value at
 * four points. */
static float triangle_power(const WeftScene *scene, const Mesh *mesh, uint32_t triangle, float area) {
    static const float points[4][2] = {{0.333f, 0.333f}, {0.2f, 0.2f}, {0.6f, 0.2f}, {0.2f, 0.6f}};
    const Material *material = &scene->materials[mesh->material];
    const float *value = material->inputs[INPUT_emission].value;
    float factor = rgb_luminance((Rgb){value[0], value[1], value[2]}) *
                   material->inputs[INPUT_emission_strength].value[0];
    float mean = 0.0f;
    for (int k = 0; k < 4; k++) {
        Hit hit = {.triangle = triangle, .u = points[k][0], .v = points[k][1]};
        Attributes at = geometry_attributes(mesh, &hit);
        mean += 0.25f * rgb_luminance(emission(scene, material, &at));
    }
    return PI * area * (0.1f * factor + 0.9f * mean) * (material->double_sided ? 2.0f : 1.0f);
}

static Emitter emitter_of(const WeftScene *scene, int m, uint32_t triangle) {
    const Mesh *mesh = &scene->meshes[m];
    const Material *material = &scene->materials[mesh->material];
    Corners c = corners(mesh, triangle);
    Vec3 normal = normal_area(c);
    const Attributes none = {.color = {1.0f, 1.0f, 1.0f, 1.0f}};
    return (Emitter){.mesh = (uint32_t)m,
                     .triangle = triangle,
                     .area = 0.5f * vec3_length(normal),
                     .a = c.a,
                     .ab = vec3_sub(c.b, c.a),
                     .ac = vec3_sub(c.c, c.a),
                     .normal = vec3_normal_or(normal, vec3(0.0f, 0.0f, 0.0f)),
                     .even = is_even(mesh, material),
                     .two_sided = material->double_sided,
                     .radiance = emission(scene, material, &none)};
}

bool emitters_make(Emitters *emitters, const WeftScene *scene, Arena *arena) {
    *emitters = (Emitters){.scene = scene};
    size_t count = 0;
    for (int m = 0; m < scene->mesh_count; m++)
        if (emits(&scene->materials[scene->meshes[m].material])) count += scene->meshes[m].triangle_count;
    if (!count) return true;
    if (count > 1 << 30) return false;
    float *room = distribution_room(arena, distribution_size((int)count));
    float *power = alloc_array(count, sizeof(float));
    emitters->triangles = arena_array(arena, count, sizeof(Emitter));
    emitters->mesh_first = arena_array(arena, (size_t)scene->mesh_count, sizeof(uint32_t));
    bool made = room && power && emitters->triangles && emitters->mesh_first;
    for (int m = 0; made && m < scene->mesh_count; m++) {
        const Mesh *mesh = &scene->meshes[m];
        if (!emits(&scene->materials[mesh->material])) continue;
        emitters->mesh_first[m] = (uint32_t)emitters->count + 1;
        for (uint32_t t = 0; t < mesh->triangle_count; t++) {
            int k = emitters->count++;
            emitters->triangles[k] = emitter_of(scene, m, t);
            float area = emitters->triangles[k].area;
            power[k] = area > 0.0f ? triangle_power(scene, mesh, t, area) : 0.0f;
        }
    }
    bool shine = made && distribution_make(&emitters->choice, emitters->count, power, room) > 0.0;
    if (!shine) emitters->count = 0;
    free(power);
    return made;
}

static Rgb radiance_at(const WeftScene *scene, const Emitter *emitter, float u, float v) {
    const Mesh *mesh = &scene->meshes[emitter->mesh];
    Hit hit = {.triangle = emitter->triangle, .u = u, .v = v};
    Attributes at = geometry_attributes(mesh, &hit);
    return emission(scene, &scene->materials[mesh->material], &at);
}

EmitterPoint emitters_sample(const Emitters *emitters, int k, Vec3 point, float u, float v) {
    const Emitter *emitter = &emitters->triangles[k];
    /* the square folded onto the triangle; Eric Heitz, "A Low-Distortion Map Between Triangle and Square",
     * 2019 */
    float b1 = u, b2 = v;
    if (b2 > b1) {
        b1 *= 0.5f;
        b2 -= b1;
    } else {
        b2 *= 0.5f;
        b1 -= b2;
    }
    Vec3 to = vec3_sub(vec3_madd(vec3_madd(emitter->a, emitter->ab, b1), emitter->ac, b2), point);
    EmitterPoint p = {.distance = vec3_length(to)};
    if (!(p.distance > 0.0f)) return p;
    p.direction = vec3_scale(to, 1.0f / p.distance);
    float cosine = -vec3_dot(emitter->normal, p.direction);
    if (cosine <= 0.0f && !emitter->two_sided) return p;
    p.radiance = emitter->even ? emitter->radiance : radiance_at(emitters->scene, emitter, b1, b2);
    p.pdf = emitters_pdf(emitters, emitter->mesh, emitter->triangle, p.distance, cosine);
    return p;
}

void emitters_sample_rows(const Emitters *emitters, int n, const float *const point[3], const float *u,
                          const float *v, LightRows *samples) {
    for (int k = 0; k < n; k++) {
        Choice triangle = distribution_choose(&emitters->choice, u[k]);
        Vec3 at = vec3(point[0][k], point[1][k], point[2][k]);
        EmitterPoint p = emitters_sample(emitters, triangle.index, at, triangle.rest, v[k]);
        samples->wi[0][k] = p.direction.x, samples->wi[1][k] = p.direction.y,
        samples->wi[2][k] = p.direction.z;
        samples->radiance[0][k] = p.radiance.r;
        samples->radiance[1][k] = p.radiance.g;
        samples->radiance[2][k] = p.radiance.b;
        samples->pdf[k] = p.pdf;
        samples->distance[k] = p.distance;
    }
}

float emitters_pdf(const Emitters *emitters, uint32_t mesh, uint32_t triangle, float t, float cosine) {
    if (!emitters->count || !emitters->mesh_first[mesh]) return 0.0f;
    uint32_t k = emitters->mesh_first[mesh] - 1 + triangle;
    float area = emitters->triangles[k].area;
    if (!(area > 0.0f)) return 0.0f;
    return distribution_probability(&emitters->choice, (int)k) * t * t / (area * max(abs(cosine), 1e-6f));
}
