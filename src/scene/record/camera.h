/* camera.h - finding a camera by its name or by text, and framing a scene without one */
#pragma once

#include "scene/record/scene.h"

/* Finds the camera of a text: NULL or "auto" is a three-quarter view from slightly above through a long lens, with all
 * of the scene in the picture; else a camera's name, its index, or "eye;target;fov" as "x,y,z;x,y,z;degrees". aspect is
 * width / height. Fails with WEFT_MESSAGE_CAMERA_NAME or _SCENE_EMPTY. */
WeftResult camera_find(const WeftScene *scene, const char *text, float aspect, Camera *out, WeftError *error);

/* Returns an upright perspective camera at eye that looks at target; yfov: vertical, radians. name is not copied. */
Camera camera_towards(const char *name, Vec3 eye, Vec3 target, float yfov);

/* Sets eye, target and vertical field of view, degrees, of a camera. The target is the point of its axis nearest to the
 * scene's middle. */
void camera_describe(const WeftScene *scene, const Camera *camera, float eye[3], float target[3], float *fov);

/* The rays of a picture through a camera. */
typedef struct View {
    Vec3 eye, forward;
    Vec3 across, up; /* from the middle of the picture to the middle of its right and upper border */
    bool orthographic;
} View;

View view_of(const Camera *camera, float aspect);

typedef struct CameraRay {
    Vec3 origin, direction; /* direction is unit */
} CameraRay;

/* Returns the ray through (x, y) in [-1, 1]^2, +y up, or outside of that beside the picture. */
static inline CameraRay view_ray(const View *view, float x, float y) {
    Vec3 offset = vec3_madd(vec3_scale(view->across, x), view->up, y);
    if (view->orthographic) return (CameraRay){vec3_add(view->eye, offset), view->forward};
    Vec3 d = vec3_add(view->forward, offset);
    return (CameraRay){view->eye, vec3_scale(d, 1.0f / sqrtf(vec3_dot(d, d)))};
}
