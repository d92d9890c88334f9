/* slot_light.h - the light of paths by the slot that reflects it at the surface which the camera sees
 *
 * At that surface f is the sum of its slots, and light that arrives from a direction is divided as they reflect it:
 * f_k / f, channel by channel. Light that was scattered between layers is divided in the same proportion. So the parts
 * add up to the light. Light from deeper vertices is divided as the first direction was. */
#pragma once

#include "trace/path/chunk.h"

enum { LIT_DIFFUSE, LIT_SPECULAR, LIT_SHEEN, LIT_COAT, LIT_DUST, LIT_SLOTS };

struct LightBySlot {
    float share[KIND_DIRECTIONS][LIT_SLOTS][3][ROW_CAPACITY]; /* of the vertices of a chunk */
    float direct[LIT_SLOTS][3][PATHS_CAPACITY];               /* by the id of a path */
    float onward[LIT_SLOTS][3][PATHS_CAPACITY];               /* share of the direction in which the path goes on */
    float before[3][PATHS_CAPACITY];                          /* radiance when the first vertices were done */
};

/* Starts all paths with no light. */
void slot_light_begin(LightBySlot *light);

/* Adds a contribution of a light sample of a group at a vertex of a chunk. */
void slot_light_add(LightBySlot *light, const Chunk *chunk, LightGroup group, int vertex);

/* Notes the radiance of all paths, and later divides what was added since. */
void slot_light_note(LightBySlot *light, const PathRadiance *radiance);
void slot_light_end(LightBySlot *light, const PathRadiance *radiance);
