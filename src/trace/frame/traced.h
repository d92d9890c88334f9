/* traced.h - the picture of a render, for the files that make something of it */
#pragma once

#include "trace/frame/tile.h"

/* Returns the picture that a render works on; borrowed. */
const TracedPicture *render_picture(const WeftRender *render);
