/* look.h - what a scene is dressed and lit as, as a value: to keep, to compare and to go back to
 *
 * A copy shares its parts, which never change once they are made: so a history of looks is small, and that
 * two are alike is told by pointers. Looks may be read, copied and released in any thread; one look is
 * changed by one thread. */
#ifndef WEFT_VIEW_LOOK_H
#define WEFT_VIEW_LOOK_H

#include <stdbool.h>

#include "weft/material.h"
#include "weft/render.h"

enum {
    LOOK_LIGHTS = 64,
    LOOK_PATH = 1024,
    LOOK_NAPS = 16,
    LOOK_FOLDERS = 16,
    LOOK_LOBES = 8,
    NAP_SIDE = 512
};

/* Folders of maps that materials wear, the latest of each; of index -1 the cloth of the scene. */
typedef struct Folders {
    char paths[LOOK_FOLDERS][LOOK_PATH];
    int materials[LOOK_FOLDERS];
    int count;
} Folders;

/* The light from far away. */
typedef enum AroundKind { AROUND_STUDIO = 0, AROUND_FILE, AROUND_COLOR } AroundKind;
typedef struct Around {
    AroundKind kind;
    char path[LOOK_PATH]; /* of a lat-long picture or of a cubemap */
    float color[3];
    float rotation, strength;  /* degrees; a factor */
    float ambient, reflection; /* factors on what lobes reflect of it: weft_scene_set_environment_parts */
    unsigned again;            /* another number: the file has changed */
} Around;

typedef struct LookMaterial LookMaterial; /* shared */

/* The nap that was brushed onto a material: U8 RGB, NAP_SIDE a side, red and green its direction, blue how
 * much of its angle it leans there. Shared. */
typedef struct Nap Nap;

typedef struct Look {
    LookMaterial **materials;
    int material_count;
    WeftLight lights[LOOK_LIGHTS];
    int light_count;
    int variant; /* of the scene's; -1: none */
    Around around;
    Nap *naps[LOOK_NAPS]; /* NULL: none */
} Look;

/* Takes the place of the one that the material wore. */
void folders_keep(Folders *folders, const char *path, int material);

/* The built-in studio, as it is. */
Around around_studio(void);

/* Whether both shine from the same source: the studio, one reading of a file, a colour. */
bool around_same_source(const Around *a, const Around *b);
/* Shines from the source of another one; how it is turned and how strong it is stays. */
void around_take_source(Around *around, const Around *from);

/* Of a scene as it is; the environment apart, which a scene does not tell. False where memory is short. */
bool look_read(Look *look, const WeftScene *scene);
bool look_copy(Look *copy, const Look *look);
void look_free(Look *look);
bool look_same(const Look *a, const Look *b);

const WeftMaterial *look_material(const Look *look, int index);
bool look_set_material(Look *look, int index, const WeftMaterial *material);
bool look_same_material(const Look *a, const Look *b, int index);

/* The preset that a material was dressed in last, counted from 1; 0: none. What else is done to it leaves
 * that as it is, and a look that differs in it alone is the same. */
int look_preset(const Look *look, int index);
bool look_set_preset(Look *look, int index, int preset);
/* Those of another look of the same scene. */
bool look_take_presets(Look *look, const Look *from);

/* The nap brushed onto a material; NULL: none. */
const WeftImage *look_nap(const Look *look, int material);
/* A copy of it, or of `own` where there is none yet: to be changed and then taken over by look_set_nap. NULL
 * where there is neither, or memory is short. */
Nap *nap_copy(const Look *look, int material, const WeftImage *own, WeftImage **image);
/* The nap that a material has by its numbers and maps, before anything was brushed; maps of the second UV set
 * are not in it. Release with weft_image_free; false where memory is short. */
bool nap_own(const WeftScene *scene, const WeftMaterial *material, WeftImage *out);
bool look_set_nap(Look *look, Nap *nap);
/* Shares the naps of another look of the same scene. */
void look_take_naps(Look *look, const Look *from);
void nap_free(Nap *nap);

/* What of naps a scene has: the number of each one's texture. */
typedef struct LookWorn {
    int materials[LOOK_NAPS], textures[LOOK_NAPS];
    int count;
} LookWorn;

/* Brings materials, variant and lights of a scene that is dressed as `is` to `look`; both of that scene.
 * changed receives, beside what it holds, what changed (WEFT_CHANGED_MATERIALS ...). On failure the scene is
 * somewhere between. */
WeftResult look_apply(const Look *look, const Look *is, LookWorn *worn, WeftScene *scene, unsigned *changed,
                      WeftError *error);
/* The same of the light from far away. Where its source cannot be had the scene is as it was. */
WeftResult around_apply(const Around *around, const Around *is, WeftScene *scene, unsigned *changed,
                        const WeftLog *log, WeftError *error);

#endif
