/* scene_state.h - the edited state of a scene as a value, to keep, to compare and to restore
 *
 * A copy shares its parts, which never change once they are made. So a history of states is small, and equal
 * states are found by their pointers. States may be read, copied and released in any thread; one state is
 * changed by one thread. */
#pragma once

#include <stdbool.h>

#include "weft/material.h"
#include "weft/render.h"

enum { STATE_LIGHTS = 64, STATE_PATH = 1024, STATE_NAPS = 16, STATE_FOLDERS = 16, STATE_LOBES = 8, NAP_SIDE = 512 };

/* The last folder of maps that was put on each material; index -1 is the cloth of the scene. */
typedef struct Folders {
    char paths[STATE_FOLDERS][STATE_PATH];
    int materials[STATE_FOLDERS];
    int count;
} Folders;

/* The source of the environment's light. */
typedef enum EnvironmentSource { ENVIRONMENT_STUDIO = 0, ENVIRONMENT_FILE, ENVIRONMENT_COLOR } EnvironmentSource;
typedef struct EnvironmentState {
    EnvironmentSource kind;
    char path[STATE_PATH]; /* of a lat-long picture or of a cubemap */
    float color[3];
    float rotation, strength;  /* degrees; a factor */
    float ambient, reflection; /* factors on what lobes reflect of it: weft_scene_set_environment_parts */
    unsigned version;          /* of the file: a reread one has another */
} EnvironmentState;

typedef struct StateMaterial StateMaterial; /* shared */

/* The nap that was brushed onto a material, shared: U8 RGB, NAP_SIDE a side. Red and green are its direction, blue the
 * fraction of its angle that it leans. */
typedef struct BrushedNap BrushedNap;

typedef struct SceneState {
    StateMaterial **materials;
    int material_count;
    WeftLight lights[STATE_LIGHTS];
    int light_count;
    int variant; /* of the scene's; -1: none */
    EnvironmentState environment;
    BrushedNap *naps[STATE_NAPS]; /* NULL: none */
} SceneState;

/* Notes a folder of maps, which replaces the earlier one of that material. */
void folders_keep(Folders *folders, const char *path, int material);

/* Returns the built-in studio. */
EnvironmentState environment_state_studio(void);

/* Returns true if both have the same source: the studio, the same version of a file, or a colour. */
bool environment_state_same_source(const EnvironmentState *a, const EnvironmentState *b);
/* Takes the source of another environment, but keeps rotation and strength. */
void environment_state_take_source(EnvironmentState *environment, const EnvironmentState *from);

/* Reads the state of a scene, without its environment, which a scene does not report. Returns false if
 * memory is short. */
bool scene_state_read(SceneState *state, const WeftScene *scene);
bool scene_state_copy(SceneState *copy, const SceneState *state);
void scene_state_free(SceneState *state);
bool scene_state_same(const SceneState *a, const SceneState *b);

const WeftMaterial *scene_state_material(const SceneState *state, int index);
bool scene_state_set_material(SceneState *state, int index, const WeftMaterial *material);
bool scene_state_same_material(const SceneState *a, const SceneState *b, int index);

/* Returns `made` with every choice and input that differs between `was` and `now` as it is now. */
WeftMaterial material_merged(const WeftMaterial *was, const WeftMaterial *now, const WeftMaterial *made);

/* Returns the preset that a material was last set to, counted from 1; 0 if none. Other changes of the material do not
 * change it, and states that differ only in it count as the same. */
int scene_state_preset(const SceneState *state, int index);
bool scene_state_set_preset(SceneState *state, int index, int preset);
/* Copies the presets from another state of the same scene. */
bool scene_state_take_presets(SceneState *state, const SceneState *from);

/* Returns the nap brushed onto a material; NULL if none. */
const WeftImage *scene_state_nap(const SceneState *state, int material);
/* Copies the nap, or `own` if there is none yet, to be changed and then given to scene_state_set_nap. NULL if there is
 * neither, or memory is short. */
BrushedNap *nap_copy(const SceneState *state, int material, const WeftImage *own, WeftImage **image);
/* Makes the nap that a material has by its numbers and maps, before anything was brushed; without maps of the second UV
 * set. Release with weft_image_free; false where memory is short. */
bool nap_own(const WeftScene *scene, const WeftMaterial *material, WeftImage *out);
bool scene_state_set_nap(SceneState *state, BrushedNap *nap);
/* Shares the naps of another state of the same scene. */
void scene_state_take_naps(SceneState *state, const SceneState *from);
void nap_free(BrushedNap *nap);

/* The textures of naps in a scene. */
typedef struct BoundNaps {
    int materials[STATE_NAPS], textures[STATE_NAPS];
    int count;
} BoundNaps;

/* Changes materials, variant and lights of a scene from the state `is` to `state`. The bits of what changed
 * (WEFT_CHANGED_MATERIALS ...) are added to *changed. On failure only some of them have changed. */
WeftResult scene_state_apply(const SceneState *state, const SceneState *is, BoundNaps *naps, WeftScene *scene,
                             unsigned *changed, WeftError *error);
/* Applies the environment likewise. If its source cannot be read the scene stays as it was. */
WeftResult environment_state_apply(const EnvironmentState *environment, const EnvironmentState *is, WeftScene *scene,
                                   unsigned *changed, const WeftLog *log, WeftError *error);
