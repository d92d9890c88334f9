/* viewer.h - the window's state: who owns which part of it, and what belongs to the window itself
 *
 * Every file may read the state through Viewer. Each part has one owner, which writes it through states.h: the .c file
 * of the header that declares the part's record. Another file changes it by a function of that header. */
#pragma once

#include "view/files/settings.h"
#include "view/render/renderer.h"
#include "view/render/view.h"

enum { MESSAGE_SIZE = 512 };

/* The window and its current frame. */
typedef struct WindowState {
    Settings settings;
    UiInput input;
    double clock; /* of this frame, s */
    long long number;
    bool ending;
    UiBox stage;  /* the picture, pixels of the window */
    UiBox beside; /* at its right, for a photograph; empty without one */
    char message[MESSAGE_SIZE];
    bool message_grave;
    double frame_seconds; /* mean over recent frames */
    double picture_seconds;
    double worst_seconds; /* longest frame since the last report */
} WindowState;

typedef struct Viewer {
    const ViewDesc *desc;
    Window *window;
    Renderer *renderer;
    ReferenceView *reference;
    struct Replay *replay;
    struct Inspection *inspection;   /* of inspect_panel.c; NULL: not yet needed */
    struct Examination *examination; /* of doctor_panel.c, for the open file; NULL: not yet requested */
    struct WeaveEdit *weave;         /* of weave_panel.c; NULL: not yet needed */
    struct PresetWindow *presets;    /* of preset_window.c; NULL: not yet needed */
    const WindowState *frame;
    const struct OpeningState *opening;
    const struct ShownScene *shown;
    const struct EditState *edit;
    const struct ViewOptions *options;
    const struct CameraState *camera;
    const struct RequestsState *requests;
    const struct DialogsState *dialogs;
    const struct DragState *drag;
    const struct StillsState *stills;
    const struct BakingsState *bakings;
    const struct LeavingState *leaving;
    const struct SessionsState *sessions;
    const struct PhotographsState *photographs;
    struct States *states; /* the same records, for their owners */
} Viewer;

/* Creates a viewer with empty states; NULL where memory is short. Release with free, after what the states own. */
Viewer *viewer_create(const ViewDesc *desc);

/* Shows a line in the status bar; a grave one in the colour of warnings. */
void viewer_report(Viewer *v, bool grave, const char *format, ...) __attribute__((format(printf, 3, 4)));

/* Ends the program after this frame. */
void viewer_quit(Viewer *v);

/* Returns true if all that was requested is shown: nothing is being read, drawn or compiled. */
bool viewer_is_idle(const Viewer *v);

void viewer_set_settings(Viewer *v, const Settings *settings);

/* Makes a path the first of the recent files. */
void viewer_add_recent(Viewer *v, const char *path);

/* Returns width over height of the stage. */
float viewer_aspect(const Viewer *v);

/* Fills a texture, which it creates if it is 0, with U8 RGB or RGBA. */
void viewer_upload(unsigned *texture, const WeftImage *image);
