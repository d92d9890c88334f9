/* buffer.h - text that grows */
#ifndef WEFT_TEXT_BUFFER_H
#define WEFT_TEXT_BUFFER_H

#include <stdbool.h>
#include <stddef.h>

/* Zero-initialise. bytes ends with a zero byte that size does not count, and is NULL until something is put.
 */
typedef struct Buffer {
    char *bytes;
    size_t size, room;
    bool failed; /* memory ran out, or the text passed BUFFER_LIMIT; nothing more is put */
} Buffer;

enum { BUFFER_LIMIT = 1 << 24 };

void buffer_put(Buffer *buffer, const char *bytes, size_t size);
void buffer_put_text(Buffer *buffer, const char *text);

/* Leaves an empty buffer that can be used again. */
void buffer_free(Buffer *buffer);

#endif
