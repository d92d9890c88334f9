/* orbit.h - a camera moved by hand: about a point, or through the scene
 *
 * Positions in metres, angles in radians; up is +y. */
#pragma once

#include <stdbool.h>

#include "weft/scene.h"

enum { ORBIT_TEXT = 160 };

typedef struct Orbit {
    float eye[3], target[3];
    float fov;             /* vertical, degrees */
    char name[ORBIT_TEXT]; /* the scene's camera that it is at, until it moves; "": none */
} Orbit;

/* Moves to a camera of the scene, named as in WeftRenderDesc.camera. Returns false if there is no such camera. */
bool orbit_at(Orbit *orbit, const WeftScene *scene, const char *camera, float aspect);

/* Rotates about the target; right and down are positive. */
void orbit_rotate(Orbit *orbit, float across, float down);

/* Moves eye and target so that the point under the mouse stays there; dx, dy in fractions of the picture's
 * height. */
void orbit_pan(Orbit *orbit, float across, float down);

/* Moves towards the target: multiplies the distance. */
void orbit_dolly(Orbit *orbit, float factor);

/* Rotates the view about the eye; right and down are positive. */
void orbit_look(Orbit *orbit, float across, float down);

/* Moves the eye along its view direction, to the right, and up in the world; metres. */
void orbit_fly(Orbit *orbit, float forward, float right, float up);

/* Moves the eye so that a box fits a picture of that aspect; the view direction stays. */
void orbit_frame(Orbit *orbit, const float low[3], const float high[3], float aspect);

/* Writes the camera in the form of `weft render --camera`. */
const char *orbit_text(const Orbit *orbit, char text[ORBIT_TEXT]);

/* Projects a point of the world into a picture, as fractions of its width and height from the top left.
 * Returns false if the point is behind the eye. */
bool orbit_project(const Orbit *orbit, const float point[3], float aspect, float at[2]);

/* Computes the direction, of unit length, of the ray through a position in the picture. */
void orbit_ray(const Orbit *orbit, float aspect, float x, float y, float direction[3]);

/* Computes the unit vectors right, up and forward. */
void orbit_axes(const Orbit *orbit, float right[3], float up[3], float forward[3]);
