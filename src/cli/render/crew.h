/* crew.h - several processes that render one picture together, and how this one takes part
 *
 * The program weft is alone. Another program (src/mpi) joins before it runs a verb: then the samples of a picture are
 * gathered by all of its processes, of which the first leads: it alone reads earlier samples, warns, and writes. */
#pragma once

#include "cli/render/picture_gather.h"

/* A place in a crew. */
typedef struct Crew {
    int rank; /* 0 leads */
    /* Adds samples until the leader's render has spp. All processes call it; words are those of their pictures. */
    WeftResult (*run)(Gather *gather, const char *words, int spp, WeftError *error);
} Crew;

/* Takes a place, borrowed; NULL: alone. */
void crew_join(const Crew *crew);

/* Returns the place of this process; NULL: it is alone. */
const Crew *crew_place(void);

/* Returns true if another process leads. */
bool crew_follows(void);
