#include "plot/page.h"

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include "base/fail.h"
#include "plot/axes.h"

const double ink_dark[3] = {0.10, 0.10, 0.11}, ink_dim[3] = {0.38, 0.39, 0.41}, ink_grid[3] = {0.84, 0.84, 0.85},
             ink_none[3] = {0.55, 0.55, 0.56};

/* Colours that colour-blind people can distinguish: Masataka Okabe and Kei Ito, "Color Universal Design", 2008, in an
 * order that begins with the darkest; their yellow, which is too bright for a line, is replaced by grey. The dashes
 * differ as well, so that a print without colour can be read. */
static const double colors[8][3] = {{0.000, 0.447, 0.698}, {0.835, 0.369, 0.000}, {0.000, 0.620, 0.451},
                                    {0.800, 0.475, 0.655}, {0.050, 0.050, 0.050}, {0.902, 0.624, 0.000},
                                    {0.337, 0.706, 0.914}, {0.500, 0.500, 0.500}};
static const double dashes[8][4] = {{0.0},      {0.75, 0.35}, {0.15, 0.3},          {0.9, 0.3, 0.15, 0.3},
                                    {1.6, 0.4}, {0.4, 0.4},   {1.2, 0.3, 0.4, 0.3}, {0.15, 0.6}};

const double *entry_color(int entry) { return colors[entry % 8]; }

void set_entry(const Page *page, int entry) {
    const double *color = entry_color(entry), *dash = dashes[(entry + entry / 8 * 3) % 8];
    double lengths[4];
    int count = 0;
    while (count < 4 && dash[count] > 0.0) {
        lengths[count] = dash[count] * page->type;
        count++;
    }
    cairo_set_source_rgb(page->cairo, color[0], color[1], color[2]);
    cairo_set_dash(page->cairo, lengths, count, 0.0);
    cairo_set_line_width(page->cairo, 0.15 * page->type);
}

void rule(const Page *page, const double color[3], double width, double x0, double y0, double x1, double y1) {
    cairo_set_source_rgb(page->cairo, color[0], color[1], color[2]);
    cairo_set_line_width(page->cairo, width * page->type);
    cairo_move_to(page->cairo, x0, y0);
    cairo_line_to(page->cairo, x1, y1);
    cairo_stroke(page->cairo);
}

WeftResult place_image(const Page *page, const WeftImage *image, PageBox box, bool smooth) {
    cairo_surface_t *surface = cairo_image_surface_create(CAIRO_FORMAT_RGB24, image->width, image->height);
    if (cairo_surface_status(surface) != CAIRO_STATUS_SUCCESS) {
        cairo_surface_destroy(surface);
        return fail(page->error, WEFT_MESSAGE_MEMORY, "plot", NULL);
    }
    unsigned char *pixels = cairo_image_surface_get_data(surface);
    const size_t stride = (size_t)cairo_image_surface_get_stride(surface);
    const uint8_t *from = image->pixels;
    for (size_t row = 0; row < (size_t)image->height; row++)
        for (size_t column = 0; column < (size_t)image->width; column++, from += 3) {
            uint32_t word = (uint32_t)from[0] << 16 | (uint32_t)from[1] << 8 | from[2];
            memcpy(pixels + row * stride + 4 * column, &word, 4);
        }
    cairo_surface_mark_dirty(surface);
    cairo_save(page->cairo);
    cairo_rectangle(page->cairo, box.x, box.y, box.width, box.height);
    cairo_clip(page->cairo);
    cairo_translate(page->cairo, box.x, box.y);
    cairo_scale(page->cairo, box.width / image->width, box.height / image->height);
    cairo_set_source_surface(page->cairo, surface, 0.0, 0.0);
    cairo_pattern_set_extend(cairo_get_source(page->cairo), CAIRO_EXTEND_PAD);
    cairo_pattern_set_filter(cairo_get_source(page->cairo), smooth ? CAIRO_FILTER_GOOD : CAIRO_FILTER_NEAREST);
    cairo_paint(page->cairo);
    cairo_restore(page->cairo);
    cairo_surface_destroy(surface);
    return WEFT_OK;
}

/* The layout, in units of the type's size: a title, panels in rows, the legend, a note. */

static const double natural_type = 13.0;

/* Computes the natural size of a panel with its title and figures. */
static void natural_panel(const WeftPlotPanel *panel, double *width, double *height) {
    *width = 37.0;
    *height = panel->form == WEFT_PLOT_ROSE      ? 22.6
              : panel->form == WEFT_PLOT_SURFACE ? 27.5
              : panel->form == WEFT_PLOT_MAP     ? 27.5
                                                 : 27.0;
    if (panel->form != WEFT_PLOT_PICTURE) return;
    *width = 74.0;
    *height = 4.5 + (*width - 2.0) * panel->rows / panel->columns;
}

static int rows_of(const WeftPlotData *data) { return (data->count + data->columns - 1) / data->columns; }

static int columns_of(const WeftPlotData *data) { return data->count < data->columns ? data->count : data->columns; }

/* Returns the number of the legend's columns. Widths are estimated from the number of letters, so that the page's size
 * needs no surface. */
static int legend_columns(const WeftPlotData *data, double width) {
    size_t longest = 4;
    for (int k = 0; k < data->legend_count; k++)
        if (strlen(data->legend[k]) > longest) longest = strlen(data->legend[k]);
    int columns = (int)(width / (5.0 + 0.62 * (double)longest));
    return columns < 1 ? 1 : columns > data->legend_count ? data->legend_count : columns;
}

static bool has_legend(const WeftPlotData *data) {
    for (int p = 0; p < data->count; p++)
        if (data->panels[p].series_count) return data->legend_count > 0;
    return false;
}

static double legend_height(const WeftPlotData *data, double width) {
    if (!has_legend(data)) return 0.0;
    int columns = legend_columns(data, width);
    int rows = (data->legend_count + columns - 1) / columns;
    return 0.6 + 1.7 * rows;
}

static double head_height(const WeftPlotData *data) { return data->title[0] ? 2.8 : 0.6; }
static double foot_height(const WeftPlotData *data) { return data->note[0] ? 1.9 : 0.6; }

/* Returns the natural height of the first `rows` rows, each as high as its highest panel. */
static double rows_height(const WeftPlotData *data, int rows) {
    double sum = 0.0;
    for (int row = 0; row < rows; row++) {
        double most = 0.0, width, height;
        for (int k = row * data->columns; k < data->count && k < (row + 1) * data->columns; k++) {
            natural_panel(&data->panels[k], &width, &height);
            most = fmax(most, height);
        }
        sum += most;
    }
    return sum;
}

static void natural(const WeftPlotData *data, double *width, double *height) {
    double w = 0.0;
    for (int k = 0; k < data->count; k++) {
        double pw, ph;
        natural_panel(&data->panels[k], &pw, &ph);
        w = fmax(w, pw);
    }
    *width = 2.0 + w * columns_of(data);
    *height =
        head_height(data) + rows_height(data, rows_of(data)) + legend_height(data, *width - 2.0) + foot_height(data);
}

void page_natural(const WeftPlotData *data, int *width, int *height) {
    double w, h;
    natural(data, &w, &h);
    double scale = fmin(natural_type, fmin(WEFT_PLOT_SIDE_MAX / w, WEFT_PLOT_SIDE_MAX / h));
    *width = (int)(w * scale);
    *height = (int)(h * scale);
}

double page_type(const WeftPlotData *data, int width, int height) {
    double w, h;
    natural(data, &w, &h);
    return fmax(fmin(width / w, height / h), 2.0);
}

static void draw_legend(const Page *page, double top) {
    const WeftPlotData *data = page->data;
    const double type = page->type, width = page->width - 2.0 * type;
    const int columns = legend_columns(data, width / type);
    set_font(page->cairo, 0.9 * type, false);
    for (int k = 0; k < data->legend_count; k++) {
        const int row = k / columns;
        double x = type + width / columns * (k % columns), y = top + (1.3 + 1.7 * row) * type;
        set_entry(page, k);
        cairo_move_to(page->cairo, x + 0.5 * type, y - 0.35 * type);
        cairo_line_to(page->cairo, x + 4.0 * type, y - 0.35 * type);
        cairo_stroke(page->cairo);
        cairo_set_dash(page->cairo, NULL, 0, 0.0);
        write_text(page->cairo, ink_dark, x + 4.6 * type, y, width / columns - 5.0 * type, data->legend[k]);
    }
}

/* Writes the figures of a panel, such as "mean 0.12 1/sr,  most 0.5 1/sr". */
static void figures_text(const WeftPlotPanel *panel, char *text, size_t size) {
    text[0] = '\0';
    for (int k = 0; k < panel->figure_count; k++) {
        const WeftPlotFigure *figure = &panel->figures[k];
        size_t used = strlen(text);
        char value[24];
        value_text(figure->value, 6, value);
        snprintf(text + used, size - used, "%s%s %s%s%s", k ? ",  " : "", figure->name, value,
                 strlen(figure->unit) > 2 ? " " : "", figure->unit);
    }
}

static WeftResult draw_panel(const Page *page, const WeftPlotPanel *panel, PageBox box) {
    static WeftResult (*const draw[])(const Page *, const WeftPlotPanel *, PageBox) = {draw_curves, draw_rose, draw_map,
                                                                                       draw_surface, draw_picture};
    const double type = page->type, width = box.width - type;
    char figures[320];
    figures_text(panel, figures, sizeof figures);
    set_font(page->cairo, type, true);
    write_text(page->cairo, ink_dark, box.x + 0.5 * type, box.y + type, width, panel->title);
    double head = 1.7 * type;
    if (figures[0]) {
        set_font(page->cairo, 0.85 * type, false);
        write_text(page->cairo, ink_dim, box.x + 0.5 * type, box.y + 2.3 * type, width, figures);
        head += 1.3 * type;
    }
    PageBox inner = {box.x + 0.3 * type, box.y + head, box.width - 0.6 * type, box.height - head - 0.4 * type};
    if (inner.width < 4.0 * type || inner.height < 4.0 * type) return WEFT_OK;
    cairo_save(page->cairo);
    WeftResult result = draw[panel->form](page, panel, inner);
    cairo_restore(page->cairo);
    return result;
}

WeftResult page_draw(const Page *page) {
    const WeftPlotData *data = page->data;
    const double type = page->type;
    const double top = head_height(data) * type, legend = legend_height(data, page->width / type - 2.0) * type;
    const double bottom = page->height - foot_height(data) * type - legend;
    const double width = (page->width - 2.0 * type) / columns_of(data),
                 unit = (bottom - top) / rows_height(data, rows_of(data));
    WeftResult result = WEFT_OK;
    cairo_set_source_rgb(page->cairo, 1.0, 1.0, 1.0);
    cairo_paint(page->cairo);
    if (data->title[0]) {
        set_font(page->cairo, 1.25 * type, true);
        write_text(page->cairo, ink_dark, 1.5 * type, 1.9 * type, page->width - 3.0 * type, data->title);
    }
    for (int k = 0; k < data->count && result == WEFT_OK; k++) {
        const int row = k / data->columns, column = k % data->columns;
        const double from = unit * rows_height(data, row), to = unit * rows_height(data, row + 1);
        result = draw_panel(page, &data->panels[k], (PageBox){type + width * column, top + from, width, to - from});
    }
    if (has_legend(data)) draw_legend(page, bottom);
    set_font(page->cairo, 0.75 * type, false);
    write_text(page->cairo, ink_dim, 1.5 * type, page->height - 0.8 * type, page->width - 3.0 * type, data->note);
    return result;
}
