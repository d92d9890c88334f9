/* view.h - the window: open a cloth asset, edit every term, and compare with the path-traced reference */
#pragma once

#include <stdbool.h>

#include "view/render/scene_state.h"
#include "weft/raster.h"

/* The window's initial content. Texts must outlive it. */
typedef struct ViewDesc {
    const char *scene;   /* NULL: the built-in cloth */
    const char *options; /* options that configure the scene, for the copied command line; may be NULL */
    /* Assigns materials and lights to a scene that was just loaded; `environment` receives the environment.
     * May be NULL. */
    WeftResult (*configure)(void *user, WeftScene *scene, EnvironmentState *environment, const WeftLog *log,
                            WeftError *error);
    void *user;
    const WeftMoment *moment; /* of an animation of the scene that is configured; NULL: at rest */
    const char *camera;       /* NULL: a built-in scene's first one, else auto */
    WeftBackground background;
    float background_color[3];
    WeftFloor floor;
    bool stage; /* scenes have the floor of weft_scene_stage, until the user decides */
    bool hide_lights;
    WeftTonemap tonemap;
    float exposure;
    bool metered;             /* exposure follows the picture */
    float kelvin, tint;       /* of the light that shows as white (weft_white); 0: that of the display */
    bool balanced;            /* white follows the picture, in place of both */
    const char *shader_dir;   /* may be NULL */
    const char *const *lobes; /* files of the user's lobes that were taken, ended by NULL */
    const char *materials;    /* folder of maps to put onto the cloth; NULL: none */
    int occlusion;
    int accumulate;     /* frames that are summed while nothing changes; 0: none */
    int bounces;        /* of light in them, 0 or 1 */
    int width, height;  /* of the window; 0: as it was last time */
    float scale;        /* of panels and text; 0: that of the display, 1 without one */
    int frames;         /* ends after so many; 0: when it is closed */
    const char *script; /* file of actions to replay; may be NULL */
    bool unseen;        /* without a window */
    bool report;        /* a line of JSON on standard output whenever it comes to rest */
    bool forget;        /* settings and sessions are neither read nor written */
    /* Returns true if the program was told to end: the window then keeps its session and closes. May be NULL. */
    bool (*interrupted)(void);
} ViewDesc;

/* Runs until it is closed. Returns an exit code; what went wrong is one line in `why`. */
int view_run(const ViewDesc *desc, char why[512]);
