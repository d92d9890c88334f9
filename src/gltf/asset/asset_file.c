#include "gltf/asset/asset_file.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "base/fail.h"
#include "gltf/asset/uri.h"

enum { FILES_MAX = 4096 };

static const size_t FILES_SIZE_MAX = (size_t)4 << 30;

/* Finds the record of the file that status describes, or adds one: a file can have many names. */
static AssetFile *file_find(FileTable *table, Asset *asset, const char *path, const struct stat *status) {
    for (size_t i = 0; i < table->count; i++)
        if (table->items[i].node == status->st_ino && table->items[i].device == status->st_dev) return &table->items[i];
    if (!table->items) table->items = asset_array(asset, &asset->arena, FILES_MAX, sizeof *table->items);
    if (table->count == FILES_MAX) asset_fail(asset, WEFT_MESSAGE_GLTF_TOO_LARGE, "more than %d files", FILES_MAX);
    if (asset->result != WEFT_OK) return NULL;
    AssetFile *file = &table->items[table->count++];
    *file = (AssetFile){.path = path,
                        .device = status->st_dev,
                        .node = status->st_ino,
                        .size = status->st_size > 0 ? (size_t)status->st_size : 0};
    return file;
}

AssetFile *file_refer(FileTable *table, const Field *field, const char *uri, size_t wanted) {
    Asset *asset = field->asset;
    const char *path = uri_path(field, uri);
    if (!path || asset->result != WEFT_OK) return NULL;
    struct stat status;
    if (stat(path, &status) != 0) {
        asset->result = fail(asset->error, WEFT_MESSAGE_FILE_OPEN, path, "%s", strerror(errno));
        return NULL;
    }
    AssetFile *file = file_find(table, asset, path, &status);
    if (file && file->wanted < wanted) file->wanted = wanted;
    return file;
}

Span file_bytes(FileTable *table, Asset *asset, AssetFile *file) {
    size_t available = FILES_SIZE_MAX - table->bytes;
    if (!file->bytes.data && asset->result == WEFT_OK) {
        size_t most = file->wanted < file->size ? file->wanted : file->size;
        if (most > available)
            asset_fail(asset, WEFT_MESSAGE_GLTF_TOO_LARGE, "its files have more than %zu bytes", FILES_SIZE_MAX);
        else
            asset->result = file_read_start(file->path, most, &file->bytes, asset->error);
        table->bytes += file->bytes.size;
    }
    return (Span){file->bytes.data, file->bytes.size};
}

void files_free(FileTable *table) {
    for (size_t i = 0; i < table->count; i++) free(table->items[i].bytes.data);
}
