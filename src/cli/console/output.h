/* output.h - a file that appears under its name complete or not at all */
#pragma once

#include <stdio.h>

#include "cli/console/options.h"

typedef struct Output {
    FILE *stream; /* write here */
    const char *path;
    char *target, *temporary; /* the file behind path's links, and the one beside it */
} Output;

/* Opens a file beside path, which must outlive the Output, or beside the file that path links to. Returns 0,
 * or an exit code after one line on standard error, as where path exists and is not a regular file. */
int output_begin(Output *output, const char *path);

/* Gives the file its name. Returns 0, or an exit code after one line; nothing is left then. */
int output_end(Output *output);

/* Removes the file. */
void output_drop(Output *output);

/* Tests that path can be written by creating a file there and removing it. Returns as output_begin. */
int output_probe(const char *path);

/* Works as output_probe, for a path that must not be one of the operands' files (a colon and the text after it are
 * ignored), so that an input is not overwritten. */
int output_probe_other(const Options *options, const char *path);
