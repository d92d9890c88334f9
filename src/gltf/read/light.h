/* light.h - KHR_lights_punctual */
#ifndef WEFT_GLTF_LIGHT_H
#define WEFT_GLTF_LIGHT_H

#include "gltf/asset/asset.h"

/* Only counts them, for the nodes. */
void lights_count(Asset *asset);

/* Adds the lights of the shown nodes to the scene, in the order of nodes. glTF's photometric units are taken
 * as radiometric ones, one for one, as for emission: their proportions stay, the exposure is the viewer's. */
void lights_read(Asset *asset);

#endif
