/* splice.h - pieces of a text that give way to others */
#ifndef WEFT_TEXT_SPLICE_H
#define WEFT_TEXT_SPLICE_H

#include "text/source/buffer.h"

/* [at, end) of the text gives way to a piece of words. */
typedef struct Edit {
    const char *at, *end;
    size_t from, size; /* of the words */
    bool dropped;      /* with the blanks before it, or the line that has nothing else */
} Edit;

/* Zero-initialise. */
typedef struct Edits {
    Edit *all;
    size_t count, room;
    Buffer words;
    bool failed; /* memory ran out */
} Edits;

/* with may be NULL: nothing takes its place. */
void edit_put(Edits *edits, const char *at, const char *end, const char *with);

/* A statement goes, with a comment behind it and the line if that has nothing else. */
void edit_drop(Edits *edits, const char *at, const char *end);

/* Appends the text with the edits, of which one inside another is lost, and frees them. False where there are
 * none; then nothing is appended. */
bool edits_apply(Edits *edits, const char *text, Buffer *out);

#endif
