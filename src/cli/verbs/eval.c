/* eval.c - `weft eval`: values of one model, an output line for each input line */
#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/pi.h"
#include "cli/console/decimal.h"
#include "cli/console/json_writer.h"
#include "cli/console/names.h"
#include "cli/console/report.h"
#include "cli/operands/given_lobe.h"
#include "cli/operands/lobes.h"
#include "cli/operands/model.h"
#include "cli/operands/root.h"
#include "cli/verbs/verbs.h"
#include "weft/weft.h"

enum { LINE_MOST = 4095, CHUNK = 1 << 18, BATCH = 1024 };

/* Lines that wait for their answers. A line of --albedo has its cosine in o[2]. */
typedef struct EvalBatch {
    size_t n;
    float o[3][BATCH], i[3][BATCH];
    float f[3][BATCH], pdf[BATCH];
    char text[BATCH * 4 * DECIMAL_SIZE];
} EvalBatch;

/* Reads exactly `count` finite numbers separated by blanks and tabs, with at most one comma between two of them. */
static bool line_numbers(const char *text, int count, double *numbers) {
    for (int k = 0; k < count; k++) {
        text += strspn(text, " \t");
        if (k && *text == ',') text += 1 + strspn(text + 1, " \t");
        const char *end = decimal_read(text, &numbers[k]);
        if (end == text || !isfinite(numbers[k]) || !strchr(" \t,\r", *end)) return false;
        text = end;
    }
    return text[strspn(text, " \t\r")] == '\0';
}

/* Computes a unit direction from degrees. The cosine is the sine of 90 - theta, so that it is exactly 0 at 90. */
static void direction(double theta, double phi, float w[3][BATCH], size_t k) {
    const double radians = RADIANS;
    double sin_theta = sin(theta * radians);
    w[0][k] = (float)(sin_theta * cos(phi * radians));
    w[1][k] = (float)(sin_theta * sin(phi * radians));
    w[2][k] = (float)sin((90.0 - theta) * radians);
}

/* One mode of evaluation: how a line is read, and how a batch is evaluated and printed. */
typedef struct EvalTask {
    const char *form;                                      /* of a line */
    int count;                                             /* numbers in it */
    bool (*take)(EvalBatch *batch, const double *numbers); /* false: invalid numbers */
    void (*answer)(EvalBatch *batch, const Model *model, bool json);
} EvalTask;

static bool take_angles(EvalBatch *batch, const double *numbers) {
    direction(numbers[0], numbers[1], batch->o, batch->n);
    direction(numbers[2], numbers[3], batch->i, batch->n);
    batch->n++;
    return true;
}

static bool take_cosine(EvalBatch *batch, const double *numbers) {
    if (!(numbers[0] > 0.0 && numbers[0] <= 1.0)) return false;
    batch->o[2][batch->n++] = (float)numbers[0];
    return true;
}

/* Evaluates a batch: a lobe in arrays, with its pdf, any other model pair by pair. */
static void eval_batch(EvalBatch *batch, const Model *model) {
    if (model->kind == MODEL_LOBE) {
        WeftDirections wo = {batch->o[0], batch->o[1], batch->o[2]}, wi = {batch->i[0], batch->i[1], batch->i[2]};
        weft_eval_n(&model->lobe, batch->n, wo, wi, (WeftColors){batch->f[0], batch->f[1], batch->f[2]}, NULL);
        weft_pdf_n(&model->lobe, batch->n, wo, wi, batch->pdf, NULL);
        return;
    }
    for (size_t k = 0; k < batch->n; k++) {
        const float wo[3] = {batch->o[0][k], batch->o[1][k], batch->o[2][k]},
                    wi[1][3] = {{batch->i[0][k], batch->i[1][k], batch->i[2][k]}};
        float f[1][3];
        weft_reflection_eval(model->reflection, WEFT_PART_ALL, wo, 1, wi, f);
        for (int c = 0; c < 3; c++) batch->f[c][k] = f[0][c];
    }
}

static void answer_eval(EvalBatch *batch, const Model *model, bool as_json) {
    const bool has_pdf = model->kind == MODEL_LOBE;
    eval_batch(batch, model);
    char *text = batch->text;
    for (size_t k = 0; k < batch->n; k++) {
        float f[3] = {batch->f[0][k], batch->f[1][k], batch->f[2][k]};
        if (as_json) {
            Json json = {.stream = stdout, .compact = true};
            json_open(&json, NULL, '{');
            json_floats(&json, "f", f, 3);
            if (has_pdf) json_float(&json, "pdf", batch->pdf[k]);
            json_close(&json, '}');
            continue;
        }
        for (int c = 0; c < 3; c++) {
            text = decimal_write(text, f[c]);
            *text++ = c < 2 || has_pdf ? ' ' : '\n';
        }
        if (!has_pdf) continue;
        text = decimal_write(text, batch->pdf[k]);
        *text++ = '\n';
    }
    fwrite(batch->text, 1, (size_t)(text - batch->text), stdout);
}

static void answer_albedo(EvalBatch *batch, const Model *model, bool as_json) {
    const WeftColors colors = {batch->f[0], batch->f[1], batch->f[2]};
    if (model->kind == MODEL_LOBE) weft_albedo_n(&model->lobe, batch->n, batch->o[2], colors, NULL);
    for (size_t k = 0; model->kind != MODEL_LOBE && k < batch->n; k++) {
        float e[3];
        weft_reflection_albedo(model->reflection, WEFT_PART_ALL, batch->o[2][k], e);
        for (int c = 0; c < 3; c++) batch->f[c][k] = e[c];
    }
    char *text = batch->text;
    for (size_t k = 0; k < batch->n; k++) {
        float e[3] = {batch->f[0][k], batch->f[1][k], batch->f[2][k]};
        if (as_json) {
            Json json = {.stream = stdout, .compact = true};
            json_open(&json, NULL, '{');
            json_floats(&json, "albedo", e, 3);
            json_close(&json, '}');
            continue;
        }
        bool grey = !(e[0] < e[1] || e[0] > e[1] || e[0] < e[2] || e[0] > e[2]);
        for (int c = 0; c < (grey ? 1 : 3); c++) {
            text = decimal_write(text, e[c]);
            *text++ = c < 2 && !grey ? ' ' : '\n';
        }
    }
    fwrite(batch->text, 1, (size_t)(text - batch->text), stdout);
}

static const EvalTask task_eval = {"theta_o phi_o theta_i phi_i", 4, take_angles, answer_eval};
static const EvalTask task_albedo = {"a cosine in (0, 1]", 1, take_cosine, answer_albedo};

/* A file as it is read. */
typedef struct NumberLines {
    const char *name;
    int file;
    long long count; /* of lines so far */
    size_t used;     /* bytes in chunk */
    char chunk[CHUNK + 1];
} NumberLines;

/* Reads one line, which ends with a zero byte, into the batch. Returns 0 or an exit code. */
static int take_line(const NumberLines *lines, const char *line, size_t length, EvalBatch *batch,
                     const EvalTask *task) {
    double numbers[4];
    bool marked = lines->count == 1 && strncmp(line, "\xef\xbb\xbf", 3) == 0; /* U+FEFF, from a spreadsheet */
    if (length > LINE_MOST || strlen(line) != length)
        return report(WEFT_INPUT, "%s: line %lld: is too long or not text", lines->name, lines->count);
    if (marked) line += 3;
    const char *first = line + strspn(line, " \t\r");
    if (*first == '\0' || *first == '#') return 0;
    if (!line_numbers(line, task->count, numbers) || !task->take(batch, numbers))
        return report(WEFT_INPUT, "%s: line %lld: is not %s", lines->name, lines->count, task->form);
    return 0;
}

/* Takes the whole lines of the chunk, and evaluates whenever the batch is full and at the end. Moves the rest of the
 * chunk to its front. */
static int take_chunk(NumberLines *lines, EvalBatch *batch, const EvalTask *task, const Model *model, bool json) {
    int result = 0;
    char *line = lines->chunk, *last = lines->chunk + lines->used, *end;
    while (result == 0 && !ferror(stdout) && (end = memchr(line, '\n', (size_t)(last - line)))) {
        *end = '\0';
        lines->count++;
        result = take_line(lines, line, (size_t)(end - line), batch, task);
        line = end + 1;
        if (batch->n < BATCH) continue;
        task->answer(batch, model, json);
        batch->n = 0;
    }
    task->answer(batch, model, json);
    batch->n = 0;
    lines->used = (size_t)(last - line);
    memmove(lines->chunk, line, lines->used);
    return result;
}

/* Evaluates the lines that have arrived before it waits for more. */
static int eval_lines(NumberLines *lines, EvalBatch *batch, const EvalTask *task, const Model *model, bool json) {
    int result = 0;
    ssize_t got = 1;
    while (result == 0 && got > 0 && !ferror(stdout)) { /* a failed output is for main to report */
        do got = read(lines->file, lines->chunk + lines->used, CHUNK - lines->used);
        while (got < 0 && errno == EINTR);
        if (got < 0)
            return report(WEFT_INPUT, "%s: %s: %s", lines->name, weft_message_text(WEFT_MESSAGE_FILE_READ),
                          strerror(errno));
        lines->used += (size_t)got;
        if (got == 0 && lines->used > 0) lines->chunk[lines->used++] = '\n'; /* the last line may lack its own */
        result = take_chunk(lines, batch, task, model, json);
        if (result == 0 && !ferror(stdout) && lines->used > LINE_MOST) {
            lines->count++;
            result = take_line(lines, lines->chunk, lines->used, batch, task);
        }
        fflush(stdout);
    }
    return result;
}

/* Evaluates the lines of the file that the second operand names. */
static int eval_file(const Options *options, const Model *model) {
    int result = 0;
    const char *path = options->operand_count > 1 ? options->operands[1] : "-";
    bool piped = strcmp(path, "-") == 0;
    int file = piped ? STDIN_FILENO : open(path, O_RDONLY);
    if (file < 0)
        return report(WEFT_INPUT, "%s: %s: %s", path, weft_message_text(WEFT_MESSAGE_FILE_OPEN), strerror(errno));
    NumberLines *lines = calloc(1, sizeof *lines);
    EvalBatch *batch = calloc(1, sizeof *batch);
    if (lines && batch) {
        lines->name = piped ? "standard input" : path;
        lines->file = file;
        result = eval_lines(lines, batch, option_given(options, "--albedo") ? &task_albedo : &task_eval, model,
                            option_given(options, "--json"));
    } else {
        result = report(WEFT_RESOURCES, "%s", weft_message_text(WEFT_MESSAGE_MEMORY));
    }
    free(batch);
    free(lines);
    if (!piped) close(file);
    return result;
}

/* Returns true for the name of what is not a lobe alone: it has settings, a kind or a suffix, or is that of a
 * profile, a workflow or a preset. */
static bool names_model(const char *name) {
    static const char *const others[] = {"profile", "workflow", "preset"};
    if (strpbrk(name, ":./")) return true;
    if (kind_find(kind_of("lobe"), name) >= 0) return false;
    bool found = false;
    for (size_t k = 0; k < sizeof others / sizeof *others; k++) found |= kind_find(kind_of(others[k]), name) >= 0;
    return found;
}

static int take_model(const Options *options, Model *model) {
    const char *name = options->operands[0];
    memset(model, 0, sizeof *model);
    model->kind = MODEL_LOBE;
    if (!names_model(name)) return given_lobe(options, name, false, &model->lobe);
    if (option_given(options, "-p"))
        return report(WEFT_USAGE, "-p: is of a lobe by its name; write %.200s:KEY=VALUE,...", name);
    return model_read(name, model);
}

static int eval_run(const Options *options) {
    Model model;
    int result = take_model(options, &model);
    if (result == 0) result = eval_file(options, &model);
    model_free(&model);
    return result;
}

static const Option eval_options[] = {
    OPTION_HEADING("Options"),
    OPTION_PARAMS(""),
    OPTION_LOBES,
    OPTION_ROOT,
    OPTION_SWITCH("--albedo",
                  "read cosines in (0, 1], write the directional albedo E; of a lobe by quadrature to 1e-4"),
    OPTION_SWITCH("--json", "one JSON object a line instead of numbers"),
    OPTION_END,
};

const Verb verb_eval = {
    .name = "eval",
    .operands = "MODEL [FILE] [options]",
    .help = "evaluates a model for lines of directions",
    .operands_least = 1,
    .operands_most = 2,
    .options = eval_options,
    .notes = "Reads lines \"theta_o phi_o theta_i phi_i\" in degrees from FILE or standard input\n"
             "and writes a line \"f_r f_g f_b pdf\" for each: in 1/sr, f without the cosine.\n"
             "theta is measured from the normal, phi from the tangent; o is towards the\n"
             "viewer, i towards the light. Below the horizon all is 0. Blanks, tabs and commas\n"
             "separate; empty lines and lines that start with # are passed over. With --albedo\n"
             "a line is a cosine and the answer is E: one number, or three where the colour is\n"
             "not grey.\n\n"
             "A model is a lobe, or " MODEL_FORM ": a profile, a preset,\n"
             "a material file, a material of a scene, or a measured BRDF (.bsdf .binary .bin).\n"
             "Of what is no lobe the answer is \"f_r f_g f_b\", without a pdf, and E a sum over\n"
             "some thousand directions, exact to about 1 %.\n\n"
             "Examples\n"
             "  echo 30 0 60 180 | weft eval charlie-neubelt -p alpha=0.25\n"
             "  weft eval ggx -p alpha=0.1 -p color=1,0.8,0.3 angles.txt\n"
             "  weft eval silk -p roughness=0.3 angles.txt\n"
             "  echo 30 0 30 180 | weft eval preset:velvet\n"
             "  weft eval cook-torrance -p d=charlie -p v=neubelt -p f=none angles.txt\n"
             "  seq 0.05 0.05 1 | weft eval charlie-neubelt -p alpha=0.25 --albedo\n",
    .run = eval_run,
};
