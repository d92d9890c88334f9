/* The window of presets: pictures in groups, a search, and the materials of the user's own. */
#define _GNU_SOURCE /* strcasestr */
#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <epoxy/gl.h>

#include "view/files/user_files.h"
#include "view/panels/panels.h"
#include "view/render/thumbs.h"
#include "view/state/actions.h"
#include "view/state/edit.h"
#include "view/state/opening.h"

static const char own_group[] = "own";

/* A material to choose. */
typedef struct PresetRow {
    char name[64], path[USER_PATH];
    const char *group, *help;
    unsigned long long stamp; /* of the file; 0: a preset */
    unsigned texture;         /* owned; 0: not yet made */
    char failure[512];        /* the reason why there will be none */
} PresetRow;

typedef struct PresetWindow {
    bool open;
    PresetRow *rows; /* those of the user come after the presets */
    int count;
    Thumbs *thumbs;
    double read; /* when the user's folder was read, s */
    char search[64], name[64];
} PresetWindow;

static void free_rows(PresetRow *rows, int count) {
    for (int k = 0; k < count; k++) glDeleteTextures(1, &rows[k].texture);
    free(rows);
}

void presets_free(PresetWindow *self) {
    if (!self) return;
    thumbs_stop(self->thumbs);
    free_rows(self->rows, self->count);
    free(self);
}

static PresetRow preset_row(int k) {
    PresetRow row = {.group = weft_preset_group(k), .help = weft_preset_help(k)};
    snprintf(row.name, sizeof row.name, "%s", weft_preset_name(k));
    snprintf(row.path, sizeof row.path, "preset:%s", weft_preset_name(k));
    return row;
}

static PresetRow own_row(const OwnMaterial *own) {
    PresetRow row = {.group = own_group, .help = "", .stamp = own->stamp};
    snprintf(row.name, sizeof row.name, "%s", own->name);
    snprintf(row.path, sizeof row.path, "%s", own->path);
    return row;
}

/* Moves the pictures of files that have not changed to the new rows. */
static void keep_pictures(PresetWindow *self, PresetRow *rows, int count) {
    for (int k = 0; k < count; k++)
        for (int j = 0; j < self->count; j++) {
            PresetRow *was = &self->rows[j];
            if (was->stamp != rows[k].stamp || strcmp(was->path, rows[k].path) != 0) continue;
            rows[k].texture = was->texture;
            memcpy(rows[k].failure, was->failure, sizeof was->failure);
            was->texture = 0;
        }
}

static void start_thumbs(Viewer *v, PresetWindow *self) {
    const char **paths = calloc((size_t)self->count + 1, sizeof *paths);
    for (int k = 0; paths && k < self->count; k++) paths[k] = self->rows[k].path;
    thumbs_stop(self->thumbs);
    self->thumbs = paths ? thumbs_start(v->window, paths, self->count) : NULL;
    free(paths);
}

/* Makes the rows of the presets and of the user's files, unless they are the present ones. */
static void read_rows(Viewer *v, PresetWindow *self) {
    int presets = 0, own_count;
    OwnMaterial *own = user_materials_list(&own_count);
    while (weft_preset_name(presets)) presets++;
    const int count = presets + own_count;
    PresetRow *rows = calloc((size_t)count + 1, sizeof *rows);
    for (int k = 0; rows && k < count; k++) rows[k] = k < presets ? preset_row(k) : own_row(&own[k - presets]);
    free(own);
    bool same = rows && count == self->count;
    for (int k = 0; same && k < count; k++)
        same = rows[k].stamp == self->rows[k].stamp && strcmp(rows[k].path, self->rows[k].path) == 0;
    if (!rows || same) {
        free(rows);
        return;
    }
    keep_pictures(self, rows, count);
    free_rows(self->rows, self->count);
    self->rows = rows;
    self->count = count;
    start_thumbs(v, self);
}

void presets_show(Viewer *v) {
    if (!v->presets) v->presets = calloc(1, sizeof *v->presets);
    if (!v->presets) return;
    v->presets->open = true;
    v->presets->read = -1.0;
}

void presets_hide(Viewer *v) {
    if (v->presets) v->presets->open = false;
}

bool presets_busy(const Viewer *v) { return v->presets && v->presets->thumbs && thumbs_busy(v->presets->thumbs); }

bool presets_poll(Viewer *v) {
    PresetWindow *self = v->presets;
    Thumb thumb;
    bool changed = false;
    while (self && self->thumbs && thumbs_take(self->thumbs, &thumb)) {
        PresetRow *row = &self->rows[thumb.index];
        if (thumb.image.pixels) viewer_upload(&row->texture, &thumb.image);
        snprintf(row->failure, sizeof row->failure, "%s", thumb.failure);
        weft_image_free(&thumb.image);
        changed = true;
    }
    return changed;
}

/* Returns true if a word of the text begins so, in any case. */
static bool has_word(const char *text, const char *begin) {
    for (const char *at = text; (at = strcasestr(at, begin)); at++)
        if (at == text || !isalnum((unsigned char)at[-1])) return true;
    return false;
}

/* Returns true if the row's name, group and help have every word of the search. */
static bool is_found(const PresetRow *row, const char *search) {
    char words[64], about[512], *rest = words;
    snprintf(words, sizeof words, "%s", search);
    snprintf(about, sizeof about, "%s %s %s", row->name, row->group, row->help);
    for (char *word; (word = strtok_r(rest, " ", &rest));)
        if (!has_word(about, word)) return false;
    return true;
}

static void choose(Viewer *v, const PresetRow *row) {
    if (row->failure[0])
        viewer_report(v, true, "%s", row->failure);
    else
        actions_send(v, TASK_ASSIGN, row->path, v->edit->material, -1);
}

/* Draws a picture with its name, or words beside it in the list that a search leaves. */
static void draw_row(Viewer *v, PresetRow *row, int k, float side, bool listed) {
    char label[96], tip[1024];
    const int preset = scene_state_preset(&v->edit->state, v->edit->material);
    const bool own = row->stamp != 0;
    const char *words = row->failure[0] ? row->failure : own ? row->path : row->help;
    if (!row->texture && !row->failure[0] && v->presets->thumbs && ui_will_be_seen(side, side))
        thumbs_want(v->presets->thumbs, k);
    snprintf(label, sizeof label, own ? "own/%s" : "%s", row->name);
    snprintf(tip, sizeof tip, "%s\n%.500s", row->name, words);
    const char *caption = row->failure[0] ? "cannot be read" : listed ? "" : row->name;
    if (ui_tile(label, row->texture, side, caption, !own && preset == k + 1)) choose(v, row);
    ui_tip_picture(tip, row->texture, (float)THUMB_SIDE * ui_scale());
    if (listed) ui_words_beside(row->name, words);
}

static int count_found(const PresetWindow *self, const char *group) {
    int found = 0;
    for (int k = 0; k < self->count; k++)
        found += (!group || strcmp(self->rows[k].group, group) == 0) && is_found(&self->rows[k], self->search);
    return found;
}

/* Draws the rows of a group that the search finds. */
static void draw_group(Viewer *v, const char *group, const char *help) {
    PresetWindow *self = v->presets;
    const float least = 0.5f * (float)THUMB_SIDE * ui_scale(), gap = 6.0f * ui_scale();
    const bool listed = self->search[0] != '\0';
    const int found = count_found(self, group);
    char label[64];
    int shown = 0;
    if (!found) return;
    snprintf(label, sizeof label, "%s (%d)###%s", group, found, group);
    if (!ui_section(label, true)) return;
    if (!listed) ui_dim(help);
    const int across = listed ? 1 : (int)fmaxf((ui_width_left() + gap) / (least + gap), 1.0f);
    const float side = listed ? least : floorf((ui_width_left() + gap) / (float)across - gap);
    for (int k = 0; k < self->count; k++) {
        PresetRow *row = &self->rows[k];
        if (strcmp(row->group, group) != 0 || !is_found(row, self->search)) continue;
        if (shown++ % across) ui_same_line();
        draw_row(v, row, k, side, listed);
    }
}

/* Draws what saves the edited material into the user's folder. */
static void draw_save(Viewer *v) {
    PresetWindow *self = v->presets;
    char folder[USER_PATH] = "", path[USER_PATH + 80], tip[USER_PATH + 80];
    const bool there = user_materials(folder, false);
    snprintf(path, sizeof path, "%s/%s.json", folder, self->name);
    snprintf(tip, sizeof tip, "Keeps the edited material as a file of %s; remove it there.", there ? folder : "yours");
    const bool good = there && self->name[0] && self->name[0] != '.' && !strchr(self->name, '/');
    const bool entered = ui_input("name", self->name, sizeof self->name);
    ui_tip("Of the edited material, as one of your own.");
    bool known = false;
    for (int k = 0; k < self->count; k++) known |= strcmp(self->rows[k].path, path) == 0;
    ui_disabled(!good);
    const bool pressed = ui_button(known ? "Replace the preset###Save as preset" : "Save as preset");
    ui_disabled_end();
    ui_tip(tip);
    if (!(pressed || entered)) return;
    if (known && !pressed) {
        viewer_report(v, true, "a preset \"%.60s\" of yours is there: press Replace, or give another name", self->name);
    } else if (!good) {
        viewer_report(v, true, "\"%.60s\" is no name for a file: no / in it, and no . before it", self->name);
    } else if (user_materials(folder, true)) {
        actions_send(v, TASK_SAVE, path, v->edit->material, -1);
    }
}

static void draw_rows(Viewer *v) {
    ui_scope("Material");
    ui_scope("preset");
    draw_group(v, own_group, "materials of your own");
    for (int g = 0; weft_preset_group_name(g); g++) draw_group(v, weft_preset_group_name(g), weft_preset_group_help(g));
    ui_scope_end();
    ui_scope_end();
    if (!count_found(v->presets, NULL)) ui_dim("Nothing has all of these words.");
}

void presets_draw(Viewer *v) {
    PresetWindow *self = v->presets;
    const float s = ui_scale(), below = 2.2f * ui_line_height();
    enum { WIDTH = 600, HEIGHT = 560 };
    int step;
    if (self && self->thumbs) thumbs_forget(self->thumbs); /* only what is seen is made */
    if (!self || !self->open || !v->shown->any || !v->edit->state.material_count) return;
    if (v->frame->clock - self->read > 0.5 || self->read < 0.0) {
        read_rows(v, self);
        self->read = v->frame->clock;
    }
    const UiBox stage = v->frame->stage,
                first = {stage.x + 8.0f * s, stage.y + 8.0f * s, fminf(WIDTH * s, stage.width - 16.0f * s),
                         fminf(HEIGHT * s, stage.height - 16.0f * s)};
    if (ui_window("Presets", first, &self->open)) {
        ui_scope("Presets");
        ui_search("search", "search: denim, pile, Irawan ...", self->search, sizeof self->search, false, &step);
        ui_tip("Shows those whose name, group or line has words that begin so.");
        ui_scope_end();
        if (ui_list("rows", 0.0f, -below)) draw_rows(v);
        ui_list_end();
        ui_scope("Presets");
        draw_save(v);
        ui_scope_end();
    }
    ui_window_end();
}
