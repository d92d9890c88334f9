/* u3m_source.h - the text of a U3M in the scene, so that what weft does not understand is written again */
#pragma once

#include "scene/record/scene.h"

/* The text of a U3M that was read, one block of memory. */
typedef struct U3mText {
    size_t size;
    const char *path; /* of the .u3m or .u3ma */
    const char *part; /* the member that was read as the material: "front", "back" or "side" */
    const char *text; /* of size bytes and a zero byte */
} U3mText;

/* The U3M that a material of a scene was read from, and how it was read: where the material is still so, the text is
 * written again as it is. In the scene's arena. */
typedef struct U3mSource {
    U3mText text;
    Material material, back;
    bool has_back;
} U3mSource;

/* Returns the U3M of a material of a scene, or NULL. */
static inline const U3mSource *u3m_source(const WeftScene *scene, int material) {
    return scene->u3m && material < scene_own_materials(scene) ? scene->u3m[material] : NULL;
}

/* Keeps the U3M that selected materials have just been given, NULL: none. Fails with WEFT_MESSAGE_MEMORY. */
WeftResult u3m_keep(WeftScene *scene, const bool *selected, const U3mText *text, WeftError *error);
