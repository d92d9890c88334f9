/* stream.h - the paths of a tile, all of them a step at a time, as arrays
 *
 * At each depth the rays of all paths are traced in packets, sorted by the material that they hit, and shaded a chunk
 * of one material at a time; the paths that continue are the rays of the next depth. The light that a path brings is
 * summed under its id, and each chunk adds to it in the same order. Sums therefore do not depend on where in an array a
 * path is. */
#pragma once

#include "trace/path/first_hit.h"
#include "trace/path/slot_light.h"

enum {
    STREAM_TILE = 16, /* pixels a side */
    STREAM_PIXELS = STREAM_TILE * STREAM_TILE,
    STREAM_SAMPLES = 16, /* of a pixel at a time, at most */
};

/* One thread's work on a tile. */
typedef struct Stream {
    const PathContext *context;
    Paths paths[2];                                                /* of this depth and of the next, alternately */
    float t[PATHS_CAPACITY], u[PATHS_CAPACITY], v[PATHS_CAPACITY]; /* their hits, as in HitRows */
    uint32_t mesh[PATHS_CAPACITY], triangle[PATHS_CAPACITY];
    PathRadiance radiance;
    FirstHits *first;   /* NULL if first hits are not recorded */
    LightBySlot *slots; /* NULL if light is not divided by slots */
    PathKeys keys;
    Chunk chunk;
    StageClock clock; /* the chunk has its address if stages are timed */
    int *order;       /* indices of paths, sorted by class: 0 if nothing is hit, else 1 + the material */
    int *end;         /* of each class in order */
    long long rays;   /* traced since the caller set it to 0 */
} Stream;

/* Returns the arrays of one thread, for a scene with so many materials; NULL if memory is short. */
Stream *stream_create(const PathContext *context, int materials);
void stream_free(Stream *stream);

/* Returns the stream's hits in the form that geometry_hits fills. */
HitRows stream_hits(Stream *stream);

/* Sends those of n paths on that pass the panes that they hit (panes.c). */
void stream_pass_panes(Stream *stream, Paths *paths, int n);

/* Follows the first n paths of paths[0], whose hits are filled, to their ends. A path whose mesh is STREAM_DONE has
 * ended already. */
#define STREAM_DONE (GEOMETRY_NOTHING - 1)
void stream_follow(Stream *stream, int n);
