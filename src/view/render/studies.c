#include "view/render/studies.h"

#include <stdio.h>
#include <string.h>

#include "weft/sheet.h"

enum { WIDTH = 300, COLUMNS = 4 };

void study_start(Study *self, const SceneState *state, int material, const WeftRasterView *view, const char *camera,
                 const WeftTone *tone, unsigned stamp) {
    study_stop(self);
    if (material < 0 || material >= state->material_count || !scene_state_copy(&self->state, state)) return;
    self->material = material;
    self->under_way = true;
    self->stamp = stamp;
    self->view = *view;
    self->view.part = WEFT_PART_ALL;
    self->view.height = WIDTH * view->height / view->width;
    self->view.width = WIDTH;
    if (self->view.height < 1) self->view.height = 1;
    if (self->view.height > 2 * WIDTH) self->view.height = 2 * WIDTH;
    snprintf(self->camera, sizeof self->camera, "%s", camera);
    self->tone = *tone;
}

void study_stop(Study *self) {
    for (int k = 0; k < STUDY_MOST; k++) weft_image_free(&self->pictures[k]);
    scene_state_free(&self->state);
    memset(self, 0, sizeof *self);
}

bool study_state(const Study *self, SceneState *state) {
    if (!scene_state_copy(state, &self->state)) {
        *state = (SceneState){0};
        return false;
    }
    WeftMaterial m = *scene_state_material(state, self->material);
    weft_material_choose(&m, weft_material_choice_find("profile"), self->next - 1);
    return scene_state_set_material(state, self->material, &m);
}

WeftRasterView study_view(const Study *self) {
    WeftRasterView view = self->view;
    view.camera = self->camera;
    return view;
}

void study_add(Study *self, WeftImage *linear) {
    weft_image_show(linear, &self->tone, NULL, &self->pictures[self->next++], NULL);
    weft_image_free(linear);
}

bool study_done(const Study *self) {
    int profile = weft_material_choice_find("profile");
    return self->next == STUDY_MOST || (self->next > 0 && !weft_material_choice_value(profile, self->next - 1));
}

bool study_sheet(const Study *self, WeftImage *sheet) {
    WeftPanel panels[STUDY_MOST] = {0};
    for (int k = 0; k < self->next; k++) {
        panels[k].image = self->pictures[k].pixels ? &self->pictures[k] : NULL;
        panels[k].title = k ? weft_material_choice_value(weft_material_choice_find("profile"), k - 1) : "weft";
    }
    const WeftSheetDesc desc = {.panels = panels, .count = self->next, .columns = COLUMNS};
    return weft_sheet_compose(&desc, sheet, NULL) == WEFT_OK;
}
