/* camera.h - choosing a camera by what a person types, and framing a scene without one */
#ifndef WEFT_SCENE_CAMERA_H
#define WEFT_SCENE_CAMERA_H

#include "scene/scene.h"

/* NULL or "auto": a three-quarter view from slightly above through a long lens, all of the scene in the
 * picture. Else a camera's name, its index, or "eye;target;fov" as "x,y,z;x,y,z;degrees". aspect is width /
 * height. Fails with WEFT_MESSAGE_CAMERA_NAME. */
WeftResult camera_find(const WeftScene *scene, const char *text, float aspect, Camera *out, WeftError *error);

/* The direction (unit) and origin of the ray through (x, y) in [-1, 1]^2, +y up. */
typedef struct CameraRay {
    Vec3 origin, direction;
} CameraRay;

CameraRay camera_ray(const Camera *camera, float aspect, float x, float y);

#endif
