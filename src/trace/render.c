#define _POSIX_C_SOURCE 200809L
#include <stdatomic.h>
#include <stdlib.h>

#include "base/fail.h"
#include "base/steady_clock.h"
#include "base/thread.h"
#include "scene/light/backdrop.h"
#include "scene/light/polygons.h"
#include "scene/light/sheen_tables.h"
#include "scene/record/camera.h"
#include "scene/record/material_at.h"
#include "shading/stack/frame.h"
#include "trace/film.h"
#include "trace/lens.h"

enum {
    DEFAULT_WIDTH = 960,
    DEFAULT_HEIGHT = 720,
    DEFAULT_DEPTH = 9,
    SIDE_MAX = 65536,
};

/* One tile's finished work, beside its samples. Only one thread holds a tile at a time. */
typedef struct Tile {
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
    Lens lens;
    Stream **streams; /* one a thread */
    int stream_count;
    WeftImage blurred; /* of backdrop.h, where it is the background; its environment was that of */
    unsigned blurred_turn;
    int x0, y0, width, height; /* the crop */
    int tiles_across, tile_count;
    Tile *tiles;
    Film film;
    int given[2]; /* samples that all tiles of a half have */
    Floor floor;
    double build_seconds, render_seconds;
};

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
    if (!(d->noise >= 0.0f) || (d->noise > 0.0f && !d->halves))
        return fail(error, WEFT_MESSAGE_DESC, "noise", "%g; above 0 it needs halves", (double)d->noise);
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
        known->material.inputs[INPUT_opacity].texture = 0;   /* opacity is decided by the hit itself */
        known->plain = material_plain(material);
        known->choices = material_choices(material);
        for (int input = 0; input < INPUT_COUNT; input++) {
            const Input *of = &known->material.inputs[input];
            known->textured |= of->texture != 0;
            known->texcoords[of->texcoord] |= of->texture != 0;
        }
        known->cloth = material->cloth ? scene->cloths[material->cloth - 1] : NULL;
        known->textured |= known->cloth != NULL;
        known->texcoords[0] |= known->cloth != NULL;
        known->sheen_e = sheen_tables_of(render->tables, (int)k);
        Surface surface = frame_surface(known->plain);
        stack_make(&known->stack, &surface, &known->choices, known->sheen_e);
        known->transmits = known->stack.transmission > 0.0f;
        known->measured = material->measured ? scene->measured[material->measured - 1] : NULL;
        if (known->cloth) {
            const Lobe yarn = lobe_default(LOBE_YARN);
            stack_put_base(&known->stack, &yarn, rgb_grey(1.0f), rgb_grey(1.0f));
        }
        known->kind = known->measured ? NULL : stack_kind(&known->stack, &known->choices);
        known->shines = material_emits(material);
        known->bent = !known->kind || known->cloth || known->material.inputs[INPUT_normal].texture ||
                      known->material.inputs[INPUT_clearcoat_normal].texture ||
                      known->plain.anisotropy > 0.0f;
    }
    for (int k = 0; k < scene->mesh_count; k++) {
        PathMaterial *known = &render->materials[scene->meshes[k].material];
        known->colored |= scene->meshes[k].color != NULL;
        known->textured |= known->colored;
    }
    return WEFT_OK;
}

static void free_streams(WeftRender *render) {
    for (int k = 0; k < render->stream_count; k++) stream_free(render->streams[k]);
    free(render->streams);
    render->streams = NULL;
    render->stream_count = 0;
}

/* No more than have a tile. */
static WeftResult make_streams(WeftRender *render, WeftError *error) {
    int wanted = render->desc.threads < render->tile_count ? render->desc.threads : render->tile_count;
    free_streams(render);
    render->streams = alloc_array((size_t)wanted, sizeof(Stream *));
    for (int k = 0; render->streams && k < wanted; k++) {
        render->streams[k] = stream_create(&render->context, render->scene->material_count);
        if (!render->streams[k]) break;
        render->stream_count++;
    }
    if (render->stream_count == wanted) return WEFT_OK;
    render->tile_count = 0; /* nothing to render */
    return fail(error, WEFT_MESSAGE_MEMORY, render->scene->name, NULL);
}

/* The picture's own: camera and an empty film. */
static WeftResult begin_picture(WeftRender *render, WeftError *error) {
    const WeftRenderDesc *d = &render->desc;
    float aspect = (float)d->width / (float)d->height;
    WeftResult result = camera_find(render->scene, d->camera, aspect, &render->camera, error);
    if (result != WEFT_OK) return result;
    render->lens.view = view_of(&render->camera, aspect);
    render->lens.width = d->width, render->lens.height = d->height, render->lens.centred = d->pixel_centre;
    render->x0 = d->crop[0], render->y0 = d->crop[1], render->width = d->crop[2], render->height = d->crop[3];
    render->tiles_across = (render->width + STREAM_TILE - 1) / STREAM_TILE;
    render->tile_count = render->tiles_across * ((render->height + STREAM_TILE - 1) / STREAM_TILE);
    free(render->tiles);
    film_free(&render->film);
    render->floor = floor_of(render->scene, &d->floor);
    render->tiles = alloc_array((size_t)render->tile_count, sizeof(Tile));
    render->render_seconds = 0.0;
    render->given[0] = render->given[1] = 0;
    if (film_create(&render->film, render->width, render->height, d->halves, d->first_hits,
                    render->floor.there) &&
        render->tiles)
        return WEFT_OK;
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
                                        .lift = !d->no_lift,
                                        .stages = d->stages != 0,
                                        .sky_in_parts = in_parts(&render->scene->environment),
                                        .first_hits = d->first_hits != 0,
                                        .forward = {render->lens.view.forward.x, render->lens.view.forward.y,
                                                    render->lens.view.forward.z}};
    if (result == WEFT_OK) {
        const View *view = &render->lens.view;
        render->context.pixel[view->orthographic ? 0 : 1] =
            2.0f * sqrtf(vec3_dot(view->up, view->up)) / (float)d->height;
    }
    if (result == WEFT_OK) result = make_streams(render, error);
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
    double start = clock_now();
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
    render->build_seconds = clock_now() - start;
    return result;
}

WeftResult weft_render_create(const WeftScene *scene, const WeftRenderDesc *desc, WeftRender **out,
                              WeftError *error) {
    *out = NULL;
    WeftRender *render = alloc_array(1, sizeof *render);
    if (!render) return fail(error, WEFT_MESSAGE_MEMORY, scene->name, NULL);
    render->scene = scene;
    lens_make(&render->lens);
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
    free_streams(render);
    lights_free(render->lights);
    geometry_free(render->geometry);
    weft_image_free(&render->blurred);
    free(render->tiles);
    film_free(&render->film);
    free(render);
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

/* A tile's part of a picture and of its samples. */
static LensPart part_of(const WeftRender *render, int item, int half, int count) {
    int x = item % render->tiles_across * STREAM_TILE, y = item / render->tiles_across * STREAM_TILE;
    int w = render->width - x, h = render->height - y;
    return (LensPart){render->x0 + x,
                      render->y0 + y,
                      w < STREAM_TILE ? w : STREAM_TILE,
                      h < STREAM_TILE ? h : STREAM_TILE,
                      render->film.half[half].samples[item],
                      count,
                      half ? hash32(render->desc.seed + 0x9e3779b9u) : render->desc.seed};
}

static size_t index_of(const WeftRender *render, const LensPart *part, int pixel) {
    int x = part->x - render->x0 + pixel % part->width, y = part->y - render->y0 + pixel / part->width;
    return (size_t)y * (size_t)render->width + (size_t)x;
}

static Ray ray_of(const WeftRender *render, const Paths *paths, int k) {
    return (Ray){vec3(paths->o[0][k], paths->o[1][k], paths->o[2][k]),
                 vec3(paths->d[0][k], paths->d[1][k], paths->d[2][k]),
                 0.0f,
                 INFINITY,
                 paths->key[k],
                 render->desc.hide_lights != 0};
}

static void trace_camera(const WeftRender *render, Stream *s, int n) {
    const Paths *p = &s->paths[0];
    const RayRows rays = {{p->o[0], p->o[1], p->o[2]},
                          {p->d[0], p->d[1], p->d[2]},
                          NULL,
                          p->key,
                          render->desc.hide_lights != 0,
                          true};
    const HitRows hits = stream_hits(s);
    geometry_hits(render->geometry, &rays, n, &hits);
    s->rays += n;
}

/* Lets a path go on along the mirror. */
static void take_mirrored(Stream *s, int k, const Mirrored *m) {
    Paths *p = &s->paths[0];
    p->o[0][k] = m->ray.origin.x, p->o[1][k] = m->ray.origin.y, p->o[2][k] = m->ray.origin.z;
    p->d[0][k] = m->ray.direction.x, p->d[1][k] = m->ray.direction.y, p->d[2][k] = m->ray.direction.z;
    p->key[k] = m->ray.key;
    for (int c = 0; c < 3; c++) p->throughput[c][k] = m->share;
    s->t[k] = m->hit.t, s->u[k] = m->hit.u, s->v[k] = m->hit.v;
    s->mesh[k] = m->hit.mesh, s->triangle[k] = m->hit.triangle;
}

/* The floor, where a camera ray meets it before all else; false where it does not. */
static bool add_floor(WeftRender *render, Stream *s, const LensPart *part, Caught *film, int k,
                      float sum[4]) {
    uint32_t id = s->paths[0].id[k], pixel = id >> PATHS_SAMPLES_LOG2;
    uint32_t sample = id & ((1u << PATHS_SAMPLES_LOG2) - 1u);
    CatcherRay from = {ray_of(render, &s->paths[0], k), 0.0f, {s->keys.pixel[pixel], s->keys.sample[sample]}};
    from.t = floor_distance(&render->floor, from.ray.origin, from.ray.direction);
    if (from.t < 0.0f || (s->mesh[k] != GEOMETRY_NOTHING && s->t[k] < from.t)) return false;
    float behind[4] = {0};
    Mirrored mirrored;
    add_background(render, from.ray.direction, behind);
    Caught *caught = &film[index_of(render, part, (int)pixel)];
    if (catcher_sample(&render->context, &render->floor, &from, behind, caught, sum, &mirrored, &s->rays))
        take_mirrored(s, k, &mirrored);
    else
        s->mesh[k] = STREAM_DONE;
    return true;
}

/* Adds what camera rays meet before any surface: the floor, the background. That of the environment is left to the
 * stream. */
static void enter(WeftRender *render, Stream *s, const LensPart *part, Caught *caught, int n) {
    bool sky = render->desc.background == WEFT_BACKGROUND_ENVIRONMENT;
    for (int k = 0; k < n; k++) {
        float sum[4] = {0}, seen = 0.0f;
        if (!render->floor.there || !add_floor(render, s, part, caught, k, sum)) {
            seen = s->mesh[k] != GEOMETRY_NOTHING ? 1.0f : 0.0f;
            if (s->mesh[k] != GEOMETRY_NOTHING || sky) {
                sum[3] = 1.0f;
            } else {
                add_background(render, ray_of(render, &s->paths[0], k).direction, sum);
                s->mesh[k] = STREAM_DONE;
            }
        }
        for (int c = 0; c < 4; c++) s->light.c[c][s->paths[0].id[k]] = sum[c];
        for (int a = 0; s->first && a < FIRST_NUMBERS; a++)
            s->first->number[a][s->paths[0].id[k]] = a == FIRST_SEEN ? seen : 0.0f;
    }
}

static int sum_up(WeftRender *render, const Stream *s, const LensPart *part, int half) {
    int non_finite = 0;
    for (int pixel = 0; pixel < part->width * part->height; pixel++)
        non_finite += film_add(&render->film, half, index_of(render, part, pixel), s,
                               pixel << PATHS_SAMPLES_LOG2, part->count);
    return non_finite;
}

typedef struct Pass {
    WeftRender *render;
    int samples, half; /* per pixel in this pass, <= STREAM_SAMPLES, and for which half of the film */
    atomic_int stop, finished;
    double deadline; /* INFINITY: none */
    WeftProgress progress;
    void *user;
    double done_before, share; /* progress before this pass, and what this pass adds */
    bool asked_to_stop;
} Pass;

/* Called in the thread that called weft_render_run. */
static void report_progress(Pass *pass, int finished) {
    double fraction = pass->done_before + pass->share * finished / pass->render->tile_count;
    if (!pass->progress || !pass->progress(pass->user, fraction)) return;
    pass->asked_to_stop = true;
    atomic_store(&pass->stop, 1);
}

static void render_tile(void *user, int item, int thread) {
    Pass *pass = user;
    WeftRender *render = pass->render;
    if (atomic_load(&pass->stop)) return;
    Tile tile = render->tiles[item]; /* counted in a copy: neighbours in memory belong to other threads */
    Stream *stream = render->streams[thread];
    FilmHalf *half = &render->film.half[pass->half];
    LensPart part = part_of(render, item, pass->half, pass->samples);
    StageClock *clock = stream->chunk.clock;
    stage_begin(clock);
    int n = lens_rays(&render->lens, &part, &stream->keys, &stream->paths[0]);
    stage_end(clock, STAGE_CAMERA);
    stream->rays = 0;
    trace_camera(render, stream, n);
    stage_end(clock, STAGE_CAMERA_HITS);
    enter(render, stream, &part, half->caught, n);
    stage_end(clock, STAGE_ENTER);
    stream_follow(stream, n);
    tile.non_finite += sum_up(render, stream, &part, pass->half);
    stage_end(clock, STAGE_FILM);
    tile.rays += stream->rays;
    half->samples[item] += pass->samples;
    render->tiles[item] = tile;
    int finished = atomic_fetch_add(&pass->finished, 1) + 1;
    if (pass->done_before > 0.0 && clock_now() > pass->deadline) atomic_store(&pass->stop, 1);
    if (thread == 0) report_progress(pass, finished);
}

/* Chooses the next pass of those that give `rest` samples. The first of a run is one sample and heeds no
 * deadline, so that even a short time shows all of the picture. Halves take turns, and are made equal. */
static void choose_pass(Pass *pass, bool first, int rest) {
    const WeftRender *render = pass->render;
    int most = first ? 1 : STREAM_SAMPLES, ahead = render->given[0] - render->given[1];
    if (render->film.halves > 1) {
        pass->half = ahead > 0 ? 1 : 0;
        rest = ahead > 0 && rest > ahead ? ahead : ahead > 0 ? rest : rest - rest / 2;
    }
    pass->samples = rest < most ? rest : most;
}

/* Fewer samples show too little to judge the error by. */
enum { NOISE_SAMPLES = 16 };

/* Returns true if the error of the picture is as small as asked for. */
static bool quiet_enough(const WeftRender *render) {
    bool halved = render->film.halves > 1 && render->given[0] == render->given[1];
    if (!halved || !(render->desc.noise > 0.0f) || 2 * render->given[0] < NOISE_SAMPLES) return false;
    double noise = film_noise(&render->film);
    return noise >= 0.0 && noise <= (double)render->desc.noise;
}

WeftResult weft_render_run(WeftRender *render, int spp, double seconds, WeftProgress progress, void *user) {
    double start = clock_now();
    Pass pass = {.render = render,
                 .deadline = seconds > 0.0 ? start + seconds : (double)INFINITY,
                 .progress = progress,
                 .user = user};
    bool quiet = quiet_enough(render);
    atomic_init(&pass.stop, 0);
    for (int done = 0; done < spp && !quiet && !atomic_load(&pass.stop); done += pass.samples) {
        choose_pass(&pass, done == 0, spp - done);
        pass.done_before = (double)done / spp;
        pass.share = (double)pass.samples / spp;
        atomic_init(&pass.finished, 0);
        parallel_for(render->stream_count, render->tile_count, render_tile, &pass);
        if (atomic_load(&pass.stop)) break;
        report_progress(&pass, render->tile_count); /* the tiles that other threads finished last */
        render->given[pass.half] += pass.samples;
        quiet = quiet_enough(render);
    }
    render->render_seconds += clock_now() - start;
    return pass.asked_to_stop ? WEFT_INTERRUPTED : WEFT_OK;
}

WeftRenderInfo weft_render_info(const WeftRender *render) {
    WeftRenderInfo info = {.build_seconds = render->build_seconds, .render_seconds = render->render_seconds};
    camera_tell(render->scene, &render->camera, info.camera_eye, info.camera_target, &info.camera_fov);
    double samples = 0.0;
    for (int k = 0; k < render->tile_count; k++) {
        int x = k % render->tiles_across * STREAM_TILE, y = k / render->tiles_across * STREAM_TILE;
        int w = render->width - x < STREAM_TILE ? render->width - x : STREAM_TILE;
        int h = render->height - y < STREAM_TILE ? render->height - y : STREAM_TILE;
        for (int half = 0; half < render->film.halves; half++)
            samples += (double)render->film.half[half].samples[k] * w * h;
        info.rays += render->tiles[k].rays;
        info.non_finite += render->tiles[k].non_finite;
    }
    info.samples_per_pixel = samples / ((double)render->width * render->height);
    return info;
}

int weft_render_stage(const WeftRender *render, int stage, WeftRenderStage *out) {
#define STAGE_ROW(NAME, name, embree) {name, 0.0, embree},
    static const WeftRenderStage stages[STAGE_COUNT] = {TRACE_STAGES(STAGE_ROW)};
    if (stage < 0 || stage >= STAGE_COUNT) return 0;
    *out = stages[stage];
    for (int k = 0; k < render->stream_count; k++) out->seconds += render->streams[k]->clock.spent[stage];
    return 1;
}

WeftResult weft_render_image(const WeftRender *render, WeftImage *out, WeftError *error) {
    return film_image(&render->film, out, error);
}

double weft_render_noise(const WeftRender *render) { return film_noise(&render->film); }

WeftResult weft_render_aov(const WeftRender *render, WeftAov aov, WeftImage *out, WeftError *error) {
    return film_aov(&render->film, aov, out, error);
}

WeftResult weft_render_denoised(const WeftRender *render, WeftDenoiser denoiser, WeftImage *out,
                                WeftError *error) {
    return film_denoise(&render->film, denoiser, render->desc.threads, out, error);
}
