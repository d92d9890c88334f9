#include "view/state/view_options.h"

#include <math.h>
#include <string.h>

#include "view/state/states.h"

void options_begin(Viewer *v) {
    const ViewDesc *desc = v->desc;
    v->states->options = (ViewOptions){.tonemap = desc->tonemap,
                                       .exposure = desc->exposure,
                                       .metered = desc->metered,
                                       .kelvin = desc->kelvin > 0.0f ? desc->kelvin : WHITE_NONE,
                                       .tint = desc->tint,
                                       .balanced = desc->balanced,
                                       .background = desc->background,
                                       .floor = desc->floor,
                                       .stage = desc->stage,
                                       .hide_lights = desc->hide_lights,
                                       .bounced = desc->bounces > 0,
                                       .split_at = 0.5f,
                                       .brush_radius = 0.05f,
                                       .brush_strength = 0.7f};
    memcpy(v->states->options.background_color, desc->background_color, sizeof v->states->options.background_color);
}

static float within(float x, float low, float high) { return fminf(fmaxf(x, low), high); }

void options_set(Viewer *v, const ViewOptions *options) {
    ViewOptions *own = &v->states->options;
    const bool decided = own->floor.on != options->floor.on;
    *own = *options;
    own->stage = own->stage && !decided;
    own->split_at = within(own->split_at, 0.02f, 0.98f);
    own->exposure = within(own->exposure, -32.0f, 32.0f);
    own->kelvin = within(own->kelvin, 1700.0f, 25000.0f);
    own->tint = within(own->tint, -50.0f, 50.0f);
    own->floor.reflection = within(own->floor.reflection, 0.0f, 1.0f);
    own->floor.roughness = within(own->floor.roughness, 0.0f, 1.0f);
    own->brush_radius = within(own->brush_radius, 1e-4f, 100.0f);
    own->brush_strength = within(own->brush_strength, 0.0f, 1.0f);
}

void options_white(const ViewOptions *options, float white[2]) {
    white[0] = white[1] = 0.0f;
    if (options->balanced) {
        memcpy(white, options->white, sizeof options->white);
        return;
    }
    const bool none = fabsf(options->kelvin - WHITE_NONE) < 0.5f && fabsf(options->tint) < 1e-3f;
    if (!none) weft_white(options->kelvin, options->tint, white);
}

void options_take_metered(Viewer *v, float stops, const float white[2]) {
    const float noise = 0.02f, color_noise = 5e-4f; /* stops; of x and y */
    ViewOptions *own = &v->states->options;
    if (own->metered && fabsf(stops - own->exposure) > noise) own->exposure = within(stops, -32.0f, 32.0f);
    if (own->balanced && fabsf(white[0] - own->white[0]) + fabsf(white[1] - own->white[1]) > color_noise)
        memcpy(own->white, white, sizeof own->white);
}

void options_toggle_mode(Viewer *v, Mode mode) {
    v->states->options.mode = v->states->options.mode == mode ? MODE_LIVE : mode;
}

void options_set_mode(Viewer *v, Mode mode) { v->states->options.mode = mode; }
void options_set_part(Viewer *v, WeftPart part) { v->states->options.part = part; }
void options_set_panel(Viewer *v, int panel) { v->states->options.panel = panel; }

void options_set_tool(Viewer *v, Tool tool) {
    v->states->options.tool = tool;
    if (tool == TOOL_PROBE) v->states->options.panel = PANEL_INSPECT;
}

void options_toggle_floor(Viewer *v) {
    v->states->options.floor.on = !v->states->options.floor.on;
    v->states->options.stage = false;
}

void options_set_stage(Viewer *v, const WeftFloor *floor) {
    ViewOptions *own = &v->states->options;
    if (!own->stage) return;
    own->floor.on = floor->on && own->background == WEFT_BACKGROUND_AUTO;
    if (own->floor.on) own->floor = *floor;
}
void options_toggle_lights(Viewer *v) { v->states->options.hide_lights = !v->states->options.hide_lights; }
