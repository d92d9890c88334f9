/* vector.h - files of lines: what Cairo writes, kept in memory and made the same in every run */
#ifndef WEFT_PLOT_VECTOR_H
#define WEFT_PLOT_VECTOR_H

#include <stdbool.h>
#include <stddef.h>

#include "weft/plot.h"

/* Bytes that grow. Zero-initialise; release text with free. */
typedef struct Vector {
    char *text;
    size_t size, room;
    bool broken; /* memory was short */
} Vector;

bool vector_append(Vector *vector, const void *bytes, size_t count);
__attribute__((format(printf, 2, 3))) bool vector_print(Vector *vector, const char *format, ...);

/* Appends text with <, >, & and quotes escaped for HTML and XML. */
bool vector_escaped(Vector *vector, const char *text);

/* Cairo numbers surfaces through the life of a program: here they count from 1. A title for those who hear
 * rather than see is put in. */
bool vector_finish_svg(Vector *svg, const char *title);

/* A figure of numbers that are there as SVG, and a file from bytes, whole or not at all. */
WeftResult plot_svg(const WeftPlotDesc *desc, const WeftPlotData *data, Vector *out, WeftError *error);
WeftResult plot_write_bytes(const char *path, const Vector *bytes, WeftError *error);

#endif
