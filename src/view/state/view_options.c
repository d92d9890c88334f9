/* The options of the view: mode, part, background, exposure, tool. */
#include <math.h>
#include <string.h>

#include "view/state/rooms.h"

void options_begin(Viewer *v) {
    const ViewDesc *desc = v->desc;
    v->rooms->options = (ViewOptions){.tonemap = desc->tonemap,
                                      .exposure = desc->exposure,
                                      .background = desc->background,
                                      .floor = desc->floor,
                                      .hide_lights = desc->hide_lights,
                                      .split_at = 0.5f,
                                      .brush_radius = 0.05f,
                                      .brush_strength = 0.7f};
    memcpy(v->rooms->options.background_color, desc->background_color,
           sizeof v->rooms->options.background_color);
}

static float within(float x, float low, float high) { return fminf(fmaxf(x, low), high); }

void options_set(Viewer *v, const ViewOptions *options) {
    ViewOptions *own = &v->rooms->options;
    *own = *options;
    own->split_at = within(own->split_at, 0.02f, 0.98f);
    own->exposure = within(own->exposure, -32.0f, 32.0f);
    own->floor.reflection = within(own->floor.reflection, 0.0f, 1.0f);
    own->floor.roughness = within(own->floor.roughness, 0.0f, 1.0f);
    own->brush_radius = within(own->brush_radius, 1e-4f, 100.0f);
    own->brush_strength = within(own->brush_strength, 0.0f, 1.0f);
}

void viewer_mode(Viewer *v, Mode mode) {
    v->rooms->options.mode = v->rooms->options.mode == mode ? MODE_LIVE : mode;
}

void viewer_show_mode(Viewer *v, Mode mode) { v->rooms->options.mode = mode; }
void viewer_part(Viewer *v, WeftPart part) { v->rooms->options.part = part; }
void viewer_panel(Viewer *v, int panel) { v->rooms->options.panel = panel; }

void viewer_tool(Viewer *v, Tool tool) {
    v->rooms->options.tool = tool;
    if (tool == TOOL_PROBE) v->rooms->options.panel = PANEL_INSPECT;
}

void viewer_toggle_floor(Viewer *v) { v->rooms->options.floor.on = !v->rooms->options.floor.on; }
void viewer_toggle_lights(Viewer *v) { v->rooms->options.hide_lights = !v->rooms->options.hide_lights; }
