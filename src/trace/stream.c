#include <stdlib.h> /* before the dialect, whose abs() shadows its own */

#include "trace/stream.h"

#include "shading/dialect/loop.h"

Stream *stream_create(const PathContext *context, int materials) {
    Stream *stream = alloc_array(1, sizeof *stream);
    if (!stream) return NULL;
    size_t classes = (size_t)materials + 1;
    stream->context = context;
    stream->chunk.clock = context->stages ? &stream->clock : NULL;
    stream->end = alloc_array(classes, sizeof(int));
    stream->order = alloc_array(PATHS_MOST + classes * ROW_LANES, sizeof(int));
    stream->first = context->first_hits ? alloc_array(1, sizeof(FirstHits)) : NULL;
    if (stream->end && stream->order && !stream->first == !context->first_hits) return stream;
    stream_free(stream);
    return NULL;
}

void stream_free(Stream *stream) {
    if (!stream) return;
    free(stream->end);
    free(stream->order);
    free(stream->first);
    free(stream);
}

HitRows stream_hits(Stream *s) { return (HitRows){s->t, s->u, s->v, s->mesh, s->triangle}; }

/* Nothing, or the material. */
static int class_of(const Stream *s, int k) {
    uint32_t mesh = s->mesh[k];
    return mesh == GEOMETRY_NOTHING ? 0 : 1 + s->context->scene->meshes[mesh].material;
}

/* Puts n paths in the order of their classes. Each class begins at a multiple of ROW_LANES, and what is left
 * up to the next repeats a path. */
static void sort(Stream *s, int n, int classes) {
    int *end = s->end, place = 0;
    for (int c = 0; c < classes; c++) end[c] = 0;
    for (int k = 0; k < n; k++)
        if (s->mesh[k] != STREAM_DONE) end[class_of(s, k)]++;
    for (int c = 0; c < classes; c++) {
        int count = end[c];
        end[c] = place;
        place += row_whole(count);
    }
    for (int k = 0; k < n; k++)
        if (s->mesh[k] != STREAM_DONE) s->order[end[class_of(s, k)]++] = k;
    for (int c = 0; c < classes; c++)
        for (int k = end[c]; k % ROW_LANES; k++) s->order[k] = s->order[k - 1];
}

LOOP(take_directions, (const Paths *paths, const int *order, int n, Row d[3]), (paths, order, n, d)) {
    for (int c = 0; c < 3; c++) {
        const float *from = paths->d[c];
        float *to = d[c];
        EACH(k, (size_t)n) to[k] = from[order[k]];
    }
}

/* Makes radiance along paths what they bring of it. */
LOOP(weigh_sky_n,
     (const Paths *paths, bool in_parts, WeftSampling sampling, const int *order, int n,
      LightRows *restrict sky),
     (paths, in_parts, sampling, order, n, sky)) {
    const float(*worth)[PATHS_ROOM] = in_parts ? paths->sky : paths->throughput;
    const float *r = worth[0], *g = worth[1], *b = worth[2], *pdf = paths->pdf;
    EACH(k, (size_t)n) {
        int j = order[k];
        float weight = lobe_weight(sampling, pdf[j], sky->pdf[k]);
        sky->radiance[0][k] = r[j] * (sky->radiance[0][k] * weight);
        sky->radiance[1][k] = g[j] * (sky->radiance[1][k] * weight);
        sky->radiance[2][k] = b[j] * (sky->radiance[2][k] * weight);
    }
}

/* Adds what the environment sends along paths that leave the scene. in_parts: they know what its light is worth
 * apart from other light. */
static void add_sky(Stream *s, const Paths *paths, bool in_parts, const int *order, int n) {
    const PathContext *context = s->context;
    LightRows *sky = &s->chunk.light[LIGHTS_SKY];
    Row *d = s->chunk.wo;
    int whole = row_whole(n);
    take_directions(paths, order, whole, d);
    const float *const along[3] = {d[0], d[1], d[2]};
    lights_environment_rows(context->lights, whole, along, sky);

    weigh_sky_n(paths, in_parts, context->sampling, order, whole, sky);
    for (int c = 0; c < 3; c++)
        for (int k = 0; k < n; k++) s->light.c[c][paths->id[order[k]]] += sky->radiance[c][k];
}

/* Shades a chunk; returns how many paths go on. */
static int shade(Stream *s, const ChunkSource *source, Paths *next, int at) {
    const PathContext *context = source->context;
    const PathMaterial *material = &context->materials[source->material];
    Chunk *chunk = &s->chunk;
    chunk_place(chunk, source);
    if (material->shines || material->material.unlit) chunk_add_emission(chunk, source, &s->light);
    bool ends = source->depth == context->max_depth || material->material.unlit;
    if (!ends) chunk_turn(chunk, source);
    if (s->first && source->depth == 0)
        first_hits_take(s->first, chunk, source->n, ends ? chunk->normal : chunk->frame[2], context->forward);
    stage_end(chunk->clock, STAGE_TURN);
    if (ends) return at;
    chunk_shade(chunk, source);
    for (int g = 0; g < LIGHT_GROUPS; g++)
        if (lights_shine(context->lights, (LightGroup)g))
            s->rays += chunk_add_light(chunk, source, (LightGroup)g, &s->light);
    at = chunk_go_on(chunk, source, next, at);
    stage_end(chunk->clock, STAGE_GO_ON);
    return at;
}

static int shade_class(Stream *s, ChunkSource source, int begin, int end, Paths *next, int at) {
    for (int first = begin; first < end; first += ROW_MOST) {
        source.order = s->order + first;
        source.n = end - first < ROW_MOST ? end - first : ROW_MOST;
        at = shade(s, &source, next, at);
    }
    return at;
}

static void trace(Stream *s, const Paths *paths, int n) {
    const RayRows rays = {{paths->o[0], paths->o[1], paths->o[2]},
                          {paths->d[0], paths->d[1], paths->d[2]},
                          NULL,
                          paths->key,
                          false,
                          false};
    const HitRows hits = stream_hits(s);
    geometry_hits(s->context->geometry, &rays, n, &hits);
    s->rays += n;
    stage_end(s->chunk.clock, STAGE_HITS);
}

void stream_follow(Stream *s, int n) {
    int classes = s->context->scene->material_count + 1;
    s->chunk.filled = 0;
    for (int depth = 0; n > 0; depth++) {
        const Paths *paths = &s->paths[depth % 2];
        Paths *next = &s->paths[(depth + 1) % 2];
        if (depth > 0) trace(s, paths, n);
        sort(s, n, classes);
        stage_end(s->chunk.clock, STAGE_SORT);
        const int *end = s->end;
        /* without shadows the environment reaches a surface along every ray that leaves it, whatever that hits */
        const int reached = depth > 0 && !s->context->shadows ? classes : 1;
        for (int c = 0; c < reached; c++)
            for (int k = c ? row_whole(end[c - 1]) : 0; k < end[c]; k += ROW_MOST)
                add_sky(s, paths, depth > 0 && s->context->sky_in_parts, s->order + k,
                        end[c] - k < ROW_MOST ? end[c] - k : ROW_MOST);
        stage_end(s->chunk.clock, STAGE_MISSES);
        ChunkSource source = {.context = s->context,
                              .paths = paths,
                              .t = s->t,
                              .u = s->u,
                              .v = s->v,
                              .mesh = s->mesh,
                              .triangle = s->triangle,
                              .keys = &s->keys,
                              .depth = depth};
        int left = 0;
        for (int c = 1; c < classes; c++) {
            source.material = c - 1;
            left = shade_class(s, source, row_whole(end[c - 1]), end[c], next, left);
        }
        n = left;
    }
}
