/* Keyboard shortcuts, by the letters on the keys, so that a shortcut is where its letter is. */
#include <stdio.h>
#include <string.h>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include "view/viewer.h"

static void with_control(Viewer *v, const UiPress *p) {
    switch (p->letter) {
    case 'z': p->shift ? viewer_redo(v) : viewer_undo(v); break;
    case 'y': viewer_redo(v); break;
    case 'o': viewer_dialog(v, "Open"); break;
    case 's': viewer_save(v, NULL); break;
    case 'c': p->shift ? viewer_copy_command(v) : viewer_copy_material(v); break;
    case 'v': viewer_paste_material(v); break;
    case 'q': v->ending = true; break;
    default: break;
    }
}

static void plain(Viewer *v, const UiPress *p) {
    switch (p->letter) {
    case 'f': viewer_frame_selection(v); break;
    case 'c': viewer_split(v, v->split == SPLIT_NONE ? SPLIT_LINE : SPLIT_NONE); break;
    case 'x': viewer_swap(v); break;
    case 'p':
        v->tool = v->tool == TOOL_PROBE ? TOOL_ORBIT : TOOL_PROBE;
        if (v->tool == TOOL_PROBE) v->panel = PANEL_INSPECT;
        break;
    case 'g': v->floor.on = !v->floor.on; break;
    case 'h': v->hide_lights = !v->hide_lights; break;
    case 'm': viewer_next_material(v, p->shift ? -1 : 1); break;
    case 'b': v->tool = v->tool == TOOL_BRUSH ? TOOL_ORBIT : TOOL_BRUSH; break;
    default: break;
    }
    if (p->key >= '1' && p->key <= '9') v->part = (WeftPart)(p->key - '1');
}

static void named(Viewer *v, const UiPress *p) {
    switch (p->key) {
    case GLFW_KEY_TAB: viewer_mode(v, p->shift ? MODE_DIFFERENCE : MODE_REFERENCE); break;
    case GLFW_KEY_HOME: viewer_reset_camera(v); break;
    case GLFW_KEY_F1: v->help_open = !v->help_open; break;
    case GLFW_KEY_F6: ui_go_to_next_panel(); break;
    case GLFW_KEY_F10: ui_go_to_menus(); break;
    case GLFW_KEY_F8: v->warnings_open = !v->warnings_open; break;
    case GLFW_KEY_F12: viewer_shot(v, NULL); break;
    case GLFW_KEY_ESCAPE:
        v->tool = TOOL_ORBIT;
        v->help_open = v->warnings_open = false;
        v->mode = MODE_LIVE;
        break;
    default: break;
    }
}

/* '?' is asked for as it is typed: it lies elsewhere on every keyboard. */
static void typed(Viewer *v) {
    for (int k = 0; k < v->input.typed_count; k++)
        if (v->input.typed[k] == '?') v->help_open = !v->help_open;
}

void keys_input(Viewer *v) {
    if (ui_types()) return;
    typed(v);
    for (int k = 0; k < v->input.pressed_count; k++) {
        const UiPress *p = &v->input.pressed[k];
        if (p->again || ui_wants_keys()) continue;
        if (p->control)
            with_control(v, p);
        else if (!p->alt) {
            plain(v, p);
            named(v, p);
        }
    }
}
