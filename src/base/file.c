#include "base/file.h"

#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/fail.h"
#include "base/memory.h"

WeftResult file_read(const char *path, size_t limit, FileBytes *out, WeftError *error) {
    *out = (FileBytes){0};
    FILE *stream = fopen(path, "rb");
    if (!stream) return fail(error, WEFT_MESSAGE_FILE_OPEN, path, "%s", strerror(errno));
    struct stat status;
    size_t expected = 1 << 16;
    if (fstat(fileno(stream), &status) == 0 && S_ISDIR(status.st_mode)) {
        fclose(stream);
        return fail(error, WEFT_MESSAGE_FILE_READ, path, "it is a folder");
    }
    if (S_ISREG(status.st_mode) && status.st_size >= 0) expected = (size_t)status.st_size + 1;
    if (expected > limit) expected = limit + 1;

    WeftResult result = WEFT_OK;
    unsigned char *data = NULL;
    size_t size = 0, room = 0;
    for (;;) {
        if (size == room) {
            size_t wanted = room ? room * 2 : expected;
            unsigned char *grown = realloc_array(data, wanted + 1, 1);
            if (!grown) {
                result = fail(error, WEFT_MESSAGE_MEMORY, path, NULL);
                break;
            }
            data = grown;
            room = wanted;
        }
        size_t got = fread(data + size, 1, room - size, stream);
        size += got;
        if (size > limit) {
            result = fail(error, WEFT_MESSAGE_FILE_LARGE, path, "the limit is %zu bytes", limit);
            break;
        }
        if (got == 0) {
            if (ferror(stream)) result = fail(error, WEFT_MESSAGE_FILE_READ, path, "%s", strerror(errno));
            break;
        }
    }
    fclose(stream);
    if (result != WEFT_OK) {
        free(data);
        return result;
    }
    data[size] = 0;
    *out = (FileBytes){data, size};
    return WEFT_OK;
}

WeftResult output_open(OutputFile *file, const char *path, WeftError *error) {
    *file = (OutputFile){.path = path};
    size_t size = strlen(path) + 32;
    file->temporary = alloc_array(size, 1);
    if (!file->temporary) return fail(error, WEFT_MESSAGE_MEMORY, path, NULL);
    snprintf(file->temporary, size, "%s.%ld.XXXXXX", path, (long)getpid());
    int handle = mkstemp(file->temporary);
    if (handle >= 0) {
        mode_t mask = umask(0);
        umask(mask);
        fchmod(handle, 0666 & ~mask);
        file->stream = fdopen(handle, "wb");
        if (!file->stream) close(handle);
    }
    if (!file->stream) {
        WeftResult result = fail(error, WEFT_MESSAGE_FILE_WRITE, path, "%s", strerror(errno));
        if (handle >= 0) unlink(file->temporary);
        free(file->temporary);
        *file = (OutputFile){0};
        return result;
    }
    return WEFT_OK;
}

WeftResult output_commit(OutputFile *file, WeftError *error) {
    int failed = fflush(file->stream) != 0 || fsync(fileno(file->stream)) != 0;
    int reason = errno;
    if (fclose(file->stream) != 0 && !failed) {
        failed = 1;
        reason = errno;
    }
    if (!failed && rename(file->temporary, file->path) != 0) {
        failed = 1;
        reason = errno;
    }
    WeftResult result = WEFT_OK;
    if (failed) {
        result = fail(error, WEFT_MESSAGE_FILE_WRITE, file->path, "%s", strerror(reason));
        unlink(file->temporary);
    }
    free(file->temporary);
    *file = (OutputFile){0};
    return result;
}

void output_discard(OutputFile *file) {
    if (!file->stream) return;
    fclose(file->stream);
    unlink(file->temporary);
    free(file->temporary);
    *file = (OutputFile){0};
}
