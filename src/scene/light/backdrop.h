/* backdrop.h - the blurred environment, as an unobtrusive background */
#pragma once

#include "scene/record/scene.h"

/* Makes the mean radiance about each direction under the weight exp(kappa (cos - 1)) (Ronald Fisher, "Dispersion on a
 * Sphere", 1953), kappa 30: about 10 degrees. F32 RGB lat-long in the frame of the environment's image, without
 * rotation and strength, to be interpolated; owned by the caller. The environment must have an image. Fails with
 * WEFT_MESSAGE_MEMORY. */
WeftResult backdrop_blurred(const Environment *environment, WeftImage *out, WeftError *error);

/* Sets the radiance along a world direction, with rotation and strength. */
void backdrop_at(const Environment *environment, const WeftImage *blurred, Vec3 direction, float color[3]);
