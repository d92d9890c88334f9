/* backdrop.h - the environment out of focus, as a background that does not draw the eye */
#ifndef WEFT_SCENE_BACKDROP_H
#define WEFT_SCENE_BACKDROP_H

#include "scene/record/scene.h"

/* The mean radiance about each direction under the weight exp(kappa (cos - 1)) (Ronald Fisher, "Dispersion on
 * a Sphere", 1953), kappa 30: about 10 degrees. F32 RGB lat-long in the frame of the environment's image,
 * without its rotation and strength, to be read between its texels; owned by the caller. For an environment
 * that has an image. Fails with WEFT_MESSAGE_MEMORY. */
WeftResult backdrop_blurred(const Environment *environment, WeftImage *out, WeftError *error);

/* Radiance along a world direction, with rotation and strength. */
void backdrop_at(const Environment *environment, const WeftImage *blurred, Vec3 direction, float color[3]);

#endif
