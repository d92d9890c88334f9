/* names.h - the ids of the catalogue by kind, and the name that a misspelt one probably means */
#pragma once

#include <stdbool.h>

/* The search for the name nearest to `typed` among those offered. Start with {.typed = text}. */
typedef struct Nearest {
    const char *typed, *name; /* name: the best so far, NULL when none is near enough */
    int distance;
} Nearest;

/* Considers one more name; it must outlive the search. */
void nearest_offer(Nearest *nearest, const char *name);

/* Writes "; did you mean NAME?" to the caller's buffer, or "" when no name is near. Returns buffer. */
const char *nearest_hint(const Nearest *nearest, char *buffer, int size);

/* The groups of a list: their names, ended by NULL, what is in them, and the name of an entry's group. */
typedef struct KindGroups {
    const char *(*name)(int index), *(*help)(int index), *(*of)(int index);
} KindGroups;

/* A list of the catalogue. name and help end with NULL. */
typedef struct Kind {
    const char *id;                      /* what one of them is: "lobe" */
    const char *article, *key, *heading; /* "a", "lobes" as in JSON, "Lobes" over a list */
    const char *(*name)(int index), *(*help)(int index);
    bool shown;               /* in the list of all kinds; else part of another kind */
    const char *file;         /* how the paths of its files begin, "terms/d_"; NULL: it has none */
    const KindGroups *groups; /* NULL: the list has none */
} Kind;

extern const Kind kinds[]; /* ends with an id of NULL */

/* Returns the kind of that id, which must exist. */
const Kind *kind_of(const char *id);

/* Returns the kind whose key begins with `length` characters of text, as in "lobe:ggx"; NULL if there is none. */
const Kind *kind_prefixed(const char *text, int length);

/* Returns the index of an id in a kind, or of what an alias of that name stands for, or -1. */
int kind_find(const Kind *kind, const char *id);

/* Works as kind_find, but returns -1 after one line on standard error. */
int kind_named(const Kind *kind, const char *id);
