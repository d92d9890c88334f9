/* light.h - KHR_lights_punctual */
#pragma once

#include "gltf/asset/asset.h"

/* Counts the lights, before the nodes that refer to them are read. */
void lights_count(Asset *asset);

/* Adds the lights of the shown nodes to the scene, in the order of nodes. The photometric units of glTF are read as
 * radiometric ones, one for one, as for emission: the proportions stay, and the viewer sets the exposure. */
void lights_read(Asset *asset);
