/* table_file.h - a baked table as a file: a C array, numbers as text, or an image, by suffix */
#pragma once

#include <stdbool.h>

#include "weft/bake.h"

typedef struct TableFile {
    const WeftImage *table; /* F32 */
    const char *command;    /* the command that made it, on one line; each format that has comments keeps it */
    const char *about;      /* a line that describes it */
    float low, high;        /* the least and the largest value */
    double scale;           /* a .png stores table / scale; 0: the least power of two that avoids clipping */
    bool half;              /* an .exr of 16 bit floats, not 32 */
} TableFile;

/* Returns true if path ends in one of .h .png .exr .dds .npy .csv .txt; otherwise prints one line on
 * standard error. */
bool table_suffix_check(const char *path);

/* Writes the file, complete or not at all. For a scaled .png it prints a line with the scale. Values that a format
 * cannot store are refused, not clipped. Returns 0, or an exit code after one line. */
int table_write(const TableFile *file, const char *path);
