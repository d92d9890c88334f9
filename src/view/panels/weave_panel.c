/* The section of a woven material: the crossings of its draft, and the yarns of warp and weft. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/pi.h"
#include "view/panels/panels.h"
#include "view/state/edit.h"
#include "view/state/opening.h"

enum { GRID = 12, PICTURE = 128 }; /* most crossings along a side: clickable, and drawn */

/* Yarns that are being changed. */
typedef struct WeaveEdit {
    unsigned scene; /* number of the scene */
    int cloth;      /* of the scene, as it is shown; 0: none */
    WeftYarn yarns[2];
    bool changed; /* and not yet woven */
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

/* Draws the section of a woven material. A cloth is woven when the mouse releases a slider or a number is typed, since
 * each adds a cloth to the scene. */
void weave_section(Viewer *v, const WeftMaterial *m) {
    const Facts *facts = &v->shown->facts;
    if (m->cloth < 1 || m->cloth > facts->cloth_count) return;
    const FactCloth *cloth = &facts->cloths[m->cloth - 1];
    if (!v->weave) v->weave = calloc(1, sizeof *v->weave);
    WeaveEdit *edit = v->weave;
    if (!edit) return;
    if (edit->cloth != m->cloth || edit->scene != v->shown->number) {
        *edit = (WeaveEdit){.scene = v->shown->number, .cloth = m->cloth};
        memcpy(edit->yarns, cloth->yarns, sizeof edit->yarns);
    }
    if (!ui_section("Weave", true)) return;
    draw_draft(v, cloth->draft);
    for (int t = 0; t < 2; t++) {
        char label[64];
        snprintf(label, sizeof label, "Yarn of the %s###yarn of %s", systems[t], systems[t]);
        if (ui_fold(label)) edit->changed |= draw_yarn(systems[t], &edit->yarns[t]);
    }
    if (edit->changed && !v->frame->input.button[0] && !ui_types()) weave(v, 0, -1);
}
