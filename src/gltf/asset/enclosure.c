#define _XOPEN_SOURCE 700 /* realpath */
#include "gltf/asset/enclosure.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "base/fail.h"
#include "weft/root.h"

static char *root; /* with links followed; NULL: none */

WeftResult weft_root_use(const char *folder, WeftError *error) {
    struct stat status;
    char *path = folder ? realpath(folder, NULL) : NULL;
    if (folder && !path)
        return fail(error, errno == ENOMEM ? WEFT_MESSAGE_MEMORY : WEFT_MESSAGE_FILE_OPEN, folder, "%s",
                    strerror(errno));
    if (folder && (stat(path, &status) != 0 || !S_ISDIR(status.st_mode))) {
        free(path);
        return fail(error, WEFT_MESSAGE_FILE_OPEN, folder, "it is not a folder");
    }
    free(root);
    root = path;
    return WEFT_OK;
}

/* Returns how far a relative path leads out of the folder that it starts in, in folders. */
static int depth_out(const char *path) {
    int depth = 0, least = 0;
    while (*path) {
        size_t step = strcspn(path, "/");
        if (step == 2 && path[0] == '.' && path[1] == '.')
            depth--;
        else if (step && !(step == 1 && path[0] == '.'))
            depth++;
        if (depth < least) least = depth;
        path += step;
        if (*path) path++;
    }
    return -least;
}

bool leaves_folder(const char *path) { return depth_out(path) > 0; }

/* Returns true if a path with links followed is in the folder; NULL is nowhere. */
static bool lies_in(const char *path, const char *folder) {
    size_t length = folder ? strlen(folder) : 0;
    if (length == 0 || strncmp(path, folder, length) != 0) return false;
    return folder[length - 1] == '/' || path[length] == '/';
}

/* Writes the folder that has what is outside: above the asset's for a name that leaves it, else that of the link's
 * target. */
static void outside_write(const char *path, size_t folder, const char *real, char *out, size_t size) {
    int depth = depth_out(path + folder);
    if (depth == 0) {
        const char *slash = real ? strrchr(real, '/') : NULL;
        snprintf(out, size, "%.*s", slash && slash > real ? (int)(slash - real) : 1, real ? real : "/");
        return;
    }
    snprintf(out, size, "%.*s", (int)folder, path);
    for (size_t used = strlen(out); depth > 0; depth--, used = strlen(out))
        snprintf(out + used, size - used, "%s%s", used && out[used - 1] != '/' ? "/" : "", "..");
}

bool is_enclosed(const char *path, size_t folder, char *out, size_t size) {
    const bool leaves = leaves_folder(path + folder);
    char *real = realpath(path, NULL), *own = NULL;
    if (folder) {
        char *name = strndup(path, folder);
        own = name ? realpath(name, NULL) : NULL;
        free(name);
    } else {
        own = realpath(".", NULL);
    }
    const bool enclosed = real ? (!leaves && lies_in(real, own)) || lies_in(real, root) : !leaves || root != NULL;
    if (!enclosed) outside_write(path, folder, real, out, size);
    free(real);
    free(own);
    return enclosed;
}
