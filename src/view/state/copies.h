/* copies.h - copies of the scene that work in the background is done from, which the renderer saves first
 *
 * Each belongs to the part of the state that has asked for it: pictures (stills.h), baked files (bakings.h). */
#pragma once

#include "view/state/viewer.h"

/* A copy that was asked for. */
typedef struct SceneCopy {
    char path[STATE_PATH]; /* of a .glb in a folder of its own */
    bool due;              /* the renderer has not saved it yet */
    unsigned scene;        /* number of the scene that is being saved; a task of an earlier one is dropped */
} SceneCopy;

/* Returns true if a copy of the scene that is shown is still to come. */
bool copy_is_due(const Viewer *v, const SceneCopy *copy);

/* Asks the renderer for a copy, and forgets one that is due. Returns false where it cannot, and says why. */
bool copy_request(Viewer *v, SceneCopy *copy);

/* Takes the renderer's word that the copy at `path` is saved; failed: it is not. Returns true if it is this one and is
 * there: who has asked then removes it by still_discard. */
bool copy_arrives(SceneCopy *copy, const char *path, bool failed);

/* Forgets a copy that is due. */
void copy_forget(SceneCopy *copy);
