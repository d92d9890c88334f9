/* curves.c - a panel of curves over two axes */
#include <math.h>
#include <stdio.h>

#include "plot/axes.h"

/* Draws the line of a series, with gaps where it has no value. */
static void trace(const Page *page, const WeftPlotSeries *series, const Scale *x, const Scale *y) {
    bool down = false;
    for (int k = 0; k < series->count; k++) {
        if (!isfinite(series->y[k])) {
            down = false;
            continue;
        }
        /* coordinates far outside are clamped to what Cairo can represent */
        double at = fmin(fmax(scale_place(y, (double)series->y[k]), -1e4), 3e4);
        if (down)
            cairo_line_to(page->cairo, scale_place(x, (double)series->x[k]), at);
        else
            cairo_move_to(page->cairo, scale_place(x, (double)series->x[k]), at);
        down = true;
    }
    cairo_stroke(page->cairo);
}

/* Draws a triangle at the top of the frame if a series exceeds it, with the largest value. Returns true if so. */
static bool mark_beyond(const Page *page, const WeftPlotPanel *panel, const WeftPlotSeries *series, PageBox in,
                        int row) {
    const double type = page->type;
    int top = -1;
    for (int k = 0; k < series->count; k++)
        if (isfinite(series->y[k]) && series->y[k] > panel->y.high && (top < 0 || series->y[k] > series->y[top]))
            top = k;
    if (top < 0) return false;
    Scale across = scale_of(&panel->x, in.x, in.x + in.width);
    double x =
        fmin(fmax(scale_place(&across, (double)series->x[top]), in.x + 0.6 * type), in.x + in.width - 0.6 * type);
    char text[40], value[24];
    value_text((double)series->y[top], 3, value);
    snprintf(text, sizeof text, "to %s", value);
    set_font(page->cairo, 0.8 * type, false);
    const double *color = entry_color(series->entry);
    double y = in.y + (0.2 + 1.1 * row) * type, share = x > in.x + 0.7 * in.width ? 1.0 : 0.0;
    cairo_set_source_rgb(page->cairo, color[0], color[1], color[2]);
    cairo_move_to(page->cairo, x, y);
    cairo_line_to(page->cairo, x - 0.4 * type, y + 0.75 * type);
    cairo_line_to(page->cairo, x + 0.4 * type, y + 0.75 * type);
    cairo_close_path(page->cairo);
    cairo_fill(page->cairo);
    double width = text_width(page->cairo, text), left = share > 0.5 ? x - 0.7 * type - width : x + 0.5 * type;
    cairo_set_source_rgba(page->cairo, 1.0, 1.0, 1.0, 0.85);
    cairo_rectangle(page->cairo, left, y - 0.1 * type, width + 0.2 * type, 1.1 * type);
    cairo_fill(page->cairo);
    place_text(page->cairo, color, x + (share > 0.5 ? -0.6 : 0.6) * type, y + 0.75 * type, share, text);
    return true;
}

static void draw_marks(const Page *page, const WeftPlotPanel *panel, PageBox in) {
    Scale across = scale_of(&panel->x, in.x, in.x + in.width);
    set_font(page->cairo, 0.75 * page->type, false);
    for (int k = 0; k < panel->mark_count; k++) {
        double x = scale_place(&across, (double)panel->marks[k].x);
        rule(page, ink_dim, 0.07, x, in.y, x, in.y + in.height);
        place_text(page->cairo, ink_dim, x, in.y - 0.25 * page->type, 0.5, panel->marks[k].label);
    }
}

WeftResult draw_curves(const Page *page, const WeftPlotPanel *panel, PageBox box) {
    const double head = panel->mark_count ? 0.5 * page->type : 0.0;
    PageBox in = axes_draw(page, panel, (PageBox){box.x, box.y + head, box.width, box.height - head});
    Scale x = scale_of(&panel->x, in.x, in.x + in.width), y = scale_of(&panel->y, in.y + in.height, in.y);
    draw_marks(page, panel, in);
    if (panel->y.high > 1.0f && panel->y.low < 1.0f && panel->y.unit[0] == '\0') /* the limit of E */
        rule(page, ink_dark, 0.09, in.x, scale_place(&y, 1.0), in.x + in.width, scale_place(&y, 1.0));
    cairo_save(page->cairo);
    cairo_rectangle(page->cairo, in.x, in.y, in.width, in.height);
    cairo_clip(page->cairo);
    cairo_set_line_join(page->cairo, CAIRO_LINE_JOIN_ROUND);
    for (int k = 0; k < panel->series_count; k++) {
        set_entry(page, panel->series[k].entry);
        trace(page, &panel->series[k], &x, &y);
    }
    cairo_set_dash(page->cairo, NULL, 0, 0.0);
    cairo_restore(page->cairo);
    for (int k = 0, row = 0; k < panel->series_count; k++) row += mark_beyond(page, panel, &panel->series[k], in, row);
    return WEFT_OK;
}
