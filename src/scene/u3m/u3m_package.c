#include "scene/u3m/u3m_package.h"

#include <jansson.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <zip.h>

#include "base/fail.h"
#include "base/file.h"
#include "base/little_endian.h"
#include "base/memory.h"
#include "base/path.h"
#include "scene/u3m/u3m_archive.h"

static const size_t bytes_most = (size_t)1 << 30; /* as is read again */

typedef struct PackedFile {
    char *path;
    unsigned char *data;
    size_t size;
    bool own;
} PackedFile;

struct U3mPackage {
    const char *path; /* borrowed */
    PackedFile *files;
    size_t count, bytes;
};

WeftResult u3m_package_begin(const char *path, U3mPackage **out, WeftError *error) {
    *out = alloc_array(1, sizeof **out);
    if (!*out) return fail(error, WEFT_MESSAGE_MEMORY, path, NULL);
    (*out)->path = path;
    return WEFT_OK;
}

bool u3m_package_has(const U3mPackage *package, const char *path) {
    for (size_t k = 0; k < package->count; k++)
        if (strcmp(package->files[k].path, path) == 0) return true;
    return false;
}

WeftResult u3m_package_add(U3mPackage *package, const char *path, const void *data, size_t size, bool own,
                           WeftError *error) {
    if (u3m_package_has(package, path)) return WEFT_OK;
    if (!u3m_path_inside(path))
        return fail(error, WEFT_MESSAGE_FILE_WRITE, package->path, "%.200s would leave its folder", path);
    if (size > bytes_most - package->bytes)
        return fail(error, WEFT_MESSAGE_FILE_WRITE, package->path, "its pictures have more than 1 GiB");
    PackedFile *grown = realloc_array(package->files, package->count + 1, sizeof *grown);
    if (grown) package->files = grown;
    PackedFile file = {.path = strdup(path), .data = alloc_array(size, 1), .size = size, .own = own};
    if (!grown || !file.path || !file.data) {
        free(file.path);
        free(file.data);
        return fail(error, WEFT_MESSAGE_MEMORY, package->path, NULL);
    }
    memcpy(file.data, data, size);
    package->files[package->count++] = file;
    package->bytes += size;
    return WEFT_OK;
}

static WeftResult write_bytes(const char *path, const void *data, size_t size, WeftError *error) {
    OutputFile file;
    WeftResult result = output_open(&file, path, error);
    if (result != WEFT_OK) return result;
    fwrite(data, 1, size, file.stream);
    return output_commit(&file, error);
}

/* Makes the folders on the way to a file that are not there, below the first `from` characters. */
static void folders_make(char *path, size_t from) {
    for (char *slash = path + from; (slash = strchr(slash, '/')); slash++) {
        *slash = '\0';
        mkdir(path, 0777); /* if it fails, writing the file fails too */
        *slash = '/';
    }
}

/* Writes a file unless it is there with the same bytes. */
static WeftResult write_beside(const PackedFile *file, char *path, size_t folder, WeftError *error) {
    struct stat status;
    if (stat(path, &status) == 0) {
        FileBytes there = {0};
        WeftResult result = file_read(path, bytes_most, &there, error);
        const bool same =
            result == WEFT_OK && there.size == file->size && memcmp(there.data, file->data, file->size) == 0;
        free(there.data);
        if (same) return WEFT_OK;
        if (!file->own)
            return fail(error, WEFT_MESSAGE_FILE_WRITE, path,
                        "another file of that name is there: save into another folder, or as .u3ma");
    }
    folders_make(path, folder);
    return write_bytes(path, file->data, file->size, error);
}

static WeftResult write_folder(const U3mPackage *package, const void *text, size_t size, WeftError *error) {
    const char *slash = strrchr(package->path, '/');
    const size_t folder = slash ? (size_t)(slash + 1 - package->path) : 0;
    WeftResult result = WEFT_OK;
    for (size_t k = 0; k < package->count && result == WEFT_OK; k++) {
        const PackedFile *file = &package->files[k];
        const size_t room = folder + strlen(file->path) + 1;
        char *path = malloc(room);
        if (!path) return fail(error, WEFT_MESSAGE_MEMORY, package->path, NULL);
        snprintf(path, room, "%.*s%s", (int)folder, package->path, file->path);
        result = write_beside(file, path, folder, error);
        free(path);
    }
    return result == WEFT_OK ? write_bytes(package->path, text, size, error) : result;
}

/* Gives the headers of a zip the values that a .u3ma demands: version 2.0 to extract, names in UTF-8. */
static void headers_restrict(unsigned char *zip, size_t size) {
    enum { CENTRAL = 46, LOCAL = 30, END = 22, NEEDED = 0x14, MADE_BY = 0x3f, UTF_8 = 0x08 };
    if (size < END) return;
    size_t at = (size_t)little_endian(zip + size - END + 16, 4),
           count = (size_t)little_endian(zip + size - END + 10, 2);
    for (size_t k = 0; k < count && at + CENTRAL <= size; k++) {
        const size_t local = (size_t)little_endian(zip + at + 42, 4);
        zip[at + 4] = MADE_BY;
        zip[at + 5] = 0;
        zip[at + 6] = NEEDED;
        zip[at + 9] |= UTF_8;
        memset(zip + at + 36, 0, 6); /* attributes */
        if (local + LOCAL <= size) {
            zip[local + 4] = NEEDED;
            zip[local + 7] |= UTF_8;
        }
        at += CENTRAL + (size_t)little_endian(zip + at + 28, 2) + (size_t)little_endian(zip + at + 30, 2) +
              (size_t)little_endian(zip + at + 32, 2);
    }
}

/* Adds a file whose bytes outlive the archive; no time is known of it. Pictures are compressed as they are. */
static bool zip_put(zip_t *zip, const char *path, const void *data, size_t size) {
    zip_source_t *source = zip_source_buffer(zip, data, size, 0);
    const zip_int64_t index = source ? zip_file_add(zip, path, source, ZIP_FL_ENC_UTF_8) : -1;
    if (index < 0) {
        if (source) zip_source_free(source);
        return false;
    }
    const bool packed = path_ends(path, ".png") || path_ends(path, ".jpg") || path_ends(path, ".jpeg");
    return zip_set_file_compression(zip, (zip_uint64_t)index, packed ? ZIP_CM_STORE : ZIP_CM_DEFLATE, 0) == 0 &&
           zip_file_set_dostime(zip, (zip_uint64_t)index, 0, 0x21, 0) == 0 &&
           zip_file_set_external_attributes(zip, (zip_uint64_t)index, 0, ZIP_OPSYS_DOS, 0) == 0;
}

/* Fills the zip in memory, and closes it. */
static bool zip_fill(zip_t *zip, const U3mPackage *package, const char *name, const void *text, size_t size) {
    bool done = zip_put(zip, name, text, size);
    for (size_t k = 0; k < package->count && done; k++)
        done = zip_put(zip, package->files[k].path, package->files[k].data, package->files[k].size);
    if (done && zip_close(zip) == 0) return true;
    zip_discard(zip);
    return false;
}

/* Copies the zip out of the memory of its source. */
static FileBytes zip_bytes(zip_source_t *source) {
    zip_stat_t stat;
    FileBytes bytes = {0};
    if (zip_source_stat(source, &stat) != 0 || zip_source_open(source) != 0) return bytes;
    bytes.data = malloc((size_t)stat.size + 1);
    if (bytes.data && zip_source_read(source, bytes.data, stat.size) == (zip_int64_t)stat.size)
        bytes.size = (size_t)stat.size;
    zip_source_close(source);
    return bytes;
}

/* Writes the name of the .u3m in an archive. */
static void name_inside(const char *path, char name[256]) {
    const char *slash = strrchr(path, '/'), *base = slash ? slash + 1 : path, *dot = strrchr(base, '.');
    snprintf(name, 256, "%.*s.u3m", dot ? (int)(dot - base) : (int)strlen(base), base);
    json_t *utf8 = json_string(name);
    if (!utf8 || !path_ends(name, ".u3m") || !u3m_path_inside(name)) snprintf(name, 256, "material.u3m");
    json_decref(utf8);
}

static WeftResult write_archive(const U3mPackage *package, const void *text, size_t size, WeftError *error) {
    char name[256];
    zip_error_t why;
    zip_error_init(&why);
    name_inside(package->path, name);
    FileBytes bytes = {0};
    zip_source_t *source = zip_source_buffer_create(NULL, 0, 0, &why);
    if (source) zip_source_keep(source);
    zip_t *zip = source ? zip_open_from_source(source, ZIP_TRUNCATE, &why) : NULL;
    if (zip && zip_fill(zip, package, name, text, size)) bytes = zip_bytes(source);
    if (source && !zip) zip_source_free(source); /* the zip would have freed it */
    if (source) zip_source_free(source);
    zip_error_fini(&why);
    WeftResult result = WEFT_OK;
    if (bytes.size) {
        headers_restrict(bytes.data, bytes.size);
        result = write_bytes(package->path, bytes.data, bytes.size, error);
    } else {
        result = fail(error, WEFT_MESSAGE_MEMORY, package->path, NULL);
    }
    free(bytes.data);
    return result;
}

WeftResult u3m_package_write(U3mPackage *package, const void *text, size_t size, WeftError *error) {
    return (path_ends(package->path, ".u3ma") ? write_archive : write_folder)(package, text, size, error);
}

void u3m_package_free(U3mPackage *package) {
    if (!package) return;
    for (size_t k = 0; k < package->count; k++) {
        free(package->files[k].path);
        free(package->files[k].data);
    }
    free(package->files);
    free(package);
}
