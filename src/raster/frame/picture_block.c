#include "raster/frame/picture_block.h"

#include <math.h>
#include <string.h>

#include "raster/light/depths.h"
#include "raster/light/ground.h"

/* Returns the depths of the scene, its lights and the floor in a camera's view. The least depth is 1e-4 of the
 * greatest, since cameras come close. */
static Depths camera_depths(const WeftScene *scene, const View *view, const Floor *floor) {
    const float least = 1e-4f;
    Depths depths = depths_none();
    depths_add_scene(&depths, view, scene);
    for (int k = 0; k < 4 && floor->there; k++)
        depths_add(&depths, view,
                   vec3_add(floor->middle, vec3(k & 1 ? floor->radius : -floor->radius, 0.0f,
                                                k & 2 ? floor->radius : -floor->radius)));
    depths_widen(&depths, view, fmaxf(least * depths.far, 1e-6f));
    return depths;
}

/* The depth in clip space of a distance w along the axis: a w + b, divided by w with perspective. */
typedef struct Depth {
    float a, b;
} Depth;

static Depth depth_of(const View *view, Depths r) {
    float span = r.far - r.near;
    return view->orthographic ? (Depth){2.0f / span, -(r.far + r.near) / span}
                              : (Depth){(r.far + r.near) / span, -2.0f * r.far * r.near / span};
}

/* Writes the matrix from world space less the eye to clip space: x = (q - w forward).across / |across|^2, y likewise, w
 * the depth of q. */
static void put_matrix(const View *view, Depths r, float m[16]) {
    Vec3 f = view_axis(view);
    Vec3 x = vec3_scale(view->across, 1.0f / vec3_dot(view->across, view->across));
    Vec3 y = vec3_scale(view->up, 1.0f / vec3_dot(view->up, view->up));
    x = vec3_madd(x, f, -vec3_dot(view->forward, x));
    y = vec3_madd(y, f, -vec3_dot(view->forward, y));
    const Depth depth = depth_of(view, r);
    float a = depth.a, b = depth.b;
    Vec3 w = vec3_scale(f, view->orthographic ? 0.0f : 1.0f);
    const float rows[4][4] = {{x.x, x.y, x.z, 0.0f},
                              {y.x, y.y, y.z, 0.0f},
                              {a * f.x, a * f.y, a * f.z, b},
                              {w.x, w.y, w.z, view->orthographic ? 1.0f : 0.0f}};
    for (int row = 0; row < 4; row++)
        for (int column = 0; column < 4; column++) m[4 * column + row] = rows[row][column];
}

static void put_light(const Light *light, uniform_vec4 to[4]) {
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

static void put_polygon(const LightPolygon *polygon, int k, Picture *out) {
    const float normal[4] = {polygon->normal.x, polygon->normal.y, polygon->normal.z, polygon->two_sided ? 1.0f : 0.0f};
    for (int j = 0; j < polygon->count; j++) {
        const float corner[4] = {polygon->corners[j].x, polygon->corners[j].y, polygon->corners[j].z, 0.0f};
        memcpy(out->polygon_corners[PICTURE_CORNERS * k + j], corner, sizeof corner);
    }
    for (int j = 0; j < POLYGON_POINTS; j++) {
        const bool right = j == 1 || j == 2, top = j % 2 != 0; /* points 0 and 1 lie on a diagonal, and 2 and 3 */
        const Vec3 p = shadow_point_on(polygon, right ? 0.75f : 0.25f, top ? 0.75f : 0.25f);
        const float point[4] = {p.x, p.y, p.z, polygon->area / POLYGON_POINTS};
        memcpy(out->polygon_points[POLYGON_POINTS * k + j], point, sizeof point);
    }
    memcpy(out->polygon_normals[k], normal, sizeof normal);
    memcpy(out->polygon_radiance[k], polygon->radiance, sizeof polygon->radiance);
}

/* Writes the uniforms of shadow map k; `first` is the first layer of a polygon's map. */
static void put_shadow(const Shadow *shadow, int k, int first, Picture *out) {
    const View *view = &shadow->view;
    const float place[4] = {view->eye.x, view->eye.y, view->eye.z, view->orthographic ? shadow->texel : -shadow->texel};
    const float half = vec3_length(view->across), tile = (float)SHADOW_TILE / (float)SHADOW_SIDE;
    const float soft[4] = {half, (float)first, (float)shadow->faces, tile};
    put_matrix(view, shadow->depths, out->shadow_clip[k]);
    memcpy(out->shadow_eye[k], place, sizeof place);
    memcpy(out->shadow_soft[k], soft, sizeof soft);
    for (int j = 0; j < shadow->points; j++) {
        Vec3 o = shadow->point[j];
        const float point[4] = {o.x / half, o.y / half, o.z, shadow_slope(shadow, j)};
        memcpy(out->shadow_points[SHADOW_POINTS * k + j], point, sizeof point);
    }
}

/* Writes the probabilities with which reference.glsl draws the punctual lights: by power, as trace/light/lights.c. */
static void put_chances(const WeftScene *scene, int lights, Picture *out) {
    float radius = 0.5f * vec3_length(vec3_sub(scene->high, scene->low)), power[PICTURE_LIGHTS], sum = 0.0f, end = 0.0f;
    if (!(radius > 1e-6f && radius < INFINITY)) radius = 1.0f;
    for (int k = 0; k < lights; k++) {
        const Light *light = &scene->lights[k];
        const float *c = light->color, spread = light->kind == LIGHT_DIRECTIONAL ? radius * radius : 4.0f;
        power[k] = fmaxf((c[0] + c[1] + c[2]) / 3.0f * light->intensity, 1e-6f) * spread;
        sum += power[k];
    }
    for (int k = 0; k < lights; k++) {
        end += power[k] / sum;
        out->lights[4 * k + 3][2] = end;
        out->lights[4 * k + 3][3] = power[k] / sum;
    }
}

/* Writes the uniforms of the floor. The cone of its mirror has slope 2 alpha, since a facet of slope alpha deflects a
 * ray by twice its own angle. */
static void put_floor(const WeftScene *scene, const View *view, const Floor *floor, Picture *out) {
    View below = ground_view(floor, view);
    Depth depth = depth_of(view, camera_depths(scene, &below, floor));
    float across = sqrtf(vec3_dot(view->across, view->across)), up = sqrtf(vec3_dot(view->up, view->up));
    float cone = fminf(2.0f * floor->roughness * floor->roughness, 1.0f);
    const float place[4] = {floor->middle.x, floor->middle.y, floor->middle.z, floor->radius};
    const float lens[4] = {depth.a, depth.b, 0.5f * cone / across, across / up};
    memcpy(out->floor_place, place, sizeof place);
    memcpy(out->floor_lens, lens, sizeof lens);
    out->floor_light[1] = floor->reflection;
}

void picture_make(const WeftScene *scene, const View *view, const LightPolygons *polygons, const Shadows *shadows,
                  const Floor *floor, Picture *out) {
    int lights = scene->light_count < PICTURE_LIGHTS ? scene->light_count : PICTURE_LIGHTS;
    const float eye[4] = {view->eye.x, view->eye.y, view->eye.z, view->orthographic ? 0.0f : 1.0f};
    const float forward[4] = {view->forward.x, view->forward.y, view->forward.z, (float)lights};
    *out = (Picture){0};
    put_matrix(view, camera_depths(scene, view, floor), out->to_clip);
    memcpy(out->eye, eye, sizeof eye);
    memcpy(out->forward, forward, sizeof forward);
    if (floor->there) put_floor(scene, view, floor, out);
    for (int k = 0; k < lights; k++) put_light(&scene->lights[k], &out->lights[4 * k]);
    put_chances(scene, lights, out);
    for (int k = 0; k < polygons->count; k++) put_polygon(&polygons->items[k], k, out);
    for (int k = 0; k < shadows->count; k++) {
        int light = shadows->of_light[k];
        int hard = shadows->count - shadows->polygons;
        put_shadow(&shadows->all[k], k, SHADOW_POINTS * (k - hard), out);
        if (light >= 0 && light < lights) out->lights[4 * light + 2][3] = (float)k;
    }
}

void picture_of_shadow(const Shadow *shadow, int point, Picture *out) {
    const View view = shadow_view(shadow, point);
    const float eye[4] = {view.eye.x, view.eye.y, view.eye.z, view.orthographic ? 0.0f : 1.0f};
    *out = (Picture){0};
    put_matrix(&view, shadow->depths, out->to_clip);
    memcpy(out->eye, eye, sizeof eye);
}
