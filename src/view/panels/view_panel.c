/* The panel of the view: camera, picture, comparison. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "view/panels/panels.h"
#include "view/state/edit.h"
#include "view/state/opening.h"
#include "view/state/photographs.h"
#include "view/state/view_camera.h"
#include "view/state/view_options.h"

static const char *camera_name(const void *user, int k) {
    const Viewer *v = user;
    return k == 0 ? "free" : k == 1 ? "all of the scene" : v->shown->facts.cameras[k - 2];
}

static void draw_camera(Viewer *v) {
    static const UiRange fov = {5.0f, 120.0f, 30.0f, "deg", false}, speed = {0.05f, 10.0f, 1.0f, NULL, true};
    const UiChoices cameras = {v->shown->facts.info.camera_count + 2, camera_name, NULL, v};
    int row = 0;
    Orbit orbit = v->camera->orbit;
    Settings settings = v->frame->settings;
    if (strcmp(orbit.name, "auto") == 0) row = 1;
    if (orbit.name[0] >= '0' && orbit.name[0] <= '9') sscanf(orbit.name, "%d", &row), row += 2;
    if (row >= cameras.count) row = 0;
    if (ui_choice("camera", &cameras, &row) && row > 0) {
        if (row == 1)
            snprintf(orbit.name, sizeof orbit.name, "auto");
        else
            snprintf(orbit.name, sizeof orbit.name, "%d", row - 2);
    }
    ui_tip("The scene's cameras, or one that frames it all. It is free once it is moved.");
    if (ui_slider("field of view", &fov, &orbit.fov)) {
        orbit.fov = fminf(fmaxf(orbit.fov, 1.0f), 170.0f);
        orbit.name[0] = '\0';
    }
    ui_tip("Vertical.");
    ui_slider("fly speed", &speed, &settings.speed);
    ui_tip("Of the keys W A S D Q E, whatever is written on them; Shift is four times as fast.");
    settings.speed = fminf(fmaxf(settings.speed, 0.01f), 100.0f);
    ui_checkbox("Look up by pulling down", &settings.invert);
    ui_tip("For the right mouse button.");
    camera_set(v, &orbit);
    viewer_set_settings(v, &settings);
}

static const char *curve_name(const void *user, int k) { return weft_tonemap_name(k); }
static const char *curve_help(const void *user, int k) {
    static const char *const helps[] = {"Khronos PBR Neutral, 2024: keeps base colours.",
                                        "Narkowicz, ACES Filmic Tone Mapping Curve, 2015.", "Clamps at 1.",
                                        "Sobotka's AgX: soft, and bright colours become white."};
    return helps[k];
}
static const char *back_name(const void *user, int k) {
    static const char *const names[] = {"auto", "environment", "transparent", "colour", "blurred"};
    return names[k];
}
static const char *back_help(const void *user, int k) {
    static const char *const helps[] = {"Paper behind the studio, else the environment.",
                                        "What lights the scene is seen behind it.", "Nothing.", "One colour.",
                                        "What lights the scene, out of focus by 10 degrees."};
    return helps[k];
}
static const char *part_name(const void *user, int k) { return weft_part_name(k); }
static const char *part_help(const void *user, int k) {
    return k == 0                     ? "All of the light."
           : k < WEFT_PART_BASE_COLOR ? "This part of the light alone; the parts sum up to all but emission."
                                      : "This property, in numbers as they are.";
}

static void draw_floor(WeftFloor *floor) {
    static const UiRange fraction = {0.0f, 1.0f, 0.1f, NULL, false}, rough = {0.0f, 1.0f, 0.3f, NULL, false};
    bool on = floor->on;
    if (ui_checkbox("Floor", &on)) floor->on = on;
    ui_tip("Catches the shadow of the scene and mirrors it, and is seen by nothing else (G).");
    if (!on) return;
    ui_slider("mirrored", &fraction, &floor->reflection);
    ui_tip("Share of the scene that the floor mirrors.");
    ui_slider("floor roughness", &rough, &floor->roughness);
    ui_tip("Of the mirror: 0 is a polished floor.");
}

static void draw_picture(Viewer *v) {
    static const UiRange stops = {-6.0f, 6.0f, 0.0f, "stops", false};
    static const UiRange kelvin = {2000.0f, 12000.0f, WHITE_NONE, "K", false},
                         tint = {-50.0f, 50.0f, 0.0f, NULL, false};
    static const float grey[3] = {0.18f, 0.18f, 0.18f};
    const UiChoices curves = {WEFT_TONEMAP_COUNT, curve_name, curve_help, NULL},
                    backs = {5, back_name, back_help, NULL};
    const UiChoices parts = {WEFT_PART_COUNT, part_name, part_help, NULL};
    ViewOptions options = *v->options;
    int curve = (int)options.tonemap, back = (int)options.background, part = (int)options.part;
    if (ui_slider("exposure", &stops, &options.exposure)) options.metered = false;
    ui_tip("Brightens by 2^stops.");
    ui_checkbox("Automatic exposure", &options.metered);
    ui_tip("Shows the mean of the picture as middle grey.");
    if (ui_choice("tone map", &curves, &curve)) options.tonemap = (WeftTonemap)curve;
    if (ui_slider("white", &kelvin, &options.kelvin)) options.balanced = false;
    ui_tip("Temperature of the light that shows as white. 6504 K changes nothing, less makes the picture bluer.");
    if (ui_slider("tint", &tint, &options.tint)) options.balanced = false;
    ui_tip("Above 0, greener light shows as white, and the picture becomes more purple.");
    ui_checkbox("Automatic white", &options.balanced);
    ui_tip("Shows the light that most of the picture is lit by as white.");
    if (ui_choice("background", &backs, &back)) options.background = (WeftBackground)back;
    if (options.background == WEFT_BACKGROUND_COLOR) {
        ui_color("colour", grey, options.background_color);
        ui_tip("Linear.");
    }
    if (ui_choice("show", &parts, &part)) options.part = (WeftPart)part;
    ui_checkbox("Bounced light", &options.bounced);
    ui_tip("Once nothing moves, surfaces light each other: once, without gloss.");
    draw_floor(&options.floor);
    options_set(v, &options);
}

static void draw_compare(Viewer *v) {
    static const char *const splits[] = {"Off", "Line", "Side by side", NULL};
    static const char *const tips[] = {"One setting.", "A on the left of a line that can be dragged, B on the right.",
                                       "The same view twice."};
    int split = (int)v->edit->split;
    if (ui_tabs("A and B", splits, tips, &split)) edit_set_split(v, (Split)split);
    if (v->edit->split == SPLIT_NONE) {
        ui_dim("Two settings of everything - materials, profiles, lights - in one picture.");
        return;
    }
    if (ui_button("Edit the other")) edit_swap_sides(v);
    ui_tip("What the panels edit: A, on the left, or B (X).");
    ui_same_line();
    if (ui_button("Same as this")) {
        edit_match_other(v);
    }
    ui_tip("Makes the other what this one is.");
    ui_dim(v->edit->side == 0 ? "A is edited." : "B is edited.");
}

static void draw_tools(Viewer *v) {
    static const char *const tools[] = {"Orbit", "Probe", "Brush nap", NULL};
    static const UiRange radius = {0.002f, 0.5f, 0.05f, "m", true}, strength = {0.0f, 1.0f, 0.7f, NULL, false};
    static const char *const tips[] = {"The left button turns the camera.",
                                       "The left button asks what a pixel is made of.",
                                       "The left button strokes the fibres of a sheen."};
    int tool = (int)v->options->tool;
    ViewOptions options = *v->options;
    if (ui_tabs("Tool", tools, tips, &tool)) options.tool = (Tool)tool;
    if (options.tool != TOOL_BRUSH) {
        options_set(v, &options);
        return;
    }
    ui_slider("radius", &radius, &options.brush_radius);
    ui_tip("Of the brush, on the surface.");
    ui_slider("pressure", &strength, &options.brush_strength);
    ui_tip("How far one pass turns the fibres.");
    options_set(v, &options);
    ui_dim("Of sheens the lobe fibre alone has a nap.");
}

void view_panel(Viewer *v) {
    if (ui_section("Picture", true)) draw_picture(v);
    if (ui_section("Camera", true)) draw_camera(v);
    if (ui_section("A | B", true)) draw_compare(v);
    if (ui_section("Photograph", v->photographs->path[0] != '\0')) photograph_section(v);
    if (ui_section("Tool", true)) draw_tools(v);
}
