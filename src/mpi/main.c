/* main.c - the program weft-mpi: `weft render` by all processes that mpirun started */
#include <mpi.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "cli/console/call_stack.h"
#include "cli/console/report.h"
#include "cli/console/uncaught.h"
#include "cli/operands/lobes.h"
#include "cli/operands/root.h"
#include "cli/verbs/verbs.h"
#include "mpi/deal.h"
#include "weft/version.h"

static int usage(void) {
    return report(WEFT_USAGE, "weft-mpi: mpirun -n COUNT weft-mpi render SCENE -o OUT [options]; options are those of "
                              "weft render");
}

/* Runs the verb, as weft does. */
static int render_run(int count, char **arguments) {
    Options options;
    int result = options_parse(&verb_render, count, arguments, &options);
    if (result == 0 && options.operand_count > 1)
        result = report(WEFT_USAGE, "weft-mpi: renders one scene; %.200s is another", options.operands[1]);
    if (result == 0) result = lobes_take(&options);
    if (result == 0) result = root_take(&options);
    if (result == 0) result = verb_render.run(&options);
    options_free(&options);
    return result;
}

/* The output of a process that follows is kept in a file, and is shown only if that process is the first that fails. */
typedef struct Hushed {
    FILE *file;
    int stream; /* standard error as it was */
} Hushed;

static Hushed hush(void) {
    Hushed hushed = {tmpfile(), dup(STDERR_FILENO)};
    if (hushed.file) dup2(fileno(hushed.file), STDERR_FILENO);
    return hushed;
}

static void unhush(Hushed *hushed, char *text, size_t size) {
    text[0] = '\0';
    fflush(stderr);
    if (hushed->file && fseek(hushed->file, 0, SEEK_SET) == 0) text[fread(text, 1, size - 1, hushed->file)] = '\0';
    if (hushed->file) fclose(hushed->file);
    if (hushed->stream >= 0) {
        dup2(hushed->stream, STDERR_FILENO);
        close(hushed->stream);
    }
}

static Hushed hushed = {NULL, -1};

/* Lets a process that follows speak again, when all have agreed to render. */
static WeftResult run_aloud(Gather *gather, const char *words, int spp, WeftError *error) {
    char text[1024];
    if (crew_follows()) unhush(&hushed, text, sizeof text);
    WeftResult result = deal_run(gather, words, spp, error);
    if (result != WEFT_OK && crew_follows()) hushed = hush(); /* what is wrong was said */
    return result;
}

static int dispatch(int count, char **arguments) {
    char text[1024] = "";
    int provided = 0;
    if (count >= 2 && strcmp(arguments[1], "--version") == 0) return printf("weft-mpi %s\n", weft_version()) < 0;
    for (int k = 1; k < count; k++)
        if (strcmp(arguments[k], "--help") == 0 || strcmp(arguments[k], "-h") == 0)
            return options_help(&verb_render), 0;
    MPI_Init_thread(&count, &arguments, MPI_THREAD_FUNNELED, &provided);
    Crew crew = {.run = run_aloud};
    MPI_Comm_rank(MPI_COMM_WORLD, &crew.rank);
    crew_join(&crew);
    if (crew.rank > 0) {
        hushed = hush();
        signal(SIGINT, SIG_IGN); /* the leader's to answer */
        signal(SIGTERM, SIG_IGN);
        if (!freopen("/dev/null", "w", stdout)) return report(WEFT_RESOURCES, "/dev/null: cannot be opened");
    }
    const bool known = count >= 2 && strcmp(arguments[1], "render") == 0;
    int result = known ? render_run(count - 2, arguments + 2) : usage();
    if (!deal_agreed()) {
        if (crew.rank > 0) unhush(&hushed, text, sizeof text);
        deal_agree(result, text);
    }
    MPI_Finalize();
    return result;
}

int main(int count, char **arguments) {
    uncaught_begin();
    signal(SIGXFSZ, SIG_IGN);
    signal(SIGCHLD, SIG_DFL);
    int result = stack_run(dispatch, count, arguments);
    return fflush(stdout) == 0 || result != 0 ? result : report(WEFT_RESOURCES, "standard output: cannot be written");
}
