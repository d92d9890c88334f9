/* history.h - earlier and later states of a scene, for undo and redo */
#pragma once

#include "view/render/scene_state.h"

enum { HISTORY_STEPS = 200 };

/* Zero-initialise: empty. Steps before `now` can be undone, those from it on can be redone. */
typedef struct History {
    SceneState steps[HISTORY_STEPS];
    int now, count;
    bool open; /* the next change belongs to the last step */
} History;

/* Keeps the state before a change, and forgets what was undone. Keeps nothing while a step is open. */
void history_keep(History *history, const SceneState *before);

/* Ends a step: the next change begins a new one. */
void history_close(History *history);

/* Exchanges the state with the previous or the next one; false if there is none. */
bool history_undo(History *history, SceneState *state);
bool history_redo(History *history, SceneState *state);

void history_free(History *history);
