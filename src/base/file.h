/* file.h - reading and writing of whole files */
#pragma once

#include <stdio.h>

#include "weft/result.h"

/* The bytes of a file, followed by one zero byte that size does not count. Release with free(data). */
typedef struct FileBytes {
    unsigned char *data;
    size_t size;
} FileBytes;

/* Reads all of path, a regular file: a folder, pipe or device is refused without waiting. Fails if the file has more
 * than limit bytes. */
WeftResult file_read(const char *path, size_t limit, FileBytes *out, WeftError *error);

/* Reads the first most bytes of path, or all where it has fewer. */
WeftResult file_read_start(const char *path, size_t most, FileBytes *out, WeftError *error);

/* A file that appears under its name complete or not at all: a temporary file is written, synced and renamed. */
typedef struct OutputFile {
    FILE *stream;     /* write here */
    const char *path; /* borrowed: must outlive the OutputFile */
    char *target;     /* the file behind path's links */
    char *temporary;  /* the file that is written */
} OutputFile;

/* Opens a temporary file beside path, or beside the file that path links to. Fails if path exists and is no regular
 * file: a folder, a device, a pipe. */
WeftResult output_open(OutputFile *file, const char *path, WeftError *error);

/* Closes and renames. Fails, with the reason, if a write to the stream has failed too; the temporary file is then
 * removed and the old file stays. */
WeftResult output_commit(OutputFile *file, WeftError *error);

/* Closes and removes the temporary file. */
void output_discard(OutputFile *file);
