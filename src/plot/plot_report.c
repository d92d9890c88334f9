/* plot_report.c - one page of HTML that contains every figure, without a script or other files */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/fail.h"
#include "base/pi.h"
#include "image/codec.h"
#include "plot/making.h"
#include "plot/vector.h"

static const char style[] =
    ":root{color-scheme:light dark;--ink:#1a1a1c;--dim:#5c5f66;--paper:#f4f4f5;--edge:#d4d4d8}\n"
    "@media(prefers-color-scheme:dark){:root{--ink:#e9e9ec;--dim:#a2a6ad;--paper:#16171a;--edge:#3a3c42}}\n"
    "body{margin:0 auto;max-width:72rem;padding:1.5rem;font:16px/1.5 \"DejaVu Sans\",system-ui,sans-serif;"
    "color:var(--ink);background:var(--paper)}\n"
    "h1{font-size:1.6rem}h2{font-size:1.15rem;margin:2.2rem 0 .6rem}\n"
    "figure{margin:0}img{display:block;width:100%;height:auto;background:#fff;"
    "border:1px solid var(--edge);border-radius:6px}\n"
    "figcaption,nav,p{color:var(--dim)}nav{display:flex;flex-wrap:wrap;gap:.2rem 1rem}nav a{color:inherit}\n"
    "table{border-collapse:collapse}th,td{padding:.25rem .9rem;border-bottom:1px solid var(--edge);"
    "text-align:right;font-variant-numeric:tabular-nums}th:first-child{text-align:left}\n"
    ".wide{overflow-x:auto}\n";

static bool base64(Vector *out, const unsigned char *bytes, size_t size) {
    static const char letters[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    for (size_t k = 0; k < size; k += 3) {
        const size_t left = size - k;
        unsigned word = (unsigned)bytes[k] << 16 | (left > 1 ? (unsigned)bytes[k + 1] << 8 : 0u) |
                        (left > 2 ? (unsigned)bytes[k + 2] : 0u);
        const char four[4] = {letters[word >> 18], letters[word >> 12 & 63], left > 1 ? letters[word >> 6 & 63] : '=',
                              left > 2 ? letters[word & 63] : '='};
        if (!vector_append(out, four, 4)) return false;
    }
    return true;
}

/* Draws the figure as the bytes of a .png. */
static WeftResult png_bytes(const WeftPlotDesc *desc, char **bytes, size_t *size, WeftError *error) {
    WeftImage image;
    WeftResult result = weft_plot_image(desc, &image, error);
    if (result != WEFT_OK) return result;
    FILE *stream = open_memstream(bytes, size);
    if (!stream) result = fail(error, WEFT_MESSAGE_MEMORY, "report", NULL);
    if (result == WEFT_OK) result = image_write_png(stream, "report", &image, &(WeftImageWriting){0}, error);
    if (stream && fclose(stream) != 0 && result == WEFT_OK) result = fail(error, WEFT_MESSAGE_MEMORY, "report", NULL);
    weft_image_free(&image);
    return result;
}

/* Writes the figure as SVG if it consists of lines, else as PNG. */
static WeftResult image_put(Vector *page, const WeftPlotDesc *desc, WeftError *error) {
    const bool lines = desc->kind == WEFT_PLOT_POLAR || desc->kind == WEFT_PLOT_CARTESIAN ||
                       desc->kind == WEFT_PLOT_ALBEDO || desc->kind == WEFT_PLOT_FURNACE;
    WeftResult result;
    if (lines) {
        WeftPlotData data;
        Vector svg = {0};
        result = weft_plot_data(desc, &data, error);
        if (result != WEFT_OK) return result;
        result = plot_svg(desc, &data, &svg, error);
        weft_plot_data_free(&data);
        if (result == WEFT_OK) {
            vector_print(page, "<img src=\"data:image/svg+xml;base64,");
            base64(page, (const unsigned char *)svg.text, svg.size);
        }
        free(svg.text);
    } else {
        char *bytes = NULL;
        size_t size = 0;
        result = png_bytes(desc, &bytes, &size, error);
        if (result == WEFT_OK) {
            vector_print(page, "<img src=\"data:image/png;base64,");
            base64(page, (const unsigned char *)bytes, size);
        }
        free(bytes);
    }
    return result;
}

static void labels_put(Vector *page, const WeftPlotDesc *desc) {
    for (int k = 0; k < desc->count; k++) {
        if (k) vector_print(page, ", ");
        vector_escaped(page, desc->models[k].label ? desc->models[k].label : "model");
    }
}

static WeftResult figure_put(Vector *page, const WeftPlotDesc *desc, WeftError *error) {
    const char *name = weft_plot_kind_name((int)desc->kind), *help = weft_plot_kind_help((int)desc->kind);
    vector_print(page, "<h2 id=\"%s\">%s</h2>\n<figure>", name, name);
    WeftResult result = image_put(page, desc, error);
    vector_print(page, "\" alt=\"%s: ", help);
    labels_put(page, desc);
    vector_print(page, "\"><figcaption>%s</figcaption></figure>\n", help);
    return result;
}

/* Writes the table of E of every model. */
static void table_put(Vector *page, const WeftPlotDesc *desc) {
    static const float angles[] = {0.0f, 30.0f, 45.0f, 60.0f, 75.0f, 85.0f};
    enum { ANGLES = sizeof angles / sizeof *angles };
    vector_print(page,
                 "<h2 id=\"numbers\">E in numbers</h2>\n<div class=\"wide\"><table><tr><th>&theta;<sub>o</sub></th>");
    for (int k = 0; k < ANGLES; k++) vector_print(page, "<th>%g&deg;</th>", (double)angles[k]);
    vector_print(page, "</tr>\n");
    for (int n = 0; n < desc->count; n++) {
        vector_print(page, "<tr><th>");
        vector_escaped(page, desc->models[n].label ? desc->models[n].label : "model");
        vector_print(page, "</th>");
        for (int k = 0; k < ANGLES; k++) {
            float e[3];
            weft_reflection_albedo(desc->models[n].reflection, WEFT_PART_ALL, (float)cos((double)angles[k] * RADIANS),
                                   e);
            vector_print(page, "<td>%.4f</td>", 0.2126 * (double)e[0] + 0.7152 * (double)e[1] + 0.0722 * (double)e[2]);
        }
        vector_print(page, "</tr>\n");
    }
    vector_print(page, "</table></div>\n<p>Directional albedo, luminance: the share of light from a direction that "
                       "comes back.</p>\n");
}

/* Returns true if the kind of figure applies, and sets the models it applies to. */
static bool serves(WeftPlotDesc *desc, WeftPlotModel *chosen) {
    int count = 0;
    if (desc->kind == WEFT_PLOT_DIFFERENCE) return desc->count == 2;
    for (int k = 0; k < desc->count; k++)
        if (!kind_refuses(desc->kind, &desc->models[k])) chosen[count++] = desc->models[k];
    desc->models = chosen;
    desc->count = count;
    return count > 0;
}

static void links_put(Vector *page, const WeftPlotDesc *desc) {
    vector_print(page, "<nav><a href=\"#numbers\">numbers</a>");
    for (int k = 0; k < WEFT_PLOT_KINDS; k++) {
        WeftPlotModel chosen[WEFT_PLOT_MODELS_MAX];
        WeftPlotDesc one = *desc;
        one.kind = (WeftPlotKind)k;
        const char *name = weft_plot_kind_name(k);
        if (serves(&one, chosen)) vector_print(page, "<a href=\"#%s\">%s</a>", name, name);
    }
    vector_print(page, "</nav>\n");
}

static WeftResult page_make(const WeftPlotDesc *desc, Vector *page, WeftError *error) {
    WeftResult result = WEFT_OK;
    vector_print(page, "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n"
                       "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; img-src data:; "
                       "style-src 'unsafe-inline'\">\n"
                       "<meta name=\"viewport\" content=\"width=device-width\">\n"
                       "<link rel=\"icon\" href=\"data:,\">\n<title>weft: ");
    labels_put(page, desc);
    vector_print(page, "</title>\n<style>\n");
    vector_append(page, style, strlen(style));
    vector_print(page, "</style></head><body>\n<h1>");
    labels_put(page, desc);
    vector_print(page,
                 "</h1>\n<p>Figures of weft %s. &theta; is measured from the normal; wo points to the viewer, wi to "
                 "the light; f is in 1/sr and excludes the cosine.</p>\n",
                 weft_version());
    links_put(page, desc);
    table_put(page, desc);
    for (int k = 0; k < WEFT_PLOT_KINDS && result == WEFT_OK; k++) {
        WeftPlotModel chosen[WEFT_PLOT_MODELS_MAX];
        WeftPlotDesc one = *desc;
        one.kind = (WeftPlotKind)k;
        one.title = "";
        one.width = 1600; /* of .png figures: sharp on fine screens too */
        one.height = 0;
        if (serves(&one, chosen)) result = figure_put(page, &one, error);
    }
    vector_print(page, "</body></html>\n");
    return result;
}

WeftResult weft_plot_report(const WeftPlotDesc *desc, const char *path, WeftError *error) {
    Vector page = {0};
    WeftPlotDesc probe = *desc;
    WeftPlotData data;
    probe.kind = WEFT_PLOT_ALBEDO; /* faults of the descriptor are found before anything is drawn */
    probe.width = probe.height = 0;
    WeftResult result = weft_plot_data(&probe, &data, error);
    if (result != WEFT_OK) return result;
    weft_plot_data_free(&data);
    result = page_make(desc, &page, error);
    if (result == WEFT_OK && page.broken) result = fail(error, WEFT_MESSAGE_MEMORY, "report", NULL);
    if (result == WEFT_OK) result = plot_write_bytes(path, &page, error);
    free(page.text);
    return result;
}
