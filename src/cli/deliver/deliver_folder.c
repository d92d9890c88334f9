/* deliver_folder.c - the files of a delivery, which are made in a folder of their own and then given their places */
#define _XOPEN_SOURCE 700 /* folder.h, mkdtemp */
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/folder.h"
#include "cli/console/output.h"
#include "cli/console/report.h"
#include "cli/deliver/delivery.h"

static int unwritten(const char *path) {
    return report(WEFT_RESOURCES, "%.400s: %s: %s", path, weft_message_text(WEFT_MESSAGE_FILE_WRITE), strerror(errno));
}

/* Writes FOLDER/NAME-TARGET.SUFFIX, or FOLDER/NAME.SUFFIX. */
static void path_in(const char *folder, const char *name, const char *target, const char *suffix,
                    char path[DELIVER_PATH]) {
    snprintf(path, DELIVER_PATH, "%.3900s/%.79s%s%.32s%s", folder, name, target ? "-" : "", target ? target : "",
             suffix);
}

void folder_path(const Delivery *delivery, const char *target, const char *suffix, char path[DELIVER_PATH]) {
    path_in(delivery->temporary, delivery->name, target, suffix, path);
}

/* Calls use with each file, the summary last, until it returns another value than 0. */
static int each_file(Delivery *delivery, int (*use)(const Delivery *delivery, const char *target, const char *suffix)) {
    int result = 0;
    for (int k = 0; k < delivery->count && result == 0; k++) {
        const WeftTarget target = file_target(&delivery->files[k]);
        result = use(delivery, target.name, file_suffix(&delivery->files[k]));
        if (result == 0) result = use(delivery, target.name, ".png");
    }
    return result == 0 ? use(delivery, NULL, ".json") : result;
}

static int place_probe(const Delivery *delivery, const char *target, const char *suffix) {
    char path[DELIVER_PATH];
    path_in(delivery->folder, delivery->name, target, suffix, path);
    return output_probe_other(delivery->options, path);
}

int folder_begin(Delivery *delivery) {
    if (strlen(delivery->folder) > 3800) return report(WEFT_USAGE, "-o: the name is too long");
    const int made = folder_create(delivery->folder);
    if (made < 0 && errno == EEXIST)
        return report(WEFT_RESOURCES, "%.400s: is a file; -o names a folder, which is made if it does not exist",
                      delivery->folder);
    if (made < 0) return unwritten(delivery->folder);
    delivery->made = made == 1;
    const int result = each_file(delivery, place_probe);
    if (result != 0) return result;
    snprintf(delivery->temporary, sizeof delivery->temporary, "%.3900s/.weft-XXXXXX", delivery->folder);
    if (mkdtemp(delivery->temporary)) return 0;
    delivery->temporary[0] = '\0';
    return unwritten(delivery->folder);
}

static int place_take(const Delivery *delivery, const char *target, const char *suffix) {
    char from[DELIVER_PATH], to[DELIVER_PATH];
    folder_path(delivery, target, suffix, from);
    path_in(delivery->folder, delivery->name, target, suffix, to);
    return rename(from, to) == 0 ? 0 : unwritten(to);
}

int folder_commit(Delivery *delivery) { return each_file(delivery, place_take); }

void folder_end(Delivery *delivery) {
    if (delivery->temporary[0]) (void)folder_remove_all(delivery->temporary);
    if (delivery->made) rmdir(delivery->folder); /* stays where it has files */
}
