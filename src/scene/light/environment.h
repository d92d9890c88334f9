/* environment.h - the procedural studio environment, and the factors on the light of any */
#pragma once

#include "scene/record/scene.h"

/* Makes the studio: a dim room with a large soft box high at the left, a weaker strip at the right, a rim light behind
 * and a bright floor bounce. F32 RGB lat-long, radiance; a product photographer's starting point. Fails with
 * WEFT_MESSAGE_MEMORY. */
WeftResult environment_studio(WeftImage *out, WeftError *error);

/* Returns true unless the factors `ambient` and `reflection` are both 1. */
bool environment_in_parts(const Environment *environment);

/* Dims the studio to a fill light if the scene has lights of its own, since it would outshine them. */
void environment_give_way(WeftScene *scene);
