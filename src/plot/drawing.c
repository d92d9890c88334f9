#include "plot/drawing.h"

#include <cairo-pdf.h>
#include <cairo-svg.h>
#include <stdlib.h>
#include <string.h>

#include "base/fail.h"
#include "base/path.h"
#include "plot/type.h"

/* Draws on a surface that is then finished. */
static WeftResult draw_on(cairo_surface_t *surface, double scale, const Drawing *drawing, WeftError *error) {
    cairo_t *cairo = cairo_create(surface);
    cairo_scale(cairo, scale, scale);
    WeftResult result = drawing->draw(cairo, drawing->user, error);
    if (result == WEFT_OK) cairo_show_page(cairo);
    if (result == WEFT_OK) result = drawn(cairo, "plot", error);
    cairo_destroy(cairo);
    cairo_surface_flush(surface);
    return result;
}

static void copy_pixels(cairo_surface_t *surface, WeftImage *out) {
    const unsigned char *pixels = cairo_image_surface_get_data(surface);
    const size_t stride = (size_t)cairo_image_surface_get_stride(surface);
    uint8_t *to = out->pixels;
    for (size_t row = 0; row < (size_t)out->height; row++)
        for (size_t column = 0; column < (size_t)out->width; column++) {
            uint32_t word;
            memcpy(&word, pixels + row * stride + 4 * column, 4);
            for (int c = 0; c < 3; c++) *to++ = (uint8_t)(word >> (16 - 8 * c));
        }
}

WeftResult drawing_image(const Drawing *drawing, WeftImage *out, WeftError *error) {
    cairo_surface_t *surface = cairo_image_surface_create(CAIRO_FORMAT_RGB24, drawing->width, drawing->height);
    WeftResult result = draw_on(surface, 1.0, drawing, error);
    if (result == WEFT_OK) result = weft_image_create(drawing->width, drawing->height, 3, WEFT_PIXEL_U8, out, error);
    if (result == WEFT_OK) copy_pixels(surface, out);
    cairo_surface_destroy(surface);
    return result;
}

static cairo_status_t append(void *user, const unsigned char *bytes, unsigned count) {
    return vector_append(user, bytes, count) ? CAIRO_STATUS_SUCCESS : CAIRO_STATUS_WRITE_ERROR;
}

static WeftResult draw_lines(const Drawing *drawing, bool pdf, Vector *out, WeftError *error) {
    const double points = 0.75; /* a pixel is 1/96 inch */
    const double width = points * drawing->width, height = points * drawing->height;
    cairo_surface_t *surface = pdf ? cairo_pdf_surface_create_for_stream(append, out, width, height)
                                   : cairo_svg_surface_create_for_stream(append, out, width, height);
    if (pdf) {
        /* a constant date, so that the same figure is the same file */
        cairo_pdf_surface_set_metadata(surface, CAIRO_PDF_METADATA_CREATE_DATE, "2000-01-01T00:00:00Z");
        char title[TEXT_SIZE];
        drawable(drawing->title, title);
        cairo_pdf_surface_set_metadata(surface, CAIRO_PDF_METADATA_TITLE, title);
    }
    WeftResult result = draw_on(surface, points, drawing, error);
    cairo_surface_finish(surface);
    if (result == WEFT_OK && (out->broken || cairo_surface_status(surface) != CAIRO_STATUS_SUCCESS))
        result = fail(error, WEFT_MESSAGE_MEMORY, "plot", NULL);
    cairo_surface_destroy(surface);
    if (result == WEFT_OK && !pdf && !vector_finish_svg(out, drawing->title))
        result = fail(error, WEFT_MESSAGE_MEMORY, "plot", NULL);
    return result;
}

WeftResult drawing_svg(const Drawing *drawing, Vector *out, WeftError *error) {
    return draw_lines(drawing, false, out, error);
}

WeftResult drawing_write(const Drawing *drawing, const char *path, WeftError *error) {
    WeftResult result;
    if (path_ends(path, ".png")) {
        WeftImage image = {0};
        result = drawing_image(drawing, &image, error);
        if (result == WEFT_OK) result = weft_image_write(path, &image, error);
        weft_image_free(&image);
        return result;
    }
    Vector bytes = {0};
    result = draw_lines(drawing, path_ends(path, ".pdf"), &bytes, error);
    if (result == WEFT_OK) result = plot_write_bytes(path, &bytes, error);
    free(bytes.text);
    return result;
}
