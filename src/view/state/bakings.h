/* bakings.h - the file that is being saved with its weaves baked to textures */
#pragma once

#include "view/render/baking.h"
#include "view/state/copies.h"

typedef struct BakingsState {
    SceneCopy copy;        /* of the scene, which the renderer saves first */
    char path[STATE_PATH]; /* the file to write */
    Baking *baking;        /* NULL: none */
} BakingsState;

/* Returns true if a material of the scene is woven. */
bool bakings_possible(const Viewer *v);

/* Begins to save the scene to a .glb or .gltf, its weaves baked. One is made at a time. */
void bakings_save(Viewer *v, const char *path);

/* Starts the thread, when the scene was saved to `scene`; failed: it was not. */
void bakings_copied(Viewer *v, const char *scene, bool failed);

/* Returns true while a file is baked, or is due. */
bool bakings_busy(const Viewer *v);

/* Takes the end. Returns true if there was one. */
bool bakings_poll(Viewer *v);
void bakings_end(Viewer *v);
