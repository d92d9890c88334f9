/* environment.h - the procedural studio environment */
#pragma once

#include "scene/record/scene.h"

/* Makes the studio: a dim room with a large soft box high at the left, a weaker strip at the right, a rim light behind
 * and a bright floor bounce. F32 RGB lat-long, radiance; a product photographer's starting point. Fails with
 * WEFT_MESSAGE_MEMORY. */
WeftResult environment_studio(WeftImage *out, WeftError *error);

/* Dims the studio to a fill light if the scene has lights of its own, since it would outshine them. */
void environment_give_way(WeftScene *scene);
