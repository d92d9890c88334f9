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
    char folder[PATH], typed[PATH], words[NAME], chosen[2 * PATH];
    FolderEntry *entries;
    const FilePlaces *places; /* NULL: none */
    int count;
    int row;        /* the entry that is chosen; -1: none */
    bool moved;     /* to a row that may be out of sight */
    bool types;     /* the path that is typed is to be opened, rather than the row */
    bool focus;     /* the words take the keyboard in the next frame */
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
    self->row = -1;
    self->more = self->types = false;
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
    self->focus = true;
    self->words[0] = '\0';
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

void browser_refresh(Browser *self, const FilePlaces *places) {
    self->places = places;
    self->words[0] = '\0';
    list(self);
}

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

/* Returns true if the name contains the words that are searched for, in any case. */
static bool found(const Browser *self, int k) {
    return !self->words[0] || path_contains(self->entries[k].name, self->words);
}

/* Returns the first row that is found from k on, in steps of 1 or -1; -1 if there is none. */
static int row_from(const Browser *self, int k, int step) {
    while (k >= 0 && k < self->count && !found(self, k)) k += step;
    return k >= 0 && k < self->count ? k : -1;
}

static const char *choose_row(Browser *self) {
    char path[PATH + NAME + 2];
    if (self->row < 0 || self->row >= self->count) return NULL;
    snprintf(path, sizeof path, "%s/%s", strcmp(self->folder, "/") == 0 ? "" : self->folder,
             self->entries[self->row].name);
    return choose(self, path);
}

const char *browser_open(Browser *self) { return self->types ? choose_typed(self) : choose_row(self); }

static void draw_places(Browser *self, float height) {
    ui_scope("places");
    if (ui_list("##places", 150.0f * ui_scale(), height)) {
        for (int k = 0; self->places && k < self->places->count; k++) {
            const FilePlace *place = &self->places->places[k];
            char label[PLACE_NAME + 16];
            snprintf(label, sizeof label, "%s##%d", place->name, k);
            if (ui_row(label, strcmp(place->path, self->folder) == 0)) choose(self, place->path);
            ui_tip(place->path);
        }
    }
    ui_list_end();
    ui_scope_end();
    ui_same_line();
}

/* Draws the rows; returns 1 if one was clicked, 2 if twice. */
static int draw_rows(Browser *self, float height) {
    int clicked = 0, shown = 0;
    if (ui_list("files", 0.0f, height)) {
        for (int k = 0; k < self->count; k++) {
            const FolderEntry *entry = &self->entries[k];
            char label[NAME + 4];
            if (!found(self, k)) continue;
            snprintf(label, sizeof label, "%s%s", entry->name, entry->folder ? "/" : "");
            const int now = ui_row(label, k == self->row);
            if (now) clicked = now, self->row = k, self->focus = true, self->types = false;
            if (k == self->row && self->moved) ui_scroll_here();
            shown++;
        }
        self->moved = false;
        if (self->more) ui_dim("... and more, which are not listed");
        if (!shown && !self->failure[0])
            ui_dim(self->words[0] ? "nothing of that name" : "nothing here that can be opened");
    }
    ui_list_end();
    return clicked;
}

/* Draws what is above the list: the way up, and the path. Returns what was typed and opened by Enter. */
static const char *draw_path(Browser *self) {
    char path[PATH + 4], before[PATH];
    const char *opened = NULL;
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
    memcpy(before, self->typed, sizeof before);
    if (ui_input_path("##path", self->typed, PATH)) opened = choose_typed(self);
    ui_tip("The folder. A path can be typed or pasted: Enter opens it.");
    if (strcmp(before, self->typed) != 0) self->types = strcmp(self->typed, self->folder) != 0;
    return opened;
}

/* Draws the words that narrow the list. Returns true if Enter was pressed. */
static bool draw_words(Browser *self) {
    char before[NAME];
    int step;
    memcpy(before, self->words, sizeof before);
    const bool entered = ui_search("filter", "type to find", self->words, NAME, self->focus, &step);
    self->focus = false;
    ui_tip("Lists only names that contain this. Arrows choose one, Enter opens it.");
    if (strcmp(before, self->words) != 0) self->row = self->words[0] ? row_from(self, 0, 1) : -1, self->moved = true;
    if (step) {
        const int next = row_from(self, self->row < 0 ? 0 : self->row + step, self->row < 0 ? 1 : step);
        if (next >= 0) self->row = next, self->moved = true, self->types = false;
    }
    return entered;
}

static void set_kinds(Browser *self, unsigned kinds) {
    if (self->kinds == kinds) return;
    self->kinds = kinds;
    list(self);
}

const char *browser_draw(Browser *self, unsigned kinds, float height) {
    set_kinds(self, kinds);
    const char *opened = draw_path(self);
    const bool entered = draw_words(self);
    if (self->failure[0]) ui_warning(self->failure);
    const float rest = height - (self->failure[0] ? 4.0f : 3.0f) * ui_line_height();
    draw_places(self, rest);
    const int clicked = draw_rows(self, rest);
    if (!opened && (clicked == 2 || entered)) opened = choose_row(self);
    return opened;
}

void browser_draw_saving(Browser *self, unsigned kinds, float height, char *name, size_t size) {
    set_kinds(self, kinds);
    const char *opened = draw_path(self);
    if (self->failure[0]) ui_warning(self->failure);
    const float rest = height - (self->failure[0] ? 3.0f : 2.0f) * ui_line_height();
    draw_places(self, rest);
    const int clicked = draw_rows(self, rest);
    const bool folder = clicked && self->entries[self->row].folder;
    if (clicked && !folder) snprintf(name, size, "%s", self->entries[self->row].name);
    if (folder && clicked == 2) choose_row(self);
    if (opened) snprintf(name, size, "%s", opened);
}

bool browser_place(const Browser *self, const char *name, char *path, size_t size) {
    char here[4096];
    const bool near = name[0] == '/' || (realpath(".", here) && strcmp(here, self->folder) == 0);
    const int used = near ? snprintf(path, size, "%s", name)
                          : snprintf(path, size, "%s/%s", strcmp(self->folder, "/") == 0 ? "" : self->folder, name);
    return used >= 0 && (size_t)used < size;
}
