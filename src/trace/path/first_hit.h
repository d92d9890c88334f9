/* first_hit.h - albedo, normal and depth of the surfaces that camera rays meet first */
#pragma once

#include "trace/path/chunk.h"

enum { FIRST_ALBEDO = 0, FIRST_NORMAL = 3, FIRST_DEPTH = 6, FIRST_SEEN = 7, FIRST_NUMBERS = 8 };

enum { PLACE_POSITION = 0, PLACE_UV = 3, PLACE_NUMBERS = 5 };

/* First hits by the id of a path. FIRST_SEEN is 1 if the camera ray meets a surface, else all are 0. The depth is along
 * the camera's axis, metres. */
typedef struct FirstHits {
    float number[FIRST_NUMBERS][PATHS_CAPACITY];
    float place[PLACE_NUMBERS][PATHS_CAPACITY]; /* position, and first texture coordinates */
    uint32_t mesh[PATHS_CAPACITY];              /* GEOMETRY_NOTHING: no surface */
} FirstHits;

/* The look of a surface: its base colour and shading normal, those of its threads where it is woven, or the
 * interpolated normal where no shading frame is made. */
typedef enum FirstLook { FIRST_LOOK_PLAIN, FIRST_LOOK_WOVEN, FIRST_LOOK_UNSHADED } FirstLook;

/* Records the first hits of a chunk, of paths that are seen. */
void first_hits_take(FirstHits *hits, const Chunk *chunk, int n, FirstLook look, const float forward[3]);

/* Records where they are, and on which meshes. */
void first_hits_place(FirstHits *hits, const Chunk *chunk, int n, const WeftScene *scene);
