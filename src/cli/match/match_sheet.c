/* match_sheet.c - a sheet of spheres: original, copy and match, with the differences of the last two from
 * the first */
#include <math.h>
#include <stdio.h>

#include "cli/console/report.h"
#include "cli/files/sheet_scale.h"
#include "cli/match/match_verb.h"

enum { SIZE = 300, PICTURES = 3 };

typedef struct Pictures {
    WeftImage linear[PICTURES], shown[PICTURES], delta[PICTURES];
    WeftDifference difference[PICTURES];
    float scale; /* of all difference images */
} Pictures;

static WeftResult draw(Pictures *all, const Match *match, WeftError *error) {
    const WeftReflection *of[PICTURES] = {match->from.reflection, match->copy.reflection, match->to.reflection};
    WeftResult result = WEFT_OK;
    for (int k = 0; k < PICTURES && result == WEFT_OK; k++) {
        result = weft_reflection_sphere(of[k], SIZE, &all->linear[k], error);
        if (result == WEFT_OK)
            result = weft_image_tonemap(&all->linear[k], WEFT_TONEMAP_PBR_NEUTRAL, 0.0f, &all->shown[k], error);
        if (result == WEFT_OK) result = weft_difference(&all->linear[k], &all->linear[0], &all->difference[k], error);
    }
    all->scale = sheet_scale(fmaxf(all->difference[1].high, all->difference[2].high), 1e-3f);
    for (int k = 1; k < PICTURES && result == WEFT_OK; k++)
        result = weft_difference_image(&all->linear[k], &all->linear[0], all->scale, &all->delta[k], error);
    return result;
}

static WeftResult compose(const Pictures *all, const Match *match, WeftImage *sheet, WeftError *error) {
    char caption[400], notes[PICTURES][64], figures[PICTURES][64];
    const char *titles[PICTURES] = {match->from.words, "numbers copied", "matched"};
    const char *differences[PICTURES] = {"difference", "copied \xe2\x88\x92 original", "matched \xe2\x88\x92 original"};
    const double distances[PICTURES] = {0.0, match->found.copied, match->found.matched};
    WeftPanel panels[2 * PICTURES] = {{0}};
    for (int k = 0; k < PICTURES; k++) {
        snprintf(notes[k], sizeof notes[k], "%s %.4f", weft_brdf_metric_name(match->metric), distances[k]);
        snprintf(figures[k], sizeof figures[k], "mean %.4f   relMSE %.4f", all->difference[k].mean,
                 all->difference[k].relmse);
        panels[k] = (WeftPanel){.image = &all->shown[k], .title = titles[k], .note = k ? notes[k] : NULL};
        panels[PICTURES + k] = k ? (WeftPanel){.image = &all->delta[k], .title = differences[k], .note = figures[k]}
                                 : (WeftPanel){.scale = all->scale,
                                               .title = differences[k],
                                               .note = "of linear radiance, the channel that differs most"};
    }
    snprintf(caption, sizeof caption, "%.190s as %.190s", match->from.words, match->to.words);
    const WeftSheetDesc desc = {.caption = caption, .panels = panels, .count = 2 * PICTURES, .columns = PICTURES};
    return weft_sheet_compose(&desc, sheet, error);
}

int match_sheet_write(const Match *match, const char *path) {
    WeftError error;
    Pictures all = {.scale = 1.0f};
    WeftImage sheet = {0};
    WeftResult result = draw(&all, match, &error);
    if (result == WEFT_OK) result = compose(&all, match, &sheet, &error);
    if (result == WEFT_OK) result = weft_image_write(path, &sheet, &error);
    for (int k = 0; k < PICTURES; k++) {
        weft_image_free(&all.linear[k]);
        weft_image_free(&all.shown[k]);
        weft_image_free(&all.delta[k]);
    }
    weft_image_free(&sheet);
    return result == WEFT_OK ? 0 : report_error(&error);
}
