#include "cli/pages/chart_sheet.h"

#include <stdio.h>

#include "cli/console/report.h"
#include "weft/chart.h"
#include "weft/sheet.h"

enum { WIDTH = 240, HEIGHT = 120, SPLIT = 84, COLUMNS = 6, LABEL = 64 };

/* Draws the diffuse colour at the top, which is white for clear materials, and F0 below it. */
static WeftResult draw(const WeftChartEntry *entry, WeftImage *out, WeftError *error) {
    WeftImage linear;
    WeftResult result = weft_image_create(WIDTH, HEIGHT, 3, WEFT_PIXEL_F32, &linear, error);
    if (result != WEFT_OK) return result;
    float *to = linear.pixels;
    for (int y = 0; y < HEIGHT; y++)
        for (int k = 0; k < 3 * WIDTH; k++) *to++ = (y < SPLIT ? entry->base_color : entry->f0)[k % 3];
    result = weft_image_tonemap(&linear, WEFT_TONEMAP_NONE, 0.0f, out, error);
    weft_image_free(&linear);
    return result;
}

static WeftResult compose(int count, WeftImage *swatches, WeftImage *sheet, WeftError *error) {
    WeftPanel panels[WEFT_SHEET_PANELS_MAX] = {0};
    char notes[WEFT_SHEET_PANELS_MAX][LABEL];
    WeftResult result = WEFT_OK;
    for (int k = 0; k < count && result == WEFT_OK; k++) {
        const WeftChartEntry *entry = weft_chart(k);
        result = draw(entry, &swatches[k], error);
        if (entry->kind == WEFT_CHART_METAL)
            snprintf(notes[k], LABEL, "metal");
        else
            snprintf(notes[k], LABEL, "%sF0 %.3f", entry->kind == WEFT_CHART_OPAQUE ? "" : "clear, ",
                     (double)entry->f0[0]);
        panels[k] = (WeftPanel){.image = &swatches[k], .title = entry->name, .note = notes[k]};
    }
    const WeftSheetDesc desc = {.caption = "Reference materials: base colour, and below it F0",
                                .panels = panels,
                                .count = count,
                                .columns = COLUMNS};
    return result == WEFT_OK ? weft_sheet_compose(&desc, sheet, error) : result;
}

int chart_sheet_write(const char *path) {
    WeftImage swatches[WEFT_SHEET_PANELS_MAX] = {0}, sheet = {0};
    WeftError error = {0};
    int count = 0;
    if (weft_image_suffix_linear(path)) return report(WEFT_USAGE, "%s: a sheet of swatches must be a .png", path);
    while (weft_chart(count) && count < WEFT_SHEET_PANELS_MAX) count++;
    WeftResult result = compose(count, swatches, &sheet, &error);
    if (result == WEFT_OK) result = weft_image_write(path, &sheet, &error);
    if (result != WEFT_OK) report_error(&error);
    for (int k = 0; k < count; k++) weft_image_free(&swatches[k]);
    weft_image_free(&sheet);
    return (int)result;
}
