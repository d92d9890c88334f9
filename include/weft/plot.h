/* plot.h - figures of what reflects: curves, lobes, slices, spheres, as pictures and as numbers
 *
 *   const WeftPlotModel model = {.reflection = reflection, .label = "charlie-neubelt"};
 *   weft_plot_write(&(WeftPlotDesc){.models = &model, .count = 1}, "lobe.svg", &error);
 *
 * The view is wo = (sin, 0, cos) of an angle; "in the plane" is that of wo and the normal, where theta_i > 0
 * lies beyond the normal (forward: wi = (-sin, 0, cos)) and theta_i < 0 on the viewer's side. Angles are in
 * degrees. Two runs give the same bytes, whatever the number of threads. */
#ifndef WEFT_PLOT_H
#define WEFT_PLOT_H

#include "weft/image.h"
#include "weft/lobe.h"
#include "weft/material.h"
#include "weft/reflection.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The kinds of figures. */
typedef enum WeftPlotKind {
    WEFT_PLOT_POLAR = 0,  /* f as a length over theta_i, in the plane of wo and across it */
    WEFT_PLOT_LOBE3D,     /* f as a length over all wi: a surface */
    WEFT_PLOT_CARTESIAN,  /* f, and f cos, over theta_i in the plane of wo */
    WEFT_PLOT_ALBEDO,     /* E over the angle of wo, and over an artist's roughness */
    WEFT_PLOT_FURNACE,    /* what a white cloth returns of uniform light: a lobe on white, each layer rule */
    WEFT_PLOT_SLICE,      /* f over theta_h and theta_d, phi_d = 90 degrees, as a picture */
    WEFT_PLOT_SPHERE,     /* a lit sphere, and more of them as the roughness grows */
    WEFT_PLOT_SAMPLES,    /* of lobes: a histogram of what is drawn, the pdf, and their ratio */
    WEFT_PLOT_DIFFERENCE, /* of two models: where in theta_o and theta_i f differs */
    WEFT_PLOT_KINDS
} WeftPlotKind;

/* The name of a kind, "polar", and a line on it; NULL out of range. */
WEFT_API const char *weft_plot_kind_name(int kind);
WEFT_API const char *weft_plot_kind_help(int kind);

/* The channel that is plotted. Luminance is that of Rec. 709. */
typedef enum WeftPlotChannel {
    WEFT_PLOT_LUMINANCE = 0,
    WEFT_PLOT_RED,
    WEFT_PLOT_GREEN,
    WEFT_PLOT_BLUE
} WeftPlotChannel;

/* The most models, views, and pixels of a side. */
enum { WEFT_PLOT_MODELS_MAX = 8, WEFT_PLOT_VIEWS_MAX = 6, WEFT_PLOT_SIDE_MAX = 8192 };

/* All are the caller's and are only read. What the reflection was made of says how it looks at other
 * roughnesses; a lobe also how it is sampled. Of a lobe that walks at random (WEFT_LOBE_REFERENCE) each
 * value is a mean over near directions. */
typedef struct WeftPlotModel {
    const WeftReflection *reflection; /* what is plotted */
    const WeftLobe *lobe;             /* NULL: it is none */
    const WeftMaterial *material;     /* NULL: it is none */
    const char *label;                /* UTF-8, one line; NULL: its number */
} WeftPlotModel;

/* Zero-initialise: a polar plot, linear, of luminance. */
typedef struct WeftPlotDesc {
    WeftPlotKind kind;                /* what is shown */
    const WeftPlotModel *models;      /* count of them */
    int count;                        /* 1 .. WEFT_PLOT_MODELS_MAX; difference: 2 */
    float views[WEFT_PLOT_VIEWS_MAX]; /* theta_o in [0, 90), degrees; sphere: of the light */
    int view_count;                   /* 0: the kind's own. Albedo: of E over roughness */
    int logarithmic;                  /* not 0: f on a logarithmic scale */
    int quick;                        /* not 0: fewer values, walks and samples: for a first look */
    int cosine;                       /* not 0, polar and lobe3d: f cos in place of f */
    WeftPlotChannel channel;          /* sphere and slice that is not logarithmic: all colours */
    const char *title;                /* above everything; NULL: the kind's own; "": none */
    int width, height;                /* pixels, 96 to the inch, <= WEFT_PLOT_SIDE_MAX; 0: its own */
} WeftPlotDesc;

/* The layout of a panel's numbers. */
typedef enum WeftPlotForm {
    WEFT_PLOT_CURVES = 0, /* series over x and y */
    WEFT_PLOT_ROSE,       /* series by angle, degrees from the normal, and length */
    WEFT_PLOT_MAP,        /* a grid of values over x and y */
    WEFT_PLOT_SURFACE,    /* a grid of lengths: columns by phi over 360 degrees, rows by theta over 90 */
    WEFT_PLOT_PICTURE     /* colours, linear Rec. 709 */
} WeftPlotForm;

/* An axis of a panel. */
typedef struct WeftPlotAxis {
    char label[64];  /* UTF-8 */
    char unit[16];   /* "" without one */
    float low, high; /* what is shown; values may lie beyond */
    int logarithmic; /* not 0: so */
} WeftPlotAxis;

/* A curve. */
typedef struct WeftPlotSeries {
    int entry;          /* of the legend */
    int count;          /* of its points */
    const float *x, *y; /* NAN: nothing there */
} WeftPlotSeries;

/* A number that belongs to a panel. */
typedef struct WeftPlotFigure {
    char name[48], unit[16]; /* what, and in what; "" without a unit */
    double value;            /* how much */
} WeftPlotFigure;

/* The most numbers and marks of a panel, and entries of a legend. */
enum { WEFT_PLOT_FIGURES_MAX = 6, WEFT_PLOT_MARKS_MAX = 4, WEFT_PLOT_LEGEND_MAX = 24 };

/* A place on the x axis with a name: the mirror direction, a view. */
typedef struct WeftPlotMark {
    char label[16]; /* the name shown beside the mark */
    float x;        /* where */
} WeftPlotMark;

/* One panel of a figure. */
typedef struct WeftPlotPanel {
    WeftPlotForm form;      /* selects the members below that count */
    char title[192];        /* above it */
    WeftPlotAxis x, y, z;   /* z: of the values of a map or a surface */
    int series_count;       /* curves */
    WeftPlotSeries *series; /* series_count of them */
    int columns, rows;      /* of a grid; rows run with y, or from the top of a picture */
    int channels;           /* of a grid: 1, or 3 for colours */
    const float *values;    /* columns * rows * channels, NAN: nothing there */
    int colored;            /* not 0: the three channels are radiance, shown times 2^exposure */
    float exposure;         /* stops */
    float center;           /* a map whose colours part there: below is blue, above red; NAN: they do not */
    float view;             /* theta_o; NAN: none */
    int entry;              /* of the legend's colours, for a surface */
    int figure_count, mark_count;                  /* of the two below */
    WeftPlotFigure figures[WEFT_PLOT_FIGURES_MAX]; /* numbers that belong to it */
    WeftPlotMark marks[WEFT_PLOT_MARKS_MAX];       /* places on its x axis */
    int cell_count;     /* of a picture: as many equal columns, each with a label below */
    char cells[12][32]; /* these labels */
} WeftPlotPanel;

/* A figure in numbers. */
typedef struct WeftPlotData {
    char title[192];                        /* above everything */
    int columns;                            /* panels stand in so many */
    int count;                              /* of panels */
    WeftPlotPanel *panels;                  /* row after row */
    int legend_count;                       /* of its entries */
    char legend[WEFT_PLOT_LEGEND_MAX][128]; /* in the order of colours */
    char note[256];                         /* below everything: how it was made; "" without one */
    struct WeftPlotMemory *owned;           /* all of the above, see weft_plot_data_free */
} WeftPlotData;

/* Computes the numbers that a figure shows. Fails with WEFT_MESSAGE_DESC (a value out of its range; samples
 * of what is no lobe; a difference of other than two) or _MEMORY. */
WEFT_API WeftResult weft_plot_data(const WeftPlotDesc *desc, WeftPlotData *out, WeftError *error);

/* Releases it and zeroes the struct. data may be NULL or all zero. */
WEFT_API void weft_plot_data_free(WeftPlotData *data);

/* The figure as U8 RGB. */
WEFT_API WeftResult weft_plot_image(const WeftPlotDesc *desc, WeftImage *out, WeftError *error);

/* Returns 1 if weft_plot_write knows this suffix (.png, .svg or .pdf, in any case), else 0. */
WEFT_API int weft_plot_suffix_known(const char *path);

/* Writes the figure by suffix; text in .svg and .pdf is outlines, so that it looks the same everywhere. The
 * file appears complete or not at all. Fails as weft_plot_data does, with WEFT_MESSAGE_OUTPUT_SUFFIX or
 * _FILE_WRITE. */
WEFT_API WeftResult weft_plot_write(const WeftPlotDesc *desc, const char *path, WeftError *error);

/* One page of HTML with every kind of figure that the models have, which needs no other file and no script;
 * kind, title and size of desc are not read. */
WEFT_API WeftResult weft_plot_report(const WeftPlotDesc *desc, const char *path, WeftError *error);

#ifdef __cplusplus
}
#endif

#endif
