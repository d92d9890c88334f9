#define _DEFAULT_SOURCE
#include "view/files/session_file.h"

#include <dirent.h>
#include <fcntl.h>
#include <limits.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include "view/files/json_file.h"
#include "view/files/paths.h"

enum { SIZE_MOST = 64 << 20 };

/* Returns a number that tells paths apart: FNV-1a (Fowler, Noll, Vo). */
static uint64_t hash_of(const char *text) {
    uint64_t hash = 14695981039346656037u;
    for (; *text; text++) hash = (hash ^ (unsigned char)*text) * 1099511628211u;
    return hash;
}

/* Writes the path of a scene's session: its name, for people, and a number, since names occur twice. */
static bool place(const char *scene, bool make, char path[SESSION_PATH]) {
    char real[PATH_MAX], stem[64], name[128];
    path_stem(scene, stem, sizeof stem);
    snprintf(name, sizeof name, "session-%s-%016llx.json", stem,
             (unsigned long long)hash_of(realpath(scene, real) ? real : scene));
    return json_file_place("XDG_STATE_HOME", ".local/state", name, make, path, SESSION_PATH);
}

/* Opens and locks the file beside a session; -1 if another window has it. */
static int lock_of(const char *path) {
    char beside[SESSION_PATH + 8];
    snprintf(beside, sizeof beside, "%s.lock", path);
    int lock = open(beside, O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0600);
    if (lock >= 0 && flock(lock, LOCK_EX | LOCK_NB) == 0) return lock;
    if (lock >= 0) close(lock);
    return -1;
}

bool session_file_claim(SessionFile *self, const char *scene) {
    char path[SESSION_PATH];
    *self = (SessionFile){.lock = -1};
    if (!place(scene, true, path)) return false;
    self->lock = lock_of(path);
    if (self->lock < 0) return false;
    memcpy(self->path, path, sizeof self->path);
    return true;
}

json_t *session_file_read(const char *path, bool *damaged) {
    struct stat s;
    json_t *root = json_file_read(path, SIZE_MOST);
    *damaged = !json_is_object(root) && lstat(path, &s) == 0;
    if (json_is_object(root)) return root;
    json_decref(root);
    return NULL;
}

bool session_file_write(const SessionFile *self, const json_t *session) {
    return self->path[0] && json_file_write(self->path, session);
}

bool session_file_nap(const char *path, int k, char nap[SESSION_PATH]) {
    const size_t stem = strlen(path) - strlen(".json");
    const int used = snprintf(nap, SESSION_PATH, "%.*s-nap-%d.png", (int)stem, path, k);
    return used > 0 && used < SESSION_PATH;
}

bool session_file_is_of(const SessionFile *self, const char *scene) {
    char path[SESSION_PATH];
    return self->path[0] && place(scene, false, path) && strcmp(path, self->path) == 0;
}

void session_file_forget(const SessionFile *self) {
    char nap[SESSION_PATH];
    if (!self->path[0]) return;
    unlink(self->path);
    for (int k = 0; k < SESSION_NAPS; k++)
        if (session_file_nap(self->path, k, nap)) unlink(nap);
}

void session_file_release(SessionFile *self, bool forget) {
    char beside[SESSION_PATH + 8];
    if (!self->path[0]) return;
    if (forget) session_file_forget(self);
    snprintf(beside, sizeof beside, "%s.lock", self->path);
    unlink(beside);
    close(self->lock);
    *self = (SessionFile){.lock = -1};
}

static bool is_session(const char *name) {
    const size_t length = strlen(name), end = strlen(".json");
    return strncmp(name, "session-", 8) == 0 && length > end && strcmp(name + length - end, ".json") == 0;
}

/* Returns true if a window has the session. */
static bool is_held(const char *path) {
    char beside[SESSION_PATH + 8];
    snprintf(beside, sizeof beside, "%s.lock", path);
    int lock = open(beside, O_RDWR | O_CLOEXEC | O_NOFOLLOW);
    bool held = lock >= 0 && flock(lock, LOCK_EX | LOCK_NB) != 0;
    if (lock >= 0) close(lock);
    return held;
}

json_t *session_file_last(void) {
    char folder[SESSION_PATH], path[SESSION_PATH], newest[SESSION_PATH] = "";
    struct timespec at = {0};
    bool damaged;
    if (!json_file_place("XDG_STATE_HOME", ".local/state", "", false, folder, sizeof folder)) return NULL;
    DIR *dir = opendir(folder);
    for (const struct dirent *d; dir && (d = readdir(dir));) {
        struct stat s;
        const int used = snprintf(path, sizeof path, "%s%s", folder, d->d_name);
        if (used < 0 || (size_t)used >= sizeof path || !is_session(d->d_name) || lstat(path, &s) != 0 ||
            !S_ISREG(s.st_mode) || is_held(path))
            continue;
        const struct timespec when = s.st_mtim;
        if (newest[0] && (when.tv_sec < at.tv_sec || (when.tv_sec == at.tv_sec && when.tv_nsec <= at.tv_nsec)))
            continue;
        at = when;
        memcpy(newest, path, sizeof newest);
    }
    if (dir) closedir(dir);
    return newest[0] ? session_file_read(newest, &damaged) : NULL;
}
