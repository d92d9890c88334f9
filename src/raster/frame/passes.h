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

/* Begins the sum self->sums, whose view is complete and valid; `seen` is its camera's. Compiles its shaders and uploads
 * what they need. The last picture of self->target begins the sum if sums.starts is set. Fails as weft_raster_draw
 * does. */
WeftResult frame_begin_sum(WeftRaster *self, const View *seen, WeftError *error);

/* Draws so many rows of a frame of the sum, or what is left of it, and waits until they are drawn. A whole frame is added
 * to the sum, and the mean becomes the picture of self->target. */
WeftResult frame_draw_sum(WeftRaster *self, int rows, WeftError *error);
