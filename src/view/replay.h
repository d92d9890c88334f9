/* replay.h - a script of actions that are done to the window as if by hand: docs/view.md has the words */
#ifndef WEFT_VIEW_REPLAY_H
#define WEFT_VIEW_REPLAY_H

#include "view/state/viewer.h"

typedef struct Replay Replay;

/* Reads all of a script; NULL with one line in `why` where it cannot be read. */
Replay *replay_open(const char *path, char why[512]);
void replay_close(Replay *replay); /* may be NULL */

/* Does what is due before the next frame. False with one line in `why` where an action cannot be done. At the
 * end of the script the window closes, unless it was asked to stay. */
bool replay_step(Replay *replay, Viewer *v, char why[512]);

/* Returns true if an action is under way that needs frames to be drawn; otherwise the replay waits. */
bool replay_acts(const Replay *replay);

#endif
