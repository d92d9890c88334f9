#define _XOPEN_SOURCE 700 /* realpath */
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

/* The file that writing to path would replace: behind its links, so that they stay. */
static int find_target(const char *path, char **target) {
    struct stat status;
    bool there = stat(path, &status) == 0;
    if (there && !S_ISREG(status.st_mode)) return report(WEFT_RESOURCES, "%s: is not a plain file", path);
    if (!there && lstat(path, &status) == 0)
        return report(WEFT_RESOURCES, "%s: is a link that leads nowhere", path);
    *target = there ? realpath(path, NULL) : strdup(path);
    return *target ? 0 : failure(path);
}

static void forget(Output *output) {
    free(output->target);
    free(output->temporary);
    *output = (Output){0};
}

int output_begin(Output *output, const char *path) {
    *output = (Output){.path = path};
    int result = find_target(path, &output->target);
    if (result != 0) return result;
    size_t size = strlen(output->target) + sizeof ".XXXXXX";
    output->temporary = malloc(size);
    if (output->temporary) snprintf(output->temporary, size, "%s.XXXXXX", output->target);
    int handle = output->temporary ? mkstemp(output->temporary) : -1;
    if (handle >= 0) {
        mode_t mask = umask(0);
        umask(mask);
        fchmod(handle, 0666 & ~mask);
        output->stream = fdopen(handle, "w");
    }
    if (output->stream) return 0;
    result = failure(path);
    if (handle >= 0) {
        close(handle);
        unlink(output->temporary);
    }
    forget(output);
    return result;
}

int output_end(Output *output) {
    errno = 0;
    bool written = !ferror(output->stream);
    int result = 0;
    written = fclose(output->stream) == 0 && written;
    if (!written || rename(output->temporary, output->target) != 0) {
        result = failure(output->path);
        unlink(output->temporary);
    }
    forget(output);
    return result;
}

void output_drop(Output *output) {
    fclose(output->stream);
    unlink(output->temporary);
    forget(output);
}

int output_probe(const char *path) {
    Output output;
    int result = output_begin(&output, path);
    if (result == 0) output_drop(&output);
    return result;
}
