#define _POSIX_C_SOURCE 200809L
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <epoxy/gl.h>

#include "base/fail.h"
#include "base/steady_clock.h"
#include "raster/frame/picture_block.h"
#include "raster/geometry/meshes.h"
#include "raster/gl/context.h"
#include "raster/gl/display.h"
#include "raster/gl/gl_check.h"
#include "raster/gl/queue.h"
#include "raster/gl/target.h"
#include "raster/light/gl_environment.h"
#include "raster/light/ground.h"
#include "raster/light/lookout.h"
#include "raster/light/shadow.h"
#include "raster/material/materials.h"
#include "raster/material/part.h"
#include "raster/material/programs.h"
#include "raster/material/shader_watch.h"
#include "weft/raster.h"

enum { DEFAULT_WIDTH = 960, DEFAULT_HEIGHT = 720, DEFAULT_SAMPLES = 4, SIDE_MAX = 16384 };

struct WeftRaster {
    const WeftScene *scene;
    WeftRasterDesc desc; /* shader_dir is our own copy */
    GlContext *context;
    GlMeshes meshes;
    GlTextures textures;
    GlMaterials materials;
    Programs programs;
    GlEnvironment environment;
    unsigned background;       /* program, 0 until it is needed */
    bool shines;               /* the environment does */
    unsigned turn, shape_turn; /* of the environment and of the shapes that were uploaded */
    Lookout lookout;
    LightPolygons polygons;
    Shadows shadows;
    Floor floor; /* of the last picture, there where it is seen */
    Ground ground;
    float sky_on_floor; /* luminance of the environment's light */
    bool floor_shaded;
    Target target;
    Display display;
    unsigned picture; /* uniform buffer */
    bool plain;       /* textures are without their smaller copies */
    Queue queue;
    Camera camera; /* of the last picture */
    double compile_seconds;
    int settled;           /* programs compiled before, for which the driver's own work is done */
    uint64_t settled_with; /* bit k: with k samples a pixel */
    FolderWatch watch;     /* of the shader_dir */
};

typedef struct Watched {
    WeftProgress progress;
    void *user;
} Watched;

static bool on_progress(void *user, float done) {
    const Watched *watched = user;
    return watched->progress && watched->progress(watched->user, (double)done) != 0;
}

static bool environment_shines(const Environment *e) {
    bool color = e->color[0] > 0.0f || e->color[1] > 0.0f || e->color[2] > 0.0f;
    return e->strength > 0.0f && (e->kind != ENVIRONMENT_CONSTANT || color);
}

/* One that is dark is neither uploaded nor dropped. */
static WeftResult update_environment(WeftRaster *self, const WeftLog *log, WeftError *error) {
    const Environment *environment = &self->scene->environment;
    Watched watched = {self->desc.progress, self->desc.user};
    const EnvironmentHow how = {.language = context_language(self->context),
                                .folder = self->desc.shader_dir,
                                .no_cache = self->desc.no_cache != 0,
                                .progress = on_progress,
                                .user = &watched};
    self->shines = environment_shines(environment);
    if (!self->shines) return WEFT_OK;
    if (self->environment.buffer && self->turn == environment->version) {
        environment_place(&self->environment, environment);
        return gl_check(error, "an environment");
    }
    environment_destroy(&self->environment);
    self->turn = environment->version;
    WeftResult result = environment_create(environment, &how, &self->environment, log, error);
    self->shines = result == WEFT_OK;
    return result;
}

/* Returns NULL where the environment is dark. */
static const GlEnvironment *lit_environment(const WeftRaster *self) {
    return self->shines ? &self->environment : NULL;
}

static WeftResult upload(WeftRaster *self, const WeftLog *log, WeftError *error) {
    const WeftScene *scene = self->scene;
    int threads = self->desc.threads;
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    WeftResult result = lookout_create(&self->lookout, scene, self->desc.occlusion, threads, error);
    if (result == WEFT_OK) result = meshes_create(scene, &self->lookout.refinement, &self->meshes, error);
    self->shape_turn = scene->shape_version;
    if (result == WEFT_OK) result = textures_create(scene, threads, &self->textures, log, error);
    if (result == WEFT_OK)
        result = materials_create(scene, &self->textures, threads, &self->materials, error);
    self->programs.sheens = self->materials.sheens;
    if (result == WEFT_OK && !light_polygons_find(&self->polygons, scene, PICTURE_POLYGONS_MOST))
        result = fail(error, WEFT_MESSAGE_MEMORY, scene->name, NULL);
    if (result == WEFT_OK) result = shadows_create(scene, &self->polygons, &self->shadows, error);
    if (result == WEFT_OK) result = update_environment(self, log, error);
    self->programs.fits.threads = threads;
    self->programs.fits.no_cache = self->desc.no_cache != 0;
    glGenBuffers(1, &self->picture);
    glBindBuffer(GL_UNIFORM_BUFFER, self->picture);
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
    glDeleteProgram(self->background);
    target_destroy(&self->target);
    display_destroy(&self->display);
    glDeleteBuffers(1, &self->picture);
}

static WeftResult enter(WeftRaster *self, GlOuter *outer, WeftError *error) {
    if (context_enter(self->context, outer)) return WEFT_OK;
    const char *why = context_adopted(self->context) ? "is not current" : "is in use";
    return fail(error, WEFT_MESSAGE_GL_CONTEXT, self->scene->name, "its context %s", why);
}

/* A context, and all that is drawn with. */
static WeftResult begin_drawing(WeftRaster *self, const WeftLog *log, WeftError *error) {
    GlOuter outer;
    TextLanguage language = self->desc.gl == WEFT_GL_ES ? TEXT_GLSL_ES_300 : TEXT_GLSL_330;
    WeftResult result = self->desc.adopt ? context_adopt(&self->context, error)
                                         : context_create(language, &self->context, error);
    if (result == WEFT_OK) result = enter(self, &outer, error);
    if (result != WEFT_OK) return result;
    language = context_language(self->context);
    self->programs.desc = (TextDesc){.language = language, .tables = true, .folder = self->desc.shader_dir};
    result = upload(self, log, error);
    context_leave(self->context, &outer);
    return result;
}

WeftResult weft_raster_create(const WeftScene *scene, const WeftRasterDesc *desc, WeftRaster **out,
                              const WeftLog *log, WeftError *error) {
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
        return fail(error, WEFT_MESSAGE_DESC, "picture size", "%d x %d; a side is 1 to %d", view->width,
                    view->height, SIDE_MAX);
    if (view->samples < 1 || view->samples > 64)
        return fail(error, WEFT_MESSAGE_DESC, "samples", "%d", view->samples);
    if ((unsigned)view->ambient > WEFT_AMBIENT_NONE)
        return fail(error, WEFT_MESSAGE_DESC, "ambient", "%d", (int)view->ambient);
    if ((unsigned)view->background > WEFT_BACKGROUND_BLURRED)
        return fail(error, WEFT_MESSAGE_DESC, "background", NULL);
    if ((unsigned)view->part >= WEFT_PART_COUNT)
        return fail(error, WEFT_MESSAGE_DESC, "part", "%d", (int)view->part);
    const int *c = view->crop;
    if (c[0] < 0 || c[1] < 0 || c[2] < 1 || c[3] < 1 || c[2] > view->width - c[0] ||
        c[3] > view->height - c[1])
        return fail(error, WEFT_MESSAGE_DESC, "crop", "%d,%d,%d,%d is not inside %d x %d", c[0], c[1], c[2],
                    c[3], view->width, view->height);
    return floor_check(&view->floor, error);
}

static void set_defaults(const WeftScene *scene, WeftRasterView *view) {
    if (!view->width) view->width = DEFAULT_WIDTH;
    if (!view->height) view->height = DEFAULT_HEIGHT;
    if (!view->samples) view->samples = DEFAULT_SAMPLES;
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

static void set_block(const WeftRaster *self, const Picture *picture) {
    glBindBuffer(GL_UNIFORM_BUFFER, self->picture);
    glBufferSubData(GL_UNIFORM_BUFFER, 0, sizeof *picture, picture);
    glBindBufferBase(GL_UNIFORM_BUFFER, BLOCK_PICTURE, self->picture);
}

static void set_picture(const WeftRaster *self, const View *view) {
    Picture picture;
    picture_make(self->scene, view, &self->polygons, &self->shadows, &self->floor, &picture);
    picture.floor_light[0] = self->sky_on_floor;
    picture.floor_light[2] = self->floor_shaded ? 1.0f : 0.0f;
    set_block(self, &picture);
}

/* Sets the state that every pass starts from. */
static void set_state(WeftRaster *self) {
    glDisable(GL_SCISSOR_TEST);
    glDisable(GL_BLEND);
    glEnable(GL_DEPTH_TEST);
    glDepthMask(GL_TRUE);
    glDepthFunc(GL_LESS);
    glCullFace(GL_BACK);
    glFrontFace(GL_CCW);
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    meshes_bind(&self->meshes);
}

/* Clears all of the picture and then keeps to the crop. With several samples drivers may disagree about those
 * beside its edge, which is why more is drawn than is looked at. */
static void clear(const Target *target, const WeftRasterView *view, const int box[4]) {
    bool several = target->drawn != target->resolved;
    int more = several ? 1 : 0;
    if (several && (box[2] < view->width || box[3] < view->height)) {
        glBindFramebuffer(GL_FRAMEBUFFER, target->resolved);
        glClear(GL_COLOR_BUFFER_BIT);
    }
    glBindFramebuffer(GL_FRAMEBUFFER, target->drawn);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    glEnable(GL_SCISSOR_TEST);
    glScissor(box[0] - more, box[1] - more, box[2] + 2 * more, box[3] + 2 * more);
}

static bool shows_environment(const WeftRasterView *view) {
    return view->background == WEFT_BACKGROUND_ENVIRONMENT || view->background == WEFT_BACKGROUND_BLURRED;
}

static void begin(WeftRaster *self, const WeftRasterView *view, const int box[4]) {
    glViewport(0, 0, view->width, view->height);
    bool color = view->background == WEFT_BACKGROUND_COLOR;
    const Environment *e = &self->scene->environment;
    const float *c = view->background_color;
    float constant[3];
    for (int k = 0; k < 3; k++) constant[k] = e->color[k] * e->strength;
    if (shows_environment(view) && e->kind == ENVIRONMENT_CONSTANT) {
        color = true;
        c = constant;
    }
    glClearColor(color ? c[0] : 0.0f, color ? c[1] : 0.0f, color ? c[2] : 0.0f, color ? 1.0f : 0.0f);
    clear(&self->target, view, box);
}

/* Binds the textures and blocks that all meshes share. */
static void bind_light(WeftRaster *self, const WeftRasterView *view) {
    bool plain = view->plain_textures != 0;
    if (plain != self->plain) textures_filter(&self->textures, !plain);
    self->plain = plain;
    if (self->shines) environment_bind(&self->environment, UNIT_ENVIRONMENT, BLOCK_ENVIRONMENT);
    glActiveTexture(GL_TEXTURE0);
    if (self->shadows.count) shadows_bind(&self->shadows, UNIT_SHADOW, UNIT_SOFT_SHADOW);
}

static WeftResult use_program(WeftRaster *self, const ShaderKey *key, const Program **program,
                              WeftError *error) {
    WeftError said = {0};
    *program = programs_get(&self->programs, key, &said);
    if (*program) glUseProgram((*program)->name);
    if (!*program && error) *error = said;
    return *program ? WEFT_OK : said.result;
}

static WeftResult draw_mesh(WeftRaster *self, int mesh, const ShaderKey *key, WeftError *error) {
    int k = self->scene->meshes[mesh].material;
    const GlMaterial *material = &self->materials.all[k];
    const Program *program;
    WeftResult result = use_program(self, key, &program, error);
    if (result != WEFT_OK) return result;
    glActiveTexture(GL_TEXTURE0 + UNIT_TABLES);
    glBindTexture(GL_TEXTURE_2D_ARRAY, program->tables);
    glActiveTexture(GL_TEXTURE0); /* where whatever is made between draws may bind what it makes */
    if (material->key.double_sided)
        glDisable(GL_CULL_FACE);
    else
        glEnable(GL_CULL_FACE);
    materials_bind(&self->materials, &self->textures, k, BLOCK_MATERIAL);
    meshes_draw(&self->meshes, mesh);
    return WEFT_OK;
}

/* The key of what a material looks like from a light: where it is. */
static ShaderKey depth_key(const ShaderKey *key) {
    ShaderKey depth;
    memset(&depth, 0, sizeof depth);
    depth.depth = 1;
    depth.alpha_mode = key->alpha_mode;
    for (int k = 0; k < INPUT_COUNT; k++) depth.inputs[k].like = -1;
    for (int k = 0; k < INPUT_COUNT; k++) depth.inputs[k].state = INPUT_ZERO;
    if (key->alpha_mode == WEFT_ALPHA_OPAQUE) return depth;
    depth.colored = key->colored;
    depth.woven = key->woven;
    depth.inputs[INPUT_opacity] = key->inputs[INPUT_opacity];
    depth.inputs[INPUT_opacity].like = -1;
    return depth;
}

/* Adds the lights' part of a key. */
static void add_lights(const WeftRaster *self, const WeftRasterView *view, ShaderKey *key) {
    const WeftScene *scene = self->scene;
    key->shadowed = !view->no_shadows && self->shadows.count;
    key->lights = scene->light_count < PICTURE_LIGHTS_MOST ? scene->light_count : PICTURE_LIGHTS_MOST;
    for (int k = 0; k < key->lights && key->lights <= SHADER_LIGHTS; k++) {
        key->light_kind[k] = (int16_t)scene->lights[k].kind;
        key->light_map[k] = -1;
        for (int j = 0; j < self->shadows.count && key->shadowed; j++)
            if (self->shadows.of_light[j] == k) key->light_map[k] = (int16_t)j;
    }
    bool ambient = self->shines && view->ambient != WEFT_AMBIENT_NONE;
    key->ambient = ambient ? (int)view->ambient + 1 : 0;
    key->polygons = view->polygons < self->polygons.count ? view->polygons : self->polygons.count;
    for (int k = 0; k < key->polygons; k++) {
        key->polygon_corners[k] = (int16_t)self->polygons.items[k].count;
        key->polygon_two_sided[k] = self->polygons.items[k].two_sided;
        key->polygon_map[k] = -1;
        for (int j = 0; j < self->shadows.count && key->shadowed; j++)
            if (self->shadows.of_polygon[j] == k) key->polygon_map[k] = (int16_t)j;
    }
}

static ShaderKey floor_key(const WeftRaster *self, const WeftRasterView *view) {
    ShaderKey key;
    memset(&key, 0, sizeof key);
    add_lights(self, view, &key);
    key.floor = 1;
    key.ambient = 0;
    return key;
}

static ShaderKey lit_key(const WeftRaster *self, const WeftRasterView *view, const GlMaterial *material) {
    ShaderKey key = material->key;
    key.part = (int)view->part;
    if (part_is_property(key.part)) return key;
    add_lights(self, view, &key);
    if (key.ambient) material_in_light(material, self->environment.parts.env_light_kappa, &key);
    return key;
}

/* Returns true if `what` holds for all keys that the image needs, including the floor's if with_floor. */
static bool of_all_keys(WeftRaster *self, const WeftRasterView *view, bool with_floor,
                        bool (*what)(Programs *programs, const ShaderKey *key)) {
    bool all = true, shadows = self->shadows.count && !self->shadows.drawn && !view->no_shadows;
    for (int k = 0; k < self->materials.count && all; k++) {
        if (!self->materials.all[k].used) continue;
        const GlMaterial *material = &self->materials.all[k];
        ShaderKey key = lit_key(self, view, material), depth = depth_key(&material->key);
        all = what(&self->programs, &key);
        if (shadows) all = all && what(&self->programs, &depth);
    }
    const ShaderKey floor = floor_key(self, view);
    return all && (!with_floor || what(&self->programs, &floor));
}

/* Compiles whatever a picture will be drawn with. */
static WeftResult prepare(WeftRaster *self, const WeftRasterView *view, WeftError *error) {
    bool held = of_all_keys(self, view, self->floor.there, programs_want);
    double start = clock_now();
    int compiled = self->programs.compiled;
    held = held && programs_build(&self->programs, self->context);
    if (self->programs.compiled != compiled) self->compile_seconds += clock_now() - start;
    return held ? WEFT_OK : fail(error, WEFT_MESSAGE_MEMORY, "shaders", NULL);
}

static WeftResult draw_depth(WeftRaster *self, WeftError *error) {
    WeftResult result = WEFT_OK;
    for (int m = 0; m < self->scene->mesh_count && result == WEFT_OK; m++) {
        ShaderKey key = depth_key(&self->materials.all[self->scene->meshes[m].material].key);
        result = draw_mesh(self, m, &key, error);
    }
    return result;
}

/* The maps stay as they are as long as the scene does. */
static WeftResult draw_shadows(WeftRaster *self, WeftError *error) {
    WeftResult result = WEFT_OK;
    for (int k = 0; k < self->shadows.count && !self->shadows.drawn && result == WEFT_OK; k++) {
        const Shadow *shadow = &self->shadows.all[k];
        for (int point = 0; point < (shadow->points ? shadow->points : 1) && result == WEFT_OK; point++) {
            Picture picture;
            picture_of_shadow(shadow, point, &picture);
            set_block(self, &picture);
            shadows_begin(&self->shadows, k, point);
            result = draw_depth(self, error);
            glFinish(); /* or Mesa's software renderer keeps the triangles of all passes until the last */
        }
    }
    self->shadows.drawn = result == WEFT_OK;
    return result;
}

/* Draws the background where nothing was drawn, before blended meshes. */
static WeftResult draw_background(WeftRaster *self, bool blurred, WeftError *error) {
    const Environment *e = &self->scene->environment;
    WeftError said = {0};
    if (!self->background) self->background = programs_background(&self->programs, &said);
    if (!self->background) {
        if (error) *error = said;
        return said.result;
    }
    if (blurred && environment_blur(&self->environment, e, &said) != WEFT_OK) {
        if (error) *error = said;
        return said.result;
    }
    glUseProgram(self->background);
    glUniform4f(glGetUniformLocation(self->background, "background_place"), cosf(e->rotation),
                sinf(e->rotation), e->strength, 0.0f);
    glActiveTexture(GL_TEXTURE0 + UNIT_BACKGROUND);
    glBindTexture(GL_TEXTURE_2D, blurred ? self->environment.blurred : self->environment.map);
    glActiveTexture(GL_TEXTURE0);
    glDepthFunc(GL_LEQUAL);
    glDepthMask(GL_FALSE);
    glDisable(GL_CULL_FACE);
    glDrawArrays(GL_TRIANGLES, 0, 3);
    glDepthMask(GL_TRUE);
    glDepthFunc(GL_LESS);
    return WEFT_OK;
}

/* Over what is behind it: colours are premultiplied. */
static WeftResult draw_floor(WeftRaster *self, const WeftRasterView *view, WeftError *error) {
    ShaderKey key = floor_key(self, view);
    const Program *program;
    WeftResult result = use_program(self, &key, &program, error);
    if (result != WEFT_OK) return result;
    ground_bind(&self->ground, UNIT_FLOOR);
    glEnable(GL_BLEND);
    glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    glDepthMask(GL_FALSE);
    glDisable(GL_CULL_FACE);
    glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
    glDepthMask(GL_TRUE);
    glDisable(GL_BLEND);
    return WEFT_OK;
}

static WeftResult draw_all(WeftRaster *self, const View *seen, const WeftRasterView *view, WeftError *error) {
    WeftResult result = WEFT_OK;
    bool behind = shows_environment(view) && self->shines && self->environment.map;
    queue_sort(&self->queue, self->scene, seen);
    for (int k = 0; k <= self->queue.count && result == WEFT_OK; k++) {
        if (k == self->queue.solid && behind)
            result = draw_background(self, view->background == WEFT_BACKGROUND_BLURRED, error);
        if (k == self->queue.solid && view->floor.on && self->floor.there && result == WEFT_OK)
            result = draw_floor(self, view, error);
        if (k == self->queue.count || result != WEFT_OK) break;
        int mesh = self->queue.order[k];
        if (view->hide_lights && mesh >= scene_own_meshes(self->scene)) continue;
        const GlMaterial *material = &self->materials.all[self->scene->meshes[mesh].material];
        ShaderKey key = lit_key(self, view, material);
        if (k == self->queue.solid) {
            glEnable(GL_BLEND);
            glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA); /* colours are premultiplied */
            glDepthMask(GL_FALSE);
        }
        result = draw_mesh(self, mesh, &key, error);
    }
    return result == WEFT_OK ? gl_check(error, "a picture") : result;
}

/* Uploads nothing where shapes of lights have changed, before the update that takes them. */
static WeftResult take_occlusion(WeftRaster *self, bool wait, WeftError *error) {
    if (self->shape_turn != self->scene->shape_version) return WEFT_OK;
    return lookout_take(&self->lookout, &self->meshes, wait, error);
}

WeftResult weft_raster_wait(WeftRaster *self, WeftError *error) {
    GlOuter outer;
    WeftResult result = enter(self, &outer, error);
    if (result != WEFT_OK) return result;
    result = take_occlusion(self, true, error);
    /* A map that was turned meanwhile is looked at once more. */
    if (self->lookout.occlusion && result == WEFT_OK) result = take_occlusion(self, true, error);
    context_leave(self->context, &outer);
    return result;
}

/* Adds the changes, other than of colour, that new pixels in its maps may cause in a material. */
static void add_stale(const WeftRaster *self, const Material *material, MaterialsChange *change) {
    const int opacity = material->inputs[INPUT_opacity].texture,
              emission = material->inputs[INPUT_emission].texture;
    change->coverage |= material->alpha_mode != WEFT_ALPHA_OPAQUE && opacity &&
                        textures_stale(&self->textures, self->scene, opacity - 1);
    change->emission |= emission && textures_stale(&self->textures, self->scene, emission - 1);
}

/* Textures that materials did not look up before, or that are of another kind, are uploaded with all others;
 * other pixels in the place of those that were, alone. */
static WeftResult update_materials(WeftRaster *self, MaterialsChange *change, const WeftLog *log,
                                   WeftError *error) {
    const WeftScene *scene = self->scene;
    GlTextures textures = self->textures;
    WeftResult result = WEFT_OK;
    MaterialsChange stale = {0};
    bool serve = textures_serve(&textures, scene);
    for (int k = 0; k < scene->material_count; k++) add_stale(self, &scene->materials[k], &stale);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    if (serve) result = textures_refresh(&self->textures, scene, self->desc.threads, error);
    if (!serve) result = textures_create(scene, self->desc.threads, &textures, log, error);
    if (result != WEFT_OK) return result;
    result = materials_update(&self->materials, scene, &textures, self->desc.threads, change, error);
    if (!serve) textures_destroy(result == WEFT_OK ? &self->textures : &textures);
    if (!serve && result == WEFT_OK) {
        self->textures = textures;
        self->plain = false;
    }
    change->coverage |= stale.coverage;
    change->emission |= stale.emission;
    self->programs.sheens = self->materials.sheens;
    self->programs.sheens_version += change->tables;
    return result;
}

/* Takes other shapes of lights, whose maps see each other. */
static WeftResult update_shapes(WeftRaster *self, WeftError *error) {
    if (self->shape_turn == self->scene->shape_version) return WEFT_OK;
    WeftResult result = meshes_reshape(&self->meshes, self->scene, error);
    if (result == WEFT_OK) result = queue_reshape(&self->queue, self->scene, error);
    self->shadows.drawn = false;
    return result;
}

static WeftResult update_lights(WeftRaster *self, const MaterialsChange *change, WeftError *error) {
    LightPolygons polygons;
    if (change->emission || self->shape_turn != self->scene->shape_version) {
        if (!light_polygons_find(&polygons, self->scene, PICTURE_POLYGONS_MOST))
            return fail(error, WEFT_MESSAGE_MEMORY, self->scene->name, NULL);
        light_polygons_free(&self->polygons);
        self->polygons = polygons;
    }
    self->shape_turn = self->scene->shape_version;
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
    if (result == WEFT_OK)
        result = lookout_update(&self->lookout, lit_environment(self), &self->meshes, log, error);
    queue_update(&self->queue, self->scene);
    context_leave(self->context, &outer);
    return result;
}

/* The floor of a picture, where it is seen, and what the sky does to it. */
static WeftResult find_floor(WeftRaster *self, const View *seen, const WeftRasterView *view,
                             WeftError *error) {
    Floor floor = floor_of(self->scene, &view->floor);
    bool above = seen->orthographic ? seen->forward.y < 0.0f : seen->eye.y > floor.middle.y;
    floor.there = floor.there && view->part == WEFT_PART_ALL && above;
    self->floor = floor;
    self->sky_on_floor = 0.0f;
    self->floor_shaded = !view->no_shadows;
    if (!floor.there || !self->shines || view->ambient == WEFT_AMBIENT_NONE) return WEFT_OK;
    WeftResult result = ground_look(&self->ground, self->scene, &floor, self->desc.threads, error);
    self->sky_on_floor = self->ground.light;
    return result;
}

/* The scene as the floor shows it. */
static WeftResult draw_mirror(WeftRaster *self, const View *seen, const WeftRasterView *view,
                              const int box[4], WeftError *error) {
    if (!self->floor.there || !(self->floor.reflection > 0.0f)) return WEFT_OK;
    View below = ground_view(&self->floor, seen);
    WeftRasterView alone = *view;
    alone.background = WEFT_BACKGROUND_TRANSPARENT;
    alone.floor.on = 0;
    WeftResult result = ground_mirror(&self->ground, view->width, view->height, box, error);
    if (result != WEFT_OK) return result;
    set_picture(self, &below);
    bind_light(self, view);
    result = draw_all(self, &below, &alone, error);
    ground_mirrored(&self->ground);
    set_state(self); /* what blends has changed it */
    return result;
}

/* Drivers compile once more when they first draw with a program, for each number of samples, and have most of what that
 * takes to spare. */
static void return_spare(WeftRaster *self) {
    const uint64_t samples = (uint64_t)1 << (self->target.samples & 63);
    if (self->programs.compiled != self->settled) self->settled_with = 0;
    if (!(self->settled_with & samples)) memory_return();
    self->settled = self->programs.compiled;
    self->settled_with |= samples;
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
    set_state(self);
    result = find_floor(self, &seen, &view, error);
    if (result == WEFT_OK) result = prepare(self, &view, error);
    if (result == WEFT_OK) result = take_occlusion(self, false, error);
    if (result == WEFT_OK && !view.no_shadows) result = draw_shadows(self, error);
    if (result == WEFT_OK)
        result = target_resize(&self->target, view.width, view.height, view.samples, error);
    /* the driver's rows run from the bottom */
    const int *c = view.crop, box[4] = {c[0], view.height - c[1] - c[3], c[2], c[3]};
    if (result == WEFT_OK) result = draw_mirror(self, &seen, &view, box, error);
    if (result == WEFT_OK) {
        set_picture(self, &seen);
        begin(self, &view, box);
        bind_light(self, &view);
        result = draw_all(self, &seen, &view, error);
        glDisable(GL_SCISSOR_TEST);
        target_resolve(&self->target, box);
    }
    return_spare(self);
    context_leave(self->context, &outer);
    return result;
}

int weft_raster_ready(WeftRaster *self, const WeftRasterView *wanted) {
    WeftRasterView view = *wanted;
    set_defaults(self->scene, &view);
    if (check_view(&view, NULL) != WEFT_OK) return 1;
    return of_all_keys(self, &view, view.floor.on && view.part == WEFT_PART_ALL, programs_has);
}

WeftResult weft_raster_image(WeftRaster *self, WeftImage *out, WeftError *error) {
    GlOuter outer;
    *out = (WeftImage){0};
    if (!self->target.drawn) return fail(error, WEFT_MESSAGE_DESC, "a picture", "nothing was drawn yet");
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
    if (!self->target.drawn) return fail(error, WEFT_MESSAGE_DESC, subject, "nothing was drawn yet");
    if (show->width < 1 || show->width > SIDE_MAX || show->height < 1 || show->height > SIDE_MAX)
        return fail(error, WEFT_MESSAGE_DESC, subject, "%d x %d; a side is 1 to %d", show->width,
                    show->height, SIDE_MAX);
    if (show->clip[2] < 0 || show->clip[3] < 0)
        return fail(error, WEFT_MESSAGE_DESC, subject, "clip %d x %d", show->clip[2], show->clip[3]);
    if ((unsigned)show->tonemap > WEFT_TONEMAP_NONE || !isfinite(show->exposure))
        return fail(error, WEFT_MESSAGE_DESC, subject, "curve %d, exposure %g", (int)show->tonemap,
                    (double)show->exposure);
    return WEFT_OK;
}

WeftResult weft_raster_show(WeftRaster *self, const WeftRasterShow *wanted, WeftError *error) {
    WeftRasterShow show = *wanted;
    GlOuter outer;
    if (!show.width) show.width = self->target.width;
    if (!show.height) show.height = self->target.height;
    WeftResult result = check_show(self, &show, error);
    if (result == WEFT_OK) result = enter(self, &outer, error);
    if (result != WEFT_OK) return result;
    set_state(self);
    result = display_draw(&self->display, &self->programs.desc, &self->target, &show, error);
    context_leave(self->context, &outer);
    return result;
}

int weft_raster_refresh(WeftRaster *self) {
    const char *folder = self->desc.shader_dir;
    int changes = folder ? watch_poll(&self->watch, folder) : 0;
    if (!changes) return 0;
    programs_refresh(&self->programs);
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

WeftRasterInfo weft_raster_info(const WeftRaster *self) {
    WeftRasterInfo info = {.driver = context_driver(self->context),
                           .compiled = self->programs.compiled,
                           .samples = self->target.samples,
                           .compile_seconds = self->compile_seconds};
    info.making = self->lookout.occlusion != NULL;
    info.made = self->shape_turn == self->scene->shape_version && self->lookout.occlusion &&
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
