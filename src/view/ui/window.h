/* window.h - a window of the desktop with OpenGL 3.3 in it, or the same without a display: a picture in
 * memory for replays
 *
 * Input arrives as events, in a queue to which a replay may add its own. All calls are for the thread that
 * opened it, except window_wake and those of the worker. */
#pragma once

#include "view/ui/ui.h"
#include "weft/image.h"

typedef struct Window Window;

typedef struct WindowDesc {
    const char *title;
    int width, height; /* pixels */
    bool unseen;       /* without a display */
    float scale;       /* pixels per design pixel; 0: that of the display, 1 without one */
} WindowDesc;

/* Opens a window, whose context is current in this thread. NULL with one line in `why` on failure. */
Window *window_open(const WindowDesc *desc, char why[256]);
void window_close(Window *window);

/* Makes a second context, which shares textures with the window's, current in the calling thread. */
bool window_worker_begin(Window *window);
void window_worker_end(Window *window);

typedef enum EventKind {
    EVENT_MOVE,   /* x, y */
    EVENT_BUTTON, /* code, down */
    EVENT_WHEEL,  /* x, y */
    EVENT_KEY,    /* code, letter, down, repeats, modifiers */
    EVENT_TYPED,  /* code: a code point */
    EVENT_DROP,   /* path */
    EVENT_RESIZE, /* x, y */
    EVENT_LEAVE,  /* the mouse */
    EVENT_FOCUS   /* lost: all keys and buttons count as released */
} EventKind;

typedef struct Event {
    EventKind kind;
    float x, y;
    int code;
    char letter;
    bool down, repeats, control, shift, alt;
    char *path; /* copied by window_push */
} Event;

/* Adds an event behind those that wait; a path is copied. */
void window_push(Window *window, const Event *event);

/* Takes the events since the last call into input, as far as one frame can show them. If a button or key went down and
 * up, the second event stays for the next frame, and so does a later change of Ctrl, Shift or Alt. Returns true if
 * anything happened. */
bool window_take(Window *window, UiInput *input);

/* Returns true if events wait. */
bool window_has_events(const Window *window);

/* Returns the next file that was dropped on the window, NULL if none; release with free. */
char *window_dropped(Window *window);

/* Waits for an event, for window_wake, or for `seconds` at most; 0: does not wait. */
void window_wait(Window *window, double seconds);
void window_wake(Window *window); /* from any thread */

/* Makes its framebuffer the one that is drawn into, and clears it. */
void window_bind(Window *window);
void window_present(Window *window);
void window_size(const Window *window, int *width, int *height);
float window_scale(const Window *window);
bool window_hidden(const Window *window); /* minimised: nothing can be seen */
/* Returns true if the window was asked to close since the last call. */
bool window_take_close(Window *window);
void window_request_close(Window *window);
void window_cursor(Window *window, UiCursor cursor);
void window_title(Window *window, const char *title);
const UiClipboard *window_clipboard(Window *window);

/* Copies the next frame before it is presented, since the front buffer of a window need not be readable. */
void window_keep(Window *window);
/* Returns the frame that was kept last, U8 RGB; NULL if there is none. */
const WeftImage *window_kept(const Window *window);
