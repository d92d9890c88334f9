#define _XOPEN_SOURCE 700
#include "view/files/places.h"

#include <mntent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "base/path.h"
#include "view/files/paths.h"

/* Adds a folder by its path, by the name or else by its own. */
static void add_real(FilePlaces *self, const char *path, const char *name) {
    if (self->count == PLACES_MOST || strlen(path) >= PLACE_PATH) return;
    for (int k = 0; k < self->count; k++)
        if (strcmp(self->places[k].path, path) == 0) return;
    FilePlace *place = &self->places[self->count++];
    snprintf(place->path, sizeof place->path, "%s", path);
    snprintf(place->name, sizeof place->name, "%.63s", name && name[0] ? name : path_name(path));
}

/* Adds a folder if it is there. */
static void add(FilePlaces *self, const char *path, const char *name) {
    char real[4096];
    struct stat s;
    if (stat(path, &s) == 0 && S_ISDIR(s.st_mode) && realpath(path, real)) add_real(self, real, name);
}

static void add_folder_of(FilePlaces *self, const char *path, const char *name) {
    char folder[PLACE_PATH];
    const char *slash = strrchr(path, '/');
    if (path_builtin(path) || strlen(path) >= sizeof folder) return;
    snprintf(folder, sizeof folder, "%.*s", slash ? (int)(slash - path) + 1 : 1, slash ? path : ".");
    add(self, folder, name);
}

static int hex_of(char c) {
    return c >= '0' && c <= '9'   ? c - '0'
           : c >= 'a' && c <= 'f' ? c - 'a' + 10
           : c >= 'A' && c <= 'F' ? c - 'A' + 10
                                  : -1;
}

/* Decodes %XX in place, RFC 3986, section 2.1. */
static void decode(char *text) {
    char *to = text;
    for (; *text; text++) {
        const int high = *text == '%' ? hex_of(text[1]) : -1, low = high >= 0 ? hex_of(text[2]) : -1;
        const bool coded = low >= 0 && 16 * high + low != 0;
        *to++ = coded ? (char)(16 * high + low) : *text;
        if (coded) text += 2;
    }
    *to = '\0';
}

void places_read_bookmarks(FilePlaces *self, const char *path) {
    char line[4096];
    FILE *file = fopen(path, "r");
    while (file && fgets(line, sizeof line, file)) {
        line[strcspn(line, "\r\n")] = '\0';
        char *name = strchr(line, ' ');
        if (name) *name++ = '\0';
        if (strncmp(line, "file:///", 8) != 0) continue;
        decode(line);
        add(self, line + 7, name);
    }
    if (file) fclose(file);
}

/* Adds what is mounted where desktops mount drives and shares of a user, without a look at it: a share whose computer is
 * gone would keep the window waiting. */
static void read_volumes(FilePlaces *self) {
    static const char *const roots[] = {"/media/", "/run/media/", "/mnt/", "/Volumes/"};
    FILE *file = setmntent("/proc/self/mounts", "r");
    for (const struct mntent *m; file && (m = getmntent(file));)
        for (size_t k = 0; k < sizeof roots / sizeof *roots; k++)
            if (strncmp(m->mnt_dir, roots[k], strlen(roots[k])) == 0) add_real(self, m->mnt_dir, NULL);
    if (file) endmntent(file);
}

void places_read(FilePlaces *self, const char *scene, const Settings *settings) {
    char path[PLACE_PATH];
    const char *home = getenv("HOME"), *config = getenv("XDG_CONFIG_HOME");
    self->count = 0;
    if (home) add(self, home, "Home");
    if (scene) add_folder_of(self, scene, "Of the scene");
    add(self, ".", "Current folder");
    for (int k = 0; k < settings->recent_count; k++) add_folder_of(self, settings->recent[k], NULL);
    int used = config && config[0] == '/'
                   ? snprintf(path, sizeof path, "%s/gtk-3.0/bookmarks", config)
                   : snprintf(path, sizeof path, "%s/.config/gtk-3.0/bookmarks", home ? home : "");
    if (used > 0 && (size_t)used < sizeof path) places_read_bookmarks(self, path);
    read_volumes(self);
}
