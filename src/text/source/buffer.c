#include "text/source/buffer.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"

/* The origin of the bytes from a place up to the next mark. */
typedef struct BufferMark {
    size_t at;
    Origin origin;
} BufferMark;

/* Returns the index of the first mark after a place. */
static size_t mark_after(const Buffer *buffer, size_t at) {
    size_t low = 0, high = buffer->mark_count;
    while (low < high) {
        size_t middle = (low + high) / 2;
        if (buffer->marks[middle].at <= at)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

Origin buffer_origin(const Buffer *buffer, size_t at) {
    size_t next = mark_after(buffer, at);
    return next ? buffer->marks[next - 1].origin : (Origin){0};
}

/* Records the origin of the bytes that are put next, and drops marks of bytes that were removed. */
static void put_mark(Buffer *buffer) {
    while (buffer->mark_count && buffer->marks[buffer->mark_count - 1].at >= buffer->size) buffer->mark_count--;
    Origin last = {0}, now = buffer->origin;
    if (buffer->mark_count) last = buffer->marks[buffer->mark_count - 1].origin;
    if (last.file == now.file && last.line == now.line) return;
    if (buffer->mark_count == buffer->mark_capacity) {
        size_t capacity = 2 * buffer->mark_capacity + 16;
        BufferMark *grown = realloc_array(buffer->marks, capacity, sizeof *grown);
        if (!grown) {
            buffer->failed = true;
            return;
        }
        buffer->marks = grown;
        buffer->mark_capacity = capacity;
    }
    buffer->marks[buffer->mark_count++] = (BufferMark){buffer->size, now};
}

void buffer_put(Buffer *buffer, const char *bytes, size_t size) {
    if (buffer->failed) return;
    if (size > BUFFER_LIMIT - buffer->size) {
        buffer->failed = true;
        return;
    }
    if (buffer->size + size + 1 > buffer->capacity) {
        size_t capacity = 2 * (buffer->size + size + 1);
        char *grown = realloc_array(buffer->bytes, capacity, 1);
        if (!grown) {
            buffer->failed = true;
            return;
        }
        buffer->bytes = grown;
        buffer->capacity = capacity;
    }
    put_mark(buffer);
    memcpy(buffer->bytes + buffer->size, bytes, size);
    buffer->size += size;
    buffer->bytes[buffer->size] = 0;
}

void buffer_print(Buffer *buffer, const char *format, ...) {
    char text[512];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    buffer_put_text(buffer, text);
}

void buffer_put_text(Buffer *buffer, const char *text) { buffer_put(buffer, text, strlen(text)); }

void buffer_free(Buffer *buffer) {
    free(buffer->bytes);
    free(buffer->marks);
    *buffer = (Buffer){0};
}
