#include "raster/light/shadow.h"

#include <epoxy/gl.h>
#include <math.h>
#include <stddef.h>
#include <string.h>

#include "base/fail.h"
#include "base/pi.h"
#include "raster/gl/box.h"
#include "raster/gl/gl_check.h"

/* Returns true if some of a mesh is on a side of a polygon that emits light; the polygon's own mesh is not. */
static bool is_lit(const Mesh *mesh, const LightPolygon *polygon) {
    const float least = 1e-3f * sqrtf(polygon->area);
    for (uint32_t k = 0; k < mesh->vertex_count; k++) {
        Vec3 from = vec3_sub(vec3_load(mesh->position + 3 * (size_t)k), polygon->corners[0]);
        float above = vec3_dot(from, polygon->normal);
        if ((polygon->two_sided ? fabsf(above) : above) > least) return true;
    }
    return false;
}

/* Returns the box of the scene's own meshes smaller than a size, and sets the size of the largest among them. Only
 * those that a polygon lights count, unless it is NULL. */
static Box smaller_box(const WeftScene *scene, const LightPolygon *polygon, float size, float *largest) {
    Box sum = box_empty();
    *largest = 0.0f;
    for (int m = 0; m < scene_own_meshes(scene); m++) {
        if (polygon && !is_lit(&scene->meshes[m], polygon)) continue;
        Box box = mesh_box(&scene->meshes[m]);
        if (!(box_size(box) < size)) continue;
        *largest = fmaxf(*largest, box_size(box));
        box_add(&sum, box.low);
        box_add(&sum, box.high);
    }
    return sum;
}

/* Returns the box that shadow maps cover: the scene without its stage, a mesh at least four times as large as all
 * others together, such as a floor to the horizon, and without meshes that a polygon does not light. The origin if
 * there is none. */
static Box find_casters(const WeftScene *scene, const LightPolygon *polygon) {
    const float stage = 4.0f;
    float largest, next;
    Box casters = smaller_box(scene, polygon, INFINITY, &largest);
    if (!(largest > 0.0f)) return (Box){{0.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 0.0f}};
    for (;;) {
        Box rest = smaller_box(scene, polygon, largest, &next);
        if (!(next > 0.0f) || largest <= stage * box_size(rest)) return casters;
        casters = rest;
        largest = next;
    }
}

/* Returns depths that hold in all directions. least: the first of them, over that of the farthest caster. */
static Depths depths_around(const WeftScene *scene, Vec3 eye, Box casters, float least) {
    const Box boxes[2] = {casters, {scene->low, scene->high}};
    const float hair = scene_hair_reach(scene);
    float far[2] = {0.0f, 0.0f};
    for (int k = 0; k < 16; k++)
        far[k / 8] = fmaxf(far[k / 8], vec3_length(vec3_sub(box_corner(boxes[k / 8], k % 8), eye)));
    return (Depths){.near = least * (1.01f * (far[0] + hair) + 1e-6f),
                    .far = 1.01f * (fmaxf(far[0], far[1]) + hair) + 1e-6f};
}

/* Returns the depths of the scene and its lights from all points of a light, which look along one axis. With
 * perspective most of the precision is near the eye, so depths begin at 1e-2 of the distance to the farthest caster at
 * least, however far a stage reaches. */
static Depths depths_of(const WeftScene *scene, const Shadow *shadow, Box casters) {
    const float least = 1e-2f;
    if (shadow->faces) return depths_around(scene, shadow->view.eye, casters, least);
    Depths all = depths_none(), here = depths_none();
    float back = 0.0f, front = 0.0f;
    depths_add_scene(&all, &shadow->view, scene);
    depths_add_box(&here, &shadow->view, casters);
    for (int k = 0; k < shadow->points; k++) {
        back = fminf(back, shadow->point[k].z);
        front = fmaxf(front, shadow->point[k].z);
    }
    all.near -= front;
    all.far -= back;
    depths_widen(&all, &shadow->view, fmaxf(least * (here.far - back), 1e-6f));
    return all;
}

/* Sets two axes across a direction. */
static void across(Vec3 forward, Vec3 *right, Vec3 *up) {
    Vec3 pole = fabsf(forward.y) < 0.99f ? vec3(0.0f, 1.0f, 0.0f) : vec3(1.0f, 0.0f, 0.0f);
    *right = vec3_normal_or(vec3_cross(forward, pole), vec3(1.0f, 0.0f, 0.0f));
    *up = vec3_cross(*right, forward);
}

static Vec3 along(Vec3 v, Vec3 right, Vec3 up, Vec3 forward) {
    return vec3(vec3_dot(v, right), vec3_dot(v, up), vec3_dot(v, forward));
}

static Shadow of_directional(const Light *light, Box casters) {
    Vec3 right, up, middle = vec3_scale(vec3_add(casters.low, casters.high), 0.5f);
    float radius = 0.5f * box_size(casters) + 1e-6f;
    across(light->direction, &right, &up);
    return (Shadow){.view = {.eye = middle,
                             .forward = light->direction,
                             .across = vec3_scale(right, radius),
                             .up = vec3_scale(up, radius),
                             .orthographic = true},
                    .texel = 2.0f * radius / SHADOW_SIDE};
}

/* Returns the map of an eye that looks along a direction, `half` to either side at distance 1. */
static Shadow with_perspective(Vec3 eye, Vec3 forward, float half) {
    Vec3 right, up;
    across(forward, &right, &up);
    return (Shadow){
        .view = {.eye = eye, .forward = forward, .across = vec3_scale(right, half), .up = vec3_scale(up, half)},
        .texel = 2.0f * half / SHADOW_SIDE};
}

static Shadow of_spot(const Light *light) {
    float cosine = fmaxf(light->cos_outer, 0.1f);
    return with_perspective(light->position, light->direction, sqrtf(1.0f - cosine * cosine) / cosine * 1.02f);
}

/* Half of the width of the widest map at distance 1. */
static const float HALF_MOST = 6.0f;

/* Returns a cube of maps about an eye, each a little wider than its face. */
static Shadow with_faces(Vec3 eye) {
    const float half = 1.01f;
    return (Shadow){
        .view = {.eye = eye, .forward = {0.0f, 0.0f, 1.0f}, .across = {-half, 0.0f, 0.0f}, .up = {0.0f, half, 0.0f}},
        .texel = 2.0f * half / SHADOW_TILE,
        .faces = SHADOW_FACES};
}

/* Returns the map of a point light: one view that has all casters, or a cube where that would be as coarse. */
static Shadow of_point(const Light *light, Box casters) {
    const Vec3 down = {0.0f, -1.0f, 0.0f}, middle = vec3_scale(vec3_add(casters.low, casters.high), 0.5f);
    const Vec3 forward = vec3_normal_or(vec3_sub(middle, light->position), down);
    Vec3 right, up;
    float half = 1e-3f;
    across(forward, &right, &up);
    for (int k = 0; k < 8; k++) {
        const Vec3 c = along(vec3_sub(box_corner(casters, k), light->position), right, up, forward);
        const float wide = fmaxf(fabsf(c.x), fabsf(c.y));
        half = fmaxf(half, c.z * HALF_MOST > wide ? 1.02f * wide / c.z : HALF_MOST);
    }
    return half < 3.0f ? with_perspective(light->position, forward, half) : with_faces(light->position);
}

static Shadow of_punctual(const Light *light, Box casters) {
    if (light->kind == LIGHT_DIRECTIONAL) return of_directional(light, casters);
    return light->kind == LIGHT_SPOT ? of_spot(light) : of_point(light, casters);
}

static float strength(const Light *light) {
    return light->intensity * (light->color[0] + light->color[1] + light->color[2]);
}

/* Returns the strongest light of a kind that has no map yet, or -1. The kinds are chosen in turn, since a sun and a
 * lamp cannot be compared. */
static int strongest(const WeftScene *scene, const Shadows *shadows, LightKind kind) {
    int best = -1;
    for (int k = 0; k < scene->light_count; k++) {
        bool there = false;
        for (int j = 0; j < shadows->count; j++) there |= shadows->of_light[j] == k;
        if (there || scene->lights[k].kind != kind || !(strength(&scene->lights[k]) > 0.0f)) continue;
        if (best < 0 || strength(&scene->lights[k]) > strength(&scene->lights[best])) best = k;
    }
    return best;
}

static void add(Shadows *self, const WeftScene *scene, Box casters, Shadow shadow, int light, int polygon) {
    shadow.depths = depths_of(scene, &shadow, casters);
    self->of_light[self->count] = light;
    self->of_polygon[self->count] = polygon;
    self->all[self->count++] = shadow;
}

static void choose_lights(const WeftScene *scene, int most, Box casters, Shadows *self) {
    static const LightKind kinds[] = {LIGHT_DIRECTIONAL, LIGHT_SPOT, LIGHT_POINT};
    enum { KINDS = sizeof kinds / sizeof *kinds };
    for (int n = 0, missed = 0; self->count < most && missed < KINDS; n++) {
        int k = strongest(scene, self, kinds[n % KINDS]);
        missed = k < 0 ? missed + 1 : 0;
        if (k >= 0) add(self, scene, casters, of_punctual(&scene->lights[k], casters), k, -1);
    }
}

/* Chooses a triangle of the fan about the first corner and a point in it: Greg Turk, "Generating Random Points in
 * Triangles", Graphics Gems, 1990. */
Vec3 shadow_point_on(const LightPolygon *polygon, float u, float v) {
    const Vec3 *corners = polygon->corners;
    Vec3 a = corners[0], across = vec3_sub(corners[1], a), up = vec3_sub(corners[polygon->count - 1], a);
    Vec3 fourth = vec3_add(vec3_add(a, across), up);
    if (polygon->count == 4 && vec3_length(vec3_sub(fourth, corners[2])) < 1e-3f * sqrtf(polygon->area))
        return vec3_madd(vec3_madd(a, across, u), up, v);
    float area = u * polygon->area;
    for (int k = 1;; k++) {
        Vec3 b = vec3_sub(corners[k], a), c = vec3_sub(corners[k + 1], a);
        float part = 0.5f * vec3_length(vec3_cross(b, c));
        if (k + 2 < polygon->count && area > part) {
            area -= part;
            continue;
        }
        float root = sqrtf(fminf(area / part, 1.0f));
        return vec3_madd(vec3_madd(a, b, root * (1.0f - v)), c, root * v);
    }
}

float shadow_slope(const Shadow *self, int point) {
    return self->meeting / (1.0f - self->point[point].z * self->meeting);
}

/* Returns half the width at distance 1 of the map in which every point o sees all corners c of a box, or 0 if a corner
 * is behind a point. With axes as in glsl/soft_shadow.glsl and d = 1 / meeting, the place of c is (c - o).xy / (c -
 * o).z + o.xy / (d - o.z). */
static float half_width(const Shadow *self, const Vec3 corners[8]) {
    float half = 0.0f;
    for (int k = 0; k < 8 * self->points; k++) {
        Vec3 o = self->point[k / 8], c = vec3_sub(corners[k % 8], o);
        float slope = shadow_slope(self, k / 8);
        if (!(c.z > 0.05f * vec3_length(c) && slope > 0.0f)) return 0.0f;
        half = fmaxf(half, fmaxf(fabsf(c.x / c.z + slope * o.x), fabsf(c.y / c.z + slope * o.y)));
    }
    return half;
}

/* Returns the shadow map of a polygon with layers of side x side texels, from its middle towards the casters. It contains
 * all of them, unless the polygon is among them. */
static Shadow of_polygon(const LightPolygon *polygon, Box casters, int side) {
    Vec3 eye = {0}, right, up, corners[8], middle = vec3_scale(vec3_add(casters.low, casters.high), 0.5f);
    for (int k = 0; k < polygon->count; k++) eye = vec3_madd(eye, polygon->corners[k], 1.0f / (float)polygon->count);
    Vec3 to = vec3_sub(middle, eye);
    float distance = vec3_length(to);
    bool faces = polygon->two_sided || vec3_dot(to, polygon->normal) > 0.3f * distance;
    Vec3 forward = faces ? vec3_normal_or(to, polygon->normal) : polygon->normal;
    across(forward, &right, &up);
    Shadow self = {.points = SHADOW_POINTS, .meeting = faces && distance > 0.0f ? 1.0f / distance : 0.0f};
    for (int k = 0; k < self.points; k++) {
        const float n = SHADOW_POINTS, u = ((float)k + 0.5f) / n, v = ((float)(k * 34 % SHADOW_POINTS) + 0.5f) / n;
        self.point[k] = along(vec3_sub(shadow_point_on(polygon, u, v), eye), right, up, forward);
    }
    for (int k = 0; k < 8; k++) corners[k] = along(vec3_sub(box_corner(casters, k), eye), right, up, forward);
    float half = half_width(&self, corners);
    if (!(half > 0.0f && half < HALF_MOST)) self.meeting = 0.0f, half = HALF_MOST;
    self.view = (View){.eye = eye, .forward = forward, .across = vec3_scale(right, half), .up = vec3_scale(up, half)};
    self.texel = 2.0f * half / (float)side;
    return self;
}

int shadow_view_count(const Shadow *self) {
    if (self->points) return self->points;
    return self->faces ? self->faces : 1;
}

/* Returns a direction of the face along z as that of another face. */
static Vec3 on_face(Vec3 v, int face) {
    const Vec3 w = face % 2 ? vec3(-v.x, v.y, -v.z) : v;
    const Vec3 by_axis[] = {{w.z, w.x, w.y}, {w.y, w.z, w.x}, w};
    return by_axis[face / 2];
}

View shadow_view(const Shadow *self, int point) {
    View view = self->view;
    if (self->faces) {
        view.forward = on_face(view.forward, point);
        view.across = on_face(view.across, point);
        view.up = on_face(view.up, point);
    }
    if (!self->points) return view;
    Vec3 o = self->point[point], right = vec3_normal_or(view.across, view.across),
         up = vec3_normal_or(view.up, view.up);
    float slope = shadow_slope(self, point);
    view.eye = vec3_madd(vec3_madd(vec3_madd(view.eye, right, o.x), up, o.y), view.forward, o.z);
    view.forward = vec3_madd(vec3_madd(view.forward, right, -slope * o.x), up, -slope * o.y);
    return view;
}

/* Returns the side of the layers with which the maps of `polygons` polygons take the memory of one at most. */
static int point_side(int polygons) {
    const int multiple = 8;
    int side = SHADOW_POINT_SIDE;
    while (polygons * side * side > SHADOW_POINT_SIDE * SHADOW_POINT_SIDE) side -= multiple;
    return side;
}

static void choose(const WeftScene *scene, const LightPolygons *polygons, Shadows *self) {
    int half = SHADOWS_MOST / 2, wanted = polygons->count < half ? polygons->count : half;
    choose_lights(scene, SHADOWS_MOST - wanted, find_casters(scene, NULL), self);
    const int left = SHADOWS_MOST - self->count, maps = polygons->count < left ? polygons->count : left;
    self->point_side = point_side(maps);
    for (int k = 0; k < maps; k++, self->polygons++) {
        const LightPolygon *polygon = &polygons->items[k];
        Box casters = find_casters(scene, polygon);
        add(self, scene, casters, of_polygon(polygon, casters, self->point_side), -1, k);
    }
}

static bool same_map(const Shadow *a, const Shadow *b) {
    bool same = memcmp(&a->view, &b->view, offsetof(View, orthographic)) == 0 &&
                a->view.orthographic == b->view.orthographic && a->points == b->points && a->faces == b->faces;
    for (int k = 0; k < a->points && same; k++)
        same = a->point[k].x == b->point[k].x && a->point[k].y == b->point[k].y && a->point[k].z == b->point[k].z;
    return same && a->meeting == b->meeting && a->depths.near == b->depths.near && a->depths.far == b->depths.far;
}

static void delete_objects(Shadows *self) {
    glDeleteTextures(1, &self->hard);
    glDeleteTextures(1, &self->soft);
    glDeleteFramebuffers(1, &self->framebuffer);
    glDeleteSamplers(1, &self->compare);
    self->hard = self->soft = self->framebuffer = self->compare = 0;
    self->drawn = false;
}

static unsigned make_layers(GLint format, GLenum type, int side, int layers) {
    unsigned texture;
    if (!layers) return 0;
    glGenTextures(1, &texture);
    glBindTexture(GL_TEXTURE_2D_ARRAY, texture);
    texture_unfiltered(GL_TEXTURE_2D_ARRAY);
    glTexImage3D(GL_TEXTURE_2D_ARRAY, 0, format, side, side, layers, 0, GL_DEPTH_COMPONENT, type, NULL);
    return texture;
}

static void make_objects(Shadows *self) {
    self->hard = make_layers(GL_DEPTH_COMPONENT32F, GL_FLOAT, SHADOW_SIDE, self->count - self->polygons);
    self->soft = make_layers(GL_DEPTH_COMPONENT16, GL_UNSIGNED_SHORT, self->point_side, SHADOW_POINTS * self->polygons);
    glGenFramebuffers(1, &self->framebuffer);
    glGenSamplers(1, &self->compare);
    glSamplerParameteri(self->compare, GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
    glSamplerParameteri(self->compare, GL_TEXTURE_COMPARE_FUNC, GL_LEQUAL);
    glSamplerParameteri(self->compare, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    glSamplerParameteri(self->compare, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    glSamplerParameteri(self->compare, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glSamplerParameteri(self->compare, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
}

WeftResult shadows_create(const WeftScene *scene, const LightPolygons *polygons, Shadows *out, WeftError *error) {
    *out = (Shadows){0};
    return shadows_update(out, scene, polygons, error);
}

WeftResult shadows_update(Shadows *self, const WeftScene *scene, const LightPolygons *polygons, WeftError *error) {
    Shadows old = *self;
    self->count = self->polygons = 0;
    choose(scene, polygons, self);
    for (int k = 0; k < self->count; k++) self->drawn &= same_map(&self->all[k], &old.all[k]);
    if (self->count == old.count && self->polygons == old.polygons) return WEFT_OK;
    delete_objects(self);
    if (self->count) make_objects(self);
    WeftResult result = gl_check(error, "shadows");
    if (result == WEFT_OK) return WEFT_OK;
    delete_objects(self);
    self->count = self->polygons = 0;
    return result;
}

void shadows_destroy(Shadows *self) {
    delete_objects(self);
    *self = (Shadows){0};
}

void shadows_begin(const Shadows *self, int k, int point) {
    static const GLenum none = GL_NONE;
    const int hard = self->count - self->polygons, layer = k < hard ? k : SHADOW_POINTS * (k - hard) + point;
    const bool tiled = self->all[k].faces > 0;
    const int side = tiled ? SHADOW_TILE : k < hard ? SHADOW_SIDE : self->point_side;
    glBindFramebuffer(GL_FRAMEBUFFER, self->framebuffer);
    glFramebufferTextureLayer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, k < hard ? self->hard : self->soft, 0, layer);
    glDrawBuffers(1, &none);
    glReadBuffer(GL_NONE);
    glViewport(tiled ? point % 3 * side : 0, tiled ? point / 3 * side : 0, side, side);
    if (!tiled || point == 0) glClear(GL_DEPTH_BUFFER_BIT);
}

static void bind(unsigned texture, unsigned sampler, int unit) {
    glActiveTexture(GL_TEXTURE0 + (GLenum)unit);
    glBindTexture(GL_TEXTURE_2D_ARRAY, texture);
    glBindSampler((GLuint)unit, sampler);
}

void shadows_bind(const Shadows *self, int hard_unit, int soft_unit) {
    bind(self->hard, self->compare, hard_unit);
    bind(self->soft, self->compare, soft_unit);
    glActiveTexture(GL_TEXTURE0);
}
