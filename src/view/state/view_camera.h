/* view_camera.h - the camera that the scene is seen through */
#pragma once

#include "view/render/orbit.h"
#include "view/state/viewer.h"

typedef struct CameraState {
    Orbit orbit;
    bool found;    /* a frame through the scene's camera that it is at has told where that is */
    bool at_home;  /* home and reach are those of the renderer */
    float home[3]; /* target of the first camera, m */
    float reach;   /* half the distance to it, m: the size of the scene's objects */
} CameraState;

void camera_set(Viewer *v, const Orbit *orbit);

/* Moves to a camera of the scene, by name or number. */
void camera_stand_at(Viewer *v, const char *name);

/* Sets the first camera of a scene that was read. Home and reach are estimates until a frame has been drawn. */
void camera_begin(Viewer *v, const WeftScene *scene, const char *name);

/* Sets the position of a camera of the scene, which a frame drawn through it has found. */
void camera_found(Viewer *v, const RenderedFrame *frame);
void camera_frame_all(Viewer *v);
void camera_reset(Viewer *v);
