#include "gltf/asset/buffer_views.h"

#include <stdlib.h>
#include <string.h>

#include "base/fail.h"
#include "gltf/asset/asset_file.h"
#include "gltf/asset/field.h"
#include "gltf/asset/meshopt.h"
#include "gltf/asset/uri.h"

/* The limit on decoded bytes: instances, sparse zeros and compression make a scene larger than its file. Any file may
 * use the floor, a small one a thousand times its size up to 256 MiB, a large one 64 times up to 4 GiB. */
static const size_t MIB = (size_t)1 << 20;

static size_t decoding_limit(size_t input) {
    const size_t floor = 16 * MIB, small = 256 * MIB, large = 4096 * MIB;
    size_t limit = input < small / 1024 ? input * 1024 : small;
    if (limit < floor) limit = floor;
    size_t ample = input < large / 64 ? input * 64 : large;
    return limit > ample ? limit : ample;
}

static void span_fill(const Field *field, AssetBuffer *buffer, Span bytes) {
    buffer->span.data = bytes.data;
    if (bytes.data && bytes.size < buffer->span.size)
        field_fail(field, WEFT_MESSAGE_GLTF_BOUNDS, "%zu of %zu bytes are there", bytes.size, buffer->span.size);
}

static void buffer_read(const Field *field, AssetBuffer *buffer, bool first) {
    Asset *asset = field->asset;
    Field length = field_member(field, "byteLength"), uri_field = field_member(field, "uri");
    const char *uri = field_text(&uri_field, NULL);
    if (!length.json) field_fail(&length, WEFT_MESSAGE_GLTF_SCHEMA, "missing an integer");
    buffer->span.size = field_size(&length, 0, 1, SIZE_MAX);
    if (uri && uri_is_data(uri)) {
        size_t size = 0;
        buffer->owned = uri_decode(&uri_field, uri, &size);
        span_fill(field, buffer, (Span){buffer->owned, size});
    } else if (uri) {
        buffer->file = file_refer(&asset->buffer_files, &uri_field, uri, buffer->span.size);
    } else if (first) {
        span_fill(field, buffer, asset->bin);
    }
}

/* Reads the files after all buffers have been seen, because only then it is clear how many bytes of each are needed. */
void buffers_read(Asset *asset) {
    Field root = field_root(asset), list = field_member(&root, "buffers");
    asset->buffer_count = field_count(&list);
    asset->buffers = asset_array(asset, &asset->arena, asset->buffer_count, sizeof *asset->buffers);
    for (size_t i = 0; i < asset->buffer_count && asset->result == WEFT_OK; i++) {
        Field field = field_element(&list, i);
        buffer_read(&field, &asset->buffers[i], i == 0);
    }
    for (size_t i = 0; i < asset->buffer_count && asset->result == WEFT_OK; i++) {
        Field field = field_element(&list, i);
        AssetBuffer *buffer = &asset->buffers[i];
        if (buffer->file) span_fill(&field, buffer, file_bytes(&asset->buffer_files, asset, buffer->file));
        asset_progress(asset, 0.05, 0.25, i + 1, asset->buffer_count);
    }
    asset->input_bytes += asset->buffer_files.bytes;
    asset->limit = decoding_limit(asset->input_bytes);
}

void buffers_free(Asset *asset) {
    for (size_t i = 0; i < asset->buffer_count && asset->buffers; i++) free(asset->buffers[i].owned);
    files_free(&asset->buffer_files);
}

/* Returns the bytes that byteOffset and byteLength of field select in its buffer. */
static Span section(const Field *field) {
    Asset *asset = field->asset;
    Field buffer_field = field_member(field, "buffer"), offset_field = field_member(field, "byteOffset"),
          length_field = field_member(field, "byteLength");
    int index = field_needed_index(&buffer_field, asset->buffer_count);
    size_t offset = field_size(&offset_field, 0, 0, SIZE_MAX);
    if (!length_field.json) field_fail(&length_field, WEFT_MESSAGE_GLTF_SCHEMA, "missing an integer");
    size_t length = field_size(&length_field, 0, 1, SIZE_MAX);
    if (asset->result != WEFT_OK || index < 0) return (Span){0};
    Span all = asset->buffers[index].span;
    if (offset > all.size || length > all.size - offset) {
        field_fail(field, WEFT_MESSAGE_GLTF_BOUNDS, "%zu bytes from %zu on, of %zu", length, offset, all.size);
        return (Span){0};
    }
    return (Span){all.data ? all.data + offset : NULL, length};
}

/* Returns the index of the text of field among count names, and fails (sticky) if it is none of them. */
static int choice(const Field *field, const char *absent, const char *const *names, int count) {
    const char *text = field_text(field, absent);
    for (int i = 0; text && i < count; i++)
        if (strcmp(text, names[i]) == 0) return i;
    field_fail(field, WEFT_MESSAGE_GLTF_SCHEMA, "not a value of the extension");
    return 0;
}

/* Reads what an extension says of compressed bytes; it has the first filter_count of the names of filters. */
static void compression_read(const Field *field, int filter_count, BufferView *view) {
    static const char *const modes[] = {"ATTRIBUTES", "TRIANGLES", "INDICES"};
    static const char *const filters[] = {"NONE", "OCTAHEDRAL", "QUATERNION", "EXPONENTIAL", "COLOR"};
    Asset *asset = field->asset;
    Compression *compression = asset_array(asset, &asset->arena, 1, sizeof *compression);
    if (!compression) return;
    Field count = field_member(field, "count"), stride = field_member(field, "byteStride"),
          mode = field_member(field, "mode"), filter = field_member(field, "filter");
    compression->source = section(field);
    compression->count = field_size(&count, 0, 1, SIZE_MAX);
    compression->stride = field_size(&stride, 0, 1, 256);
    switch (choice(&mode, NULL, modes, 3)) {
    case 1: compression->mode = MODE_TRIANGLES; break;
    case 2: compression->mode = MODE_INDICES; break;
    default: compression->mode = MODE_ATTRIBUTES; break;
    }
    switch (choice(&filter, "NONE", filters, filter_count)) {
    case 1: compression->filter = FILTER_OCTAHEDRAL; break;
    case 2: compression->filter = FILTER_QUATERNION; break;
    case 3: compression->filter = FILTER_EXPONENTIAL; break;
    case 4: compression->filter = FILTER_COLOR; break;
    default: compression->filter = FILTER_NONE; break;
    }
    const char *reason = meshopt_reason(compression, view->span.size);
    if (reason) field_fail(field, WEFT_MESSAGE_GLTF_SCHEMA, "%s", reason);
    view->compression = compression;
    Field packed = field_member(field, "buffer"), plain = field_member(field->parent, "buffer");
    if (field_index(&packed, asset->buffer_count) == field_index(&plain, asset->buffer_count))
        view->span.data = NULL; /* there are only the compressed bytes */
}

void views_read(Asset *asset) {
    Field root = field_root(asset), list = field_member(&root, "bufferViews");
    asset->view_count = field_count(&list);
    asset->views = asset_array(asset, &asset->arena, asset->view_count, sizeof *asset->views);
    for (size_t i = 0; i < asset->view_count && asset->result == WEFT_OK; i++) {
        Field field = field_element(&list, i), stride = field_member(&field, "byteStride");
        Field newer = field_extension(&field, "KHR_meshopt_compression"),
              older = field_extension(&field, "EXT_meshopt_compression");
        BufferView *view = &asset->views[i];
        view->span = section(&field);
        view->stride = field_size(&stride, 0, 4, 252);
        if (asset->result != WEFT_OK || (!newer.json && !older.json)) continue;
        compression_read(newer.json ? &newer : &older, newer.json ? 5 : 4, view);
    }
}

/* Decompresses a view, or keeps the bytes of its fallback, with a warning. */
static void view_decode(Asset *asset, int index) {
    BufferView *view = &asset->views[index];
    unsigned char *decoded = asset_array(asset, &asset->arena, view->span.size, 1);
    const char *reason = decoded ? meshopt_decode(view->compression, decoded) : NULL;
    view->compression = NULL;
    if (!reason)
        view->span.data = decoded;
    else if (view->span.data)
        warn(asset->log, WEFT_MESSAGE_GLTF_WARN_REPAIRED, asset->name,
             "bufferViews[%d]: %s; the bytes without compression are used", index, reason);
    else
        asset_fail(asset, WEFT_MESSAGE_GLTF_DECODE, "bufferViews[%d]: %s", index, reason);
}

Span view_bytes(Asset *asset, int index) {
    BufferView *view = &asset->views[index];
    if (view->compression && asset->result == WEFT_OK) view_decode(asset, index);
    if (!view->span.data)
        asset_fail(asset, WEFT_MESSAGE_GLTF_REFERENCE, "bufferViews[%d]: its buffer has no data", index);
    return asset->result == WEFT_OK ? view->span : (Span){0};
}
