/* shader_keys.h - the shader that a picture needs for each material, for shadow maps and for the floor
 *
 * Views must be complete: no member has its default 0 any more. */
#pragma once

#include "raster/frame/raster_state.h"

/* Returns the key of a material in a picture, with the scene's lights, or in a frame of a sum, without. */
ShaderKey lit_key(const WeftRaster *self, const WeftRasterView *view, const GlMaterial *material);

/* Returns the key of a material, whose own key is given, in a shadow map. */
ShaderKey depth_key(const ShaderKey *key);

/* Returns true if the shading points of a picture are fewer than its pixels. */
bool is_coarse(const WeftRasterView *view);

/* Returns true if a key is that of a material in a picture at rest. */
bool is_still(const ShaderKey *key);

/* Returns the key of the floor. */
ShaderKey floor_key(const WeftRaster *self, const WeftRasterView *view);

/* Returns true if `test` holds for all keys that a picture needs, with_floor including the floor's; stops at the first
 * for which it does not. */
bool all_keys(WeftRaster *self, const WeftRasterView *view, bool with_floor,
              bool (*test)(Programs *programs, const ShaderKey *key));
