/* render.c - the API of the path tracer (weft/render.h): what a render owns, when it is rebuilt, and its passes */
#define _POSIX_C_SOURCE 200809L
#include <limits.h>
#include <stdatomic.h>
#include <stdlib.h>

#include "base/fail.h"
#include "base/steady_clock.h"
#include "base/thread.h"
#include "scene/light/backdrop.h"
#include "scene/light/environment.h"
#include "scene/light/polygons.h"
#include "scene/record/camera.h"
#include "trace/frame/film_tile.h"
#include "trace/frame/traced.h"
#include "trace/path/path_materials.h"

enum {
    DEFAULT_WIDTH = 960,
    DEFAULT_HEIGHT = 720,
    DEFAULT_DEPTH = 9,
    SIDE_MAX = 65536,
};

/* Counts of a tile's finished work. Only one thread works on a tile at a time. */
typedef struct Tile {
    long long rays, non_finite;
} Tile;

/* A render: the scene prepared for paths, the picture that is being rendered, and one stream a thread. */
struct WeftRender {
    const WeftScene *scene;
    Geometry *geometry;
    Lights *lights;
    SheenTables *tables;
    PathMaterial *materials; /* their sheen_e point into tables */
    int material_count;
    Camera camera;
    TracedPicture picture;
    Stream **streams; /* one a thread */
    int stream_count;
    unsigned blurred_version; /* of the environment that picture.blurred was made from */
    Tile *tiles;
    uint32_t *names[FILM_MATTES]; /* ids of the meshes' objects and materials; NULL without mattes */
    int samples_done[2];          /* samples a pixel that all tiles of a half have */
    double build_seconds, render_seconds;
};

static WeftResult check_desc(const WeftRenderDesc *d, WeftError *error) {
    if (d->width < 1 || d->width > SIDE_MAX || d->height < 1 || d->height > SIDE_MAX)
        return fail(error, WEFT_MESSAGE_DESC, "picture size", "%d x %d; a side is 1 to %d", d->width, d->height,
                    SIDE_MAX);
    const int *c = d->crop;
    if (c[0] < 0 || c[1] < 0 || c[2] < 1 || c[3] < 1 || c[2] > d->width - c[0] || c[3] > d->height - c[1])
        return fail(error, WEFT_MESSAGE_DESC, "crop", "%d,%d,%d,%d is not inside %d x %d", c[0], c[1], c[2], c[3],
                    d->width, d->height);
    if (d->max_depth < 1) return fail(error, WEFT_MESSAGE_DESC, "max depth", "%d; at least 1", d->max_depth);
    if ((unsigned)d->background > WEFT_BACKGROUND_BLURRED || (unsigned)d->sampling > WEFT_SAMPLING_LOBE)
        return fail(error, WEFT_MESSAGE_DESC, "background or sampling", NULL);
    for (int k = 0; k < 3; k++)
        if (!isfinite(d->background_color[k])) return fail(error, WEFT_MESSAGE_DESC, "background color", NULL);
    if (!(d->noise >= 0.0f) || (d->noise > 0.0f && d->halves != WEFT_HALVES_INDEPENDENT))
        return fail(error, WEFT_MESSAGE_DESC, "noise", "%g; above 0 it needs independent halves", (double)d->noise);
    if ((d->places || d->mattes || d->slots) && !d->first_hits)
        return fail(error, WEFT_MESSAGE_DESC, "places, mattes and slots", "they need first_hits");
    if ((unsigned)d->halves > WEFT_HALVES_SHARED) return fail(error, WEFT_MESSAGE_DESC, "halves", "%d", d->halves);
    if (d->threads < 0 || d->threads > WEFT_THREADS_MAX)
        return fail(error, WEFT_MESSAGE_DESC, "threads", "%d", d->threads);
    return floor_check(&d->floor, error);
}

static void set_defaults(WeftRenderDesc *d) {
    if (!d->width) d->width = DEFAULT_WIDTH;
    if (!d->height) d->height = DEFAULT_HEIGHT;
    if (!d->max_depth) d->max_depth = DEFAULT_DEPTH;
    if (!d->crop[0] && !d->crop[1] && !d->crop[2] && !d->crop[3]) d->crop[2] = d->width, d->crop[3] = d->height;
}

/* Prepares the materials, and the sheen tables that they lack. */
static WeftResult make_materials(WeftRender *render, WeftError *error) {
    const WeftScene *scene = render->scene;
    SheenTables *tables;
    WeftResult result = sheen_tables_renew(render->tables, scene, render->picture.desc.threads, &tables, error);
    if (result != WEFT_OK) return result;
    sheen_tables_free_but(render->tables, tables);
    render->tables = tables;
    free(render->materials);
    render->material_count = scene_shaded_materials(scene);
    render->materials = path_materials_create(scene, tables);
    return render->materials ? WEFT_OK : fail(error, WEFT_MESSAGE_MEMORY, scene->name, NULL);
}

static void free_streams(WeftRender *render) {
    for (int k = 0; k < render->stream_count; k++) stream_free(render->streams[k]);
    free(render->streams);
    render->streams = NULL;
    render->stream_count = 0;
}

/* Creates a stream for each thread, but no more than there are tiles. */
static WeftResult make_streams(WeftRender *render, WeftError *error) {
    int threads = render->picture.desc.threads, tiles = render->picture.film.tile_count;
    int wanted = threads < tiles ? threads : tiles;
    free_streams(render);
    render->streams = alloc_array((size_t)wanted, sizeof(Stream *));
    for (int k = 0; render->streams && k < wanted; k++) {
        render->streams[k] = stream_create(&render->picture.context, scene_shaded_materials(render->scene));
        if (!render->streams[k]) break;
        render->stream_count++;
    }
    if (render->stream_count == wanted) return WEFT_OK;
    render->picture.film.tile_count = 0; /* nothing to render */
    return fail(error, WEFT_MESSAGE_MEMORY, render->scene->name, NULL);
}

/* Gives the film the ids of the meshes' objects and materials. Returns false if memory is short. */
static bool name_meshes(WeftRender *render, bool wanted) {
    const WeftScene *scene = render->scene;
    for (int m = 0; m < FILM_MATTES; m++) {
        free(render->names[m]);
        render->names[m] = wanted ? alloc_array((size_t)scene->mesh_count, sizeof(uint32_t)) : NULL;
        render->picture.film.names[m] = render->names[m];
        if (wanted && !render->names[m]) return false;
    }
    for (int k = 0; wanted && k < scene->mesh_count; k++) {
        render->names[FILM_OBJECTS][k] = matte_id(matte_object(scene, k));
        render->names[FILM_MATERIALS][k] = matte_id(matte_material(scene, scene->meshes[k].material));
    }
    return true;
}

/* Begins a picture: finds its camera and makes an empty film. */
static WeftResult begin_picture(WeftRender *render, WeftError *error) {
    TracedPicture *picture = &render->picture;
    const WeftRenderDesc *d = &picture->desc;
    Film *film = &picture->film;
    float aspect = (float)d->width / (float)d->height;
    WeftResult result = camera_find(render->scene, d->camera, aspect, &render->camera, error);
    if (result != WEFT_OK) return result;
    picture->lens.view = view_of(&render->camera, aspect);
    picture->lens.width = d->width, picture->lens.height = d->height;
    picture->lens.centred = d->pixel_centre;
    free(render->tiles);
    film_free(film);
    picture->floor = floor_of(render->scene, &d->floor);
    render->render_seconds = 0.0;
    render->samples_done[0] = render->samples_done[1] = 0;
    const FilmRecords records = {.halves = d->halves != 0,
                                 .hits = d->first_hits != 0,
                                 .places = d->places != 0,
                                 .mattes = d->mattes != 0,
                                 .slots = d->slots != 0,
                                 .floor = picture->floor.there};
    bool made = film_create(film, d->crop[2], d->crop[3], records) && name_meshes(render, records.mattes);
    render->tiles = alloc_array((size_t)film->tile_count, sizeof(Tile));
    if (made && render->tiles) return WEFT_OK;
    film->tile_count = 0;
    return fail(error, WEFT_MESSAGE_MEMORY, render->scene->name, NULL);
}

static WeftResult make_geometry(WeftRender *render, WeftError *error) {
    geometry_free(render->geometry);
    render->geometry = NULL;
    return geometry_create(render->scene, render->scene->mesh_count, render->picture.desc.threads, &render->geometry,
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

static void set_context(WeftRender *render) {
    const WeftRenderDesc *d = &render->picture.desc;
    const View *view = &render->picture.lens.view;
    PathContext *context = &render->picture.context;
    *context = (PathContext){.scene = render->scene,
                             .geometry = render->geometry,
                             .lights = render->lights,
                             .materials = render->materials,
                             .max_depth = d->max_depth,
                             .sampling = d->sampling,
                             .roulette = !d->no_roulette,
                             .shadows = !d->no_shadows,
                             .lift = !d->no_lift,
                             .stages = d->stages != 0,
                             .solids = path_materials_solid(render->materials, scene_shaded_materials(render->scene)),
                             .panes = !d->no_shadows && geometry_has_panes(render->geometry),
                             .sky_in_parts = environment_in_parts(&render->scene->environment),
                             .first_hits = d->first_hits != 0,
                             .places = d->places || d->mattes,
                             .slots = d->slots != 0,
                             .forward = {view->forward.x, view->forward.y, view->forward.z}};
    if (context->solids)
        context->eye_inside = path_eye_inside(context, scene_shaded_materials(render->scene), view->eye);
    context->pixel_width[view->orthographic ? 0 : 1] = 2.0f * sqrtf(vec3_dot(view->up, view->up)) / (float)d->height;
}

/* Rebuilds what `changed` concerns, and what an earlier call failed to make. A changed material rebuilds the lights if
 * it emits or did, and the geometry if its filter of hits differs. */
static WeftResult build(WeftRender *render, unsigned changed, WeftError *error) {
    if (!render->materials || render->material_count != scene_shaded_materials(render->scene)) changed = ~0u;
    bool shapes = changed & WEFT_CHANGED_SHAPES || !render->geometry || !geometry_serves(render->geometry);
    bool lights =
        changed & (WEFT_CHANGED_SHAPES | WEFT_CHANGED_LIGHTS) || !render->lights || (changed && any_emits(render));
    WeftResult result = begin_picture(render, error);
    if (result == WEFT_OK && shapes) result = make_geometry(render, error);
    if (result == WEFT_OK && lights) result = make_lights(render, error);
    if (result == WEFT_OK && changed) result = make_materials(render, error);
    if (result == WEFT_OK) set_context(render);
    if (result == WEFT_OK) result = make_streams(render, error);
    return result;
}

/* Blurs the environment for the background, if it is wanted and the environment has changed. */
static WeftResult make_blurred(WeftRender *render, WeftError *error) {
    const Environment *e = &render->scene->environment;
    if (render->picture.desc.background != WEFT_BACKGROUND_BLURRED || e->kind == ENVIRONMENT_CONSTANT) return WEFT_OK;
    if (render->picture.blurred.pixels && render->blurred_version == e->version) return WEFT_OK;
    weft_image_free(&render->picture.blurred);
    render->blurred_version = e->version;
    return backdrop_blurred(e, &render->picture.blurred, error);
}

WeftResult weft_render_restart(WeftRender *render, const WeftRenderDesc *desc, unsigned changed, WeftError *error) {
    double start = clock_now();
    const WeftScene *scene = render->scene;
    WeftRenderDesc d = *desc;
    set_defaults(&d);
    WeftResult result = check_desc(&d, error);
    if (result != WEFT_OK) return result;
    const Environment *sky = &scene->environment;
    if (d.slots && (sky->ambient < sky->reflection || sky->ambient > sky->reflection))
        return fail(error, WEFT_MESSAGE_DESC, "light by slots",
                    "the environment's ambient and reflection differ, so that slots reflect different light");
    if (!d.threads) d.threads = thread_count();
    if (d.background == WEFT_BACKGROUND_AUTO)
        d.background =
            scene->environment.kind == ENVIRONMENT_STUDIO ? WEFT_BACKGROUND_COLOR : WEFT_BACKGROUND_ENVIRONMENT;
    if (desc->background == WEFT_BACKGROUND_AUTO)
        for (int c = 0; c < 3; c++) d.background_color[c] = 0.62f; /* a light grey paper roll */
    render->picture.desc = d;
    result = build(render, changed, error);
    if (result == WEFT_OK) result = make_blurred(render, error);
    render->picture.desc.camera = NULL; /* borrowed only during this call */
    render->build_seconds = clock_now() - start;
    return result;
}

WeftResult weft_render_create(const WeftScene *scene, const WeftRenderDesc *desc, WeftRender **out, WeftError *error) {
    *out = NULL;
    WeftRender *render = alloc_array(1, sizeof *render);
    if (!render) return fail(error, WEFT_MESSAGE_MEMORY, scene->name, NULL);
    render->scene = scene;
    lens_make(&render->picture.lens);
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
    weft_image_free(&render->picture.blurred);
    free(render->tiles);
    for (int m = 0; m < FILM_MATTES; m++) free(render->names[m]);
    film_free(&render->picture.film);
    free(render);
}

/* Samples that are added to tiles between two looks at progress, noise and deadline. */
typedef struct Pass {
    WeftRender *render;
    int half, target;            /* each tile gets samples until it has so many of a half of the film */
    const unsigned char *wanted; /* of tiles_run, by tile: not 0 if it is to be rendered; NULL: all */
    int spp, tile_count;         /* of tiles_run: samples in all, tiles that are to be rendered */
    atomic_int stop;             /* 1: no tile is started any more */
    atomic_int finished;         /* tiles */
    double deadline;             /* of clock_now(); INFINITY: none */
    WeftProgress progress;
    void *user;
    double done_before, share; /* progress before this pass, and what this pass adds */
    bool interrupted;
} Pass;

/* Reports progress to the caller, in the thread that called weft_render_run. */
static void report_progress(Pass *pass, int finished) {
    double fraction = pass->done_before + pass->share * finished / pass->tile_count;
    if (!pass->progress || !pass->progress(pass->user, fraction)) return;
    pass->interrupted = true;
    atomic_store(&pass->stop, 1);
}

/* Adds samples of a half to a tile. */
static void add_samples(WeftRender *render, int tile, int half, int samples, int thread) {
    Stream *stream = render->streams[thread];
    int non_finite = tile_render(&render->picture, stream, tile, half, samples);
    render->tiles[tile].non_finite += non_finite;
    render->tiles[tile].rays += stream->rays;
}

/* Renders one tile in a thread of parallel_for; user is the Pass. A tile that is ahead, since an earlier run was
 * stopped, waits for the others. */
static void render_tile(void *user, int item, int thread) {
    Pass *pass = user;
    if (atomic_load(&pass->stop)) return;
    const int missing = pass->target - pass->render->picture.film.half[pass->half].samples[item];
    if (missing > 0) add_samples(pass->render, item, pass->half, missing, thread);
    int finished = atomic_fetch_add(&pass->finished, 1) + 1;
    if (pass->done_before > 0.0 && clock_now() > pass->deadline) atomic_store(&pass->stop, 1);
    if (thread == 0) report_progress(pass, finished);
}

/* Chooses the next samples of those that have done[half] and get `rest` more: returns their number, and their half.
 * The first is alone, so that even a short time shows the whole picture. Then samples go up to the next multiple of
 * STREAM_SAMPLES, which are thus the same, bit by bit, whether or not earlier ones were rendered by another run. Halves
 * alternate, and end equal. */
static int next_samples(const int done[2], int halves, int rest, int *half) {
    const int ahead = done[0] - done[1];
    *half = 0;
    if (halves > 1) {
        *half = ahead > 0 ? 1 : 0;
        rest = ahead > 0 && rest > ahead ? ahead : ahead > 0 ? rest : rest - rest / 2;
    }
    const int most = done[*half] ? STREAM_SAMPLES - done[*half] % STREAM_SAMPLES : 1;
    return rest < most ? rest : most;
}

/* Renders all samples of one tile in a thread of parallel_for; user is the Pass. */
static void render_whole_tile(void *user, int item, int thread) {
    Pass *pass = user;
    Film *film = &pass->render->picture.film;
    if (pass->wanted && !pass->wanted[item]) return;
    while (!atomic_load(&pass->stop)) {
        const int done[2] = {film->half[0].samples[item], film->halves > 1 ? film->half[1].samples[item] : 0};
        int half, rest = pass->spp - done[0] - done[1];
        if (rest <= 0) break;
        const int samples = next_samples(done, film->halves, rest, &half);
        add_samples(pass->render, item, half, samples, thread);
        if (thread == 0) report_progress(pass, atomic_load(&pass->finished));
    }
    atomic_fetch_add(&pass->finished, 1);
}

/* Counts the samples that all tiles of a half have. */
static void count_done(WeftRender *render) {
    const Film *film = &render->picture.film;
    for (int half = 0; half < film->halves; half++) {
        int least = film->half[half].samples[0];
        for (int k = 1; k < film->tile_count; k++)
            if (film->half[half].samples[k] < least) least = film->half[half].samples[k];
        render->samples_done[half] = least;
    }
}

enum { NOISE_SAMPLES = 16 }; /* fewer do not suffice to estimate the error */

/* Returns true if the estimated error of the picture is at most desc.noise. */
static bool noise_reached(const WeftRender *render) {
    bool halved = render->picture.film.halves > 1 && render->samples_done[0] == render->samples_done[1];
    if (!halved || !(render->picture.desc.noise > 0.0f) || 2 * render->samples_done[0] < NOISE_SAMPLES) return false;
    double noise = film_noise(&render->picture.film);
    return noise >= 0.0 && noise <= (double)render->picture.desc.noise;
}

WeftResult weft_render_run(WeftRender *render, int spp, double seconds, WeftProgress progress, void *user) {
    double start = clock_now();
    const int tiles = render->picture.film.tile_count;
    Pass pass = {.render = render,
                 .tile_count = tiles,
                 .deadline = seconds > 0.0 ? start + seconds : (double)INFINITY,
                 .progress = progress,
                 .user = user};
    if (tiles) count_done(render);
    bool quiet = noise_reached(render);
    atomic_init(&pass.stop, 0);
    for (int done = 0, samples; done < spp && !quiet && !atomic_load(&pass.stop); done += samples) {
        samples = next_samples(render->samples_done, render->picture.film.halves, spp - done, &pass.half);
        pass.target = render->samples_done[pass.half] + samples;
        pass.done_before = (double)done / spp;
        pass.share = (double)samples / spp;
        atomic_init(&pass.finished, 0);
        parallel_for(render->stream_count, tiles, render_tile, &pass);
        if (atomic_load(&pass.stop)) break;
        report_progress(&pass, tiles); /* those that other threads finished last */
        render->samples_done[pass.half] += samples;
        quiet = noise_reached(render);
    }
    render->render_seconds += clock_now() - start;
    return pass.interrupted ? WEFT_INTERRUPTED : WEFT_OK;
}

int weft_render_samples(const WeftRender *render) {
    const Film *film = &render->picture.film;
    int least = INT_MAX;
    for (int k = 0; k < film->tile_count; k++) {
        const int samples = film->half[0].samples[k] + (film->halves > 1 ? film->half[1].samples[k] : 0);
        if (samples < least) least = samples;
    }
    return film->tile_count ? least : 0;
}

int weft_render_tile_count(const WeftRender *render) { return render->picture.film.tile_count; }

WeftResult weft_render_tiles_run(WeftRender *render, const unsigned char *wanted, int spp, WeftProgress progress,
                                 void *user) {
    double start = clock_now();
    const int tiles = render->picture.film.tile_count;
    Pass pass = {.render = render,
                 .wanted = wanted,
                 .spp = spp,
                 .deadline = (double)INFINITY,
                 .progress = progress,
                 .user = user,
                 .share = 1.0};
    for (int k = 0; k < tiles; k++) pass.tile_count += !wanted || wanted[k];
    if (!pass.tile_count) return WEFT_OK;
    atomic_init(&pass.stop, 0);
    atomic_init(&pass.finished, 0);
    parallel_for(render->stream_count, tiles, render_whole_tile, &pass);
    if (!pass.interrupted) report_progress(&pass, pass.tile_count);
    render->render_seconds += clock_now() - start;
    return pass.interrupted ? WEFT_INTERRUPTED : WEFT_OK;
}

int weft_render_tile_numbers(const WeftRender *render) { return film_pixel_numbers(&render->picture.film); }

void weft_render_tile(const WeftRender *render, int tile, float *numbers) {
    film_tile_get(&render->picture.film, tile, render->tiles[tile].non_finite, numbers);
}

WeftResult weft_render_tile_set(WeftRender *render, int tile, const float *numbers, WeftError *error) {
    if (tile < 0 || tile >= render->picture.film.tile_count)
        return fail(error, WEFT_MESSAGE_DESC, "tile", "%d; there are %d", tile, render->picture.film.tile_count);
    if (film_tile_set(&render->picture.film, tile, numbers, &render->tiles[tile].non_finite)) return WEFT_OK;
    return fail(error, WEFT_MESSAGE_DESC, "sums of a tile", "a number is not finite, or is no number of samples");
}

WeftRenderInfo weft_render_info(const WeftRender *render) {
    WeftRenderInfo info = {.build_seconds = render->build_seconds, .render_seconds = render->render_seconds};
    camera_describe(render->scene, &render->camera, info.camera_eye, info.camera_target, &info.camera_fov);
    const Film *film = &render->picture.film;
    double samples = 0.0;
    for (int k = 0; k < film->tile_count; k++) {
        int x = k % film->tiles_across * STREAM_TILE, y = k / film->tiles_across * STREAM_TILE;
        int w = film->width - x < STREAM_TILE ? film->width - x : STREAM_TILE;
        int h = film->height - y < STREAM_TILE ? film->height - y : STREAM_TILE;
        for (int half = 0; half < film->halves; half++) samples += (double)film->half[half].samples[k] * w * h;
        info.rays += render->tiles[k].rays;
        info.non_finite += render->tiles[k].non_finite;
    }
    info.samples_per_pixel = samples / ((double)film->width * film->height);
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
    return film_image(&render->picture.film, out, error);
}

double weft_render_noise(const WeftRender *render) { return film_noise(&render->picture.film); }

WeftResult weft_render_aov(const WeftRender *render, WeftAov aov, WeftImage *out, WeftError *error) {
    return film_aov(&render->picture.film, aov, out, error);
}

WeftResult weft_render_denoised(const WeftRender *render, WeftDenoiser denoiser, WeftImage *out, WeftError *error) {
    return film_denoise(&render->picture.film, denoiser, render->picture.desc.threads, out, error);
}

const TracedPicture *render_picture(const WeftRender *render) { return &render->picture; }
