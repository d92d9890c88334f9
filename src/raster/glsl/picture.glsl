/* picture.glsl - the uniform block that all shaders of a picture share: the camera, lights and their shadows */
#include "raster/glsl/picture_uniforms.h"

#define PICTURE_ONE(type, name)         highp type name;
#define PICTURE_MANY(type, name, count) highp type name[count];
layout(std140) uniform Picture { PICTURE_UNIFORMS(PICTURE_ONE, PICTURE_MANY) };
