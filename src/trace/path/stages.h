/* stages.h - time that the stages of following paths take */
#pragma once

#include "base/steady_clock.h"

/* S(NAME, name, true if nearly all of it is Embree's time), in the order of a step:
 *   CAMERA         draws a point in each pixel and makes its ray
 *   CAMERA_HITS    finds the nearest hits of camera rays
 *   ENTER          adds the floor and the background where camera rays meet them
 *   HITS           finds the nearest hits of all other rays
 *   SORT           sorts the paths by the material that they hit
 *   MISSES         adds the environment along rays that leave the scene
 *   PLACE          computes positions, normals and the origins of the next rays
 *   INPUTS         reads the material's inputs from its numbers and textures
 *   WEAVE          finds the threads of woven materials
 *   FRAMES         adds emission and builds the shading frames
 *   NUMBERS        draws the random numbers of the samples that follow
 *   SKY            samples the environment
 *   EMITTERS       samples emissive triangles
 *   PUNCTUAL       samples punctual lights
 *   SHADE          samples the material and evaluates it for all samples, a vertex a lane
 *   SHADE_EACH     does the same one vertex at a time
 *   WEIGH          weighs the light samples, makes their shadow rays and adds what arrives
 *   OCCLUSIONS     traces the shadow rays
 *   CONTINUE       applies Russian roulette and writes the rays of the next depth
 *   FILM           adds what the paths brought to the film */
#define TRACE_STAGES(S)                                                                                                \
    S(CAMERA, "camera rays", false)                                                                                    \
    S(CAMERA_HITS, "camera hits", true)                                                                                \
    S(ENTER, "floor and background", false)                                                                            \
    S(HITS, "bounce hits", true)                                                                                       \
    S(SORT, "sort by material", false)                                                                                 \
    S(MISSES, "environment at misses", false)                                                                          \
    S(PLACE, "positions and normals", false)                                                                           \
    S(INPUTS, "inputs and textures", false)                                                                            \
    S(WEAVE, "threads of woven cloths", false)                                                                         \
    S(FRAMES, "emission and frames", false)                                                                            \
    S(NUMBERS, "random numbers", false)                                                                                \
    S(SKY, "samples of the environment", false)                                                                        \
    S(EMITTERS, "samples of emissive triangles", false)                                                                \
    S(PUNCTUAL, "samples of punctual lights", false)                                                                   \
    S(SHADE, "stack: views, values, sample", false)                                                                    \
    S(SHADE_EACH, "stack, one vertex at a time", false)                                                                \
    S(WEIGH, "weights and shadow rays", false)                                                                         \
    S(OCCLUSIONS, "shadow tests", true)                                                                                \
    S(CONTINUE, "roulette and next rays", false)                                                                       \
    S(FILM, "film", false)

#define STAGE_ID(NAME, name, embree) STAGE_##NAME,
typedef enum TraceStage { TRACE_STAGES(STAGE_ID) STAGE_COUNT } TraceStage;
#undef STAGE_ID

/* The clock of one thread, in seconds. */
typedef struct StageClock {
    double since;              /* end of the last stage, or stage_begin */
    double spent[STAGE_COUNT]; /* in each stage */
} StageClock;

/* Starts the first stage. clock: NULL if stages are not timed. */
static inline void stage_begin(StageClock *clock) {
    if (clock) clock->since = clock_now();
}

/* Adds the time since the end of the last stage to `stage`. clock: NULL if stages are not timed. */
static inline void stage_end(StageClock *clock, TraceStage stage) {
    if (!clock) return;
    double now = clock_now();
    clock->spent[stage] += now - clock->since;
    clock->since = now;
}
