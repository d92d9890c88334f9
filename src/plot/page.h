/* page.h - a figure on paper: white, with type and lines in proportion to its size
 *
 * Lengths are pixels, 96 to the inch; y runs down. */
#ifndef WEFT_PLOT_PAGE_H
#define WEFT_PLOT_PAGE_H

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

/* The page's size where none was asked for, and the size of type in one that was. */
void page_natural(const WeftPlotData *data, int *width, int *height);
double page_type(const WeftPlotData *data, int width, int height);

/* Draws all of it. WEFT_OK, or memory was short. */
WeftResult page_draw(const Page *page);

/* One panel each, inside its box. */
WeftResult draw_curves(const Page *page, const WeftPlotPanel *panel, PageBox box);
WeftResult draw_rose(const Page *page, const WeftPlotPanel *panel, PageBox box);
WeftResult draw_map(const Page *page, const WeftPlotPanel *panel, PageBox box);
WeftResult draw_surface(const Page *page, const WeftPlotPanel *panel, PageBox box);
WeftResult draw_picture(const Page *page, const WeftPlotPanel *panel, PageBox box);

/* Inks: text and frames, what explains, and grid lines. */
extern const double ink_dark[3], ink_dim[3], ink_grid[3];

/* Colour and dashes of an entry of the legend, for the lines that follow. */
void set_entry(const Page *page, int entry);
const double *entry_color(int entry);

/* A line from one place to another, so many parts of the type's size wide. */
void rule(const Page *page, const double color[3], double width, double x0, double y0, double x1, double y1);

/* Rows from the top, an U8 RGB picture over a box; smooth: between its pixels. */
WeftResult place_image(const Page *page, const WeftImage *image, PageBox box, bool smooth);

/* The sheet's dark grey where a map has no value or a picture nothing to show. */
extern const double ink_none[3];

#endif
