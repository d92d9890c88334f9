#define _XOPEN_SOURCE 700 /* realpath */
#include "base/file.h"

#include <errno.h>
#include <fcntl.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#include "base/fail.h"
#include "base/memory.h"
#include "base/random.h"
#include "base/stream_reason.h"

/* Opens a regular file. A pipe would make the open wait for a writer and a device might never end, so both are
 * refused without waiting: the names come from assets and caches that anybody may have written. */
static WeftResult open_regular(const char *path, int *handle, struct stat *status, WeftError *error) {
    *handle = open(path, O_RDONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC);
    if (*handle < 0 || fstat(*handle, status) != 0) {
        WeftResult result = fail(error, WEFT_MESSAGE_FILE_OPEN, path, "%s", strerror(errno));
        if (*handle >= 0) close(*handle);
        return result;
    }
    if (S_ISREG(status->st_mode)) return WEFT_OK;
    close(*handle);
    return fail(error, WEFT_MESSAGE_FILE_READ, path,
                S_ISDIR(status->st_mode) ? "it is a folder" : "it is not a plain file");
}

/* Reads until the end of a file, or one byte more than limit. `expected` is only the first capacity, since the size
 * of a file is no promise: files of /proc report 0. */
static WeftResult read_handle(int handle, size_t expected, size_t limit, FileBytes *out, const char *path,
                              WeftError *error) {
    size_t size = 0, capacity = expected <= limit ? expected + 1 : limit + 1;
    unsigned char *data = alloc_array(capacity + 1, 1);
    while (data && size <= limit) {
        if (size == capacity) {
            unsigned char *grown = realloc_array(data, capacity * 2 + 1, 1);
            if (!grown) free(data);
            data = grown;
            capacity *= 2;
            continue;
        }
        ssize_t got = read(handle, data + size, capacity - size);
        if (got < 0 && errno == EINTR) continue;
        if (got < 0) {
            free(data);
            return fail(error, WEFT_MESSAGE_FILE_READ, path, "%s", strerror(errno));
        }
        if (got == 0) break;
        size += (size_t)got;
    }
    if (!data) return fail(error, WEFT_MESSAGE_MEMORY, path, NULL);
    *out = (FileBytes){data, size};
    return WEFT_OK;
}

/* Reads up to limit bytes. Bytes beyond are dropped with `cut`, else an error. */
static WeftResult read_limited(const char *path, size_t limit, bool cut, FileBytes *out, WeftError *error) {
    struct stat status = {0};
    int handle = -1;
    *out = (FileBytes){0};
    WeftResult result = open_regular(path, &handle, &status, error);
    if (result != WEFT_OK) return result;
    size_t expected = status.st_size > 0 ? (size_t)status.st_size : 1 << 16;
    bool large = !cut && status.st_size > 0 && expected > limit; /* found without reading */
    if (!large) result = read_handle(handle, expected, limit, out, path, error);
    close(handle);
    if (result != WEFT_OK) return result;
    large |= !cut && out->size > limit;
    if (large) {
        free(out->data);
        *out = (FileBytes){0};
        return fail(error, WEFT_MESSAGE_FILE_LARGE, path, "the limit is %zu bytes", limit);
    }
    if (out->size > limit) out->size = limit;
    out->data[out->size] = 0;
    return WEFT_OK;
}

WeftResult file_read(const char *path, size_t limit, FileBytes *out, WeftError *error) {
    return read_limited(path, limit, false, out, error);
}

WeftResult file_read_start(const char *path, size_t most, FileBytes *out, WeftError *error) {
    return read_limited(path, most, true, out, error);
}

/* Creates a new file, named path with a random suffix, with the permissions that the umask leaves. Returns its
 * handle, or -1 with errno if none can be made. */
static int create_beside(const char *path, char *name, size_t size) {
    int handle = -1;
    for (uint32_t attempt = 0; attempt < 1000; attempt++) {
        struct timespec now;
        clock_gettime(CLOCK_REALTIME, &now);
        uint32_t salt = hash_combine(hash_combine((uint32_t)getpid(), (uint32_t)now.tv_nsec), attempt);
        snprintf(name, size, "%s.%06x", path, (unsigned)(salt & 0xffffff));
        handle = open(name, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
        if (handle >= 0 || errno != EEXIST) break;
    }
    return handle;
}

/* Finds the file that writing to path replaces: behind its links, so that they stay. Only a regular file may be
 * replaced. */
static WeftResult find_target(const char *path, char **target, WeftError *error) {
    struct stat status;
    *target = NULL;
    if (!path[0]) return fail(error, WEFT_MESSAGE_FILE_WRITE, path, "it has no name");
    bool there = stat(path, &status) == 0;
    if (there && !S_ISREG(status.st_mode)) return fail(error, WEFT_MESSAGE_FILE_WRITE, path, "it is not a plain file");
    if (!there && lstat(path, &status) == 0)
        return fail(error, WEFT_MESSAGE_FILE_WRITE, path, "it is a link that leads nowhere");
    *target = there ? realpath(path, NULL) : strdup(path);
    return *target ? WEFT_OK : fail(error, WEFT_MESSAGE_FILE_WRITE, path, "%s", strerror(errno));
}

WeftResult output_open(OutputFile *file, const char *path, WeftError *error) {
    *file = (OutputFile){.path = path};
    WeftResult found = find_target(path, &file->target, error);
    if (!file->target) return found;
    size_t size = strlen(file->target) + sizeof ".123456";
    file->temporary = alloc_array(size, 1);
    if (!file->temporary) {
        free(file->target);
        *file = (OutputFile){0};
        return fail(error, WEFT_MESSAGE_MEMORY, path, NULL);
    }
    int handle = create_beside(file->target, file->temporary, size);
    if (handle >= 0) {
        file->stream = fdopen(handle, "wb");
        if (!file->stream) close(handle);
    }
    if (!file->stream) {
        WeftResult result = fail(error, WEFT_MESSAGE_FILE_WRITE, path, "%s", strerror(errno));
        if (handle >= 0) unlink(file->temporary);
        free(file->temporary);
        free(file->target);
        *file = (OutputFile){0};
        return result;
    }
    return WEFT_OK;
}

WeftResult output_commit(OutputFile *file, WeftError *error) {
    int failed = ferror(file->stream) != 0;
    const char *earlier = failed ? stream_reason(file->stream) : NULL;
    failed = failed || fflush(file->stream) != 0 || fsync(fileno(file->stream)) != 0;
    int reason = errno;
    if (fclose(file->stream) != 0 && !failed) {
        failed = 1;
        reason = errno;
    }
    if (!failed && rename(file->temporary, file->target) != 0) {
        failed = 1;
        reason = errno;
    }
    WeftResult result = WEFT_OK;
    if (failed) {
        result = fail(error, WEFT_MESSAGE_FILE_WRITE, file->path, "%s", earlier ? earlier : strerror(reason));
        unlink(file->temporary);
    }
    free(file->temporary);
    free(file->target);
    *file = (OutputFile){0};
    return result;
}

void output_discard(OutputFile *file) {
    if (!file->stream) return;
    fclose(file->stream);
    unlink(file->temporary);
    free(file->temporary);
    free(file->target);
    *file = (OutputFile){0};
}
