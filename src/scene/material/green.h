/* green.h - the direction of green in a picture of normals, by what the picture shows */
#pragma once

#include <stdbool.h>

#include "weft/image.h"

/* Returns true if the slopes of the normals are those of one surface with green down, as in DirectX, and not with green
 * up. False for a picture without relief, and for one whose slopes fit neither well. */
bool normals_green_down(const WeftImage *image);
