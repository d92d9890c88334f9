/* main.c - the weft program: finds the verb and runs it */
#include <errno.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "cli/console/call_stack.h"
#include "cli/console/crash.h"
#include "cli/console/names.h"
#include "cli/console/report.h"
#include "cli/console/two_columns.h"
#include "cli/console/uncaught.h"
#include "cli/operands/lobes.h"
#include "cli/operands/root.h"
#include "cli/verbs/verbs.h"
#include "man.h"
#include "weft/version.h"

#define VERB_PLACED(name) &verb_##name,
static const Verb *const verbs[] = {VERBS(VERB_PLACED) NULL};

static const ExitCode codes[] = {{"0", "done"},
                                 {"1", "a check or a comparison did not hold"},
                                 {"2", "a name, a number or an option makes no sense"},
                                 {"3", "an input could not be read or is invalid"},
                                 {"4", "out of memory or disk space, or a device failed"},
                                 {"130", "interrupted; what there was has been written"},
                                 {NULL, NULL}};

static void list_verbs(FILE *stream) {
    for (int k = 0; verbs[k]; k++) layout_entry(stream, 12, verbs[k]->name, verbs[k]->help);
}

static void program_help(void) {
    printf("weft %s - the cloth-shading workbench\n\nUsage: weft VERB ...\n\n", weft_version());
    list_verbs(stdout);
    printf("\n`weft VERB --help` or `weft help VERB` explains a verb; `weft --version` prints the\n"
           "version.\n\nExit codes\n");
    for (const ExitCode *code = codes; code->code; code++) layout_entry(stdout, 12, code->code, code->words);
}

static int verb_run(const Verb *verb, int count, char **arguments) {
    for (int k = 0; k < count && strcmp(arguments[k], "--") != 0; k++)
        if (strcmp(arguments[k], "--help") == 0 || strcmp(arguments[k], "-h") == 0) {
            options_help(verb);
            return 0;
        }
    Options options;
    int result = options_parse(verb, count, arguments, &options);
    if (result == 0) result = lobes_take(&options);
    if (result == 0) result = root_take(&options);
    if (result == 0) result = verb->run(&options);
    options_free(&options);
    return result;
}

/* Returns the verb of that name; NULL after one line on standard error. */
static const Verb *verb_find(const char *word) {
    char hint[96];
    Nearest nearest = {.typed = word};
    for (int k = 0; verbs[k]; k++) {
        if (strcmp(word, verbs[k]->name) == 0) return verbs[k];
        nearest_offer(&nearest, verbs[k]->name);
    }
    report(WEFT_USAGE, "%.200s: is not a verb%s", word[0] ? word : "\"\"",
           nearest.name ? nearest_hint(&nearest, hint, sizeof hint) : "; see weft --help");
    return NULL;
}

/* Runs `weft help [--man] [VERB]`, which prints text or a page for man. */
static int help_run(int count, char **arguments) {
    bool man = count && strcmp(arguments[0], "--man") == 0;
    count -= man;
    arguments += man;
    if (count > 1) return report(WEFT_USAGE, "%.200s: is one operand too many; weft help [--man] [VERB]", arguments[1]);
    const Verb *verb = count ? verb_find(arguments[0]) : NULL;
    if (count && !verb) return WEFT_USAGE;
    if (verb && man)
        man_verb(verb);
    else if (verb)
        options_help(verb);
    else if (man)
        man_program(verbs, codes);
    else
        program_help();
    return 0;
}

static int dispatch(int count, char **arguments) {
    if (count < 2) {
        report(WEFT_USAGE, "a verb is needed: weft VERB ...; see weft --help");
        fputc('\n', stderr);
        list_verbs(stderr);
        return WEFT_USAGE;
    }
    const char *word = arguments[1];
    if (strcmp(word, "help") == 0) return help_run(count - 2, arguments + 2);
    if (strcmp(word, "--help") == 0 || strcmp(word, "-h") == 0) return help_run(0, arguments + count);
    if (strcmp(word, "--version") == 0 || strcmp(word, "version") == 0) {
        printf("weft %s\n", weft_version());
        return 0;
    }
    const Verb *verb = verb_find(word);
    return verb ? verb_run(verb, count - 2, arguments + 2) : WEFT_USAGE;
}

int main(int count, char **arguments) {
    crash_begin();
    uncaught_begin();
    signal(SIGXFSZ, SIG_IGN); /* a file beyond its limit is a write that fails, and is reported as one */
    signal(SIGCHLD, SIG_DFL); /* if the parent ignores it, compilers could not be waited for */
    int result = stack_run(dispatch, count, arguments);
    errno = 0;
    int flushed = fflush(stdout);
    if ((flushed != 0 || ferror(stdout)) && (result == 0 || result == WEFT_FAILED)) /* only stdout shows this */
        result = report(WEFT_RESOURCES, "standard output: cannot be written%s%s", errno ? ": " : "",
                        errno ? strerror(errno) : "");
    /* Threads of TBB may still work on what failed for lack of memory, and would use what exit() destroys. */
    if (result == WEFT_RESOURCES) _exit(result);
    return result;
}
