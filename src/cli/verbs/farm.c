/* farm.c - `weft farm`: a job becomes commands that several machines run, for a queue that is there already */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/path.h"
#include "cli/console/output.h"
#include "cli/console/report.h"
#include "cli/operands/command.h"
#include "cli/operands/lobes.h"
#include "cli/render/request.h"
#include "cli/verbs/verbs.h"
#include "weft/weft.h"

/* The commands of a job: those that may run at the same time, and one after all of them. */
typedef struct Tasks {
    char **lines; /* owned */
    int count, capacity;
    char *last; /* owned; NULL: none */
} Tasks;

static void tasks_free(Tasks *tasks) {
    for (int k = 0; k < tasks->count; k++) free(tasks->lines[k]);
    free(tasks->lines);
    free(tasks->last);
}

static int short_of_memory(void) { return report(WEFT_RESOURCES, "farm: out of memory"); }

/* Adds a command, which it takes. */
static int task_add(Tasks *tasks, char *line) {
    if (tasks->count == tasks->capacity) {
        const int capacity = tasks->capacity ? 2 * tasks->capacity : 64;
        char **lines = realloc(tasks->lines, (size_t)capacity * sizeof(char *));
        if (lines) tasks->lines = lines, tasks->capacity = capacity;
    }
    if (!line || tasks->count == tasks->capacity) return free(line), short_of_memory();
    tasks->lines[tasks->count++] = line;
    return 0;
}

/* ---- a command */

/* A command that is being written. */
typedef struct FarmLine {
    FILE *stream;
    char *text;
    size_t size;
    bool good;
} FarmLine;

/* Appends a word in quotes, with a blank before. */
static void line_word(FarmLine *line, const char *word) {
    char *quoted = line->good ? command_word(word) : NULL;
    line->good = quoted && fprintf(line->stream, " %s", quoted) > 0;
    free(quoted);
}

/* Begins a command with the program and a verb. */
static void line_begin(FarmLine *line, const Options *farm, const char *verb) {
    *line = (FarmLine){.stream = NULL};
    line->stream = open_memstream(&line->text, &line->size);
    char *program = command_word(option_text(farm, "--program"));
    line->good = line->stream && program && fprintf(line->stream, "%s", program) > 0;
    free(program);
    line_word(line, verb);
}

/* Appends an option and its value. */
static void line_option(FarmLine *line, const char *name, const char *value) {
    line_word(line, name);
    if (value) line_word(line, value);
}

/* Appends all options of a job but those in `but`. A value that looks like an option is joined to its name. */
static void line_options(FarmLine *line, const Options *job, const char *const *but) {
    for (int k = 0; k < job->given_count; k++) {
        const Given *given = &job->given[k];
        bool left = false;
        for (int b = 0; but[b]; b++) left |= strcmp(but[b], given->option->name) == 0;
        if (!left) line_option(line, given->option->name, given->option->value ? given->value : NULL);
    }
}

/* Ends a command; NULL where memory was short. */
static char *line_end(FarmLine *line) {
    if (line->stream && fclose(line->stream) != 0) line->good = false;
    if (line->good) return line->text;
    free(line->text);
    return NULL;
}

/* ---- pieces of jobs */

/* Makes "chair.part-7.exr" of "chair.png" and the number 7. Release with free. */
static char *part_name(const char *out, int number) {
    char digits[PATH_NUMBER + 8];
    const size_t size = strlen(out) + sizeof digits + 8;
    char *name = malloc(size);
    if (!name) return NULL;
    const char *slash = strrchr(out, '/'), *dot = strrchr(out, '.');
    const int stem = dot && (!slash || dot > slash + 1) ? (int)(dot - out) : (int)strlen(out);
    if (number > 0)
        snprintf(digits, sizeof digits, "part-%d", number);
    else
        snprintf(digits, sizeof digits, "so-far-%d", -number);
    snprintf(name, size, "%.*s.%s.exr", stem, out, digits);
    return name;
}

/* Adds part `index` of a picture, which has a checkpoint: a queue may take a machine away. */
static int part_add(Tasks *tasks, const Options *farm, const Options *job, int index, int count, const char *out) {
    static const char *const but[] = {"-o", "--checkpoint", "--quiet", NULL};
    char chunk[32], *part = part_name(out, index), *point = part_name(out, -index);
    FarmLine line;
    snprintf(chunk, sizeof chunk, "%d/%d", index, count);
    line_begin(&line, farm, "render");
    line_word(&line, job->operands[0]);
    line_options(&line, job, but);
    line_option(&line, "--chunk", chunk);
    if (!part || !point) line.good = false;
    if (line.good) line_option(&line, "--checkpoint", point);
    if (line.good) line_option(&line, "-o", part);
    free(part);
    free(point);
    return task_add(tasks, line_end(&line));
}

/* Cuts one picture into parts, which are merged at the end. */
static int parts_make(Tasks *tasks, const Options *farm, const Options *job, int count) {
    const char *out = option_text(job, "-o");
    int cursor = 0, result = 0;
    FarmLine line;
    for (int k = 1; k <= count && result == 0; k++) result = part_add(tasks, farm, job, k, count, out);
    if (result != 0) return result;
    line_begin(&line, farm, "merge");
    for (int k = 1; k <= count && line.good; k++) {
        char *part = part_name(out, k);
        if (part) line_word(&line, part);
        line.good &= part != NULL;
        free(part);
    }
    for (const char *path; (path = option_next(job, "-o", &cursor));) line_option(&line, "-o", path);
    tasks->last = line_end(&line);
    return tasks->last ? 0 : short_of_memory();
}

/* Deals out the pictures of a turntable. */
static int frames_make(Tasks *tasks, const Options *farm, const Options *job, int count) {
    static const char *const but[] = {"--chunk", NULL};
    int result = 0;
    for (int k = 1; k <= count && result == 0; k++) {
        char chunk[32];
        FarmLine line;
        snprintf(chunk, sizeof chunk, "%d/%d", k, count);
        line_begin(&line, farm, "render");
        line_word(&line, job->operands[0]);
        line_options(&line, job, but);
        line_option(&line, "--chunk", chunk);
        result = task_add(tasks, line_end(&line));
    }
    return result;
}

/* Gives each operand a command of its own. */
static int operands_make(Tasks *tasks, const Options *farm, const Options *job) {
    static const char *const none[] = {NULL};
    int result = 0;
    for (int k = 0; k < job->operand_count && result == 0; k++) {
        FarmLine line;
        line_begin(&line, farm, job->verb->name);
        line_word(&line, job->operands[k]);
        line_options(&line, job, none);
        result = task_add(tasks, line_end(&line));
    }
    return result;
}

/* Gives each lobe of `check all` a command of its own. */
static int checks_make(Tasks *tasks, const Options *farm, const Options *job) {
    static const char *const none[] = {NULL};
    int result = 0;
    for (int k = 0; result == 0 && k < weft_lobe_count(); k++) {
        FarmLine line;
        line_begin(&line, farm, "check");
        line_word(&line, weft_lobe_info(k)->id);
        line_options(&line, job, none);
        result = task_add(tasks, line_end(&line));
    }
    for (int k = 0; result == 0 && weft_profile_name(k); k++) {
        FarmLine line;
        line_begin(&line, farm, "check");
        line_word(&line, weft_profile_name(k));
        line_options(&line, job, none);
        result = task_add(tasks, line_end(&line));
    }
    return result;
}

/* Checks a job of `weft render` as the commands that it is cut into will, and how many those are. */
static int request_check(const Options *job, int *count, bool *frames) {
    Options own = *job; /* lobes_take forgets the options that it has taken */
    Request request;
    own.given = calloc((size_t)job->given_count + 1, sizeof *own.given);
    if (!own.given) return short_of_memory();
    memcpy(own.given, job->given, (size_t)job->given_count * sizeof *own.given);
    int result = lobes_take(&own);
    if (result == 0 && !request_read(&own, &request)) result = WEFT_USAGE;
    if (result == 0) {
        const int height = request.desc.crop[3] ? request.desc.crop[3] : request.desc.height;
        const int most = (height + WEFT_RENDER_TILE - 1) / WEFT_RENDER_TILE;
        *frames = request.turntable > 0;
        if (*count > (*frames ? request.turntable : most)) *count = *frames ? request.turntable : most;
        result = request_cut(&request, 0, *count) ? 0 : WEFT_USAGE;
    }
    free(own.given);
    return result;
}

/* Cuts a job of `weft render`. */
static int render_make(Tasks *tasks, const Options *farm, const Options *job) {
    static const char *const own[] = {"--chunk", "--save", "--from", NULL};
    int count = 0;
    bool frames = false;
    if (!option_given(job, "-o")) return report(WEFT_USAGE, "farm: render needs -o OUT");
    for (int k = 0; own[k]; k++)
        if (option_given(job, own[k]) && job->operand_count == 1)
            return report(WEFT_USAGE, "farm: not with %s, which is of one process", own[k]);
    if (job->operand_count > 1) return operands_make(tasks, farm, job);
    if (!option_integer(farm, "--array", &count)) return WEFT_USAGE;
    const int result = request_check(job, &count, &frames);
    if (result != 0) return result;
    return frames ? frames_make(tasks, farm, job, count) : parts_make(tasks, farm, job, count);
}

static int check_make(Tasks *tasks, const Options *farm, const Options *job) {
    if (strcmp(job->operands[0], "all") != 0 || option_given(job, "--html"))
        return report(WEFT_USAGE, "farm: of check only `all` has pieces, and those have no --html together");
    return checks_make(tasks, farm, job);
}

/* The verbs whose jobs have pieces. */
static const struct {
    const Verb *verb;
    int (*make)(Tasks *tasks, const Options *farm, const Options *job);
} jobs[] = {{&verb_render, render_make},
            {&verb_check, check_make},
            {&verb_doctor, operands_make},
            {&verb_match, operands_make}};

/* Cuts the job that stands behind "--". */
static int job_make(Tasks *tasks, const Options *farm) {
    if (farm->operand_count < 2)
        return report(WEFT_USAGE, "farm: needs a job: weft farm KIND [options] -- render SCENE -o OUT");
    for (size_t k = 0; k < sizeof jobs / sizeof *jobs; k++) {
        if (strcmp(farm->operands[1], jobs[k].verb->name) != 0) continue;
        Options job;
        const int count = farm->operand_count - 2;
        char **words = calloc((size_t)count + 1, sizeof(char *));
        if (!words) return short_of_memory();
        memcpy(words, farm->operands + 2, (size_t)count * sizeof(char *));
        int result = options_parse(jobs[k].verb, count, words, &job);
        if (result == 0) result = jobs[k].make(tasks, farm, &job);
        options_free(&job);
        free(words);
        return result;
    }
    return report(WEFT_USAGE, "farm: %.100s is not render, check, doctor or match; --commands FILE takes any commands",
                  farm->operands[1]);
}

/* Takes commands from a file, one a line. */
static int commands_read(Tasks *tasks, const char *path) {
    FILE *stream = strcmp(path, "-") == 0 ? stdin : fopen(path, "r");
    char *line = NULL;
    size_t capacity = 0;
    int result = 0;
    if (!stream) return report(WEFT_INPUT, "%.200s: cannot be opened", path);
    for (ssize_t size; result == 0 && (size = getline(&line, &capacity, stream)) >= 0;) {
        if (size && line[size - 1] == '\n') line[--size] = '\0';
        if (strlen(line) != (size_t)size) result = report(WEFT_INPUT, "%.200s: is no text", path);
        if (result == 0 && line[strspn(line, " \t")]) result = task_add(tasks, strdup(line));
    }
    if (result == 0 && ferror(stream)) result = report(WEFT_INPUT, "%.200s: cannot be read", path);
    if (stream != stdin) fclose(stream);
    free(line);
    return result;
}

static void list_print(FILE *to, const Tasks *tasks) {
    for (int k = 0; k < tasks->count; k++) fprintf(to, "%s\n", tasks->lines[k]);
    if (tasks->last) fprintf(to, "# after all of these:\n%s\n", tasks->last);
}

static void parallel_print(FILE *to, const Tasks *tasks) {
    fprintf(to, "#!/bin/sh\n# Arguments are those of GNU parallel, such as --jobs 2 or --sshloginfile NODES.\n"
                "set -eu\nparallel --will-cite --halt soon,fail=1 \"$@\" <<'WEFT_COMMANDS'\n");
    for (int k = 0; k < tasks->count; k++) fprintf(to, "%s\n", tasks->lines[k]);
    fprintf(to, "WEFT_COMMANDS\n");
    if (tasks->last) fprintf(to, "%s\n", tasks->last);
}

static void slurm_print(FILE *to, const Tasks *tasks) {
    fprintf(to,
            "#!/bin/sh\n# Arguments are those of sbatch, such as --partition=P --time=2:00:00.\nset -eu\n"
            "array=$(sbatch --parsable --job-name=weft --array=1-%d --requeue \"$@\" <<'WEFT_SCRIPT'\n#!/bin/sh\n"
            "case $SLURM_ARRAY_TASK_ID in\n",
            tasks->count);
    for (int k = 0; k < tasks->count; k++) fprintf(to, "%d) %s ;;\n", k + 1, tasks->lines[k]);
    fprintf(to, "esac\nWEFT_SCRIPT\n)\necho \"$array\"\n");
    if (!tasks->last) return;
    fprintf(to,
            "sbatch --parsable --job-name=weft-merge --dependency=\"afterok:$array\" --kill-on-invalid-dep=yes \"$@\" "
            "<<'WEFT_SCRIPT'\n#!/bin/sh\n%s\nWEFT_SCRIPT\n",
            tasks->last);
}

static const struct {
    const char *name;
    void (*print)(FILE *to, const Tasks *tasks);
} kinds[] = {{"slurm", slurm_print}, {"parallel", parallel_print}, {"list", list_print}};

/* Refuses what would break a line of a script in two. */
static int words_check(const Tasks *tasks) {
    for (int k = 0; k <= tasks->count; k++) {
        const char *line = k < tasks->count ? tasks->lines[k] : tasks->last;
        for (; line && *line; line++)
            if ((unsigned char)*line < ' ' && *line != '\t')
                return report(WEFT_USAGE, "farm: a name or an option has a line break or another control character");
    }
    return 0;
}

static int script_write(const Options *options, void (*print)(FILE *, const Tasks *), const Tasks *tasks) {
    const char *path = option_text(options, "-o");
    if (!path) return print(stdout, tasks), 0;
    Output output;
    int result = output_begin(&output, path);
    if (result != 0) return result;
    print(output.stream, tasks);
    return output_end(&output);
}

static int farm_run(const Options *options) {
    const char *commands = option_text(options, "--commands");
    Tasks tasks = {.count = 0};
    size_t kind = 0;
    while (kind < sizeof kinds / sizeof *kinds && strcmp(kinds[kind].name, options->operands[0]) != 0) kind++;
    if (kind == sizeof kinds / sizeof *kinds)
        return report(WEFT_USAGE, "farm: \"%.100s\" is not slurm, parallel or list", options->operands[0]);
    if (commands && options->operand_count > 1)
        return report(WEFT_USAGE, "farm: has a job by --commands already; %.100s is another", options->operands[1]);
    int result = commands ? commands_read(&tasks, commands) : job_make(&tasks, options);
    if (result == 0) result = words_check(&tasks);
    if (result == 0 && !tasks.count) result = report(WEFT_USAGE, "farm: there is nothing to do");
    if (result == 0) result = script_write(options, kinds[kind].print, &tasks);
    tasks_free(&tasks);
    return result;
}

static const Option farm_options[] = {
    OPTION_WHOLE("--array", "COUNT", "16", 1, CHUNKS_MOST,
                 "parts of a picture or of a turntable; of other jobs each piece is a command"),
    OPTION_TEXT("--commands", "FILE", NULL,
                "take any commands of a shell, one a line, in place of a job; - reads them"),
    OPTION_TEXT("--program", "PATH", "weft", "call the program so, on the machines that run it"),
    OPTION_TEXT("-o", "FILE", NULL, "write there and not to standard output"),
    OPTION_END,
};

const Verb verb_farm = {
    .name = "farm",
    .operands = "KIND [options] -- VERB ...",
    .help = "writes a job as commands for Slurm, GNU parallel, lists",
    .operands_least = 1,
    .operands_most = 1 << 20,
    .options = farm_options,
    .notes = "KIND is slurm, a script that submits an array of jobs and, after them, what\n"
             "joins their files; parallel, a script that calls GNU parallel; or list, a\n"
             "command a line for another queue, where the last, if there is a remark before\n"
             "it, has to wait for all others. The job behind -- is a command line of weft\n"
             "without the program: a picture becomes parts and weft merge, a turntable some of\n"
             "its pictures each, `check all` a model each, and several assets of render,\n"
             "doctor or match one each. Parts have checkpoints, so that a job that is stopped\n"
             "and queued again goes on. docs/farm.md has the way from one laptop to a thousand\n"
             "cores.\n\n"
             "Examples\n"
             "  weft farm slurm --array 16 -- render chair.glb --spp 4096 -o chair.exr | sh\n"
             "  weft farm parallel --array 4 -- render chair.glb -o chair.png >chair.sh\n"
             "  weft farm list -- check all --json\n"
             "  for f in *.csv; do echo weft fit \"$f\" --lobe ggx; done |\n"
             "       weft farm slurm --commands - >fits.sh\n",
    .run = farm_run,
};
