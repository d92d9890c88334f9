#include <stdlib.h> /* before the dialect, which makes abs a macro */

#include "trace/path/stream.h"

#include "shading/dialect/loop.h"

Stream *stream_create(const PathContext *context, int materials) {
    Stream *stream = alloc_array(1, sizeof *stream);
    if (!stream) return NULL;
    size_t classes = (size_t)materials + 1;
    stream->context = context;
    stream->chunk.clock = context->stages ? &stream->clock : NULL;
    stream->end = alloc_array(classes, sizeof(int));
    stream->order = alloc_array(PATHS_MAX + classes * ROW_LANES, sizeof(int));
    stream->first = context->first_hits ? alloc_array(1, sizeof(FirstHits)) : NULL;
    stream->slots = context->slots ? alloc_array(1, sizeof(LightBySlot)) : NULL;
    stream->chunk.slots = stream->slots;
    if (stream->end && stream->order && !stream->first == !context->first_hits && !stream->slots == !context->slots)
        return stream;
    stream_free(stream);
    return NULL;
}

void stream_free(Stream *stream) {
    if (!stream) return;
    free(stream->end);
    free(stream->order);
    free(stream->first);
    free(stream->slots);
    free(stream);
}

HitRows stream_hits(Stream *stream) {
    return (HitRows){stream->t, stream->u, stream->v, stream->mesh, stream->triangle};
}

/* Returns true if path k hits its triangle from behind. */
static bool hits_back(const Stream *stream, const Paths *paths, int k) {
    const Mesh *mesh = &stream->context->scene->meshes[stream->mesh[k]];
    const Vec3 winding = geometry_winding(mesh, stream->triangle[k]);
    return vec3_dot(winding, vec3(paths->direction[0][k], paths->direction[1][k], paths->direction[2][k])) > 0.0f;
}

/* Returns the class of path k: 0 if its ray hits nothing, else 1 + the material of the side that it hits. */
static int class_of(const Stream *stream, const Paths *paths, int k) {
    const WeftScene *scene = stream->context->scene;
    const uint32_t mesh = stream->mesh[k];
    if (mesh == GEOMETRY_NOTHING) return 0;
    const int front = scene->meshes[mesh].material, back = scene_back(scene, front);
    return 1 + (back >= 0 && hits_back(stream, paths, k) ? back : front);
}

/* Sorts n paths by their classes into `order`, without paths that have ended (their mesh is STREAM_DONE). Each class
 * begins at a multiple of ROW_LANES, the width of a vector, and its last path is repeated up to the next multiple.
 * end[c] becomes the end of class c, before these copies. */
static void sort_by_class(Stream *stream, const Paths *paths, int n, int classes) {
    int *end = stream->end, place = 0;
    for (int hit_class = 0; hit_class < classes; hit_class++) end[hit_class] = 0;
    for (int k = 0; k < n; k++)
        if (stream->mesh[k] != STREAM_DONE) end[class_of(stream, paths, k)]++;
    for (int hit_class = 0; hit_class < classes; hit_class++) {
        int count = end[hit_class];
        end[hit_class] = place;
        place += row_whole(count);
    }
    for (int k = 0; k < n; k++)
        if (stream->mesh[k] != STREAM_DONE) stream->order[end[class_of(stream, paths, k)]++] = k;
    for (int hit_class = 0; hit_class < classes; hit_class++)
        for (int k = end[hit_class]; k % ROW_LANES; k++) stream->order[k] = stream->order[k - 1];
    stage_end(stream->chunk.clock, STAGE_SORT);
}

/* Copies the directions of n paths into d. LOOP defines a function that is compiled once for each set of instructions,
 * and EACH is a loop in it whose elements are independent. */
LOOP(gather_directions, (const Paths *paths, const int *order, int n, Row d[3]), (paths, order, n, d)) {
    for (int c = 0; c < 3; c++) {
        const float *from = paths->direction[c];
        float *to = d[c];
        EACH(k, (size_t)n) to[k] = from[order[k]];
    }
}

/* Multiplies the environment's radiance along n paths by their throughputs and MIS weights (lobe_weight). */
LOOP(weigh_sky_n,
     (const Paths *paths, bool in_parts, WeftSampling sampling, const int *order, int n, LightRows *restrict sky),
     (paths, in_parts, sampling, order, n, sky)) {
    const float(*throughput)[PATHS_CAPACITY] = in_parts ? paths->sky_throughput : paths->throughput;
    const float *r = throughput[0], *g = throughput[1], *b = throughput[2], *pdf = paths->pdf;
    EACH(k, (size_t)n) {
        int j = order[k];
        float weight = lobe_weight(sampling, pdf[j], sky->pdf[k]);
        sky->radiance[0][k] = r[j] * (sky->radiance[0][k] * weight);
        sky->radiance[1][k] = g[j] * (sky->radiance[1][k] * weight);
        sky->radiance[2][k] = b[j] * (sky->radiance[2][k] * weight);
    }
}

/* Adds the environment's light along the rays of n paths. in_parts: this light has separate factors for diffuse
 * and other reflections, which sky_throughput contains and throughput does not. */
static void add_sky(Stream *stream, const Paths *paths, bool in_parts, const int *order, int n) {
    const PathContext *context = stream->context;
    LightRows *sky = &stream->chunk.light_samples[LIGHTS_SKY];
    Row *d = stream->chunk.wo; /* not in use between chunks */
    int whole = row_whole(n);
    gather_directions(paths, order, whole, d);
    const float *const along[3] = {d[0], d[1], d[2]};
    lights_environment_rows(context->lights, whole, along, sky);

    weigh_sky_n(paths, in_parts, context->sampling, order, whole, sky);
    for (int c = 0; c < 3; c++)
        for (int k = 0; k < n; k++) stream->radiance.rgba[c][paths->id[order[k]]] += sky->radiance[c][k];
}

/* Shades a chunk, which is at most ROW_MOST paths of one class. Appends those that continue to `next`, which has
 * `count` paths so far, and returns its new count. */
static int shade_chunk(Stream *stream, const ChunkSource *source, Paths *next, int count) {
    const PathContext *context = source->context;
    const PathMaterial *material = &context->materials[source->material];
    Chunk *chunk = &stream->chunk;
    chunk_place(chunk, source); /* computes positions and normals, and reads the inputs of the material */
    if (material->emits || material->material.unlit) chunk_add_emission(chunk, source, &stream->radiance);
    bool ends = source->depth == context->max_depth || material->material.unlit;
    if (!ends) chunk_make_frames(chunk, source);
    if (stream->first && source->depth == 0) {
        FirstLook look = ends ? FIRST_LOOK_UNSHADED : material->cloth ? FIRST_LOOK_WOVEN : FIRST_LOOK_PLAIN;
        first_hits_take(stream->first, chunk, source->n, look, context->forward);
        if (context->places) first_hits_place(stream->first, chunk, source->n, context->scene);
    }
    stage_end(chunk->clock, STAGE_FRAMES);
    if (ends) return count;
    chunk_shade(chunk, source);
    for (int g = 0; g < LIGHT_GROUPS; g++)
        if (lights_has_group(context->lights, (LightGroup)g))
            stream->rays += chunk_add_light(chunk, source, (LightGroup)g, &stream->radiance);
    count = chunk_continue(chunk, source, next, count);
    stage_end(chunk->clock, STAGE_CONTINUE);
    return count;
}

/* Shades the paths order[begin .. end - 1], all of one class, in chunks. count and result: as in shade_chunk. */
static int shade_class(Stream *stream, ChunkSource source, int begin, int end, Paths *next, int count) {
    for (int first = begin; first < end; first += ROW_MOST) {
        source.order = stream->order + first;
        source.n = end - first < ROW_MOST ? end - first : ROW_MOST;
        count = shade_chunk(stream, &source, next, count);
    }
    return count;
}

/* Finds the nearest hits of n paths, behind the panes that they pass. */
static void trace(Stream *stream, Paths *paths, int n) {
    const RayRows rays = {{paths->origin[0], paths->origin[1], paths->origin[2]},
                          {paths->direction[0], paths->direction[1], paths->direction[2]},
                          NULL,       /* no far end */
                          paths->key, /* decides hits of partly transparent surfaces */
                          false,      /* polygon lights are hit too */
                          false};     /* neighbours have different directions */
    const HitRows hits = stream_hits(stream);
    geometry_hits(stream->context->geometry, &rays, n, &hits);
    stream->rays += n;
    stream_pass_panes(stream, paths, n);
    stage_end(stream->chunk.clock, STAGE_HITS);
}

/* Adds the environment's light along the rays that leave the scene. If shadows are off, nothing hides the environment:
 * scattered rays that hit something bring its light too. */
static void add_misses(Stream *stream, const Paths *paths, int depth, int classes) {
    const PathContext *context = stream->context;
    const int *end = stream->end, reached = depth > 0 && !context->shadows ? classes : 1;
    for (int hit_class = 0; hit_class < reached; hit_class++)
        for (int k = hit_class ? row_whole(end[hit_class - 1]) : 0; k < end[hit_class]; k += ROW_MOST)
            add_sky(stream, paths, depth > 0 && context->sky_in_parts, stream->order + k,
                    end[hit_class] - k < ROW_MOST ? end[hit_class] - k : ROW_MOST);
    stage_end(stream->chunk.clock, STAGE_MISSES);
}

/* Shades all paths that hit something; returns how many of them continue in `next`. */
static int shade_hits(Stream *stream, const Paths *paths, int depth, int classes, Paths *next) {
    const int *end = stream->end;
    int count = 0;
    ChunkSource source = {.context = stream->context,
                          .paths = paths,
                          .t = stream->t,
                          .u = stream->u,
                          .v = stream->v,
                          .mesh = stream->mesh,
                          .triangle = stream->triangle,
                          .keys = &stream->keys,
                          .depth = depth};
    for (int hit_class = 1; hit_class < classes; hit_class++) {
        source.material = hit_class - 1;
        count = shade_class(stream, source, row_whole(end[hit_class - 1]), end[hit_class], next, count);
    }
    return count;
}

void stream_follow(Stream *stream, int n) {
    int classes = scene_shaded_materials(stream->context->scene) + 1;
    stream->chunk.filled_material = 0; /* the chunk has the inputs of no material */
    if (stream->slots) slot_light_begin(stream->slots);
    for (int depth = 0; n > 0; depth++) {
        Paths *paths = &stream->paths[depth % 2], *next = &stream->paths[(depth + 1) % 2];
        if (depth > 0) trace(stream, paths, n);
        sort_by_class(stream, paths, n, classes);
        add_misses(stream, paths, depth, classes);
        n = shade_hits(stream, paths, depth, classes, next);
        if (stream->slots && depth == 0) slot_light_note(stream->slots, &stream->radiance);
    }
    if (stream->slots) slot_light_end(stream->slots, &stream->radiance);
}
