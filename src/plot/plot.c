/* plot.c - figures from descriptors: checked, made, drawn and written */
#include "weft/plot.h"

#include <cairo-pdf.h>
#include <cairo-svg.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/fail.h"
#include "base/file.h"
#include "base/path.h"
#include "plot/making.h"
#include "plot/page.h"
#include "plot/vector.h"

struct WeftPlotMemory {
    Arena arena;
};

typedef struct Kind {
    const char *name, *help, *title;
    WeftResult (*make)(Making *making);
} Kind;

static const Kind kinds[WEFT_PLOT_KINDS] = {
    [WEFT_PLOT_POLAR] = {"polar", "f as a length over the angle of wi, in the plane of wo and across it",
                         "Polar plot", kind_polar},
    [WEFT_PLOT_LOBE3D] = {"lobe3d", "f as a length over all wi: a surface", "The lobe in space", kind_lobe3d},
    [WEFT_PLOT_CARTESIAN] = {"cartesian", "f, and f cos, over the angle of wi",
                             "Reflectance in the plane of view", kind_cartesian},
    [WEFT_PLOT_ALBEDO] = {"albedo", "directional albedo over the angle of view, and over roughness",
                          "Directional albedo", kind_albedo},
    [WEFT_PLOT_FURNACE] = {"furnace",
                           "what white cloth returns of uniform light: a lobe on a white base, by layer rule",
                           "White furnace", kind_furnace},
    [WEFT_PLOT_SLICE] = {"slice", "f over theta_h and theta_d, phi_d = 90 degrees, as a picture",
                         "Image slice", kind_slice},
    [WEFT_PLOT_SPHERE] = {"sphere", "a lit sphere, and more as the roughness grows", "Lit spheres",
                          kind_sphere},
    [WEFT_PLOT_SAMPLES] = {"samples", "lobes only: histogram of what is drawn, pdf, and their ratio",
                           "Samples against their density", kind_samples},
    [WEFT_PLOT_DIFFERENCE] = {"difference", "where in theta_o and theta_i two subjects differ", "Difference",
                              kind_difference},
};

const char *weft_plot_kind_name(int kind) {
    return kind >= 0 && kind < WEFT_PLOT_KINDS ? kinds[kind].name : NULL;
}

const char *weft_plot_kind_help(int kind) {
    return kind >= 0 && kind < WEFT_PLOT_KINDS ? kinds[kind].help : NULL;
}

/* What is wrong with a descriptor; NULL: nothing. */
static const char *complaint(const WeftPlotDesc *desc) {
    if ((int)desc->kind < 0 || desc->kind >= WEFT_PLOT_KINDS) return "there is no such kind";
    if (!desc->subjects || desc->count < 1 || desc->count > WEFT_PLOT_SUBJECTS_MAX)
        return "a figure has 1 to 8 subjects";
    for (int k = 0; k < desc->count; k++)
        if (!desc->subjects[k].reflection) return "a subject has no reflection";
    if (desc->kind == WEFT_PLOT_DIFFERENCE && desc->count != 2) return "a difference is of two subjects";
    if (desc->view_count < 0 || desc->view_count > WEFT_PLOT_VIEWS_MAX) return "a figure has up to 6 views";
    for (int k = 0; k < desc->view_count; k++)
        if (!(desc->views[k] >= 0.0f && desc->views[k] < (desc->kind == WEFT_PLOT_SPHERE ? 180.0f : 90.0f)))
            return "a view is an angle from 0 to below 90 degrees";
    if ((int)desc->channel < 0 || desc->channel > WEFT_PLOT_BLUE) return "there is no such channel";
    if (desc->width < 0 || desc->height < 0 || desc->width > WEFT_PLOT_SIDE_MAX ||
        desc->height > WEFT_PLOT_SIDE_MAX)
        return "a side has up to 8192 pixels";
    if (desc->kind == WEFT_PLOT_SAMPLES)
        for (int k = 0; k < desc->count; k++)
            if (!desc->subjects[k].lobe) return "only lobes are sampled by themselves";
    return NULL;
}

/* The kind's own title names the one subject there is. */
static void make_title(const WeftPlotDesc *desc, WeftPlotData *data) {
    const char *own = kinds[desc->kind].title;
    if (desc->title)
        snprintf(data->title, sizeof data->title, "%s", desc->title);
    else if (desc->count == 1 && desc->subjects[0].label)
        snprintf(data->title, sizeof data->title, "%s: %.128s", own, desc->subjects[0].label);
    else
        snprintf(data->title, sizeof data->title, "%s", own);
}

WeftResult weft_plot_data(const WeftPlotDesc *desc, WeftPlotData *out, WeftError *error) {
    memset(out, 0, sizeof *out);
    const char *wrong = complaint(desc);
    if (wrong) return fail(error, WEFT_MESSAGE_DESC, "plot", "%s", wrong);
    out->owned = alloc_array(1, sizeof *out->owned);
    if (!out->owned) return fail(error, WEFT_MESSAGE_MEMORY, "plot", NULL);
    make_title(desc, out);
    Making making = {.desc = desc, .data = out, .arena = &out->owned->arena, .error = error};
    WeftResult result = kinds[desc->kind].make(&making);
    if (result != WEFT_OK) weft_plot_data_free(out);
    return result;
}

void weft_plot_data_free(WeftPlotData *data) {
    if (!data || !data->owned) return;
    arena_free(&data->owned->arena);
    free(data->owned);
    memset(data, 0, sizeof *data);
}

/* Drawing. */

static void page_size(const WeftPlotDesc *desc, const WeftPlotData *data, int *width, int *height) {
    page_natural(data, width, height);
    double aspect = (double)*height / *width;
    if (desc->width && desc->height) {
        *width = desc->width;
        *height = desc->height;
    } else if (desc->width) {
        *width = desc->width;
        *height = (int)fmin(fmax(round(desc->width * aspect), 1.0), WEFT_PLOT_SIDE_MAX);
    } else if (desc->height) {
        *height = desc->height;
        *width = (int)fmin(fmax(round(desc->height / aspect), 1.0), WEFT_PLOT_SIDE_MAX);
    }
}

/* Draws on a surface that is then finished, and destroyed in any case. */
static WeftResult draw_on(cairo_surface_t *surface, double scale, Page *page) {
    page->cairo = cairo_create(surface);
    cairo_scale(page->cairo, scale, scale);
    WeftResult result = page_draw(page);
    if (result == WEFT_OK) cairo_show_page(page->cairo);
    if (result == WEFT_OK && cairo_status(page->cairo) != CAIRO_STATUS_SUCCESS)
        result = fail(page->error, WEFT_MESSAGE_MEMORY, "plot", "%s",
                      cairo_status_to_string(cairo_status(page->cairo)));
    cairo_destroy(page->cairo);
    cairo_surface_flush(surface);
    return result;
}

static WeftResult page_image(Page *page, WeftImage *out) {
    cairo_surface_t *surface = cairo_image_surface_create(CAIRO_FORMAT_RGB24, page->width, page->height);
    WeftResult result = draw_on(surface, 1.0, page);
    if (result == WEFT_OK)
        result = weft_image_create(page->width, page->height, 3, WEFT_PIXEL_U8, out, page->error);
    if (result == WEFT_OK) {
        const unsigned char *pixels = cairo_image_surface_get_data(surface);
        const size_t stride = (size_t)cairo_image_surface_get_stride(surface);
        uint8_t *to = out->pixels;
        for (size_t row = 0; row < (size_t)page->height; row++)
            for (size_t column = 0; column < (size_t)page->width; column++) {
                uint32_t word;
                memcpy(&word, pixels + row * stride + 4 * column, 4);
                for (int c = 0; c < 3; c++) *to++ = (uint8_t)(word >> (16 - 8 * c));
            }
    }
    cairo_surface_destroy(surface);
    return result;
}

static Page page_of(const WeftPlotDesc *desc, const WeftPlotData *data, WeftError *error) {
    Page page = {.data = data, .error = error};
    page_size(desc, data, &page.width, &page.height);
    page.type = page_type(data, page.width, page.height);
    return page;
}

WeftResult weft_plot_image(const WeftPlotDesc *desc, WeftImage *out, WeftError *error) {
    WeftPlotData data;
    *out = (WeftImage){0};
    WeftResult result = weft_plot_data(desc, &data, error);
    if (result != WEFT_OK) return result;
    Page page = page_of(desc, &data, error);
    result = page_image(&page, out);
    weft_plot_data_free(&data);
    return result;
}

static cairo_status_t append(void *user, const unsigned char *bytes, unsigned count) {
    return vector_append(user, bytes, count) ? CAIRO_STATUS_SUCCESS : CAIRO_STATUS_WRITE_ERROR;
}

static WeftResult vector_page(Page *page, bool pdf, Vector *out) {
    const double points = 0.75; /* a pixel is 1/96 inch */
    const double width = points * page->width, height = points * page->height;
    cairo_surface_t *surface = pdf ? cairo_pdf_surface_create_for_stream(append, out, width, height)
                                   : cairo_svg_surface_create_for_stream(append, out, width, height);
    if (pdf) {
        /* the day is none of what is drawn: the same figure is the same file */
        cairo_pdf_surface_set_metadata(surface, CAIRO_PDF_METADATA_CREATE_DATE, "2000-01-01T00:00:00Z");
        char title[TEXT_SIZE];
        drawable(page->data->title, title);
        cairo_pdf_surface_set_metadata(surface, CAIRO_PDF_METADATA_TITLE, title);
    }
    WeftResult result = draw_on(surface, points, page);
    cairo_surface_finish(surface);
    if (result == WEFT_OK && (out->broken || cairo_surface_status(surface) != CAIRO_STATUS_SUCCESS))
        result = fail(page->error, WEFT_MESSAGE_MEMORY, "plot", NULL);
    cairo_surface_destroy(surface);
    if (result == WEFT_OK && !pdf && !vector_settle_svg(out, page->data->title))
        result = fail(page->error, WEFT_MESSAGE_MEMORY, "plot", NULL);
    return result;
}

WeftResult plot_svg(const WeftPlotDesc *desc, const WeftPlotData *data, Vector *out, WeftError *error) {
    Page page = page_of(desc, data, error);
    return vector_page(&page, false, out);
}

WeftResult plot_write_bytes(const char *path, const Vector *bytes, WeftError *error) {
    OutputFile file;
    WeftResult result = output_open(&file, path, error);
    if (result != WEFT_OK) return result;
    if (fwrite(bytes->text, 1, bytes->size, file.stream) == bytes->size) return output_commit(&file, error);
    output_discard(&file);
    return fail(error, WEFT_MESSAGE_FILE_WRITE, path, NULL);
}

int weft_plot_suffix_known(const char *path) {
    return path_ends(path, ".png") || path_ends(path, ".svg") || path_ends(path, ".pdf");
}

WeftResult weft_plot_write(const WeftPlotDesc *desc, const char *path, WeftError *error) {
    WeftPlotData data;
    if (!weft_plot_suffix_known(path))
        return fail(error, WEFT_MESSAGE_OUTPUT_SUFFIX, path, "figures are .png, .svg or .pdf");
    WeftResult result = weft_plot_data(desc, &data, error);
    if (result != WEFT_OK) return result;
    Page page = page_of(desc, &data, error);
    if (path_ends(path, ".png")) {
        WeftImage image = {0};
        result = page_image(&page, &image);
        if (result == WEFT_OK) result = weft_image_write(path, &image, error);
        weft_image_free(&image);
    } else {
        Vector bytes = {0};
        result = vector_page(&page, path_ends(path, ".pdf"), &bytes);
        if (result == WEFT_OK) result = plot_write_bytes(path, &bytes, error);
        free(bytes.text);
    }
    weft_plot_data_free(&data);
    return result;
}
