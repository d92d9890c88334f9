/* bend_scene.h - the scene builtin:bend: a cloth over a bend, and nothing else */
#pragma once

#include "scene/record/scene.h"

/* Makes a cloth over an arc of 150 degrees about the vertical, 0.2 m high, whose threads are not stretched, with texture
 * coordinates in metres. From the front its columns sweep a slice of the cloth's BRDF. */
WeftResult bend_make(WeftScene *scene, WeftError *error);
