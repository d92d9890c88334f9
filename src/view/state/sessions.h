/* sessions.h - the session of the scene that is shown: kept in a file while something differs from the scene as it was
 * opened, and restored if the window was killed */
#pragma once

#include "view/files/session_file.h"
#include "view/state/viewer.h"

typedef struct SessionsState {
    SessionFile file, next;  /* of the scene that is shown, and of the one that is being read */
    struct json_t *kept;     /* what the file holds, or what the scene was opened with; owned */
    SceneState state, other; /* whose naps the file has */
    double looked;           /* time of the last look for changes, s */
    bool failed;             /* the file could not be written when the session last changed */
} SessionsState;

/* Claims the session of a scene that is about to be read. Returns its path, valid until the next call; "" if there is
 * none to restore or to keep. */
const char *sessions_claim(Viewer *v, const char *scene);

/* Begins the session of a scene that is shown from now on, whose states were restored already: restores the view. The
 * session before ends, and is forgotten. */
void sessions_begin(Viewer *v, const Loaded *loaded);

/* Writes the path of the scene of the newest session that no window has; false if there is none. */
bool sessions_last(char path[STATE_PATH]);

/* Writes the session if it has changed, every other second. */
void sessions_poll(Viewer *v, double seconds);

/* Returns true if the file holds the session as it is now, or nothing differs from the scene as it was opened. */
bool sessions_are_kept(const Viewer *v);

/* Ends the session. keep: it is written, and restored when the scene is opened again. */
void sessions_end(Viewer *v, bool keep);
