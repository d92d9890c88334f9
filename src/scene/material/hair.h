/* hair.h - loose fibres that stand off a cloth and break its outline, as triangles that every renderer draws
 *
 * A fibre is a flat ribbon of two pieces of equal length: a rectangle that rises from the cloth, and a triangle that goes on
 * in another direction and ends in a point. Fibres are strewn evenly over the front of a mesh, as many on each triangle as
 * its area has room for. Length (half of the longest and more), lean, bend and azimuth are random numbers of
 * mesh and triangle, so a scene has the same hair each time. None grows in holes of its cloth.
 *   Of each mesh with hair the scene has a mesh of ribbons, with a material of its own: that of the cloth, seen from both
 * sides, opaque, without maps of the relief, and in place of a weave with the albedo of the fibres of the thread that it
 * comes from. */
#pragma once

#include "scene/record/scene.h"

/* Hair of more fibres is refused. Each takes 0.2 KiB, and about 0.3 KiB more in the path tracer. */
enum { HAIRS_MOST = 4000000 };

/* The triangles and the vertices of a fibre: two at its root, two at its joint, and its tip. */
enum { HAIR_TRIANGLES = 3, HAIR_VERTICES = 5 };

/* Returns true if a mesh of the scene, or a material, is that of hair. */
static inline bool hair_is_mesh(const WeftScene *scene, int mesh) {
    return mesh >= scene_own_meshes(scene) && mesh < scene_light_meshes(scene);
}
static inline bool hair_is_material(const WeftScene *scene, int material) {
    return material >= scene_own_materials(scene) && material < scene_light_materials(scene);
}

/* Returns the width of the fibres of a mesh of hair, m. */
static inline float hair_thickness(const WeftScene *scene, int mesh) {
    return scene->hairs[mesh - scene_own_meshes(scene)].numbers[WEFT_HAIR_THICKNESS];
}

/* Returns the part of an even sky that the hair of a material lets through to its cloth, 1 without hair. Fibres at all
 * angles have half of their area a across a ray: exp(-a / 2 cos) reach a level cloth at an angle, and of the sky 2 E_3(a / 2),
 * which is within 0.01 of exp(-0.9 a) for a up to 0.6 (Milton Abramowitz, Irene A. Stegun, "Handbook of Mathematical
 * Functions", 1964, 5.1.4). The area of a fibre is that of 3/4 of the length and 3/4 of the width. */
float hair_lets_through(const Material *material);

/* Returns the vector from the middle of a fibre to one of its vertices, half as long as the fibre is wide; 0 at its tip. */
Vec3 hair_across(const Mesh *hair, uint32_t vertex);

/* Grows the hair that materials ask for where it is not there yet, drops what none asks for, and gives all hair the present
 * materials of its cloth. Call it when materials, or the meshes that have them, have changed. Fails with
 * WEFT_MESSAGE_PARAM_VALUE beyond HAIRS_MOST, or _MEMORY; hair is then as it was. */
WeftResult hairs_fit(WeftScene *scene, WeftError *error);

/* Releases all hair; only the scene may be released then. */
void hairs_free(WeftScene *scene);

/* Makes a copy of a scene without hair, of which all else is shared. Its lists are in the arena. Returns false if memory is
 * short. */
bool hairs_left_out(const WeftScene *scene, Arena *arena, WeftScene *out);
