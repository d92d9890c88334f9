#include "view/state/leaving.h"

#include <stdio.h>
#include <string.h>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include "view/files/paths.h"
#include "view/state/states.h"

static const char dialog[] = "Unsaved changes";

static void leave(Viewer *v) {
    const LeavingState now = v->states->leaving;
    leaving_cancel(v);
    if (now.what == LEAVING_WINDOW) viewer_quit(v);
    if (now.what == LEAVING_SCENE) opening_open(v, now.path);
}

void leaving_cancel(Viewer *v) { v->states->leaving = (LeavingState){0}; }

void leaving_stop_waiting(Viewer *v) { v->states->leaving.saves = false; }

void leaving_quit(Viewer *v) {
    if (!edit_is_unsaved(v) && !stills_busy(v) && !bakings_busy(v)) {
        viewer_quit(v);
        return;
    }
    v->states->leaving = (LeavingState){.what = LEAVING_WINDOW};
    dialogs_open(v, dialog);
}

bool leaving_asks(Viewer *v, const char *path) {
    if (!edit_is_unsaved(v) || strlen(path) >= sizeof v->states->leaving.path) return false;
    v->states->leaving = (LeavingState){.what = LEAVING_SCENE};
    memcpy(v->states->leaving.path, path, strlen(path));
    dialogs_open(v, dialog);
    return true;
}

void leaving_saved(Viewer *v, bool failed) {
    if (!v->states->leaving.saves) return;
    v->states->leaving.saves = false;
    if (failed)
        leaving_cancel(v);
    else if (edit_is_unsaved(v))
        dialogs_open(v, dialog);
    else
        leave(v);
}

/* Returns what differs from what was saved, in words. */
static void say_changes(const Viewer *v, char *text, size_t size) {
    const SceneState *is = &v->edit->state, *was = &v->edit->saved;
    int count = 0, named = 0;
    for (int k = 0; k < is->material_count && k < was->material_count; k++)
        if (!scene_state_same_material(is, was, k) || scene_state_nap(is, k) != scene_state_nap(was, k))
            count++, named = k;
    if (count == 1)
        snprintf(text, size, "the material %s", v->shown->facts.materials[named]);
    else if (count)
        snprintf(text, size, "%d materials", count);
    else
        snprintf(text, size, "lights, environment or variant");
}

static bool struck(const Viewer *v, int key, char letter) {
    for (int k = 0; k < v->frame->input.pressed_count; k++) {
        const UiPress *p = &v->frame->input.pressed[k];
        if (!p->repeats && !p->control && !p->alt && (letter ? p->letter == letter : p->key == key)) return true;
    }
    return false;
}

static void draw_text(const Viewer *v) {
    char text[512], changed[160];
    say_changes(v, changed, sizeof changed);
    if (edit_is_unsaved(v)) {
        snprintf(text, sizeof text, "%.200s has changes that are not saved: %s.", path_name(v->shown->facts.path),
                 changed);
        ui_wrapped(text);
    }
    if (stills_busy(v) && v->leaving->what == LEAVING_WINDOW) {
        snprintf(text, sizeof text, "A path-traced picture is being made, %.0f %% of it so far; it would be lost.",
                 100.0 * v->stills->share);
        ui_wrapped(text);
    }
    if (bakings_busy(v) && v->leaving->what == LEAVING_WINDOW) {
        snprintf(text, sizeof text, "%.200s is being baked; it would not be written.", path_name(v->bakings->path));
        ui_wrapped(text);
    }
    ui_dim(" ");
}

void leaving_draw(Viewer *v) {
    if (!ui_dialog(dialog, 480.0f * ui_scale(), 0.0f)) return;
    ui_scope(dialog);
    draw_text(v);
    ui_disabled(!edit_is_unsaved(v));
    const bool save = ui_button("Save ...") || struck(v, GLFW_KEY_ENTER, 0);
    ui_tip("Asks where to, and goes on then (Enter).");
    ui_disabled_end();
    ui_same_line();
    const bool discard = ui_button("Discard") || struck(v, 0, 'd');
    ui_tip("Goes on; the changes are lost (D).");
    ui_same_line();
    const bool cancel = ui_button("Cancel") || ui_escaped();
    ui_tip("Stays here (Escape).");
    if (save || discard || cancel) ui_dialog_close();
    ui_scope_end();
    ui_dialog_end();
    if (cancel) {
        leaving_cancel(v);
    } else if (discard) {
        leave(v);
    } else if (save && edit_is_unsaved(v)) {
        dialogs_save(v, NULL);
        v->states->leaving.saves = true;
    }
}
