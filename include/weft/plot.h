/* plot.h - figures of reflections: curves, lobes, slices, spheres, as pictures and as numbers
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
    WEFT_PLOT_FURNACE,    /* E of a white cloth: a lobe on a white base, by each layer rule */
    WEFT_PLOT_SLICE,      /* f over theta_h and theta_d, phi_d = 90 degrees, as a picture */
    WEFT_PLOT_SPHERE,     /* a lit sphere, and more of them as the roughness grows */
    WEFT_PLOT_SAMPLES,    /* of lobes: a histogram of the samples, the pdf, and their ratio */
    WEFT_PLOT_DIFFERENCE, /* of two models: the difference of f over theta_o and theta_i */
    WEFT_PLOT_AMBIENT,    /* of lobes: a sphere under a map, and as engines light it by that map */
    WEFT_PLOT_KINDS
} WeftPlotKind;

/* Returns the name of a kind, such as "polar", and a line on it; NULL out of range. */
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

/* A model to plot; the caller owns all members. Figures over roughness evaluate the lobe or material that the
 * reflection was made of; WEFT_PLOT_SAMPLES and WEFT_PLOT_AMBIENT need a lobe. With WEFT_LOBE_REFERENCE each value is a mean
 * over nearby directions. */
typedef struct WeftPlotModel {
    const WeftReflection *reflection; /* the model */
    const WeftLobe *lobe;             /* if the reflection is a lobe, else NULL */
    const WeftMaterial *material;     /* if the reflection is a material, else NULL */
    const char *label;                /* UTF-8, one line; NULL: its number */
} WeftPlotModel;

/* Zero-initialise: a polar plot, linear, of luminance. */
typedef struct WeftPlotDesc {
    WeftPlotKind kind;                /* of the figure */
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
    const WeftImage *environment;     /* ambient: a lat-long map of floats, linear; NULL: the studio */
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
    float low, high; /* the range shown; values may lie beyond */
    int logarithmic; /* not 0: a logarithmic axis */
} WeftPlotAxis;

/* A curve. */
typedef struct WeftPlotSeries {
    int entry;          /* of the legend */
    int count;          /* of its points */
    const float *x, *y; /* NAN: a gap */
} WeftPlotSeries;

/* A number that a panel shows. */
typedef struct WeftPlotFigure {
    char name[48], unit[16]; /* "" without a unit */
    double value;            /* in that unit */
} WeftPlotFigure;

/* The largest number of figures and marks of a panel, and of entries of a legend. */
enum { WEFT_PLOT_FIGURES_MAX = 8, WEFT_PLOT_MARKS_MAX = 4, WEFT_PLOT_LEGEND_MAX = 24 };

/* A place on the x axis with a name: the mirror direction, a view. */
typedef struct WeftPlotMark {
    char label[16]; /* the name shown beside the mark */
    float x;        /* place on the axis */
} WeftPlotMark;

/* One panel of a figure. */
typedef struct WeftPlotPanel {
    WeftPlotForm form;            /* selects the members below that are used */
    char title[192];              /* above it */
    WeftPlotAxis x, y, z;         /* z: of the values of a map or a surface */
    int series_count;             /* curves */
    WeftPlotSeries *series;       /* series_count of them */
    int columns, rows;            /* of a grid; rows run with y, or from the top of a picture */
    int channels;                 /* of a grid: 1, or 3 for colours */
    const float *values;          /* columns * rows * channels, NAN: a gap */
    int colored;                  /* not 0: the three channels are radiance, shown times 2^exposure */
    float exposure;               /* stops */
    float center;                 /* of a diverging colour map: values below are blue, above red; NAN: none */
    float view;                   /* theta_o; NAN: none */
    int entry;                    /* of the legend's colours, for a surface */
    int figure_count, mark_count; /* of the two below */
    WeftPlotFigure figures[WEFT_PLOT_FIGURES_MAX]; /* numbers shown in it */
    WeftPlotMark marks[WEFT_PLOT_MARKS_MAX];       /* places on its x axis */
    int cell_count;                                /* of a picture: its equal columns, each with a label below */
    char cells[12][32];                            /* these labels */
} WeftPlotPanel;

/* A figure in numbers. */
typedef struct WeftPlotData {
    char title[192];                        /* above everything */
    int columns;                            /* of panels */
    int count;                              /* of panels */
    WeftPlotPanel *panels;                  /* row after row */
    int legend_count;                       /* of its entries */
    char legend[WEFT_PLOT_LEGEND_MAX][128]; /* in the order of colours */
    char note[256];                         /* below everything: how it was made; "" without one */
    struct WeftPlotMemory *owned;           /* memory of the above, see weft_plot_data_free */
} WeftPlotData;

/* Computes the numbers that a figure shows. Fails with WEFT_MESSAGE_DESC (a value out of its range; samples
 * or ambient of a model that is not a lobe; a map that has no floats; a difference of other than two models) or _MEMORY. */
WEFT_API WeftResult weft_plot_data(const WeftPlotDesc *desc, WeftPlotData *out, WeftError *error);

/* Releases the numbers and zeroes the struct. data may be NULL or all zero. */
WEFT_API void weft_plot_data_free(WeftPlotData *data);

/* Draws the figure as U8 RGB. Fails as weft_plot_data does. */
WEFT_API WeftResult weft_plot_image(const WeftPlotDesc *desc, WeftImage *out, WeftError *error);

/* Returns 1 if weft_plot_write supports this suffix (.png, .svg or .pdf, in any case), else 0. */
WEFT_API int weft_plot_suffix_known(const char *path);

/* Writes the figure by suffix; text in .svg and .pdf is outlines, so that it looks the same everywhere. The
 * file appears complete or not at all. Fails as weft_plot_data does, with WEFT_MESSAGE_OUTPUT_SUFFIX or
 * _FILE_WRITE. */
WEFT_API WeftResult weft_plot_write(const WeftPlotDesc *desc, const char *path, WeftError *error);

/* Writes one page of HTML with every kind of figure that the models have. It needs no other file and no script. kind,
 * title and size of desc are not read. */
WEFT_API WeftResult weft_plot_report(const WeftPlotDesc *desc, const char *path, WeftError *error);

#ifdef __cplusplus
}
#endif

#endif
