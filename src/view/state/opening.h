/* opening.h - files: loading of scenes, lights, materials, images, and of files that change on disk; the shown scene */
#pragma once

#include "view/files/file_watch.h"
#include "view/render/loader.h"
#include "view/state/viewer.h"

typedef struct OpeningState {
    Loader *loader;    /* NULL: nothing is being read */
    Loader *leaving;   /* a loader that is stopping; NULL: none */
    WeftResult opened; /* result of the last load */
    FileWatch *file_watch;
    char configured[STATE_PATH];         /* path of the scene that the command line configures */
    char watched[STATE_PATH];            /* environment whose file is watched */
    char lobes[STATE_LOBES][STATE_PATH]; /* files of lobes, which are watched too */
    int lobe_count;
    unsigned scenes; /* number of the last scene that was read */
    Loaded pending;  /* state and facts of the scene that the renderer prepares */
    bool has_pending;
    bool resumes; /* the first scene is that of the last session, which nobody has asked for by its name */
} OpeningState;

/* The scene that is shown. */
typedef struct ShownScene {
    bool any;
    unsigned number;
    Facts facts;
    Folders folders;       /* of maps that the scene uses */
    unsigned maps_texture; /* thumbnails of its maps */
    char warnings[8192];   /* of scene and files, one a line */
} ShownScene;

/* Begins with the scene and the lobes that the window starts with; false where memory is short. */
bool opening_begin(Viewer *v);

/* Opens a path by its kind: a scene is read in the background, an environment lights the scene, a material file is
 * assigned, a lobe is loaded, for a picture a dialog opens, the maps of a folder are bound. */
void opening_open(Viewer *v, const char *path);

/* Opens a path likewise, but asks first if it would end the scene that is shown with changes that are not saved. */
void opening_ask(Viewer *v, const char *path);

/* Begins to read a scene; reread: the one that is shown, whose file has changed. */
void opening_start(Viewer *v, const char *path, bool reread);

/* Loads a lobe's file. The scene is then reread, since its lobes are made with it. */
void opening_lobe(Viewer *v, const char *path);

/* Takes the scene that has been read, if there is one. */
void opening_poll(Viewer *v);

/* Looks for files that have changed; true if there is one. seconds: of a steady clock. */
bool opening_watch(Viewer *v, double seconds);

/* Shows the scene that the renderer has taken over. If it could not, the old scene stays. */
void opening_take(Viewer *v, const RenderEvent *event);

/* Takes over the coverage by the state's materials after a change of variant. Chooses the most visible material that
 * the variant has put on. If there is none and the chosen material is no longer used, it chooses the most visible one. */
void opening_varied(Viewer *v, float **coverage);

/* Takes over the maps and cloths of the state that a task has made; the event gets the old ones. */
void opening_take_maps(Viewer *v, RenderEvent *event);

/* Notes a folder whose maps the scene uses from now on. */
void opening_keep_folder(Viewer *v, const char *path);

/* Adds lines to the warnings; lines may be NULL. */
void opening_warn(Viewer *v, const char *lines);

/* Stops reading, and releases everything of the scene. */
void opening_end(Viewer *v);
