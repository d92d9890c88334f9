/* cloth_fit.h - the size of threads on a mesh: metres that a unit of texture coordinates spans */
#pragma once

#include "scene/record/scene.h"

/* Returns the metres that a unit of texture coordinates, set 0 or 1, spans on the meshes of a material: the root of
 * their area over that of their texture coordinates. Returns 0 where no triangle has an area in both. `uneven`, which may be
 * NULL, gets the standard deviation of the logarithm of a triangle's own metres, weighted by area: 0 where threads have
 * one size. */
double cloth_uv_metres(const WeftScene *scene, int material, int set, double *uneven);

/* Gives a cloth that the scene does not have yet the size that suits a material's meshes, if its metres are
 * automatic. */
void cloth_fit(const WeftScene *scene, int material, WeftCloth *cloth);

/* Warns where a woven material has a transmission, which threads have not, and where its meshes have no texture
 * coordinates, or such that threads differ in size. */
void cloth_check(const WeftScene *scene, int material, const WeftLog *log);

/* The standard deviation of cloth_uv_metres from which on threads differ visibly. */
#define CLOTH_UNEVEN 0.25

/* Gives a material a cloth of the size that suits it, which the scene then owns, also on failure:
 * WEFT_MESSAGE_MEMORY. */
WeftResult cloth_put(WeftScene *scene, int material, WeftCloth *cloth, WeftError *error);

/* Gives cloths whose metres are automatic the size that suits the meshes of their material, and a copy to each of
 * several materials that differ. Call it when materials, or the meshes that have them, have changed. fresh: the
 * scene was just read and nothing else refers to its cloths, so that the first material's needs no copy. Fails with
 * WEFT_MESSAGE_MEMORY. */
WeftResult cloths_fit(WeftScene *scene, bool fresh, WeftError *error);
