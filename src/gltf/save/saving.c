#include "gltf/save/saving.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/fail.h"
#include "base/file.h"

void saving_fail(Saving *saving, WeftMessage message, const char *subject, const char *detail) {
    if (saving->result == WEFT_OK)
        saving->result =
            detail ? fail(saving->error, message, subject, "%s", detail) : fail(saving->error, message, subject, NULL);
}

static void no_memory(Saving *saving) { saving_fail(saving, WEFT_MESSAGE_MEMORY, saving->path, NULL); }

void saving_put(Saving *saving, json_t *object, const char *key, json_t *value) {
    if (json_object_set_new(object, key, value) != 0) no_memory(saving);
}

void saving_append(Saving *saving, json_t *array, json_t *value) {
    if (json_array_append_new(array, value) != 0) no_memory(saving);
}

void saving_name(Saving *saving, json_t *object, const char *name) {
    json_t *text = name[0] ? json_string(name) : NULL; /* NULL also if it is no UTF-8 */
    if (text) saving_put(saving, object, "name", text);
}

json_t *saving_floats(const float *values, int count) {
    json_t *array = json_array();
    for (int k = 0; k < count; k++)
        if (json_array_append_new(array, json_real((double)values[k])) != 0) {
            json_decref(array);
            return NULL;
        }
    return array;
}

/* Returns a member of an object, created with make if it is missing. */
static json_t *member(Saving *saving, json_t *object, const char *key, json_t *(*make)(void)) {
    if (!json_object_get(object, key)) saving_put(saving, object, key, make());
    return json_object_get(object, key);
}

json_t *saving_list(Saving *saving, const char *name) { return member(saving, saving->root, name, json_array); }

void saving_uses(Saving *saving, const char *extension) {
    json_t *list = saving_list(saving, "extensionsUsed"), *value;
    size_t k;
    json_array_foreach(list, k, value) {
        if (strcmp(json_string_value(value), extension) == 0) return;
    }
    saving_append(saving, list, json_string(extension));
}

void saving_extend(Saving *saving, json_t *object, const char *name, json_t *value) {
    saving_uses(saving, name);
    saving_put(saving, member(saving, object, "extensions", json_object), name, value);
}

/* Allocates space for `more` bytes. Returns false if memory is short. */
static bool grow(Saving *saving, size_t more) {
    const size_t most = (size_t)4000 << 20; /* of a .glb, whose sizes are 32-bit numbers */
    if (more > most - saving->size) {
        saving_fail(saving, WEFT_MESSAGE_FILE_WRITE, saving->path, "it would have more than 4 GB");
        return false;
    }
    if (saving->size + more <= saving->capacity) return true;
    size_t capacity = 2 * saving->capacity > saving->size + more ? 2 * saving->capacity : saving->size + more;
    unsigned char *grown = realloc_array(saving->bytes, capacity, 1);
    if (!grown) {
        no_memory(saving);
        return false;
    }
    saving->bytes = grown;
    saving->capacity = capacity;
    return true;
}

void saving_bytes(Saving *saving, const void *data, size_t size) {
    size_t padding = (4 - size % 4) % 4;
    if (!size || saving->result != WEFT_OK || !grow(saving, size + padding)) return;
    memcpy(saving->bytes + saving->size, data, size);
    memset(saving->bytes + saving->size + size, 0, padding);
    saving->size += size + padding;
}

int saving_view(Saving *saving, const void *data, size_t size, int target) {
    json_t *views = saving_list(saving, "bufferViews"), *view = json_object();
    saving_put(saving, view, "buffer", json_integer(0));
    saving_put(saving, view, "byteOffset", json_integer((json_int_t)saving->size));
    saving_put(saving, view, "byteLength", json_integer((json_int_t)size));
    if (target) saving_put(saving, view, "target", json_integer(target));
    saving_bytes(saving, data, size);
    saving_append(saving, views, view);
    return (int)json_array_size(views) - 1;
}

char *saving_beside(Saving *saving, const char *end) {
    size_t stem = strlen(saving->path), size = stem + strlen(end) + 1;
    const char *dot = strrchr(saving->path, '.');
    char *path = arena_array(&saving->arena, size, 1);
    if (!path) no_memory(saving);
    if (path) snprintf(path, size, "%.*s%s", (int)(dot - saving->path), saving->path, end);
    return path;
}

/* Returns true if a character need not be encoded: IETF, RFC 3986 "Uniform Resource Identifier", 2005, section 2.3. */
static bool is_unreserved(unsigned char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || (c && strchr("-._~", c));
}

char *saving_uri(Saving *saving, const char *path) {
    const char *slash = strrchr(path, '/'), *name = slash ? slash + 1 : path;
    char *uri = arena_array(&saving->arena, 3 * strlen(name) + 1, 1), *to = uri;
    if (!uri) no_memory(saving);
    for (; uri && *name; name++) {
        if (is_unreserved((unsigned char)*name))
            *to++ = *name;
        else
            to += snprintf(to, 4, "%%%02X", (unsigned)(unsigned char)*name);
    }
    return uri;
}

void saving_write(Saving *saving, const char *path, const void *head, size_t head_size, const void *body,
                  size_t body_size) {
    OutputFile file;
    if (saving->result != WEFT_OK) return;
    saving->result = output_open(&file, path, saving->error);
    if (saving->result != WEFT_OK) return;
    fwrite(head, 1, head_size, file.stream);
    if (body_size) fwrite(body, 1, body_size, file.stream);
    saving->result = output_commit(&file, saving->error);
}

void saving_picture(Saving *saving, json_t *object, bool inside, int number, const void *bytes, size_t size,
                    const char *media, const char *suffix) {
    if (inside) {
        saving_put(saving, object, "mimeType", json_string(media));
        saving_put(saving, object, "bufferView", json_integer(saving_view(saving, bytes, size, 0)));
        return;
    }
    char end[32];
    snprintf(end, sizeof end, "-%d.%s", number, suffix);
    const char *path = saving_beside(saving, end), *uri = path ? saving_uri(saving, path) : NULL;
    if (uri) saving_put(saving, object, "uri", json_string(uri));
    if (uri) saving_write(saving, path, bytes, size, NULL, 0);
}
