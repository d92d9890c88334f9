/* output.h - a file that appears under its name complete or not at all */
#ifndef WEFT_CLI_OUTPUT_H
#define WEFT_CLI_OUTPUT_H

#include <stdio.h>

typedef struct Output {
    FILE *stream; /* write here */
    const char *path;
    char temporary[1024];
} Output;

/* Opens a file beside path, which must outlive the Output. Returns 0, or an exit code after one line on
 * standard error. */
int output_begin(Output *output, const char *path);

/* Gives the file its name. Returns 0, or an exit code after one line; nothing is left then. */
int output_end(Output *output);

/* Removes the file. */
void output_drop(Output *output);

#endif
