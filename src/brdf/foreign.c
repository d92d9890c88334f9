#include "brdf/foreign.h"

#include <stdbool.h>
#include <string.h>

#include "base/mark.h"

#define LINES "write lines theta_o phi_o theta_i phi_i r g b and fit them by `weft fit`"

/* Names of contents by words near their beginning. A later row is a more general one. */
static const struct {
    const char *word, *name;
} foreign_words[] = {
    {"<WindowElement", "it is XML of a window layer, as WINDOW 6 and Radiance's genBSDF write it; " LINES},
    {"<?xml", "it is XML, perhaps of a window layer (WINDOW 6, Radiance's genBSDF); " LINES},
    {"ScatterAzimuth", "it is text of a scatterometer in Zemax's format; " LINES},
    {"AngleOfIncidence", "it is text of a scatterometer in Zemax's format; " LINES},
    {"TotalIntegratedScatter", "it is text of a scatterometer in Zemax's format; " LINES},
    {"version https://git-lfs", "it is a Git LFS pointer, not the file: fetch it by `git lfs pull`"},
    {"<html", "it is HTML, perhaps of a failed download"},
    {"<!DOCTYPE", "it is HTML, perhaps of a failed download"},
};

static const struct {
    const char *bytes;
    size_t size;
    const char *name;
} foreign_signatures[] = {
    {"\x89HDF", 4, "it is an HDF5 container; " LINES},
    {"PK\x03\x04", 4, "it is a zip archive: unpack it"},
    {"\x1f\x8b", 2, "it is compressed by gzip: unpack it"},
};

/* Returns true if the first bytes are those of a text: no control characters, and few that are not ASCII. */
static bool is_text(const unsigned char *data, size_t size) {
    enum { ENOUGH = 24 };
    size_t others = 0;
    for (size_t k = 0; k < size; k++) {
        if (data[k] == 0x7f || (data[k] < 0x20 && !strchr("\t\n\f\r", data[k])) || data[k] == 0) return false;
        others += data[k] >= 0x80;
    }
    return size >= ENOUGH && others <= size / 8;
}

const char *foreign_name(const void *data, size_t size) {
    char start[2048];
    for (size_t k = 0; k < sizeof foreign_signatures / sizeof *foreign_signatures; k++)
        if (size >= foreign_signatures[k].size &&
            memcmp(data, foreign_signatures[k].bytes, foreign_signatures[k].size) == 0)
            return foreign_signatures[k].name;
    const size_t mark = mark_size(data, size), rest = size - mark,
                 length = rest < sizeof start ? rest : sizeof start - 1;
    memcpy(start, (const char *)data + mark, length);
    start[length] = '\0';
    if (!is_text((const unsigned char *)start, length)) return NULL;
    for (size_t k = 0; k < sizeof foreign_words / sizeof *foreign_words; k++)
        if (strstr(start, foreign_words[k].word)) return foreign_words[k].name;
    return "it is text, as scatterometers write it; " LINES;
}
