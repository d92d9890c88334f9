/* cartesian.c - f, and f cos, over the angle of wi in the plane of wo */
#include <math.h>

#include "plot/making.h"

enum { WALKS = 4000 };

static WeftPlotPanel *one_panel(Making *making, float view, bool cosine) {
    WeftPlotPanel *panel = making_panel(making, WEFT_PLOT_CURVES, "%s, \xce\xb8\xe2\x82\x92 = %g\xc2\xb0",
                                        cosine ? "f cos \xce\xb8\xe1\xb5\xa2" : "f", (double)view);
    making_axis(&panel->x, "\xce\xb8\xe1\xb5\xa2 in the plane of \xcf\x89\xe2\x82\x92", "\xc2\xb0", -90.0f, 90.0f);
    making_axis(&panel->y, cosine ? "f cos \xce\xb8\xe1\xb5\xa2" : "f", "1/sr", 0.0f, 1.0f);
    panel->view = view;
    making_mark(panel, -view, "\xcf\x89\xe2\x82\x92");
    if (view > 0.0f) making_mark(panel, view, "mirror");
    return making_series_space(making, panel, making->desc->count) ? panel : NULL;
}

static bool both_series(Making *making, WeftPlotPanel *const panels[2], int model, float view) {
    float(*wi)[3] = arena_array(making->arena, PLANE_ANGLES, sizeof *wi);
    float(*f)[3] = arena_array(making->arena, PLANE_ANGLES, sizeof *f);
    float *x[2], *y[2], wo[3];
    if (!wi || !f) return false;
    for (int p = 0; p < 2; p++)
        if (!making_series(making, panels[p], model, PLANE_ANGLES, &x[p], &y[p])) return false;
    plane_angles(view, x[0]);
    direction_of_view(view, wo);
    for (int k = 0; k < PLANE_ANGLES; k++) direction_in_plane(x[0][k], wi[k]);
    making_eval(&making->desc->models[model], wo, PLANE_ANGLES, (const float(*)[3])wi, making_walks(making, WALKS), f);
    for (int k = 0; k < PLANE_ANGLES; k++) {
        x[1][k] = x[0][k];
        y[0][k] = making_value(making, f[k]);
        y[1][k] = y[0][k] * wi[k][2];
    }
    return true;
}

WeftResult kind_cartesian(Making *making) {
    const int views = making_view_count(making);
    if (!making_panels(making, 2 * views, 2)) return making_short(making);
    making_models(making);
    for (int k = 0; k < views; k++) {
        const float view = making_view(making, k, 60.0f);
        WeftPlotPanel *panels[2] = {one_panel(making, view, false), one_panel(making, view, true)};
        if (!panels[0] || !panels[1]) return making_short(making);
        for (int n = 0; n < making->desc->count; n++)
            if (!both_series(making, panels, n, view)) return making_short(making);
    }
    range_of_f(making->data, WEFT_PLOT_CURVES, making->desc->logarithmic != 0);
    return WEFT_OK;
}
