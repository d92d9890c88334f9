/* lobe_surface.c - a panel of a surface over the ground: lengths by direction, seen obliquely from above
 *
 * Triangles are drawn with a depth buffer at SAMPLES times the resolution of the page. The result is laid over the
 * ground, which Cairo draws; from above no part of the ground can cover the surface. */
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "base/fail.h"
#include "base/memory.h"
#include "base/pi.h"
#include "plot/axes.h"

enum { SAMPLES = 3, SIDE_MOST = 3000 };

/* The viewer of the parallel projection, radians: 35 degrees to the side of the plane of wo, 28 above the ground. */
static const double azimuth = 0.61, rise = 0.49;

typedef struct SurfacePoint {
    double x, y, depth; /* on the page; depth grows away from the viewer */
} SurfacePoint;

typedef struct PlotStage {
    double x, y, radius; /* of the ground's circle; the radius is the length of the largest value */
    Scale scale;         /* from values to lengths on the page */
    PageBox box;
    int width, height; /* of the buffers */
    double fine;       /* their pixels per page's */
    float *depth, (*color)[4];
} PlotStage;

static SurfacePoint project(const PlotStage *stage, const double p[3]) {
    double along = p[0] * cos(azimuth) + p[1] * sin(azimuth), across = p[1] * cos(azimuth) - p[0] * sin(azimuth);
    return (SurfacePoint){stage->x + across, stage->y - p[2] * cos(rise) + along * sin(rise),
                          -(along * cos(rise) + p[2] * sin(rise))};
}

static double length_of(const PlotStage *stage, float value) {
    return fmin(fmax(scale_place(&stage->scale, (double)value), 0.0), stage->radius);
}

/* Computes the position of a node of the grid in the stage's space. */
static void node(const PlotStage *stage, const WeftPlotPanel *panel, int row, int column, double p[3]) {
    float value = panel->values[row * panel->columns + column];
    double theta = 0.5 * PI_DOUBLE * row / (panel->rows - 1);
    double phi = 2.0 * PI_DOUBLE * column / (panel->columns - 1);
    double r = isnan(value) ? 0.0 : length_of(stage, value);
    p[0] = r * sin(theta) * cos(phi), p[1] = r * sin(theta) * sin(phi), p[2] = r * cos(theta);
}

static void normal_of(const double a[3], const double b[3], const double c[3], double n[3]) {
    double u[3], v[3];
    for (int k = 0; k < 3; k++) u[k] = b[k] - a[k], v[k] = c[k] - a[k];
    n[0] = u[1] * v[2] - u[2] * v[1], n[1] = u[2] * v[0] - u[0] * v[2], n[2] = u[0] * v[1] - u[1] * v[0];
    double length = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    for (int k = 0; k < 3; k++) n[k] /= fmax(length, 1e-30);
}

/* Returns the brightness of a normal in light from the viewer's upper left, which lights both sides. */
static double shade(const double n[3]) {
    static const double light[3] = {0.62, -0.28, 0.73};
    return 0.45 + 0.55 * fabs(n[0] * light[0] + n[1] * light[1] + n[2] * light[2]);
}

static double edge(SurfacePoint a, SurfacePoint b, double x, double y) {
    return (b.x - a.x) * (y - a.y) - (b.y - a.y) * (x - a.x);
}

/* A corner of a triangle, with its place in the cell of the mesh. */
typedef struct PlotCorner {
    SurfacePoint at;
    double across, along;
} PlotCorner;

static void fill(const PlotStage *stage, const PlotCorner corner[3], const float color[3], const bool mesh[2]) {
    const double thin = 0.35; /* of a cell */
    SurfacePoint a = corner[0].at, b = corner[1].at, c = corner[2].at;
    double area = edge(a, b, c.x, c.y);
    if (fabs(area) < 1e-9) return;
    int left = (int)floor(fmax(fmin(a.x, fmin(b.x, c.x)), 0.0));
    int right = (int)ceil(fmin(fmax(a.x, fmax(b.x, c.x)), stage->width - 1.0));
    int top = (int)floor(fmax(fmin(a.y, fmin(b.y, c.y)), 0.0));
    int bottom = (int)ceil(fmin(fmax(a.y, fmax(b.y, c.y)), stage->height - 1.0));
    for (int y = top; y <= bottom; y++)
        for (int x = left; x <= right; x++) {
            double u = edge(b, c, x + 0.5, y + 0.5) / area, v = edge(c, a, x + 0.5, y + 0.5) / area;
            double w = 1.0 - u - v;
            if (u < -1e-9 || v < -1e-9 || w < -1e-9) continue;
            float depth = (float)(u * a.depth + v * b.depth + w * c.depth);
            size_t at = (size_t)y * (size_t)stage->width + (size_t)x;
            if (depth >= stage->depth[at]) continue;
            double across = u * corner[0].across + v * corner[1].across + w * corner[2].across;
            double along = u * corner[0].along + v * corner[1].along + w * corner[2].along;
            bool line = (mesh[0] && across < thin) || (mesh[1] && along < thin);
            stage->depth[at] = depth;
            for (int k = 0; k < 3; k++) stage->color[at][k] = color[k] * (line ? 0.6f : 1.0f);
            stage->color[at][3] = 1.0f;
        }
}

/* Projects a point to pixels of the buffers. */
static SurfacePoint fine_point(const PlotStage *stage, const double p[3]) {
    SurfacePoint point = project(stage, p);
    point.x = (point.x - stage->box.x) * stage->fine;
    point.y = (point.y - stage->box.y) * stage->fine;
    return point;
}

/* Returns true if node k lies on a line of the mesh: every fifteen degrees the surface is darker. */
static bool on_mesh(int k, int nodes, int degrees) {
    int step = (nodes - 1) * 15 / degrees;
    return step > 0 && k % step == 0;
}

static void fill_cell(const PlotStage *stage, const WeftPlotPanel *panel, int row, int column) {
    double p[4][3], n[3];
    PlotCorner at[4];
    for (int k = 0; k < 4; k++) {
        const int along = k / 2, across = k % 2;
        node(stage, panel, row + along, column + across, p[k]);
        at[k] = (PlotCorner){fine_point(stage, p[k]), across, along};
    }
    normal_of(p[0], p[1], p[3], n);
    if (!(fabs(n[0]) + fabs(n[1]) + fabs(n[2]) > 0.5)) normal_of(p[0], p[3], p[2], n);
    const double *base = entry_color(panel->entry);
    const bool mesh[2] = {on_mesh(column, panel->columns, 360), on_mesh(row, panel->rows, 90)};
    float color[3];
    /* lifted towards white, so that black too has shades */
    for (int k = 0; k < 3; k++) color[k] = (float)((0.22 + 0.78 * base[k]) * shade(n));
    fill(stage, (PlotCorner[3]){at[0], at[1], at[3]}, color, mesh);
    fill(stage, (PlotCorner[3]){at[0], at[3], at[2]}, color, mesh);
}

static void circle(const Page *page, const PlotStage *stage, double radius) {
    cairo_new_path(page->cairo);
    for (int k = 0; k <= 90; k++) {
        double phi = 2.0 * PI_DOUBLE * k / 90, p[3] = {radius * cos(phi), radius * sin(phi), 0.0};
        SurfacePoint at = project(stage, p);
        cairo_line_to(page->cairo, at.x, at.y);
    }
    cairo_close_path(page->cairo);
}

static void draw_ground(const Page *page, const WeftPlotPanel *panel, const PlotStage *stage) {
    const double type = page->type;
    Tick ticks[TICKS_MAX];
    int count = ticks_make(&stage->scale, false, 2.8 * type, ticks);
    circle(page, stage, stage->radius);
    cairo_set_source_rgb(page->cairo, 0.955, 0.955, 0.96);
    cairo_fill(page->cairo);
    for (int degrees = 0; degrees < 360; degrees += 30) {
        double phi = degrees * RADIANS;
        double p[3] = {stage->radius * cos(phi), stage->radius * sin(phi), 0.0}, o[3] = {0.0};
        SurfacePoint at = project(stage, p), center = project(stage, o);
        rule(page, ink_grid, 0.06, center.x, center.y, at.x, at.y);
    }
    for (int k = 0; k < count; k++) {
        if (!ticks[k].text[0]) continue;
        circle(page, stage, scale_place(&stage->scale, ticks[k].value));
        cairo_set_source_rgb(page->cairo, ink_grid[0], ink_grid[1], ink_grid[2]);
        cairo_set_line_width(page->cairo, 0.06 * type);
        cairo_stroke(page->cairo);
    }
    circle(page, stage, stage->radius);
    cairo_set_source_rgb(page->cairo, ink_dim[0], ink_dim[1], ink_dim[2]);
    cairo_set_line_width(page->cairo, 0.07 * type);
    cairo_stroke(page->cairo);
}

/* Draws a ruler with the values below the ground, where the surface cannot cover it. */
static void draw_labels(const Page *page, const WeftPlotPanel *panel, const PlotStage *stage) {
    const double type = page->type;
    Tick ticks[TICKS_MAX];
    int count = ticks_make(&stage->scale, false, 2.8 * type, ticks);
    set_font(page->cairo, 0.8 * type, false);
    /* a ruler in front: from below the middle of the ground to its right end */
    double base = project(stage, (double[3]){stage->radius, 0.0, 0.0}).y;
    base = fmax(base, stage->y + stage->radius * sin(rise)) + 0.6 * type;
    rule(page, ink_dark, 0.08, stage->x, base, stage->x + stage->radius, base);
    double last = -HUGE_VAL;
    for (int k = 0; k < count; k++) {
        double length = scale_place(&stage->scale, ticks[k].value), x = stage->x + length;
        rule(page, ink_dark, 0.07, x, base, x, base + (ticks[k].text[0] ? 0.3 : 0.15) * type);
        if (!ticks[k].text[0] || length - last < text_width(page->cairo, ticks[k].text)) continue;
        place_text(page->cairo, ink_dark, x, base + 1.2 * type, 0.5, ticks[k].text);
        last = length + 0.5 * type;
    }
    char label[96];
    axis_text(&panel->z, label);
    set_font(page->cairo, 0.9 * type, false);
    place_text(page->cairo, ink_dark, stage->x - 1.8 * type, base + 0.6 * type, 1.0, label);
}

/* Draws the parts of the arrow towards the viewer that the surface does not cover. */
static void draw_arrow(const Page *page, const WeftPlotPanel *panel, const PlotStage *stage) {
    enum { PARTS = 400 };
    const double type = page->type, angle = (double)panel->view * RADIANS;
    const double reach = 1.06 * stage->radius;
    SurfacePoint tip = {0.0, 0.0, 0.0}, before = {0.0, 0.0, 0.0};
    cairo_set_source_rgb(page->cairo, ink_dark[0], ink_dark[1], ink_dark[2]);
    cairo_set_line_width(page->cairo, 0.13 * type);
    for (int k = 0; k < PARTS; k++) {
        double p[3] = {reach * k / PARTS * sin(angle), 0.0, reach * k / PARTS * cos(angle)};
        double q[3] = {p[0] * (k + 1.2) / fmax(k, 1), 0.0, p[2] * (k + 1.2) / fmax(k, 1)};
        SurfacePoint at = project(stage, p), fine = fine_point(stage, p), next = project(stage, q);
        int x = (int)fine.x, y = (int)fine.y;
        bool inside = x >= 0 && y >= 0 && x < stage->width && y < stage->height;
        before = at;
        tip = next;
        if (inside && (double)stage->depth[(size_t)y * (size_t)stage->width + (size_t)x] < at.depth - 0.5) continue;
        cairo_move_to(page->cairo, at.x, at.y);
        cairo_line_to(page->cairo, next.x, next.y);
    }
    cairo_stroke(page->cairo);
    double dx = tip.x - before.x, dy = tip.y - before.y, length = fmax(hypot(dx, dy), 1e-9);
    dx *= 0.7 * type / length, dy *= 0.7 * type / length;
    cairo_move_to(page->cairo, tip.x + dx, tip.y + dy);
    cairo_line_to(page->cairo, tip.x - 0.45 * dy, tip.y + 0.45 * dx);
    cairo_line_to(page->cairo, tip.x + 0.45 * dy, tip.y - 0.45 * dx);
    cairo_close_path(page->cairo);
    cairo_fill(page->cairo);
    set_font(page->cairo, 0.9 * type, false);
    place_text(page->cairo, ink_dark, tip.x + 2.3 * dx, tip.y + 2.3 * dy + 0.3 * type, 0.5, "\xcf\x89\xe2\x82\x92");
}

/* Paints the fine buffer over the page, averaged to the page's resolution; pixels without surface are transparent. */
static WeftResult lay_over(const Page *page, const PlotStage *stage) {
    cairo_surface_t *surface = cairo_image_surface_create(CAIRO_FORMAT_ARGB32, stage->width, stage->height);
    if (cairo_surface_status(surface) != CAIRO_STATUS_SUCCESS) {
        cairo_surface_destroy(surface);
        return fail(page->error, WEFT_MESSAGE_MEMORY, "plot", NULL);
    }
    unsigned char *pixels = cairo_image_surface_get_data(surface);
    const size_t stride = (size_t)cairo_image_surface_get_stride(surface);
    for (int y = 0; y < stage->height; y++)
        for (int x = 0; x < stage->width; x++) {
            const float *color = stage->color[(size_t)y * (size_t)stage->width + (size_t)x];
            uint32_t word = color[3] > 0.5f ? 255u : 0u;
            for (int k = 0; k < 3; k++)
                word = word << 8 | (uint32_t)(color[3] * fminf(fmaxf(color[k], 0.0f), 1.0f) * 255.0f + 0.5f);
            memcpy(pixels + (size_t)y * stride + 4 * (size_t)x, &word, 4);
        }
    cairo_surface_mark_dirty(surface);
    cairo_save(page->cairo);
    cairo_translate(page->cairo, stage->box.x, stage->box.y);
    cairo_scale(page->cairo, 1.0 / stage->fine, 1.0 / stage->fine);
    cairo_set_source_surface(page->cairo, surface, 0.0, 0.0);
    cairo_pattern_set_filter(cairo_get_source(page->cairo), CAIRO_FILTER_GOOD);
    cairo_paint(page->cairo);
    cairo_restore(page->cairo);
    cairo_surface_destroy(surface);
    return WEFT_OK;
}

/* Returns the height that surface and arrow reach above the middle of the ground, in radii. */
static double reach_up(const WeftPlotPanel *panel) {
    PlotStage unit = {.radius = 1.0, .scale = scale_of(&panel->z, 0.0, 1.0)};
    double angle = (double)panel->view * RADIANS;
    const double tip[3] = {1.06 * sin(angle), 0.0, 1.06 * cos(angle)};
    double most = fmax(sin(rise), -project(&unit, tip).y);
    for (int row = 0; row < panel->rows; row += 2)
        for (int column = 0; column < panel->columns; column += 2) {
            double p[3];
            node(&unit, panel, row, column, p);
            most = fmax(most, -project(&unit, p).y);
        }
    return most;
}

/* Returns the stage, as large as width and height allow and centred. */
static PlotStage stage_of(const Page *page, const WeftPlotPanel *panel, PageBox box) {
    const double type = page->type, height = box.height - 5.0 * type, up = reach_up(panel);
    PlotStage stage = {.box = box};
    stage.radius = fmax(fmin(0.5 * box.width - 2.0 * type, height / (up + sin(rise))), type);
    stage.x = box.x + 0.5 * box.width;
    stage.y = box.y + 2.0 * type + 0.5 * (height - stage.radius * (up + sin(rise))) + stage.radius * up;
    stage.scale = scale_of(&panel->z, 0.0, stage.radius);
    stage.fine = fmin(SAMPLES, SIDE_MOST / fmax(box.width, box.height));
    stage.width = (int)fmax(box.width * stage.fine, 1.0);
    stage.height = (int)fmax(box.height * stage.fine, 1.0);
    return stage;
}

WeftResult draw_surface(const Page *page, const WeftPlotPanel *panel, PageBox box) {
    PlotStage stage = stage_of(page, panel, box);
    const size_t count = (size_t)stage.width * (size_t)stage.height;
    stage.depth = alloc_array(count, sizeof *stage.depth);
    stage.color = alloc_array(count, sizeof *stage.color);
    const bool made = stage.depth && stage.color;
    WeftResult result = made ? WEFT_OK : fail(page->error, WEFT_MESSAGE_MEMORY, "plot", NULL);
    if (made) {
        for (size_t k = 0; k < count; k++) stage.depth[k] = HUGE_VALF;
        for (int row = 0; row + 1 < panel->rows; row++)
            for (int column = 0; column + 1 < panel->columns; column++) fill_cell(&stage, panel, row, column);
        draw_ground(page, panel, &stage);
        result = lay_over(page, &stage);
        draw_arrow(page, panel, &stage);
        draw_labels(page, panel, &stage);
    }
    free(stage.depth);
    free(stage.color);
    return result;
}
