/* buffer.h - text that grows, and stores the origin of each of its bytes */
#pragma once

#include <stdbool.h>
#include <stddef.h>

/* A line of a file, from 1 on; file is NULL where there is none. */
typedef struct Origin {
    const char *file; /* borrowed */
    int line;
} Origin;

/* Zero-initialise. bytes ends with a zero byte that size does not count, and is NULL until something is put.
 * The owner may make size smaller, which removes the bytes after it. */
typedef struct Buffer {
    char *bytes;
    size_t size, capacity;
    bool failed;   /* memory ran out, or the text passed BUFFER_LIMIT; nothing more is put */
    Origin origin; /* of the bytes put from now on; the owner sets it */
    struct BufferMark *marks;
    size_t mark_count, mark_capacity;
} Buffer;

enum { BUFFER_LIMIT = 1 << 24 };

void buffer_put(Buffer *buffer, const char *bytes, size_t size);
void buffer_put_text(Buffer *buffer, const char *text);

/* Appends formatted text, at most 511 bytes. */
__attribute__((format(printf, 2, 3))) void buffer_print(Buffer *buffer, const char *format, ...);

/* Returns the origin of the byte at that place. */
Origin buffer_origin(const Buffer *buffer, size_t at);

/* Leaves an empty buffer that can be used again. */
void buffer_free(Buffer *buffer);
