/* opening.h - loading of scenes, lights, materials, images, and of files that change on disk / */
#ifndef WEFT_VIEW_OPENING_H
#define WEFT_VIEW_OPENING_H

#include "view/state/viewer.h"

/* Begins with the scene and the lobes that the window starts with; false where memory is short. */
bool opening_begin(Viewer *v);

/* Begins to read a scene; again: the one that is shown, whose file has changed. */
void opening_start(Viewer *v, const char *path, bool again);

/* Takes a lobe's file. What is made of a lobe is made with the scene, which is read again behind it. */
void opening_lobe(Viewer *v, const char *path);

/* Takes what has been read, where something has. */
void opening_poll(Viewer *v);

/* Looks for files that have changed; true where one had. seconds: of a steady clock. */
bool opening_watch(Viewer *v, double seconds);

/* The renderer has taken a scene, or could not. */
void opening_take(Viewer *v, const RenderEvent *event);

/* Takes over the coverage of the state's materials after a variant has changed them. */
void opening_varied(Viewer *v, float **coverage);

/* Takes over the maps of the state that a task has made. */
void opening_take_maps(Viewer *v, RenderEvent *event);

/* A folder whose maps the scene uses from now on. */
void opening_keep_folder(Viewer *v, const char *path);

/* Adds lines to the warnings; lines may be NULL. */
void opening_warn(Viewer *v, const char *lines);

/* Gives up what is being read, and releases all that is of the scene. */
void opening_end(Viewer *v);

#endif
