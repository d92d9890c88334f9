/* The panel with the findings of weft doctor for the open file. */
#include <stdio.h>
#include <string.h>

#include "base/path.h"
#include "view/panels/examine.h"
#include "view/panels/panels.h"
#include "view/state/edit.h"
#include "view/state/opening.h"
#include "view/state/view_options.h"
#include "weft/lobe.h"

/* Writes the names of the engines that a finding affects: "khronos, three". */
static void name_engines(unsigned engines, char *text, size_t size) {
    size_t used = 0;
    text[0] = '\0';
    for (int k = 0; weft_profile_name(k) && k < 32; k++) {
        if (!(engines >> k & 1u) || used >= size) continue;
        used += (size_t)snprintf(text + used, size - used, "%s%s", used ? ", " : "", weft_profile_name(k));
    }
}

/* Draws a finding's heading; a click on that of a material chooses the material. */
static void draw_heading(Viewer *v, const WeftFinding *f, int k) {
    char label[256], engines[200], tip[700];
    snprintf(label, sizeof label, "%s: %s, %.96s###finding %d", weft_severity_name(f->severity),
             weft_finding_name((int)f->kind), f->subject, k);
    bool chooses = f->of == WEFT_OF_MATERIAL && f->index < v->edit->state.material_count;
    if (ui_selectable(label, chooses && f->index == v->edit->material) && chooses) {
        edit_choose_material(v, f->index);
        viewer_report(v, false, "%s", v->shown->facts.materials[f->index]);
    }
    name_engines(f->engines, engines, sizeof engines);
    snprintf(tip, sizeof tip, "%s.\nIn the file: %s%s%s%s", weft_finding_help((int)f->kind), f->place,
             engines[0] ? "\nIn " : "", engines, chooses ? "\nA click chooses the material." : "");
    ui_tip(tip);
}

static void draw_findings(Viewer *v, const WeftDoctor *doctor) {
    char text[96];
    int count = weft_doctor_count(doctor);
    snprintf(text, sizeof text,
             count == 1 ? "%d finding about the file, as it is saved"
             : count    ? "%d findings about the file, as it is saved"
                        : "nothing is wrong with the file, as it is saved",
             count);
    ui_dim(text);
    for (int k = 0; k < count; k++) {
        const WeftFinding *f = weft_doctor_finding(doctor, k);
        draw_heading(v, f, k);
        if (f->severity == WEFT_SEVERITY_NOTE)
            ui_wrapped(f->words);
        else
            ui_warning(f->words);
        ui_dim(f->fix);
        ui_rule();
    }
}

static bool is_file(const Viewer *v) { return !path_builtin(v->shown->facts.path); }

bool doctor_busy(const Viewer *v) {
    return v->options->panel == PANEL_DOCTOR && v->shown->any && is_file(v) &&
           !(v->examination && examination_done(v->examination));
}

void doctor_forget(Viewer *v) {
    examination_free(v->examination);
    v->examination = NULL;
}

void doctor_panel(Viewer *v) {
    if (!is_file(v)) {
        ui_dim("A built-in scene is no file: there is nothing to examine.");
        return;
    }
    if (!v->examination) v->examination = examination_start(v->window, v->shown->facts.path);
    if (!v->examination || !examination_done(v->examination))
        ui_progress(-1.0f, "examining");
    else if (examination_doctor(v->examination))
        draw_findings(v, examination_doctor(v->examination));
    else
        ui_warning(examination_failure(v->examination));
}
