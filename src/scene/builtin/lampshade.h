/* lampshade.h - the scene builtin:lampshade: light through cloth, of a lamp's shade and of a curtain */
#pragma once

#include "scene/record/scene.h"

/* Makes a lit table lamp in front of a curtain. Materials are named shade, curtain, bulb, stand and table. */
WeftResult lampshade_make(WeftScene *scene, WeftError *error);
