#include <stdlib.h> /* before the dialect, whose abs() shadows its own */

#include "trace/light/emitters.h"

#include "scene/record/material_at.h"
#include "shading/dialect/loop.h"
#include "trace/geometry/geometry.h"

/* An emissive triangle. */
typedef struct Emitter {
    uint32_t mesh, triangle;
    float area;   /* m^2 */
    Vec3 a;       /* a corner */
    Vec3 ab, ac;  /* two edges */
    Vec3 normal;  /* unit, or 0 */
    bool uniform; /* emits the same radiance everywhere */
    bool two_sided;
    Rgb radiance; /* if uniform */
} Emitter;

/* The columns of an emitter in its row of numbers. */
enum {
    EMITTER_A = 0,
    EMITTER_AB = 3,
    EMITTER_AC = 6,
    EMITTER_NORMAL = 9,
    EMITTER_RADIANCE = 12,
    EMITTER_AREA = 15,
    EMITTER_TWO_SIDED = 16, /* 1, or 0 */
    EMITTER_FLOATS = 17
};

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
static bool is_uniform(const Mesh *mesh, const Material *material) {
    return !material->inputs[INPUT_emission].texture && !material->inputs[INPUT_emission_strength].texture &&
           (material->alpha_mode == WEFT_ALPHA_OPAQUE || (!material->inputs[INPUT_opacity].texture && !mesh->color));
}

typedef struct Corners {
    Vec3 a, b, c;
} Corners;

static Corners corners(const Mesh *mesh, uint32_t triangle) {
    const uint32_t *index = mesh->index + 3 * (size_t)triangle;
    return (Corners){vec3_load(mesh->position + 3 * (size_t)index[0]), vec3_load(mesh->position + 3 * (size_t)index[1]),
                     vec3_load(mesh->position + 3 * (size_t)index[2])};
}

static Vec3 normal_area(Corners c) { return vec3_cross(vec3_sub(c.b, c.a), vec3_sub(c.c, c.a)); }

/* Returns the power of a triangle, W, as far as luminance goes: nine tenths from its emission at four points, and a
 * tenth from the factor without textures, so that no bright spot between the points stays unsampled. */
static float triangle_power(const WeftScene *scene, const Mesh *mesh, uint32_t triangle, float area) {
    static const float points[4][2] = {{0.333f, 0.333f}, {0.2f, 0.2f}, {0.6f, 0.2f}, {0.2f, 0.6f}};
    const Material *material = &scene->materials[mesh->material];
    const float *value = material->inputs[INPUT_emission].value;
    float factor =
        rgb_luminance((Rgb){value[0], value[1], value[2]}) * material->inputs[INPUT_emission_strength].value[0];
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
                     .uniform = is_uniform(mesh, material),
                     .two_sided = material->double_sided,
                     .radiance = emission(scene, material, &none)};
}

static void put_numbers(const Emitter *e, float *numbers) {
    const Vec3 vectors[] = {e->a, e->ab, e->ac, e->normal, {e->radiance.r, e->radiance.g, e->radiance.b}};
    for (int k = 0; k < 5; k++) {
        numbers[3 * k] = vectors[k].x;
        numbers[3 * k + 1] = vectors[k].y;
        numbers[3 * k + 2] = vectors[k].z;
    }
    numbers[EMITTER_AREA] = e->area;
    numbers[EMITTER_TWO_SIDED] = e->two_sided ? 1.0f : 0.0f;
}

static Vec3 corner_of(const Emitter *e, int k) { return k == 0 ? e->a : vec3_add(e->a, k == 1 ? e->ab : e->ac); }

static LightBounds bounds_of(const Emitter *e, float power) {
    LightBounds bounds = {
        .low = e->a, .high = e->a, .axis = e->normal, .cos_spread = 1.0f, .power = power, .two_sided = e->two_sided};
    for (int k = 1; k < 3; k++) {
        Vec3 c = corner_of(e, k);
        bounds.low = vec3_least(bounds.low, c);
        bounds.high = vec3_most(bounds.high, c);
    }
    return bounds;
}

/* Appends the triangles of a mesh; returns their power. */
static float add_mesh(Emitters *emitters, int m, LightBounds *bounds) {
    const WeftScene *scene = emitters->scene;
    const Mesh *mesh = &scene->meshes[m];
    float sum = 0.0f;
    emitters->mesh_first[m] = (uint32_t)emitters->count + 1;
    for (uint32_t t = 0; t < mesh->triangle_count; t++) {
        int k = emitters->count++;
        Emitter *e = &emitters->triangles[k];
        *e = emitter_of(scene, m, t);
        emitters->uniform &= e->uniform;
        put_numbers(e, emitters->numbers + (size_t)EMITTER_FLOATS * (size_t)k);
        float power = e->area > 0.0f ? triangle_power(scene, mesh, t, e->area) : 0.0f;
        bounds[k] = bounds_of(e, power);
        sum += power;
    }
    return sum;
}

bool emitters_make(Emitters *emitters, const WeftScene *scene, Arena *arena) {
    *emitters = (Emitters){.scene = scene, .uniform = true};
    size_t count = 0;
    for (int m = 0; m < scene->mesh_count; m++)
        if (emits(&scene->materials[scene->meshes[m].material])) count += scene->meshes[m].triangle_count;
    if (!count) return true;
    if (count > INT32_MAX / (2 * EMITTER_FLOATS)) return false; /* an int counts their numbers */
    LightBounds *bounds = alloc_array(count, sizeof(LightBounds));
    emitters->triangles = arena_array(arena, count, sizeof(Emitter));
    emitters->numbers = arena_array(arena, count * EMITTER_FLOATS, sizeof(float));
    emitters->mesh_first = arena_array(arena, (size_t)scene->mesh_count, sizeof(uint32_t));
    bool made = bounds && emitters->triangles && emitters->numbers && emitters->mesh_first;
    float power = 0.0f;
    for (int m = 0; made && m < scene->mesh_count; m++)
        if (emits(&scene->materials[scene->meshes[m].material])) power += add_mesh(emitters, m, bounds);
    if (!(power > 0.0f)) emitters->count = 0;
    if (emitters->count) made = light_tree_make(&emitters->tree, emitters->count, bounds, arena);
    free(bounds);
    return made;
}

static Rgb radiance_at(const WeftScene *scene, const Emitter *emitter, float u, float v) {
    const Mesh *mesh = &scene->meshes[emitter->mesh];
    Hit hit = {.triangle = emitter->triangle, .u = u, .v = v};
    Attributes at = geometry_attributes(mesh, &hit);
    return emission(scene, &scene->materials[mesh->material], &at);
}

/* Gives the barycentric weights of a point of a triangle, onto which the unit square is folded. Eric Heitz, "A
 * Low-Distortion Map Between Triangle and Square", 2019. */
FN void fold(float u, float v, float *b1, float *b2) {
    float half = 0.5f * min(u, v);
    *b1 = u - half;
    *b2 = v - half;
}

/* Returns the density over solid angle, 1/sr, of a point chosen uniformly over an area, seen from the distance t. */
FN float solid_pdf(float t2, float area, float cosine) { return t2 / (area * max(abs(cosine), 1e-6f)); }

/* Emitters chosen with u. */
typedef struct ChosenRows {
    int emitter[ROW_CAPACITY];
    float probability[ROW_CAPACITY];
    float u[ROW_CAPACITY]; /* position in the emitter's interval, in [0, 1) */
} ChosenRows;

/* Samples points of the chosen emitters. */
LOOP(sample_n,
     (const float *numbers, int n, const float *const point[3], const float *v, const ChosenRows *chosen,
      LightRows *restrict s),
     (numbers, n, point, v, chosen, s)) {
    const float *px = point[0], *py = point[1], *pz = point[2];
    EACH(k, (size_t)n) {
        int e = EMITTER_FLOATS * chosen->emitter[k];
        float b1, b2;
        fold(chosen->u[k], v[k], &b1, &b2);
        float x = numbers[e] + numbers[e + 3] * b1 + numbers[e + 6] * b2 - px[k];
        float y = numbers[e + 1] + numbers[e + 4] * b1 + numbers[e + 7] * b2 - py[k];
        float z = numbers[e + 2] + numbers[e + 5] * b1 + numbers[e + 8] * b2 - pz[k];
        float t2 = x * x + y * y + z * z;
        bool away = t2 > 1e-30f;
        float t = sqrt(away ? t2 : 1.0f), r = 1.0f / t;
        float cosine = -(x * numbers[e + 9] + y * numbers[e + 10] + z * numbers[e + 11]) * r;
        bool live = away & ((cosine > 0.0f) | (numbers[e + EMITTER_TWO_SIDED] > 0.0f));
        s->wi[0][k] = x * r;
        s->wi[1][k] = y * r;
        s->wi[2][k] = z * r;
        s->radiance[0][k] = numbers[e + 12];
        s->radiance[1][k] = numbers[e + 13];
        s->radiance[2][k] = numbers[e + 14];
        float visible = live ? 1.0f : 0.0f; /* a choice would put look-ups in a branch */
        s->pdf[k] = visible * chosen->probability[k] * solid_pdf(t2, numbers[e + EMITTER_AREA], cosine);
        s->distance[k] = t;
    }
}

void emitters_sample_rows(const Emitters *emitters, int n, const float *const point[3], const float *const normal[3],
                          const float *u, const float *v, LightRows *samples) {
    ChosenRows chosen;
    memcpy(chosen.u, u, (size_t)n * sizeof *u);
    light_tree_choose_rows(&emitters->tree, n, point, normal, chosen.u, chosen.emitter, chosen.probability);
    sample_n(emitters->numbers, n, point, v, &chosen, samples);
    for (int k = 0; !emitters->uniform && k < n; k++) {
        const Emitter *e = &emitters->triangles[chosen.emitter[k]];
        float b1, b2;
        fold(chosen.u[k], v[k], &b1, &b2);
        Rgb c = e->uniform ? e->radiance : radiance_at(emitters->scene, e, b1, b2);
        samples->radiance[0][k] = c.r, samples->radiance[1][k] = c.g, samples->radiance[2][k] = c.b;
    }
}

float emitters_pdf(const Emitters *emitters, uint32_t mesh, uint32_t triangle, Vec3 point, Vec3 normal, float t,
                   float cosine) {
    if (!emitters->count || !emitters->mesh_first[mesh]) return 0.0f;
    int k = (int)(emitters->mesh_first[mesh] - 1 + triangle);
    float area = emitters->triangles[k].area;
    if (!(area > 0.0f)) return 0.0f;
    return light_tree_probability(&emitters->tree, k, point, normal) * solid_pdf(t * t, area, cosine);
}
