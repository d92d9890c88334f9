#include "measure/cloth/map_texel.h"

#include <math.h>

#include "shading/media/yarn_medium.h"
#include "shading/weave/weave_light.h"

enum { FINE = 2 }; /* points along a texel's side */

/* Returns the part of light that leaves white fibres after it met one of them (yarn_medium.h). */
static float single_of(float alpha) { return 0.328f - 0.111f * alpha; }

float map_spacing(const MapGrid *grid) {
    return fmaxf(grid->weave.cycle_x / (float)grid->width, grid->weave.cycle_y / (float)grid->height) / FINE;
}

/* Adds a point of the cloth to a texel. */
static void add_point(const Weave *m, float x, float y, float spacing, MapTexel *t) {
    const WeavePoint p = weave_point(m, x, y, spacing, 0.0f);
    const float part = 1.0f / (FINE * FINE);
    if (p.height <= WEAVE_NONE) {
        t->height += part * m->low;
        return;
    }
    const float alpha = p.weft ? m->weft.alpha : m->warp.alpha, single = single_of(alpha);
    for (int c = 0; c < 3; c++) {
        const float a = weave_albedo(m, p, c);
        t->color[c] += part * (a * single + yarn_reflectance(a) * (1.0f - single));
    }
    t->cover += part;
    t->light += part * weave_open(m, p);
    t->slope[0] += part * p.slope_x;
    t->slope[1] += part * p.slope_y;
    t->roughness += part * sqrtf(alpha);
    t->open += part * weave_depth(m, p);
    t->height += part * p.height;
    const float across = p.fibre.x * p.fibre.x + p.fibre.y * p.fibre.y;
    t->along[0] += part * (p.fibre.x * p.fibre.x - p.fibre.y * p.fibre.y) / fmaxf(across, 1e-6f);
    t->along[1] += part * 2.0f * p.fibre.x * p.fibre.y / fmaxf(across, 1e-6f);
}

MapTexel map_texel(const MapGrid *grid, int column, int row) {
    const float spacing = map_spacing(grid);
    MapTexel t = {.cover = 0.0f};
    for (int k = 0; k < FINE * FINE; k++) {
        const int right = k % FINE, down = k / FINE;
        const float x = map_x(grid, (float)column + ((float)right + 0.5f) / FINE);
        const float y = map_y(grid, (float)row + ((float)down + 0.5f) / FINE);
        add_point(&grid->weave, x, y, spacing, &t);
    }
    return t;
}

void map_texel_add(MapTexel *to, const MapTexel *texel, float part) {
    for (int c = 0; c < 3; c++) to->color[c] += part * texel->color[c];
    for (int a = 0; a < 2; a++) {
        to->slope[a] += part * texel->slope[a];
        to->along[a] += part * texel->along[a];
    }
    to->cover += part * texel->cover;
    to->light += part * texel->light;
    to->roughness += part * texel->roughness;
    to->open += part * texel->open;
    to->height += part * texel->height;
}

float map_texel_color(const MapTexel *t, int c, float shade, bool holed) {
    const float cover = fmaxf(t->cover, 1e-6f);
    return t->color[c] / (holed ? cover : 1.0f) * powf(fmaxf(t->light / cover, 0.0f), shade);
}

float map_texel_stretch(const MapTexel *t, float *angle) {
    *angle = 0.5f * atan2f(t->along[1], t->along[0]) + PI / 2.0f;
    if (*angle > 0.75f * PI)
        *angle -= PI; /* neither system lies where opposite ones meet, so that means of texels hold */
    return sqrtf(t->along[0] * t->along[0] + t->along[1] * t->along[1]) / fmaxf(t->cover, 1e-6f);
}
