/* deal.h - a picture that all processes of MPI render
 *
 * The leader, rank 0, deals out blocks of tiles, fewer and fewer as they run out, and renders blocks itself. Between the
 * tiles of its own it looks for messages, so that one thread of each process alone calls MPI. A process that has rendered
 * a block sends the sums of its tiles, weft/render.h, which the leader copies into its render; a tile knows nothing of
 * other tiles, so that neither the dealing nor its order changes a byte. */
#pragma once

#include "cli/render/crew.h"

/* Returns the exit code of all processes before they render: 0 if all of them are ready, which this one is if code is 0;
 * else, in every process, that of the first which is not. All call it once. complaint (may be NULL): what this process
 * printed, which is shown if it is the first that is not ready and does not lead. */
int deal_agree(int code, const char *complaint);

/* Returns true after deal_agree. */
bool deal_agreed(void);

/* Renders with the others, as a Crew does. */
WeftResult deal_run(Gather *gather, const char *words, int spp, WeftError *error);
