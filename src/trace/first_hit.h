/* first_hit.h - albedo, normal and depth of the surfaces that camera rays meet first */
#ifndef WEFT_TRACE_FIRST_HIT_H
#define WEFT_TRACE_FIRST_HIT_H

#include "trace/chunk.h"

enum { FIRST_ALBEDO = 0, FIRST_NORMAL = 3, FIRST_DEPTH = 6, FIRST_SEEN = 7, FIRST_NUMBERS = 8 };

/* By the id of a path. SEEN is 1 for a camera ray that meets a surface, else 0, and so is then all else. The
 * depth is along the camera's axis. */
typedef struct FirstHits {
    float number[FIRST_NUMBERS][PATHS_CAPACITY];
} FirstHits;

/* Fills in what a chunk of first hits is, of those that are seen. normal: the world's. */
void first_hits_take(FirstHits *hits, const Chunk *chunk, int n, Row normal[3], const float forward[3]);

#endif
