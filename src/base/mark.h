/* mark.h - the byte-order mark U+FEFF, with which some programs begin a text in UTF-8 */
#ifndef WEFT_BASE_MARK_H
#define WEFT_BASE_MARK_H

#include <stddef.h>
#include <string.h>

/* Returns how many bytes of the text the mark takes: 3 or, where there is none, 0. */
static inline size_t mark_size(const void *text, size_t size) {
    return size >= 3 && memcmp(text, "\xef\xbb\xbf", 3) == 0 ? 3 : 0;
}

#endif
