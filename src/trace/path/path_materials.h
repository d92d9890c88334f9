/* path_materials.h - the materials of a scene, prepared for all hits of paths on them */
#pragma once

#include "scene/light/sheen_tables.h"
#include "trace/path/path_context.h"

/* Returns the scene's materials in their order, an array that the caller frees; NULL if memory is short. Their sheen_e
 * point into tables. */
PathMaterial *path_materials_create(const WeftScene *scene, const SheenTables *tables);

/* Returns true if any of them is of solid glass. */
bool path_materials_solid(const PathMaterial *materials, int count);
