/* slopes.h - the slopes of a normal map within the texels of its levels
 *
 * A level of a normal map has mean normals: the unevenness that is averaged away would make a surface smoother, and its
 * highlight brighter, the farther it is. So another texture has moments of the slopes, which are averaged as the normals
 * are: Marc Olano, Dan Baker, "LEAN Mapping", I3D 2010, section 3. The fourth moment, which LEAN mapping does without,
 * tells ribs with two sides from grains.
 *
 * A slope is (x, y) / z of a normal, at most SLOPE_MOST. Four floats a texel:
 *
 *   E x^2, E x y, E y^2, E (x^2 + y^2)^2 */
#pragma once

#include "weft/image.h"

/* Replaces the size of a normal map by that of its slopes: half of it, or so many halvings more that no side is longer
 * than SLOPES_SIDE. */
enum { SLOPES_SIDE = 512 };
void slopes_size(int *width, int *height);

/* Writes all levels, one after the other, each halved from the one before down to one texel. */
void slopes_make(const WeftImage *map, int width, int height, float *levels);
