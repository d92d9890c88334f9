/* nearest.h - the name that was probably meant */
#ifndef WEFT_CLI_NAMES_H
#define WEFT_CLI_NAMES_H

/* The search for the name nearest to `typed` among those offered. Start with {.typed = text}. */
typedef struct Nearest {
    const char *typed, *name; /* name: the best so far, NULL when none is near enough */
    int distance;
} Nearest;

/* Considers one more name; it must outlive the search. */
void nearest_offer(Nearest *nearest, const char *name);

/* "; did you mean NAME?" in a buffer of the caller's, or "" when nothing is near. */
const char *nearest_hint(const Nearest *nearest, char *buffer, int size);

/* The index of a lobe or a layer rule by id, or -1 after one line on standard error. */
int lobe_named(const char *id);
int layer_named(const char *id);

#endif
