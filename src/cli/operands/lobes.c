#include "cli/operands/lobes.h"

#include <string.h>

#include "cli/console/interrupt.h"
#include "cli/console/report.h"
#include "weft/lobe.h"

/* Returns true if value names a file; no id contains a dot or a slash. */
static bool is_file(const char *value) { return strpbrk(value, "./") != NULL; }

enum { TAKEN_MOST = 64 };
static const char *taken[TAKEN_MOST + 1];

const char *const *lobes_taken(void) { return taken; }

static void keep(const char *path) {
    int k = 0;
    while (k < TAKEN_MOST && taken[k]) k++;
    if (k < TAKEN_MOST) taken[k] = path;
}

/* Loads a lobe. A signal meanwhile ends the compiler; it is an exit code, whatever the verb does about signals. */
static int load(const char *path) {
    const WeftLog log = {.fn = report_warning};
    WeftError error;
    interrupt_watch();
    WeftResult result = weft_lobe_load(path, NULL, &log, &error);
    interrupt_unwatch();
    if (interrupt_seen()) return report(WEFT_INTERRUPTED, "%.200s: interrupted while it was compiled", path);
    return result == WEFT_OK ? 0 : report_error(&error);
}

int lobes_take(Options *options) {
    int cursor = 0, ids = 0;
    for (const char *value; (value = option_next(options, "--lobe", &cursor));) {
        bool either = strchr(option_row(options, "--lobe")->value, '|') != NULL;
        if (either && !is_file(value)) {
            if (ids++) return report(WEFT_USAGE, "--lobe: is given twice");
            continue;
        }
        int result = load(value);
        if (result != 0) return result;
        keep(value);
        option_drop(options, --cursor);
    }
    return 0;
}
