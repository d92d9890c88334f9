#include "weft/sheet.h"

#include <cairo.h>
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

#include "base/fail.h"
#include "plot/scale.h"
#include "plot/type.h"

enum { SIDE_MAX = 32767 }; /* of a Cairo surface, pixels */

static const double background[3] = {0.086, 0.090, 0.098}, bright[3] = {0.92, 0.92, 0.93}, dim[3] = {0.58, 0.60, 0.63};

/* Sizes in pixels; all depend on the size of the type. */
typedef struct SheetLayout {
    int columns, rows;
    double type;                    /* size of titles */
    int column_width, image_height; /* of the largest panel */
    int margin, gap, caption, label;
    int legend;   /* height of the colours of a map, below labels */
    bool stacked; /* notes are below titles, since they do not fit side by side */
    bool wrapped; /* a title takes two lines */
    int width, height;
} SheetLayout;

static double note_size(const SheetLayout *layout) { return 0.82 * layout->type; }

/* Breaks a title that is wider than width at a blank. Sets line to the first line and returns the second, or NULL. */
static const char *wrap(cairo_t *cairo, double width, const char *title, char line[TEXT_SIZE]) {
    drawable(title, line);
    if (text_width(cairo, line) <= width) return NULL;
    for (size_t k = strlen(line); k-- > 1;) {
        if (line[k] != ' ') continue;
        line[k] = '\0';
        if (text_width(cairo, line) <= width) return line + k + 1;
        line[k] = ' ';
    }
    return NULL;
}

static bool titles_wrap(cairo_t *cairo, const SheetLayout *layout, const WeftSheetDesc *desc) {
    char line[TEXT_SIZE];
    bool any = false;
    set_font(cairo, layout->type, true);
    for (int k = 0; k < desc->count; k++)
        any |= desc->panels[k].title && wrap(cairo, layout->column_width, desc->panels[k].title, line);
    return any;
}

static bool notes_fit(cairo_t *cairo, const SheetLayout *layout, const WeftSheetDesc *desc) {
    for (int k = 0; k < desc->count; k++) {
        const WeftPanel *panel = &desc->panels[k];
        if (!panel->title || !panel->note) continue;
        set_font(cairo, layout->type, true);
        double width = text_width(cairo, panel->title) + layout->type;
        set_font(cairo, note_size(layout), false);
        if (width + text_width(cairo, panel->note) > layout->column_width) return false;
    }
    return true;
}

static bool is_map(const WeftPanel *panel) {
    return panel->image && (panel->none < panel->most || panel->none > panel->most);
}

static SheetLayout layout_of(const WeftSheetDesc *desc, cairo_t *cairo) {
    enum { NARROWEST = 240 };
    SheetLayout layout = {.columns = desc->columns, .rows = (desc->count + desc->columns - 1) / desc->columns};
    bool labels = false, maps = false;
    for (int k = 0; k < desc->count; k++) {
        const WeftPanel *panel = &desc->panels[k];
        labels |= panel->title || panel->note;
        maps |= is_map(panel);
        if (!panel->image) continue;
        if (panel->image->width > layout.column_width) layout.column_width = panel->image->width;
        if (panel->image->height > layout.image_height) layout.image_height = panel->image->height;
    }
    if (layout.column_width < NARROWEST) layout.column_width = NARROWEST;
    layout.type = fmin(fmax(layout.column_width / 30.0, 12.0), 40.0);
    layout.stacked = !notes_fit(cairo, &layout, desc);
    layout.wrapped = titles_wrap(cairo, &layout, desc);
    layout.margin = (int)lround(1.5 * layout.type);
    layout.gap = (int)lround(0.6 * layout.type);
    layout.caption = desc->caption ? (int)lround(2.1 * layout.type) : 0;
    double lines = 2.1 + (layout.stacked ? 1.2 : 0.0) + (layout.wrapped ? 1.2 : 0.0);
    layout.legend = maps ? (int)lround(2.4 * layout.type) : 0;
    layout.label = layout.legend + (labels ? (int)lround(lines * layout.type) : 0);
    double width = 2.0 * layout.margin + (double)layout.columns * (layout.column_width + layout.gap) - layout.gap;
    double height = 2.0 * layout.margin + layout.caption +
                    (double)layout.rows * (layout.image_height + layout.label + layout.gap) - layout.gap;
    layout.width = (int)fmin(width, SIDE_MAX + 1.0);
    layout.height = (int)fmin(height, SIDE_MAX + 1.0);
    return layout;
}

static void draw_label(cairo_t *cairo, const SheetLayout *layout, const WeftPanel *panel, double x, double y) {
    double baseline = y + 1.35 * layout->type, width = layout->column_width;
    if (panel->title) {
        char line[TEXT_SIZE];
        set_font(cairo, layout->type, true);
        const char *second = wrap(cairo, width, panel->title, line);
        write_text(cairo, bright, x, baseline, width, line);
        if (second) write_text(cairo, bright, x, baseline += 1.2 * layout->type, width, second);
    }
    if (!panel->note) return;
    set_font(cairo, note_size(layout), false);
    double at = layout->stacked || !panel->title ? x : fmax(x, x + width - text_width(cairo, panel->note));
    write_text(cairo, dim, at, baseline + (layout->stacked ? 1.2 * layout->type : 0.0), width, panel->note);
}

/* Draws a bar of the scale's colours from t = low to 1. */
static void draw_bar(cairo_t *cairo, double left, double top, double width, double height, float low) {
    int steps = (int)width;
    for (int k = 0; k < steps; k++) {
        float rgb[3];
        scale_color(low + (1.0f - low) * ((float)k + 0.5f) / (float)steps, rgb);
        cairo_set_source_rgb(cairo, (double)rgb[0], (double)rgb[1], (double)rgb[2]);
        cairo_rectangle(cairo, floor(left) + k, floor(top), 1.0, floor(height));
        cairo_fill(cairo);
    }
}

/* Draws the colours of a map below its label. */
static void draw_legend(cairo_t *cairo, const SheetLayout *layout, const WeftPanel *panel, double x, double y) {
    double width = layout->column_width, height = 0.7 * layout->type;
    draw_bar(cairo, x, y + 0.5 * layout->type, width, height, 0.0f);
    for (int k = 0; k < 3; k++) {
        char number[48];
        double share = 0.5 * k, value = (double)panel->none + share * (double)(panel->most - panel->none);
        snprintf(number, sizeof number, "%.4g%s", value,
                 k == 0                      ? " the same"
                 : k == 1                    ? ""
                 : panel->most > panel->none ? " and more"
                                             : " and less");
        set_font(cairo, note_size(layout), false);
        write_text(cairo, bright, x + share * (width - text_width(cairo, number)), y + height + 1.6 * layout->type,
                   width, number);
    }
}

/* Draws a bar in the middle of a panel, with words and numbers at its ends. */
static void draw_scale(cairo_t *cairo, const SheetLayout *layout, float scale, double x, double y) {
    double width = 0.7 * layout->column_width, height = 0.9 * layout->type;
    double left = x + 0.5 * (layout->column_width - width), top = y + 0.5 * (layout->image_height - height);
    draw_bar(cairo, left, top, width, height, -1.0f);
    const char *const words[3] = {"darker", "same", "brighter"};
    for (int k = 0; k < 3; k++) {
        char number[32];
        snprintf(number, sizeof number, "%s%g",
                 k == 0   ? "\xe2\x88\x92"
                 : k == 2 ? "+"
                          : "",
                 k == 1 ? 0.0 : (double)scale);
        set_font(cairo, note_size(layout), false);
        double share = 0.5 * k, at = left + share * width;
        write_text(cairo, dim, at - share * text_width(cairo, words[k]), top - 0.5 * layout->type, width, words[k]);
        write_text(cairo, bright, at - share * text_width(cairo, number), top + height + 1.1 * layout->type, width,
                   number);
    }
}

/* Copies an image pixel by pixel, without resampling. RGB24 has a 32-bit word a pixel, 0x00rrggbb. */
static void copy_image(const WeftImage *image, unsigned char *pixels, int stride, int x, int y) {
    const uint8_t *from = image->pixels;
    for (int row = 0; row < image->height; row++)
        for (int column = 0; column < image->width; column++, from += image->channels) {
            uint32_t word = 0, alpha = image->channels == 4 ? from[3] : 255;
            for (int c = 0; c < 3; c++) {
                uint32_t below = (uint32_t)(background[c] * 255.0 + 0.5);
                word = word << 8 | (from[c] * alpha + below * (255 - alpha) + 127) / 255;
            }
            memcpy(pixels + (size_t)(y + row) * (size_t)stride + 4 * (size_t)(x + column), &word, 4);
        }
}

/* Computes the corner of panel k. */
static void panel_place(const SheetLayout *layout, int k, int *x, int *y) {
    *x = layout->margin + k % layout->columns * (layout->column_width + layout->gap);
    *y = layout->margin + layout->caption + k / layout->columns * (layout->image_height + layout->label + layout->gap);
}

static void draw(cairo_t *cairo, const SheetLayout *layout, const WeftSheetDesc *desc) {
    cairo_set_source_rgb(cairo, background[0], background[1], background[2]);
    cairo_paint(cairo);
    if (desc->caption) {
        set_font(cairo, 1.2 * layout->type, false);
        write_text(cairo, bright, layout->margin, layout->margin + layout->type, layout->width - 2.0 * layout->margin,
                   desc->caption);
    }
    for (int k = 0; k < desc->count; k++) {
        const WeftPanel *panel = &desc->panels[k];
        int x, y;
        panel_place(layout, k, &x, &y);
        draw_label(cairo, layout, panel, x, y + layout->image_height);
        if (is_map(panel))
            draw_legend(cairo, layout, panel, x, y + layout->image_height + layout->label - layout->legend);
        if (!panel->image && panel->scale > 0.0f) draw_scale(cairo, layout, panel->scale, x, y);
    }
}

static WeftResult from_surface(cairo_surface_t *surface, const SheetLayout *layout, const WeftSheetDesc *desc,
                               WeftImage *out, WeftError *error) {
    WeftResult result = weft_image_create(layout->width, layout->height, 3, WEFT_PIXEL_U8, out, error);
    if (result != WEFT_OK) return result;
    cairo_surface_flush(surface);
    unsigned char *pixels = cairo_image_surface_get_data(surface);
    int stride = cairo_image_surface_get_stride(surface);
    for (int k = 0; k < desc->count; k++) {
        int x, y;
        const WeftImage *image = desc->panels[k].image;
        panel_place(layout, k, &x, &y);
        if (image)
            copy_image(image, pixels, stride, x + (layout->column_width - image->width) / 2,
                       y + layout->image_height - image->height);
    }
    uint8_t *to = out->pixels;
    for (int row = 0; row < layout->height; row++)
        for (int column = 0; column < layout->width; column++) {
            uint32_t word;
            memcpy(&word, pixels + (size_t)row * (size_t)stride + 4 * (size_t)column, 4);
            for (int c = 0; c < 3; c++) *to++ = (uint8_t)(word >> (16 - 8 * c));
        }
    return WEFT_OK;
}

static WeftResult check(const WeftSheetDesc *desc, WeftError *error) {
    if (desc->count < 1 || desc->count > WEFT_SHEET_PANELS_MAX || desc->columns < 1 || desc->columns > desc->count ||
        !desc->panels)
        return fail(error, WEFT_MESSAGE_DESC, "sheet", "%d panels in %d columns", desc->count, desc->columns);
    for (int k = 0; k < desc->count; k++) {
        const WeftImage *image = desc->panels[k].image;
        if (image && (image->type != WEFT_PIXEL_U8 || image->channels < 3 || !image->pixels))
            return fail(error, WEFT_MESSAGE_DESC, "sheet", "panel %d is not U8 of 3 or 4 channels", k);
    }
    return WEFT_OK;
}

WeftResult weft_sheet_compose(const WeftSheetDesc *desc, WeftImage *out, WeftError *error) {
    *out = (WeftImage){0};
    WeftResult result = check(desc, error);
    if (result != WEFT_OK) return result;
    cairo_surface_t *probe = cairo_image_surface_create(CAIRO_FORMAT_RGB24, 1, 1);
    cairo_t *ruler = cairo_create(probe);
    SheetLayout layout = layout_of(desc, ruler);
    cairo_destroy(ruler);
    cairo_surface_destroy(probe);
    if (layout.width > SIDE_MAX || layout.height > SIDE_MAX)
        return fail(error, WEFT_MESSAGE_DESC, "sheet", "a side would have more than %d pixels", SIDE_MAX);
    cairo_surface_t *surface = cairo_image_surface_create(CAIRO_FORMAT_RGB24, layout.width, layout.height);
    cairo_t *cairo = cairo_create(surface);
    draw(cairo, &layout, desc);
    result = drawn(cairo, "sheet", error);
    if (result == WEFT_OK) result = from_surface(surface, &layout, desc, out, error);
    cairo_destroy(cairo);
    cairo_surface_destroy(surface);
    return result;
}
