#include "view/panels/render_command.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/path.h"
#include "base/pi.h"
#include "view/state/dialogs.h"
#include "view/state/edit.h"
#include "view/state/frame_requests.h"
#include "view/state/opening.h"
#include "view/state/view_camera.h"
#include "view/state/view_options.h"

typedef struct Line {
    char *text;
    size_t used, size;
    bool short_of_memory;
} Line;

static void put(Line *line, const char *format, ...) {
    va_list list;
    va_start(list, format);
    int more = vsnprintf(line->text + line->used, line->size - line->used, format, list);
    va_end(list);
    if (more >= 0 && (size_t)more < line->size - line->used) {
        line->used += (size_t)more;
        return;
    }
    size_t size = 2 * line->size + (size_t)(more > 0 ? more : 0);
    char *grown = realloc(line->text, size);
    if (!grown) {
        line->short_of_memory = true;
        return;
    }
    line->text = grown, line->size = size;
    va_start(list, format);
    line->used += (size_t)vsnprintf(line->text + line->used, line->size - line->used, format, list);
    va_end(list);
}

/* Writes a word as a shell reads it. */
static void put_word(Line *line, const char *word) {
    if (word[0] &&
        strspn(word, "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_./:=,-+%@") == strlen(word)) {
        put(line, " %s", word);
        return;
    }
    put(line, " '");
    for (; *word; word++)
        if (*word == '\'')
            put(line, "'\\''");
        else
            put(line, "%c", *word);
    put(line, "'");
}

static bool differs(float a, float b) { return a < b || a > b; }

static void put_input(Line *line, int material, int k, const WeftInput *input) {
    WeftInputInfo info;
    char word[160];
    weft_material_input_info(k, &info);
    const float *x = input->value;
    double scale = info.kind == WEFT_INPUT_ANGLE || info.kind == WEFT_INPUT_DIRECTION ? 1.0 / RADIANS : 1.0;
    if (info.kind == WEFT_INPUT_COLOR)
        snprintf(word, sizeof word, "%d.%s=%.9g,%.9g,%.9g", material, info.name, (double)x[0], (double)x[1],
                 (double)x[2]);
    else
        snprintf(word, sizeof word, "%d.%s=%.9g", material, info.name, scale * (double)x[0]);
    put(line, " --set");
    put_word(line, word);
}

/* Writes the weave of a material. It replaces the material's other inputs, so it comes before these. */
static void put_weave(Line *line, int material, const char *text) {
    const size_t size = strlen(text) + 32;
    char *word = malloc(size);
    if (!word) {
        line->short_of_memory = true;
        return;
    }
    snprintf(word, size, "%d.weave=%s", material, text);
    put(line, " --set");
    put_word(line, word);
    free(word);
}

/* Returns true if an input is what --texture makes of it: its map alone. */
static bool is_map_alone(int k, const WeftInput *input) {
    static const float identity[6] = {1.0f, 0.0f, 0.0f, 0.0f, 1.0f, 0.0f};
    WeftInputInfo info;
    weft_material_input_info(k, &info);
    const float one = info.kind == WEFT_INPUT_DIRECTION ? 0.0f : 1.0f;
    bool alone = input->texcoord == 0;
    for (int c = 0; c < 6; c++) alone = alone && !differs(input->transform[c], identity[c]);
    for (int c = 0; c < (info.kind == WEFT_INPUT_COLOR ? 3 : 1); c++) alone = alone && !differs(input->value[c], one);
    return alone;
}

/* Writes the map of an input that was put on since; false if --texture cannot say it. */
static bool put_map(Line *line, const Facts *facts, int material, int k, const WeftInput *input) {
    char word[STATE_PATH + 96];
    const int map = input->texture - 1;
    const char *path = map < facts->map_count && facts->map_paths ? facts->map_paths[map] : NULL;
    if (!path || !is_map_alone(k, input)) return false;
    const char channel[3] = {'.', "rgba"[input->channel & 3], '\0'};
    snprintf(word, sizeof word, "%d.%s%s=%s", material, weft_material_input_name(k), input->channel ? channel : "",
             path);
    put(line, " --texture");
    put_word(line, word);
    return true;
}

/* Writes the inputs of a material that differ from those that it has by then. woven: it is woven on the way. */
static void put_inputs(Line *line, Line *unsaid, const Viewer *v, int index, const WeftMaterial *was, bool woven) {
    const WeftMaterial *is = scene_state_material(&v->edit->state, index);
    for (int k = 0; weft_material_input_name(k); k++) {
        const WeftInput *a = &was->inputs[k], *b = &is->inputs[k];
        const bool other = a->texture != b->texture;
        bool changed = other;
        for (int c = 0; c < 3; c++) changed = changed || differs(a->value[c], b->value[c]);
        if (!changed) continue;
        if (!b->texture)
            put_input(line, index, k, b);
        else if (!other) /* --set would drop the map */
            put(unsaid, "%s of %s, by which its map is multiplied\n", weft_material_input_name(k),
                v->shown->facts.materials[index]);
        else if (woven || !put_map(line, &v->shown->facts, index, k, b))
            put(unsaid, "the map of %s of %s\n", weft_material_input_name(k), v->shown->facts.materials[index]);
    }
}

/* Notes what no option of a command line sets. */
static void note_unsaid(Line *unsaid, const Viewer *v, int index) {
    const WeftMaterial *was = scene_state_material(&v->edit->first, index),
                       *is = scene_state_material(&v->edit->state, index);
    const int opacity = weft_material_input_find("opacity");
    const char *name = v->shown->facts.materials ? v->shown->facts.materials[index] : "";
    if (is->alpha_mode != was->alpha_mode && !differs(is->inputs[opacity].value[0], was->inputs[opacity].value[0]))
        put(unsaid, "that %s is %s\n", name, is->alpha_mode == WEFT_ALPHA_OPAQUE ? "opaque" : "cut out or blended");
    if (differs(is->alpha_cutoff, was->alpha_cutoff)) put(unsaid, "where %s is cut out\n", name);
    if (is->unlit != was->unlit) put(unsaid, "that %s is %s\n", name, is->unlit ? "unlit" : "lit");
    if (is->double_sided != was->double_sided)
        put(unsaid, "that %s has %s\n", name, is->double_sided ? "two sides" : "one side");
    if (is->measured != was->measured) put(unsaid, "the measurement of %s\n", name);
    if (scene_state_nap(&v->edit->state, index)) put(unsaid, "the brushed nap of %s\n", name);
}

/* Writes the changes of a material since it was read; choices first, since they move inputs. */
static void put_material(Line *line, Line *unsaid, const Viewer *v, int index) {
    WeftMaterial was = *scene_state_material(&v->edit->first, index);
    const WeftMaterial *is = scene_state_material(&v->edit->state, index);
    for (int k = 0; weft_material_choice_name(k); k++) {
        if (is->choices[k] == was.choices[k]) continue;
        const char *id = is->choices[k] < 0 ? "auto" : weft_material_choice_value(k, is->choices[k]);
        put(line, " --set %d.%s=%s", index, weft_material_choice_name(k), id);
        weft_material_choose(&was, k, is->choices[k]);
    }
    const bool woven = is->cloth != was.cloth;
    if (woven) {
        const Facts *facts = &v->shown->facts;
        const char *text = is->cloth > 0 && is->cloth <= facts->cloth_count ? facts->cloths[is->cloth - 1].text : NULL;
        if (text)
            put_weave(line, index, text);
        else
            put(unsaid, is->cloth ? "the weave of %s\n" : "that %s is no longer woven\n", facts->materials[index]);
    }
    for (int k = 0; k < WEFT_HAIR_NUMBERS; k++)
        if (differs(is->hair[k], was.hair[k]))
            put(line, " --set %d.%s=%.9g", index, weft_material_hair_name(k), (double)is->hair[k]);
    note_unsaid(unsaid, v, index);
    put_inputs(line, unsaid, v, index, &was, woven);
}

static void put_light(Line *line, const WeftLight *l) {
    const float *p = l->position, *d = l->direction, *c = l->color;
    char word[640], place[120], way[120], color[120];
    snprintf(place, sizeof place, "%.9g,%.9g,%.9g", (double)p[0], (double)p[1], (double)p[2]);
    snprintf(way, sizeof way, "%.9g,%.9g,%.9g", (double)d[0], (double)d[1], (double)d[2]);
    snprintf(color, sizeof color, "%.9g,%.9g,%.9g", (double)c[0], (double)c[1], (double)c[2]);
    switch (l->kind) {
    case WEFT_LIGHT_DIRECTIONAL: snprintf(word, sizeof word, "sun;%s;%s", way, color); break;
    case WEFT_LIGHT_POINT: snprintf(word, sizeof word, "point;%s;%s", place, color); break;
    case WEFT_LIGHT_SPOT:
        snprintf(word, sizeof word, "spot;%s;%s;%s;%.9g,%.9g", place, way, color, (double)l->inner, (double)l->outer);
        break;
    case WEFT_LIGHT_POLYGON:
        snprintf(word, sizeof word, "polygon;%s;%s;%.9g,%.9g;%s;%d,%.9g", place, way, (double)l->size[0],
                 (double)l->size[1], color, l->corners, (double)l->roll);
        break;
    }
    put(line, " --light");
    put_word(line, word);
}

static void put_lights(Line *line, const Viewer *v) {
    const SceneState *a = &v->edit->first, *b = &v->edit->state;
    if (a->light_count == b->light_count &&
        memcmp(a->lights, b->lights, (size_t)a->light_count * sizeof *a->lights) == 0)
        return;
    put(line, " --light none");
    for (int k = 0; k < b->light_count; k++) put_light(line, &b->lights[k]);
}

static void put_environment(Line *line, const EnvironmentState *a) {
    if (a->kind == ENVIRONMENT_FILE) {
        put(line, " --env");
        put_word(line, a->path);
    }
    if (a->kind == ENVIRONMENT_COLOR)
        put(line, " --env %.9g,%.9g,%.9g", (double)a->color[0], (double)a->color[1], (double)a->color[2]);
    if (differs(a->rotation, 0.0f)) put(line, " --env-rotation %.9g", (double)a->rotation);
    if (differs(a->strength, 1.0f)) put(line, " --env-strength %.9g", (double)a->strength);
    if (differs(a->ambient, 1.0f)) put(line, " --env-ambient %.9g", (double)a->ambient);
    if (differs(a->reflection, 1.0f)) put(line, " --env-reflection %.9g", (double)a->reflection);
}

static void put_view(Line *line, const Viewer *v) {
    static const char *const backs[] = {"auto", "environment", "transparent", "", "blurred"};
    static const char *const ambients[] = {"best", "irradiance", "mirror", "fitted", "none"};
    char camera[ORBIT_TEXT];
    int width, height;
    requests_picture_size(v, &width, &height);
    put(line, " --width %d --height %d --camera", width, height);
    put_word(line, orbit_text(&v->camera->orbit, camera));
    if (v->options->background == WEFT_BACKGROUND_COLOR)
        put(line, " --background %.9g,%.9g,%.9g", (double)v->options->background_color[0],
            (double)v->options->background_color[1], (double)v->options->background_color[2]);
    else if (v->options->background != WEFT_BACKGROUND_AUTO)
        put(line, " --background %s", backs[v->options->background]);
    if (v->options->floor.on)
        put(line, " --floor --floor-reflection %.9g --floor-roughness %.9g", (double)v->options->floor.reflection,
            (double)v->options->floor.roughness);
    else if (!path_builtin(v->shown->facts.path))
        put(line, " --stage none");
    if (v->options->hide_lights) put(line, " --hide-lights");
    if (differs(v->options->exposure, 0.0f)) put(line, " --exposure %.9g", (double)v->options->exposure);
    if (v->options->tonemap != WEFT_TONEMAP_PBR_NEUTRAL)
        put(line, " --tonemap %s", weft_tonemap_name((int)v->options->tonemap));
    float white[2];
    options_white(v->options, white);
    if (v->options->balanced)
        put(line, " --white-balance auto");
    else if (white[1] > 0.0f)
        put(line, " --white-balance %.9g,%.9g", (double)v->options->kelvin, (double)v->options->tint);
    if (v->options->mode != MODE_LIVE) {
        put(line, v->options->mode == MODE_DIFFERENCE ? " --engine both --halves --spp %d" : " --halves --spp %d",
            v->requests->traced.samples >= 1.0 ? (int)v->requests->traced.samples : 64);
        return;
    }
    put(line, " --engine raster");
    if (v->options->part != WEFT_PART_ALL) put(line, " --part %s", weft_part_name((int)v->options->part));
    if (v->options->ambient != WEFT_AMBIENT_BEST) put(line, " --ambient %s", ambients[v->options->ambient]);
}

/* Writes all of the line, but what it cannot say. */
static void put_line(Line *line, Line *unsaid, const Viewer *v) {
    const SceneState *is = &v->edit->state, *was = &v->edit->first;
    const bool configured = strcmp(v->opening->configured, v->shown->facts.path) == 0;
    put(line, "weft render");
    put_word(line, v->shown->facts.path);
    for (int k = 0; k < v->opening->lobe_count; k++) {
        put(line, " --lobe");
        put_word(line, v->opening->lobes[k]);
    }
    if (v->desc->options && v->desc->options[0] && configured) put(line, " %s", v->desc->options);
    if (v->desc->materials && configured) { /* these are put on at the start */
        put(line, " --materials");
        put_word(line, v->desc->materials);
    }
    if (is->variant < 0 && was->variant >= 0) put(unsaid, "that no variant is worn\n");
    if (is->variant != was->variant && is->variant >= 0) {
        put(line, " --variant");
        put_word(line, v->shown->facts.variants[is->variant]);
    }
    for (int k = 0; k < is->material_count && k < was->material_count; k++) put_material(line, unsaid, v, k);
    put_lights(line, v);
    put_environment(line, &is->environment);
    put_view(line, v);
    if (v->edit->split != SPLIT_NONE && v->options->mode == MODE_LIVE)
        put(unsaid, "%c of A and B, beside which it is shown\n", v->edit->side ? 'A' : 'B');
    put(line, " -o picture.png");
}

char *command_line(const Viewer *v, char **unsaid) {
    Line line = {.text = calloc(1, 1024), .size = 1024}, left = {.text = calloc(1, 256), .size = 256};
    if (unsaid) *unsaid = NULL;
    if (line.text && left.text) put_line(&line, &left, v);
    const bool good = line.text && left.text && !line.short_of_memory && !left.short_of_memory;
    if (!good || !unsaid) {
        free(left.text);
        left.text = NULL;
    }
    if (good && unsaid) *unsaid = left.text;
    if (good) return line.text;
    free(line.text);
    return NULL;
}

char *command_said(const Viewer *v) {
    char *unsaid, *line = command_line(v, &unsaid);
    Line text = {.text = calloc(1, 1024), .size = 1024};
    if (line && text.text) {
        put(&text, "%s\n", line);
        for (char *from = unsaid, *end; (end = strchr(from, '\n')); from = end + 1)
            put(&text, "# not in this line: %.*s\n", (int)(end - from), from);
    }
    const bool good = line && text.text && !text.short_of_memory;
    free(line);
    free(unsaid);
    if (good) return text.text;
    free(text.text);
    return NULL;
}

void command_copy(Viewer *v) {
    char *unsaid, *line = command_line(v, &unsaid), *text = command_said(v);
    if (line && text) {
        const UiClipboard *clip = window_clipboard(v->window);
        clip->set(clip->user, text);
        dialogs_show_unsaid(v, unsaid);
        viewer_report(v, unsaid[0] != '\0',
                      unsaid[0] ? "copied, but for what the window lists: save the scene and render that"
                                : "copied: %.400s",
                      line);
    }
    free(line);
    free(unsaid);
    free(text);
}
