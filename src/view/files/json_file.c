#define _POSIX_C_SOURCE 200809L
#include "view/files/json_file.h"

#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* Creates a folder and those that it is in. */
static void make_folders(const char *path) {
    char part[4096];
    if (strlen(path) >= sizeof part) return;
    for (const char *slash = strchr(path + 1, '/'); slash; slash = strchr(slash + 1, '/')) {
        snprintf(part, sizeof part, "%.*s", (int)(slash - path), path);
        mkdir(part, 0755);
    }
}

bool json_file_place(const char *variable, const char *fallback, const char *name, bool make, char *path, size_t size) {
    const char *folder = getenv(variable), *home = getenv("HOME");
    const int used = folder && folder[0] == '/' ? snprintf(path, size, "%s/weft/%s", folder, name)
                     : home                     ? snprintf(path, size, "%s/%s/weft/%s", home, fallback, name)
                                                : -1;
    if (used < 0 || (size_t)used >= size) return false;
    if (make) make_folders(path);
    return true;
}

/* Reading a pipe would block, so it opens regular files alone. */
json_t *json_file_read(const char *path, long most) {
    struct stat s;
    int file = open(path, O_RDONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC);
    bool regular = file >= 0 && fstat(file, &s) == 0 && S_ISREG(s.st_mode) && s.st_size <= most;
    json_t *root = regular ? json_loadfd(file, 0, NULL) : NULL;
    if (file >= 0) close(file);
    return root;
}

/* Writes a new file; a file with that name is removed, not opened. */
static bool write_new(const char *path, const json_t *root) {
    unlink(path);
    int file = open(path, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    bool good = file >= 0 && json_dumpfd(root, file, JSON_INDENT(2)) == 0;
    return file >= 0 && close(file) == 0 && good;
}

bool json_file_write(const char *path, const json_t *root) {
    char part[4096];
    const int used = snprintf(part, sizeof part, "%s.part", path);
    if (used < 0 || (size_t)used >= sizeof part) return false;
    bool good = write_new(part, root) && rename(part, path) == 0;
    if (!good) unlink(part);
    return good;
}
