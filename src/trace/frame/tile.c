#include "trace/frame/tile.h"

#include "scene/light/backdrop.h"

/* Adds the background along a camera ray: colour and coverage. */
static void add_background(const TracedPicture *picture, Vec3 direction, float *sum) {
    const WeftRenderDesc *d = &picture->desc;
    if (d->background == WEFT_BACKGROUND_TRANSPARENT) return;
    Rgb c = {d->background_color[0], d->background_color[1], d->background_color[2]};
    float blurred[3];
    if (d->background == WEFT_BACKGROUND_BLURRED && picture->context.scene->environment.kind != ENVIRONMENT_CONSTANT) {
        backdrop_at(&picture->context.scene->environment, &picture->blurred, direction, blurred);
        c = (Rgb){blurred[0], blurred[1], blurred[2]};
    } else if (d->background != WEFT_BACKGROUND_COLOR) {
        c = lights_environment(picture->context.lights, direction).radiance;
    }
    sum[0] += c.r, sum[1] += c.g, sum[2] += c.b, sum[3] += 1.0f;
}

/* Returns the pixels of a tile, and `count` samples of a half after those that it has. */
static LensPart part_of(const TracedPicture *picture, int item, int half, int count) {
    int x = item % picture->film.tiles_across * STREAM_TILE, y = item / picture->film.tiles_across * STREAM_TILE;
    int w = picture->film.width - x, h = picture->film.height - y;
    bool shared = picture->desc.halves == WEFT_HALVES_SHARED;
    return (LensPart){.x = picture->desc.crop[0] + x,
                      .y = picture->desc.crop[1] + y,
                      .width = w < STREAM_TILE ? w : STREAM_TILE,
                      .height = h < STREAM_TILE ? h : STREAM_TILE,
                      .first = picture->film.half[half].samples[item],
                      .count = count,
                      .half = shared ? half : -1,
                      .seed = half && !shared ? hash32(picture->desc.seed + 0x9e3779b9u) : picture->desc.seed};
}

/* Returns the index in the film of a pixel of a tile. */
static size_t index_of(const TracedPicture *picture, const LensPart *part, int pixel) {
    int x = part->x - picture->desc.crop[0] + pixel % part->width,
        y = part->y - picture->desc.crop[1] + pixel / part->width;
    return (size_t)y * (size_t)picture->film.width + (size_t)x;
}

static Ray ray_of(const TracedPicture *picture, const Paths *paths, int k) {
    return (Ray){vec3(paths->origin[0][k], paths->origin[1][k], paths->origin[2][k]),
                 vec3(paths->direction[0][k], paths->direction[1][k], paths->direction[2][k]),
                 0.0f,
                 INFINITY,
                 paths->key[k],
                 picture->desc.hide_lights != 0};
}

/* Finds the nearest hits of n camera rays. */
static void trace_camera(const TracedPicture *picture, Stream *stream, int n) {
    const Paths *paths = &stream->paths[0];
    const RayRows rays = {{paths->origin[0], paths->origin[1], paths->origin[2]},
                          {paths->direction[0], paths->direction[1], paths->direction[2]},
                          NULL,
                          paths->key,
                          picture->desc.hide_lights != 0,
                          true};
    const HitRows hits = stream_hits(stream);
    geometry_hits(picture->context.geometry, &rays, n, &hits);
    stream->rays += n;
}

/* Continues path k along the ray that the floor mirrors. */
static void put_mirrored(Stream *stream, int k, const Mirrored *mirrored) {
    Paths *paths = &stream->paths[0];
    paths->origin[0][k] = mirrored->ray.origin.x, paths->origin[1][k] = mirrored->ray.origin.y,
    paths->origin[2][k] = mirrored->ray.origin.z;
    paths->direction[0][k] = mirrored->ray.direction.x, paths->direction[1][k] = mirrored->ray.direction.y,
    paths->direction[2][k] = mirrored->ray.direction.z;
    paths->key[k] = mirrored->ray.key;
    for (int c = 0; c < 3; c++) paths->throughput[c][k] = mirrored->share;
    stream->t[k] = mirrored->hit.t, stream->u[k] = mirrored->hit.u, stream->v[k] = mirrored->hit.v;
    stream->mesh[k] = mirrored->hit.mesh, stream->triangle[k] = mirrored->hit.triangle;
}

/* Adds the floor if camera ray k meets it before all else, else returns false. The path then ends, or continues along
 * the mirror. */
static bool add_floor(TracedPicture *picture, Stream *stream, const LensPart *part, Caught *film, int k, float sum[4]) {
    uint32_t id = stream->paths[0].id[k], pixel = id >> PATHS_SAMPLES_LOG2;
    uint32_t sample = id & ((1u << PATHS_SAMPLES_LOG2) - 1u);
    CatcherRay from = {
        ray_of(picture, &stream->paths[0], k), 0.0f, {stream->keys.pixel[pixel], stream->keys.sample[sample]}};
    from.t = floor_distance(&picture->floor, from.ray.origin, from.ray.direction);
    if (from.t < 0.0f || (stream->mesh[k] != GEOMETRY_NOTHING && stream->t[k] < from.t)) return false;
    float behind[4] = {0};
    Mirrored mirrored;
    add_background(picture, from.ray.direction, behind);
    Caught *caught = &film[index_of(picture, part, (int)pixel)];
    if (catcher_sample(&picture->context, &picture->floor, &from, behind, caught, sum, &mirrored, &stream->rays))
        put_mirrored(stream, k, &mirrored);
    else
        stream->mesh[k] = STREAM_DONE;
    return true;
}

/* Starts the first hit of a path: seen is 1 if it may meet a surface. */
static void begin_first(FirstHits *first, uint32_t id, float seen) {
    for (int a = 0; a < FIRST_NUMBERS; a++) first->number[a][id] = a == FIRST_SEEN ? seen : 0.0f;
    for (int a = 0; a < PLACE_NUMBERS; a++) first->place[a][id] = 0.0f;
    first->mesh[id] = GEOMETRY_NOTHING;
}

/* Starts the sums of n paths with what camera rays meet before any surface: the floor or the background. The stream
 * adds the environment as a background. */
static void enter(TracedPicture *picture, Stream *stream, const LensPart *part, Caught *caught, int n) {
    bool sky = picture->desc.background == WEFT_BACKGROUND_ENVIRONMENT;
    for (int k = 0; k < n; k++) {
        float sum[4] = {0}, seen = 0.0f;
        if (!picture->floor.there || !add_floor(picture, stream, part, caught, k, sum)) {
            seen = stream->mesh[k] != GEOMETRY_NOTHING ? 1.0f : 0.0f;
            if (stream->mesh[k] != GEOMETRY_NOTHING || sky) {
                sum[3] = 1.0f;
            } else {
                add_background(picture, ray_of(picture, &stream->paths[0], k).direction, sum);
                stream->mesh[k] = STREAM_DONE;
            }
        }
        for (int c = 0; c < 4; c++) stream->radiance.rgba[c][stream->paths[0].id[k]] = sum[c];
        if (stream->first) begin_first(stream->first, stream->paths[0].id[k], seen);
    }
}

/* Adds the samples of a tile to the film; returns how many were not finite. */
static int add_to_film(TracedPicture *picture, const Stream *stream, const LensPart *part, int half) {
    int non_finite = 0;
    for (int pixel = 0; pixel < part->width * part->height; pixel++)
        non_finite += film_add(&picture->film, half, index_of(picture, part, pixel), stream,
                               pixel << PATHS_SAMPLES_LOG2, part->count);
    return non_finite;
}

int tile_render(TracedPicture *picture, Stream *stream, int tile, int half, int samples) {
    LensPart part = part_of(picture, tile, half, samples);
    StageClock *clock = stream->chunk.clock;
    stage_begin(clock);
    int n = lens_rays(&picture->lens, &part, &stream->keys, &stream->paths[0]);
    stage_end(clock, STAGE_CAMERA);
    stream->rays = 0;
    trace_camera(picture, stream, n);
    stage_end(clock, STAGE_CAMERA_HITS);
    enter(picture, stream, &part, picture->film.half[half].caught, n);
    stage_end(clock, STAGE_ENTER);
    stream_follow(stream, n);
    int non_finite = add_to_film(picture, stream, &part, half);
    stage_end(clock, STAGE_FILM);
    picture->film.half[half].samples[tile] += samples;
    return non_finite;
}
