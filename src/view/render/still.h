/* still.h - a path-traced picture of any size, made in the background from a saved copy of the scene
 *
 * The copy makes it independent of the scene that is edited meanwhile. The bytes are those of `weft render` with the same
 * options. */
#pragma once

#include "view/render/orbit.h"
#include "view/render/scene_state.h"
#include "view/ui/window.h"

/* A picture to make. */
typedef struct StillDesc {
    char scene[STATE_PATH]; /* a .glb in a folder of its own; both are removed at the end */
    char path[STATE_PATH];  /* file to write */
    EnvironmentState environment;
    WeftRenderDesc desc; /* with the size; the camera is the text below */
    char camera[ORBIT_TEXT];
    int samples; /* a pixel */
    bool denoised;
    WeftTonemap tonemap; /* of a file for display */
    float exposure;      /* stops */
} StillDesc;

typedef struct Still Still;

/* Makes a folder for a scene, and writes the name of a .glb in it into path. Returns false if there is none. */
bool still_folder(char path[STATE_PATH]);

/* Removes the file and its folder. */
void still_discard(const char path[STATE_PATH]);

/* Starts the thread, which wakes the window (may be NULL) as it goes on. NULL where memory is short. */
Still *still_start(const StillDesc *desc, Window *window);

/* Returns the share of the samples that are taken, 0 to 1, and whether it has ended. */
double still_progress(Still *still, bool *ended);

/* Stops it if it has not ended, and releases it. Writes a line for people, and returns false if there is no picture. */
bool still_end(Still *still, char line[512]);
