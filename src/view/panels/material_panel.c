/* The panel of a material: choices and inputs, from the catalogue's tables. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/pi.h"
#include "view/panels/panels.h"
#include "view/state/actions.h"
#include "view/state/dialogs.h"
#include "view/state/edit.h"
#include "view/state/opening.h"
#include "view/ui/help.h"
#include "view/ui/swatches.h"

static const float degrees = (float)(1.0 / RADIANS);

/* Inputs lie under the heading whose word their name begins with; all others under the first. */
static const struct {
    const char *heading, *prefixes[4];
    bool unfolded;
} groups[] = {{"Base", {NULL}, true},
              {"Sheen", {"sheen", "nap", "fuzz", NULL}, true},
              {"Coat", {"clearcoat", "coat", NULL}, false},
              {"Glass", {"transmission", "thickness", "attenuation", NULL}, false},
              {"Dust", {"dust", NULL}, false},
              {"Emission", {"emission", NULL}, false}};
enum { GROUPS = sizeof groups / sizeof *groups, SHEEN = 1, MODELS_BEFORE = 2 };

static int group_of(const char *name) {
    for (int g = 1; g < GROUPS; g++)
        for (int k = 0; groups[g].prefixes[k]; k++)
            if (strncmp(name, groups[g].prefixes[k], strlen(groups[g].prefixes[k])) == 0) return g;
    return 0;
}

/* ---- choices ---- */

/* The rows of a menu: auto, and the values that fit. */
typedef struct InputRows {
    int choice, count;
    int values[64];
} InputRows;

static InputRows rows_of(int choice) {
    InputRows rows = {.choice = choice, .count = 1, .values = {-1}};
    for (int value = 0; weft_material_choice_value(choice, value) && rows.count < 64; value++)
        if (weft_material_choice_fits(choice, value)) rows.values[rows.count++] = value;
    return rows;
}

static const char *choice_name(const void *user, int row) {
    const InputRows *rows = user;
    return row ? weft_material_choice_value(rows->choice, rows->values[row]) : "auto";
}
static const char *choice_help(const void *user, int row) {
    const InputRows *rows = user;
    return help_choice(rows->choice, rows->values[row]);
}

/* Words of artists, with the term beside them where it is another one; other choices are called as they are. */
static const char *const words[][2] = {
    {"d", "distribution D"},        {"v", "shadowing V"},         {"f", "Fresnel F"},
    {"profile", "engine, profile"}, {"diffuse", "diffuse model"}, {"layer", "layering rule"},
    {"layer_by", "rule goes by"},   {"convert", "convert from"},  {"rim", "sheen or fuzz"}};

/* Makes a label of the words shown, NULL for the name. Scripts find the control by its name, with blanks for '_'. */
static void label_make(const char *name, const char *shown, char label[96]) {
    char plain[48];
    snprintf(plain, sizeof plain, "%s", name);
    for (char *p = plain; *p; p++)
        if (*p == '_') *p = ' ';
    snprintf(label, 96, "%.40s###%.47s", shown ? shown : plain, plain);
}

static void label_choice(int choice, char label[96]) {
    const char *name = weft_material_choice_name(choice), *shown = NULL;
    for (size_t k = 0; k < sizeof words / sizeof *words; k++)
        if (strcmp(words[k][0], name) == 0) shown = words[k][1];
    label_make(name, shown, label);
}

static void draw_choice(WeftMaterial *m, int choice) {
    const InputRows rows = rows_of(choice);
    const UiChoices menu = {rows.count, choice_name, choice_help, &rows};
    char label[96];
    int row = 0;
    while (row + 1 < rows.count && rows.values[row] != m->choices[choice]) row++;
    label_choice(choice, label);
    if (ui_choice(label, &menu, &row)) weft_material_choose(m, choice, rows.values[row]);
}

/* ---- inputs ---- */

static bool draw_number(const WeftInputInfo *info, const char *label, float *value) {
    bool angle = info->kind == WEFT_INPUT_ANGLE || info->kind == WEFT_INPUT_DIRECTION;
    float shown = angle ? *value * degrees : *value;
    bool wide = info->low > 0.0f && info->high / info->low > 100.0f;
    const UiRange range = {info->low, info->high, info->initial, angle ? "deg" : NULL, wide};
    if (!ui_slider(label, &range, &shown)) return false;
    shown = fminf(fmaxf(shown, info->hard_low), info->hard_high);
    *value = angle ? shown / degrees : shown;
    return true;
}

static bool is_beyond(const WeftInputInfo *info, const WeftInput *input) {
    bool angle = info->kind == WEFT_INPUT_ANGLE;
    float scale = angle ? degrees : 1.0f;
    if (info->kind == WEFT_INPUT_DIRECTION) return false;
    for (int c = 0; c < (info->kind == WEFT_INPUT_COLOR ? 3 : 1); c++)
        if (scale * input->value[c] > info->high * 1.0001f || scale * input->value[c] < info->low - 1e-6f) return true;
    return false;
}

/* Draws the button of an input's map, at the end of the column of names. */
static void draw_chooser(Viewer *v, int k, bool has_map) {
    char label[96];
    snprintf(label, sizeof label, "...###%s choose", weft_material_input_name(k));
    ui_beside();
    if (ui_small_button(label)) {
        dialogs_choose_map(v, k);
    }
    ui_tip(has_map ? "Another picture in the place of this map." : "A picture that multiplies the value.");
}

static void draw_thumb(const Viewer *v, int texture, const char *name) {
    int count = v->shown->facts.thumbs.height / FACTS_THUMB;
    char label[96];
    UiBox box;
    float side = ui_line_height() - 5.0f * ui_scale();
    if (texture > count || !v->shown->maps_texture) return;
    snprintf(label, sizeof label, "##%s thumb", name);
    ui_canvas(label, side, side, &box);
    ui_tip(v->shown->facts.maps[texture - 1]);
    ui_picture_part(v->shown->maps_texture, box, 0.0f, (float)(texture - 1) / (float)count, 1.0f,
                    (float)texture / (float)count);
    ui_same_line();
}

/* Draws the map that multiplies a value: a thumbnail and its name. */
static void draw_map(const Viewer *v, WeftInput *input, const char *name) {
    char label[96];
    int texture = input->texture;
    ui_indent();
    draw_thumb(v, texture, name);
    snprintf(label, sizeof label, "x###%s map", name);
    if (ui_small_button(label)) input->texture = 0;
    ui_tip("Takes the map away.");
    ui_same_line();
    snprintf(label, sizeof label, "times %.60s",
             texture <= v->shown->facts.map_count ? v->shown->facts.maps[texture - 1] : "a map");
    ui_text(label);
    ui_tip(texture <= v->shown->facts.map_count ? v->shown->facts.maps[texture - 1] : NULL);
    ui_indent_end();
}

static void draw_input(Viewer *v, WeftMaterial *m, int k, bool reads) {
    WeftInputInfo info;
    char label[96];
    WeftInput *input = &m->inputs[k];
    weft_material_input_info(k, &info);
    label_make(info.name, weft_material_input_label(k), label);
    const float initial[3] = {info.initial, info.initial, info.initial};
    ui_faint(!reads);
    ui_leave_room();
    bool changed = info.kind == WEFT_INPUT_COLOR ? ui_color(label, initial, input->value)
                                                 : draw_number(&info, label, input->value);
    ui_faint_end();
    ui_tip(help_input(k));
    if (changed) {
        for (int c = 0; c < 3; c++)
            input->value[c] =
                fminf(fmaxf(input->value[c], info.kind == WEFT_INPUT_COLOR ? info.hard_low : input->value[c]),
                      info.kind == WEFT_INPUT_COLOR ? info.hard_high : input->value[c]);
        input->given = 1;
    }
    draw_chooser(v, k, input->texture != 0);
    if (input->texture) draw_map(v, input, info.name);
    chart_swatches(m, info.name);
    if (is_beyond(&info, input)) {
        char text[96];
        snprintf(text, sizeof text, "beyond what is plausible: %g .. %g", (double)info.low, (double)info.high);
        ui_warning(text);
    }
}

/* ---- what else can be done with one ---- */

/* Returns the name of a material, marked if nothing uses it. */
static const char *material_name(const void *user, int k) {
    static char text[FACTS_NAME + 16];
    const Facts *facts = &((const Viewer *)user)->shown->facts;
    bool unused = facts->coverage && facts->coverage[k] < 0.0f;
    snprintf(text, sizeof text, "%s%s", facts->materials[k], unused ? " (unused)" : "");
    return text;
}
static const char *material_help(const void *user, int k) {
    static char text[160];
    const Facts *facts = &((const Viewer *)user)->shown->facts;
    float coverage = facts->coverage ? facts->coverage[k] : 0.0f;
    snprintf(text, sizeof text, "The material that is edited; a click on the picture chooses what is there.");
    if (coverage < 0.0f) snprintf(text, sizeof text, "Nothing uses it now: it is there for a variant.");
    if (coverage > 0.0f) {
        size_t used = strlen(text);
        snprintf(text + used, sizeof text - used, "\n%.1f %% of the picture, at first.", 100.0 * (double)coverage);
    }
    return text;
}
static const char *variant_name(const void *user, int k) {
    return k ? ((const Viewer *)user)->shown->facts.variants[k - 1] : "the file's own";
}

static void draw_which(Viewer *v) {
    const UiChoices materials = {v->edit->state.material_count, material_name, material_help, v};
    const UiChoices variants = {v->shown->facts.info.variant_count + 1, variant_name, NULL, v};
    int variant = v->edit->state.variant + 1;
    const int preset = scene_state_preset(&v->edit->state, v->edit->material);
    int material = v->edit->material;
    if (ui_choice("material", &materials, &material)) edit_choose_material(v, material);
    if (v->shown->facts.info.variant_count) {
        if (ui_choice("variant", &variants, &variant)) edit_set_variant(v, variant - 1);
        ui_tip("Other materials that the file has for the same shapes: the choice follows them.");
    }
    if (ui_field("preset", preset ? weft_preset_name(preset - 1) : "choose ...")) presets_show(v);
    ui_tip(preset ? weft_preset_help(preset - 1)
                  : "Replaces the material by a preset, or by one of your own: pictures of all.");
}

static void draw_buttons(Viewer *v, WeftMaterial *m) {
    if (ui_button("Copy")) edit_copy_material(v);
    ui_tip("Keeps this material to be pasted onto another (Ctrl+C).");
    ui_same_line();
    ui_disabled(!v->edit->has_copied);
    if (ui_button("Paste")) *m = v->edit->copied;
    ui_disabled_end();
    ui_tip("Puts the copied material here (Ctrl+V).");
    ui_same_line();
    if (ui_button("Reset") && v->edit->material < v->edit->first.material_count) {
        *m = *scene_state_material(&v->edit->first, v->edit->material);
        edit_set_preset(v, v->edit->material, 0);
    }
    ui_tip("Back to the value of the file.");
    ui_same_line();
    if (ui_button("Profiles ...")) dialogs_show_profiles(v);
    ui_tip("A sheet of the scene with this material under every engine's profile.");
}

typedef struct WarningLines {
    char text[1024];
    int count;
} WarningLines;

static void on_warning(void *user, WeftMessage message, const char *text) {
    WarningLines *lines = user;
    size_t used = strlen(lines->text);
    snprintf(lines->text + used, sizeof lines->text - used, "%s%s", used ? "\n" : "", text);
    lines->count++;
}

static void draw_plausible(Viewer *v, const WeftMaterial *m) {
    WarningLines lines = {.count = 0};
    char label[64];
    const WeftLog log = {on_warning, &lines};
    weft_material_plausible(m, v->shown->facts.materials[v->edit->material], &log);
    snprintf(label, sizeof label,
             lines.count ? "Plausibility: %d to look at###Plausibility" : "Plausibility: good###Plausibility",
             lines.count);
    if (ui_section(label, false)) {
        if (lines.count)
            ui_warning(lines.text);
        else
            ui_dim("All of its numbers are plausible.");
    }
}

/* Draws the inputs that have any influence; then, folded away, the others. */
static void draw_inputs(Viewer *v, WeftMaterial *m, int group) {
    bool reads[WEFT_INPUTS_MAX] = {false};
    int idle = 0;
    char label[64];
    for (int k = 0; weft_material_input_name(k); k++) {
        if (group_of(weft_material_input_name(k)) != group) continue;
        reads[k] = weft_material_reads(m, k) != 0;
        idle += !reads[k];
    }
    for (int pass = 0; pass < 2; pass++) {
        snprintf(label, sizeof label, "%d without influence now###idle %s", idle, groups[group].heading);
        if (pass && (!idle || !ui_fold(label))) return;
        for (int k = 0; weft_material_input_name(k); k++)
            if (group_of(weft_material_input_name(k)) == group && reads[k] == !pass) draw_input(v, m, k, reads[k]);
    }
}

/* Draws the numbers of hair in units of their size. */
static void draw_hair(WeftMaterial *m) {
    static const struct {
        const char *label, *unit;
        float scale;
    } shown[WEFT_HAIR_NUMBERS] = {{"length###hair_length", "mm", 1e3f},
                                  {"density###hair_density", "per cm2", 1e-4f},
                                  {"thickness###hair_thickness", "um", 1e6f}};
    for (int k = 0; k < WEFT_HAIR_NUMBERS; k++) {
        WeftInputInfo info;
        weft_material_hair_info(k, &info);
        const float scale = shown[k].scale;
        const UiRange range = {scale * info.low, scale * info.high, scale * info.initial, shown[k].unit, false};
        float value = scale * m->hair[k];
        if (ui_slider(shown[k].label, &range, &value))
            m->hair[k] = fminf(fmaxf(value / scale, info.hard_low), info.hard_high);
        ui_tip(info.help);
    }
}

static const char *const sheen_choice = "sheen_lobe"; /* stands with the sheen */

static void draw_models(WeftMaterial *m) {
    for (int k = 0; weft_material_choice_name(k); k++)
        if (strcmp(weft_material_choice_name(k), sheen_choice) != 0) draw_choice(m, k);
}

void material_panel(Viewer *v) {
    if (v->edit->material >= v->edit->state.material_count) edit_choose_material(v, 0);
    if (!v->edit->state.material_count) {
        ui_dim("this scene has no materials");
        return;
    }
    draw_which(v);
    WeftMaterial m = *scene_state_material(&v->edit->state, v->edit->material);
    draw_buttons(v, &m);
    draw_plausible(v, &m);
    if (m.cloth > 0) weave_section(v, &m);
    for (int g = 0; g < GROUPS; g++) {
        if (g == MODELS_BEFORE && ui_section("Models", false)) draw_models(&m);
        if (!ui_section(groups[g].heading, groups[g].unfolded)) continue;
        if (g == SHEEN) draw_choice(&m, weft_material_choice_find(sheen_choice));
        draw_inputs(v, &m, g);
    }
    if (ui_section("Hair", false)) draw_hair(&m);
    if (m.cloth <= 0) weave_section(v, &m);
    edit_set_material(v, v->edit->material, &m);
}
