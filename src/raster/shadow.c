#include "raster/shadow.h"

#include <epoxy/gl.h>
#include <math.h>
#include <stddef.h>
#include <string.h>

#include "base/fail.h"
#include "base/pi.h"
#include "raster/box.h"
#include "raster/gl_check.h"

/* The box of the scene's own meshes smaller than a size, and the largest among them. */
static Box smaller_box(const WeftScene *scene, float size, float *largest) {
    Box sum = box_empty();
    *largest = 0.0f;
    for (int m = 0; m < scene_own_meshes(scene); m++) {
        Box box = mesh_box(&scene->meshes[m]);
        if (!(box_size(box) < size)) continue;
        *largest = fmaxf(*largest, box_size(box));
        box_add(&sum, box.low);
        box_add(&sum, box.high);
    }
    return sum;
}

/* Returns the box that shadow maps cover: the scene without its stage, a mesh many times as large as all
 * others together, such as a floor to the horizon. */
static Box find_casters(const WeftScene *scene) {
    const float stage = 4.0f;
    float largest, next;
    Box casters = smaller_box(scene, INFINITY, &largest);
    for (;;) {
        Box rest = smaller_box(scene, largest, &next);
        if (!(next > 0.0f) || largest <= stage * box_size(rest)) return casters;
        casters = rest;
        largest = next;
    }
}

/* Two axes across a direction. */
static void across(Vec3 forward, Vec3 *right, Vec3 *up) {
    Vec3 pole = fabsf(forward.y) < 0.99f ? vec3(0.0f, 1.0f, 0.0f) : vec3(1.0f, 0.0f, 0.0f);
    *right = vec3_normal_or(vec3_cross(forward, pole), vec3(1.0f, 0.0f, 0.0f));
    *up = vec3_cross(*right, forward);
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

static Shadow of_spot(const Light *light) {
    Vec3 right, up;
    float cosine = fmaxf(light->cos_outer, 0.1f), half = sqrtf(1.0f - cosine * cosine) / cosine * 1.02f;
    across(light->direction, &right, &up);
    return (Shadow){.view = {.eye = light->position,
                             .forward = light->direction,
                             .across = vec3_scale(right, half),
                             .up = vec3_scale(up, half)},
                    .texel = 2.0f * half / SHADOW_SIDE};
}

static float strength(const Light *light) {
    return light->kind == LIGHT_POINT
               ? -1.0f
               : light->intensity * (light->color[0] + light->color[1] + light->color[2]);
}

/* The strongest of a kind that is not there yet, or -1. A sun and a spot cannot be compared, so kinds take
 * turns. */
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

static void add(Shadows *self, Shadow shadow, int light, int polygon) {
    self->of_light[self->count] = light;
    self->of_polygon[self->count] = polygon;
    self->all[self->count++] = shadow;
}

static void choose_lights(const WeftScene *scene, int most, Box casters, Shadows *self) {
    for (int turn = 0, missed = 0; self->count < most && missed < 2; turn++) {
        LightKind kind = turn % 2 ? LIGHT_SPOT : LIGHT_DIRECTIONAL;
        int k = strongest(scene, self, kind);
        missed = k < 0 ? missed + 1 : 0;
        if (k < 0) continue;
        const Light *light = &scene->lights[k];
        add(self, kind == LIGHT_SPOT ? of_spot(light) : of_directional(light, casters), k, -1);
    }
}

/* From the middle of the polygon towards the casters, all of which it sees unless it is within. */
static Shadow of_polygon(const LightPolygon *polygon, Box casters) {
    Vec3 eye = {0}, right, up, middle = vec3_scale(vec3_add(casters.low, casters.high), 0.5f);
    for (int k = 0; k < polygon->count; k++)
        eye = vec3_madd(eye, polygon->corners[k], 1.0f / (float)polygon->count);
    Vec3 to = vec3_sub(middle, eye);
    float distance = vec3_length(to), radius = 0.5f * box_size(casters), most = 6.0f, half = most;
    bool faces = polygon->two_sided || vec3_dot(to, polygon->normal) > 0.3f * distance;
    Vec3 forward = faces ? vec3_normal_or(to, polygon->normal) : polygon->normal;
    if (faces && distance > 1.05f * radius)
        half = fminf(radius / sqrtf(distance * distance - radius * radius), most);
    across(forward, &right, &up);
    return (Shadow){.view = {.eye = eye,
                             .forward = forward,
                             .across = vec3_scale(right, half),
                             .up = vec3_scale(up, half)},
                    .texel = 2.0f * half / SHADOW_SIDE,
                    .radius = sqrtf(polygon->area / PI_FLOAT)};
}

static void choose(const WeftScene *scene, const LightPolygons *polygons, Shadows *self) {
    Box casters = {self->low, self->high};
    int half = SHADOWS_MOST / 2, wanted = polygons->count < half ? polygons->count : half;
    choose_lights(scene, SHADOWS_MOST - wanted, casters, self);
    for (int k = 0; k < polygons->count && self->count < SHADOWS_MOST; k++)
        add(self, of_polygon(&polygons->items[k], casters), -1, k);
}

static bool sees_the_same(const Shadow *a, const Shadow *b) {
    return memcmp(&a->view, &b->view, offsetof(View, orthographic)) == 0 &&
           a->view.orthographic == b->view.orthographic;
}

static void delete_objects(Shadows *self) {
    glDeleteTextures(1, &self->texture);
    glDeleteFramebuffers(1, &self->framebuffer);
    glDeleteSamplers(1, &self->compare);
    glDeleteSamplers(1, &self->plain);
    self->texture = self->framebuffer = self->compare = self->plain = 0;
    self->drawn = false;
}

static void make_objects(Shadows *self) {
    glGenTextures(1, &self->texture);
    glBindTexture(GL_TEXTURE_2D_ARRAY, self->texture);
    texture_plain(GL_TEXTURE_2D_ARRAY);
    glTexImage3D(GL_TEXTURE_2D_ARRAY, 0, GL_DEPTH_COMPONENT32F, SHADOW_SIDE, SHADOW_SIDE, self->count, 0,
                 GL_DEPTH_COMPONENT, GL_FLOAT, NULL);
    glGenFramebuffers(1, &self->framebuffer);
    glGenSamplers(1, &self->compare);
    glSamplerParameteri(self->compare, GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
    glSamplerParameteri(self->compare, GL_TEXTURE_COMPARE_FUNC, GL_LEQUAL);
    glSamplerParameteri(self->compare, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    glSamplerParameteri(self->compare, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    glSamplerParameteri(self->compare, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glSamplerParameteri(self->compare, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    glGenSamplers(1, &self->plain);
    glSamplerParameteri(self->plain, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glSamplerParameteri(self->plain, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    glSamplerParameteri(self->plain, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glSamplerParameteri(self->plain, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
}

WeftResult shadows_create(const WeftScene *scene, const LightPolygons *polygons, Shadows *out,
                          WeftError *error) {
    Box casters = find_casters(scene);
    *out = (Shadows){.low = casters.low, .high = casters.high};
    return shadows_update(out, scene, polygons, error);
}

WeftResult shadows_update(Shadows *self, const WeftScene *scene, const LightPolygons *polygons,
                          WeftError *error) {
    Shadows old = *self;
    self->count = 0;
    choose(scene, polygons, self);
    for (int k = 0; k < self->count; k++) self->drawn &= sees_the_same(&self->all[k], &old.all[k]);
    if (self->count == old.count) return WEFT_OK;
    delete_objects(self);
    if (self->count) make_objects(self);
    WeftResult result = gl_check(error, "shadows");
    if (result == WEFT_OK) return WEFT_OK;
    delete_objects(self);
    self->count = 0;
    return result;
}

void shadows_destroy(Shadows *self) {
    delete_objects(self);
    *self = (Shadows){0};
}

void shadows_begin(const Shadows *self, int layer) {
    static const GLenum none = GL_NONE;
    glBindFramebuffer(GL_FRAMEBUFFER, self->framebuffer);
    glFramebufferTextureLayer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, self->texture, 0, layer);
    glDrawBuffers(1, &none);
    glReadBuffer(GL_NONE);
    glViewport(0, 0, SHADOW_SIDE, SHADOW_SIDE);
    glClear(GL_DEPTH_BUFFER_BIT);
}

void shadows_bind(const Shadows *self, int compare_unit, int plain_unit) {
    glActiveTexture(GL_TEXTURE0 + (GLenum)compare_unit);
    glBindTexture(GL_TEXTURE_2D_ARRAY, self->texture);
    glBindSampler((GLuint)compare_unit, self->compare);
    glActiveTexture(GL_TEXTURE0 + (GLenum)plain_unit);
    glBindTexture(GL_TEXTURE_2D_ARRAY, self->texture);
    glBindSampler((GLuint)plain_unit, self->plain);
    glActiveTexture(GL_TEXTURE0);
}
