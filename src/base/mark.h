/* mark.h - the byte-order mark U+FEFF at the beginning of a text in UTF-8 */
#pragma once

#include <stddef.h>
#include <string.h>

/* Returns the size of the mark in bytes: 3, or 0 if the text has none. */
static inline size_t mark_size(const void *text, size_t size) {
    return size >= 3 && memcmp(text, "\xef\xbb\xbf", 3) == 0 ? 3 : 0;
}
