#include "view/ui/swatches.h"

#include <stdbool.h>
#include <stdio.h>
#include <string.h>

#include "view/ui/ui.h"
#include "weft/chart.h"
#include "weft/reflection.h"

/* The input for the F0 of a dielectric in each workflow; the last row is for all others. */
static const struct {
    const char *workflow, *input;
} f0_inputs[] = {{"disney", "specular"}, {"specular", "specular_color"}, {"free", "specular_color"}, {NULL, "ior"}};

static const char *workflow_of(const WeftMaterial *m) {
    int choice = weft_material_choice_find("workflow"), value = m->choices[choice];
    return value < 0 ? "" : weft_material_choice_value(choice, value);
}

static const char *f0_input(const WeftMaterial *m) {
    const char *workflow = workflow_of(m);
    int k = 0;
    while (f0_inputs[k].workflow && strcmp(f0_inputs[k].workflow, workflow) != 0) k++;
    return f0_inputs[k].input;
}

static void put(WeftMaterial *m, const char *input, const float color[3], float scale) {
    WeftInput *to = &m->inputs[weft_material_input_find(input)];
    for (int c = 0; c < 3; c++) to->value[c] = scale * color[c];
    to->given = 1;
}

/* Sets the base colour. A metal's colour is its reflectance: the base is black where the workflow has a separate F0. */
static void put_base(WeftMaterial *m, const WeftChartEntry *e) {
    static const float black[3] = {0.0f, 0.0f, 0.0f};
    bool metal = e->kind == WEFT_CHART_METAL, separate_f0 = strcmp(f0_input(m), "specular_color") == 0;
    const float metallic[3] = {metal ? 1.0f : 0.0f, 0.0f, 0.0f};
    put(m, "base_color", metal && separate_f0 ? black : e->base_color, 1.0f);
    if (!separate_f0) put(m, "metallic", metallic, 1.0f);
    if (metal && separate_f0) put(m, "specular_color", e->f0, 1.0f);
}

static void put_f0(WeftMaterial *m, const WeftChartEntry *e, const char *input) {
    const float ior[3] = {e->ior, 0.0f, 0.0f};
    if (strcmp(input, "ior") == 0)
        put(m, input, ior, 1.0f);
    else
        put(m, input, e->f0, strcmp(input, "specular") == 0 ? 1.0f / 0.08f : 1.0f);
}

/* Returns true if the entry has a value for the input: clear materials have no base colour, metals no
 * index of refraction. */
static bool has_swatch(const WeftChartEntry *e, const char *input) {
    if (strcmp(input, "base_color") == 0) return e->kind == WEFT_CHART_OPAQUE || e->kind == WEFT_CHART_METAL;
    return e->kind != WEFT_CHART_METAL || strcmp(input, "specular_color") == 0;
}

static void set_swatch(const WeftChartEntry *e, bool base) {
    char text[512];
    const float *c = base ? e->base_color : e->f0;
    snprintf(text, sizeof text, "%s%s%s\n%s %.3g, %.3g, %.3g\n%s", e->name, e->help[0] ? ", " : "", e->help,
             base ? "base colour" : "F0", (double)c[0], (double)c[1], (double)c[2], e->source);
    ui_tip(text);
}

void chart_swatches(WeftMaterial *m, const char *input) {
    enum { ROW = 10 };
    bool base = strcmp(input, "base_color") == 0;
    int shown = 0;
    char label[96];
    if (!base && strcmp(input, f0_input(m)) != 0) return;
    snprintf(label, sizeof label, "%s of known materials###known %s", base ? "colours" : "F0", input);
    if (!ui_fold(label)) return;
    for (int k = 0; weft_chart(k); k++) {
        const WeftChartEntry *e = weft_chart(k);
        if (!has_swatch(e, input)) continue;
        if (shown++ % ROW) ui_same_line();
        snprintf(label, sizeof label, "##%s %s", base ? "colour" : "F0", e->name);
        if (ui_swatch(label, base ? e->base_color : e->f0)) base ? put_base(m, e) : put_f0(m, e, input);
        set_swatch(e, base);
    }
}
