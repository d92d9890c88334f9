/* drawing.h - Cairo drawings as images, as SVG, and as files */
#pragma once

#include <cairo.h>

#include "plot/vector.h"
#include "weft/image.h"

/* A drawing of so many pixels, 96 to the inch. */
typedef struct Drawing {
    int width, height;
    const char *title; /* of a .pdf or .svg */
    WeftResult (*draw)(cairo_t *cairo, void *user, WeftError *error);
    void *user;
} Drawing;

/* Draws it as a U8 RGB image. */
WeftResult drawing_image(const Drawing *drawing, WeftImage *out, WeftError *error);

/* Draws it as the bytes of a .svg. */
WeftResult drawing_svg(const Drawing *drawing, Vector *out, WeftError *error);

/* Writes it as .png, .svg or .pdf by the path's suffix. */
WeftResult drawing_write(const Drawing *drawing, const char *path, WeftError *error);
