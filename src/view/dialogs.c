/* The dialogs: files, help, warnings, the sheet of profiles. */
#include <stdio.h>
#include <string.h>

#include "view/browser.h"
#include "view/paths.h"
#include "view/viewer.h"

static void cancel(void) {
    bool pressed = ui_button("Cancel");
    ui_tip("Closes this without doing anything (Escape).");
    if (pressed || ui_escaped()) ui_dialog_close();
}

static void use_map(Viewer *v, const char *path) {
    viewer_task(v, TASK_ASSIGN, path, v->material, v->dropped_input);
}

/* Dialogs that choose a file, and what becomes of it; some take the folder that is shown. */
static const struct {
    const char *name, *words;
    unsigned kinds;
    void (*use)(Viewer *v, const char *path);
    const char *folder, *tip; /* NULL: folders are not taken */
} choosers[] = {
    {"Open",
     "Scenes (.glb .gltf), light (.hdr .exr), materials (.json), lobes (.h), pictures (.png .jpg .tga)",
     1u << PATH_SCENE | 1u << PATH_LIGHT | 1u << PATH_MATERIAL | 1u << PATH_LOBE | 1u << PATH_PICTURE,
     viewer_open, "Use this folder as maps",
     "Puts Albedo, Normal, Roughness ... files of this folder onto the cloth of the scene."},
    {"Choose a light", "Lat-long pictures (.hdr .exr, or .png .jpg .tga); the folder of a cubemap",
     1u << PATH_LIGHT | 1u << PATH_PICTURE, viewer_light_by, "Use this folder as a cubemap",
     "Six faces by their names: px, nx ... or posx, negx ..."},
    {"Choose a map", "Pictures (.png .jpg .tga .hdr .exr)", 1u << PATH_LIGHT | 1u << PATH_PICTURE, use_map,
     NULL, NULL}};

static void draw_chooser(Viewer *v, int k) {
    if (!ui_dialog(choosers[k].name, 640.0f * ui_scale(), 460.0f * ui_scale())) return;
    ui_scope(choosers[k].name);
    ui_dim(choosers[k].words);
    const char *path = browser_draw(v->browser, choosers[k].kinds, 400.0f * ui_scale() - ui_line_height());
    if (choosers[k].folder) {
        if (ui_button(choosers[k].folder)) path = browser_folder(v->browser);
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

static void draw_save(Viewer *v) {
    if (!ui_dialog("Save the scene", 560.0f * ui_scale(), 0.0f)) return;
    ui_scope("Save the scene");
    ui_dim(".glb or .gltf: the scene as it is now, read again it gives the same picture.\n.json: the "
           "material that is edited.");
    bool entered = ui_input("file", v->save_path, STATE_PATH);
    ui_tip("Where to write; from the folder the program was started in.");
    ui_dim(path_stamp(v->save_path) ? "A file of this name is there: it will be replaced." : " ");
    bool pressed = ui_button("Save");
    ui_tip("Writes the file (Enter).");
    if (pressed || entered) {
        PathKind kind = path_kind(v->save_path);
        if (kind == PATH_SCENE || kind == PATH_MATERIAL) {
            viewer_save(v, v->save_path);
            ui_dialog_close();
        } else {
            viewer_say(v, true, "%.300s: is neither .glb, .gltf nor .json", v->save_path);
        }
    }
    ui_same_line();
    cancel();
    ui_scope_end();
    ui_dialog_end();
}

static void draw_shot(Viewer *v) {
    if (!ui_dialog("Save a picture", 560.0f * ui_scale(), 0.0f)) return;
    ui_scope("Save a picture");
    bool entered = ui_input("file", v->shot_path, STATE_PATH);
    ui_tip(".png as it is shown, .exr, .hdr or .npy linear.");
    ui_disabled(v->shot_traced);
    ui_slider_int("width", 16, 8192, &v->shot_width);
    ui_tip("Pixels; any size, whatever the window's.");
    ui_slider_int("height", 16, 8192, &v->shot_height);
    ui_tip("Pixels.");
    ui_checkbox("transparent", &v->shot_transparent);
    ui_tip("Alpha 0 where nothing is.");
    ui_disabled_end();
    ui_checkbox("path traced", &v->shot_traced);
    ui_tip("What the path tracer has gathered, in the size it is seen in.");
    v->shot_width = v->shot_width < 1 ? 1 : v->shot_width > 16384 ? 16384 : v->shot_width;
    v->shot_height = v->shot_height < 1 ? 1 : v->shot_height > 16384 ? 16384 : v->shot_height;
    ui_dim(path_stamp(v->shot_path) ? "A file of this name is there: it will be replaced." : " ");
    bool pressed = ui_button("Save");
    ui_tip("Writes the file (Enter).");
    if (pressed || entered) {
        viewer_shot(v, v->shot_path);
        ui_dialog_close();
    }
    ui_same_line();
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
    ui_dim(v->dropped);
    ui_choice("as", &inputs, &v->dropped_input);
    ui_text(v->has_scene ? v->facts.materials[v->material] : "");
    if (ui_button("Use")) {
        viewer_task(v, TASK_ASSIGN, v->dropped, v->material, v->dropped_input);
        ui_dialog_close();
    }
    ui_tip("Puts the picture in the place of this input's map.");
    ui_same_line();
    if (ui_button("As light")) {
        viewer_light_by(v, v->dropped);
        ui_dialog_close();
    }
    ui_tip("Lights the scene by it, a lat-long picture.");
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
    {"W A S D, Q E (by place: Z Q S D, A E on AZERTY)", "fly; Q and E go down and up"},
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
    if (!v->help_open) return;
    float s = ui_scale();
    if (ui_window("Keys and mouse", (UiBox){60.0f * s, 80.0f * s, 640.0f * s, 540.0f * s}, &v->help_open))
        for (size_t k = 0; k < sizeof help_lines / sizeof *help_lines; k++) {
            ui_text(help_lines[k][0]);
            ui_column(0.55f);
            ui_text(help_lines[k][1]);
        }
    ui_window_end();
}

static void draw_warnings(Viewer *v) {
    if (!v->warnings_open) return;
    float s = ui_scale();
    if (ui_window("Warnings", (UiBox){60.0f * s, 120.0f * s, 620.0f * s, 300.0f * s}, &v->warnings_open)) {
        if (v->warnings[0])
            ui_wrapped(v->warnings);
        else
            ui_dim("none");
    }
    ui_window_end();
}

static void draw_profiles(Viewer *v) {
    if (!v->profiles_open) return;
    float s = ui_scale();
    if (ui_window("All profiles", (UiBox){20.0f * s, 70.0f * s, 860.0f * s, 600.0f * s}, &v->profiles_open)) {
        ui_scope("All profiles");
        if (!v->profiles_made) ui_progress(-1.0f, "drawing the material under every profile");
        if (ui_button("Draw again")) viewer_profiles(v);
        ui_tip("Of the scene as it is now.");
        ui_same_line();
        ui_disabled(!v->profiles.pixels);
        if (ui_button("Save as profiles.png")) {
            WeftError error = {0};
            if (weft_image_write("profiles.png", &v->profiles, &error) == WEFT_OK)
                viewer_say(v, false, "wrote profiles.png");
            else
                viewer_say(v, true, "%s", error.text);
        }
        ui_tip("Into the folder the program was started in.");
        ui_disabled_end();
        if (v->profiles_texture && v->profiles_width) {
            UiBox box;
            float width = ui_room(), height = width * (float)v->profiles_height / (float)v->profiles_width;
            ui_canvas("##sheet", width, height, &box);
            ui_picture(v->profiles_texture, box, false);
        }
        ui_scope_end();
    }
    ui_window_end();
}

void dialogs_draw(Viewer *v) {
    if (v->open_dialog[0]) ui_dialog_open(v->open_dialog);
    v->open_dialog[0] = '\0';
    for (int k = 0; k < (int)(sizeof choosers / sizeof *choosers); k++) draw_chooser(v, k);
    draw_save(v);
    draw_shot(v);
    draw_use(v);
    draw_help(v);
    draw_warnings(v);
    draw_profiles(v);
}
