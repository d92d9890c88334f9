/* weave_place.h - the place of a weave on texture coordinates, and its rotation against their tangent */
#pragma once

#include "shading/dialect/angles.h"
#include "shading/weave/weave_noise.h"

/* The way from texture coordinates to threads: their numbers in a unit, and the rotation of the weave. */
STRUCT(WeavePlacing) { float warps, picks, rotation_cos, rotation_sin; };

/* Returns a step in texture coordinates in threads: across the warp (x), and along it in picks (y). Picks count up the
 * cloth, v runs down. */
FN Dir weave_threads(WeavePlacing p, float u, float v) {
    return dir((p.rotation_cos * u - p.rotation_sin * v) * p.warps,
               (-p.rotation_cos * v - p.rotation_sin * u) * p.picks, 0.0f);
}

/* Returns the place of texture coordinates on the cloth, in threads. */
FN Dir weave_place_of(WeavePlacing p, float u, float v) {
    Dir at = weave_threads(p, u, v);
    return dir(weave_in_range(at.x), weave_in_range(at.y), 0.0f);
}

/* Returns a direction of the tangent's frame in the frame of the threads. */
FN Dir weave_direction(WeavePlacing p, Dir w) {
    return dir(p.rotation_cos * w.x + p.rotation_sin * w.y, p.rotation_cos * w.y - p.rotation_sin * w.x, w.z);
}
