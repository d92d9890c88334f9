/* woven_presets.h - which presets are woven */
#ifndef WEFT_TESTS_WOVEN_PRESETS_H
#define WEFT_TESTS_WOVEN_PRESETS_H

#include <stddef.h>
#include <string.h>

/* Our own, and those by the numbers of two papers: how their names begin, and how many there are. */
static const struct {
    const char *prefix;
    int promised;
} woven_families[] = {{"woven-", 12}, {"irawan-", 6}, {"sadeghi-", 6}};
enum { WOVEN_FAMILIES = sizeof woven_families / sizeof *woven_families, WOVEN_PRESETS = 12 + 6 + 6 };

/* Returns the family of a preset; -1: it is not woven. */
static inline int woven_family(const char *preset) {
    for (int f = 0; f < WOVEN_FAMILIES; f++)
        if (strncmp(preset, woven_families[f].prefix, strlen(woven_families[f].prefix)) == 0) return f;
    return -1;
}

#endif
