/* map.c - a panel of a grid of values in false colours, and one of a picture */
#include <math.h>
#include <stdint.h>

#include "base/fail.h"
#include "base/memory.h"
#include "base/pi.h"
#include "plot/axes.h"
#include "plot/scale.h"

/* Returns the place of a value among the colours: -1 .. 1 if these diverge, else 0 .. 1. */
static float color_place(const WeftPlotPanel *panel, float value) {
    const WeftPlotAxis *z = &panel->z;
    if (!isnan(panel->center)) {
        float side = value < panel->center ? panel->center - z->low : z->high - panel->center;
        return (value - panel->center) / fmaxf(side, 1e-30f);
    }
    float low = z->logarithmic ? log10f(z->low) : z->low, high = z->logarithmic ? log10f(z->high) : z->high;
    float at = z->logarithmic ? log10f(fmaxf(value, 1e-30f)) : value;
    return fminf(fmaxf((at - low) / (high - low), 0.0f), 1.0f);
}

/* Converts the values to colours; row 0 is at the bottom of the axes. */
static void map_pixels(const WeftPlotPanel *panel, WeftImage *image) {
    uint8_t *pixel = image->pixels;
    for (int row = panel->rows - 1; row >= 0; row--)
        for (int k = 0; k < panel->columns; k++) {
            float value = panel->values[row * panel->columns + k], rgb[3];
            if (isnan(value))
                for (int c = 0; c < 3; c++) rgb[c] = (float)ink_none[c];
            else
                scale_color(color_place(panel, value), rgb);
            for (int c = 0; c < 3; c++) *pixel++ = (uint8_t)(rgb[c] * 255.0f + 0.5f);
        }
}

/* Converts the colours of a panel by the tone curve. */
static WeftResult color_pixels(const WeftPlotPanel *panel, bool upward, WeftImage *image, WeftError *error) {
    WeftImage linear;
    WeftResult result = weft_image_create(panel->columns, panel->rows, 3, WEFT_PIXEL_F32, &linear, error);
    if (result != WEFT_OK) return result;
    float *to = linear.pixels;
    for (int row = 0; row < panel->rows; row++) {
        const float *from = panel->values + (size_t)(upward ? panel->rows - 1 - row : row) * (size_t)panel->columns * 3;
        for (int k = 0; k < 3 * panel->columns; k++) *to++ = isfinite(from[k]) ? from[k] : 0.0f;
    }
    result = weft_image_tonemap(&linear, WEFT_TONEMAP_PBR_NEUTRAL, panel->exposure, image, error);
    weft_image_free(&linear);
    return result;
}

static void draw_bar(const Page *page, const WeftPlotPanel *panel, PageBox bar) {
    const double type = page->type;
    Scale scale = scale_of(&panel->z, bar.y + bar.height, bar.y);
    Tick ticks[TICKS_MAX];
    int steps = 128, count = ticks_make(&scale, false, 2.0 * type, ticks);
    for (int k = 0; k < steps; k++) {
        float rgb[3], t = ((float)k + 0.5f) / (float)steps;
        scale_color(isnan(panel->center) ? t : 2.0f * t - 1.0f, rgb);
        cairo_set_source_rgb(page->cairo, (double)rgb[0], (double)rgb[1], (double)rgb[2]);
        double high = bar.y + bar.height * (1.0 - (double)k / steps);
        cairo_rectangle(page->cairo, bar.x, high - 1.6 * bar.height / steps, bar.width,
                        1.6 * bar.height / steps); /* overlaps the next one, so that there is no visible seam */
        if (k + 1 == steps) {
            cairo_new_path(page->cairo);
            cairo_rectangle(page->cairo, bar.x, bar.y, bar.width, bar.height / steps);
        }
        cairo_fill(page->cairo);
    }
    cairo_rectangle(page->cairo, bar.x, bar.y, bar.width, bar.height);
    cairo_set_source_rgb(page->cairo, ink_dark[0], ink_dark[1], ink_dark[2]);
    cairo_set_line_width(page->cairo, 0.07 * type);
    cairo_stroke(page->cairo);
    set_font(page->cairo, 0.85 * type, false);
    double widest = 0.0;
    for (int k = 0; k < count; k++) {
        double y = scale_place(&scale, ticks[k].value), right = bar.x + bar.width;
        rule(page, ink_dark, 0.07, right, y, right + (ticks[k].text[0] ? 0.3 : 0.15) * type, y);
        write_text(page->cairo, ink_dark, right + 0.5 * type, y + 0.33 * type, HUGE_VAL, ticks[k].text);
        widest = fmax(widest, text_width(page->cairo, ticks[k].text));
    }
    char label[96];
    axis_text(&panel->z, label);
    cairo_save(page->cairo);
    cairo_translate(page->cairo, bar.x + bar.width + widest + 1.6 * type, bar.y + 0.5 * bar.height);
    cairo_rotate(page->cairo, -(0.5 * PI_DOUBLE));
    place_text(page->cairo, ink_dark, 0.0, 0.0, 0.5, label);
    cairo_restore(page->cairo);
}

WeftResult draw_map(const Page *page, const WeftPlotPanel *panel, PageBox box) {
    const double type = page->type, right = panel->colored ? 0.0 : 6.2 * type;
    PageBox in = axes_draw(page, panel, (PageBox){box.x, box.y, box.width - right, box.height});
    WeftImage image;
    WeftResult result = panel->colored
                            ? color_pixels(panel, true, &image, page->error)
                            : weft_image_create(panel->columns, panel->rows, 3, WEFT_PIXEL_U8, &image, page->error);
    if (result != WEFT_OK) return result;
    if (!panel->colored) map_pixels(panel, &image);
    result = place_image(page, &image, in, false);
    weft_image_free(&image);
    if (!panel->colored) draw_bar(page, panel, (PageBox){in.x + in.width + 0.8 * type, in.y, 1.1 * type, in.height});
    cairo_rectangle(page->cairo, in.x, in.y, in.width, in.height);
    cairo_set_source_rgb(page->cairo, ink_dark[0], ink_dark[1], ink_dark[2]);
    cairo_set_line_width(page->cairo, 0.08 * type);
    cairo_stroke(page->cairo);
    return result;
}

WeftResult draw_picture(const Page *page, const WeftPlotPanel *panel, PageBox box) {
    const double type = page->type, labels = panel->cell_count ? 1.6 * type : 0.0;
    double scale = fmin(box.width / panel->columns, (box.height - labels) / panel->rows);
    PageBox in = {round(box.x + 0.3 * type), round(box.y), floor(scale * panel->columns - 0.3 * type),
                  floor(scale * panel->rows)};
    WeftImage image;
    WeftResult result = color_pixels(panel, false, &image, page->error);
    if (result != WEFT_OK) return result;
    result = place_image(page, &image, in, true);
    weft_image_free(&image);
    set_font(page->cairo, 0.85 * type, false);
    for (int k = 0; k < panel->cell_count; k++)
        place_text(page->cairo, ink_dark, in.x + in.width * (k + 0.5) / panel->cell_count,
                   in.y + in.height + 1.2 * type, 0.5, panel->cells[k]);
    return result;
}
