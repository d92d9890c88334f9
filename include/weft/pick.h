/* pick.h - the surface under a pixel
 *
 * Shapes are those of when the picker was made, and none of lights; materials are read as they are. One
 * thread at a time, not beside calls that change the scene. */
#ifndef WEFT_PICK_H
#define WEFT_PICK_H

#include "weft/scene.h"

#ifdef __cplusplus
extern "C" {
#endif

/* A picker. */
typedef struct WeftPick WeftPick;

/* The scene must outlive it. Fails with WEFT_MESSAGE_SCENE_EMPTY, _MEMORY or _RENDER_DEVICE. */
WEFT_API WeftResult weft_pick_create(const WeftScene *scene, WeftPick **out, WeftError *error);

/* pick may be NULL. */
WEFT_API void weft_pick_free(WeftPick *pick);

/* The point that a ray hits. */
typedef struct WeftPicked {
    int mesh, material;           /* indices in the scene */
    float position[3], normal[3]; /* in the world; the normal unit, interpolated, towards the viewer */
    float tangent[3];             /* unit, along +u, at right angles to the normal */
    float bitangent[3];           /* the same along +v */
    float texcoord[2][2];         /* of both UV sets */
    float distance;               /* m */
    float uv_per_metre;           /* UV of set 0 that a metre on the surface spans, on average */
} WeftPicked;

/* Through the point (x, y), pixels from the top left, of a picture of that size; camera as in WeftRenderDesc.
 * Returns 1, or 0 where there is nothing or the camera is none. What is cut out by opacity is not there. */
WEFT_API int weft_pick_at(const WeftPick *pick, const char *camera, int width, int height, float x, float y,
                          WeftPicked *out);

#ifdef __cplusplus
}
#endif

#endif
