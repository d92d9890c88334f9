/* opening.h - loading of scenes, lights, materials, images, and of files that change on disk / */
#ifndef WEFT_VIEW_OPENING_H
#define WEFT_VIEW_OPENING_H

#include "view/viewer.h"

/* Begins with the scene and the lobes that the window starts with. */
void opening_begin(Viewer *v);

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

/* Sets the centre of the scene, and its size: half the distance of the camera. */
void opening_home(Viewer *v, const float eye[3], const float target[3]);

/* Releases all that is of the scene. */
void opening_forget(Viewer *v);

#endif
