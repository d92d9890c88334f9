/* Specification: Khronos Group, "glTF 2.0 Specification", 2021, section 4 (GLB file format). */
#include "gltf/asset/container.h"

#include <string.h>

#include "base/fail.h"
#include "base/json.h"
#include "base/little_endian.h"
#include "base/mark.h"

/* A parsed value takes up to some 150 bytes, and each but the first follows one of , [ { in the text: so this
 * bounds the memory of the tree. The largest real scenes have tens of thousands of nodes. */
enum { JSON_VALUES_MAX = 4000000 };

/* Takes away what some exporters put around the text and glTF forbids, with a warning: a byte order mark before it, and
 * zeros behind it, which are to be blanks in a GLB. */
static Span text_trim(const Asset *asset, Span text) {
    const size_t mark = mark_size(text.data, text.size), whole = text.size;
    while (text.size && !text.data[text.size - 1]) text.size--;
    if (text.size < whole)
        warn(asset->log, WEFT_MESSAGE_GLTF_WARN_REPAIRED, asset->name, "zeros end its JSON; glTF has blanks there");
    if (mark)
        warn(asset->log, WEFT_MESSAGE_GLTF_WARN_REPAIRED, asset->name,
             "its JSON begins with a byte order mark, which glTF forbids");
    return (Span){text.data + mark, text.size - mark};
}

static void json_read(Asset *asset, Span text) {
    size_t values = 0;
    text = text_trim(asset, text);
    asset->text = text;
    for (size_t i = 0; i < text.size; i++) values += text.data[i] == ',' || text.data[i] == '[' || text.data[i] == '{';
    if (values > JSON_VALUES_MAX) {
        asset_fail(asset, WEFT_MESSAGE_GLTF_TOO_LARGE, "more than %d JSON values", JSON_VALUES_MAX);
        return;
    }
    json_error_t error;
    bool starved;
    asset->root = json_parse((const char *)text.data, text.size, 0, &error, &starved);
    if (starved)
        asset_fail(asset, WEFT_MESSAGE_MEMORY, NULL);
    else if (!asset->root)
        asset_fail(asset, WEFT_MESSAGE_GLTF_JSON, "line %d, column %d: %s", error.line, error.column, error.text);
    else if (!json_is_object(asset->root))
        asset_fail(asset, WEFT_MESSAGE_GLTF_JSON, "the outermost value is not an object");
}

static uint32_t word(const unsigned char *p) { return (uint32_t)little_endian(p, 4); }

enum { HEADER_SIZE = 12, CHUNK_HEADER_SIZE = 8, CHUNK_JSON = 0x4e4f534a, CHUNK_BIN = 0x004e4942 };

static void glb_read(Asset *asset, Span data) {
    if (data.size < HEADER_SIZE) {
        asset_fail(asset, WEFT_MESSAGE_GLTF_CONTAINER, "the header is cut short");
        return;
    }
    uint32_t version = word(data.data + 4), length = word(data.data + 8);
    if (version != 2) {
        asset_fail(asset, WEFT_MESSAGE_GLTF_VERSION, "it is GLB version %u", (unsigned)version);
        return;
    }
    if (length < HEADER_SIZE || length > data.size) {
        asset_fail(asset, WEFT_MESSAGE_GLTF_CONTAINER, "it has %zu of %u bytes", data.size, (unsigned)length);
        return;
    }

    Span json = {0};
    size_t at = HEADER_SIZE;
    asset->packed = true;
    for (int chunk = 0; at + CHUNK_HEADER_SIZE <= length; chunk++) {
        uint32_t size = word(data.data + at), type = word(data.data + at + 4);
        at += CHUNK_HEADER_SIZE;
        if (size > length - at) {
            asset_fail(asset, WEFT_MESSAGE_GLTF_CONTAINER, "chunk %d reaches beyond the end", chunk);
            return;
        }
        Span body = {data.data + at, size};
        at += size;
        if (chunk == 0 && type == CHUNK_JSON)
            json = body;
        else if (chunk == 0)
            break;
        else if (chunk == 1 && type == CHUNK_BIN)
            asset->bin = body;
        else if (!asset->behind.data && type != CHUNK_JSON && type != CHUNK_BIN)
            asset->behind = (Span){body.data - CHUNK_HEADER_SIZE, length - at + size + CHUNK_HEADER_SIZE};
        else if (type == CHUNK_JSON || type == CHUNK_BIN)
            warn(asset->log, WEFT_MESSAGE_GLTF_WARN_IGNORED, asset->name, "misplaced chunk %d", chunk);
    }
    if (!json.data) {
        asset_fail(asset, WEFT_MESSAGE_GLTF_CONTAINER, "the first chunk is not JSON");
        return;
    }
    if (length < data.size)
        warn(asset->log, WEFT_MESSAGE_GLTF_WARN_IGNORED, asset->name, "%zu bytes after the end", data.size - length);
    json_read(asset, json);
}

void container_read(Asset *asset, Span data) {
    if (data.size >= 4 && memcmp(data.data, "glTF", 4) == 0) {
        glb_read(asset, data);
        return;
    }
    size_t blank = mark_size(data.data, data.size);
    while (blank < data.size && data.data[blank] && strchr(" \t\r\n", data.data[blank])) blank++;
    if (blank < data.size && data.data[blank] == '{')
        json_read(asset, data);
    else
        asset_fail(asset, WEFT_MESSAGE_SCENE_KIND, "it is neither GLB nor a JSON object");
}

static unsigned char *put_word(unsigned char *to, size_t word) {
    for (int k = 0; k < 4; k++) *to++ = (unsigned char)(word >> (8 * k) & 255);
    return to;
}

unsigned char *container_head(Span text, size_t bin, size_t behind, size_t *size) {
    enum { MAGIC = 0x46546c67, VERSION = 2 };
    size_t json = (text.size + 3) / 4 * 4, tail = bin ? CHUNK_HEADER_SIZE : 0;
    *size = HEADER_SIZE + CHUNK_HEADER_SIZE + json + tail;
    unsigned char *head = alloc_array(*size, 1), *to = head;
    if (!head) return NULL;
    to = put_word(put_word(put_word(to, MAGIC), VERSION), *size + bin + behind);
    to = put_word(put_word(to, json), CHUNK_JSON);
    memset(to, ' ', json);
    memcpy(to, text.data, text.size);
    if (tail) put_word(put_word(to + json, bin), CHUNK_BIN);
    return head;
}
