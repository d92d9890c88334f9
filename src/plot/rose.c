/* rose.c - a panel of curves by angle from the normal, which points up, and length */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "base/pi.h"
#include "plot/axes.h"

/* The half circle. */
typedef struct Rose {
    double x, y, radius;
    Scale scale; /* from values to lengths */
} Rose;

static void place(const Rose *rose, double degrees, double length, double *x, double *y) {
    double angle = degrees * RADIANS;
    *x = rose->x + length * sin(angle);
    *y = rose->y - length * cos(angle);
}

static double length_of(const Rose *rose, double value) {
    return fmin(fmax(scale_place(&rose->scale, value), 0.0), 4.0 * rose->radius);
}

static void half_circle(const Page *page, const Rose *rose, double radius) {
    cairo_new_path(page->cairo);
    cairo_arc(page->cairo, rose->x, rose->y, radius, PI_DOUBLE, 0.0);
}

static void stroke(const Page *page, const double color[3], double width) {
    cairo_set_source_rgb(page->cairo, color[0], color[1], color[2]);
    cairo_set_line_width(page->cairo, width * page->type);
    cairo_stroke(page->cairo);
}

static void draw_grid(const Page *page, const WeftPlotPanel *panel, const Rose *rose) {
    const double type = page->type;
    Tick ticks[TICKS_MAX];
    int count = ticks_make(&rose->scale, false, 2.6 * type, ticks);
    double last = -HUGE_VAL;
    set_font(page->cairo, 0.8 * type, false);
    for (int k = 0; k < count; k++) {
        double length = scale_place(&rose->scale, ticks[k].value);
        if (!ticks[k].text[0]) continue;
        half_circle(page, rose, length);
        stroke(page, ink_grid, 0.06);
        rule(page, ink_dark, 0.07, rose->x + length, rose->y, rose->x + length, rose->y + 0.3 * type);
        if (length - last < text_width(page->cairo, ticks[k].text)) continue;
        place_text(page->cairo, ink_dark, rose->x + length, rose->y + 1.25 * type, 0.5, ticks[k].text);
        last = length + 0.6 * type;
    }
    for (int degrees = -90; degrees <= 90; degrees += 30) {
        double x, y;
        char text[24];
        place(rose, degrees, rose->radius, &x, &y);
        rule(page, ink_grid, 0.06, rose->x, rose->y, x, y);
        place(rose, degrees, rose->radius + 0.45 * type, &x, &y);
        snprintf(text, sizeof text, "%s%d\xc2\xb0", degrees < 0 ? "\xe2\x88\x92" : "", abs(degrees));
        double share = 0.5 - 0.5 * sin(degrees * RADIANS);
        place_text(page->cairo, ink_dim, x, y + (degrees == 90 || degrees == -90 ? -0.1 : 0.15) * type, share, text);
    }
    half_circle(page, rose, rose->radius);
    cairo_close_path(page->cairo);
    stroke(page, ink_dark, 0.08);
    char label[96];
    axis_text(&panel->y, label);
    set_font(page->cairo, 0.9 * type, false);
    place_text(page->cairo, ink_dark, rose->x + 0.5 * rose->radius, rose->y + 2.7 * type, 0.5, label);
}

/* Draws an arrow from the centre to the rim, in the direction of the viewer. */
static void draw_view(const Page *page, const Rose *rose, double view) {
    const double type = page->type, tip = rose->radius - 0.2 * type;
    double x[2], y[2], ax, ay;
    place(rose, -view, 0.0, &x[0], &y[0]);
    place(rose, -view, tip, &x[1], &y[1]);
    rule(page, ink_dim, 0.11, x[0], y[0], x[1], y[1]);
    for (int side = -1; side <= 1; side += 2) {
        double spread = 57.29578 * 0.3 * type / tip;
        place(rose, -view + side * spread, tip - 0.8 * type, &ax, &ay);
        rule(page, ink_dim, 0.11, x[1], y[1], ax, ay);
    }
    set_font(page->cairo, 0.8 * type, false);
    place(rose, -view - 57.29578 * 0.9 * type / tip, tip - 1.6 * type, &ax, &ay);
    place_text(page->cairo, ink_dim, ax, ay + 0.3 * type, 0.5, "\xcf\x89\xe2\x82\x92");
}

static void trace(const Page *page, const Rose *rose, const WeftPlotSeries *series) {
    bool down = false;
    for (int k = 0; k < series->count; k++) {
        double x, y;
        if (!isfinite(series->y[k])) {
            down = false;
            continue;
        }
        place(rose, (double)series->x[k], length_of(rose, (double)series->y[k]), &x, &y);
        if (down)
            cairo_line_to(page->cairo, x, y);
        else
            cairo_move_to(page->cairo, x, y);
        down = true;
    }
    cairo_stroke(page->cairo);
}

/* Draws a triangle inside the rim where a curve exceeds it most, with the largest value. */
static void mark_beyond(const Page *page, const WeftPlotPanel *panel, const WeftPlotSeries *series, const Rose *rose) {
    const double type = page->type, inner = rose->radius - 0.9 * type;
    int top = -1;
    for (int k = 0; k < series->count; k++)
        if (isfinite(series->y[k]) && series->y[k] > panel->y.high && (top < 0 || series->y[k] > series->y[top]))
            top = k;
    if (top < 0) return;
    const double *color = entry_color(series->entry);
    double at = fmin(fmax((double)series->x[top], -84.0), 84.0), spread = 57.29578 * 0.4 * type / inner, x, y;
    char text[40], value[24];
    value_text((double)series->y[top], 3, value);
    snprintf(text, sizeof text, "to %s", value);
    set_font(page->cairo, 0.8 * type, false);
    place(rose, at, inner - 0.7 * type, &x, &y);
    double width = text_width(page->cairo, text);
    if (at > 0.0) x -= width;
    cairo_set_source_rgba(page->cairo, 1.0, 1.0, 1.0, 0.85);
    cairo_rectangle(page->cairo, x - 0.1 * type, y - 0.45 * type, width + 0.2 * type, 1.0 * type);
    cairo_fill(page->cairo);
    place_text(page->cairo, color, x, y + 0.35 * type, 0.0, text);
    cairo_set_source_rgb(page->cairo, color[0], color[1], color[2]);
    place(rose, at, rose->radius - 0.1 * type, &x, &y);
    cairo_move_to(page->cairo, x, y);
    place(rose, at - spread, inner, &x, &y);
    cairo_line_to(page->cairo, x, y);
    place(rose, at + spread, inner, &x, &y);
    cairo_line_to(page->cairo, x, y);
    cairo_close_path(page->cairo);
    cairo_fill(page->cairo);
}

WeftResult draw_rose(const Page *page, const WeftPlotPanel *panel, PageBox box) {
    const double type = page->type;
    Rose rose = {.x = box.x + 0.5 * box.width, .y = box.y + box.height - 3.2 * type};
    rose.radius = fmax(fmin(0.5 * box.width - 3.0 * type, rose.y - box.y - 1.6 * type), type);
    rose.scale = scale_of(&panel->y, 0.0, rose.radius);
    draw_grid(page, panel, &rose);
    if (!isnan(panel->view)) draw_view(page, &rose, (double)panel->view);
    cairo_save(page->cairo);
    half_circle(page, &rose, rose.radius);
    cairo_close_path(page->cairo);
    cairo_clip(page->cairo);
    cairo_set_line_join(page->cairo, CAIRO_LINE_JOIN_ROUND);
    for (int k = 0; k < panel->series_count; k++) {
        set_entry(page, panel->series[k].entry);
        trace(page, &rose, &panel->series[k]);
    }
    cairo_set_dash(page->cairo, NULL, 0, 0.0);
    cairo_restore(page->cairo);
    for (int k = 0; k < panel->series_count; k++) mark_beyond(page, panel, &panel->series[k], &rose);
    return WEFT_OK;
}
