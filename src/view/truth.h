/* truth.h - the thread that path traces what the window shows, sample upon sample
 *
 * The scene is the painter's, which holds the truth still while it changes anything. */
#ifndef WEFT_VIEW_TRUTH_H
#define WEFT_VIEW_TRUTH_H

#include "view/orbit.h"
#include "view/window.h"
#include "weft/render.h"
#include "weft/sheet.h"

typedef struct Truth Truth;

typedef struct TruthOrder {
    bool wanted;
    WeftRenderDesc desc; /* its camera is the text below */
    char camera[ORBIT_TEXT];
    WeftTonemap tonemap;
    float exposure;
    float behind[3]; /* light of the display, where it is transparent */
    bool difference; /* from the picture that was handed over, in place of it */
    float scale;     /* of the heat map; 0: the 99 of 100 pixels */
    int samples;     /* a pixel, after which it rests */
} TruthOrder;

/* What there is to show: U8 RGBA. */
typedef struct TruthPicture {
    WeftImage image;
    unsigned number; /* of the painter's order in whose place it is; 0: it is wanted for itself */
    double samples, seconds;
    int wanted_samples;
    WeftDifference difference; /* where one was asked for and `compared` */
    bool compared;
    float scale;
    char failure[256];
} TruthPicture;

/* window must outlive it, and is woken when there is something to take. NULL where memory is short. */
Truth *truth_start(Window *window);
void truth_stop(Truth *truth);

/* Holds it still: when this returns nothing reads the scene. */
void truth_hold(Truth *truth);
/* Lets it go on with a scene (NULL: none) in which `changed` has changed, WEFT_CHANGED_MATERIALS and so on;
 * of another scene all. */
void truth_release(Truth *truth, const WeftScene *scene, unsigned changed);

void truth_order(Truth *truth, const TruthOrder *order);

/* From now on pictures are made though none is wanted, in the place of the one that the painter cannot draw
 * yet, whose number they bear; coarse ones at first. 0: no more. */
void truth_stand_in(Truth *truth, unsigned number);
/* Waits for the first picture that bears the number, so long at most. */
void truth_await(Truth *truth, unsigned number, double seconds);

/* The picture to compare with: taken over and zeroed. */
void truth_compare(Truth *truth, WeftImage *linear);

/* The newest picture: true where it is another one; then it is the caller's to free. */
bool truth_take(Truth *truth, TruthPicture *picture);

bool truth_fresh(Truth *truth);

/* The samples so far, F32 RGBA; false where there are none. */
bool truth_image(Truth *truth, WeftImage *out);

/* Whether it rests: it is not wanted, or has all of its samples. */
bool truth_resting(Truth *truth);

#endif
