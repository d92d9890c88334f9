/* stream.h - the paths of a tile, all of them a step at a time, as arrays
 *
 * Depth by depth the rays of all paths are traced in packets, sorted by the material that they hit, and
 * shaded a chunk of one material at a time; what is left goes on as the rays of the next depth. What a path
 * brings is kept under its id, and each chunk adds to it in the same order, so that sums do not depend on
 * where in an array a path is. */
#ifndef WEFT_TRACE_STREAM_H
#define WEFT_TRACE_STREAM_H

#include "trace/first_hit.h"

enum {
    STREAM_TILE = 16, /* pixels a side */
    STREAM_PIXELS = STREAM_TILE * STREAM_TILE,
    STREAM_SAMPLES = 16, /* of a pixel at once, at most */
};

typedef struct Stream {
    const PathContext *context;
    Paths paths[2];                                    /* those of this depth and the next */
    float t[PATHS_ROOM], u[PATHS_ROOM], v[PATHS_ROOM]; /* where they end: as HitRows */
    uint32_t mesh[PATHS_ROOM], triangle[PATHS_ROOM];
    Light4 light;     /* by the id of the path that brought it */
    FirstHits *first; /* NULL where the context does not ask for them */
    PathKeys keys;
    Chunk chunk;
    StageClock clock; /* the chunk has its address where the context says so */
    int *end, *order; /* paths by class, which is nothing hit or a material; where those of a class end */
    long long rays;
} Stream;

/* Room for the batches of one thread, in a scene with so many materials; NULL when memory is short. */
Stream *stream_create(const PathContext *context, int materials);
void stream_free(Stream *stream);

/* The hits as geometry_hits wants them. */
HitRows stream_hits(Stream *stream);

/* Follows the first n paths of paths[0], whose hits are known, to their ends. A path whose mesh is
 * STREAM_DONE is at its own already. */
#define STREAM_DONE (GEOMETRY_NOTHING - 1)
void stream_follow(Stream *stream, int n);

#endif
