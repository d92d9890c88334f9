/* frame_requests.h - requests for frames, and their results */
#pragma once

#include "view/state/viewer.h"

enum { TRACE_SAMPLES = 1024, GLIDE = 6 };

/* The kind of picture that is shown. */
typedef enum Shows { SHOWS_NOTHING, SHOWS_DRAWN, SHOWS_TRACED } Shows;

typedef struct RequestsState {
    RenderedFrame rendered;
    unsigned requested;   /* number of the last request */
    FrameRequest request; /* the last request; its states are empty */
    SceneState sent;      /* the edited state of the last request */
    bool due;             /* a request must be sent even if nothing that is drawn has changed */
    double changed;       /* time of the last request that differed from the one before, s */
    bool late;            /* the renderer is busy for long: the window does not wait for it */
    int glide;            /* frames until a picture in motion has faded out over the finer one */
    unsigned reference_texture;
    ReferenceFrame traced; /* without its image */
    Probe probe;
    bool has_probe;
    char shader_complaint[512], failure[512]; /* last reported to the user */
} RequestsState;

/* Makes the next requests_send send a request even if nothing that is drawn has changed. */
void requests_due(Viewer *v);

/* Forgets the scene that was drawn before: its state, which is released, or the point that was probed. */
void requests_forget(Viewer *v);
void requests_forget_probe(Viewer *v);
void requests_end(Viewer *v);

/* Sends a request if it differs from the last one, or if its picture can now be drawn more finely. */
void requests_send(Viewer *v);

/* Returns true if the picture shown is of the latest request but could be drawn more finely. */
bool requests_can_refine(const Viewer *v);

/* Takes the newest picture; waits up to 0.04 s for one if one is due. */
void requests_wait_frame(Viewer *v);

/* Returns the opacity of the picture in motion over the finer one that replaced it: it falls to 0 within GLIDE frames. */
float requests_glide(const Viewer *v);
void requests_take_reference(Viewer *v);

/* Reads the position of a camera of the scene from the first frame drawn through it. */
void requests_read_camera(Viewer *v);

/* Takes the events of tasks. */
void requests_take_events(Viewer *v);

/* Returns the kind of the newest picture of the scene: the path traced one in its modes, or while OpenGL has no picture
 * of its request yet. */
Shows requests_shown(const Viewer *v);
const char *shows_name(Shows shows); /* "nothing", "drawn", "traced" */

/* Returns the size of requested frames: that of the stage, at least 16 pixels. */
void requests_picture_size(const Viewer *v, int *width, int *height);
