/* The bars: menus and modes at the top, the status at the bottom. */
#include <stdio.h>
#include <string.h>

#include "view/files/paths.h"
#include "view/panels/panels.h"
#include "view/panels/render_command.h"
#include "view/state/dialogs.h"
#include "view/state/edit.h"
#include "view/state/frame_requests.h"
#include "view/state/leaving.h"
#include "view/state/opening.h"
#include "view/state/photographs.h"
#include "view/state/stills.h"
#include "view/state/view_camera.h"
#include "view/state/view_options.h"

static void file_menu(Viewer *v) {
    if (ui_menu_item("Open ...", "Ctrl+O", false, true)) dialogs_open(v, "Open");
    if (ui_menu("Open recent")) {
        for (int k = 0; k < v->frame->settings.recent_count; k++)
            if (ui_menu_item(v->frame->settings.recent[k], NULL, false, true)) {
                char path[RECENT_PATH];
                snprintf(path, sizeof path, "%s", v->frame->settings.recent[k]); /* the list is about to change */
                opening_ask(v, path);
            }
        if (!v->frame->settings.recent_count) ui_menu_item("nothing yet", NULL, false, false);
        ui_menu_end();
    }
    if (ui_menu("Built-in scenes")) {
        for (int k = 0; weft_builtin_name(k); k++) {
            char path[96];
            snprintf(path, sizeof path, "builtin:%s", weft_builtin_name(k));
            if (ui_menu_item(path, NULL, false, true)) opening_ask(v, path);
            ui_tip(weft_builtin_help(k));
        }
        ui_menu_end();
    }
    ui_rule();
    if (ui_menu_item("Save scene or material ...", "Ctrl+S", false, v->shown->any)) dialogs_save(v, NULL);
    if (ui_menu_item("Save a picture ...", "F12", false, v->shown->any)) dialogs_shot(v, NULL);
    if (ui_menu_item("Copy the command line", "Ctrl+Shift+C", false, v->shown->any)) command_copy(v);
    ui_rule();
    if (ui_menu_item("Cancel the path-traced pictures", NULL, false, v->stills->still != NULL)) stills_cancel(v);
    if (ui_menu_item("Quit", "Ctrl+Q", false, true)) leaving_quit(v);
}

static void edit_menu(Viewer *v) {
    if (ui_menu_item("Undo", "Ctrl+Z", false, v->edit->history.now > 0)) edit_undo(v);
    if (ui_menu_item("Redo", "Ctrl+Shift+Z", false, v->edit->history.now < v->edit->history.count)) edit_redo(v);
    ui_rule();
    if (ui_menu_item("Presets ...", NULL, false, v->shown->any)) presets_show(v);
    if (ui_menu_item("Next material", "M", false, v->shown->any)) edit_next_material(v, 1);
    if (ui_menu_item("Material before", "Shift+M", false, v->shown->any)) edit_next_material(v, -1);
}

static void view_menu(Viewer *v) {
    if (ui_menu_item("Frame all", "F", false, v->shown->any)) camera_frame_all(v);
    if (ui_menu_item("First camera", "Home", false, v->shown->any)) camera_reset(v);
    ui_rule();
    if (ui_menu_item("Floor", "G", v->options->floor.on, true)) options_toggle_floor(v);
    if (ui_menu_item("Hide polygon lights", "H", v->options->hide_lights, true)) options_toggle_lights(v);
    ui_rule();
    for (int k = 0; k < WEFT_PART_COUNT; k++) {
        char key[8];
        snprintf(key, sizeof key, "%d", k + 1);
        if (ui_menu_item(weft_part_name(k), k < 9 ? key : NULL, (int)v->options->part == k, true))
            options_set_part(v, (WeftPart)k);
    }
}

static void photograph_menu(Viewer *v) {
    static const char *const places[] = {"Photograph off", "Photograph beside", "Photograph behind a line",
                                         "Photograph over the picture"};
    PhotographView view = v->photographs->view;
    const bool any = v->photographs->path[0] != '\0';
    if (ui_menu_item("Photograph ...", NULL, false, v->shown->any)) dialogs_open(v, "Choose a photograph");
    for (int k = 0; k < 4; k++) {
        if (!ui_menu_item(places[k], NULL, any && (int)view.place == k, any)) continue;
        view.place = (PhotographPlace)k;
        photographs_set(v, &view);
    }
}

static void compare_menu(Viewer *v) {
    if (ui_menu_item("A | B, with a line", "C", v->edit->split == SPLIT_LINE, v->shown->any))
        edit_set_split(v, v->edit->split == SPLIT_LINE ? SPLIT_NONE : SPLIT_LINE);
    if (ui_menu_item("A | B, side by side", NULL, v->edit->split == SPLIT_SIDES, v->shown->any))
        edit_set_split(v, v->edit->split == SPLIT_SIDES ? SPLIT_NONE : SPLIT_SIDES);
    if (ui_menu_item("Edit the other", "X", false, v->edit->split != SPLIT_NONE)) edit_swap_sides(v);
    ui_rule();
    if (ui_menu_item("Path traced", "Tab", v->options->mode == MODE_REFERENCE, v->shown->any))
        options_toggle_mode(v, MODE_REFERENCE);
    if (ui_menu_item("Difference", "Shift+Tab", v->options->mode == MODE_DIFFERENCE, v->shown->any))
        options_toggle_mode(v, MODE_DIFFERENCE);
    ui_rule();
    if (ui_menu_item("All profiles", NULL, false, v->shown->any)) dialogs_show_profiles(v);
    ui_rule();
    photograph_menu(v);
}

static void draw_menus(Viewer *v) {
    if (ui_menu("File")) {
        file_menu(v);
        ui_menu_end();
    }
    if (ui_menu("Edit")) {
        edit_menu(v);
        ui_menu_end();
    }
    if (ui_menu("View")) {
        view_menu(v);
        ui_menu_end();
    }
    if (ui_menu("Compare")) {
        compare_menu(v);
        ui_menu_end();
    }
    if (ui_menu("Help")) {
        if (ui_menu_item("Keys and mouse", "?", v->dialogs->help, true)) dialogs_toggle_help(v);
        ui_menu_end();
    }
}

static void draw_modes(Viewer *v) {
    static const char *const modes[] = {"OpenGL", "Path traced", "Difference", NULL};
    static const char *const tips[] = {"As an engine draws it.", "The path tracer's answer to exactly this view (Tab).",
                                       "How OpenGL differs from it, as a map and in numbers (Shift+Tab)."};
    int mode = (int)v->options->mode;
    if (ui_tabs("Mode", modes, tips, &mode)) options_set_mode(v, (Mode)mode);
    ui_same_line();
    ui_text("  ");
    ui_same_line();
    bool line = v->edit->split == SPLIT_LINE;
    if (ui_checkbox("A | B", &line)) edit_set_split(v, line ? SPLIT_LINE : SPLIT_NONE);
    ui_tip("Two settings in one picture, with a line between that can be dragged (C). X edits the other.");
    ui_same_line();
    bool probe = v->options->tool == TOOL_PROBE, brush = v->options->tool == TOOL_BRUSH;
    if (ui_checkbox("Probe", &probe)) {
        options_set_tool(v, probe ? TOOL_PROBE : TOOL_ORBIT);
    }
    ui_tip("A click shows what a pixel is made of (P).");
    ui_same_line();
    if (ui_checkbox("Brush", &brush)) options_set_tool(v, brush ? TOOL_BRUSH : TOOL_ORBIT);
    ui_tip("Strokes lay the nap of a fibre sheen (B).");
    if (v->options->tool != TOOL_BRUSH || v->edit->material >= v->edit->state.material_count) return;
    if (weft_material_reads(scene_state_material(&v->edit->state, v->edit->material), weft_material_input_find("nap")))
        return;
    ui_same_line();
    if (ui_button("Make it fibre")) edit_make_fibre(v);
    ui_tip("The sheen of this material has no nap: gives it the lobe fibre, which has one.");
}

void menu_draw(Viewer *v) {
    int width, height;
    window_size(v->window, &width, &height);
    ui_scope("Menu");
    if (ui_menu_bar()) {
        draw_menus(v);
        ui_menu_bar_end();
    }
    ui_scope_end();
    float row = ui_line_height();
    UiBox bar = {0.0f, row - 4.0f * ui_scale(), (float)width, v->frame->stage.y - row + 4.0f * ui_scale()};
    if (ui_panel("Bar", bar, false)) draw_modes(v);
    ui_panel_end();
}

/* Returns the number of lines. */
static int lines_of(const char *text) {
    int count = 0;
    for (; *text; text++) count += *text == '\n';
    return count;
}

/* Returns the status of the picture; text: of a sum of frames. */
static const char *picture_status(const Viewer *v, char text[64]) {
    const RenderedFrame *p = &v->requests->rendered;
    bool sums = v->options->mode == MODE_LIVE && p->summed < p->sum_frames;
    snprintf(text, 64, "%d of %d frames", p->summed, p->sum_frames);
    bool instead = v->options->mode == MODE_LIVE && requests_shown(v) == SHOWS_TRACED;
    return v->opening->has_pending ? "preparing"
           : instead               ? "compiling, path tracing meanwhile"
           : v->requests->late     ? "compiling, showing the previous picture"
           : p->busy               ? "preparing shaders and occlusion"
           : sums                  ? text
                                   : "ready";
}

void status_draw(Viewer *v) {
    int width, height;
    char text[200], right[200], sum[64];
    window_size(v->window, &width, &height);
    float top = v->frame->stage.y + v->frame->stage.height, scale = ui_scale();
    UiBox bar = {0.0f, top, (float)width, (float)height - top};
    ui_behind(true);
    ui_fill(bar, 0xFF1C1B1Au);
    char still[64] = "";
    if (v->stills->still)
        snprintf(still, sizeof still, "path tracing %s: %.0f %%   ",
                 v->stills->due.choice.around ? "a turntable" : "a picture", 100.0 * v->stills->share);
    snprintf(right, sizeof right, "%s%.0f fps  picture %.1f ms  %d x %d  %s", still,
             v->frame->frame_seconds > 0.0 ? 1.0 / v->frame->frame_seconds : 0.0, 1e3 * v->frame->picture_seconds,
             v->requests->rendered.width, v->requests->rendered.height, picture_status(v, sum));
    float width_left = (float)width - ui_text_width(right) - 40.0f * scale;
    int count = lines_of(v->shown->warnings);
    text[0] = '\0';
    if (count) snprintf(text, sizeof text, "%d warning%s (F8)   ", count, count == 1 ? "" : "s");
    UiBox left = {0.0f, top, width_left, bar.height};
    ui_clip(&left);
    ui_label(8.0f * scale, top + 4.0f * scale, 0xFF58C7F8u, text);
    ui_label(8.0f * scale + ui_text_width(text), top + 4.0f * scale,
             v->frame->message_grave ? 0xFF58C7F8u : 0xFFB0B2B4u, v->frame->message);
    ui_clip(NULL);
    ui_label((float)width - ui_text_width(right) - 12.0f * scale, top + 4.0f * scale, 0xFF909294u, right);
    ui_behind(false);
}
