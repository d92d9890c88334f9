#include "text/buffer.h"

#include <stdlib.h>
#include <string.h>

#include "base/memory.h"

void buffer_put(Buffer *buffer, const char *bytes, size_t size) {
    if (buffer->failed) return;
    if (size > BUFFER_LIMIT - buffer->size) {
        buffer->failed = true;
        return;
    }
    if (buffer->size + size + 1 > buffer->room) {
        size_t room = 2 * (buffer->size + size + 1);
        char *grown = realloc_array(buffer->bytes, room, 1);
        if (!grown) {
            buffer->failed = true;
            return;
        }
        buffer->bytes = grown;
        buffer->room = room;
    }
    memcpy(buffer->bytes + buffer->size, bytes, size);
    buffer->size += size;
    buffer->bytes[buffer->size] = 0;
}

void buffer_put_text(Buffer *buffer, const char *text) { buffer_put(buffer, text, strlen(text)); }

void buffer_free(Buffer *buffer) {
    free(buffer->bytes);
    *buffer = (Buffer){0};
}
