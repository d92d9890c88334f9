#include "text/passes/splice.h"

#include <stdlib.h>

#include "base/memory.h"
#include "text/source/token.h"

void edit_put(Edits *edits, const char *at, const char *end, const char *with) {
    if (edits->count == edits->capacity) {
        size_t capacity = edits->capacity ? 2 * edits->capacity : 64;
        Edit *all = realloc_array(edits->all, capacity, sizeof *all);
        if (!all) {
            edits->failed = true;
            return;
        }
        edits->all = all;
        edits->capacity = capacity;
    }
    size_t from = edits->words.size;
    if (with) buffer_put_text(&edits->words, with);
    edits->all[edits->count++] = (Edit){at, end, from, edits->words.size - from, false};
}

void edit_drop(Edits *edits, const char *at, const char *end) {
    const char *last = end;
    while (*last == ' ' || *last == '\t') last++;
    if (is_comment(last, last + strlen(last))) {
        const char *stop = comment_end(last, last + strlen(last));
        if (*stop == '\n') end = stop;
    }
    size_t count = edits->count;
    edit_put(edits, at, end, NULL);
    if (edits->count > count) edits->all[count].dropped = true;
}

/* Compares edits by their beginning, then the longest first. */
static int order(const void *left, const void *right) {
    const Edit *a = left, *b = right;
    if (a->at != b->at) return a->at < b->at ? -1 : 1;
    if (a->end != b->end) return a->end > b->end ? -1 : 1;
    return a->from < b->from ? -1 : a->from > b->from;
}

static bool is_space(char c) { return c == ' ' || c == '\t'; }

/* Widens a removed piece to its line if that has nothing else, else by the blanks before it. */
static void widen(const char *text, const char **at, const char **end) {
    const char *first = *at, *last = *end;
    while (first > text && is_space(first[-1])) first--;
    while (is_space(*last)) last++;
    bool begins = first == text || first[-1] == '\n';
    if (begins && *last == '\n') {
        *at = first;
        *end = last + 1;
    } else if (!begins) {
        *at = first;
    } else {
        *end = last;
    }
}

/* Joins edit k with those inside it, and with removed statements next to each other. Sets the end of the joined piece
 * and returns the next edit. */
static size_t run_end(const Edits *edits, size_t k, const char **end) {
    const bool dropped = edits->all[k].dropped;
    *end = edits->all[k].end;
    for (k++; k < edits->count; k++) {
        const Edit *next = &edits->all[k];
        const char *c = *end;
        while (c < next->at && is_space(*c)) c++;
        if (next->at >= *end && (c < next->at || !dropped || !next->dropped)) return k;
        if (next->end > *end) *end = next->end;
    }
    return k;
}

bool edits_apply(Edits *edits, const char *text, Buffer *out) {
    bool any = edits->count > 0;
    const char *c = text;
    if (any) qsort(edits->all, edits->count, sizeof *edits->all, order);
    for (size_t k = 0, next; k < edits->count; k = next) {
        const Edit *edit = &edits->all[k];
        const char *at = edit->at, *end;
        next = run_end(edits, k, &end);
        if (edit->dropped) widen(text, &at, &end);
        buffer_put(out, c, (size_t)(at - c));
        if (edit->size) buffer_put(out, edits->words.bytes + edit->from, edit->size);
        c = end;
    }
    if (any) buffer_put_text(out, c);
    out->failed |= edits->failed || edits->words.failed;
    free(edits->all);
    buffer_free(&edits->words);
    *edits = (Edits){0};
    return any;
}
