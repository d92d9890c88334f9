#define _XOPEN_SOURCE 700 /* realpath */
#include "cli/console/output.h"

#include <errno.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/stream_reason.h"
#include "cli/console/report.h"

static int report_unwritten(const char *path, const char *reason) {
    return report(WEFT_RESOURCES, "%s: %s: %s", path, weft_message_text(WEFT_MESSAGE_FILE_WRITE), reason);
}

/* Returns the file that writing to path would replace, with links resolved so that they stay. Release with free; NULL
 * after one line. */
static char *find_target(const char *path) {
    struct stat status;
    bool there = stat(path, &status) == 0;
    const char *wrong = NULL;
    if (there && !S_ISREG(status.st_mode)) wrong = "is not a plain file";
    if (!there && lstat(path, &status) == 0) wrong = "is a link that leads nowhere";
    if (wrong) {
        report(WEFT_RESOURCES, "%s: %s", path, wrong);
        return NULL;
    }
    char *target = there ? realpath(path, NULL) : strdup(path);
    if (!target) report_unwritten(path, strerror(errno));
    return target;
}

static void forget(Output *output) {
    free(output->target);
    free(output->temporary);
    *output = (Output){0};
}

int output_begin(Output *output, const char *path) {
    *output = (Output){.path = path};
    output->target = find_target(path);
    if (!output->target) return WEFT_RESOURCES;
    size_t size = strlen(output->target) + sizeof ".XXXXXX";
    output->temporary = malloc(size);
    if (!output->temporary) {
        forget(output);
        return report_unwritten(path, strerror(ENOMEM));
    }
    snprintf(output->temporary, size, "%s.XXXXXX", output->target);
    int handle = mkstemp(output->temporary);
    if (handle >= 0) {
        mode_t mask = umask(0);
        umask(mask);
        fchmod(handle, 0666 & ~mask);
        output->stream = fdopen(handle, "w");
    }
    if (output->stream) return 0;
    report_unwritten(path, strerror(errno));
    if (handle >= 0) {
        close(handle);
        unlink(output->temporary);
    }
    forget(output);
    return WEFT_RESOURCES;
}

int output_end(Output *output) {
    const char *earlier = ferror(output->stream) ? stream_reason(output->stream) : NULL;
    int result = 0;
    bool closed = fclose(output->stream) == 0;
    if (earlier || !closed || rename(output->temporary, output->target) != 0) {
        result = report_unwritten(output->path, earlier ? earlier : strerror(errno));
        unlink(output->temporary);
    }
    forget(output);
    return result;
}

void output_drop(Output *output) {
    if (output->stream) fclose(output->stream);
    if (output->temporary) unlink(output->temporary);
    forget(output);
}

int output_probe(const char *path) {
    Output output;
    int result = output_begin(&output, path);
    if (result == 0) output_drop(&output);
    return result;
}

static bool same_file(const struct stat *there, const char *name) {
    struct stat status;
    return stat(name, &status) == 0 && status.st_dev == there->st_dev && status.st_ino == there->st_ino;
}

/* Returns true if the file is named by the whole operand or by a part that ends at a colon, as in "chair.glb:fabric". */
static bool names_file(const struct stat *there, const char *operand) {
    char *name = strdup(operand);
    bool same = name && same_file(there, name);
    for (char *colon = name ? strrchr(name, ':') : NULL; colon && !same; colon = strrchr(name, ':')) {
        *colon = '\0';
        same = same_file(there, name);
    }
    free(name);
    return same;
}

int output_probe_other(const Options *options, const char *path) {
    struct stat there;
    bool exists = stat(path, &there) == 0;
    for (int k = 0; exists && k < options->operand_count; k++)
        if (names_file(&there, options->operands[k]))
            return report(WEFT_USAGE, "%s: is what is read: it would be lost", path);
    return output_probe(path);
}
