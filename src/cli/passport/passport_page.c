#include <math.h>
#include <string.h>

#include "cli/passport/passports.h"

/* Writes text with HTML characters escaped, since ids and drivers' names may contain any. */
static void escaped(FILE *f, const char *text) {
    for (; *text; text++) switch (*text) {
        case '<': fputs("&lt;", f); break;
        case '>': fputs("&gt;", f); break;
        case '&': fputs("&amp;", f); break;
        case '"': fputs("&quot;", f); break;
        default: fputc(*text, f);
        }
}

/* A plot: x runs over [0, 1], y over [0, top]. */
typedef struct PassportPlot {
    FILE *stream;
    double top;
    int curves, of; /* drawn so far, and in all; colours run from violet to yellow-green */
} PassportPlot;

enum { LEFT = 46, TOP = 26, WIDE = 330, HIGH = 200, KEY = 150 };

static double plot_x(double x) { return LEFT + WIDE * x; }
static double plot_y(const PassportPlot *plot, double y) { return TOP + HIGH * (1.0 - fmin(y / plot->top, 1.0)); }

/* Begins a plot. Values above 1 are shaded; NaN is drawn along the top. */
static PassportPlot plot_open(FILE *f, const char *title, const char *x_name, double most, int of) {
    double steps[] = {1.2, 1.6, 2.0, 3.0, 4.0, 6.0, 8.0, 12.0};
    PassportPlot plot = {.stream = f, .top = most < 1e6 ? most : 1e6, .of = of};
    for (int k = 7; k >= 0; k--)
        if (steps[k] > most) plot.top = steps[k];
    fprintf(f, "<svg viewBox=\"0 0 %d %d\" width=\"%d\" role=\"img\"><title>%s</title>\n", LEFT + WIDE + KEY,
            TOP + HIGH + 42, LEFT + WIDE + KEY, title);
    fprintf(f, "<text x=\"%d\" y=\"16\" class=\"title\">%s</text>\n", LEFT, title);
    fprintf(f, "<rect x=\"%d\" y=\"%d\" width=\"%d\" height=\"%.1f\" class=\"above\"/>\n", LEFT, TOP, WIDE,
            plot_y(&plot, 1.0) - TOP);
    for (int k = 0; k <= 4; k++) {
        double y = plot_y(&plot, plot.top * k / 4), x = plot_x(k / 4.0);
        fprintf(f, "<path d=\"M%d %.1fh%dM%.1f %dv5\" class=\"grid\"/>\n", LEFT, y, WIDE, x, TOP + HIGH);
        fprintf(f, "<text x=\"%d\" y=\"%.1f\" class=\"left\">%.3g</text>", LEFT - 6, y + 4, plot.top * k / 4);
        fprintf(f, "<text x=\"%.1f\" y=\"%d\" class=\"under\">%.3g</text>\n", x, TOP + HIGH + 18, k / 4.0);
    }
    fprintf(f, "<text x=\"%d\" y=\"%d\" class=\"under\">", LEFT + WIDE / 2, TOP + HIGH + 36);
    escaped(f, x_name);
    fprintf(f, "</text>\n");
    return plot;
}

/* Draws one curve and its line of the key. */
static void plot_curve(PassportPlot *plot, const float *x, const float *y, int count, const char *name) {
    int hue = 280 - 220 * plot->curves / (plot->of > 1 ? plot->of - 1 : 1), key = TOP + 8 + 15 * plot->curves;
    fprintf(plot->stream, "<polyline class=\"curve\" stroke=\"hsl(%d,70%%,42%%)\" points=\"", hue);
    for (int k = 0; k < count; k++)
        fprintf(plot->stream, "%.1f,%.1f ", plot_x((double)x[k]), plot_y(plot, (double)y[k]));
    fprintf(plot->stream, "\"/><path class=\"curve\" stroke=\"hsl(%d,70%%,42%%)\" d=\"M%d %dh16\"/>", hue,
            LEFT + WIDE + 10, key);
    fprintf(plot->stream, "<text x=\"%d\" y=\"%d\">", LEFT + WIDE + 31, key + 4);
    escaped(plot->stream, name);
    fprintf(plot->stream, "</text>\n");
    plot->curves++;
}

static void plot_close(PassportPlot *plot) { fprintf(plot->stream, "</svg>\n"); }

static void row_name(const WeftPassport *p, int row, char *name, size_t size) {
    if (*p->parameter)
        snprintf(name, size, "%s %.3g", p->parameter, (double)p->values[row]);
    else
        snprintf(name, size, "%s", p->id);
}

static void draw_albedo(FILE *f, const WeftPassport *p, const char *title, const float cells[][WEFT_PASSPORT_COSINES]) {
    PassportPlot plot = plot_open(f, title, "cos_o", (double)p->albedo_most, p->rows);
    for (int row = 0; row < p->rows; row++) {
        char name[96];
        row_name(p, row, name, sizeof name);
        plot_curve(&plot, p->cosines, cells[row], WEFT_PASSPORT_COSINES, name);
    }
    plot_close(&plot);
}

static void draw_furnace(FILE *f, const WeftPassport *p) {
    const int middle = WEFT_PASSPORT_SHEENS / 2;
    char title[96];
    float most = 0.0f;
    for (int layer = 0; layer < p->layers; layer++)
        for (int v = 0; v < WEFT_PASSPORT_VIEWS; v++) most = fmaxf(most, p->furnace[layer][middle][v]);
    snprintf(title, sizeof title, "White furnace over white Lambert, roughness %g", (double)p->sheens[middle]);
    PassportPlot plot = plot_open(f, title, "cos_o", (double)most, p->layers);
    for (int layer = 0; layer < p->layers; layer++)
        plot_curve(&plot, p->views, p->furnace[layer][middle], WEFT_PASSPORT_VIEWS, weft_layer_name(layer));
    plot_close(&plot);
}

/* Draws the square roots of variances, which are the noise of a picture. */
static void draw_variance(FILE *f, const WeftPassport *p) {
    float own[WEFT_PASSPORT_VIEWS], by_cosine[WEFT_PASSPORT_VIEWS], most = 0.0f;
    char title[160], name[96];
    row_name(p, p->row_default, name, sizeof name);
    for (int v = 0; v < WEFT_PASSPORT_VIEWS; v++) {
        own[v] = sqrtf(p->variance[p->row_default][v]);
        by_cosine[v] = sqrtf(p->variance_cosine[p->row_default][v]);
        most = fmaxf(most, fmaxf(own[v], by_cosine[v]));
    }
    snprintf(title, sizeof title, "Deviation of f cos / pdf, %s", name);
    PassportPlot plot = plot_open(f, title, "cos_o", (double)most, 2);
    plot_curve(&plot, p->views, own, WEFT_PASSPORT_VIEWS, "its own sampling");
    plot_curve(&plot, p->views, by_cosine, WEFT_PASSPORT_VIEWS, "the cosine's");
    plot_close(&plot);
}

static void write_table(FILE *f, const WeftPassport *p) {
    fprintf(f, "<table><tr><th>cos_o");
    for (int row = 0; row < p->rows && *p->parameter; row++) fprintf(f, "<th>%.3g", (double)p->values[row]);
    for (int c = 0; c < WEFT_PASSPORT_COSINES; c++) {
        fprintf(f, "\n<tr><th>%g", (double)p->cosines[c]);
        for (int row = 0; row < p->rows; row++) {
            float e = p->albedo[row][c];
            fprintf(f, "<td%s>%.3f", !(e <= 1.001f) ? " class=\"above\"" : "", (double)e);
        }
    }
    fprintf(f, "\n</table>\n");
}

static void write_facts(FILE *f, const WeftPassport *p) {
    fprintf(f, "<dl><dt>E<dd>at most %.3g; %d cells of the table above 1\n", (double)p->albedo_most, p->albedo_above);
    fprintf(f, "<dt>Reciprocity<dd>|f(wo, wi) &minus; f(wi, wo)| at most %.2g of the larger\n", (double)p->reciprocity);
    fprintf(f,
            "<dt>Sampling<dd>the pdf integrates to at most %.4f; significance of %d chi-square tests %.2g; "
            "%.2g of E is missed\n",
            (double)p->pdf_most, p->tests, weft_passport_significance(p->p, p->tests), (double)p->missed);
    fprintf(f, "<dt>Variance<dd>%.2g of the cosine's; at worst %.2g\n", (double)p->variance_ratio,
            (double)p->variance_worst);
    fprintf(f, "<dt>Sweep<dd>of %lld results %lld not finite, %lld negative, %lld from below the horizon\n",
            p->sweep_count, p->sweep_infinite, p->sweep_negative, p->sweep_below);
    fprintf(f, "<dt>Half precision<dd>");
    if (p->half_measured)
        for (int row = 0; row < p->rows; row++) {
            char name[96];
            row_name(p, row, name, sizeof name);
            escaped(f, name);
            if (p->half_floor[row] == WEFT_HALF_FREE)
                fprintf(f, ": no floor<br>");
            else if (p->half_floor[row])
                fprintf(f, ": cosines &ge; 2<sup>&minus;%d</sup><br>", p->half_floor[row]);
            else
                fprintf(f, ": not finite<br>");
        }
    else
        fprintf(f, "not measured");
    fprintf(f, "\n<dt>C and GPU<dd>");
    if (p->parity_measured)
        fprintf(f, "at most %.1e apart but for %.2g %%, on ", (double)p->parity_worst,
                100.0 * (double)p->parity_beyond);
    escaped(f, p->parity_words);
    fprintf(f, "\n</dl>\n");
}

static const char style[] =
    "body{font:15px/1.5 sans-serif;max-width:70em;margin:2em auto;padding:0 1em;color:#222}"
    "svg{max-width:100%;font:12px sans-serif}.title{font-weight:bold}.left{text-anchor:end}"
    ".under{text-anchor:middle}.grid{stroke:#ccc}.curve{fill:none;stroke-width:1.6}"
    "rect.above{fill:#fbe3e0}td.above{background:#f5b7b1;font-weight:bold}"
    "table{border-collapse:collapse;font-size:12px;margin:1em 0}td,th{padding:1px 6px;text-align:right}"
    "dt{font-weight:bold;float:left;clear:left;width:9em}dd{margin-left:9em}";

void passports_page(FILE *f, const WeftPassport *passports, int count) {
    fprintf(f, "<!DOCTYPE html>\n<html lang=\"en\"><meta charset=\"utf-8\"><title>weft check</title>\n");
    fprintf(f, "<style>%s</style>\n<h1>Passports</h1>\n", style);
    for (int k = 0; k < count; k++) {
        const WeftPassport *p = &passports[k];
        fprintf(f, "<h2>");
        escaped(f, p->id);
        fprintf(f, "</h2>\n<p>");
        escaped(f, p->surface);
        fprintf(f, "</p>\n");
        write_facts(f, p);
        draw_albedo(f, p, "Directional albedo E", p->albedo);
        if (p->traits & WEFT_LOBE_TINTED) draw_albedo(f, p, "E of fibres that keep half of the light", p->albedo_half);
        if (p->layers) draw_furnace(f, p);
        draw_variance(f, p);
        write_table(f, p);
    }
    fprintf(f, "</html>\n");
}
