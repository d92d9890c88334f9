/* Keyboard shortcuts, by the letter on a key and not by its position. */
#include <stdio.h>
#include <string.h>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include "view/panels/panels.h"
#include "view/panels/render_command.h"
#include "view/state/dialogs.h"
#include "view/state/edit.h"
#include "view/state/leaving.h"
#include "view/state/view_camera.h"
#include "view/state/view_options.h"

static void with_control(Viewer *v, const UiPress *p) {
    switch (p->letter) {
    case 'z': p->shift ? edit_redo(v) : edit_undo(v); break;
    case 'y': edit_redo(v); break;
    case 'o': dialogs_open(v, "Open"); break;
    case 's': dialogs_save(v, NULL); break;
    case 'c': p->shift ? command_copy(v) : edit_copy_material(v); break;
    case 'v': edit_paste_material(v); break;
    case 'q': leaving_quit(v); break;
    default: break;
    }
}

static void without_control(Viewer *v, const UiPress *p) {
    switch (p->letter) {
    case 'f': camera_frame_all(v); break;
    case 'c': edit_set_split(v, v->edit->split == SPLIT_NONE ? SPLIT_LINE : SPLIT_NONE); break;
    case 'x': edit_swap_sides(v); break;
    case 'p': options_set_tool(v, v->options->tool == TOOL_PROBE ? TOOL_ORBIT : TOOL_PROBE); break;
    case 'g': options_toggle_floor(v); break;
    case 'h': options_toggle_lights(v); break;
    case 'm': edit_next_material(v, p->shift ? -1 : 1); break;
    case 'b': options_set_tool(v, v->options->tool == TOOL_BRUSH ? TOOL_ORBIT : TOOL_BRUSH); break;
    default: break;
    }
    if (p->key >= '1' && p->key <= '9') options_set_part(v, (WeftPart)(p->key - '1'));
}

static void named(Viewer *v, const UiPress *p) {
    switch (p->key) {
    case GLFW_KEY_TAB: options_toggle_mode(v, p->shift ? MODE_DIFFERENCE : MODE_REFERENCE); break;
    case GLFW_KEY_HOME: camera_reset(v); break;
    case GLFW_KEY_F1: dialogs_toggle_help(v); break;
    case GLFW_KEY_F6: ui_go_to_next_panel(); break;
    case GLFW_KEY_F10: ui_go_to_menus(); break;
    case GLFW_KEY_F8: dialogs_toggle_warnings(v); break;
    case GLFW_KEY_F12: dialogs_shot(v, NULL); break;
    case GLFW_KEY_ESCAPE:
        options_set_tool(v, TOOL_ORBIT);
        dialogs_close_windows(v);
        presets_hide(v);
        options_set_mode(v, MODE_LIVE);
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
        if (p->repeats || ui_wants_keys()) continue;
        if (p->control)
            with_control(v, p);
        else if (!p->alt) {
            without_control(v, p);
            named(v, p);
        }
    }
}
