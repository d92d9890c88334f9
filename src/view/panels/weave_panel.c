/* The section of a material's weave: its draft, the crossings of it, its size, and the yarns of warp and weft. */
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/pi.h"
#include "view/panels/panels.h"
#include "view/state/actions.h"
#include "view/state/dialogs.h"
#include "view/state/edit.h"
#include "view/state/opening.h"

enum { GRID = 12, PICTURE = 128 }; /* most crossings along a side: clickable, and drawn */

/* Yarns that are being changed. */
typedef struct WeaveEdit {
    unsigned scene; /* number of the scene */
    int cloth;      /* of the scene, as it is shown; 0: none */
    WeftYarn yarns[2];
    bool changed; /* and not yet woven */
    WeftClothInfo info;
    float color[2][3]; /* linear, of the first thread of warp and weft */
    const char *key;   /* of the weave, changed and not yet woven; NULL: none */
    char value[64];    /* of that key */
    char draft[1024];  /* as it is typed */
} WeaveEdit;

static const char *const systems[] = {"warp", "weft"};

/* Weaves the material of the edited yarns; pick -1: of the same draft. */
static void weave(Viewer *v, int warp, int pick) {
    Task task = {.kind = TASK_WEAVE, .scene = v->shown->number, .index = v->edit->material, .warp = warp, .pick = pick};
    task.stamp = edit_assign(v, v->edit->material);
    memcpy(task.yarns, v->weave->yarns, sizeof task.yarns);
    renderer_add_task(v->renderer, &task);
    v->weave->changed = false;
}

/* Computes the linear colour on top of a crossing. Warp is darker and weft paler than in the cloth, so that they differ
 * even where both have one colour. */
static bool crossing_color(const WeftDraft *draft, int warp, int pick, float color[3]) {
    const bool up = weft_draft_warp_up(draft, warp, pick) != 0;
    const WeftThread thread = weft_draft_thread(draft, up ? WEFT_WARP : WEFT_WEFT, up ? warp : pick);
    for (int c = 0; c < 3; c++) {
        const float linear = ui_linear(thread.color[c]);
        color[c] = up ? 0.7f * linear : 0.65f * linear + 0.35f;
    }
    return up;
}

/* Draws the first crossings of the repeat, from its lower left corner. */
static void draw_crossings(Viewer *v, const WeftDraft *draft, int warps, int picks) {
    for (int pick = picks - 1; pick >= 0; pick--)
        for (int warp = 0; warp < warps; warp++) {
            char label[64], tip[128];
            float color[3];
            const bool up = crossing_color(draft, warp, pick, color);
            if (warp) ui_same_line();
            snprintf(label, sizeof label, "##crossing %d %d", warp + 1, pick + 1);
            if (ui_swatch(label, color)) weave(v, warp, pick);
            snprintf(tip, sizeof tip, "Warp thread %d is %s pick %d: a click turns that over.", warp + 1,
                     up ? "over" : "under", pick + 1);
            ui_tip(tip);
        }
}

/* Draws a whole repeat that is too large to be clicked. */
static void draw_picture(const WeftDraft *draft, int warps, int picks) {
    const float width = ui_width_left(), side = width / (float)warps;
    UiBox box;
    ui_canvas("##draft", width, side * (float)picks, &box);
    ui_tip("The repeat of the draft: warp darker, weft paler than its threads are.");
    for (int pick = 0; pick < picks; pick++)
        for (int warp = 0; warp < warps; warp++) {
            float c[3];
            crossing_color(draft, warp, pick, c);
            ui_fill((UiBox){box.x + side * (float)warp, box.y + side * (float)(picks - 1 - pick), side, side},
                    ui_shown(c));
        }
}

static int least(int a, int b) { return a < b ? a : b; }

static void draw_draft(Viewer *v, const WeftDraft *draft) {
    const WeftDraftInfo info = weft_draft_info(draft);
    const int warps = info.count[WEFT_WARP], picks = info.count[WEFT_WEFT];
    char text[256];
    if (warps > GRID || picks > GRID) draw_picture(draft, least(warps, PICTURE), least(picks, PICTURE));
    draw_crossings(v, draft, least(warps, GRID), least(picks, GRID));
    snprintf(text, sizeof text, "%d warp threads x %d picks%s%.120s", warps, picks, info.title[0] ? ": " : "",
             info.title);
    ui_dim(text);
}

static const char *yarn_name(const void *user, int row) {
    (void)user;
    return row ? weft_yarn_name(row - 1) : "its own";
}
static const char *yarn_help(const void *user, int row) {
    (void)user;
    return row ? weft_yarn_help(row - 1) : "Numbers that no named yarn has.";
}

/* Returns the row of the named yarn with these numbers; 0 if there is none. */
static int yarn_row(const WeftYarn *yarn) {
    for (int k = 0; weft_yarn_name(k); k++) {
        WeftYarn named;
        if (weft_yarn_find(weft_yarn_name(k), &named, NULL) != WEFT_OK) continue;
        bool same = true;
        for (int n = 0; weft_yarn_number(n); n++) {
            const size_t offset = weft_yarn_number(n)->offset;
            same &= fabsf(*(const float *)((const char *)&named + offset) -
                          *(const float *)((const char *)yarn + offset)) < 1e-5f;
        }
        if (same) return k + 1;
    }
    return 0;
}

static bool draw_yarn(const char *system, WeftYarn *yarn) {
    char label[96];
    int count = 0, row = yarn_row(yarn);
    while (weft_yarn_name(count)) count++;
    const UiChoices names = {count + 1, yarn_name, yarn_help, NULL};
    snprintf(label, sizeof label, "yarn###%s yarn", system);
    bool changed = ui_choice(label, &names, &row) && row > 0;
    if (changed) (void)weft_yarn_find(weft_yarn_name(row - 1), yarn, NULL);
    for (int k = 0; weft_yarn_number(k); k++) {
        const WeftYarnNumber *n = weft_yarn_number(k);
        const float scale = n->angle ? (float)(1.0 / RADIANS) : 1.0f;
        float *value = (float *)((char *)yarn + n->offset), shown = scale * *value;
        const UiRange range = {scale * n->low, scale * n->high, shown, n->angle ? "deg" : NULL, false};
        snprintf(label, sizeof label, "%s###%s %s", n->name, system, n->name);
        if (ui_slider(label, &range, &shown)) {
            *value = fminf(fmaxf(shown / scale, n->low), n->high);
            changed = true;
        }
        ui_tip(n->help);
    }
    return changed;
}

/* Keeps a key to be woven when the mouse is released. */
static void keep_key(WeaveEdit *edit, const char *key, const char *format, ...) {
    va_list list;
    va_start(list, format);
    vsnprintf(edit->value, sizeof edit->value, format, list);
    va_end(list);
    edit->key = key;
}

/* Draws the draft as it is typed, and the way to one in a file. */
static void draw_new_draft(Viewer *v, WeaveEdit *edit) {
    bool entered = ui_input("draft", edit->draft, sizeof edit->draft);
    ui_tip("Words such as twill 2/2; warp 1#26375c; weft 1w (docs/weave.md), or a .wif file.");
    bool pressed = ui_button("Weave it");
    ui_tip("Weaves this material of the draft (Enter).");
    if ((pressed || entered) && edit->draft[0]) actions_weave(v, "draft", edit->draft);
    ui_same_line();
    if (ui_button("Draft ...")) dialogs_open(v, "Choose a draft");
    ui_tip("Weaves it of a WIF or a picture; dropping a WIF on the window does the same.");
}

/* The words for the relief of the asset, in the order of their rows. */
static const char *const relief_names[] = {"folds", "all", "none"},
                         *const relief_helps[] = {"Folds and seams stay; the asset's own threads and pile go.",
                                                  "The whole normal map of the asset.",
                                                  "A smooth surface under the cloth."};
static const char *relief_name(const void *user, int row) {
    (void)user;
    return relief_names[row];
}
static const char *relief_help(const void *user, int row) {
    (void)user;
    return relief_helps[row];
}

/* Draws the choice of how much relief of the asset is seen, and the length that is smoothed away. */
static void draw_relief(WeaveEdit *edit) {
    WeftClothInfo *info = &edit->info;
    const UiChoices names = {3, relief_name, relief_help, NULL};
    int row = isinf(info->relief) ? 2 : info->relief > 0.0f ? 0 : 1;
    if (ui_choice("relief of the asset###relief", &names, &row)) keep_key(edit, "relief", "%s", relief_names[row]);
    if (row) return;
    float millimetres = 1000.0f * info->relief;
    const UiRange range = {0.1f, 200.0f, millimetres, "mm", true};
    if (ui_slider("smoothed over###relief length", &range, &millimetres)) {
        info->relief = 0.001f * fminf(fmaxf(millimetres, 0.1f), 1e4f);
        keep_key(edit, "relief", "%.9g", (double)info->relief);
    }
    ui_tip("Length over which the normal map of the asset is smoothed: more hides larger details.");
}

static void draw_size(WeaveEdit *edit) {
    WeftClothInfo *info = &edit->info;
    if (ui_numbers("sett###sett", 0.1f, info->sett, 2))
        keep_key(edit, "sett", "%.9g,%.9g", (double)info->sett[0], (double)info->sett[1]);
    ui_tip("Threads per centimetre of warp and weft.");
    bool automatic = info->automatic != 0;
    if (ui_checkbox("size of the mesh", &automatic)) {
        info->automatic = automatic;
        if (automatic)
            keep_key(edit, "metres", "auto");
        else
            keep_key(edit, "metres", "%.9g", (double)info->metres);
    }
    ui_tip("Threads have their true size: the metres follow from the texture coordinates of the mesh.");
    const UiRange range = {0.01f, 10.0f, info->metres, "m", true};
    ui_disabled(automatic);
    if (ui_slider("metres", &range, &info->metres)) keep_key(edit, "metres", "%.9g", (double)info->metres);
    ui_disabled_end();
    ui_tip("Metres that a unit of texture coordinates spans: more metres, smaller threads.");
    draw_relief(edit);
    const UiRange degrees = {-180.0f, 180.0f, info->rotation, "deg", false};
    if (ui_slider("rotation###weave rotation", &degrees, &info->rotation)) {
        info->rotation = fminf(fmaxf(info->rotation, -360.0f), 360.0f);
        keep_key(edit, "rotation", "%.9g", (double)info->rotation);
    }
    ui_tip("Rotates the weave on the mesh: 90 lays the warp where the weft was.");
    if (ui_slider_int("seed", 0, 288, &info->seed)) keep_key(edit, "seed", "%d", info->seed);
    ui_tip("Another piece of the same cloth: other slubs and loose fibres.");
}

/* Draws a row of colours that yarns are dyed in, to be clicked. */
static void draw_dyes(WeaveEdit *edit, int threads, const char *key) {
    static const char *const dyes[][2] = {
        {"white", "#f2efe6"},  {"ecru", "#d9c9a3"},  {"yellow", "#e0b21b"}, {"orange", "#d2691e"}, {"red", "#b3191f"},
        {"wine", "#5e1224"},   {"pink", "#d98a9b"},  {"green", "#2f6b3a"},  {"teal", "#1f6f78"},   {"blue", "#26508c"},
        {"indigo", "#26375c"}, {"brown", "#5a3a24"}, {"grey", "#6b6d70"},   {"black", "#151518"}};
    for (size_t k = 0; k < sizeof dyes / sizeof *dyes; k++) {
        char label[64];
        unsigned rgb = 0;
        float color[3];
        sscanf(dyes[k][1] + 1, "%6x", &rgb);
        for (int c = 0; c < 3; c++) color[c] = ui_linear((float)(rgb >> (16 - 8 * c) & 255u) / 255.0f);
        snprintf(label, sizeof label, "###%s %s", systems[threads], dyes[k][0]);
        if (k) ui_same_line();
        if (ui_swatch(label, color)) {
            memcpy(edit->color[threads], color, sizeof color);
            keep_key(edit, key, "%s", dyes[k][1]);
        }
        ui_tip(dyes[k][0]);
    }
}

static void draw_color(WeaveEdit *edit, int threads) {
    static const char *const keys[] = {"warp.color", "weft.color"}, *const labels[] = {"colour###warp colour",
                                                                                       "colour###weft colour"};
    float initial[3];
    memcpy(initial, edit->color[threads], sizeof initial);
    if (ui_color(labels[threads], initial, edit->color[threads])) {
        float *c = edit->color[threads];
        for (int k = 0; k < 3; k++) c[k] = fminf(fmaxf(c[k], 0.0f), 1.0f);
        keep_key(edit, keys[threads], "%.9g,%.9g,%.9g", (double)c[0], (double)c[1], (double)c[2]);
    }
    ui_tip("One colour for all threads of the system; it replaces stripes.");
    draw_dyes(edit, threads, keys[threads]);
}

/* Takes a cloth of the scene as the one that is edited. */
static void edit_cloth(WeaveEdit *edit, unsigned scene, int number, const FactCloth *cloth) {
    WeaveEdit fresh = {.scene = scene, .cloth = number, .info = cloth->info};
    memcpy(fresh.yarns, cloth->yarns, sizeof fresh.yarns);
    memcpy(fresh.draft, edit->draft, sizeof fresh.draft);
    for (int t = 0; t < 2; t++)
        for (int c = 0; c < 3; c++)
            fresh.color[t][c] = ui_linear(weft_draft_thread(cloth->draft, (WeftThreads)t, 0).color[c]);
    *edit = fresh;
}

/* Draws the section of a material's weave. A cloth is woven when the mouse releases a slider or a number is typed, since
 * each adds a cloth to the scene. */
void weave_section(Viewer *v, const WeftMaterial *m) {
    const Facts *facts = &v->shown->facts;
    const bool woven = m->cloth > 0 && m->cloth <= facts->cloth_count;
    if (!v->weave) v->weave = calloc(1, sizeof *v->weave);
    WeaveEdit *edit = v->weave;
    if (!edit || !ui_section("Weave", woven)) return;
    draw_new_draft(v, edit);
    if (!woven) return;
    const FactCloth *cloth = &facts->cloths[m->cloth - 1];
    if (edit->cloth != m->cloth || edit->scene != v->shown->number) edit_cloth(edit, v->shown->number, m->cloth, cloth);
    draw_draft(v, cloth->draft);
    draw_size(edit);
    for (int t = 0; t < 2; t++) {
        char label[64];
        snprintf(label, sizeof label, "Yarn of the %s###yarn of %s", systems[t], systems[t]);
        if (!ui_fold(label)) continue;
        draw_color(edit, t);
        edit->changed |= draw_yarn(systems[t], &edit->yarns[t]);
    }
    if (v->frame->input.button[0] || ui_types()) return;
    if (edit->changed) weave(v, 0, -1);
    if (edit->key) actions_weave(v, edit->key, edit->value);
    edit->key = NULL;
}
