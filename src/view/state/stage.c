#include "view/state/stage.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/pi.h"
#include "view/state/brush.h"
#include "view/state/states.h"

enum { LEFT, RIGHT, MIDDLE };

static const unsigned white = 0xFFFFFFFFu, dark = 0xB0000000u, accent = 0xFF4D8CDBu;

static bool over_stage(const Viewer *v) {
    const UiBox *s = &v->frame->stage;
    return v->frame->input.x >= s->x && v->frame->input.y >= s->y && v->frame->input.x < s->x + s->width &&
           v->frame->input.y < s->y + s->height;
}

/* Returns the box of the edited state: half of the stage if two stand side by side. */
static UiBox seen_box(const Viewer *v) {
    UiBox box = v->frame->stage;
    if (v->edit->split != SPLIT_SIDES || v->options->mode != MODE_LIVE) return box;
    box.width = floorf(0.5f * box.width);
    if (v->edit->side) box.x += box.width;
    return box;
}

static float seen_aspect(const Viewer *v) {
    UiBox box = seen_box(v);
    return fmaxf(box.width, 1.0f) / fmaxf(box.height, 1.0f);
}

/* Returns the mouse position on that picture, as fractions of its sides. */
static void on_picture(const Viewer *v, float at[2]) {
    UiBox box = seen_box(v);
    at[0] = (v->frame->input.x - box.x) / box.width;
    at[1] = (v->frame->input.y - box.y) / box.height;
}

/* Computes the position of a light's handle; that of a sun is on a sphere around the scene. */
static void handle_place(const Viewer *v, const WeftLight *light, float place[3]) {
    memcpy(place, light->position, 3 * sizeof *place);
    if (light->kind != WEFT_LIGHT_DIRECTIONAL) return;
    const float *d = light->direction;
    float n = sqrtf(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]), r = v->camera->reach;
    for (int k = 0; k < 3; k++) place[k] = v->camera->home[k] - r * d[k] / fmaxf(n, 1e-6f);
}

static bool handle_at(const Viewer *v, int light, float at[2]) {
    float place[3];
    handle_place(v, &v->edit->state.lights[light], place);
    if (!orbit_project(&v->camera->orbit, place, seen_aspect(v), at)) return false;
    UiBox box = seen_box(v);
    at[0] = box.x + at[0] * box.width;
    at[1] = box.y + at[1] * box.height;
    return true;
}

static bool handles_shown(const Viewer *v) { return v->options->panel == PANEL_LIGHT && v->options->mode == MODE_LIVE; }

static int handle_under(const Viewer *v) {
    float at[2], most = 12.0f * ui_scale();
    for (int k = 0; k < v->edit->state.light_count && handles_shown(v); k++)
        if (handle_at(v, k, at) && hypotf(at[0] - v->frame->input.x, at[1] - v->frame->input.y) < most) return k;
    return -1;
}

/* Moves a light with the mouse: in the plane that faces the eye, a sun over its sphere. */
static void drag_light(Viewer *v) {
    WeftLight moved = v->edit->state.lights[v->states->drag.light], *light = &moved;
    float at[2], ray[3], place[3], right[3], up[3], forward[3];
    on_picture(v, at);
    orbit_ray(&v->camera->orbit, seen_aspect(v), at[0], at[1], ray);
    orbit_axes(&v->camera->orbit, right, up, forward);
    handle_place(v, light, place);
    float depth = 0.0f, along = 0.0f;
    for (int k = 0; k < 3; k++) {
        depth += (place[k] - v->camera->orbit.eye[k]) * forward[k];
        along += ray[k] * forward[k];
    }
    if (!(along > 1e-3f)) return;
    for (int k = 0; k < 3; k++) place[k] = v->camera->orbit.eye[k] + depth / along * ray[k];
    if (light->kind != WEFT_LIGHT_DIRECTIONAL) {
        memcpy(light->position, place, sizeof place);
        edit_set_light(v, v->states->drag.light, &moved);
        return;
    }
    float d[3], n = 0.0f;
    for (int k = 0; k < 3; k++) {
        d[k] = v->camera->home[k] - place[k];
        n += d[k] * d[k];
    }
    for (int k = 0; k < 3 && n > 1e-12f; k++) light->direction[k] = d[k] / sqrtf(n);
    edit_set_light(v, v->states->drag.light, &moved);
}

enum { PICK_SELECT = 1, PICK_BRUSH = 2, PICK_KINDS = 4 };

/* Requests the surface point under the mouse. */
static void pick(Viewer *v, TaskKind kind, unsigned why) {
    Task task = {.kind = kind,
                 .scene = v->shown->number,
                 .x = v->frame->input.x - v->frame->stage.x,
                 .y = v->frame->input.y - v->frame->stage.y};
    task.nap = why == PICK_BRUSH;
    task.stamp = ++v->states->drag.stamps * PICK_KINDS + why;
    renderer_add_task(v->renderer, &task);
}

/* Gives a material without a nap an angle, so that the brushed map shows. */
static void begin_nap(Viewer *v, int material) {
    WeftMaterial m = *scene_state_material(&v->edit->state, material);
    int nap = weft_material_input_find("nap");
    if (m.inputs[nap].value[0] > 0.0f) return;
    m.inputs[nap].value[0] = 0.436332f; /* 25 degrees */
    m.inputs[nap].given = 1;
    edit_set_material(v, material, &m);
}

/* Returns true if the material has a nap to brush; otherwise explains what to do. */
static bool takes_strokes(Viewer *v, int material) {
    if (weft_material_reads(scene_state_material(&v->edit->state, material), weft_material_input_find("nap")))
        return true;
    viewer_report(v, true, "the sheen of %s has no nap to brush: \"Make it fibre\", above, gives it one",
                  v->shown->facts.materials[material]);
    v->states->drag.stroke.down = false;
    return false;
}

/* Paints along the way from the last position of the brush; the stroke begins again across a seam of the map. */
static void lay_along(const Viewer *v, WeftImage *image, const Probe *at, const float along[2]) {
    const Stroke *brush = &v->drag->stroke;
    float radius = v->options->brush_radius * at->uv_per_metre, du = at->texcoord[0] - brush->uv[0],
          dv = at->texcoord[1] - brush->uv[1];
    float far = hypotf(du, dv);
    int steps = far < 0.25f ? 1 + (int)fminf(far / fmaxf(0.3f * radius, 1e-4f), 200.0f) : 1;
    for (int k = 1; k <= steps; k++) {
        float t = (float)k / (float)steps;
        const float place[2] = {brush->uv[0] + t * du, brush->uv[1] + t * dv};
        brush_stroke(image, far < 0.25f ? place : at->texcoord, radius, along, v->options->brush_strength);
    }
}

static void brush_at(Viewer *v, const Probe *at, const WeftImage *own) {
    float d[2] = {0.0f, 0.0f};
    Stroke *brush = &v->states->drag.stroke;
    bool goes_on = brush->started && brush->material == at->material;
    if (brush->started && !goes_on) return; /* a stroke stays on its first material */
    edit_choose_material(v, at->material);
    if (!takes_strokes(v, at->material)) return;
    for (int k = 0; k < 3 && goes_on; k++) {
        d[0] += (at->position[k] - brush->at[k]) * at->tangent[k];
        d[1] += (at->position[k] - brush->at[k]) * at->bitangent[k];
    }
    bool moved = goes_on && hypotf(d[0], d[1]) > 0.05f * v->options->brush_radius;
    WeftImage *image;
    BrushedNap *nap = moved ? nap_copy(&v->edit->state, at->material, own->pixels ? own : NULL, &image) : NULL;
    if (nap) {
        lay_along(v, image, at, d);
        begin_nap(v, at->material);
        if (!edit_set_nap(v, nap)) viewer_report(v, true, "no more than %d materials can be brushed", STATE_NAPS);
    }
    if (goes_on && !moved) return;
    memcpy(brush->at, at->position, sizeof brush->at);
    memcpy(brush->uv, at->texcoord, sizeof brush->uv);
    brush->started = true;
    brush->material = at->material;
}

void stage_picked(Viewer *v, const RenderEvent *event) {
    const Probe *at = &event->probe;
    unsigned why = event->stamp % PICK_KINDS;
    if (!at->hit || at->material < 0 || at->material >= v->edit->state.material_count) {
        v->states->drag.stroke.started = false;
        return;
    }
    if (why == PICK_SELECT) {
        edit_choose_material(v, at->material);
        viewer_report(v, false, "%s", v->shown->facts.materials[at->material]);
    }
    if (why == PICK_BRUSH) brush_at(v, at, &event->image);
}

static bool line_dragged(const Viewer *v) { return v->drag->split || v->drag->wipe; }

static void begin_drag(Viewer *v, int button) {
    float middle = v->frame->stage.x + v->options->split_at * v->frame->stage.width;
    v->states->drag.light = button == LEFT ? handle_under(v) : -1;
    const PhotographView *photograph = &v->photographs->view;
    const float line = v->frame->stage.x + photograph->at * v->frame->stage.width;
    v->states->drag.wipe = button == LEFT && photograph->place == PHOTOGRAPH_WIPE && v->photographs->width &&
                           fabsf(v->frame->input.x - line) < 8.0f * ui_scale();
    v->states->drag.split = !v->states->drag.wipe && button == LEFT && v->edit->split == SPLIT_LINE &&
                            v->options->mode == MODE_LIVE && fabsf(v->frame->input.x - middle) < 8.0f * ui_scale();
    if (v->states->drag.wipe) v->states->drag.light = -1;
    if (v->states->drag.light >= 0) edit_choose_light(v, v->states->drag.light);
    v->states->drag.stroke.down =
        button == LEFT && v->options->tool == TOOL_BRUSH && v->states->drag.light < 0 && !line_dragged(v);
    v->states->drag.stroke.started = false;
    if (v->states->drag.stroke.down) pick(v, TASK_PICK, PICK_BRUSH);
    v->states->drag.press_x = v->frame->input.x, v->states->drag.press_y = v->frame->input.y;
    v->states->drag.moved = false;
}

static void rotate_environment(Viewer *v, float across) {
    EnvironmentState environment = v->edit->state.environment;
    environment.rotation = fmodf(environment.rotation + 180.0f * across, 360.0f);
    edit_set_environment(v, &environment);
}

static void drag(Viewer *v, float dx, float dy) {
    float across = dx / v->frame->stage.height, down = dy / v->frame->stage.height, speed = 3.5f;
    Orbit orbit = v->camera->orbit;
    bool pans = v->states->drag.pressed[MIDDLE] || (v->states->drag.pressed[LEFT] && v->frame->input.shift);
    if (v->states->drag.wipe) {
        PhotographView view = v->photographs->view;
        view.at = (v->frame->input.x - v->frame->stage.x) / v->frame->stage.width;
        photographs_set(v, &view);
    } else if (v->states->drag.split) {
        ViewOptions options = *v->options;
        options.split_at = (v->frame->input.x - v->frame->stage.x) / v->frame->stage.width;
        options_set(v, &options);
    } else if (v->states->drag.light >= 0) {
        drag_light(v);
    } else if (v->states->drag.stroke.down) {
        pick(v, TASK_PICK, PICK_BRUSH);
    } else if (pans) {
        orbit_pan(&orbit, across, down);
    } else if (v->states->drag.pressed[LEFT] && v->frame->input.control) {
        rotate_environment(v, across);
    } else if (v->states->drag.pressed[LEFT]) {
        orbit_rotate(&orbit, speed * across, speed * down);
    } else if (v->states->drag.pressed[RIGHT]) {
        orbit_look(&orbit, 1.5f * across, v->frame->settings.invert ? -1.5f * down : 1.5f * down);
    }
    camera_set(v, &orbit);
}

static void end_drag(Viewer *v, int button) {
    bool clicked = !v->states->drag.moved && button == LEFT && v->states->drag.light < 0 && !line_dragged(v);
    if (clicked && v->options->tool == TOOL_PROBE) pick(v, TASK_PROBE, 0);
    if (clicked && v->options->tool == TOOL_ORBIT) pick(v, TASK_PICK, PICK_SELECT);
    v->states->drag.light = -1;
    v->states->drag.split = v->states->drag.wipe = v->states->drag.stroke.down = false;
}

static void fly(Viewer *v) {
    const bool *key = v->frame->input.key;
    if (ui_types() || v->frame->input.control || v->frame->input.alt) return;
    float ahead = (float)key['W'] - (float)key['S'], right = (float)key['D'] - (float)key['A'];
    float rise = (float)key['E'] - (float)key['Q'];
    if (ahead == 0.0f && right == 0.0f && rise == 0.0f) return;
    float step =
        v->camera->reach * v->frame->settings.speed * v->frame->input.seconds * (v->frame->input.shift ? 4.0f : 1.0f);
    Orbit orbit = v->camera->orbit;
    orbit_fly(&orbit, step * ahead, step * right, step * rise);
    camera_set(v, &orbit);
}

void stage_begin(Viewer *v) { v->states->drag.light = -1; }

void stage_input(Viewer *v) {
    const UiInput *in = &v->frame->input;
    if (!v->shown->any) return;
    bool free_mouse = over_stage(v) && !ui_wants_mouse();
    for (int b = 0; b < 3; b++) {
        if (in->button[b] && !v->states->drag.pressed[b] && free_mouse) {
            v->states->drag.pressed[b] = true;
            begin_drag(v, b);
        } else if (!in->button[b] && v->states->drag.pressed[b]) {
            v->states->drag.pressed[b] = false;
            end_drag(v, b);
        }
    }
    bool down = v->states->drag.pressed[0] || v->states->drag.pressed[1] || v->states->drag.pressed[2];
    float dx = in->x - v->states->drag.last_x, dy = in->y - v->states->drag.last_y;
    v->states->drag.last_x = in->x, v->states->drag.last_y = in->y;
    if (down && hypotf(in->x - v->states->drag.press_x, in->y - v->states->drag.press_y) > 3.0f)
        v->states->drag.moved = true;
    if (down && v->states->drag.moved && (dx < 0.0f || dx > 0.0f || dy < 0.0f || dy > 0.0f)) drag(v, dx, dy);
    if (free_mouse && in->wheel != 0.0f) {
        Orbit orbit = v->camera->orbit;
        orbit_dolly(&orbit, powf(0.88f, in->wheel));
        camera_set(v, &orbit);
    }
    if (!ui_wants_keys()) fly(v);
}

static void tag(float x, float y, const char *text) {
    float pad = 5.0f * ui_scale(), width = ui_text_width(text);
    ui_fill((UiBox){x, y, width + 2.0f * pad, 22.0f * ui_scale()}, dark);
    ui_label(x + pad, y + 3.0f * ui_scale(), white, text);
}

static void draw_handles(const Viewer *v) {
    float at[2];
    for (int k = 0; k < v->edit->state.light_count && handles_shown(v); k++) {
        if (!handle_at(v, k, at)) continue;
        bool chosen = k == v->edit->light;
        ui_disc(at[0], at[1], 7.0f * ui_scale(), dark);
        ui_disc(at[0], at[1], 4.5f * ui_scale(), chosen ? accent : white);
        char number[12];
        snprintf(number, sizeof number, "%d", k + 1);
        ui_label(at[0] + 9.0f * ui_scale(), at[1] - 8.0f * ui_scale(), white, number);
    }
}

/* Writes the label of a side of A and B, "B  profile unreal4  (edited)", with the first choice of the material by which
 * they differ. */
static void name_side(const Viewer *v, int side, char text[128]) {
    bool edited = v->edit->side == side;
    const WeftMaterial *is = scene_state_material(edited ? &v->edit->state : &v->edit->other, v->edit->material),
                       *beside = scene_state_material(edited ? &v->edit->other : &v->edit->state, v->edit->material);
    int k = 0, length = snprintf(text, 128, "%c", side == 0 ? 'A' : 'B');
    while (weft_material_choice_name(k) && is->choices[k] == beside->choices[k]) k++;
    if (weft_material_choice_name(k))
        length += snprintf(text + length, 128 - (size_t)length, "  %s %s", weft_material_choice_name(k),
                           is->choices[k] < 0 ? "auto" : weft_material_choice_value(k, is->choices[k]));
    if (edited) snprintf(text + length, 128 - (size_t)length, "  (edited)");
}

static void draw_split(const Viewer *v) {
    const UiBox *s = &v->frame->stage;
    char text[128];
    if (v->edit->split == SPLIT_NONE || v->options->mode != MODE_LIVE) return;
    float x = s->x + floorf((v->edit->split == SPLIT_LINE ? v->options->split_at : 0.5f) * s->width);
    ui_line(x, s->y, x, s->y + s->height, 0xD0FFFFFFu, 1.0f);
    if (v->edit->split == SPLIT_LINE) ui_disc(x, s->y + 0.5f * s->height, 6.0f * ui_scale(), white);
    name_side(v, 0, text);
    tag(s->x + 8.0f * ui_scale(), s->y + 8.0f * ui_scale(), text);
    name_side(v, 1, text);
    tag(s->x + s->width - ui_text_width(text) - 20.0f * ui_scale(), s->y + 8.0f * ui_scale(), text);
}

static void draw_scale(const Viewer *v) {
    const UiBox *s = &v->frame->stage;
    char text[160];
    if (v->options->mode != MODE_DIFFERENCE || !v->requests->traced.compared) return;
    snprintf(text, sizeof text, "mean %.4f   relMSE %.5f   99%% within %.3f   %.0f spp",
             v->requests->traced.difference.mean, v->requests->traced.difference.relmse,
             (double)v->requests->traced.difference.high, v->requests->traced.samples);
    tag(s->x + 8.0f * ui_scale(), s->y + s->height - 32.0f * ui_scale(), text);
    snprintf(text, sizeof text, "blue: OpenGL is darker   red, yellow: brighter   ends at %.3f",
             (double)v->requests->traced.scale);
    tag(s->x + 8.0f * ui_scale(), s->y + s->height - 58.0f * ui_scale(), text);
}

static void draw_tags(const Viewer *v) {
    const UiBox *s = &v->frame->stage;
    char text[128] = "";
    if (v->options->mode == MODE_REFERENCE)
        snprintf(text, sizeof text, "path traced   %.0f of %d spp%s", v->requests->traced.samples, TRACE_SAMPLES,
                 v->requests->traced.denoised ? ", denoised" : "");
    else if (v->options->mode == MODE_DIFFERENCE)
        snprintf(text, sizeof text, "%s",
                 requests_shown(v) != SHOWS_TRACED ? "OpenGL before it is compared"
                 : v->requests->traced.compared    ? "OpenGL less path traced"
                                                   : "path traced before it is compared");
    else if (requests_shown(v) == SHOWS_TRACED)
        snprintf(text, sizeof text, "path traced while shaders compile   %.0f spp", v->requests->traced.samples);
    else if (requests_shown(v) == SHOWS_NOTHING && v->shown->any)
        snprintf(text, sizeof text, "shaders compile");
    else if (v->options->part != WEFT_PART_ALL)
        snprintf(text, sizeof text, "%s alone", weft_part_name((int)v->options->part));
    if (text[0]) tag(s->x + 8.0f * ui_scale(), s->y + 8.0f * ui_scale(), text);
    if (v->options->mode != MODE_LIVE && v->desc->shader_dir)
        tag(s->x + 8.0f * ui_scale(), s->y + 34.0f * ui_scale(),
            "shader text may be edited: OpenGL then differs from what is traced");
    if (v->options->tool == TOOL_BRUSH)
        tag(s->x + 8.0f * ui_scale(), s->y + s->height - 32.0f * ui_scale(), "brush: stroke the nap; B ends");
    if (v->options->tool == TOOL_PROBE)
        tag(s->x + 8.0f * ui_scale(), s->y + s->height - 32.0f * ui_scale(), "probe: click a pixel; P ends");
}

static void draw_progress(const Viewer *v) {
    const UiBox *s = &v->frame->stage;
    char text[64] = "reading";
    float fraction = loader_progress(v->opening->loader), width = 260.0f * ui_scale();
    UiBox box = {s->x + 0.5f * (s->width - width), s->y + 0.5f * s->height, width, 5.0f * ui_scale()};
    if (fraction >= 0.0f) snprintf(text, sizeof text, "reading %.0f %%", 100.0 * (double)fraction);
    tag(box.x, box.y - 30.0f * ui_scale(), text);
    ui_fill(box, dark);
    box.width *= fminf(fmaxf(fraction, 0.02f), 1.0f);
    ui_fill(box, accent);
}

static void draw_brush(const Viewer *v) {
    if (v->options->tool != TOOL_BRUSH || !over_stage(v) || ui_wants_mouse()) return;
    float d = 0.0f;
    for (int k = 0; k < 3; k++)
        d += (v->camera->orbit.eye[k] - v->camera->orbit.target[k]) *
             (v->camera->orbit.eye[k] - v->camera->orbit.target[k]);
    float height = 2.0f * sqrtf(d) * tanf(0.5f * v->camera->orbit.fov * (float)RADIANS);
    ui_ring(v->frame->input.x, v->frame->input.y,
            fmaxf(v->options->brush_radius / height * v->frame->stage.height, 2.0f), white);
}

void stage_draw(Viewer *v) {
    static const char welcome[] = "Drop a .glb or .gltf here, or File > Open ...";
    ui_behind(true);
    if (requests_shown(v) == SHOWS_TRACED)
        ui_picture(v->requests->reference_texture, v->frame->stage, false);
    else if (requests_shown(v) == SHOWS_DRAWN)
        ui_picture(v->requests->rendered.texture, v->frame->stage, true);
    if (requests_shown(v) == SHOWS_DRAWN && v->requests->glide)
        ui_picture_faint(v->requests->rendered.before, v->frame->stage, true, requests_glide(v));
    photographs_draw(v);
    ui_clip(&v->frame->stage);
    draw_split(v);
    draw_handles(v);
    draw_tags(v);
    draw_scale(v);
    draw_brush(v);
    if (v->opening->loader) draw_progress(v);
    if (!v->shown->any && !v->opening->loader && v->frame->stage.height > 40.0f)
        ui_label(v->frame->stage.x + 0.5f * (v->frame->stage.width - ui_text_width(welcome)),
                 v->frame->stage.y + 0.5f * v->frame->stage.height, white, welcome);
    ui_clip(NULL);
    ui_behind(false);
}
