/* environment.h - distant light made by rule */
#ifndef WEFT_SCENE_ENVIRONMENT_H
#define WEFT_SCENE_ENVIRONMENT_H

#include "scene/record/scene.h"

/* The studio: a dim room with a large soft box high at the left, a weaker strip at the right, a rim light
 * behind and a bright floor bounce. F32 RGB lat-long, values in radiance; a product photographer's starting
 * point. */
WeftResult environment_studio(WeftImage *out, WeftError *error);

/* Dims the studio to a fill where the scene brings lights of its own, which else would be drowned. */
void environment_give_way(WeftScene *scene);

#endif
