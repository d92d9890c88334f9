/* raster.c - the API of the raster engine, weft/raster.h: creating, updating and drawing */
#define _POSIX_C_SOURCE 200809L
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <epoxy/gl.h>

#include "base/equal.h"
#include "base/fail.h"
#include "base/steady_clock.h"
#include "image/tone_check.h"
#include "raster/frame/passes.h"
#include "raster/frame/picture_block.h"
#include "raster/frame/shader_keys.h"
#include "raster/gl/gl_check.h"

enum { DEFAULT_WIDTH = 960, DEFAULT_HEIGHT = 720, DEFAULT_SAMPLES = 4, SIDE_MAX = 16384, RATE_MAX = 8 };
enum { FIRST_PIXELS = 20000 }; /* of the first strip of a sum */
static const double strip_seconds = 0.04;

typedef struct Watched {
    WeftProgress progress;
    void *user;
} Watched;

static bool on_progress(void *user, float done) {
    const Watched *watched = user;
    return watched->progress && watched->progress(watched->user, (double)done) != 0;
}

static bool environment_emits(const Environment *e) {
    bool color = e->color[0] > 0.0f || e->color[1] > 0.0f || e->color[2] > 0.0f;
    return e->strength > 0.0f && (e->kind != ENVIRONMENT_CONSTANT || color);
}

/* Uploads the scene's environment if it is another one than before. A black one is not uploaded; the one before it is
 * kept. */
static WeftResult update_environment(WeftRaster *self, const WeftLog *log, WeftError *error) {
    const Environment *environment = &self->scene->environment;
    Watched watched = {self->desc.progress, self->desc.user};
    const EnvironmentHow how = {.language = context_language(self->context),
                                .folder = self->desc.shader_dir,
                                .no_cache = self->desc.no_cache != 0,
                                .progress = on_progress,
                                .user = &watched};
    self->environment_lit = environment_emits(environment);
    if (!self->environment_lit) return WEFT_OK;
    if (self->environment.buffer && self->environment_version == environment->version) {
        environment_place(&self->environment, environment);
        return gl_check(error, "an environment");
    }
    environment_destroy(&self->environment);
    self->environment_version = environment->version;
    WeftResult result = environment_create(environment, &how, &self->environment, log, error);
    self->environment_lit = result == WEFT_OK;
    return result;
}

/* Returns the uploaded environment, or NULL if the scene's is black. */
static const GlEnvironment *lit_environment(const WeftRaster *self) {
    return self->environment_lit ? &self->environment : NULL;
}

static WeftResult upload(WeftRaster *self, const WeftLog *log, WeftError *error) {
    const WeftScene *scene = self->scene;
    int threads = self->desc.threads;
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    WeftResult result = lookout_create(&self->lookout, scene, self->desc.occlusion, threads, error);
    if (result == WEFT_OK) result = meshes_create(scene, &self->lookout.refinement, &self->meshes, error);
    self->shape_version = scene->shape_version;
    if (result == WEFT_OK) result = textures_create(scene, threads, &self->textures, log, error);
    if (result == WEFT_OK) result = materials_create(scene, &self->textures, threads, &self->materials, error);
    self->programs.sheens = self->materials.sheens;
    if (result == WEFT_OK && !light_polygons_find(&self->polygons, scene, PICTURE_POLYGONS))
        result = fail(error, WEFT_MESSAGE_MEMORY, scene->name, NULL);
    if (result == WEFT_OK) result = shadows_create(scene, &self->polygons, &self->shadows, error);
    if (result == WEFT_OK) result = update_environment(self, log, error);
    self->programs.fits.threads = threads;
    self->programs.fits.no_cache = self->desc.no_cache != 0;
    glGenBuffers(1, &self->picture_buffer);
    glBindBuffer(GL_UNIFORM_BUFFER, self->picture_buffer);
    glBufferData(GL_UNIFORM_BUFFER, sizeof(Picture), NULL, GL_DYNAMIC_DRAW);
    return result == WEFT_OK ? gl_check(error, "a scene") : result;
}

static void release(WeftRaster *self) {
    meshes_destroy(&self->meshes);
    textures_destroy(&self->textures);
    materials_destroy(&self->materials);
    programs_destroy(&self->programs);
    shadows_destroy(&self->shadows);
    environment_destroy(&self->environment);
    ground_destroy(&self->ground);
    glDeleteProgram(self->background_program);
    target_destroy(&self->target);
    sums_destroy(&self->sums);
    coarse_destroy(&self->coarse);
    ray_scene_destroy(&self->rays);
    sky_table_destroy(&self->sky);
    display_destroy(&self->display);
    glDeleteBuffers(1, &self->picture_buffer);
}

static WeftResult enter(WeftRaster *self, GlOuter *outer, WeftError *error) {
    if (context_enter(self->context, outer)) return WEFT_OK;
    const char *why = context_adopted(self->context) ? "is not current" : "is in use";
    return fail(error, WEFT_MESSAGE_GL_CONTEXT, self->scene->name, "its context %s", why);
}

/* Makes or adopts the context and uploads the scene into it. */
static WeftResult begin_drawing(WeftRaster *self, const WeftLog *log, WeftError *error) {
    GlOuter outer;
    TextLanguage language = self->desc.gl == WEFT_GL_ES ? TEXT_GLSL_ES_300 : TEXT_GLSL_330;
    WeftResult result =
        self->desc.adopt ? context_adopt(&self->context, error) : context_create(language, &self->context, error);
    if (result == WEFT_OK) result = enter(self, &outer, error);
    if (result != WEFT_OK) return result;
    language = context_language(self->context);
    self->programs.desc = (TextDesc){.language = language, .tables = true, .folder = self->desc.shader_dir};
    result = upload(self, log, error);
    context_leave(self->context, &outer);
    return result;
}

WeftResult weft_raster_create(const WeftScene *scene, const WeftRasterDesc *desc, WeftRaster **out, const WeftLog *log,
                              WeftError *error) {
    *out = NULL;
    if ((unsigned)desc->gl > WEFT_GL_ES) return fail(error, WEFT_MESSAGE_DESC, "gl", "%d", (int)desc->gl);
    if (desc->occlusion < 0 || desc->occlusion > 4096)
        return fail(error, WEFT_MESSAGE_DESC, "occlusion", "%d", desc->occlusion);
    if (desc->threads < 0 || desc->threads > WEFT_THREADS_MAX)
        return fail(error, WEFT_MESSAGE_DESC, "threads", "%d", desc->threads);
    if (!scene->mesh_count) return fail(error, WEFT_MESSAGE_SCENE_EMPTY, scene->name, NULL);
    WeftRaster *self = alloc_array(1, sizeof *self);
    if (!self) return fail(error, WEFT_MESSAGE_MEMORY, scene->name, NULL);
    self->scene = scene;
    self->desc = *desc;
    if (desc->shader_dir) self->desc.shader_dir = strdup(desc->shader_dir);
    WeftResult result = queue_create(scene, &self->queue, error);
    if (result == WEFT_OK && desc->shader_dir && !self->desc.shader_dir)
        result = fail(error, WEFT_MESSAGE_MEMORY, scene->name, NULL);
    if (result == WEFT_OK && desc->shader_dir) watch_poll(&self->watch, desc->shader_dir);
    if (result == WEFT_OK) result = begin_drawing(self, log, error);
    if (result == WEFT_OK)
        result = lookout_start(&self->lookout, lit_environment(self), desc->no_cache != 0, log, error);
    if (result == WEFT_OK)
        *out = self;
    else
        weft_raster_free(self);
    return result;
}

void weft_raster_free(WeftRaster *self) {
    GlOuter outer;
    if (!self) return;
    if (self->context && context_enter(self->context, &outer)) {
        release(self);
        context_leave(self->context, &outer);
    }
    context_destroy(self->context);
    lookout_free(&self->lookout);
    queue_destroy(&self->queue);
    light_polygons_free(&self->polygons);
    free((char *)self->desc.shader_dir);
    watch_free(&self->watch);
    free(self);
}

static WeftResult check_view(const WeftRasterView *view, WeftError *error) {
    if (view->width < 1 || view->width > SIDE_MAX || view->height < 1 || view->height > SIDE_MAX)
        return fail(error, WEFT_MESSAGE_DESC, "picture size", "%d x %d; a side is 1 to %d", view->width, view->height,
                    SIDE_MAX);
    if (view->samples < 1 || view->samples > 64) return fail(error, WEFT_MESSAGE_DESC, "samples", "%d", view->samples);
    if ((unsigned)view->ambient > WEFT_AMBIENT_NONE)
        return fail(error, WEFT_MESSAGE_DESC, "ambient", "%d", (int)view->ambient);
    if ((unsigned)view->background > WEFT_BACKGROUND_BLURRED) return fail(error, WEFT_MESSAGE_DESC, "background", NULL);
    if (view->bounces < 0 || view->bounces > 1)
        return fail(error, WEFT_MESSAGE_DESC, "bounces", "%d; 0 or 1", view->bounces);
    if ((unsigned)view->part >= WEFT_PART_COUNT) return fail(error, WEFT_MESSAGE_DESC, "part", "%d", (int)view->part);
    if (view->shading_rate < 1 || view->shading_rate > RATE_MAX)
        return fail(error, WEFT_MESSAGE_DESC, "shading rate", "%d; 1 to %d", view->shading_rate, RATE_MAX);
    const int *c = view->crop;
    if (c[0] < 0 || c[1] < 0 || c[2] < 1 || c[3] < 1 || c[2] > view->width - c[0] || c[3] > view->height - c[1])
        return fail(error, WEFT_MESSAGE_DESC, "crop", "%d,%d,%d,%d is not inside %d x %d", c[0], c[1], c[2], c[3],
                    view->width, view->height);
    return floor_check(&view->floor, error);
}

static void set_defaults(const WeftScene *scene, WeftRasterView *view) {
    if (!view->width) view->width = DEFAULT_WIDTH;
    if (!view->height) view->height = DEFAULT_HEIGHT;
    if (!view->samples) view->samples = DEFAULT_SAMPLES;
    if (!view->shading_rate) view->shading_rate = 1;
    if (!view->polygons) view->polygons = WEFT_RASTER_POLYGONS;
    if (view->polygons < 0) view->polygons = 0;
    if (!view->crop[0] && !view->crop[1] && !view->crop[2] && !view->crop[3])
        view->crop[2] = view->width, view->crop[3] = view->height;
    if (view->part != WEFT_PART_ALL) view->background = WEFT_BACKGROUND_TRANSPARENT;
    if (view->background != WEFT_BACKGROUND_AUTO) return;
    bool studio = scene->environment.kind == ENVIRONMENT_STUDIO;
    view->background = studio ? WEFT_BACKGROUND_COLOR : WEFT_BACKGROUND_ENVIRONMENT;
    for (int c = 0; c < 3; c++) view->background_color[c] = 0.62f; /* a light grey paper roll */
}

WeftResult weft_raster_wait(WeftRaster *self, WeftError *error) {
    GlOuter outer;
    WeftResult result = enter(self, &outer, error);
    if (result != WEFT_OK) return result;
    result = frame_take_occlusion(self, true, error);
    /* an environment that was rotated meanwhile has started another search */
    if (self->lookout.occlusion && result == WEFT_OK) result = frame_take_occlusion(self, true, error);
    context_leave(self->context, &outer);
    return result;
}

/* Adds to change what new pixels in the maps of a material may have changed: coverage and emission. */
static void add_stale(const WeftRaster *self, const Material *material, MaterialsChange *change) {
    const int opacity = material->inputs[INPUT_opacity].texture, emission = material->inputs[INPUT_emission].texture;
    change->coverage |= material->alpha_mode != WEFT_ALPHA_OPAQUE && opacity &&
                        textures_stale(&self->textures, self->scene, opacity - 1);
    change->emission |= emission && textures_stale(&self->textures, self->scene, emission - 1);
}

/* Uploads what has changed in materials and their textures. New pixels of an uploaded texture are uploaded alone; a
 * texture that no material had before, or of another size or kind, uploads all textures again. */
static WeftResult update_materials(WeftRaster *self, MaterialsChange *change, const WeftLog *log, WeftError *error) {
    const WeftScene *scene = self->scene;
    GlTextures textures = self->textures;
    WeftResult result = WEFT_OK;
    MaterialsChange stale = {0};
    bool serve = textures_serve(&textures, scene);
    for (int k = 0; k < scene_shaded_materials(scene); k++) add_stale(self, &scene->materials[k], &stale);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    if (serve) result = textures_refresh(&self->textures, scene, self->desc.threads, error);
    if (!serve) result = textures_create(scene, self->desc.threads, &textures, log, error);
    if (result != WEFT_OK) return result;
    result = materials_update(&self->materials, scene, &textures, self->desc.threads, change, error);
    if (!serve) textures_destroy(result == WEFT_OK ? &self->textures : &textures);
    if (!serve && result == WEFT_OK) {
        self->textures = textures;
        self->no_mipmaps = false;
    }
    change->coverage |= stale.coverage;
    change->emission |= stale.emission;
    self->programs.sheens = self->materials.sheens;
    self->programs.sheens_version += change->tables;
    return result;
}

/* Uploads changed shapes of lights. All shadow maps are drawn again, since lights cast shadows too. */
static WeftResult update_shapes(WeftRaster *self, WeftError *error) {
    if (self->shape_version == self->scene->shape_version) return WEFT_OK;
    WeftResult result = meshes_reshape(&self->meshes, self->scene, error);
    if (result == WEFT_OK) result = queue_reshape(&self->queue, self->scene, error);
    self->shadows.drawn = false;
    return result;
}

static WeftResult update_lights(WeftRaster *self, const MaterialsChange *change, WeftError *error) {
    LightPolygons polygons;
    if (change->emission || self->shape_version != self->scene->shape_version) {
        if (!light_polygons_find(&polygons, self->scene, PICTURE_POLYGONS))
            return fail(error, WEFT_MESSAGE_MEMORY, self->scene->name, NULL);
        light_polygons_free(&self->polygons);
        self->polygons = polygons;
    }
    self->shape_version = self->scene->shape_version;
    if (change->coverage) self->shadows.drawn = false;
    return shadows_update(&self->shadows, self->scene, &self->polygons, error);
}

WeftResult weft_raster_update(WeftRaster *self, const WeftLog *log, WeftError *error) {
    GlOuter outer;
    MaterialsChange change;
    WeftResult result = enter(self, &outer, error);
    if (result != WEFT_OK) return result;
    result = update_shapes(self, error);
    if (result == WEFT_OK) result = meshes_update(&self->meshes, self->scene, error);
    if (result == WEFT_OK) result = update_materials(self, &change, log, error);
    if (result == WEFT_OK) self->lookout.again |= change.coverage;
    if (result == WEFT_OK) self->ground.stale |= change.coverage;
    if (result == WEFT_OK) result = update_lights(self, &change, error);
    if (result == WEFT_OK) result = update_environment(self, log, error);
    self->rays.filled = self->sums.begun = self->drawn = false;
    if (result == WEFT_OK) result = lookout_update(&self->lookout, lit_environment(self), &self->meshes, log, error);
    queue_update(&self->queue, self->scene);
    context_leave(self->context, &outer);
    return result;
}

WeftResult weft_raster_draw(WeftRaster *self, const WeftRasterView *wanted, WeftError *error) {
    WeftRasterView view = *wanted;
    GlOuter outer;
    set_defaults(self->scene, &view);
    WeftResult result = check_view(&view, error);
    if (result != WEFT_OK) return result;
    float aspect = (float)view.width / (float)view.height;
    result = camera_find(self->scene, view.camera, aspect, &self->camera, error);
    if (result != WEFT_OK) return result;
    View seen = view_of(&self->camera, aspect);
    result = enter(self, &outer, error);
    if (result != WEFT_OK) return result;
    self->sums.begun = false;
    result = frame_draw_passes(self, &view, &seen, error);
    self->drawn = result == WEFT_OK;
    self->drawn_view = view;
    self->drawn_from = seen;
    context_leave(self->context, &outer);
    return result;
}

static bool same_place(Vec3 a, Vec3 b) { return is_equal(a.x, b.x) && is_equal(a.y, b.y) && is_equal(a.z, b.z); }

static bool same_colors(const float a[3], const float b[3]) {
    return is_equal(a[0], b[0]) && is_equal(a[1], b[1]) && is_equal(a[2], b[2]);
}
static bool same_floors(const WeftFloor *a, const WeftFloor *b) {
    return a->on == b->on && is_equal(a->reflection, b->reflection) && is_equal(a->roughness, b->roughness);
}

/* Returns true if the last picture shows what this view does, so that it may begin a sum. */
static bool shows(const WeftRaster *self, const WeftRasterView *view, const View *seen) {
    const WeftRasterView *last = &self->drawn_view;
    const View *from = &self->drawn_from;
    return self->drawn && last->width == view->width && last->height == view->height && last->part == view->part &&
           last->background == view->background && last->hide_lights == view->hide_lights &&
           same_colors(last->background_color, view->background_color) && same_floors(&last->floor, &view->floor) &&
           memcmp(last->crop, view->crop, sizeof view->crop) == 0 && same_place(from->eye, seen->eye) &&
           same_place(from->forward, seen->forward) && same_place(from->across, seen->across) &&
           same_place(from->up, seen->up);
}

WeftResult weft_raster_accumulate_begin(WeftRaster *self, const WeftRasterView *wanted, int frames, WeftError *error) {
    WeftRasterView view = *wanted;
    GlOuter outer;
    set_defaults(self->scene, &view);
    WeftResult result = check_view(&view, error);
    if (result != WEFT_OK) return result;
    if (frames < 1 || frames > WEFT_RASTER_FRAMES_MOST)
        return fail(error, WEFT_MESSAGE_DESC, "frames", "%d; 1 to %d", frames, WEFT_RASTER_FRAMES_MOST);
    float aspect = (float)view.width / (float)view.height;
    result = camera_find(self->scene, view.camera, aspect, &self->camera, error);
    if (result != WEFT_OK) return result;
    Sums *sums = &self->sums;
    sums->seen = view_of(&self->camera, aspect);
    sums->begun = false;
    sums->starts = shows(self, &view, &sums->seen);
    view.camera = NULL; /* the text is the caller's */
    sums->view = view;
    sums->frames = frames;
    sums->rows = FIRST_PIXELS / view.width > 0 ? FIRST_PIXELS / view.width : 1;
    result = enter(self, &outer, error);
    if (result != WEFT_OK) return result;
    result = frame_begin_sum(self, &sums->seen, error);
    sums->begun = result == WEFT_OK;
    self->drawn = false;
    context_leave(self->context, &outer);
    return result;
}

/* Draws a strip of a frame and adjusts the height of the next to strip_seconds. */
static WeftResult draw_strip(WeftRaster *self, WeftError *error) {
    Sums *sums = &self->sums;
    const double start = clock_now();
    const WeftResult result = frame_draw_sum(self, sums->rows, error);
    const double took = clock_now() - start;
    if (took < 0.5 * strip_seconds && sums->rows < sums->height) sums->rows *= 2;
    if (took > 1.5 * strip_seconds && sums->rows > 4) sums->rows /= 2;
    return result;
}

WeftResult weft_raster_accumulate(WeftRaster *self, double seconds, int *done, WeftError *error) {
    const Sums *sums = &self->sums;
    const double until = clock_now() + seconds;
    GlOuter outer;
    *done = 0;
    if (!sums->begun)
        return fail(error, WEFT_MESSAGE_DESC, "a sum of frames", "was not begun, or something else was drawn since");
    WeftResult result = enter(self, &outer, error);
    if (result != WEFT_OK) return result;
    while (result == WEFT_OK && sums->done < sums->frames) {
        result = draw_strip(self, error);
        if (clock_now() >= until) break;
    }
    context_leave(self->context, &outer);
    *done = sums->done;
    if (result != WEFT_OK) self->sums.begun = false;
    return result;
}

int weft_raster_ready(WeftRaster *self, const WeftRasterView *wanted) {
    WeftRasterView view = *wanted;
    set_defaults(self->scene, &view);
    if (check_view(&view, NULL) != WEFT_OK) return 1;
    return all_keys(self, &view, view.floor.on && view.part == WEFT_PART_ALL, programs_has);
}

WeftResult weft_raster_image(WeftRaster *self, WeftImage *out, WeftError *error) {
    GlOuter outer;
    *out = (WeftImage){0};
    if (!self->target.mean) return fail(error, WEFT_MESSAGE_DESC, "a picture", "nothing was drawn yet");
    WeftResult result = enter(self, &outer, error);
    if (result != WEFT_OK) return result;
    result = target_read(&self->target, out, error);
    context_leave(self->context, &outer);
    return result;
}

static WeftResult check_show(const WeftRaster *self, const WeftRasterShow *show, WeftError *error) {
    static const char subject[] = "showing a picture";
    if (!context_adopted(self->context))
        return fail(error, WEFT_MESSAGE_DESC, subject, "a context of its own has nothing to show it in");
    if (!self->target.mean) return fail(error, WEFT_MESSAGE_DESC, subject, "nothing was drawn yet");
    if (show->width < 1 || show->width > SIDE_MAX || show->height < 1 || show->height > SIDE_MAX)
        return fail(error, WEFT_MESSAGE_DESC, subject, "%d x %d; a side is 1 to %d", show->width, show->height,
                    SIDE_MAX);
    if (show->clip[2] < 0 || show->clip[3] < 0)
        return fail(error, WEFT_MESSAGE_DESC, subject, "clip %d x %d", show->clip[2], show->clip[3]);
    const WeftTone tone = {show->tonemap, show->exposure, {show->white[0], show->white[1]}};
    return tone_check(&tone, subject, error);
}

WeftResult weft_raster_show(WeftRaster *self, const WeftRasterShow *wanted, WeftError *error) {
    WeftRasterShow show = *wanted;
    GlOuter outer;
    if (!show.width) show.width = self->target.width;
    if (!show.height) show.height = self->target.height;
    WeftResult result = check_show(self, &show, error);
    if (result == WEFT_OK) result = enter(self, &outer, error);
    if (result != WEFT_OK) return result;
    frame_reset_state(self);
    result = display_draw(&self->display, &self->programs.desc, &self->target, &show, error);
    context_leave(self->context, &outer);
    return result;
}

int weft_raster_refresh(WeftRaster *self) {
    const char *folder = self->desc.shader_dir;
    int changes = folder ? watch_poll(&self->watch, folder) : 0;
    if (!changes) return 0;
    programs_refresh(&self->programs);
    self->sums.begun = self->drawn = false;
    self->display.stale = true;
    self->shadows.drawn = false;
    return changes;
}

void weft_raster_finish(WeftRaster *self) {
    GlOuter outer;
    if (!context_enter(self->context, &outer)) return;
    glFinish();
    context_leave(self->context, &outer);
}

void weft_raster_return_memory(void) { memory_return(); }

void weft_raster_rest(WeftRaster *self) {
    GlOuter outer;
    if (self && self->target.drawn && self->target.samples > 1 && context_enter(self->context, &outer)) {
        target_keep_mean(&self->target);
        context_leave(self->context, &outer);
    }
    memory_return();
}

WeftRasterInfo weft_raster_info(const WeftRaster *self) {
    WeftRasterInfo info = {.driver = context_driver(self->context),
                           .compiled = self->programs.compiled,
                           .samples = self->target.samples,
                           .compile_seconds = self->compile_seconds};
    info.making = self->lookout.occlusion != NULL;
    info.made = self->shape_version == self->scene->shape_version && self->lookout.occlusion &&
                occlusion_values(self->lookout.occlusion, false);
    camera_describe(self->scene, &self->camera, info.camera_eye, info.camera_target, &info.camera_fov);
    for (const Program *p = self->programs.first; p; p = p->next) {
        info.programs += p->name != 0;
        if (p->samplers > info.samplers) info.samplers = p->samplers;
    }
    const char *complaint = programs_complaint(&self->programs);
    snprintf(info.complaint, sizeof info.complaint, "%s", *complaint ? complaint : self->display.error.text);
    return info;
}
