/* The panel of the view: camera, picture, comparison. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "view/viewer.h"

static const char *camera_name(const void *user, int k) {
    const Viewer *v = user;
    return k == 0 ? "free" : k == 1 ? "all of the scene" : v->facts.cameras[k - 2];
}

static void draw_camera(Viewer *v) {
    static const UiRange fov = {5.0f, 120.0f, 30.0f, "deg", false}, speed = {0.05f, 10.0f, 1.0f, NULL, true};
    const UiChoices cameras = {v->facts.info.camera_count + 2, camera_name, NULL, v};
    int row = 0;
    if (strcmp(v->orbit.name, "auto") == 0) row = 1;
    if (v->orbit.name[0] >= '0' && v->orbit.name[0] <= '9') sscanf(v->orbit.name, "%d", &row), row += 2;
    if (row >= cameras.count) row = 0;
    if (ui_choice("camera", &cameras, &row) && row > 0) {
        if (row == 1)
            snprintf(v->orbit.name, sizeof v->orbit.name, "auto");
        else
            snprintf(v->orbit.name, sizeof v->orbit.name, "%d", row - 2);
    }
    ui_tip("The scene's cameras, or one that frames it all. It is free once it is moved.");
    if (ui_slider("field of view", &fov, &v->orbit.fov)) {
        v->orbit.fov = fminf(fmaxf(v->orbit.fov, 1.0f), 170.0f);
        v->orbit.name[0] = '\0';
    }
    ui_tip("Vertical.");
    ui_slider("fly speed", &speed, &v->settings.speed);
    ui_tip("Of the keys W A S D Q E, whatever is written on them; Shift is four times as fast.");
    v->settings.speed = fminf(fmaxf(v->settings.speed, 0.01f), 100.0f);
    ui_checkbox("Look up by pulling down", &v->settings.invert);
    ui_tip("For the right mouse button.");
}

static const char *curve_name(const void *user, int k) {
    static const char *const names[] = {"pbr-neutral", "aces", "none"};
    return names[k];
}
static const char *curve_help(const void *user, int k) {
    static const char *const helps[] = {"Khronos PBR Neutral, 2024: keeps base colours.",
                                        "Narkowicz, ACES Filmic Tone Mapping Curve, 2015.", "Clamps at 1."};
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

static void draw_floor(Viewer *v) {
    static const UiRange fraction = {0.0f, 1.0f, 0.1f, NULL, false}, rough = {0.0f, 1.0f, 0.3f, NULL, false};
    bool on = v->floor.on;
    if (ui_checkbox("Floor", &on)) v->floor.on = on;
    ui_tip("Catches the shadow of the scene and mirrors it, and is seen by nothing else (G).");
    if (!on) return;
    ui_slider("mirrored", &fraction, &v->floor.reflection);
    ui_tip("Share of the scene that the floor mirrors.");
    ui_slider("floor roughness", &rough, &v->floor.roughness);
    ui_tip("Of the mirror: 0 is a polished floor.");
    v->floor.reflection = fminf(fmaxf(v->floor.reflection, 0.0f), 1.0f);
    v->floor.roughness = fminf(fmaxf(v->floor.roughness, 0.0f), 1.0f);
}

static void draw_picture(Viewer *v) {
    static const UiRange stops = {-6.0f, 6.0f, 0.0f, "stops", false};
    static const float grey[3] = {0.18f, 0.18f, 0.18f};
    const UiChoices curves = {3, curve_name, curve_help, NULL}, backs = {5, back_name, back_help, NULL};
    const UiChoices parts = {WEFT_PART_COUNT, part_name, part_help, NULL};
    int curve = (int)v->tonemap, back = (int)v->background, part = (int)v->part;
    ui_slider("exposure", &stops, &v->exposure);
    ui_tip("Brightens by 2^stops.");
    v->exposure = fminf(fmaxf(v->exposure, -32.0f), 32.0f);
    if (ui_choice("tone map", &curves, &curve)) v->tonemap = (WeftTonemap)curve;
    if (ui_choice("background", &backs, &back)) v->background = (WeftBackground)back;
    if (v->background == WEFT_BACKGROUND_COLOR) {
        ui_color("colour", grey, v->background_color);
        ui_tip("Linear.");
    }
    if (ui_choice("show", &parts, &part)) v->part = (WeftPart)part;
    draw_floor(v);
}

static void draw_compare(Viewer *v) {
    static const char *const splits[] = {"Off", "Line", "Side by side", NULL};
    static const char *const tips[] = {"One setting.",
                                       "A on the left of a line that can be dragged, B on the right.",
                                       "The same view twice."};
    int split = (int)v->split;
    if (ui_tabs("A and B", splits, tips, &split)) viewer_split(v, (Split)split);
    if (v->split == SPLIT_NONE) {
        ui_dim("Two settings of everything - materials, profiles, lights - in one picture.");
        return;
    }
    if (ui_button("Edit the other")) viewer_swap(v);
    ui_tip("What the panels edit: A, on the left, or B (X).");
    ui_same_line();
    if (ui_button("Same as this")) {
        scene_state_free(&v->other);
        scene_state_copy(&v->other, &v->state);
        v->ask = true;
    }
    ui_tip("Makes the other what this one is.");
    ui_dim(v->side == 0 ? "A is edited." : "B is edited.");
}

static void draw_tools(Viewer *v) {
    static const char *const tools[] = {"Orbit", "Probe", "Brush nap", NULL};
    static const UiRange radius = {0.002f, 0.5f, 0.05f, "m", true},
                         strength = {0.0f, 1.0f, 0.7f, NULL, false};
    static const char *const tips[] = {"The left button turns the camera.",
                                       "The left button asks what a pixel is made of.",
                                       "The left button strokes the fibres of a sheen."};
    int tool = (int)v->tool;
    if (ui_tabs("Tool", tools, tips, &tool)) v->tool = (Tool)tool;
    if (v->tool != TOOL_BRUSH) return;
    ui_slider("radius", &radius, &v->brush.radius);
    ui_tip("Of the brush, on the surface.");
    ui_slider("pressure", &strength, &v->brush.strength);
    ui_tip("How far one pass turns the fibres.");
    v->brush.radius = fminf(fmaxf(v->brush.radius, 1e-4f), 100.0f);
    v->brush.strength = fminf(fmaxf(v->brush.strength, 0.0f), 1.0f);
    ui_dim("Of sheens the lobe fibre alone has a nap.");
}

void view_panel(Viewer *v) {
    if (ui_section("Picture", true)) draw_picture(v);
    if (ui_section("Camera", true)) draw_camera(v);
    if (ui_section("A | B", true)) draw_compare(v);
    if (ui_section("Tool", true)) draw_tools(v);
}
