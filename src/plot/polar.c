/* polar.c - f as a length over the angle of wi, in the plane of wo and across it */
#include <math.h>

#include "plot/making.h"

enum { WALKS = 4000 };

static bool one_series(Making *making, WeftPlotPanel *panel, int model, float view, bool across) {
    float(*wi)[3] = arena_array(making->arena, PLANE_ANGLES, sizeof *wi);
    float(*f)[3] = arena_array(making->arena, PLANE_ANGLES, sizeof *f);
    float *x, *y, wo[3];
    if (!wi || !f || !making_series(making, panel, model, PLANE_ANGLES, &x, &y)) return false;
    plane_angles(across ? 0.0f : view, x);
    direction_of_view(view, wo);
    for (int k = 0; k < PLANE_ANGLES; k++)
        if (across)
            direction_across(x[k], wi[k]);
        else
            direction_in_plane(x[k], wi[k]);
    making_eval(&making->desc->models[model], wo, PLANE_ANGLES, (const float(*)[3])wi, making_walks(making, WALKS), f);
    for (int k = 0; k < PLANE_ANGLES; k++) y[k] = making_value(making, f[k]) * (making->desc->cosine ? wi[k][2] : 1.0f);
    return true;
}

WeftResult kind_polar(Making *making) {
    const int views = making_view_count(making);
    if (!making_panels(making, 2 * views, 2)) return making_short(making);
    making_models(making);
    for (int k = 0; k < 2 * views; k++) {
        const bool across = k % 2 != 0;
        const float view = making_view(making, k / 2, 60.0f);
        WeftPlotPanel *panel = making_panel(
            making, WEFT_PLOT_ROSE, "%s, \xce\xb8\xe2\x82\x92 = %g\xc2\xb0, %s", making_f(making), (double)view,
            across ? "across the plane of \xcf\x89\xe2\x82\x92" : "in the plane of \xcf\x89\xe2\x82\x92");
        making_axis(&panel->x, "\xce\xb8\xe1\xb5\xa2", "\xc2\xb0", -90.0f, 90.0f);
        making_axis(&panel->y, making_f(making), "1/sr", 0.0f, 1.0f);
        panel->view = across ? NAN : view;
        if (!making_series_space(making, panel, making->desc->count)) return making_short(making);
        for (int n = 0; n < making->desc->count; n++)
            if (!one_series(making, panel, n, view, across)) return making_short(making);
    }
    range_of_f(making->data, WEFT_PLOT_ROSE, making->desc->logarithmic != 0);
    return WEFT_OK;
}
