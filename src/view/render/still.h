/* still.h - path-traced pictures of any size, made in the background from a saved copy of the scene: one, or a turntable
 *
 * The copy makes them independent of the scene that is edited meanwhile. The bytes are those of `weft render` with the same
 * options. */
#pragma once

#include "view/render/orbit.h"
#include "view/render/scene_state.h"
#include "view/ui/window.h"

/* The quality and number of pictures, as the user chooses them. */
typedef struct StillChoice {
    int width, height;
    int samples; /* a pixel, at most */
    float noise; /* relMSE at which it stops earlier; 0: it does not */
    int around;  /* pictures on a circle about the scene, numbered before their suffix; 0: one picture */
    bool denoised, transparent, floor;
    bool layered; /* an .exr has all AOVs but `variance`, as layers */
} StillChoice;

/* Pictures to make. */
typedef struct StillDesc {
    char scene[STATE_PATH]; /* a .glb in a folder of its own; both are removed at the end */
    char path[STATE_PATH];  /* file to write */
    StillChoice choice;
    EnvironmentState environment;
    WeftRenderDesc desc; /* the camera is the text below */
    char camera[ORBIT_TEXT];
    WeftTonemap tonemap; /* of a file for display */
    float exposure;      /* stops */
    bool laid_behind;    /* background_color of desc is of the display, laid behind a transparent picture */
    float white[2];      /* as WeftTone has it */
} StillDesc;

typedef struct Still Still;

/* Makes a folder for a scene, and writes the name of a .glb in it into path. Returns false if there is none. */
bool still_folder(char path[STATE_PATH]);

/* Removes the file and its folder. */
void still_discard(const char path[STATE_PATH]);

/* Starts the thread, which wakes the window (may be NULL) as it goes on. NULL where memory is short. */
Still *still_start(const StillDesc *desc, Window *window);

/* Returns the share of all samples that are taken, 0 to 1, and whether it has ended. */
double still_progress(Still *still, bool *ended);

/* Stops it if it has not ended, and releases it. Writes a line for people, and returns false if a picture is missing. */
bool still_end(Still *still, char line[512]);
