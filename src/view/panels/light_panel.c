/* The panel of lights: those of the scene, and the environment. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "view/panels/panels.h"
#include "view/state/dialogs.h"
#include "view/state/edit.h"
#include "view/state/view_camera.h"
#include "view/state/view_options.h"

static const char *const kinds[] = {"sun", "point", "spot", "polygon"};
static const char *const kind_helps[] = {
    "Parallel light from far away: its colour is irradiance across the beam, W/m^2.",
    "Light from a point: its colour is radiant intensity, W/sr, and falls with the square of the distance.",
    "A point light within a cone.",
    "A flat light of a few corners: its colour is radiance, W/(m^2 sr). OpenGL draws it by linearly "
    "transformed "
    "cosines (Heitz et al. 2016)."};

static const char *light_name(const void *user, int k) {
    static char text[64];
    const Viewer *v = user;
    snprintf(text, sizeof text, "%d: %s", k + 1, kinds[v->edit->state.lights[k].kind]);
    return text;
}

/* Adds a light beside and above the eye, directed at the camera's target. */
static void add_light(Viewer *v, WeftLightKind kind) {
    if (v->edit->state.light_count == STATE_LIGHTS) {
        viewer_report(v, true, "no more than %d lights", STATE_LIGHTS);
        return;
    }
    WeftLight light;
    float right[3], up[3], forward[3], far = 0.6f * v->camera->reach;
    memset(&light, 0, sizeof light); /* compared byte by byte */
    light.kind = kind;
    orbit_axes(&v->camera->orbit, right, up, forward);
    for (int k = 0; k < 3; k++) light.direction[k] = 0.6f * forward[k] + 0.5f * right[k];
    light.direction[1] -= 0.6f;
    float n = hypotf(hypotf(light.direction[0], light.direction[1]), light.direction[2]);
    for (int k = 0; k < 3; k++) light.direction[k] /= fmaxf(n, 1e-6f);
    for (int k = 0; k < 3; k++) light.position[k] = v->camera->home[k] - far * light.direction[k];
    float color = kind == WEFT_LIGHT_DIRECTIONAL ? 2.0f : kind == WEFT_LIGHT_POLYGON ? 12.0f : 3.0f * far * far;
    for (int k = 0; k < 3; k++) light.color[k] = color;
    if (kind == WEFT_LIGHT_POLYGON) light.size[0] = light.size[1] = 0.4f * far, light.corners = 4;
    if (kind == WEFT_LIGHT_SPOT) light.inner = 20.0f, light.outer = 30.0f;
    edit_add_light(v, &light);
}

/* Draws colour and strength; the strength is the greatest channel. */
static void draw_color(WeftLight *l) {
    static const float white[3] = {1.0f, 1.0f, 1.0f};
    static const UiRange range = {0.01f, 1000.0f, 1.0f, NULL, true};
    float most = fmaxf(l->color[0], fmaxf(l->color[1], l->color[2])), tint[3];
    for (int c = 0; c < 3; c++) tint[c] = most > 0.0f ? l->color[c] / most : 1.0f;
    bool changed = ui_color("colour", white, tint);
    ui_tip("The tint of the light; its strongest channel counts as 1.");
    changed |= ui_slider("intensity", &range, &most);
    ui_tip(kind_helps[l->kind]);
    float top = fmaxf(tint[0], fmaxf(tint[1], tint[2]));
    for (int c = 0; c < 3 && changed; c++) l->color[c] = fminf(fmaxf(most * tint[c] / fmaxf(top, 1e-6f), 0.0f), 1e6f);
}

static void draw_place(WeftLight *l) {
    if (l->kind != WEFT_LIGHT_DIRECTIONAL) {
        ui_numbers("position", 0.01f, l->position, 3);
        ui_tip("Metres, x, y (up), z. The light can be dragged in the picture, too.");
    }
    if (l->kind != WEFT_LIGHT_POINT) {
        float kept[3];
        memcpy(kept, l->direction, sizeof kept);
        ui_numbers("direction", 0.01f, l->direction, 3);
        ui_tip("Where it shines, of any length.");
        const float *d = l->direction;
        if (!(d[0] * d[0] + d[1] * d[1] + d[2] * d[2] > 1e-12f)) memcpy(l->direction, kept, sizeof kept);
    }
}

static void draw_shape(WeftLight *l) {
    static const UiRange cone = {0.0f, 90.0f, 30.0f, "deg", false}, size = {0.01f, 10.0f, 1.0f, "m", true};
    static const UiRange roll = {-180.0f, 180.0f, 0.0f, "deg", false};
    if (l->kind == WEFT_LIGHT_SPOT) {
        ui_slider("inner cone", &cone, &l->inner);
        ui_tip("Full up to this angle from its axis.");
        ui_slider("outer cone", &cone, &l->outer);
        ui_tip("Nothing from this angle on.");
        l->outer = fminf(fmaxf(l->outer, 0.1f), 90.0f);
        l->inner = fminf(fmaxf(l->inner, 0.0f), l->outer);
    }
    if (l->kind != WEFT_LIGHT_POLYGON) return;
    ui_slider("width", &size, &l->size[0]);
    ui_tip("Metres, along its level axis.");
    ui_slider("height", &size, &l->size[1]);
    ui_tip("Metres, across it.");
    ui_slider("roll", &roll, &l->roll);
    ui_tip("Turns it about its normal.");
    l->roll = remainderf(l->roll, 360.0f);
    ui_slider_int("corners", 3, 8, &l->corners);
    ui_tip("Of the polygon: 4 is a rectangle, 8 nearly an ellipse.");
    l->corners = l->corners < 3 ? 3 : l->corners > 8 ? 8 : l->corners;
    for (int k = 0; k < 2; k++) l->size[k] = fminf(fmaxf(l->size[k], 1e-3f), 1e4f);
}

static void draw_lights(Viewer *v) {
    bool hidden = v->options->hide_lights;
    if (ui_checkbox("Hide polygon lights", &hidden) && hidden != v->options->hide_lights) options_toggle_lights(v);
    ui_tip("They shine, but the camera looks through them.");
    for (int k = 0; k < 4; k++) {
        char label[32];
        if (k) ui_same_line();
        snprintf(label, sizeof label, "+ %s", kinds[k]);
        if (ui_button(label)) add_light(v, (WeftLightKind)k);
        ui_tip(kind_helps[k]);
    }
    if (!v->edit->state.light_count) {
        ui_dim("No light of its own: only the environment lights the scene.");
        return;
    }
    if (v->edit->light >= v->edit->state.light_count) edit_choose_light(v, v->edit->state.light_count - 1);
    int light = v->edit->light;
    const UiChoices lights = {v->edit->state.light_count, light_name, NULL, v};
    if (ui_choice("light", &lights, &light)) edit_choose_light(v, light);
    ui_tip("The light that is edited; its handle in the picture moves it.");
    WeftLight edited = v->edit->state.lights[v->edit->light];
    draw_color(&edited);
    draw_place(&edited);
    draw_shape(&edited);
    edit_set_light(v, v->edit->light, &edited);
    if (ui_button("Remove")) edit_remove_light(v, v->edit->light);
    ui_tip("Takes this light away; Ctrl+Z brings it back.");
}

static const char *environment_name(const void *user, int k) {
    static const char *const names[] = {"studio", "picture", "colour"};
    return names[k];
}
static const char *environment_help(const void *user, int k) {
    static const char *const helps[] = {
        "The built-in soft boxes.",
        "A lat-long picture (.hdr, .exr), or a cube map (.ktx2, or a folder with posx, negx ...): open or drop one.",
        "One radiance from everywhere: the furnace, when it is 1."};
    return helps[k];
}

static void draw_environment(Viewer *v) {
    static const UiRange rotation = {-180.0f, 180.0f, 0.0f, "deg", false}, strength = {0.0f, 4.0f, 1.0f, NULL, false};
    static const float grey[3] = {1.0f, 1.0f, 1.0f};
    const UiChoices rows = {3, environment_name, environment_help, NULL};
    EnvironmentState edited = v->edit->state.environment, *a = &edited;
    int kind = (int)a->kind;
    if (ui_choice("source", &rows, &kind)) {
        if (kind == ENVIRONMENT_FILE && !a->path[0]) {
            dialogs_open(v, "Choose a light");
        } else {
            if (kind == ENVIRONMENT_COLOR && !(a->color[0] + a->color[1] + a->color[2] > 0.0f))
                a->color[0] = a->color[1] = a->color[2] = 1.0f;
            a->kind = (EnvironmentSource)kind;
        }
    }
    ui_indent();
    if (ui_button("Choose a picture ...")) dialogs_open(v, "Choose a light");
    ui_tip("Another lat-long picture, or a cube map: a KTX 2 file, or six files posx, negx, posy, negy, posz, negz.");
    ui_indent_end();
    if (a->kind == ENVIRONMENT_FILE) ui_dim(a->path);
    if (a->kind == ENVIRONMENT_COLOR) {
        ui_color("radiance", grey, a->color);
        ui_tip("W/(m^2 sr), linear.");
    }
    ui_slider("rotation", &rotation, &a->rotation);
    ui_tip("About the vertical. Ctrl-drag on the picture does it, too.");
    ui_slider("strength", &strength, &a->strength);
    ui_tip("A factor on the environment's light.");
    ui_slider("ambient", &strength, &a->ambient);
    ui_tip("A factor on what the diffuse lobe and dust reflect of it: 0 leaves reflections alone. In the path "
           "tracer, too, though no light is so.");
    ui_slider("reflections", &strength, &a->reflection);
    ui_tip("A factor on what the specular, sheen and coat lobes reflect of it: 0 leaves ambient light alone.");
    a->rotation = remainderf(a->rotation, 360.0f);
    float *const factors[] = {&a->strength, &a->ambient, &a->reflection};
    for (int k = 0; k < 3; k++) *factors[k] = fminf(fmaxf(*factors[k], 0.0f), 1e6f);
    edit_set_environment(v, &edited);
}

static const char *ambient_name(const void *user, int k) {
    static const char *const names[] = {"best", "irradiance", "mirror", "fitted", "none"};
    return names[k];
}
static const char *ambient_help(const void *user, int k) {
    static const char *const helps[] = {"For each lobe the one that is nearest to the path tracer.",
                                        "Irradiance times albedo: the cheapest, and for many engines all there is.",
                                        "One look-up where a mirror would look, as engines do.",
                                        "Lights for what is bright, and a few look-ups fitted to the lobe.",
                                        "No light from the environment."};
    return helps[k];
}

void light_panel(Viewer *v) {
    if (ui_section("Lights", true)) draw_lights(v);
    if (ui_section("Environment (HDRI, IBL)###Environment", true)) {
        draw_environment(v);
        const UiChoices rows = {5, ambient_name, ambient_help, NULL};
        ViewOptions options = *v->options;
        int ambient = (int)options.ambient;
        if (ui_choice("by OpenGL", &rows, &ambient)) options.ambient = (WeftAmbient)ambient;
        options_set(v, &options);
    }
}
