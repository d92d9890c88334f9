/* Keyboard shortcuts, by the letters on the keys, so that a shortcut is where its letter is. */
#include <stdio.h>
#include <string.h>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include "view/state/viewer.h"

static void with_control(Viewer *v, const UiPress *p) {
    switch (p->letter) {
    case 'z': p->shift ? viewer_redo(v) : viewer_undo(v); break;
    case 'y': viewer_redo(v); break;
    case 'o': viewer_dialog(v, "Open"); break;
    case 's': viewer_save(v, NULL); break;
    case 'c': p->shift ? viewer_copy_command(v) : viewer_copy_material(v); break;
    case 'v': viewer_paste_material(v); break;
    case 'q': viewer_quit(v); break;
    default: break;
    }
}

static void plain(Viewer *v, const UiPress *p) {
    switch (p->letter) {
    case 'f': viewer_frame_selection(v); break;
    case 'c': viewer_split(v, v->edit->split == SPLIT_NONE ? SPLIT_LINE : SPLIT_NONE); break;
    case 'x': viewer_swap(v); break;
    case 'p': viewer_tool(v, v->options->tool == TOOL_PROBE ? TOOL_ORBIT : TOOL_PROBE); break;
    case 'g': viewer_toggle_floor(v); break;
    case 'h': viewer_toggle_lights(v); break;
    case 'm': viewer_next_material(v, p->shift ? -1 : 1); break;
    case 'b': viewer_tool(v, v->options->tool == TOOL_BRUSH ? TOOL_ORBIT : TOOL_BRUSH); break;
    default: break;
    }
    if (p->key >= '1' && p->key <= '9') viewer_part(v, (WeftPart)(p->key - '1'));
}

static void named(Viewer *v, const UiPress *p) {
    switch (p->key) {
    case GLFW_KEY_TAB: viewer_mode(v, p->shift ? MODE_DIFFERENCE : MODE_REFERENCE); break;
    case GLFW_KEY_HOME: viewer_reset_camera(v); break;
    case GLFW_KEY_F1: dialogs_toggle_help(v); break;
    case GLFW_KEY_F6: ui_go_to_next_panel(); break;
    case GLFW_KEY_F10: ui_go_to_menus(); break;
    case GLFW_KEY_F8: dialogs_toggle_warnings(v); break;
    case GLFW_KEY_F12: viewer_shot(v, NULL); break;
    case GLFW_KEY_ESCAPE:
        viewer_tool(v, TOOL_ORBIT);
        dialogs_close_windows(v);
        viewer_show_mode(v, MODE_LIVE);
        break;
    default: break;
    }
}

/* Toggles the help when a '?' is typed; which key that is depends on the keyboard. */
static void typed(Viewer *v) {
    for (int k = 0; k < v->frame->input.typed_count; k++)
        if (v->frame->input.typed[k] == '?') dialogs_toggle_help(v);
}

void keys_input(Viewer *v) {
    if (ui_types()) return;
    typed(v);
    for (int k = 0; k < v->frame->input.pressed_count; k++) {
        const UiPress *p = &v->frame->input.pressed[k];
        if (p->again || ui_wants_keys()) continue;
        if (p->control)
            with_control(v, p);
        else if (!p->alt) {
            plain(v, p);
            named(v, p);
        }
    }
}
