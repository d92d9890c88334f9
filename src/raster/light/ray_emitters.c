#include <stdlib.h> /* before the dialect, whose abs() shadows its own */

#include "raster/light/ray_emitters.h"

#include "base/memory.h"
#include "raster/light/triangle_points.h"
#include "scene/light/polygons.h"
#include "scene/record/material_at.h"

enum { STEPS = 6 }; /* the mean over a triangle takes STEPS^2 points */

static float mixed(const float *values, const uint32_t *index, int width, int channel, const float weight[3]) {
    float sum = 0.0f;
    for (int k = 0; k < 3; k++) sum += weight[k] * values[(size_t)width * index[k] + (size_t)channel];
    return sum;
}

/* Adds emission times opacity at a point of a triangle to sum. */
static void add_emission(const WeftScene *scene, const Mesh *mesh, const uint32_t *index, const float weight[3],
                         float sum[3]) {
    static const float white[4] = {1.0f, 1.0f, 1.0f, 1.0f};
    const Material *material = &scene->materials[mesh->material];
    float uv[2][2] = {{0}};
    for (int set = 0; set < 2; set++)
        for (int a = 0; a < 2 && mesh->texcoord[set]; a++) uv[set][a] = mixed(mesh->texcoord[set], index, 2, a, weight);
    Surface s = material_plain(material);
    material_textures(scene, material, uv, white, &s);
    const float alpha = mesh->color ? mixed(mesh->color, index, 4, 3, weight) : 1.0f;
    const float k = s.emission_strength * material_opacity(scene, material, uv, alpha);
    sum[0] += k * s.emission.r, sum[1] += k * s.emission.g, sum[2] += k * s.emission.b;
}

/* Sets the mean radiance over a triangle, by points at the middles of its parts. */
static void find_radiance(const WeftScene *scene, const Mesh *mesh, RayEmitter *emitter) {
    const Material *material = &scene->materials[mesh->material];
    const bool even =
        !material->inputs[INPUT_emission].texture && !material->inputs[INPUT_emission_strength].texture &&
        (material->alpha_mode == WEFT_ALPHA_OPAQUE || (!material->inputs[INPUT_opacity].texture && !mesh->color));
    const int steps = even ? 1 : STEPS;
    const uint32_t *index = mesh->index + 3 * (size_t)emitter->triangle;
    for (int k = 0; k < steps * steps; k++) {
        float weight[3];
        triangle_point(k, steps, weight);
        add_emission(scene, mesh, index, weight, emitter->radiance);
    }
    for (int c = 0; c < 3; c++) emitter->radiance[c] /= (float)(steps * steps);
}

static RayEmitter emitter_of(const WeftScene *scene, uint32_t m, uint32_t triangle) {
    const Mesh *mesh = &scene->meshes[m];
    const uint32_t *index = mesh->index + 3 * (size_t)triangle;
    const Vec3 a = vec3_load(mesh->position + 3 * (size_t)index[0]);
    RayEmitter emitter = {.mesh = m,
                          .triangle = triangle,
                          .a = a,
                          .ab = vec3_sub(vec3_load(mesh->position + 3 * (size_t)index[1]), a),
                          .ac = vec3_sub(vec3_load(mesh->position + 3 * (size_t)index[2]), a),
                          .two_sided = scene->materials[mesh->material].double_sided};
    emitter.area = 0.5f * vec3_length(vec3_cross(emitter.ab, emitter.ac));
    find_radiance(scene, mesh, &emitter);
    return emitter;
}

/* Sets the probabilities. Returns false if no emitter has any power. */
static bool distribute(RayEmitters *self) {
    double sum = 0.0, running = 0.0;
    for (int k = 0; k < self->count; k++) {
        RayEmitter *emitter = &self->all[k];
        const float *c = emitter->radiance;
        emitter->probability =
            emitter->area * (0.2126f * c[0] + 0.7152f * c[1] + 0.0722f * c[2]) * (emitter->two_sided ? 2.0f : 1.0f);
        sum += (double)emitter->probability;
    }
    for (int k = 0; k < self->count; k++) {
        self->all[k].probability = (float)((double)self->all[k].probability / sum);
        running += (double)self->all[k].probability;
        self->all[k].until = k + 1 < self->count ? (float)running : 1.0f;
    }
    return sum > 0.0;
}

bool ray_emitters_find(RayEmitters *self, const WeftScene *scene) {
    size_t count = 0;
    *self = (RayEmitters){0};
    for (int m = 0; m < scene->mesh_count; m++)
        if (material_emits(&scene->materials[scene->meshes[m].material])) count += scene->meshes[m].triangle_count;
    if (!count) return true;
    self->all = count < INT32_MAX ? alloc_array(count, sizeof(RayEmitter)) : NULL;
    if (!self->all) return false;
    for (int m = 0; m < scene->mesh_count; m++) {
        const Mesh *mesh = &scene->meshes[m];
        for (uint32_t t = 0; material_emits(&scene->materials[mesh->material]) && t < mesh->triangle_count; t++)
            self->all[self->count++] = emitter_of(scene, (uint32_t)m, t);
    }
    if (!distribute(self)) ray_emitters_free(self);
    return true;
}

void ray_emitters_free(RayEmitters *self) {
    free(self->all);
    *self = (RayEmitters){0};
}
