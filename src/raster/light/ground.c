#include <stdlib.h> /* before the dialect, whose abs() shadows its own */

#include "raster/light/ground.h"

#include <epoxy/gl.h>

#include "base/fail.h"
#include "base/thread.h"
#include "raster/gl/gl_check.h"
#include "shading/dialect/rgb.h"
#include "trace/light/sky.h"

enum { SIDE = 96, RAYS = 256 };

/* Samples of the sky by its radiance. */
typedef struct SkyLights {
    Vec3 wi[RAYS];
    float w[RAYS]; /* luminance of a sample's irradiance on a level plane */
    float whole;   /* sum of w */
} SkyLights;

typedef struct GroundRow {
    const Ground *ground;
    const SkyLights *lights;
    float *texels;
} GroundRow;

static bool find_sky_lights(SkyLights *lights, const WeftScene *scene) {
    Arena arena = {0};
    Sky sky;
    bool made = sky_make(&sky, &scene->environment, &arena);
    lights->whole = 0.0f;
    for (int k = 0; made && k < RAYS; k++) {
        float v = (float)k * 0.618033989f;
        SkyPoint p = sky_sample(&sky, ((float)k + 0.5f) / RAYS, v - floorf(v));
        float light = rgb_luminance(p.radiance);
        bool counts = p.pdf > 0.0f && p.direction.y > 0.0f && light > 0.0f;
        lights->wi[k] = p.direction;
        lights->w[k] = counts ? light * p.direction.y / (p.pdf * RAYS) : 0.0f;
        lights->whole += lights->w[k];
    }
    arena_free(&arena);
    return made;
}

static float reached(const GroundRow *look, Vec3 point) {
    float sum = 0.0f;
    for (int k = 0; k < RAYS; k++) {
        Ray ray = {point, look->lights->wi[k], 0.0f, INFINITY, (uint32_t)k, false};
        if (look->lights->w[k] > 0.0f && !geometry_occluded(look->ground->geometry, ray)) sum += look->lights->w[k];
    }
    return look->lights->whole > 0.0f ? sum / look->lights->whole : 1.0f;
}

static void look_along_row(void *user, int row, int thread) {
    const GroundRow *look = user;
    const Floor *floor = &look->ground->floor;
    for (int column = 0; column < SIDE; column++) {
        float x = 2.0f * ((float)column + 0.5f) / SIDE - 1.0f, y = 2.0f * ((float)row + 0.5f) / SIDE - 1.0f;
        float scale = sqrtf(x * x + y * y) * floor->radius;
        Vec3 point = vec3_add(floor->middle, vec3(scale * x, 0.0f, scale * y));
        look->texels[row * SIDE + column] = x * x + y * y < 1.1f ? reached(look, point) : 1.0f;
    }
}

static void upload(Ground *self, const float *texels) {
    if (!self->sky) glGenTextures(1, &self->sky);
    glBindTexture(GL_TEXTURE_2D, self->sky);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_R16F, SIDE, SIDE, 0, GL_RED, GL_FLOAT, texels);
    glBindTexture(GL_TEXTURE_2D, 0);
}

static bool is_solved(const Ground *self, const Environment *e, const Floor *floor) {
    return self->solved && !self->stale && self->version == e->version && !(self->rotation < e->rotation) &&
           !(self->rotation > e->rotation) && !(self->strength < e->strength) && !(self->strength > e->strength) &&
           !(self->floor.radius < floor->radius) && !(self->floor.radius > floor->radius);
}

WeftResult ground_look(Ground *self, const WeftScene *scene, const Floor *floor, int threads, WeftError *error) {
    const Environment *e = &scene->environment;
    WeftResult result = WEFT_OK;
    SkyLights lights;
    if (is_solved(self, e, floor)) return WEFT_OK;
    self->solved = false;
    if (self->stale) geometry_free(self->geometry), self->geometry = NULL;
    self->stale = false;
    if (threads <= 0) threads = thread_count();
    if (!self->geometry) result = geometry_create(scene, scene_own_meshes(scene), threads, &self->geometry, error);
    if (result != WEFT_OK) return result;
    float *texels = alloc_array((size_t)SIDE * SIDE, sizeof(float));
    if (!texels || !find_sky_lights(&lights, scene)) {
        free(texels);
        return fail(error, WEFT_MESSAGE_MEMORY, scene->name, NULL);
    }
    self->floor = *floor;
    self->version = e->version;
    self->rotation = e->rotation;
    self->strength = e->strength;
    self->light = lights.whole;
    parallel_for(threads, SIDE, look_along_row, &(GroundRow){self, &lights, texels});
    upload(self, texels);
    free(texels);
    result = gl_check(error, "a floor");
    self->solved = result == WEFT_OK;
    return result;
}

static Vec3 from_below(Vec3 v, float k) { return vec3(k * v.x, -k * v.y, k * v.z); }

View ground_view(const Floor *floor, const View *view) {
    View below = *view;
    below.eye = vec3_add(from_below(view->eye, 1.0f), vec3(0.0f, 2.0f * floor->middle.y, 0.0f));
    below.forward = from_below(view->forward, 1.0f);
    below.up = from_below(view->up, 1.0f);
    below.across = from_below(view->across, -1.0f); /* keeps front faces front */
    return below;
}

static void delete_mirror(Ground *self) {
    glDeleteFramebuffers(1, &self->framebuffer);
    glDeleteTextures(1, &self->color);
    glDeleteTextures(1, &self->depth);
    self->framebuffer = self->color = self->depth = 0;
}

static unsigned make_texture(GLenum format, GLenum of, GLenum type, GLint filter, int width, int height) {
    unsigned name;
    glGenTextures(1, &name);
    glBindTexture(GL_TEXTURE_2D, name);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, filter);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, filter == GL_NEAREST ? GL_NEAREST : GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    glTexImage2D(GL_TEXTURE_2D, 0, (GLint)format, width, height, 0, of, type, NULL);
    return name;
}

static WeftResult make_mirror(Ground *self, int width, int height, WeftError *error) {
    delete_mirror(self);
    self->width = width, self->height = height;
    self->color = make_texture(GL_RGBA16F, GL_RGBA, GL_HALF_FLOAT, GL_LINEAR_MIPMAP_LINEAR, width, height);
    self->depth = make_texture(GL_DEPTH_COMPONENT32F, GL_DEPTH_COMPONENT, GL_FLOAT, GL_NEAREST, width, height);
    glGenFramebuffers(1, &self->framebuffer);
    glBindFramebuffer(GL_FRAMEBUFFER, self->framebuffer);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, self->color, 0);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, self->depth, 0);
    WeftResult result = gl_check(error, "the floor's mirror");
    if (result != WEFT_OK) delete_mirror(self);
    return result;
}

WeftResult ground_mirror(Ground *self, int width, int height, const int box[4], WeftError *error) {
    int w = (width + 1) / 2, h = (height + 1) / 2, more = h / 3 + 1;
    WeftResult result = WEFT_OK;
    if (!self->framebuffer || self->width != w || self->height != h) result = make_mirror(self, w, h, error);
    if (result != WEFT_OK) return result;
    glBindFramebuffer(GL_FRAMEBUFFER, self->framebuffer);
    glViewport(0, 0, w, h);
    glEnable(GL_SCISSOR_TEST);
    glScissor(0, box[1] / 2 - more, w, box[3] / 2 + 2 * more);
    glClearColor(0.0f, 0.0f, 0.0f, 0.0f);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    return WEFT_OK;
}

void ground_mirrored(const Ground *self) {
    glBindTexture(GL_TEXTURE_2D, self->color);
    glGenerateMipmap(GL_TEXTURE_2D);
    glBindTexture(GL_TEXTURE_2D, 0);
}

void ground_bind(const Ground *self, int unit) {
    const unsigned textures[] = {self->sky, self->color, self->depth};
    for (int k = 0; k < 3; k++) {
        glActiveTexture(GL_TEXTURE0 + (GLenum)(unit + k));
        glBindTexture(GL_TEXTURE_2D, textures[k]);
    }
    glActiveTexture(GL_TEXTURE0);
}

void ground_destroy(Ground *self) {
    geometry_free(self->geometry);
    glDeleteTextures(1, &self->sky);
    delete_mirror(self);
    *self = (Ground){0};
}
