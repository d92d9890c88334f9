/* depths.h - nearest and farthest depth of objects along the axis of a view */
#pragma once

#include "raster/gl/box.h"
#include "scene/record/camera.h"

typedef struct Depths {
    float near, far; /* m, from the eye */
} Depths;

/* Returns the unit normal of a view's picture plane, away from the eye: its forward, unless the view is sheared. */
static inline Vec3 view_axis(const View *view) {
    return vec3_normal_or(vec3_cross(view->up, view->across), view->forward);
}

static inline Depths depths_none(void) { return (Depths){INFINITY, -INFINITY}; }

static inline void depths_add(Depths *depths, const View *view, Vec3 p) {
    float depth = vec3_dot(vec3_sub(p, view->eye), view_axis(view));
    depths->near = fminf(depths->near, depth);
    depths->far = fmaxf(depths->far, depth);
}

static inline void depths_add_box(Depths *depths, const View *view, Box box) {
    for (int k = 0; k < 8; k++) depths_add(depths, view, box_corner(box, k));
}

/* Adds a scene, its hair and its lights. */
static inline void depths_add_scene(Depths *depths, const View *view, const WeftScene *scene) {
    const float reach = scene_hair_reach(scene);
    const Vec3 around = {reach, reach, reach};
    depths_add_box(depths, view, (Box){vec3_sub(scene->low, around), vec3_add(scene->high, around)});
    for (int m = scene_light_meshes(scene); m < scene->mesh_count; m++)
        for (uint32_t k = 0; k < scene->meshes[m].vertex_count; k++)
            depths_add(depths, view, vec3_load(scene->meshes[m].position + 3 * (size_t)k));
}

/* Widens depths by a margin for rounding, since a plane that faces the eye has no depth of its own. With perspective
 * they then begin at `least`, above 0, or beyond. */
static inline void depths_widen(Depths *depths, const View *view, float least) {
    const float rounding = 1e-5f * fmaxf(fabsf(depths->near), fabsf(depths->far));
    const float margin = 1e-3f * (depths->far - depths->near) + rounding + 1e-6f;
    depths->near -= margin;
    depths->far += margin;
    if (view->orthographic) return;
    depths->near = fmaxf(depths->near, least);
    depths->far = fmaxf(depths->far, 2.0f * least);
}
