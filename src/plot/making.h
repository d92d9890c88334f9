/* making.h - the numbers of a figure as they are made: panels, series and grids in one arena
 *
 * What needs memory returns NULL where that is short; the kind then returns making_short. */
#ifndef WEFT_PLOT_MAKING_H
#define WEFT_PLOT_MAKING_H

#include <stdbool.h>

#include "base/memory.h"
#include "weft/plot.h"

typedef struct Making {
    const WeftPlotDesc *desc;
    WeftPlotData *data;
    Arena *arena;
    WeftError *error;
    int room; /* for panels */
} Making;

/* The kinds: each fills making->data, a file each. */
WeftResult kind_polar(Making *making);
WeftResult kind_lobe3d(Making *making);
WeftResult kind_cartesian(Making *making);
WeftResult kind_albedo(Making *making);
WeftResult kind_furnace(Making *making);
WeftResult kind_slice(Making *making);
WeftResult kind_sphere(Making *making);
WeftResult kind_samples(Making *making);
WeftResult kind_difference(Making *making);

WeftResult making_short(const Making *making);

/* Room for so many panels, all that there will be, in so many columns. */
bool making_panels(Making *making, int most, int columns);

/* The next of them. */
__attribute__((format(printf, 3, 4))) WeftPlotPanel *making_panel(Making *making, WeftPlotForm form,
                                                                  const char *title, ...);

/* Room for so many series of a panel, and the next of them with its x and y, which are the caller's to fill.
 */
bool making_series_room(Making *making, WeftPlotPanel *panel, int most);
WeftPlotSeries *making_series(Making *making, WeftPlotPanel *panel, int entry, int count, float **x,
                              float **y);

/* A grid of values for the caller to fill. */
float *making_grid(Making *making, WeftPlotPanel *panel, int columns, int rows, int channels);

/* One more line of the legend; its number. All models have theirs first. */
int making_legend(Making *making, const char *text);
void making_models(Making *making);
const char *making_label(const Making *making, int model);

void making_axis(WeftPlotAxis *axis, const char *label, const char *unit, float low, float high);
__attribute__((format(printf, 3, 4))) void making_mark(WeftPlotPanel *panel, float x, const char *label, ...);
void making_figure(WeftPlotPanel *panel, const char *name, const char *unit, double value);

/* Return the number of views, and theta_o of one in degrees; `usual` if none was given. */
int making_view_count(const Making *making);
float making_view(const Making *making, int k, float usual);

/* wo = (sin, 0, cos) of degrees, exact at both ends; wi of plane angles: in the plane of wo, beyond the
 * normal where theta > 0; across it, towards y. */
void direction_of_view(float degrees, float w[3]);
void direction_in_plane(float degrees, float w[3]);
void direction_across(float degrees, float w[3]);

/* f of many directions. Of what walks at random each is the mean of `walks` pairs within a degree. */
void making_eval(const WeftPlotModel *model, const float wo[3], int count, const float (*wi)[3], int walks,
                 float (*f)[3]);

/* So many, or a part of that where a first look is asked for. */
int making_walks(const Making *making, int walks);

/* Returns the value of the descriptor's channel for a colour. */
float making_value(const Making *making, const float color[3]);

/* The name of what is plotted: "f", "f cos". */
const char *making_f(const Making *making);

/* theta_i from -90 to 90 degrees, closer about the mirror direction: PLANE_ANGLES of them. */
enum { PLANE_STEPS = 360, PLANE_NEAR = 10, PLANE_ANGLES = PLANE_STEPS + 2 * PLANE_NEAR + 1 };
void plane_angles(float mirror, float theta[PLANE_ANGLES]);

/* A model at another of an artist's roughness: the first parameter of a lobe, sheen_roughness of a material
 * that has a sheen, else roughness. Made in `out`, which has no label, and released with rough_free. False
 * where the model has none, or memory is short. */
typedef struct Rough {
    WeftLobe lobe;
    WeftReflection *reflection;
    WeftPlotModel model;
} Rough;
bool rough_make(const WeftPlotModel *model, float roughness, Rough *out);
void rough_free(Rough *rough);

/* Sets high, and low of a logarithmic axis, of the y of all panels of one form so that they show their series
 * and can be compared. What towers over all else is cut off: curves thirty times as high as the next
 * lower one, unless they are more than half, and what f does within five degrees of the horizon. */
void range_of_f(WeftPlotData *data, WeftPlotForm form, bool logarithmic);

/* 1, 2, 2.5 or 5 times a power of ten, at x or above. */
double round_up(double x);

#endif
