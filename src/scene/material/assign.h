/* assign.h - the materials that a name selects */
#pragma once

#include "scene/record/scene.h"

/* Returns a flag for each material that is set if name, index or "*" selects it. NULL selects all that have a
 * sheen or, if none has, all that emit no light. The flags live as long as the scene. Returns NULL on
 * failure: MATERIAL_NAME or MEMORY. */
bool *materials_matching(WeftScene *scene, const char *material, WeftError *error);

/* Assigns a material to one by its index, below scene_own_materials: from the text of a material file without pictures, and
 * from a file, as weft_scene_assign_material. */
WeftResult material_assign_text(WeftScene *scene, int material, const char *text, WeftError *error);
WeftResult material_assign_file(WeftScene *scene, int material, const char *path, WeftError *error);
