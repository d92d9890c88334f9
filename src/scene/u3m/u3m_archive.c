#include "scene/u3m/u3m_archive.h"

#include <stdlib.h>
#include <string.h>
#include <zip.h>

#include "base/fail.h"
#include "base/memory.h"
#include "base/path.h"

enum { FILES_MOST = 4096, DEFLATE_MOST = 1032 }; /* deflate: 258 bytes of 2 bits each */
static const zip_uint64_t bytes_most = (zip_uint64_t)1 << 30;

struct U3mArchive {
    zip_t *zip;
    const char *name; /* borrowed: subject of errors */
    char *material;
};

bool u3m_path_inside(const char *path) {
    if (!path[0] || strlen(path) > 4096) return false;
    for (const char *part = path; part; part = strchr(part, '/') ? strchr(part, '/') + 1 : NULL) {
        const size_t length = strcspn(part, "/");
        if (length == 0 || length > 255 || (length <= 2 && strspn(part, ".") >= length)) return false;
        if (length == 1 && part[0] == '~') return false;
    }
    for (const char *p = path; *p; p++)
        if ((unsigned char)*p < 0x20 || strchr("<>:\"\\|", *p)) return false;
    return true;
}

/* Returns what is wrong with a file of the archive, or NULL. */
static const char *fault_of(const zip_stat_t *stat) {
    const zip_uint64_t needed = ZIP_STAT_NAME | ZIP_STAT_SIZE | ZIP_STAT_COMP_SIZE | ZIP_STAT_COMP_METHOD;
    if ((stat->valid & needed) != needed) return "has no name or size";
    if (stat->valid & ZIP_STAT_ENCRYPTION_METHOD && stat->encryption_method != ZIP_EM_NONE) return "is encrypted";
    if (stat->comp_method != ZIP_CM_STORE && stat->comp_method != ZIP_CM_DEFLATE)
        return "is compressed by another method than deflate";
    if (stat->size > bytes_most || stat->size > DEFLATE_MOST * (stat->comp_size + 1)) return "is too large";
    return NULL;
}

/* Checks a file of the archive, and notes its path if it is the material. */
static WeftResult check_file(U3mArchive *archive, zip_uint64_t index, WeftError *error) {
    zip_stat_t stat;
    if (zip_stat_index(archive->zip, index, 0, &stat) != 0 || !stat.name)
        return fail(error, WEFT_MESSAGE_MATERIAL_FILE, archive->name, "file %d of the archive has no name", (int)index);
    const char *fault = fault_of(&stat);
    const size_t length = strlen(stat.name);
    char *path = strdup(stat.name);
    if (!path) return fail(error, WEFT_MESSAGE_MEMORY, archive->name, NULL);
    if (length && path[length - 1] == '/') path[length - 1] = '\0'; /* a folder */
    if (!u3m_path_inside(path)) fault = "would lie outside the archive's folder, or has a name that is not allowed";
    const bool material = path_ends(path, ".u3m");
    if (!fault && material && archive->material) fault = "is a second .u3m";
    if (fault) {
        fail(error, WEFT_MESSAGE_MATERIAL_FILE, archive->name, "in the archive %.120s %s", stat.name, fault);
        free(path);
        return WEFT_INPUT;
    }
    if (material)
        archive->material = path;
    else
        free(path);
    return WEFT_OK;
}

static WeftResult check_all(U3mArchive *archive, WeftError *error) {
    const zip_int64_t count = zip_get_num_entries(archive->zip, 0);
    WeftResult result = WEFT_OK;
    if (count > FILES_MOST)
        return fail(error, WEFT_MESSAGE_MATERIAL_FILE, archive->name, "more than %d files", FILES_MOST);
    for (zip_int64_t k = 0; k < count && result == WEFT_OK; k++) result = check_file(archive, (zip_uint64_t)k, error);
    if (result == WEFT_OK && !archive->material)
        return fail(error, WEFT_MESSAGE_MATERIAL_FILE, archive->name, "the archive has no .u3m");
    return result;
}

/* Opens the zip without its files. Fails with WEFT_MESSAGE_MATERIAL_FILE. */
static WeftResult open_zip(const void *data, size_t size, U3mArchive *archive, WeftError *error) {
    zip_error_t why;
    zip_error_init(&why);
    zip_source_t *source = zip_source_buffer_create(data, size, 0, &why);
    archive->zip = source ? zip_open_from_source(source, ZIP_RDONLY | ZIP_CHECKCONS, &why) : NULL;
    WeftResult result = WEFT_OK;
    if (!archive->zip) {
        const bool starved = zip_error_code_zip(&why) == ZIP_ER_MEMORY;
        result = starved ? fail(error, WEFT_MESSAGE_MEMORY, archive->name, NULL)
                         : fail(error, WEFT_MESSAGE_MATERIAL_FILE, archive->name, "the archive: %s",
                                zip_error_strerror(&why));
        if (source) zip_source_free(source);
    }
    zip_error_fini(&why);
    return result;
}

WeftResult u3m_archive_open(const void *data, size_t size, const char *name, U3mArchive **out, WeftError *error) {
    U3mArchive *archive = *out = alloc_array(1, sizeof *archive);
    if (!archive) return fail(error, WEFT_MESSAGE_MEMORY, name, NULL);
    archive->name = name;
    WeftResult result = open_zip(data, size, archive, error);
    if (result == WEFT_OK) result = check_all(archive, error);
    if (result == WEFT_OK) return WEFT_OK;
    u3m_archive_close(archive);
    *out = NULL;
    return result;
}

const char *u3m_archive_material(const U3mArchive *archive) { return archive->material; }

WeftResult u3m_archive_read(U3mArchive *archive, const char *path, FileBytes *out, WeftError *error) {
    zip_stat_t stat;
    *out = (FileBytes){0};
    zip_file_t *file =
        zip_stat(archive->zip, path, 0, &stat) == 0 ? zip_fopen_index(archive->zip, stat.index, 0) : NULL;
    if (!file) return fail(error, WEFT_MESSAGE_MATERIAL_FILE, archive->name, "the archive has no %.200s", path);
    out->data = malloc((size_t)stat.size + 1); /* at most bytes_most, as was checked */
    const zip_int64_t got = out->data ? zip_fread(file, out->data, stat.size + 1) : 0;
    const bool whole = zip_fclose(file) == 0 && got >= 0 && (zip_uint64_t)got == stat.size;
    if (out->data && whole) {
        out->size = (size_t)stat.size;
        out->data[out->size] = 0;
        return WEFT_OK;
    }
    const bool starved = !out->data;
    free(out->data);
    *out = (FileBytes){0};
    return starved ? fail(error, WEFT_MESSAGE_MEMORY, archive->name, NULL)
                   : fail(error, WEFT_MESSAGE_MATERIAL_FILE, archive->name, "in the archive %.200s is damaged", path);
}

const char *u3m_archive_file(const U3mArchive *archive, int k) {
    return k < 0 ? NULL : zip_get_name(archive->zip, (zip_uint64_t)k, 0);
}

void u3m_archive_close(U3mArchive *archive) {
    if (!archive) return;
    if (archive->zip) zip_discard(archive->zip);
    free(archive->material);
    free(archive);
}
