/* reference_view.h - the thread that path traces the window's view (ground truth), sample upon sample
 *
 * The scene belongs to the renderer, which pauses this thread while it changes anything. */
#pragma once

#include "view/render/orbit.h"
#include "view/ui/window.h"
#include "weft/render.h"
#include "weft/sheet.h"

typedef struct ReferenceView ReferenceView;

typedef struct ReferenceRequest {
    bool wanted;
    WeftRenderDesc desc; /* the camera is the text below */
    char camera[ORBIT_TEXT];
    WeftTonemap tonemap;
    float exposure;
    float white[2];  /* as WeftTone has it */
    float behind[3]; /* colour behind transparent pixels, after tone mapping */
    bool difference; /* show the difference from reference_set_comparison's picture instead */
    float scale;     /* end of the heat map; 0: the 99th percentile */
    int samples;     /* per pixel, after which the thread rests */
} ReferenceRequest;

/* A picture of the path tracer, U8 RGBA. It is denoised until it has all samples, except the first one and
 * differences. */
typedef struct ReferenceFrame {
    WeftImage image;
    unsigned number;         /* of the renderer's request that it replaces; 0: it was itself requested */
    unsigned view, state;    /* numbers of what it shows: reference_request, reference_set_state */
    double samples, seconds; /* samples: below 1 while the resolution is reduced */
    bool denoised;           /* at least partly */
    float exposure;          /* as metered, stops */
    float white[2];          /* as metered */
    int wanted_samples;
    WeftDifference difference; /* if `compared` */
    bool compared;
    float scale;
    char failure[256];
} ReferenceFrame;

/* Starts the thread. window may be NULL; otherwise it must outlive the result, and is woken when there is output. NULL
 * where memory is short. */
ReferenceView *reference_start(Window *window);
void reference_stop(ReferenceView *reference);

/* Pauses the thread: when this returns nothing reads the scene. */
void reference_pause(ReferenceView *reference);
/* Continues with a scene (NULL: none). `changed` are the parts that have changed, WEFT_CHANGED_MATERIALS and so on;
 * for another scene everything counts as changed. */
void reference_resume(ReferenceView *reference, const WeftScene *scene, unsigned changed);

/* Sets the number of the current state of the scene, which later pictures have. After reference_resume with a
 * change or another scene its state has the number 0 until then. */
void reference_set_state(ReferenceView *reference, unsigned state);

/* Returns the number of the request's view, which its pictures have. It is a new one if the previous request had
 * another view, or if only one of the two is wanted, or only one is for a difference. */
unsigned reference_request(ReferenceView *reference, const ReferenceRequest *request);

/* Makes pictures from now on though none is requested, instead of the one that the renderer cannot draw yet, whose
 * number they have; the first ones are coarse. 0: no more. */
void reference_stand_in(ReferenceView *reference, unsigned number);
/* Waits for the first picture with that number, at most `seconds`. */
void reference_wait(ReferenceView *reference, unsigned number, double seconds);

/* Takes the picture to compare with, and zeroes it. It is forgotten if it is not of the latest request's view, or as
 * soon as view or scene change. */
void reference_set_comparison(ReferenceView *reference, unsigned view, WeftImage *linear);

/* Takes the newest picture. Returns true if it is a new one, which the caller must free. */
bool reference_take_frame(ReferenceView *reference, ReferenceFrame *picture);

bool reference_has_frame(ReferenceView *reference);

/* Copies the mean of the samples so far, F32 RGBA; false if there are none. */
bool reference_image(ReferenceView *reference, WeftImage *out);

/* Returns true if the path tracer is idle: it is not wanted, or has all of its samples. */
bool reference_is_idle(ReferenceView *reference);
