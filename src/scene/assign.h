/* dress.h - which materials a wish means */
#ifndef WEFT_SCENE_DRESS_H
#define WEFT_SCENE_DRESS_H

#include "scene/scene.h"

/* Of each material whether it is meant by a name, an index, "*" or NULL: all that have a sheen or, where none
 * has, all that send out no light. Lives as long as the scene. NULL on failure: MATERIAL_NAME or MEMORY. */
bool *materials_matching(WeftScene *scene, const char *material, WeftError *error);

#endif
