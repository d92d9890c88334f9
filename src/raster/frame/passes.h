/* passes.h - the passes of a picture: shadow maps, mirror of the floor, solid meshes, background, floor, blended meshes
 *
 * All calls are for the context that is current. */
#pragma once

#include "raster/frame/raster_state.h"

/* Sets the OpenGL state that every pass starts from. */
void frame_reset_state(WeftRaster *self);

/* Uploads the occlusion that was found in the background, or is waited for. Does nothing if shapes of lights have
 * changed since the last update, which uploads them. Fails as lookout_take does. */
WeftResult frame_take_occlusion(WeftRaster *self, bool wait, WeftError *error);

/* Draws a picture into self->target. The view must be complete and valid; `seen` is its camera's. Fails as
 * weft_raster_draw does. */
WeftResult frame_draw_passes(WeftRaster *self, const WeftRasterView *view, const View *seen, WeftError *error);
