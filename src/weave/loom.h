/* loom.h - the smallest loom that weaves a draft
 *
 * Warp threads that rise together hang on one shaft; picks that lift the same shafts press one treadle:
 *
 *   up(warp, pick) = tieup(treadling(pick), threading(warp))
 *
 * There are as many shafts as the draft has different columns, and as many treadles as it has different rows. Both are
 * numbered from 0 in the order of their first use. */
#pragma once

#include "weave/weave_draft.h"

typedef struct Loom {
    int shafts, treadles;
    int *threading;       /* the shaft of each warp thread */
    int *treadling;       /* the treadle of each pick */
    unsigned char *tieup; /* [treadle * shafts + shaft]: 1 where the treadle lifts the shaft */
} Loom;

/* Finds the loom of a draft. Returns false if memory is short; release with loom_free in either case. */
bool loom_of(const WeftDraft *draft, Loom *out);
void loom_free(Loom *loom);
