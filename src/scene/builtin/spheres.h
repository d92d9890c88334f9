/* spheres.h - the scenes of balls: builtin:spheres, a sweep of sheen roughness, and builtin:ball, one */
#pragma once

#include "scene/record/scene.h"

/* Makes two rows of five spheres on a floor: sheen roughness from 0.1 (left) to 1; a dark base in front, a light one
 * behind. Materials are named dark-0 .. dark-4, light-0 .. light-4 and floor. */
WeftResult spheres_make(WeftScene *scene, WeftError *error);

/* Makes one such ball, light and of sheen roughness 0.5, near the camera. Materials are named ball and floor. */
WeftResult ball_make(WeftScene *scene, WeftError *error);
