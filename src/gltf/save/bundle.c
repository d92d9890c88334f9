#include "gltf/save/bundle.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "base/fail.h"
#include "gltf/asset/uri.h"
#include "image/codec.h"

static const size_t FILE_MAX = (size_t)4 << 30;

/* Returns an asset whose URIs resolve from the folder of a path. Only the name of the path is read. */
static Asset folder_of(const char *path, bool in_memory, WeftError *error) {
    return (Asset){.name = path, .in_memory = in_memory, .error = error};
}

/* Returns the path of a URI, in the arena of base, or NULL if it names no file. */
static char *file_path(Asset *base, const char *uri) {
    Field field = {.asset = base};
    char *path = uri_is_data(uri) ? NULL : uri_path(&field, uri);
    base->result = WEFT_OK; /* a URI that names no file is kept */
    return path;
}

FileBytes bundle_bytes(const Asset *asset, const char *uri, WeftResult *result, WeftError *error) {
    WeftError unused;
    Asset base = folder_of(asset->name, asset->in_memory, &unused);
    Field field = {.asset = &base};
    FileBytes bytes = {0};
    char *path = NULL;
    if (uri_is_data(uri))
        bytes.data = uri_decode(&field, uri, &bytes.size);
    else if ((path = file_path(&base, uri)))
        *result = file_read(path, FILE_MAX, &bytes, error);
    arena_free(&base.arena);
    return bytes;
}

/* The new place of an old buffer: the number of its buffer, and the offset of its bytes there. */
typedef struct Moved {
    json_int_t number, shift;
} Moved;

/* Returns a number, since integers may be written as reals; 0 if it is absent. */
static double number_at(const json_t *object, const char *key) {
    return json_number_value(json_object_get(object, key));
}

static void reference_move(Saving *saving, json_t *object, const Moved *moved, size_t count) {
    double k = json_is_number(json_object_get(object, "buffer")) ? number_at(object, "buffer") : -1.0;
    double offset = number_at(object, "byteOffset");
    if (!(k >= 0.0) || !(k < (double)count) || !(offset >= 0.0) || offset > 0x1p53) return;
    const Moved *to = &moved[(size_t)k];
    if (to->number != (json_int_t)k) saving_put(saving, object, "buffer", json_integer(to->number));
    if (to->shift) saving_put(saving, object, "byteOffset", json_integer((json_int_t)offset + to->shift));
}

/* Updates the buffers that views and their compression extensions name. */
static void references_move(Saving *saving, const Moved *moved, size_t count) {
    size_t k;
    json_t *view, *extension;
    const char *name;
    json_array_foreach(json_object_get(saving->root, "bufferViews"), k, view) {
        reference_move(saving, view, moved, count);
        json_object_foreach(json_object_get(view, "extensions"), name, extension) {
            reference_move(saving, extension, moved, count);
        }
    }
}

/* Appends the bytes of all buffers to the first. */
static void buffers_pack(Saving *saving, const Asset *asset) {
    json_t *buffers = json_object_get(saving->root, "buffers"), *kept = json_array(), *buffer;
    size_t count = json_array_size(buffers), k;
    Moved *moved = arena_array(&saving->arena, count, sizeof *moved);
    if (!moved || !kept) saving_fail(saving, WEFT_MESSAGE_MEMORY, saving->path, NULL);
    json_array_foreach(buffers, k, buffer) {
        const char *uri = json_string_value(json_object_get(buffer, "uri"));
        FileBytes bytes = {0};
        if (!moved || saving->result != WEFT_OK) break;
        if (uri) bytes = bundle_bytes(asset, uri, &saving->result, saving->error);
        double length = number_at(buffer, "byteLength");
        size_t size = length > 0.0 && length < (double)bytes.size ? (size_t)length : bytes.size;
        moved[k] =
            (Moved){bytes.data ? 0 : (json_int_t)json_array_size(kept), bytes.data ? (json_int_t)saving->size : 0};
        if (bytes.data) saving_bytes(saving, bytes.data, size);
        if (bytes.data) json_object_del(buffer, "uri");
        if (k == 0 || !bytes.data) json_array_append(kept, buffer);
        free(bytes.data);
    }
    if (moved && saving->result == WEFT_OK) references_move(saving, moved, count);
    if (saving->result == WEFT_OK && json_array_size(kept) != count)
        saving_put(saving, saving->root, "buffers", kept);
    else
        json_decref(kept);
}

static void image_pack(Saving *saving, const Asset *asset, json_t *image) {
    const char *uri = json_string_value(json_object_get(image, "uri"));
    FileBytes bytes = {0};
    if (uri) bytes = bundle_bytes(asset, uri, &saving->result, saving->error);
    const char *type = bytes.data ? image_media_type(bytes.data, bytes.size) : NULL;
    if (type && saving->result == WEFT_OK) {
        saving_put(saving, image, "mimeType", json_string(type));
        saving_put(saving, image, "bufferView", json_integer(saving_view(saving, bytes.data, bytes.size, 0)));
        json_object_del(image, "uri");
    }
    free(bytes.data);
}

void bundle_pack(Saving *saving, const Asset *asset) {
    json_t *buffers = json_object_get(saving->root, "buffers"), *image;
    size_t k;
    if (buffers && !json_object_get(json_array_get(buffers, 0), "uri")) return;
    buffers_pack(saving, asset);
    json_array_foreach(json_object_get(saving->root, "images"), k, image) {
        if (saving->result == WEFT_OK) image_pack(saving, asset, image);
    }
}

static bool same_folder(const char *a, const char *b) {
    const char *const paths[2] = {a, b};
    struct stat status[2];
    for (int k = 0; k < 2; k++) {
        char folder[4096];
        const char *slash = strrchr(paths[k], '/');
        size_t length = slash ? (size_t)(slash - paths[k]) + 1 : 2;
        if (length >= sizeof folder) return false;
        memcpy(folder, slash ? paths[k] : "./", length);
        folder[length] = 0;
        if (stat(folder, &status[k]) != 0) return false;
    }
    return status[0].st_dev == status[1].st_dev && status[0].st_ino == status[1].st_ino;
}

/* Makes the folders on the way to a file that are not there, below the first `from` characters. */
static void folders_make(char *path, size_t from) {
    for (char *slash = path + from; (slash = strchr(slash, '/')); slash++) {
        *slash = 0;
        mkdir(path, 0777); /* if it fails, writing the file fails too */
        *slash = '/';
    }
}

static void file_copy(Saving *saving, const char *from, char *to, size_t folder) {
    FileBytes bytes = {0}, there = {0};
    struct stat status;
    if (stat(from, &status) != 0) return;
    saving->result = file_read(from, FILE_MAX, &bytes, saving->error);
    if (saving->result == WEFT_OK && stat(to, &status) == 0) {
        saving->result = file_read(to, FILE_MAX, &there, saving->error);
        if (saving->result == WEFT_OK && (there.size != bytes.size || memcmp(there.data, bytes.data, bytes.size) != 0))
            saving_fail(saving, WEFT_MESSAGE_FILE_WRITE, to, "another file of that name is there");
    } else if (saving->result == WEFT_OK) {
        folders_make(to, folder);
        saving_write(saving, to, bytes.data, bytes.size, NULL, 0);
    }
    free(bytes.data);
    free(there.data);
}

static void uri_copy(Saving *saving, const Asset *asset, const char *uri) {
    WeftError unused;
    Asset here = folder_of(asset->name, asset->in_memory, &unused), there = folder_of(saving->path, false, &unused);
    const char *slash = strrchr(saving->path, '/');
    Field field = {.asset = &there};
    char *from = file_path(&here, uri), *to = from ? uri_path_to_write(&field, uri) : NULL;
    if (from && !to)
        saving_fail(saving, WEFT_MESSAGE_FILE_WRITE, saving->path,
                    "a file lies outside of the asset's folder: write a .glb, which packs it");
    else if (from)
        file_copy(saving, from, to, slash ? (size_t)(slash - saving->path) + 1 : 0);
    arena_free(&here.arena);
    arena_free(&there.arena);
}

/* Copies every file named by a member "uri", at any depth, since extensions refer to files too. */
static void copy_below(Saving *saving, const Asset *asset, json_t *value) {
    size_t k;
    json_t *part;
    const char *key;
    json_array_foreach(value, k, part) { copy_below(saving, asset, part); }
    json_object_foreach(value, key, part) {
        if (strcmp(key, "uri") == 0 && json_is_string(part) && saving->result == WEFT_OK)
            uri_copy(saving, asset, json_string_value(part));
        copy_below(saving, asset, part);
    }
}

void bundle_copy(Saving *saving, const Asset *asset) {
    if (!asset->in_memory && !same_folder(asset->name, saving->path)) copy_below(saving, asset, saving->root);
}
