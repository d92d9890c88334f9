/* replay.h - a script of actions of mouse and keyboard for the window: docs/view.md describes it */
#pragma once

#include "view/state/viewer.h"

typedef struct Replay Replay;

/* Reads all of a script; NULL with one line in `why` where it cannot be read. */
Replay *replay_open(const char *path, char why[512]);
void replay_close(Replay *replay); /* may be NULL */

/* Does the actions before the next frame. False with one line in `why` if one fails. At the end of the script the
 * window closes, unless the script contains `stay`. */
bool replay_step(Replay *replay, Viewer *v, char why[512]);

/* Returns true if an action is under way that needs frames to be drawn; otherwise the replay waits. */
bool replay_acts(const Replay *replay);
