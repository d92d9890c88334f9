/* history.h - looks to go back to, and forward again */
#ifndef WEFT_VIEW_HISTORY_H
#define WEFT_VIEW_HISTORY_H

#include "view/render/scene_state.h"

enum { HISTORY_STEPS = 200 };

/* Zero-initialise: empty. Steps before `now` can be undone, those from it on done again. */
typedef struct History {
    SceneState steps[HISTORY_STEPS];
    int now, count;
    bool open; /* what changes next belongs to the last step */
} History;

/* Keeps the state as it was before a change; what was undone is forgotten. While it is open nothing is kept.
 */
void history_keep(History *history, const SceneState *before);

/* Ends a step: the next change begins a new one. */
void history_close(History *history);

/* Exchanges look with the one before, or after; false where there is none. */
bool history_undo(History *history, SceneState *state);
bool history_redo(History *history, SceneState *state);

void history_free(History *history);

#endif
