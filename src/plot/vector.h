/* vector.h - vector graphics files in memory, made reproducible */
#pragma once

#include <stdbool.h>
#include <stddef.h>

#include "weft/plot.h"

/* Bytes that grow. Zero-initialise; release text with free. */
typedef struct Vector {
    char *text;
    size_t size, capacity;
    bool broken; /* memory was short */
} Vector;

bool vector_append(Vector *vector, const void *bytes, size_t count);
__attribute__((format(printf, 2, 3))) bool vector_print(Vector *vector, const char *format, ...);

/* Appends text with <, >, & and quotes escaped for HTML and XML. */
bool vector_escaped(Vector *vector, const char *text);

/* Renumbers the names in an SVG from 1, since Cairo counts surfaces over the life of a program, and inserts a title for
 * screen readers. Returns false if memory is short. */
bool vector_finish_svg(Vector *svg, const char *title);

/* Draws a figure from its numbers as SVG (plot_svg), and writes bytes as a file, complete or not at all
 * (plot_write_bytes). */
WeftResult plot_svg(const WeftPlotDesc *desc, const WeftPlotData *data, Vector *out, WeftError *error);
WeftResult plot_write_bytes(const char *path, const Vector *bytes, WeftError *error);
