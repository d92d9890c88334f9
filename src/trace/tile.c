#include "trace/tile.h"

#include "scene/backdrop.h"

/* Adds the background: colour and coverage. */
static void add_background(const TracedPicture *picture, Vec3 direction, float *sum) {
    const WeftRenderDesc *d = &picture->desc;
    if (d->background == WEFT_BACKGROUND_TRANSPARENT) return;
    Rgb c = {d->background_color[0], d->background_color[1], d->background_color[2]};
    float blurred[3];
    if (d->background == WEFT_BACKGROUND_BLURRED &&
        picture->context.scene->environment.kind != ENVIRONMENT_CONSTANT) {
        backdrop_at(&picture->context.scene->environment, &picture->blurred, direction, blurred);
        c = (Rgb){blurred[0], blurred[1], blurred[2]};
    } else if (d->background != WEFT_BACKGROUND_COLOR) {
        c = lights_environment(picture->context.lights, direction).radiance;
    }
    sum[0] += c.r, sum[1] += c.g, sum[2] += c.b, sum[3] += 1.0f;
}

/* A tile's part of a picture and of its samples. */
static LensPart part_of(const TracedPicture *picture, int item, int half, int count) {
    int x = item % picture->film.tiles_across * STREAM_TILE,
        y = item / picture->film.tiles_across * STREAM_TILE;
    int w = picture->film.width - x, h = picture->film.height - y;
    return (LensPart){picture->desc.crop[0] + x,
                      picture->desc.crop[1] + y,
                      w < STREAM_TILE ? w : STREAM_TILE,
                      h < STREAM_TILE ? h : STREAM_TILE,
                      picture->film.half[half].samples[item],
                      count,
                      half ? hash32(picture->desc.seed + 0x9e3779b9u) : picture->desc.seed};
}

static size_t index_of(const TracedPicture *picture, const LensPart *part, int pixel) {
    int x = part->x - picture->desc.crop[0] + pixel % part->width,
        y = part->y - picture->desc.crop[1] + pixel / part->width;
    return (size_t)y * (size_t)picture->film.width + (size_t)x;
}

static Ray ray_of(const TracedPicture *picture, const Paths *paths, int k) {
    return (Ray){vec3(paths->o[0][k], paths->o[1][k], paths->o[2][k]),
                 vec3(paths->d[0][k], paths->d[1][k], paths->d[2][k]),
                 0.0f,
                 INFINITY,
                 paths->key[k],
                 picture->desc.hide_lights != 0};
}

static void trace_camera(const TracedPicture *picture, Stream *s, int n) {
    const Paths *p = &s->paths[0];
    const RayRows rays = {{p->o[0], p->o[1], p->o[2]},
                          {p->d[0], p->d[1], p->d[2]},
                          NULL,
                          p->key,
                          picture->desc.hide_lights != 0,
                          true};
    const HitRows hits = stream_hits(s);
    geometry_hits(picture->context.geometry, &rays, n, &hits);
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
static bool add_floor(TracedPicture *picture, Stream *s, const LensPart *part, Caught *film, int k,
                      float sum[4]) {
    uint32_t id = s->paths[0].id[k], pixel = id >> PATHS_SAMPLES_LOG2;
    uint32_t sample = id & ((1u << PATHS_SAMPLES_LOG2) - 1u);
    CatcherRay from = {
        ray_of(picture, &s->paths[0], k), 0.0f, {s->keys.pixel[pixel], s->keys.sample[sample]}};
    from.t = floor_distance(&picture->floor, from.ray.origin, from.ray.direction);
    if (from.t < 0.0f || (s->mesh[k] != GEOMETRY_NOTHING && s->t[k] < from.t)) return false;
    float behind[4] = {0};
    Mirrored mirrored;
    add_background(picture, from.ray.direction, behind);
    Caught *caught = &film[index_of(picture, part, (int)pixel)];
    if (catcher_sample(&picture->context, &picture->floor, &from, behind, caught, sum, &mirrored, &s->rays))
        take_mirrored(s, k, &mirrored);
    else
        s->mesh[k] = STREAM_DONE;
    return true;
}

/* Adds what camera rays meet before any surface: the floor, the background. That of the environment is left to the
 * stream. */
static void enter(TracedPicture *picture, Stream *s, const LensPart *part, Caught *caught, int n) {
    bool sky = picture->desc.background == WEFT_BACKGROUND_ENVIRONMENT;
    for (int k = 0; k < n; k++) {
        float sum[4] = {0}, seen = 0.0f;
        if (!picture->floor.there || !add_floor(picture, s, part, caught, k, sum)) {
            seen = s->mesh[k] != GEOMETRY_NOTHING ? 1.0f : 0.0f;
            if (s->mesh[k] != GEOMETRY_NOTHING || sky) {
                sum[3] = 1.0f;
            } else {
                add_background(picture, ray_of(picture, &s->paths[0], k).direction, sum);
                s->mesh[k] = STREAM_DONE;
            }
        }
        for (int c = 0; c < 4; c++) s->light.c[c][s->paths[0].id[k]] = sum[c];
        for (int a = 0; s->first && a < FIRST_NUMBERS; a++)
            s->first->number[a][s->paths[0].id[k]] = a == FIRST_SEEN ? seen : 0.0f;
    }
}

static int sum_up(TracedPicture *picture, const Stream *s, const LensPart *part, int half) {
    int non_finite = 0;
    for (int pixel = 0; pixel < part->width * part->height; pixel++)
        non_finite += film_add(&picture->film, half, index_of(picture, part, pixel), s,
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
    int non_finite = sum_up(picture, stream, &part, half);
    stage_end(clock, STAGE_FILM);
    picture->film.half[half].samples[tile] += samples;
    return non_finite;
}
