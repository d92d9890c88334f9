#include "view/state/dialogs.h"

#include <stdio.h>
#include <string.h>

#include <epoxy/gl.h>

#include "base/path.h"
#include "view/files/paths.h"
#include "view/state/actions.h"
#include "view/state/bakings.h"
#include "view/state/states.h"
#include "view/state/stills.h"
#include "view/ui/browser.h"

bool dialogs_begin(Viewer *v) {
    v->states->dialogs.browser = browser_create(v->frame->settings.folder);
    return v->states->dialogs.browser != NULL;
}

void dialogs_end(Viewer *v) {
    DialogsState *dialogs = &v->states->dialogs;
    if (dialogs->browser) {
        Settings settings = v->frame->settings;
        snprintf(settings.folder, sizeof settings.folder, "%s", browser_folder(dialogs->browser));
        viewer_set_settings(v, &settings);
    }
    browser_free(dialogs->browser);
    if (v->window) glDeleteTextures(1, &dialogs->profiles_texture);
    weft_image_free(&dialogs->profiles);
}

void dialogs_toggle_help(Viewer *v) { v->states->dialogs.help = !v->states->dialogs.help; }
void dialogs_toggle_warnings(Viewer *v) { v->states->dialogs.warnings_shown = !v->states->dialogs.warnings_shown; }
void dialogs_close_windows(Viewer *v) {
    DialogsState *dialogs = &v->states->dialogs;
    dialogs->help = dialogs->warnings_shown = dialogs->unsaid_shown = false;
}

void dialogs_show_unsaid(Viewer *v, const char *unsaid) {
    DialogsState *dialogs = &v->states->dialogs;
    snprintf(dialogs->unsaid, sizeof dialogs->unsaid, "%s", unsaid);
    dialogs->unsaid_shown = unsaid[0] != '\0';
}

void dialogs_forget_paths(Viewer *v) { v->states->dialogs.save_path[0] = v->states->dialogs.shot_path[0] = '\0'; }

void dialogs_choose_use(Viewer *v, const char *path, int input) {
    snprintf(v->states->dialogs.dropped, sizeof v->states->dialogs.dropped, "%s", path);
    v->states->dialogs.dropped_input = input;
    dialogs_open(v, "Use a picture");
}

void dialogs_choose_map(Viewer *v, int input) {
    v->states->dialogs.dropped_input = input;
    dialogs_open(v, "Choose a map");
}

void dialogs_take_profiles(Viewer *v, WeftImage *sheet) {
    DialogsState *dialogs = &v->states->dialogs;
    dialogs->profiles_made = sheet != NULL;
    if (!sheet) return;
    viewer_upload(&dialogs->profiles_texture, sheet);
    weft_image_free(&dialogs->profiles);
    dialogs->profiles = *sheet;
    *sheet = (WeftImage){0};
}

static void offer_path(Viewer *v, char *path, const char *suffix) {
    if (path[0]) return;
    char stem[200];
    path_stem(v->shown->facts.path, stem, sizeof stem);
    snprintf(path, STATE_PATH, "%s%s", stem, suffix);
}

/* Chooses a picture of the stage's size, of what it shows. */
static void take_stage(Viewer *v) {
    DialogsState *dialogs = &v->states->dialogs;
    dialogs->shot.width = (int)v->frame->stage.width, dialogs->shot.height = (int)v->frame->stage.height;
    dialogs->shot.floor = v->options->floor.on != 0;
    dialogs->shot_traced = v->options->mode == MODE_REFERENCE;
}

void dialogs_shot(Viewer *v, const char *path) {
    if (!path) {
        offer_path(v, v->states->dialogs.shot_path, "-weft.png");
        take_stage(v);
        dialogs_open(v, "Save a picture");
        return;
    }
    Task task = {.kind = TASK_SHOT,
                 .scene = v->shown->number,
                 .width = v->states->dialogs.shot.width,
                 .height = v->states->dialogs.shot.height,
                 .transparent = v->states->dialogs.shot.transparent,
                 .floor = v->states->dialogs.shot.floor,
                 .reference = v->states->dialogs.shot_traced};
    snprintf(task.path, sizeof task.path, "%s", path);
    if (!weft_image_suffix_known(path))
        viewer_report(v, true, "%.300s: %s", path, weft_message_text(WEFT_MESSAGE_OUTPUT_SUFFIX));
    else
        renderer_add_task(v->renderer, &task);
}

void dialogs_save(Viewer *v, const char *path) {
    if (!v->shown->any) return;
    if (!path) {
        offer_path(v, v->states->dialogs.save_path, "-weft.glb");
        dialogs_open(v, "Save the scene");
        return;
    }
    actions_send(v, TASK_SAVE, path, v->edit->material, -1);
}

void dialogs_show_profiles(Viewer *v) {
    v->states->dialogs.profiles_open = true;
    v->states->dialogs.profiles_made = false;
    actions_send(v, TASK_PROFILES, NULL, v->edit->material, -1);
}

void dialogs_open(Viewer *v, const char *name) {
    DialogsState *dialogs = &v->states->dialogs;
    places_read(&dialogs->places, v->shown->any ? v->shown->facts.path : NULL, &v->frame->settings);
    browser_refresh(dialogs->browser, &dialogs->places);
    dialogs->asked[0] = '\0';
    leaving_stop_waiting(v);
    snprintf(v->states->dialogs.due, sizeof v->states->dialogs.due, "%s", name);
}

void dialogs_shot_stage(Viewer *v, const char *path) {
    take_stage(v);
    dialogs_shot(v, path);
}

/* Draws the button that closes a dialog; returns true if it was closed by it. */
static bool cancel(void) {
    bool pressed = ui_button("Cancel");
    ui_tip("Closes this without doing anything (Escape).");
    if (!pressed && !ui_escaped()) return false;
    ui_dialog_close();
    return true;
}

static void use_map(Viewer *v, const char *path) {
    actions_send(v, TASK_ASSIGN, path, v->edit->material, v->states->dialogs.dropped_input);
}

/* Dialogs that choose a file, and what becomes of it; some take the folder that is shown. */
static const struct {
    const char *name, *words;
    unsigned kinds;
    void (*use)(Viewer *v, const char *path);
    const char *folder, *tip; /* NULL: folders are not taken */
} choosers[] = {{"Open",
                 "Scenes (.glb .gltf), light (.hdr .exr), materials (.json), drafts (.wif .dtx), lobes (.h), pictures",
                 1u << PATH_DRAFT | 1u << PATH_SCENE | 1u << PATH_LIGHT | 1u << PATH_MATERIAL | 1u << PATH_LOBE |
                     1u << PATH_PICTURE,
                 opening_ask, "Use this folder as maps",
                 "Puts Albedo, Normal, Roughness ... files of this folder onto the cloth of the scene."},
                {"Choose a light", "Lat-long pictures (.hdr .exr, or .png .jpg .tga); a cube map: a folder or one face",
                 1u << PATH_LIGHT | 1u << PATH_PICTURE, actions_light_by, "Use this folder as a cubemap",
                 "Six faces by their names: posx, negx ... or px, nx ..."},
                {"Choose a draft", "Drafts (.wif .dtx); pictures (.png .jpg .tga), a pixel a crossing",
                 1u << PATH_DRAFT | 1u << PATH_PICTURE, actions_weave_file, NULL, NULL},
                {"Choose a photograph", "Pictures (.png .jpg .tga .hdr .exr), to compare with",
                 1u << PATH_LIGHT | 1u << PATH_PICTURE, photographs_open, NULL, NULL},
                {"Choose a map", "Pictures (.png .jpg .tga .hdr .exr)", 1u << PATH_LIGHT | 1u << PATH_PICTURE, use_map,
                 NULL, NULL}};

static void draw_chooser(Viewer *v, int k) {
    Browser *browser = v->states->dialogs.browser;
    if (!ui_dialog(choosers[k].name, 720.0f * ui_scale(), 480.0f * ui_scale())) return;
    ui_scope(choosers[k].name);
    ui_dim(choosers[k].words);
    const char *path = browser_draw(browser, choosers[k].kinds, ui_height_left() - ui_line_height());
    if (ui_button("Open")) path = browser_open(browser);
    ui_tip("Opens what is chosen above, as a double click does.");
    ui_same_line();
    if (choosers[k].folder) {
        if (ui_button(choosers[k].folder)) path = browser_folder(browser);
        ui_tip(choosers[k].tip);
        ui_same_line();
    }
    if (path) {
        choosers[k].use(v, path);
        ui_dialog_close();
    }
    cancel();
    ui_scope_end();
    ui_dialog_end();
}

/* Draws the button that saves; it asks first if a file would be replaced. Returns true if the file is to be written:
 * `path` is then its path. entered: Enter was pressed in the name. */
static bool draw_save_button(Viewer *v, const char *name, bool entered, char path[STATE_PATH]) {
    DialogsState *dialogs = &v->states->dialogs;
    const bool fits = browser_place(dialogs->browser, name, path, STATE_PATH), there = fits && path_stamp(path);
    bool asks = there && strcmp(dialogs->asked, path) == 0;
    if (asks)
        ui_warning("A file of this name is there. Replace it?");
    else
        ui_dim(there ? "A file of this name is there." : " ");
    const bool pressed = ui_button(asks ? "Replace###Save" : "Save###Save") || entered;
    ui_tip("Writes the file (Enter); asks before it replaces one.");
    ui_same_line();
    if (!pressed || !fits) return false;
    if (there && !asks) snprintf(dialogs->asked, sizeof dialogs->asked, "%s", path);
    return !there || asks;
}

static void draw_save(Viewer *v) {
    DialogsState *dialogs = &v->states->dialogs;
    char path[STATE_PATH];
    if (!ui_dialog("Save the scene", 640.0f * ui_scale(), 460.0f * ui_scale())) return;
    ui_scope("Save the scene");
    ui_dim(
        ".glb or .gltf: the scene as it is now; reading the file gives the same picture. .json: the material that is "
        "edited.");
    const bool woven = bakings_possible(v);
    browser_draw_saving(dialogs->browser, 1u << PATH_SCENE | 1u << PATH_MATERIAL,
                        ui_height_left() - (woven ? 4.4f : 3.2f) * ui_line_height(), dialogs->save_path,
                        sizeof dialogs->save_path);
    bool entered = ui_input_path("file", dialogs->save_path, STATE_PATH);
    ui_tip("The name of the file, in the folder above, or a path.");
    if (woven) {
        ui_checkbox("bake into the file", &dialogs->bakes);
        ui_tip(
            "For other viewers, which know no threads: they get textures that are fitted to the cloth. The file is an "
            "export: it has no weave to go on with.");
    }
    if (draw_save_button(v, dialogs->save_path, entered, path)) {
        PathKind kind = path_kind(path);
        if (kind == PATH_SCENE && woven && dialogs->bakes) {
            bakings_save(v, path);
            leaving_cancel(v);
            ui_dialog_close();
        } else if (kind == PATH_SCENE || kind == PATH_MATERIAL) {
            if (v->shown->any) actions_send(v, TASK_SAVE, path, v->edit->material, -1);
            ui_dialog_close();
        } else {
            viewer_report(v, true, "%.300s: is neither .glb, .gltf nor .json", path);
        }
    }
    if (cancel()) leaving_cancel(v);
    ui_scope_end();
    ui_dialog_end();
}

static int within(int value, int low, int high) { return value < low ? low : value > high ? high : value; }

/* Draws what only path-traced pictures have. */
static void draw_samples(DialogsState *dialogs) {
    static const UiRange noise = {1e-3f, 1e-1f, 3e-3f, NULL, true};
    StillChoice *shot = &dialogs->shot;
    if (shot->samples < 1) shot->samples = 256, shot->noise = noise.initial;
    ui_disabled(!dialogs->shot_traced);
    ui_slider_int("samples", 1, 4096, &shot->samples);
    ui_tip("Per pixel, at most: four times as many halve the noise.");
    ui_checkbox("stop at a noise level", &dialogs->shot_to_noise);
    ui_tip("Ends before the samples are taken, as soon as the picture is good enough.");
    ui_disabled(!dialogs->shot_to_noise);
    ui_slider("noise level", &noise, &shot->noise);
    ui_tip(
        "The picture's relMSE, estimated from two halves of its samples: 0.001 is clean to the eye, smaller ones can "
        "be typed.");
    ui_disabled_end();
    ui_checkbox("denoised", &shot->denoised);
    ui_tip("Smooths what noise is left; threads are kept. The file is marked: .png or .exr.");
    ui_checkbox("layers", &shot->layered);
    ui_tip("An .exr then has colour, normal, depth, position, the light of each lobe, and mattes of objects and "
           "materials.");
    ui_slider_int("turntable", 0, 120, &shot->around);
    ui_tip("So many pictures on a circle about the scene, each with a number before its suffix; 0: one picture of this "
           "view.");
    ui_disabled_end();
    shot->samples = within(shot->samples, 1, 65536);
    shot->around = within(shot->around, 0, 10000);
    if (!(shot->noise >= 1e-9f)) shot->noise = 1e-9f;
}

static void save_shot(Viewer *v, const char *path) {
    const DialogsState *dialogs = &v->states->dialogs;
    StillChoice choice = dialogs->shot;
    if (!dialogs->shot_to_noise) choice.noise = 0.0f;
    if (dialogs->shot_traced)
        stills_make(v, path, &choice);
    else
        dialogs_shot(v, path);
}

/* Draws the folder that pictures go to; it can be unfolded to go to another. */
static void draw_folder(DialogsState *dialogs) {
    char text[1100];
    snprintf(text, sizeof text, "in %.1000s###folder", browser_folder(dialogs->browser));
    if (!ui_fold(text)) return;
    browser_draw_saving(dialogs->browser, 1u << PATH_LIGHT | 1u << PATH_PICTURE, 220.0f * ui_scale(),
                        dialogs->shot_path, sizeof dialogs->shot_path);
}

/* Returns the name of the first file that would be replaced, or else of the first that will be written. */
static const char *first_file(const DialogsState *dialogs, char name[STATE_PATH]) {
    char number[PATH_NUMBER], path[STATE_PATH];
    const int around = dialogs->shot_traced ? dialogs->shot.around : 0;
    bool fits = around > 0;
    for (int k = 0; fits && k < around; k++) {
        fits = path_numbered(dialogs->shot_path, path_number(k, around, number), name, STATE_PATH);
        if (fits && browser_place(dialogs->browser, name, path, STATE_PATH) && path_stamp(path)) return name;
    }
    return fits && path_numbered(dialogs->shot_path, path_number(0, around, number), name, STATE_PATH)
               ? name
               : dialogs->shot_path;
}

static void draw_shot(Viewer *v) {
    DialogsState *dialogs = &v->states->dialogs;
    char path[STATE_PATH], first[STATE_PATH];
    if (!ui_dialog("Save a picture", 560.0f * ui_scale(), 0.0f)) return;
    ui_scope("Save a picture");
    bool entered = ui_input_path("file", dialogs->shot_path, STATE_PATH);
    ui_tip(".png as it is shown, .exr, .hdr or .npy linear.");
    draw_folder(dialogs);
    ui_slider_int("width", 16, 8192, &dialogs->shot.width);
    ui_tip("Pixels; any size, whatever the window's.");
    ui_slider_int("height", 16, 8192, &dialogs->shot.height);
    ui_tip("Pixels.");
    ui_checkbox("transparent", &dialogs->shot.transparent);
    ui_tip("Alpha 0 where nothing is; a floor leaves its shadow.");
    ui_checkbox("floor", &dialogs->shot.floor);
    ui_tip("A floor that catches the shadow of the scene.");
    ui_checkbox("path traced", &dialogs->shot_traced);
    ui_tip("Ground truth, made in the background while you work on; the status bar shows how far it is.");
    draw_samples(dialogs);
    dialogs->shot.width = within(dialogs->shot.width, 1, 16384);
    dialogs->shot.height = within(dialogs->shot.height, 1, 16384);
    if (draw_save_button(v, first_file(dialogs, first), entered, path) &&
        browser_place(dialogs->browser, dialogs->shot_path, path, STATE_PATH)) {
        save_shot(v, path);
        ui_dialog_close();
    }
    cancel();
    ui_scope_end();
    ui_dialog_end();
}

static const char *input_name(const void *user, int k) { return weft_material_input_name(k); }
static const char *input_help(const void *user, int k) { return weft_material_input_help(k); }

static void draw_use(Viewer *v) {
    if (!ui_dialog("Use a picture", 460.0f * ui_scale(), 0.0f)) return;
    int count = 0;
    while (weft_material_input_name(count)) count++;
    const UiChoices inputs = {count, input_name, input_help, NULL};
    ui_scope("Use a picture");
    ui_dim(v->states->dialogs.dropped);
    ui_choice("as", &inputs, &v->states->dialogs.dropped_input);
    ui_text(v->shown->any ? v->shown->facts.materials[v->edit->material] : "");
    if (ui_button("Use")) {
        actions_send(v, TASK_ASSIGN, v->states->dialogs.dropped, v->edit->material, v->states->dialogs.dropped_input);
        ui_dialog_close();
    }
    ui_tip("Puts the picture in the place of this input's map.");
    ui_same_line();
    if (ui_button("As light")) {
        actions_light_by(v, v->states->dialogs.dropped);
        ui_dialog_close();
    }
    ui_tip("Lights the scene by it: a lat-long picture, or one of the six faces of a cube map (posx, negx ...).");
    ui_same_line();
    if (ui_button("As photograph")) {
        photographs_open(v, v->states->dialogs.dropped);
        ui_dialog_close();
    }
    ui_tip("Shows it beside the picture, to compare with.");
    ui_same_line();
    cancel();
    ui_scope_end();
    ui_dialog_end();
}

static const char *const help_lines[][2] = {
    {"Left drag", "orbit"},
    {"Middle drag, Shift + left drag", "pan"},
    {"Wheel", "nearer, farther"},
    {"Right drag", "look around"},
    {"Ctrl + left drag", "turn the environment"},
    {"Click", "choose the material that is there"},
    {"W A S D, Q E by their places (AZERTY: Z Q S D, A E)", "fly; Q and E go down and up"},
    {"Shift", "flies four times as fast"},
    {"F, Home", "frame all; the first camera"},
    {"F6, F10", "next panel, menus: then arrows, Space, Enter; Escape ends"},
    {"M, Shift + M", "next material, the one before"},
    {"G, H", "floor; hide polygon lights"},
    {"Tab, Shift + Tab", "path traced and back; difference"},
    {"C, X", "A | B; edit the other"},
    {"1 ... 9", "all, diffuse, specular, sheen ... roughness"},
    {"P, B", "probe; brush of the nap"},
    {"Ctrl + Z, Ctrl + Shift + Z", "undo, redo"},
    {"Ctrl + C, Ctrl + V", "copy and paste a material"},
    {"Ctrl + Shift + C", "copy the command line that draws this"},
    {"Ctrl + O, Ctrl + S, F12", "open, save, picture"},
    {"Ctrl + click, double click on a slider", "type a value, also beyond its range; reset"},
    {"F8", "warnings"},
    {"?, F1", "this"},
};

static void draw_help(Viewer *v) {
    if (!v->states->dialogs.help) return;
    float s = ui_scale();
    if (ui_window("Keys and mouse", (UiBox){60.0f * s, 60.0f * s, 800.0f * s, 560.0f * s}, &v->states->dialogs.help))
        for (size_t k = 0; k < sizeof help_lines / sizeof *help_lines; k++) {
            ui_text(help_lines[k][0]);
            ui_column(0.5f);
            ui_wrapped(help_lines[k][1]);
        }
    ui_window_end();
}

static void draw_warnings(Viewer *v) {
    if (!v->states->dialogs.warnings_shown) return;
    float s = ui_scale();
    if (ui_window("Warnings", (UiBox){60.0f * s, 120.0f * s, 620.0f * s, 300.0f * s},
                  &v->states->dialogs.warnings_shown)) {
        if (v->shown->warnings[0])
            ui_wrapped(v->shown->warnings);
        else
            ui_dim("none");
    }
    ui_window_end();
}

static void draw_unsaid(Viewer *v) {
    DialogsState *dialogs = &v->states->dialogs;
    const float s = ui_scale();
    if (!dialogs->unsaid_shown) return;
    if (ui_window("Not in the command line", (UiBox){60.0f * s, 140.0f * s, 520.0f * s, 240.0f * s},
                  &dialogs->unsaid_shown)) {
        ui_scope("Not in the command line");
        ui_wrapped("The line that was copied draws the picture but for:");
        ui_warning(dialogs->unsaid);
        if (ui_button("Save the scene ...")) dialogs_save(v, NULL);
        ui_tip("A saved .glb or .gltf has maps, naps and weaves: weft render draws it as it is.");
        ui_scope_end();
    }
    ui_window_end();
}

static void draw_profiles(Viewer *v) {
    if (!v->states->dialogs.profiles_open) return;
    float s = ui_scale();
    if (ui_window("All profiles", (UiBox){20.0f * s, 70.0f * s, 860.0f * s, 600.0f * s},
                  &v->states->dialogs.profiles_open)) {
        ui_scope("All profiles");
        if (!v->states->dialogs.profiles_made) ui_progress(-1.0f, "drawing the material under every profile");
        if (ui_button("Draw again")) dialogs_show_profiles(v);
        ui_tip("Of the scene as it is now.");
        ui_same_line();
        ui_disabled(!v->states->dialogs.profiles.pixels);
        if (ui_button("Save as profiles.png")) {
            WeftError error = {0};
            if (weft_image_write("profiles.png", &v->states->dialogs.profiles, &error) == WEFT_OK)
                viewer_report(v, false, "wrote profiles.png");
            else
                viewer_report(v, true, "%s", error.text);
        }
        ui_tip("Into the folder the program was started in.");
        ui_disabled_end();
        if (v->states->dialogs.profiles_texture && v->states->dialogs.profiles.width) {
            UiBox box;
            float width = ui_width_left(),
                  height = width * (float)v->states->dialogs.profiles.height / (float)v->states->dialogs.profiles.width;
            ui_canvas("##sheet", width, height, &box);
            ui_picture(v->states->dialogs.profiles_texture, box, false);
        }
        ui_scope_end();
    }
    ui_window_end();
}

void dialogs_draw(Viewer *v) {
    if (v->states->dialogs.due[0]) ui_dialog_open(v->states->dialogs.due);
    v->states->dialogs.due[0] = '\0';
    for (int k = 0; k < (int)(sizeof choosers / sizeof *choosers); k++) draw_chooser(v, k);
    draw_save(v);
    draw_shot(v);
    draw_use(v);
    leaving_draw(v);
    draw_help(v);
    draw_warnings(v);
    draw_unsaid(v);
    draw_profiles(v);
}
