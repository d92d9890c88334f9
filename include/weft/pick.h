/* pick.h - the surface under a pixel
 *
 * A picker keeps the shapes of the moment when it was made, without those of lights; materials are read as they are
 * now. One thread at a time may use it, not beside calls that change the scene. */
#ifndef WEFT_PICK_H
#define WEFT_PICK_H

#include "weft/scene.h"

#ifdef __cplusplus
extern "C" {
#endif

/* A picker. */
typedef struct WeftPick WeftPick;

/* Makes a picker of a scene, which must outlive it. Fails with WEFT_MESSAGE_SCENE_EMPTY, _MEMORY or _RENDER_DEVICE. */
WEFT_API WeftResult weft_pick_create(const WeftScene *scene, WeftPick **out, WeftError *error);

WEFT_API void weft_pick_free(WeftPick *pick); /* may be NULL */

/* The point that a ray hits. */
typedef struct WeftPicked {
    int mesh, material;           /* indices in the scene */
    float position[3], normal[3]; /* in the world; the normal unit, interpolated, towards the viewer */
    float tangent[3];             /* unit, along +u, at right angles to the normal */
    float bitangent[3];           /* the same along +v */
    float texcoord[2][2];         /* of both UV sets */
    float distance;               /* m */
    float uv_per_metre;           /* length in UV of set 0 of a metre on the surface, on average */
} WeftPicked;

/* Finds the surface at the point (x, y), pixels from the top left, of a picture of that size; camera as in
 * WeftRenderDesc. Returns 1, or 0 where there is no surface or no such camera. A ray passes where opacity cuts out. */
WEFT_API int weft_pick_at(const WeftPick *pick, const char *camera, int width, int height, float x, float y,
                          WeftPicked *out);

#ifdef __cplusplus
}
#endif

#endif
