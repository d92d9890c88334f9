#include "raster/picture.h"

#include <math.h>
#include <string.h>

typedef struct Range {
    float near, far;
} Range;

/* From the nearest to the farthest corner of the scene's box, along the axis of the view. */
static Range depth_range(const WeftScene *scene, const View *view) {
    float near = INFINITY, far = -INFINITY;
    for (int k = 0; k < 8; k++) {
        Vec3 corner = {k & 1 ? scene->high.x : scene->low.x, k & 2 ? scene->high.y : scene->low.y,
                       k & 4 ? scene->high.z : scene->low.z};
        float depth = vec3_dot(vec3_sub(corner, view->eye), view->forward);
        near = fminf(near, depth);
        far = fmaxf(far, depth);
    }
    float margin = 1e-3f * fmaxf(far - near, 1e-6f) + 1e-6f;
    near -= margin;
    far += margin;
    if (view->orthographic) return (Range){near, far};
    far = fmaxf(far, 1e-5f);
    return (Range){fmaxf(near, 1e-4f * far), far};
}

/* q, from the eye, to clip space: x = q.across / |across|^2, likewise y, w the depth. */
static void put_matrix(const WeftScene *scene, const View *view, float m[16]) {
    Range r = depth_range(scene, view);
    Vec3 x = vec3_scale(view->across, 1.0f / vec3_dot(view->across, view->across));
    Vec3 y = vec3_scale(view->up, 1.0f / vec3_dot(view->up, view->up)), f = view->forward;
    float span = r.far - r.near;
    float a = view->orthographic ? 2.0f / span : (r.far + r.near) / span;
    float b = view->orthographic ? -(r.far + r.near) / span : -2.0f * r.far * r.near / span;
    Vec3 w = vec3_scale(f, view->orthographic ? 0.0f : 1.0f);
    const float rows[4][4] = {{x.x, x.y, x.z, 0.0f},
                              {y.x, y.y, y.z, 0.0f},
                              {a * f.x, a * f.y, a * f.z, b},
                              {w.x, w.y, w.z, view->orthographic ? 1.0f : 0.0f}};
    for (int row = 0; row < 4; row++)
        for (int column = 0; column < 4; column++) m[4 * column + row] = rows[row][column];
}

static void put_light(const Light *light, float to[4][4]) {
    const float place[4] = {light->position.x, light->position.y, light->position.z, (float)light->kind};
    const float along[4] = {light->direction.x, light->direction.y, light->direction.z, light->range};
    const float *c = light->color;
    const float color[4] = {c[0] * light->intensity, c[1] * light->intensity, c[2] * light->intensity, -1.0f};
    const float cone[4] = {light->cos_inner, light->cos_outer, 0.0f, 0.0f};
    memcpy(to[0], place, sizeof place);
    memcpy(to[1], along, sizeof along);
    memcpy(to[2], color, sizeof color);
    memcpy(to[3], cone, sizeof cone);
}

static void put_shadow(const WeftScene *scene, const Shadow *shadow, float clip[16], float eye[4]) {
    const View *view = &shadow->view;
    const float place[4] = {view->eye.x, view->eye.y, view->eye.z,
                            view->orthographic ? shadow->texel : -shadow->texel};
    put_matrix(scene, view, clip);
    memcpy(eye, place, sizeof place);
}

void picture_make(const WeftScene *scene, const View *view, const Shadows *shadows, Picture *out) {
    int lights = scene->light_count < PICTURE_LIGHTS_MOST ? scene->light_count : PICTURE_LIGHTS_MOST;
    const float eye[4] = {view->eye.x, view->eye.y, view->eye.z, view->orthographic ? 0.0f : 1.0f};
    const float forward[4] = {view->forward.x, view->forward.y, view->forward.z, (float)lights};
    *out = (Picture){0};
    put_matrix(scene, view, out->to_clip);
    memcpy(out->eye, eye, sizeof eye);
    memcpy(out->forward, forward, sizeof forward);
    for (int k = 0; k < lights; k++) put_light(&scene->lights[k], out->lights[k]);
    for (int k = 0; shadows && k < shadows->count; k++) {
        put_shadow(scene, &shadows->all[k], out->shadow_clip[k], out->shadow_eye[k]);
        if (shadows->of_light[k] < lights) out->lights[shadows->of_light[k]][2][3] = (float)k;
    }
}
