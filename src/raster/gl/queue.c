#include "raster/gl/queue.h"

#include <stdlib.h>

#include "base/fail.h"
#include "raster/gl/box.h"
#include "scene/material/hair.h"

static void measure(Queue *self, const WeftScene *scene, int m) {
    const Mesh *mesh = &scene->meshes[m];
    const Box box = mesh->vertex_count ? mesh_box(mesh) : (Box){{0.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 0.0f}};
    self->middle[m] = vec3_scale(vec3_add(box.low, box.high), 0.5f);
    self->reach[m] = 0.5f * box_size(box);
}

static bool blends(const WeftScene *scene, int m) {
    return hair_is_mesh(scene, m) || scene->materials[scene->meshes[m].material].alpha_mode == WEFT_ALPHA_BLEND;
}

WeftResult queue_create(const WeftScene *scene, Queue *out, WeftError *error) {
    size_t count = (size_t)scene->mesh_count;
    *out = (Queue){.order = alloc_array(count, sizeof(int)),
                   .depth = alloc_array(count, sizeof(float)),
                   .middle = alloc_array(count, sizeof(Vec3)),
                   .reach = alloc_array(count, sizeof(float))};
    if (!out->order || !out->depth || !out->middle || !out->reach) {
        queue_destroy(out);
        return fail(error, WEFT_MESSAGE_MEMORY, scene->name, NULL);
    }
    for (int m = 0; m < scene->mesh_count; m++) measure(out, scene, m);
    queue_update(out, scene);
    return WEFT_OK;
}

/* Returns true if opaque meshes still come before blended ones. */
static bool is_partitioned(const Queue *self, const WeftScene *scene) {
    bool good = self->count == scene->mesh_count;
    for (int k = 0; k < self->count; k++) good &= blends(scene, self->order[k]) == (k >= self->solid);
    return good;
}

void queue_update(Queue *self, const WeftScene *scene) {
    if (is_partitioned(self, scene)) return;
    self->count = 0;
    for (int m = 0; m < scene->mesh_count; m++)
        if (!blends(scene, m)) self->order[self->count++] = m;
    self->solid = self->count;
    for (int m = 0; m < scene->mesh_count; m++)
        if (blends(scene, m)) self->order[self->count++] = m;
}

WeftResult queue_reshape(Queue *self, const WeftScene *scene, WeftError *error) {
    Queue fresh;
    if (self->count == scene->mesh_count) {
        for (int m = scene_own_meshes(scene); m < scene->mesh_count; m++) measure(self, scene, m);
        return WEFT_OK;
    }
    WeftResult result = queue_create(scene, &fresh, error);
    if (result != WEFT_OK) return result;
    queue_destroy(self);
    *self = fresh;
    return WEFT_OK;
}

void queue_destroy(Queue *self) {
    free(self->order);
    free(self->depth);
    free(self->middle);
    free(self->reach);
    *self = (Queue){0};
}

/* Sorts by insertion, which is fast since the order is nearly that of the picture before. */
static void sort(Queue *self, int first, int end, float sign) {
    for (int k = first + 1; k < end; k++) {
        int mesh = self->order[k], j = k;
        for (; j > first && sign * self->depth[self->order[j - 1]] > sign * self->depth[mesh]; j--)
            self->order[j] = self->order[j - 1];
        self->order[j] = mesh;
    }
}

void queue_sort(Queue *self, const WeftScene *scene, const View *view) {
    for (int m = 0; m < self->count; m++) {
        float depth = vec3_dot(vec3_sub(self->middle[m], view->eye), view->forward);
        /* solid meshes by their far ends, so that a floor comes last though it begins nearest */
        self->depth[m] = blends(scene, m) ? depth : depth + self->reach[m];
    }
    sort(self, 0, self->solid, 1.0f);
    sort(self, self->solid, self->count, -1.0f);
}
