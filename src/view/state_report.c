#define _POSIX_C_SOURCE 200809L
#include "view/state_report.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <jansson.h>

#include "view/panels/panels.h"
#include "view/panels/render_command.h"
#include "view/state/dialogs.h"
#include "view/state/edit.h"
#include "view/state/frame_requests.h"
#include "view/state/opening.h"
#include "view/state/photographs.h"
#include "view/state/view_camera.h"
#include "view/state/view_options.h"

/* Returns the resident memory, MiB. */
static double resident(void) {
    long pages = 0, all = 0;
    FILE *file = fopen("/proc/self/statm", "r");
    if (!file) return 0.0;
    if (fscanf(file, "%ld %ld", &all, &pages) != 2) pages = 0;
    fclose(file);
    return (double)pages * (double)sysconf(_SC_PAGESIZE) / (1024.0 * 1024.0);
}

static json_t *material_json(const Viewer *v, int index) {
    const WeftMaterial *m = scene_state_material(&v->edit->state, index);
    json_t *object = json_object();
    int preset = scene_state_preset(&v->edit->state, index);
    json_object_set_new(object, "name", json_string(v->shown->facts.materials[index]));
    json_object_set_new(object, "preset", json_string(preset ? weft_preset_name(preset - 1) : ""));
    json_object_set_new(object, "cloth", json_integer(m->cloth));
    for (int k = 0; weft_material_choice_name(k); k++) {
        const char *id = m->choices[k] < 0 ? "auto" : weft_material_choice_value(k, m->choices[k]);
        json_object_set_new(object, weft_material_choice_name(k), json_string(id ? id : ""));
    }
    for (int k = 0; weft_material_input_name(k); k++) {
        const WeftInput *i = &m->inputs[k];
        json_object_set_new(
            object, weft_material_input_name(k),
            json_pack("[f,f,f,i]", (double)i->value[0], (double)i->value[1], (double)i->value[2], i->texture));
    }
    return object;
}

static json_t *box_json(const UiBox *b) {
    return json_pack("[i,i,i,i]", (int)b->x, (int)b->y, (int)b->width, (int)b->height);
}

/* Lists the controls that have no tip. */
static json_t *unexplained_json(void) {
    json_t *array = json_array();
    for (int k = 0; k < ui_control_count(); k++)
        if (!ui_control(k)->explained) json_array_append_new(array, json_string(ui_control(k)->name));
    return array;
}

static json_t *controls_json(void) {
    json_t *object = json_object();
    for (int k = 0; k < ui_control_count(); k++)
        json_object_set_new(object, ui_control(k)->name, box_json(&ui_control(k)->box));
    return object;
}

void report_state(const Viewer *v) {
    static const char *const modes[] = {"live", "truth", "difference"};
    char camera[ORBIT_TEXT];
    json_t *materials = json_array();
    for (int k = 0; k < v->edit->state.material_count; k++) json_array_append_new(materials, material_json(v, k));
    char *unsaid = NULL, *command = v->shown->any ? command_line(v, &unsaid) : NULL;
    json_t *root = json_object();
    json_object_set_new(root, "frame", json_integer(v->frame->number));
    json_object_set_new(root, "clock", json_real(v->frame->clock));
    json_object_set_new(root, "rest", json_boolean(viewer_is_idle(v)));
    json_object_set_new(root, "scene", json_string(v->shown->any ? v->shown->facts.path : ""));
    json_object_set_new(root, "camera", json_string(orbit_text(&v->camera->orbit, camera)));
    json_object_set_new(root, "eye",
                        json_pack("[f,f,f]", (double)v->camera->orbit.eye[0], (double)v->camera->orbit.eye[1],
                                  (double)v->camera->orbit.eye[2]));
    json_object_set_new(root, "mode", json_string(modes[v->options->mode]));
    json_object_set_new(root, "shows", json_string(shows_name(requests_shown(v))));
    json_object_set_new(root, "split", json_integer((int)v->edit->split));
    json_object_set_new(root, "part", json_string(weft_part_name((int)v->options->part)));
    json_object_set_new(root, "material", json_integer(v->edit->material));
    json_object_set_new(root, "materials", materials);
    json_object_set_new(root, "lights", json_integer(v->edit->state.light_count));
    json_object_set_new(root, "rotation", json_real((double)v->edit->state.environment.rotation));
    json_object_set_new(root, "samples", json_real(v->requests->traced.samples));
    json_object_set_new(root, "summed", json_integer(v->requests->rendered.summed));
    bool compared = v->requests->traced.compared && v->requests->traced.samples > 0.0;
    json_object_set_new(root, "relmse", json_real(compared ? v->requests->traced.difference.relmse : -1.0));
    json_object_set_new(root, "message", json_string(v->frame->message));
    json_object_set_new(root, "complaint", json_string(v->requests->shader_complaint));
    json_object_set_new(root, "variant", json_integer(v->shown->any ? v->edit->state.variant : -1));
    json_object_set_new(root, "unsaid", json_string(unsaid ? unsaid : ""));
    json_object_set_new(root, "command", json_string(command ? command : ""));
    json_object_set_new(root, "driver", json_string(v->requests->rendered.driver));
    json_object_set_new(root, "picture", json_integer((json_int_t)v->requests->rendered.number));
    json_object_set_new(root, "picture_ms", json_real(1e3 * v->frame->picture_seconds));
    json_object_set_new(root, "frame_ms", json_real(1e3 * v->frame->frame_seconds));
    json_object_set_new(root, "worst_ms", json_real(1e3 * v->frame->worst_seconds));
    json_object_set_new(root, "resident_mib", json_real(resident()));
    const UiBox photograph = photographs_box(v);
    json_object_set_new(root, "photograph", json_string(v->photographs->path));
    json_object_set_new(root, "photograph_box", box_json(&photograph));
    float share[3];
    if (inspection_furnace(v->inspection, share))
        json_object_set_new(root, "furnace",
                            json_pack("[f,f,f]", (double)share[0], (double)share[1], (double)share[2]));
    json_object_set_new(root, "stage", box_json(&v->frame->stage));
    json_object_set_new(root, "help", json_boolean(v->dialogs->help));
    json_object_set_new(root, "untold", unexplained_json());
    json_object_set_new(root, "controls", controls_json());
    char *text = json_dumps(root, JSON_COMPACT | JSON_ENSURE_ASCII);
    if (text) puts(text);
    fflush(stdout);
    free(text);
    free(command);
    free(unsaid);
    json_decref(root);
}
