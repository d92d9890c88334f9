#include <string.h>

#include "raster/light/lookout.h"

WeftResult lookout_create(Lookout *self, const WeftScene *scene, int rays, int threads, WeftError *error) {
    self->scene = scene;
    self->rays = rays;
    self->threads = threads;
    return rays ? refinement_make(scene, &self->refinement, error) : WEFT_OK;
}

void lookout_free(Lookout *self) {
    occlusion_free(self->occlusion);
    refinement_free(&self->refinement);
    refinement_free(&self->finer);
}

static bool is_same_place(const EnvLight *a, const EnvLight *b) {
    return memcmp((const char *)&a->direction, (const char *)&b->direction, sizeof a->direction) == 0 &&
           memcmp((const char *)&a->spread, (const char *)&b->spread, sizeof a->spread) == 0;
}

/* Returns true if the environment without its lights has changed, or its rotation. A change of strength does not count,
 * since only fractions of the light are used. */
static bool find_rest(Lookout *self, const GlEnvironment *environment, float rotation) {
    enum { TEXELS = AMBIENT_REST_HEIGHT * AMBIENT_REST_WIDTH };
    AmbientRest rest = environment->parts.rest;
    float *now = rest.luminance[0], mean = 0.0f, change = 0.0f;
    const float *before = self->rest.luminance[0];
    for (int k = 0; k < TEXELS; k++) mean += now[k] / TEXELS;
    for (int k = 0; k < TEXELS; k++) {
        now[k] = mean > 0.0f ? now[k] / mean : 1.0f;
        change += fabsf(now[k] - before[k]) / TEXELS;
    }
    const float rounding = 1e-5f;
    if (!(fabsf(rotation - self->rotation) > 0.0f) && change <= rounding) return false;
    self->rest = rest;
    self->rotation = rotation;
    return true;
}

/* Returns true if lights, or the environment without them, have moved. */
static bool find_lights(Lookout *self, const GlEnvironment *environment) {
    EnvLight lights[AMBIENT_LIGHTS_MAX];
    const float rotation = self->scene->environment.rotation;
    if (!environment) return false;
    int count = environment_lights(environment, rotation, lights);
    bool same = count == self->light_count;
    for (int k = 0; same && k < count; k++) same = is_same_place(&lights[k], &self->lights[k]);
    memcpy(self->lights, lights, (size_t)count * sizeof *lights);
    self->light_count = count;
    self->point_count = environment_points(environment, rotation, self->points);
    return find_rest(self, environment, rotation) || !same;
}

static WeftResult start_search(Lookout *self, bool no_cache, const WeftLog *log, WeftError *error) {
    const OcclusionHow how = {.rays = self->rays,
                              .threads = self->threads,
                              .no_cache = no_cache,
                              .env_lights = self->lights,
                              .env_light_count = self->light_count,
                              .env_points = self->points,
                              .env_point_count = self->point_count,
                              .rest = &self->rest,
                              .rotation = self->rotation};
    WeftResult result = occlusion_start(self->scene, &self->refinement, &how, &self->occlusion, log, error);
    self->again = result != WEFT_OK;
    return result;
}

WeftResult lookout_start(Lookout *self, const GlEnvironment *environment, bool no_cache, const WeftLog *log,
                         WeftError *error) {
    if (!self->rays) return WEFT_OK;
    find_lights(self, environment);
    return start_search(self, no_cache, log, error);
}

WeftResult lookout_update(Lookout *self, const GlEnvironment *environment, GlMeshes *meshes, const WeftLog *log,
                          WeftError *error) {
    if (!self->rays) return WEFT_OK;
    if (find_lights(self, environment)) {
        meshes_forget_lights(meshes);
        self->again = true;
    }
    return self->again && !self->occlusion ? start_search(self, true, log, error) : WEFT_OK;
}

/* Uploads the scene's meshes as the search has refined them. */
static WeftResult take_refinement(Lookout *self, GlMeshes *meshes, WeftError *error) {
    Refinement before = self->finer;
    self->finer = occlusion_take_refinement(self->occlusion);
    WeftResult result = meshes_refine(meshes, self->scene, &self->finer, error);
    if (result != WEFT_OK) {
        refinement_free(&self->finer);
        self->finer = before;
    } else {
        refinement_free(&before);
    }
    return result;
}

WeftResult lookout_take(Lookout *self, GlMeshes *meshes, bool wait, WeftError *error) {
    const float *values = self->occlusion ? occlusion_values(self->occlusion, wait) : NULL;
    if (!values) return WEFT_OK;
    WeftResult result = take_refinement(self, meshes, error);
    if (result == WEFT_OK) result = meshes_occlusion(meshes, values, error);
    occlusion_free(self->occlusion);
    self->occlusion = NULL;
    if (result != WEFT_OK) self->again = true;
    if (!self->again || result != WEFT_OK) return result;
    meshes_forget_lights(meshes);
    return start_search(self, true, NULL, error);
}
