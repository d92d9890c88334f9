/* stages.h - time that the stages of following paths take */
#ifndef WEFT_TRACE_STAGES_H
#define WEFT_TRACE_STAGES_H

#include "base/steady_clock.h"

/* S(NAME, name, whether all of it is Embree's but for the copying of rays), in the order of a step. */
#define TRACE_STAGES(S)                                                                                      \
    S(CAMERA, "camera rays", false)                                                                          \
    S(CAMERA_HITS, "camera hits", true)                                                                      \
    S(ENTER, "floor and background", false)                                                                  \
    S(HITS, "bounce hits", true)                                                                             \
    S(SORT, "sort by material", false)                                                                       \
    S(MISSES, "environment at misses", false)                                                                \
    S(PLACE, "positions and normals", false)                                                                 \
    S(INPUTS, "inputs and textures", false)                                                                  \
    S(WEAVE, "threads of woven cloths", false)                                                               \
    S(TURN, "emission and frames", false)                                                                    \
    S(NUMBERS, "random numbers", false)                                                                      \
    S(SKY, "samples of the environment", false)                                                              \
    S(EMITTERS, "samples of emissive triangles", false)                                                      \
    S(PUNCTUAL, "samples of punctual lights", false)                                                         \
    S(SHADE, "stack: views, values, sample", false)                                                          \
    S(SHADE_EACH, "stack, one vertex at a time", false)                                                      \
    S(WEIGH, "weights and shadow rays", false)                                                               \
    S(OCCLUSIONS, "shadow tests", true)                                                                      \
    S(GO_ON, "roulette and next rays", false)                                                                \
    S(FILM, "film", false)

#define STAGE_ID(NAME, name, embree) STAGE_##NAME,
typedef enum TraceStage { TRACE_STAGES(STAGE_ID) STAGE_COUNT } TraceStage;
#undef STAGE_ID

/* One thread's. */
typedef struct StageClock {
    double since, spent[STAGE_COUNT]; /* seconds */
} StageClock;

static inline void stage_begin(StageClock *clock) {
    if (clock) clock->since = clock_now();
}

/* The time since the last end, or the begin, was this stage's. clock: NULL where nobody asks. */
static inline void stage_end(StageClock *clock, TraceStage stage) {
    if (!clock) return;
    double now = clock_now();
    clock->spent[stage] += now - clock->since;
    clock->since = now;
}

#endif
