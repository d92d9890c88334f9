#include "plot/axes.h"

#include "base/pi.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

Scale scale_of(const WeftPlotAxis *axis, double from, double to) {
    return (Scale){.low = (double)axis->low,
                   .high = (double)axis->high,
                   .from = from,
                   .to = to,
                   .logarithmic = axis->logarithmic != 0};
}

double scale_place(const Scale *scale, double value) {
    double t = scale->logarithmic
                   ? (log10(fmax(value, 1e-30)) - log10(scale->low)) / (log10(scale->high) - log10(scale->low))
                   : (value - scale->low) / (scale->high - scale->low);
    return scale->from + t * (scale->to - scale->from);
}

bool axis_in_degrees(const WeftPlotAxis *axis) { return strcmp(axis->unit, "\xc2\xb0") == 0; }

void axis_text(const WeftPlotAxis *axis, char text[96]) {
    if (axis->unit[0])
        snprintf(text, 96, "%s  [%s]", axis->label, axis->unit);
    else
        snprintf(text, 96, "%s", axis->label);
}

/* Replaces hyphens before a number by minus signs. */
static void typeset(const char *ascii, char text[24]) {
    size_t used = 0;
    for (const char *s = ascii; *s && used + 4 < 24; s++) {
        if (*s == '-' && (s == ascii || s[-1] == 'e')) {
            memcpy(text + used, "\xe2\x88\x92", 3);
            used += 3;
        } else {
            text[used++] = *s;
        }
    }
    text[used] = '\0';
}

void value_text(double value, int digits, char text[24]) {
    char ascii[24];
    double size = fabs(value);
    bool whole = size < 1e9 && !(size > floor(size));
    if (whole || (size >= 999.5 && size < 99999.5))
        snprintf(ascii, sizeof ascii, "%.0f", value);
    else
        snprintf(ascii, sizeof ascii, "%.*g", digits, value);
    char *e = strchr(ascii, 'e');
    if (e) { /* "1.3e+05" becomes "1.3e5" */
        char *from = e + 1, *to = e + 1;
        if (*from == '-') *to++ = '-';
        if (*from == '-' || *from == '+') from++;
        while (*from == '0' && from[1]) from++;
        memmove(to, from, strlen(from) + 1);
    }
    typeset(ascii, text);
}

/* Writes a power of ten, in digits if short, else with a raised exponent. */
static void decade_text(int exponent, char text[24]) {
    static const char *const raised[10] = {"\xe2\x81\xb0", "\xc2\xb9",     "\xc2\xb2",     "\xc2\xb3",
                                           "\xe2\x81\xb4", "\xe2\x81\xb5", "\xe2\x81\xb6", "\xe2\x81\xb7",
                                           "\xe2\x81\xb8", "\xe2\x81\xb9"};
    int size = exponent < 0 ? -exponent : exponent;
    if (exponent >= -2 && exponent <= 3)
        snprintf(text, 24, "%g", pow(10.0, exponent));
    else
        snprintf(text, 24, "10%s%s%s", exponent < 0 ? "\xe2\x81\xbb" : "", size > 9 ? raised[size / 10 % 10] : "",
                 raised[size % 10]);
}

static int decades(const Scale *scale, double spacing, Tick ticks[TICKS_MAX]) {
    int first = (int)lround(ceil(log10(scale->low) - 1e-6)), last = (int)lround(floor(log10(scale->high) + 1e-6));
    double decade = fabs(scale->to - scale->from) / fmax(log10(scale->high / scale->low), 1e-3);
    int step = (int)ceil(spacing / decade), count = 0;
    if (step < 1) step = 1;
    for (int e = first - 1; e <= last && count < TICKS_MAX - 9; e++) {
        if (e >= first) {
            ticks[count].value = pow(10.0, e);
            ticks[count].text[0] = '\0';
            if ((e - first) % step == 0) decade_text(e, ticks[count].text);
            count++;
        }
        for (int m = 2; m < 10 && step == 1; m++) {
            double value = m * pow(10.0, e);
            if (value >= scale->low && value <= scale->high * 1.0001)
                ticks[count++] = (Tick){.value = value, .text = ""};
        }
    }
    return count;
}

static double step_of(const Scale *scale, bool degrees, double spacing) {
    static const double rights[] = {1.0, 2.0, 5.0, 10.0, 15.0, 30.0, 45.0, 90.0};
    double least = spacing * fabs((scale->high - scale->low) / (scale->to - scale->from));
    if (!degrees || least < 1.0) {
        const double steps[] = {1.0, 2.0, 5.0, 10.0}, power = pow(10.0, floor(log10(least)));
        for (int k = 0; k < 4; k++)
            if (steps[k] * power >= least) return steps[k] * power;
    }
    for (size_t k = 0; k < sizeof rights / sizeof *rights; k++)
        if (rights[k] >= least) return rights[k];
    return 90.0;
}

int ticks_make(const Scale *scale, bool degrees, double spacing, Tick ticks[TICKS_MAX]) {
    if (scale->logarithmic) return decades(scale, spacing, ticks);
    double step = step_of(scale, degrees, spacing);
    int count = 0, places = (int)fmax(-floor(log10(step) + 1e-9), 0.0);
    double most = fmax(fabs(scale->low), fabs(scale->high));
    for (double k = ceil(scale->low / step - 1e-6); k * step <= scale->high + 1e-6 * step && count < TICKS_MAX;
         k += 1.0) {
        char ascii[24];
        double value = fabs(k) < 0.5 ? 0.0 : k * step;
        ticks[count].value = value;
        if (most >= 1e5 || places > 4) {
            value_text(value, 3, ticks[count].text);
        } else {
            snprintf(ascii, sizeof ascii, "%.*f", places, value);
            typeset(ascii, ticks[count].text);
        }
        count++;
    }
    return count;
}

static double widest(const Page *page, const Tick *ticks, int count) {
    double most = 0.0;
    for (int k = 0; k < count; k++) most = fmax(most, text_width(page->cairo, ticks[k].text));
    return most;
}

static void draw_x(const Page *page, const WeftPlotPanel *panel, PageBox in, const Tick *ticks, int count) {
    const double type = page->type, bottom = in.y + in.height;
    Scale scale = scale_of(&panel->x, in.x, in.x + in.width);
    for (int k = 0; k < count; k++) {
        double x = scale_place(&scale, ticks[k].value);
        bool major = ticks[k].text[0] != '\0';
        if (major && panel->form == WEFT_PLOT_CURVES) rule(page, ink_grid, 0.05, x, in.y, x, bottom);
        rule(page, ink_dark, 0.07, x, bottom, x, bottom + (major ? 0.35 : 0.2) * type);
        place_text(page->cairo, ink_dark, x, bottom + 1.35 * type, 0.5, ticks[k].text);
    }
    char label[96];
    axis_text(&panel->x, label);
    place_text(page->cairo, ink_dark, in.x + 0.5 * in.width, bottom + 2.75 * type, 0.5, label);
}

static void draw_y(const Page *page, const WeftPlotPanel *panel, PageBox in, double left, const Tick *ticks,
                   int count) {
    const double type = page->type;
    Scale scale = scale_of(&panel->y, in.y + in.height, in.y);
    for (int k = 0; k < count; k++) {
        double y = scale_place(&scale, ticks[k].value);
        bool major = ticks[k].text[0] != '\0';
        if (major && panel->form == WEFT_PLOT_CURVES) rule(page, ink_grid, 0.05, in.x, y, in.x + in.width, y);
        rule(page, ink_dark, 0.07, in.x - (major ? 0.35 : 0.2) * type, y, in.x, y);
        place_text(page->cairo, ink_dark, in.x - 0.55 * type, y + 0.36 * type, 1.0, ticks[k].text);
    }
    char label[96];
    axis_text(&panel->y, label);
    cairo_save(page->cairo);
    cairo_translate(page->cairo, left + 0.9 * type, in.y + 0.5 * in.height);
    cairo_rotate(page->cairo, -(0.5 * PI_DOUBLE));
    place_text(page->cairo, ink_dark, 0.0, 0.0, 0.5, label);
    cairo_restore(page->cairo);
}

PageBox axes_draw(const Page *page, const WeftPlotPanel *panel, PageBox box) {
    const double type = page->type;
    Tick x[TICKS_MAX], y[TICKS_MAX];
    set_font(page->cairo, 0.9 * type, false);
    Scale up = scale_of(&panel->y, box.y + box.height - 3.2 * type, box.y + 0.5 * type);
    int rows = ticks_make(&up, axis_in_degrees(&panel->y), 2.4 * type, y);
    double left = widest(page, y, rows) + 2.2 * type;
    PageBox in = {box.x + left, box.y + 0.5 * type, box.width - left - 1.2 * type, box.height - 3.7 * type};
    Scale across = scale_of(&panel->x, in.x, in.x + in.width);
    int columns = ticks_make(&across, axis_in_degrees(&panel->x), 3.6 * type, x);
    draw_x(page, panel, in, x, columns);
    draw_y(page, panel, in, box.x, y, rows);
    cairo_rectangle(page->cairo, in.x, in.y, in.width, in.height);
    cairo_set_source_rgb(page->cairo, ink_dark[0], ink_dark[1], ink_dark[2]);
    cairo_set_line_width(page->cairo, 0.08 * type);
    cairo_stroke(page->cairo);
    return in;
}
