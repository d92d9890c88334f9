#define _XOPEN_SOURCE 700
#include "view/ui/browser.h"

#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>
#include <unistd.h>

#include "view/files/paths.h"
#include "view/ui/ui.h"

enum { PATH = 1024, NAME = 256, ENTRIES = 4096 };

typedef struct FolderEntry {
    char name[NAME];
    bool folder;
} FolderEntry;

struct Browser {
    char folder[PATH], typed[PATH], chosen[2 * PATH];
    FolderEntry *entries;
    int count;
    bool more;      /* there are more than are listed */
    unsigned kinds; /* kinds listed and chosen: bit k for PathKind k */
    bool everything;
    char failure[200];
};

static int by_name(const void *a, const void *b) {
    const FolderEntry *x = a, *y = b;
    if (x->folder != y->folder) return x->folder ? -1 : 1;
    return strcasecmp(x->name, y->name);
}

static bool is_folder(const Browser *self, const struct dirent *d) {
    char path[PATH + NAME + 2];
    struct stat s;
    snprintf(path, sizeof path, "%s/%s", self->folder, d->d_name);
    return stat(path, &s) == 0 && S_ISDIR(s.st_mode);
}

static bool fits(const Browser *self, const char *path) { return self->kinds >> path_kind(path) & 1; }

static void list(Browser *self) {
    DIR *dir = opendir(self->folder);
    self->count = 0;
    self->more = false;
    self->failure[0] = '\0';
    snprintf(self->typed, sizeof self->typed, "%s", self->folder);
    if (!dir) {
        snprintf(self->failure, sizeof self->failure, "cannot open this folder");
        return;
    }
    for (const struct dirent *d; (d = readdir(dir));) {
        if (d->d_name[0] == '.' || strlen(d->d_name) >= NAME) continue;
        bool folder = is_folder(self, d);
        if (!folder && !self->everything && !fits(self, d->d_name)) continue;
        if (self->count == ENTRIES) {
            self->more = true;
            break;
        }
        snprintf(self->entries[self->count].name, NAME, "%s", d->d_name);
        self->entries[self->count++].folder = folder;
    }
    closedir(dir);
    qsort(self->entries, (size_t)self->count, sizeof *self->entries, by_name);
}

static bool enter(Browser *self, const char *folder) {
    char real[4096];
    if (!realpath(folder, real) || strlen(real) >= PATH) return false;
    memcpy(self->folder, real, strlen(real) + 1);
    list(self);
    return true;
}

Browser *browser_create(const char *folder) {
    Browser *self = calloc(1, sizeof *self);
    if (self) self->entries = calloc(ENTRIES, sizeof *self->entries);
    if (!self || !self->entries) {
        free(self);
        return NULL;
    }
    if (!(folder && folder[0] && enter(self, folder)) && !enter(self, ".")) snprintf(self->folder, PATH, "/");
    return self;
}

void browser_free(Browser *self) {
    if (self) free(self->entries);
    free(self);
}

void browser_refresh(Browser *self) { list(self); }

const char *browser_folder(const Browser *self) { return self->folder; }

static const char *choose(Browser *self, const char *path) {
    struct stat s;
    bool there = stat(path, &s) == 0, catalogue = !there && strchr(path, ':'); /* builtin:, preset: */
    if (there && S_ISDIR(s.st_mode)) {
        if (!enter(self, path)) snprintf(self->failure, sizeof self->failure, "cannot open this folder");
        return NULL;
    }
    self->failure[0] = '\0';
    if (!there && !(catalogue && path_kind(path) != PATH_UNKNOWN))
        snprintf(self->failure, sizeof self->failure, "there is no such file");
    else if (!fits(self, path))
        snprintf(self->failure, sizeof self->failure, "this is no file of that kind, by its name");
    if (self->failure[0]) return NULL;
    snprintf(self->chosen, sizeof self->chosen, "%s", path);
    return self->chosen;
}

/* Chooses a typed path. It is relative to the current folder of the program, or else to the folder shown. */
static const char *choose_typed(Browser *self) {
    char path[2 * PATH];
    struct stat s;
    snprintf(path, sizeof path, "%s/%s", self->folder, self->typed);
    bool beside = self->typed[0] != '/' && stat(self->typed, &s) != 0 && stat(path, &s) == 0;
    if (!beside) snprintf(path, sizeof path, "%s", self->typed);
    return choose(self, path);
}

const char *browser_draw(Browser *self, unsigned kinds, float height) {
    const char *chosen = NULL;
    char path[PATH + NAME + 2];
    if (self->kinds != kinds) {
        self->kinds = kinds;
        list(self);
    }
    if (ui_button("Up")) {
        snprintf(path, sizeof path, "%s/..", self->folder);
        choose(self, path);
    }
    ui_tip("To the folder that this one is in.");
    ui_same_line();
    if (ui_button("Read again")) list(self);
    ui_tip("Looks at the disk again.");
    ui_same_line();
    if (ui_checkbox("All files", &self->everything)) list(self);
    ui_tip("Lists what cannot be opened, too.");
    if (ui_input("##path", self->typed, PATH)) chosen = choose_typed(self);
    ui_tip("A path to type: Enter opens it.");
    if (self->failure[0]) ui_warning(self->failure);
    if (ui_list("files", height - 3.2f * ui_line_height())) {
        for (int k = 0; k < self->count && !chosen; k++) {
            const FolderEntry *entry = &self->entries[k];
            char label[NAME + 4];
            snprintf(label, sizeof label, "%s%s", entry->name, entry->folder ? "/" : "");
            if (!ui_selectable(label, false)) continue;
            snprintf(path, sizeof path, "%s/%s", strcmp(self->folder, "/") == 0 ? "" : self->folder, entry->name);
            chosen = choose(self, path);
            break; /* the list may have changed */
        }
        if (self->more) ui_dim("... and more, which are not listed");
        if (!self->count && !self->failure[0]) ui_dim("nothing here that can be opened");
    }
    ui_list_end();
    return chosen;
}
