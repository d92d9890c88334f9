/* making.h - construction of a figure's numbers: panels, series and grids in one arena
 *
 * Functions that need memory return NULL or false if it is short; the kind then returns making_short. */
#pragma once

#include <stdbool.h>

#include "base/memory.h"
#include "weft/plot.h"

typedef struct Making {
    const WeftPlotDesc *desc;
    WeftPlotData *data;
    Arena *arena;
    WeftError *error;
    int panels_max; /* capacity of data->panels */
} Making;

/* Fills making->data for a kind of figure; each kind has a file. */
WeftResult kind_polar(Making *making);
WeftResult kind_lobe3d(Making *making);
WeftResult kind_cartesian(Making *making);
WeftResult kind_albedo(Making *making);
WeftResult kind_furnace(Making *making);
WeftResult kind_slice(Making *making);
WeftResult kind_sphere(Making *making);
WeftResult kind_samples(Making *making);
WeftResult kind_difference(Making *making);
WeftResult kind_ambient(Making *making);

/* Returns why a kind of figure is not for a model, or NULL. */
const char *kind_refuses(WeftPlotKind kind, const WeftPlotModel *model);

WeftResult making_short(const Making *making);

/* Allocates panels, at most `most` in all, in so many columns. */
bool making_panels(Making *making, int most, int columns);

/* Adds a panel. */
__attribute__((format(printf, 3, 4))) WeftPlotPanel *making_panel(Making *making, WeftPlotForm form, const char *title,
                                                                  ...);

/* Allocates space for so many series of a panel (making_series_space), and adds a series, whose x and y the caller
 * fills (making_series). */
bool making_series_space(Making *making, WeftPlotPanel *panel, int most);
WeftPlotSeries *making_series(Making *making, WeftPlotPanel *panel, int entry, int count, float **x, float **y);

/* Adds the grid of values of a panel for the caller to fill. */
float *making_grid(Making *making, WeftPlotPanel *panel, int columns, int rows, int channels);

/* Adds a line to the legend and returns its number. making_models adds the models, which come first. */
int making_legend(Making *making, const char *text);
void making_models(Making *making);
const char *making_label(const Making *making, int model);

void making_axis(WeftPlotAxis *axis, const char *label, const char *unit, float low, float high);
__attribute__((format(printf, 3, 4))) void making_mark(WeftPlotPanel *panel, float x, const char *label, ...);
void making_figure(WeftPlotPanel *panel, const char *name, const char *unit, double value);

/* Returns the number of views, and theta_o of one in degrees; `usual` if none was given. */
int making_view_count(const Making *making);
float making_view(const Making *making, int k, float usual);

/* Computes wo = (sin, 0, cos) of an angle in degrees, exact at both ends; and wi of a plane angle: in the plane of wo,
 * beyond the normal if it is positive, or across that plane, towards y. */
void direction_of_view(float degrees, float w[3]);
void direction_in_plane(float degrees, float w[3]);
void direction_across(float degrees, float w[3]);

/* Evaluates f for many directions. For a lobe that walks at random each f is the mean of `walks` pairs within a
 * degree. */
void making_eval(const WeftPlotModel *model, const float wo[3], int count, const float (*wi)[3], int walks,
                 float (*f)[3]);

/* Returns `walks`, or an eighth of it for a quick figure. */
int making_walks(const Making *making, int walks);

/* Returns the value of the descriptor's channel for a colour. */
float making_value(const Making *making, const float color[3]);

/* Returns the name of the plotted quantity: "f" or "f cos" with a subscript. */
const char *making_f(const Making *making);

/* Fills theta with theta_i from -90 to 90 degrees: middles of half degrees, the mirror direction, and angles at halving
 * distances from it on both sides. */
enum { PLANE_STEPS = 360, PLANE_NEAR = 10, PLANE_ANGLES = PLANE_STEPS + 2 * PLANE_NEAR + 1 };
void plane_angles(float mirror, float theta[PLANE_ANGLES]);

/* A model at another roughness. */
typedef struct Rough {
    WeftLobe lobe;
    WeftReflection *reflection;
    WeftPlotModel model;
} Rough;

/* Makes a model at an artist's roughness, which sets the first parameter of a lobe, sheen_roughness of a material that
 * has a sheen, else roughness. Returns false if the model has no roughness or memory is short; release with rough_free
 * in any case. */
bool rough_make(const WeftPlotModel *model, float roughness, Rough *out);
void rough_free(Rough *rough);

/* Returns true if the model has a roughness. */
bool rough_is_there(const WeftPlotModel *model);

/* Sets high, and low of a logarithmic axis, of the y of all panels of one form, so that they show their series and can
 * be compared. Outliers are cut off: curves thirty times as high as the next lower one, unless they are more than half,
 * and f within five degrees of the horizon. */
void range_of_f(WeftPlotData *data, WeftPlotForm form, bool logarithmic);

/* Returns the least 1, 2, 2.5 or 5 times a power of ten that is not below x. */
double round_up(double x);
