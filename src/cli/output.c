#include "output.h"

#include <errno.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "report.h"

static int failure(const char *path) {
    return report(WEFT_RESOURCES, "%s: %s: %s", path, weft_message_text(WEFT_MESSAGE_FILE_WRITE),
                  strerror(errno));
}

int output_begin(Output *output, const char *path) {
    *output = (Output){.path = path};
    if (snprintf(output->temporary, sizeof output->temporary, "%s.XXXXXX", path) >=
        (int)sizeof output->temporary) {
        errno = ENAMETOOLONG;
        return failure(path);
    }
    int handle = mkstemp(output->temporary);
    if (handle < 0) return failure(path);
    mode_t mask = umask(0);
    umask(mask);
    fchmod(handle, 0666 & ~mask);
    output->stream = fdopen(handle, "w");
    if (output->stream) return 0;
    close(handle);
    unlink(output->temporary);
    return failure(path);
}

int output_end(Output *output) {
    errno = 0;
    bool written = !ferror(output->stream);
    written = fclose(output->stream) == 0 && written;
    if (written && rename(output->temporary, output->path) == 0) return 0;
    int result = failure(output->path);
    unlink(output->temporary);
    return result;
}

void output_drop(Output *output) {
    fclose(output->stream);
    unlink(output->temporary);
}
