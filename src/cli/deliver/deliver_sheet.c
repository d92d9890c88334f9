/* deliver_sheet.c - the sheet of a target: reference, file and difference, near and far */
#include <stdio.h>

#include "cli/console/report.h"
#include "cli/deliver/delivery.h"
#include "cli/files/sheet_scale.h"

enum { COLUMNS = 3, PANELS = COLUMNS * VIEW_COUNT, NOTE = 96 };
static const char *const view_names[VIEW_COUNT] = {"near", "far"};

typedef struct Sheet {
    WeftImage shown[PANELS];
    char titles[PANELS][NOTE], notes[PANELS][NOTE];
    float scale[VIEW_COUNT]; /* of the differences */
} Sheet;

static WeftResult row_make(Sheet *sheet, int v, const Shots *shots, const Shots *reference, WeftError *error) {
    const WeftImage *of = &shots->views[v], *as = &reference->views[v];
    WeftImage *shown = sheet->shown + (ptrdiff_t)COLUMNS * v;
    WeftDifference difference = {.high = 0.0f};
    WeftResult result = weft_difference(of, as, &difference, error);
    sheet->scale[v] = sheet_scale(difference.high, 1e-3f);
    if (result == WEFT_OK) result = weft_image_tonemap(as, WEFT_TONEMAP_PBR_NEUTRAL, 0.0f, &shown[0], error);
    if (result == WEFT_OK) result = weft_image_tonemap(of, WEFT_TONEMAP_PBR_NEUTRAL, 0.0f, &shown[1], error);
    if (result == WEFT_OK) result = weft_difference_image(of, as, sheet->scale[v], &shown[2], error);
    return result;
}

static void row_label(Sheet *sheet, int v, const Delivery *delivery, const TargetFile *file, const char *target) {
    const ViewErrors *errors = &file->errors.views[v];
    const int first = COLUMNS * v;
    snprintf(sheet->titles[first], NOTE, "reference, %s", view_names[v]);
    snprintf(sheet->notes[first], NOTE, "%.80s", delivery->reference);
    snprintf(sheet->titles[first + 1], NOTE, "%.40s, %s", target, view_names[v]);
    snprintf(sheet->notes[first + 1], NOTE, "FLIP %.4f   contrast %.2f of the reference's", errors->flip,
             errors->contrast);
    snprintf(sheet->titles[first + 2], NOTE, "difference, full colours at %g", (double)sheet->scale[v]);
    snprintf(sheet->notes[first + 2], NOTE, "mean colour %.1f %%   columns %.1f %%", 100.0 * errors->color,
             100.0 * errors->profile);
}

int delivery_sheet(const Delivery *delivery, const TargetFile *file, const Shots *shots, const Shots *reference,
                   const char *path) {
    Sheet sheet = {.scale = {1.0f}};
    WeftPanel panels[PANELS] = {{0}};
    const WeftTarget target = file_target(file);
    WeftImage picture = {0};
    WeftError error;
    char caption[300];
    WeftResult result = WEFT_OK;
    for (int v = 0; v < VIEW_COUNT && result == WEFT_OK; v++) {
        result = row_make(&sheet, v, shots, reference, &error);
        row_label(&sheet, v, delivery, file, target.name);
    }
    for (int k = 0; k < PANELS; k++)
        panels[k] = (WeftPanel){.image = &sheet.shown[k], .title = sheet.titles[k], .note = sheet.notes[k]};
    snprintf(caption, sizeof caption, "%.160s for %.40s: under an even sky %+.1f %%", delivery->what, target.name,
             100.0 * file->errors.sky);
    const WeftSheetDesc desc = {.caption = caption, .panels = panels, .count = PANELS, .columns = COLUMNS};
    if (result == WEFT_OK) result = weft_sheet_compose(&desc, &picture, &error);
    if (result == WEFT_OK) result = weft_image_write(path, &picture, &error);
    for (int k = 0; k < PANELS; k++) weft_image_free(&sheet.shown[k]);
    weft_image_free(&picture);
    return result == WEFT_OK ? 0 : report_error(&error);
}
