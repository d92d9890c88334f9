/* session_file.h - the file that keeps the session of a scene: one for each scene, in $XDG_STATE_HOME/weft (or
 * ~/.local/state/weft), from the first change until the window is closed
 *
 * So a file that is there when the scene is opened is that of a window that was killed. */
#pragma once

#include <stdbool.h>

#include <jansson.h>

enum { SESSION_PATH = 2048, SESSION_NAPS = 32 };

/* Zero-initialise: no file. */
typedef struct SessionFile {
    char path[SESSION_PATH]; /* of the JSON; "": none */
    int lock;                /* descriptor of the locked file beside it */
} SessionFile;

/* Claims the file of a scene. Fails if another window has it, or there is no folder for it. */
bool session_file_claim(SessionFile *file, const char *scene);

/* Returns the kept session, owned; NULL if there is none, or it is damaged, which `damaged` says. */
json_t *session_file_read(const char *path, bool *damaged);

/* Writes the session; false on failure. */
bool session_file_write(const SessionFile *file, const json_t *session);

/* Writes the path of picture k of the session, below SESSION_NAPS; false where it is too long. */
bool session_file_nap(const char *path, int k, char nap[SESSION_PATH]);

/* Returns true if it is the file of that scene. */
bool session_file_is_of(const SessionFile *file, const char *scene);

/* Removes what was kept, with its pictures; the file stays claimed. */
void session_file_forget(const SessionFile *file);

/* Lets go of the file; forget: what was kept is removed. */
void session_file_release(SessionFile *file, bool forget);

/* Returns the newest session that no window has, owned; NULL: none. */
json_t *session_file_last(void);
