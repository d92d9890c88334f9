/* session_state.h - edited states of a scene as JSON, to be kept and restored
 *
 * The JSON holds what differs from the state that the file gives (`first`): materials with the paths of maps and the
 * weaves that were put on, all lights, the environment, the variant. Brushed naps are pictures of their own. */
#pragma once

#include <jansson.h>

#include "view/render/loader.h"
#include "view/render/scene_state.h"

/* Returns a state as JSON; NULL where memory is short. first may be NULL: all materials are written whole, to be restored
 * where other options configure the scene. */
json_t *session_state_write(const SceneState *state, const SceneState *first, const Facts *facts);

/* Makes a state of JSON that session_state_write wrote for the same file. The maps and cloths that it needs are added
 * to the scene, whose materials stay those of `first`. `session` is the path of the session, beside which its naps are,
 * from number `nap` on. Fails, with a line, if the JSON is damaged or a file is missing; *state is then empty. */
WeftResult session_state_read(const json_t *root, const char *session, int nap, WeftScene *scene,
                              const SceneState *first, SceneState *state, WeftError *error);

/* Returns true if two states have the same brushed naps; either may be empty. */
bool session_state_same_naps(const SceneState *a, const SceneState *b);

/* Writes the brushed naps of a state as pictures beside the session, from number `nap` on, unless `kept` has the same.
 * Returns false if one cannot be written. */
bool session_state_write_naps(const SceneState *state, const SceneState *kept, const char *session, int nap);
