/* loom_scene.h - the scene builtin:loom: woven swatches, and denim over a bar */
#pragma once

#include "scene/record/scene.h"

/* Makes six swatches of woven presets, and a seventh cloth over a bar. The cameras are main; far, whose picture is
 * 5,000 threads of the denim wide; near, 500; close, 50; threads, 5. */
WeftResult loom_make(WeftScene *scene, WeftError *error);
