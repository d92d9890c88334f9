/* scratch.h - folders for the files that a test writes */
#ifndef WEFT_TESTS_SCRATCH_H
#define WEFT_TESTS_SCRATCH_H

#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { SCRATCH_SIZE = 40 };

/* Makes a new folder under $TMPDIR, or under /tmp if that is not set or too long. */
static inline bool scratch_make(char folder[SCRATCH_SIZE]) {
    const char *root = getenv("TMPDIR");
    bool usable = root && root[0] == '/' && strlen(root) < SCRATCH_SIZE - 20;
    snprintf(folder, SCRATCH_SIZE, "%s/weft-test-XXXXXX", usable ? root : "/tmp");
    return mkdtemp(folder) != NULL;
}

/* Makes one and lets the program work in it. */
static inline bool scratch_enter(char folder[SCRATCH_SIZE]) { return scratch_make(folder) && chdir(folder) == 0; }

/* Makes one that is the user's cache. */
static inline bool scratch_cache(char folder[SCRATCH_SIZE]) {
    return scratch_make(folder) && setenv("XDG_CACHE_HOME", folder, 1) == 0;
}

/* Removes a folder with all that is in it. */
static inline bool scratch_remove(const char *folder) {
    char command[SCRATCH_SIZE + 16];
    snprintf(command, sizeof command, "rm -r '%s'", folder);
    return system(command) == 0;
}

/* For a group of tests that work in one, which *state is: to begin and to end with. */
static inline int scratch_group_begin(void **state) {
    static char folder[SCRATCH_SIZE];
    *state = folder;
    return scratch_enter(folder) ? 0 : -1;
}
static inline int scratch_group_end(void **state) { return chdir("/") == 0 && scratch_remove(*state) ? 0 : -1; }

/* Removes a folder; fails if a test has left a file in it. */
static inline bool scratch_remove_empty(const char *folder) { return chdir("/") == 0 && rmdir(folder) == 0; }

#endif
