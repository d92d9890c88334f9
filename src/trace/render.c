#define _POSIX_C_SOURCE 200809L
#include <stdatomic.h>
#include <stdlib.h>
#include <time.h>

#include "base/fail.h"
#include "base/thread.h"
#include "scene/backdrop.h"
#include "scene/camera.h"
#include "scene/polygons.h"
#include "scene/shade.h"
#include "scene/sheen_tables.h"
#include "shading/frame.h"
#include "trace/catcher.h"
#include "trace/path_radiance.h"

enum {
    TILE = 16,
    PASS_SAMPLES = 16,
    DEFAULT_WIDTH = 960,
    DEFAULT_HEIGHT = 720,
    DEFAULT_DEPTH = 9,
    SIDE_MAX = 65536,
    FILTER_STEPS = 256,
};

/* One tile's finished work. Only one thread holds a tile at a time. */
typedef struct Tile {
    int samples; /* in every pixel of the tile */
    long long rays, non_finite;
} Tile;

struct WeftRender {
    const WeftScene *scene;
    WeftRenderDesc desc;
    Geometry *geometry;
    Lights *lights;
    SheenTables *tables;
    PathMaterial *materials; /* their sheen_e point into tables */
    int material_count;
    PathContext context;
    Camera camera;
    View view;
    float filter[FILTER_STEPS + 1];
    WeftImage blurred; /* of backdrop.h, where it is the background; its environment was that of */
    unsigned blurred_turn;
    int x0, y0, width, height; /* the crop */
    int tiles_across, tile_count;
    Tile *tiles;
    float *sums; /* RGBA a pixel: radiance times coverage, coverage */
    Floor floor;
    Caught *caught; /* one a pixel, by the floor; NULL where there is none */
    double build_seconds, render_seconds;
};

static double now(void) {
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static WeftResult check_desc(const WeftRenderDesc *d, WeftError *error) {
    if (d->width < 1 || d->width > SIDE_MAX || d->height < 1 || d->height > SIDE_MAX)
        return fail(error, WEFT_MESSAGE_DESC, "picture size", "%d x %d; a side is 1 to %d", d->width,
                    d->height, SIDE_MAX);
    const int *c = d->crop;
    if (c[0] < 0 || c[1] < 0 || c[2] < 1 || c[3] < 1 || c[2] > d->width - c[0] || c[3] > d->height - c[1])
        return fail(error, WEFT_MESSAGE_DESC, "crop", "%d,%d,%d,%d is not inside %d x %d", c[0], c[1], c[2],
                    c[3], d->width, d->height);
    if (d->max_depth < 1) return fail(error, WEFT_MESSAGE_DESC, "max depth", "%d; at least 1", d->max_depth);
    if ((unsigned)d->background > WEFT_BACKGROUND_BLURRED || (unsigned)d->sampling > WEFT_SAMPLING_LOBE)
        return fail(error, WEFT_MESSAGE_DESC, "background or sampling", NULL);
    for (int k = 0; k < 3; k++)
        if (!isfinite(d->background_color[k]))
            return fail(error, WEFT_MESSAGE_DESC, "background color", NULL);
    if (d->threads < 0 || d->threads > WEFT_THREADS_MAX)
        return fail(error, WEFT_MESSAGE_DESC, "threads", "%d", d->threads);
    return floor_check(&d->floor, error);
}

static void set_defaults(WeftRenderDesc *d) {
    if (!d->width) d->width = DEFAULT_WIDTH;
    if (!d->height) d->height = DEFAULT_HEIGHT;
    if (!d->max_depth) d->max_depth = DEFAULT_DEPTH;
    if (!d->crop[0] && !d->crop[1] && !d->crop[2] && !d->crop[3])
        d->crop[2] = d->width, d->crop[3] = d->height;
}

/* Tables that still serve are kept. */
static WeftResult make_materials(WeftRender *render, WeftError *error) {
    const WeftScene *scene = render->scene;
    size_t count = (size_t)scene->material_count;
    SheenTables *tables;
    WeftResult result = sheen_tables_renew(render->tables, scene, render->desc.threads, &tables, error);
    if (result != WEFT_OK) return result;
    sheen_tables_free_but(render->tables, tables);
    render->tables = tables;
    free(render->materials);
    render->material_count = (int)count;
    render->materials = alloc_array(count, sizeof(PathMaterial));
    if (!render->materials) return fail(error, WEFT_MESSAGE_MEMORY, scene->name, NULL);
    for (size_t k = 0; k < count; k++) {
        const Material *material = &scene->materials[k];
        PathMaterial *known = &render->materials[k];
        known->material = *material;
        known->material.inputs[INPUT_occlusion].texture = 0; /* the paths find it out for themselves */
        known->material.inputs[INPUT_opacity].texture = 0;   /* told by whether there is a hit */
        known->plain = material_plain(material);
        known->choices = material_choices(material);
        for (int input = 0; input < INPUT_COUNT; input++)
            known->textured |= known->material.inputs[input].texture != 0;
        known->sheen_e = sheen_tables_of(render->tables, (int)k);
        Surface surface = frame_surface(known->plain);
        stack_make(&known->stack, &surface, &known->choices, known->sheen_e);
        known->kind = stack_kind(&known->stack, &known->choices);
    }
    return WEFT_OK;
}

/* Positions at equal steps of the integral of the Blackman-Harris window of 1.5 pixels' radius: looking one
 * up at random spreads samples as the window weighs them. Fredric J. Harris, "On the Use of Windows for
 * Harmonic Analysis with the Discrete Fourier Transform", 1978. */
static void filter_make(float filter[FILTER_STEPS + 1]) {
    enum { FINE = 16 * FILTER_STEPS };
    const double radius = 1.5, total = 0.35875;
    double integral = 0.0;
    int step = 0;
    for (int k = 0; k < FINE; k++) {
        double a = 6.28318530717959 * (k + 0.5) / FINE;
        double w = 0.35875 - 0.48829 * (cos)(a) + 0.14128 * (cos)(2.0 * a) - 0.01168 * (cos)(3.0 * a),
               before = integral;
        integral += w / (total * FINE);
        for (; step <= FILTER_STEPS && (double)step / FILTER_STEPS <= integral; step++) {
            double part = ((double)step / FILTER_STEPS - before) / (integral - before);
            filter[step] = (float)(radius * (2.0 * (k + part) / FINE - 1.0));
        }
    }
    for (; step <= FILTER_STEPS; step++) filter[step] = (float)radius;
}

/* The picture's own: camera and an empty film. */
static WeftResult begin_picture(WeftRender *render, WeftError *error) {
    const WeftRenderDesc *d = &render->desc;
    float aspect = (float)d->width / (float)d->height;
    WeftResult result = camera_find(render->scene, d->camera, aspect, &render->camera, error);
    if (result != WEFT_OK) return result;
    render->view = view_of(&render->camera, aspect);
    render->x0 = d->crop[0], render->y0 = d->crop[1], render->width = d->crop[2], render->height = d->crop[3];
    render->tiles_across = (render->width + TILE - 1) / TILE;
    render->tile_count = render->tiles_across * ((render->height + TILE - 1) / TILE);
    free(render->tiles);
    free(render->sums);
    free(render->caught);
    size_t pixels = (size_t)render->width * (size_t)render->height;
    render->floor = floor_of(render->scene, &d->floor);
    render->tiles = alloc_array((size_t)render->tile_count, sizeof(Tile));
    render->sums = alloc_array(pixels, 4 * sizeof(float));
    render->caught = render->floor.there ? alloc_array(pixels, sizeof(Caught)) : NULL;
    render->render_seconds = 0.0;
    if (render->tiles && render->sums && (render->caught || !render->floor.there)) return WEFT_OK;
    render->tile_count = 0;
    return fail(error, WEFT_MESSAGE_MEMORY, render->scene->name, NULL);
}

static WeftResult make_geometry(WeftRender *render, WeftError *error) {
    geometry_free(render->geometry);
    render->geometry = NULL;
    return geometry_create(render->scene, render->scene->mesh_count, render->desc.threads, &render->geometry,
                           error);
}

static WeftResult make_lights(WeftRender *render, WeftError *error) {
    lights_free(render->lights);
    render->lights = NULL;
    return lights_create(render->scene, &render->lights, error);
}

/* Returns true if a material emits light, or did when the render was made. */
static bool any_emits(const WeftRender *render) {
    bool any = false;
    for (int k = 0; k < render->material_count; k++)
        any |= material_emits(&render->scene->materials[k]) || material_emits(&render->materials[k].material);
    return any;
}

static bool in_parts(const Environment *e) {
    return e->ambient < 1.0f || e->ambient > 1.0f || e->reflection < 1.0f || e->reflection > 1.0f;
}

/* Makes what was changed, and what could not be made before. A material may be what shines, and what shadow
 * rays must ask. */
static WeftResult build(WeftRender *render, unsigned changed, WeftError *error) {
    const WeftRenderDesc *d = &render->desc;
    if (!render->materials || render->material_count != render->scene->material_count) changed = ~0u;
    bool shapes = changed & WEFT_CHANGED_SHAPES || !render->geometry || !geometry_serves(render->geometry);
    bool lights = changed & (WEFT_CHANGED_SHAPES | WEFT_CHANGED_LIGHTS) || !render->lights ||
                  (changed && any_emits(render));
    WeftResult result = begin_picture(render, error);
    if (result == WEFT_OK && shapes) result = make_geometry(render, error);
    if (result == WEFT_OK && lights) result = make_lights(render, error);
    if (result == WEFT_OK && changed) result = make_materials(render, error);
    if (result == WEFT_OK)
        render->context = (PathContext){.scene = render->scene,
                                        .geometry = render->geometry,
                                        .lights = render->lights,
                                        .materials = render->materials,
                                        .max_depth = d->max_depth,
                                        .sampling = d->sampling,
                                        .roulette = !d->no_roulette,
                                        .shadows = !d->no_shadows,
                                        .sky_in_parts = in_parts(&render->scene->environment)};
    return result;
}

static bool has_image(const WeftScene *scene) { return scene->environment.kind != ENVIRONMENT_CONSTANT; }

static WeftResult make_blurred(WeftRender *render, WeftError *error) {
    const Environment *e = &render->scene->environment;
    if (render->desc.background != WEFT_BACKGROUND_BLURRED || !has_image(render->scene)) return WEFT_OK;
    if (render->blurred.pixels && render->blurred_turn == e->turn) return WEFT_OK;
    weft_image_free(&render->blurred);
    render->blurred_turn = e->turn;
    return backdrop_blurred(e, &render->blurred, error);
}

WeftResult weft_render_restart(WeftRender *render, const WeftRenderDesc *desc, unsigned changed,
                               WeftError *error) {
    double start = now();
    const WeftScene *scene = render->scene;
    WeftRenderDesc d = *desc;
    set_defaults(&d);
    WeftResult result = check_desc(&d, error);
    if (result != WEFT_OK) return result;
    if (!d.threads) d.threads = thread_count();
    if (d.background == WEFT_BACKGROUND_AUTO)
        d.background = scene->environment.kind == ENVIRONMENT_STUDIO ? WEFT_BACKGROUND_COLOR
                                                                     : WEFT_BACKGROUND_ENVIRONMENT;
    if (desc->background == WEFT_BACKGROUND_AUTO)
        for (int c = 0; c < 3; c++) d.background_color[c] = 0.62f; /* a light grey paper roll */
    render->desc = d;
    result = build(render, changed, error);
    if (result == WEFT_OK) result = make_blurred(render, error);
    render->desc.camera = NULL; /* borrowed only during this call */
    render->build_seconds = now() - start;
    return result;
}

WeftResult weft_render_create(const WeftScene *scene, const WeftRenderDesc *desc, WeftRender **out,
                              WeftError *error) {
    *out = NULL;
    WeftRender *render = alloc_array(1, sizeof *render);
    if (!render) return fail(error, WEFT_MESSAGE_MEMORY, scene->name, NULL);
    render->scene = scene;
    filter_make(render->filter);
    WeftResult result = weft_render_restart(render, desc, 0, error);
    if (result == WEFT_OK)
        *out = render;
    else
        weft_render_free(render);
    return result;
}

void weft_render_free(WeftRender *render) {
    if (!render) return;
    sheen_tables_free(render->tables);
    free(render->materials);
    lights_free(render->lights);
    geometry_free(render->geometry);
    weft_image_free(&render->blurred);
    free(render->tiles);
    free(render->sums);
    free(render->caught);
    free(render);
}

static float filter_offset(const float *filter, float u) {
    float x = u * FILTER_STEPS;
    int k = (int)x;
    return mix(filter[k], filter[k + 1], x - (float)k);
}

static Ray camera_sample(const WeftRender *render, int px, int py, Sampler *sampler) {
    const WeftRenderDesc *d = &render->desc;
    float x = 0.5f, y = 0.5f;
    if (!d->pixel_centre) {
        Point p = sampler_next(sampler).first;
        x += filter_offset(render->filter, p.u), y += filter_offset(render->filter, p.v);
    }
    x = 2.0f * ((float)px + x) / (float)d->width - 1.0f;
    y = 1.0f - 2.0f * ((float)py + y) / (float)d->height;
    CameraRay r = view_ray(&render->view, x, y);
    return (Ray){r.origin,
                 r.direction,
                 0.0f,
                 INFINITY,
                 hash32(sampler->key ^ sampler->index),
                 render->desc.hide_lights != 0};
}

/* Adds the background: colour and coverage. */
static void add_background(const WeftRender *render, Vec3 direction, float *sum) {
    const WeftRenderDesc *d = &render->desc;
    if (d->background == WEFT_BACKGROUND_TRANSPARENT) return;
    Rgb c = {d->background_color[0], d->background_color[1], d->background_color[2]};
    float blurred[3];
    if (d->background == WEFT_BACKGROUND_BLURRED && has_image(render->scene)) {
        backdrop_at(&render->scene->environment, &render->blurred, direction, blurred);
        c = (Rgb){blurred[0], blurred[1], blurred[2]};
    } else if (d->background != WEFT_BACKGROUND_COLOR) {
        c = lights_environment(render->lights, direction).radiance;
    }
    sum[0] += c.r, sum[1] += c.g, sum[2] += c.b, sum[3] += 1.0f;
}

static bool finite(Rgb c) { return c.r + c.g + c.b < INFINITY && c.r + c.g + c.b > -INFINITY; }

/* The floor, where a camera ray meets it before all else; false where it does not. */
static bool add_floor(const WeftRender *render, const Ray *ray, float hit_t, Sampler *sampler, Caught *caught,
                      float *sum, Tile *tile) {
    float t = floor_distance(&render->floor, ray->origin, ray->direction);
    if (t < 0.0f || (hit_t >= 0.0f && hit_t < t)) return false;
    float behind[4] = {0};
    add_background(render, ray->direction, behind);
    catcher_sample(&render->context, &render->floor, ray, t, behind, sampler, caught, sum, &tile->rays);
    return true;
}

/* `count` samples of a pixel, the index-th, from sample `first` on. */
static void sample_pixel(const WeftRender *render, int px, int py, size_t index, int first, int count,
                         Tile *tile) {
    float *sum = render->sums + 4 * index;
    Sampler samplers[GEOMETRY_PACKET];
    Ray rays[GEOMETRY_PACKET] = {0};
    Hit hits[GEOMETRY_PACKET];
    uint32_t key = sampler_key((uint32_t)px, (uint32_t)py, render->desc.seed);
    for (int k = 0; k < count; k++) {
        samplers[k] = sampler_start(key, (uint32_t)(first + k));
        rays[k] = camera_sample(render, px, py, &samplers[k]);
    }
    geometry_hit_packet(render->geometry, count, rays, hits);
    tile->rays += count;
    for (int k = 0; k < count; k++) {
        if (render->floor.there &&
            add_floor(render, &rays[k], hits[k].t, &samplers[k], render->caught + index, sum, tile))
            continue;
        if (hits[k].t < 0.0f) {
            add_background(render, rays[k].direction, sum);
            continue;
        }
        Rgb c = path_radiance(&render->context, rays[k], hits[k], &samplers[k], &tile->rays);
        if (!finite(c)) {
            tile->non_finite++;
            c = (Rgb){0};
        }
        sum[0] += c.r, sum[1] += c.g, sum[2] += c.b, sum[3] += 1.0f;
    }
}

typedef struct Pass {
    WeftRender *render;
    int samples; /* per pixel in this pass, <= PASS_SAMPLES */
    atomic_int stop, finished;
    double deadline; /* INFINITY: none */
    WeftProgress progress;
    void *user;
    double done_before, share; /* progress before this pass, and what this pass adds */
    bool asked_to_stop;
} Pass;

static void render_tile(void *user, int item, int thread) {
    Pass *pass = user;
    WeftRender *render = pass->render;
    if (atomic_load(&pass->stop)) return;
    Tile tile = render->tiles[item]; /* counted in a copy: neighbours in memory belong to other threads */
    int tx = item % render->tiles_across * TILE, ty = item / render->tiles_across * TILE;
    for (int y = ty; y < ty + TILE && y < render->height; y++)
        for (int x = tx; x < tx + TILE && x < render->width; x++) {
            size_t index = (size_t)y * (size_t)render->width + (size_t)x;
            sample_pixel(render, render->x0 + x, render->y0 + y, index, tile.samples, pass->samples, &tile);
        }
    tile.samples += pass->samples;
    render->tiles[item] = tile;
    int finished = atomic_fetch_add(&pass->finished, 1) + 1;
    if (pass->done_before > 0.0 && now() > pass->deadline) atomic_store(&pass->stop, 1);
    if (thread != 0 || !pass->progress) return;
    double fraction = pass->done_before + pass->share * finished / render->tile_count;
    if (pass->progress(pass->user, fraction)) {
        pass->asked_to_stop = true;
        atomic_store(&pass->stop, 1);
    }
}

WeftResult weft_render_run(WeftRender *render, int spp, double seconds, WeftProgress progress, void *user) {
    double start = now();
    Pass pass = {.render = render,
                 .deadline = seconds > 0.0 ? start + seconds : (double)INFINITY,
                 .progress = progress,
                 .user = user};
    atomic_init(&pass.stop, 0);
    /* The first pass is one sample and heeds no deadline, so that even a short time shows all of the picture.
     */
    for (int done = 0; done < spp && !atomic_load(&pass.stop); done += pass.samples) {
        int rest = spp - done;
        pass.samples = done == 0 ? 1 : rest < PASS_SAMPLES ? rest : PASS_SAMPLES;
        pass.done_before = (double)done / spp;
        pass.share = (double)pass.samples / spp;
        atomic_init(&pass.finished, 0);
        parallel_for(render->desc.threads, render->tile_count, render_tile, &pass);
    }
    render->render_seconds += now() - start;
    return pass.asked_to_stop ? WEFT_INTERRUPTED : WEFT_OK;
}

WeftRenderInfo weft_render_info(const WeftRender *render) {
    WeftRenderInfo info = {.build_seconds = render->build_seconds, .render_seconds = render->render_seconds};
    camera_tell(render->scene, &render->camera, info.camera_eye, info.camera_target, &info.camera_fov);
    double samples = 0.0;
    for (int k = 0; k < render->tile_count; k++) {
        int x = k % render->tiles_across * TILE, y = k / render->tiles_across * TILE;
        int w = render->width - x < TILE ? render->width - x : TILE;
        int h = render->height - y < TILE ? render->height - y : TILE;
        samples += (double)render->tiles[k].samples * w * h;
        info.rays += render->tiles[k].rays;
        info.non_finite += render->tiles[k].non_finite;
    }
    info.samples_per_pixel = samples / ((double)render->width * render->height);
    return info;
}

WeftResult weft_render_image(const WeftRender *render, WeftImage *out, WeftError *error) {
    WeftResult result = weft_image_create(render->width, render->height, 4, WEFT_PIXEL_F32, out, error);
    if (result != WEFT_OK) return result;
    float *pixel = out->pixels;
    size_t index = 0;
    for (int y = 0; y < render->height; y++)
        for (int x = 0; x < render->width; x++, pixel += 4, index++) {
            int samples = render->tiles[y / TILE * render->tiles_across + x / TILE].samples;
            float sum[4];
            memcpy(sum, render->sums + 4 * index, sizeof sum);
            if (render->caught) catcher_resolve(&render->caught[index], sum);
            if (!samples || !(sum[3] > 0.0f)) continue;
            for (int c = 0; c < 3; c++) pixel[c] = sum[c] / sum[3]; /* straight alpha */
            pixel[3] = sum[3] / (float)samples;
        }
    return WEFT_OK;
}
