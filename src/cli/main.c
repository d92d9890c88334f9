/* main.c - the weft program: finds the verb and hands over */
#include <errno.h>
#include <stdio.h>
#include <string.h>

#include "layout.h"
#include "names.h"
#include "report.h"
#include "verbs.h"

static const Verb *const verbs[] = {&verb_render, &verb_models, &verb_eval, &verb_check, NULL};

static void program_help(void) {
    printf("weft %s - the cloth-shading workbench\n\nUsage: weft VERB ...\n\n", weft_version());
    for (int k = 0; verbs[k]; k++) layout_entry(stdout, 12, verbs[k]->name, verbs[k]->help);
    printf("\n`weft VERB --help` tells all of a verb; `weft --version` the version.\n\nExit codes\n");
    layout_entry(stdout, 12, "0", "done");
    layout_entry(stdout, 12, "1", "a check or a comparison did not hold");
    layout_entry(stdout, 12, "2", "a name, a number or an option makes no sense");
    layout_entry(stdout, 12, "3", "an input could not be read or is invalid");
    layout_entry(stdout, 12, "4", "memory, disk or a device gave out");
    layout_entry(stdout, 12, "130", "interrupted; what there was has been written");
}

static int verb_run(const Verb *verb, int count, char **arguments) {
    for (int k = 0; k < count && strcmp(arguments[k], "--") != 0; k++)
        if (strcmp(arguments[k], "--help") == 0 || strcmp(arguments[k], "-h") == 0) {
            options_help(verb);
            return 0;
        }
    Options options;
    int result = options_parse(verb, count, arguments, &options);
    if (result == 0) result = verb->run(&options);
    options_free(&options);
    return result;
}

static int dispatch(int count, char **arguments) {
    if (count < 2) return report(WEFT_USAGE, "a verb is needed; see weft --help");
    const char *word = arguments[1];
    if (strcmp(word, "--help") == 0 || strcmp(word, "-h") == 0) {
        program_help();
        return 0;
    }
    if (strcmp(word, "--version") == 0) {
        printf("weft %s\n", weft_version());
        return 0;
    }
    Nearest nearest = {.typed = word};
    for (int k = 0; verbs[k]; k++) {
        if (strcmp(word, verbs[k]->name) == 0) return verb_run(verbs[k], count - 2, arguments + 2);
        nearest_offer(&nearest, verbs[k]->name);
    }
    char hint[96];
    return report(WEFT_USAGE, "%.200s: is not a verb%s", word,
                  nearest.name ? nearest_hint(&nearest, hint, sizeof hint) : "; see weft --help");
}

int main(int count, char **arguments) {
    int result = dispatch(count, arguments);
    errno = 0;
    int flushed = fflush(stdout);
    if ((flushed != 0 || ferror(stdout)) && result == 0)
        result = report(WEFT_RESOURCES, "standard output: cannot be written%s%s", errno ? ": " : "",
                        errno ? strerror(errno) : "");
    return result;
}
