/* picture.h - the uniform block that all shaders of a picture share: camera and punctual lights */
#ifndef WEFT_RASTER_PICTURE_H
#define WEFT_RASTER_PICTURE_H

#include "scene/camera.h"

enum { PICTURE_LIGHTS_MOST = 64 };

/* As glsl/picture.glsl declares it, std140. */
typedef struct Picture {
    float to_clip[16]; /* column after column */
    float eye[4], forward[4];
    float lights[PICTURE_LIGHTS_MOST][4][4];
} Picture;

/* What a scene looks like through a view. */
void picture_make(const WeftScene *scene, const View *view, Picture *out);

#endif
