/* page.h - a figure on paper: white, with type and lines in proportion to its size
 *
 * Lengths are pixels, 96 to the inch; y runs down. */
#pragma once

#include <cairo.h>
#include <stdbool.h>

#include "plot/type.h"
#include "weft/plot.h"

typedef struct PageBox {
    double x, y, width, height;
} PageBox;

typedef struct Page {
    const WeftPlotData *data;
    int width, height;
    double type; /* size of the text */
    cairo_t *cairo;
    WeftError *error;
} Page;

/* Computes the natural size of a page, and the size of type on a page of a given size. */
void page_natural(const WeftPlotData *data, int *width, int *height);
double page_type(const WeftPlotData *data, int width, int height);

/* Draws the page. Fails with WEFT_MESSAGE_MEMORY. */
WeftResult page_draw(const Page *page);

/* Draws a panel of one form inside its box. */
WeftResult draw_curves(const Page *page, const WeftPlotPanel *panel, PageBox box);
WeftResult draw_rose(const Page *page, const WeftPlotPanel *panel, PageBox box);
WeftResult draw_map(const Page *page, const WeftPlotPanel *panel, PageBox box);
WeftResult draw_surface(const Page *page, const WeftPlotPanel *panel, PageBox box);
WeftResult draw_picture(const Page *page, const WeftPlotPanel *panel, PageBox box);

/* Inks: of text and frames, of annotations, and of grid lines. */
extern const double ink_dark[3], ink_dim[3], ink_grid[3];

/* Sets the colour and dashes of an entry of the legend for the lines that follow; entry_color returns the colour. */
void set_entry(const Page *page, int entry);
const double *entry_color(int entry);

/* Draws a line; width is in units of the type's size. */
void rule(const Page *page, const double color[3], double width, double x0, double y0, double x1, double y1);

/* Draws a U8 RGB picture over a box, its rows from the top. smooth: pixels are interpolated. */
WeftResult place_image(const Page *page, const WeftImage *image, PageBox box, bool smooth);

/* The grey of a map where it has no value. */
extern const double ink_none[3];
