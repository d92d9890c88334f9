/* eval.c - `weft eval`: numbers of one lobe, a line in, a line out */
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "json.h"
#include "names.h"
#include "report.h"
#include "verbs.h"
#include "weft/weft.h"

enum { LINE_SIZE = 4096, STREAM_BUFFER = 1 << 20 };

/* Exactly count finite numbers separated by blanks and tabs, with at most one comma among them. */
static bool line_numbers(const char *text, int count, double *numbers) {
    for (int k = 0; k < count; k++) {
        char *end;
        text += strspn(text, " \t");
        if (k && *text == ',') text += 1 + strspn(text + 1, " \t");
        numbers[k] = strtod(text, &end);
        if (end == text || !isfinite(numbers[k]) || !strchr(" \t,\r\n", *end)) return false;
        text = end;
    }
    return text[strspn(text, " \t\r\n")] == '\0';
}

/* Unit direction from degrees. The cosine is the sine of the rest to 90, so that it is exactly 0 there. */
static void direction(double theta, double phi, float w[3]) {
    const double radians = 3.14159265358979323846 / 180.0;
    double sin_theta = sin(theta * radians);
    w[0] = (float)(sin_theta * cos(phi * radians));
    w[1] = (float)(sin_theta * sin(phi * radians));
    w[2] = (float)sin((90.0 - theta) * radians);
}

/* One line's work: numbers in, a line out. */
typedef struct Task {
    const char *form; /* of the input line */
    int count;        /* numbers in it */
    bool (*valid)(const double *numbers);
    void (*run)(const WeftLobe *lobe, const double *numbers, bool json);
} Task;

static bool any(const double *numbers) { return numbers != NULL; }
static bool is_cosine(const double *numbers) { return numbers[0] > 0.0 && numbers[0] <= 1.0; }

static void run_eval(const WeftLobe *lobe, const double *numbers, bool as_json) {
    float wo[3], wi[3], f[3];
    direction(numbers[0], numbers[1], wo);
    direction(numbers[2], numbers[3], wi);
    weft_lobe_eval(lobe, wo, wi, f);
    float pdf = weft_lobe_pdf(lobe, wo, wi);
    if (!as_json) {
        printf("%.9g %.9g %.9g %.9g\n", (double)f[0], (double)f[1], (double)f[2], (double)pdf);
        return;
    }
    Json json = {.stream = stdout, .compact = true};
    json_open(&json, NULL, '{');
    json_floats(&json, "f", f, 3);
    json_float(&json, "pdf", pdf);
    json_close(&json, '}');
}

static void run_albedo(const WeftLobe *lobe, const double *numbers, bool as_json) {
    float e[3];
    weft_lobe_albedo(lobe, (float)numbers[0], e);
    if (as_json) {
        Json json = {.stream = stdout, .compact = true};
        json_open(&json, NULL, '{');
        json_floats(&json, "albedo", e, 3);
        json_close(&json, '}');
    } else if (!(e[0] < e[1] || e[0] > e[1] || e[0] < e[2] || e[0] > e[2])) {
        printf("%.9g\n", (double)e[0]);
    } else {
        printf("%.9g %.9g %.9g\n", (double)e[0], (double)e[1], (double)e[2]);
    }
}

static const Task task_eval = {"theta_o phi_o theta_i phi_i", 4, any, run_eval};
static const Task task_albedo = {"a cosine in (0, 1]", 1, is_cosine, run_albedo};

static int eval_lines(FILE *stream, const char *name, const Task *task, const WeftLobe *lobe, bool json) {
    char line[LINE_SIZE];
    double numbers[4];
    for (long long k = 1; fgets(line, sizeof line, stream); k++) {
        if (!strchr(line, '\n') && !feof(stream))
            return report(WEFT_INPUT, "%s: line %lld: is too long or not text", name, k);
        const char *first = line + strspn(line, " \t\r\n");
        if (*first == '\0' || *first == '#') continue;
        if (!line_numbers(line, task->count, numbers) || !task->valid(numbers))
            return report(WEFT_INPUT, "%s: line %lld: is not %s", name, k, task->form);
        task->run(lobe, numbers, json);
        if (ferror(stdout)) return 0; /* main reports it */
    }
    if (ferror(stream))
        return report(WEFT_INPUT, "%s: %s: %s", name, weft_message_text(WEFT_MESSAGE_FILE_READ),
                      strerror(errno));
    return 0;
}

static void warning(void *user, WeftMessage message, const char *text) {
    (void)user;
    (void)message;
    report(0, "warning: %s", text);
}

/* The lobe with every -p name=value. */
static int lobe_make(const Options *options, WeftLobe *lobe) {
    WeftError error;
    WeftLog log = {.fn = warning};
    if (kind_named(kind_of("lobe"), options->operands[0]) < 0) return WEFT_USAGE;
    if (weft_lobe_create(options->operands[0], lobe, &error) != WEFT_OK) return report_error(&error);
    int cursor = 0;
    for (const char *text; (text = option_next(options, "-p", &cursor));) {
        char param[64];
        const char *equals = strchr(text, '=');
        if (!equals || equals == text || (size_t)(equals - text) >= sizeof param)
            return report(WEFT_USAGE, "-p: \"%.80s\" is not name=value", text);
        snprintf(param, sizeof param, "%.*s", (int)(equals - text), text);
        if (weft_lobe_set(lobe, param, equals + 1, &log, &error) != WEFT_OK) return report_error(&error);
    }
    return 0;
}

static int eval_run(const Options *options) {
    WeftLobe lobe;
    int result = lobe_make(options, &lobe);
    if (result != 0) return result;
    const char *path = options->operand_count > 1 ? options->operands[1] : "-";
    bool piped = strcmp(path, "-") == 0;
    FILE *stream = piped ? stdin : fopen(path, "r");
    if (!stream)
        return report(WEFT_INPUT, "%s: %s: %s", path, weft_message_text(WEFT_MESSAGE_FILE_OPEN),
                      strerror(errno));
    setvbuf(stream, NULL, _IOFBF, STREAM_BUFFER);
    result = eval_lines(stream, piped ? "standard input" : path,
                        option_given(options, "--albedo") ? &task_albedo : &task_eval, &lobe,
                        option_given(options, "--json"));
    if (!piped) fclose(stream);
    return result;
}

static const Option eval_options[] = {
    OPTION_HEADING("Options"),
    OPTION_LIST(
        "-p", "NAME=VALUE",
        "a parameter of the lobe, a number or, where it is a choice, an id; color=r,g,b or f90=r,g,b"),
    OPTION_SWITCH("--albedo", "read cosines in (0, 1], write the directional albedo E by quadrature to 1e-4"),
    OPTION_SWITCH("--json", "one JSON object a line instead of numbers"),
    OPTION_END,
};

const Verb verb_eval = {
    .name = "eval",
    .operands = "LOBE [FILE] [options]",
    .help = "evaluates a lobe for lines of directions",
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
             "Examples\n"
             "  echo 30 0 60 180 | weft eval charlie-neubelt -p alpha=0.25\n"
             "  weft eval ggx -p alpha=0.1 -p color=1,0.8,0.3 angles.txt\n"
             "  weft eval cook-torrance -p d=charlie -p v=neubelt -p f=none angles.txt\n"
             "  seq 0.05 0.05 1 | weft eval charlie-neubelt -p alpha=0.25 --albedo\n",
    .run = eval_run,
};
