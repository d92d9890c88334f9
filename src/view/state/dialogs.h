/* dialogs.h - dialogs, and what is entered in them */
#pragma once

#include "view/files/places.h"
#include "view/render/still.h"
#include "view/state/viewer.h"

typedef struct DialogsState {
    struct Browser *browser;
    FilePlaces places;      /* the places of the browser */
    char asked[STATE_PATH]; /* file that the dialog has asked whether to replace; "": none */
    bool help, warnings_shown, unsaid_shown;
    char unsaid[4096]; /* what the copied command line cannot say, a line each */
    char due[32];      /* dialog to open in this frame */
    char save_path[STATE_PATH], shot_path[STATE_PATH];
    bool bakes;       /* a scene is saved with its weaves baked to textures */
    StillChoice shot; /* samples 0: not yet chosen */
    bool shot_traced;
    bool shot_to_noise;       /* stops at the noise level of the choice */
    char dropped[STATE_PATH]; /* a picture whose input is still to be chosen */
    int dropped_input;
    bool profiles_open, profiles_made;
    WeftImage profiles; /* sheet of all profiles */
    unsigned profiles_texture;
} DialogsState;

bool dialogs_begin(Viewer *v);

/* Releases the dialogs; the browser's folder goes to the settings. */
void dialogs_end(Viewer *v);
void dialogs_draw(Viewer *v);

/* Opens the dialog of that name in this frame. */
void dialogs_open(Viewer *v, const char *name);
/* Opens a window with what the copied command line cannot say, each a line; "" closes it. */
void dialogs_show_unsaid(Viewer *v, const char *unsaid);
void dialogs_toggle_help(Viewer *v);
void dialogs_toggle_warnings(Viewer *v);
void dialogs_close_windows(Viewer *v);
void dialogs_forget_paths(Viewer *v);

/* Opens the dialog that asks what a picture is for; input is the one proposed. */
void dialogs_choose_use(Viewer *v, const char *path, int input);
void dialogs_choose_map(Viewer *v, int input);

/* Saves a picture, or the scene; a path of NULL opens the dialog. */
void dialogs_shot(Viewer *v, const char *path);
void dialogs_save(Viewer *v, const char *path);

/* Saves a picture of the stage's size, path traced if that is shown. */
void dialogs_shot_stage(Viewer *v, const char *path);

/* Draws the sheet of all profiles and opens its window. */
void dialogs_show_profiles(Viewer *v);

/* Takes over the sheet of profiles; NULL: the current one is out of date. */
void dialogs_take_profiles(Viewer *v, WeftImage *sheet);
