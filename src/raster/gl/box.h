/* box.h - a box about points, along the axes */
#pragma once

#include "scene/record/scene.h"

typedef struct Box {
    Vec3 low, high;
} Box;

static inline Box box_empty(void) { return (Box){{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}}; }

static inline void box_add(Box *box, Vec3 p) {
    box->low = vec3_least(box->low, p);
    box->high = vec3_most(box->high, p);
}

/* Returns corner k of 8. */
static inline Vec3 box_corner(Box box, int k) {
    return vec3(k & 1 ? box.high.x : box.low.x, k & 2 ? box.high.y : box.low.y, k & 4 ? box.high.z : box.low.z);
}

/* Returns the length of the diagonal; 0 of an empty box. */
static inline float box_size(Box box) {
    return box.low.x > box.high.x ? 0.0f : vec3_length(vec3_sub(box.high, box.low));
}

static inline Box mesh_box(const Mesh *mesh) {
    Box box = box_empty();
    for (uint32_t k = 0; k < mesh->vertex_count; k++) box_add(&box, vec3_load(mesh->position + 3 * (size_t)k));
    return box;
}
