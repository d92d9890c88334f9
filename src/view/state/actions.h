/* actions.h - tasks that menus, dialogs and replays send to the renderer */
#pragma once

#include "view/state/viewer.h"

/* Sends a task. path may be NULL; index and input as in Task. */
void actions_send(Viewer *v, TaskKind kind, const char *path, int index, int input);

/* Sets a key of the weave of the edited material (weft_scene_weave); a draft of a file makes it woven. */
void actions_weave(Viewer *v, const char *key, const char *value);
void actions_weave_file(Viewer *v, const char *path);

/* Lights the scene by a picture, or by the folder of a cubemap. */
void actions_light_by(Viewer *v, const char *path);
