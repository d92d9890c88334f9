/* stream_reason.h - why a stream cannot be written; includes nothing of weft, so that programs may include it */
#pragma once

#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

/* Returns the reason why a stream with its error flag set takes no more, as strerror words it. A stream does not keep
 * the reason of a write that failed earlier, so zeros are written behind the end of its file until that fails again:
 * the file is for nothing but to be removed. A stream without a file is one in memory. */
static inline const char *stream_reason(FILE *stream) {
    enum { TRIES = 64 };
    static const char zeros[4096];
    int handle = fileno(stream);
    if (handle < 0) return strerror(ENOMEM);
    errno = 0;
    if (lseek(handle, 0, SEEK_END) >= 0)
        for (int k = 0; k < TRIES && write(handle, zeros, sizeof zeros) >= 0; k++) {
        }
    return strerror(errno ? errno : EIO);
}
