#include "cli/bake/audit_sheet.h"

#include <math.h>
#include <stdio.h>

#include "weft/sheet.h"

enum { PANEL = 320 }; /* pixels, at least, of small tables */

static int times(const WeftImage *image) {
    const int most = image->width > image->height ? image->width : image->height;
    return most < PANEL ? (PANEL + most - 1) / most : 1;
}

/* Makes channel c of the errors grey RGB, F32, each texel a square of times(errors) pixels. */
static WeftResult enlarged(const WeftImage *errors, int c, WeftImage *out, WeftError *error) {
    const int n = times(errors);
    WeftResult result = weft_image_create(errors->width * n, errors->height * n, 3, WEFT_PIXEL_F32, out, error);
    if (result != WEFT_OK) return result;
    float *to = out->pixels;
    for (int y = 0; y < out->height; y++)
        for (int x = 0; x < out->width; x++) {
            const size_t from = (size_t)(y / n) * (size_t)errors->width + (size_t)(x / n);
            for (int k = 0; k < 3; k++) *to++ = ((const float *)errors->pixels)[3 * from + (size_t)c];
        }
    return WEFT_OK;
}

/* Rounds x up to 1, 2 or 5 times a power of ten. */
static float rounded_up(float x) {
    const float steps[] = {1.0f, 2.0f, 5.0f, 10.0f};
    if (!(x > 1e-7f)) return 1e-7f;
    const float power = powf(10.0f, floorf(log10f(x)));
    for (int k = 0; k < 4; k++)
        if (steps[k] * power >= 0.999f * x) return steps[k] * power;
    return x;
}

static WeftResult compose(const AuditSheet *sheet, const WeftImage *table, const WeftImage *albedo, WeftImage shown[3],
                          WeftImage *out, WeftError *error) {
    WeftDifference difference;
    char caption[200], elements[WEFT_TABLE_FORM_TEXT], note[80];
    WeftResult result = weft_difference(table, albedo, &difference, error);
    const float scale = rounded_up(difference.high);
    if (result == WEFT_OK) result = weft_image_tonemap(table, WEFT_TONEMAP_NONE, 0.0f, &shown[0], error);
    if (result == WEFT_OK) result = weft_image_tonemap(albedo, WEFT_TONEMAP_NONE, 0.0f, &shown[1], error);
    if (result == WEFT_OK) result = weft_difference_image(table, albedo, scale, &shown[2], error);
    if (result != WEFT_OK) return result;
    snprintf(caption, sizeof caption, "%s: %s", sheet->name, weft_table_form_text(&sheet->audit->form, elements));
    snprintf(note, sizeof note, "largest %.2g, rms %.2g", sheet->audit->largest, sheet->audit->rms);
    const WeftPanel panels[] = {{.image = &shown[0], .title = "table", .note = "white is 1 and above"},
                                {.image = &shown[1], .title = "E by quadrature", .note = sheet->lobe},
                                {.image = &shown[2], .title = "error", .note = note},
                                {.scale = scale, .title = "scale", .note = "of the error"}};
    const WeftSheetDesc desc = {.caption = caption, .panels = panels, .count = 4, .columns = 4};
    return weft_sheet_compose(&desc, out, error);
}

WeftResult audit_sheet(const AuditSheet *sheet, WeftImage *out, WeftError *error) {
    WeftImage table = {0}, albedo = {0}, shown[3] = {{0}};
    WeftResult result = enlarged(sheet->errors, 1, &table, error);
    if (result == WEFT_OK) result = enlarged(sheet->errors, 2, &albedo, error);
    if (result == WEFT_OK) result = compose(sheet, &table, &albedo, shown, out, error);
    weft_image_free(&table);
    weft_image_free(&albedo);
    for (int k = 0; k < 3; k++) weft_image_free(&shown[k]);
    return result;
}
