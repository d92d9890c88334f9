/* loader.h - reads a scene in a thread of its own, with progress */
#pragma once

#include <jansson.h>

#include "view/render/scene_state.h"
#include "view/render/view.h"
#include "view/ui/window.h"
#include "weft/weave.h"

enum { FACTS_NAME = 64, FACTS_MOST = 512, FACTS_THUMB = 32, FACTS_THUMBS = 128 };

typedef char FactName[FACTS_NAME];

/* A cloth of the scene: a copy of its draft, owned, and its yarns. */
typedef struct FactCloth {
    WeftDraft *draft;
    WeftYarn yarns[2];
    WeftClothInfo info;
    char *text; /* as weft_scene_weave_text has it; owned */
} FactCloth;

/* The contents of a scene: copies, since the scene belongs to the renderer. */
typedef struct Facts {
    char path[STATE_PATH];
    FactName *materials, *cameras, *variants; /* owned */
    FactName *maps;                           /* files of textures, as it was read; owned */
    char **map_paths;                         /* of the same; NULL where there is no file; owned */
    int map_count, own_maps;                  /* own_maps: those that the file of the scene has, which come first */
    FactCloth *cloths;                        /* as WeftMaterial's `cloth` counts them, from 1; owned */
    int cloth_count;
    WeftImage thumbs; /* of the maps in the same order, FACTS_THUMB a side, one below the other: U8 RGB; owned */
    float *coverage;  /* fraction of the picture by material, at the last survey (survey.h); owned, may be NULL */
    WeftSceneInfo info;
    WeftFloor stage; /* weft_scene_stage */
} Facts;

/* Reads the facts of a scene from path. Returns false if memory is short. */
bool facts_read(Facts *facts, const WeftScene *scene, const char *path);
void facts_free(Facts *facts);
/* Reads maps and cloths again, after textures or weaves were added. */
void facts_read_maps(Facts *facts, const WeftScene *scene);

/* The session of a window that was killed, restored (session_state.h). */
typedef struct Restored {
    json_t *session;         /* all that was kept; owned; NULL: nothing */
    SceneState state, other; /* edited, and the other of A and B, empty without one; owned */
    char complaint[512];     /* the reason why nothing was restored; "": none */
} Restored;

typedef struct Loader Loader;

/* The result of a load, or the reason of its failure. */
typedef struct Loaded {
    WeftScene *scene; /* owned; NULL on failure */
    SceneState state; /* owned; as configured */
    Facts facts;      /* owned */
    char path[STATE_PATH];
    WeftResult result;
    char failure[512];
    char *warnings;        /* warnings, one a line; owned, may be NULL */
    const char *camera;    /* the first camera; a constant, or the command line's */
    bool reread;           /* the shown scene was reread from its file */
    Folders folders;       /* folders of maps that are in use */
    char lobe[STATE_PATH]; /* file of a lobe loaded before the scene; "": none */
    bool taken;            /* the lobe was loaded, even if the scene failed */
    Restored restored;
} Loaded;

/* A load as it is requested. */
typedef struct Reading {
    const char *path;
    const char *lobe;       /* file of a lobe to load before the scene; may be NULL */
    bool reread;            /* the scene that is shown, whose file has changed */
    bool configured;        /* desc.configure is called, in that thread */
    const Folders *folders; /* to be put on materials; those that fail are dropped with a warning */
    float aspect;           /* width / height of the picture that it will be seen in */
    const char *session;    /* path of a session to restore; "": none */
} Reading;

/* Starts to read. NULL where memory is short. */
Loader *loader_start(Window *window, const ViewDesc *desc, const Reading *reading);

/* Returns the finished share, or -1 while it is unknown. */
float loader_progress(Loader *loader);
bool loader_done(Loader *loader);

/* Returns the path of the scene that it reads, valid while the loader exists; reread: as in Reading. */
const char *loader_path(const Loader *loader, bool *reread);

/* Stops the loader, without waiting for it. */
void loader_stop(Loader *loader);

/* Gives up what is not done, and takes what is (loaded may be NULL: dropped). The loader is gone. */
void loader_finish(Loader *loader, Loaded *loaded);
void loaded_free(Loaded *loaded);
