/* baking.h - saves a scene whose woven materials are baked to textures, in a thread of its own, from a saved copy */
#pragma once

#include <stdbool.h>

#include "view/ui/window.h"

typedef struct Baking Baking;

/* Starts the thread, which wakes the window at its end. scene: a copy in a folder of its own (still_folder), both of which
 * are removed in any case. path: the file to write. NULL where memory or threads are short. */
Baking *baking_start(const char *scene, const char *path, Window *window);
bool baking_done(Baking *baking);

/* Stops the search and waits for the end, and releases it. Writes a line for people,
 * and returns false if there is no file. */
bool baking_end(Baking *baking, char line[512]);
