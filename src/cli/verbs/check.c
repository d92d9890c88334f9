/* check.c - `weft check`: measures a lobe, an engine profile or a weave: energy, reciprocity, sampling */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "cli/console/names.h"
#include "cli/console/output.h"
#include "cli/console/report.h"
#include "cli/operands/given_lobe.h"
#include "cli/operands/lobes.h"
#include "cli/operands/model.h"
#include "cli/operands/root.h"
#include "cli/passport/passports.h"
#include "cli/verbs/verbs.h"
#include "weft/weft.h"

/* A bound on a result of a passport. One without an option always applies. */
typedef struct Bound {
    const char *option, *words;
    double most; /* if the option is not given; HUGE_VAL: none */
    double (*value)(const WeftPassport *passport);
    double slack; /* tolerance of the measurement, which the stars of the table use too */
} Bound;

static double albedo(const WeftPassport *p) { return (double)p->albedo_most; }
static double reciprocity(const WeftPassport *p) { return (double)p->reciprocity; }
static double furnace(const WeftPassport *p) { return (double)p->furnace_most; }
static double variance(const WeftPassport *p) { return (double)p->variance_worst; }
static double integral(const WeftPassport *p) { return (double)p->pdf_most; }
static double improbable(const WeftPassport *p) { return 1.0 - weft_passport_significance(p->p, p->tests); }
static double stray(const WeftPassport *p) { return p->stray; }
static double missed(const WeftPassport *p) { return (double)p->missed; }
static double beyond(const WeftPassport *p) { return (double)p->parity_beyond; }
static double swept(const WeftPassport *p) { return (double)(p->sweep_infinite + p->sweep_negative + p->sweep_below); }

static const Bound bounds[] = {
    {"--max-albedo", "the directional albedo", HUGE_VAL, albedo, 1e-3},
    {"--max-reciprocity", "the error of reciprocity", HUGE_VAL, reciprocity, 0.0},
    {"--max-furnace", "the furnace under a layer rule that conserves energy", HUGE_VAL, furnace, 1e-3},
    {"--max-variance", "the variance of the weight over the cosine's", HUGE_VAL, variance, 0.0},
    {NULL, "the number of results that are not finite, negative or from below", 0.0, swept, 0.0},
    {NULL, "the integral of the pdf", 1.002, integral, 0.0},
    {NULL, "the confidence that samples do not follow their pdf", 0.999, improbable, 0.0},
    {NULL, "the number of samples whose pdf is 0", 0.0, stray, 0.0},
    {NULL, "the albedo that sampling misses", 1e-4, missed, 0.0},
    {NULL, "the share of results in which C and GPU differ", 1e-3, beyond, 0.0},
};
enum { BOUNDS = sizeof bounds / sizeof bounds[0] };

/* A check as the command line describes it. */
typedef struct Check {
    const Options *options;
    WeftPassportDesc desc;
    WeftLobe lobe; /* desc.lobe, where there is -p */
    Model model;   /* of desc.material and desc.cloth, where that is a woven material */
    double most[BOUNDS];
    bool json, header, lines, watched;
    WeftPassport *passports;
    int count;
    bool broken;
} Check;

static void judge(Check *check, const WeftPassport *p) {
    for (int k = 0; k < BOUNDS; k++) {
        double value = bounds[k].value(p);
        if (value <= check->most[k] + bounds[k].slack) continue;
        report(WEFT_FAILED, "%s: %s is %.4g, more than %.4g", p->id, bounds[k].words, value, check->most[k]);
        check->broken = true;
    }
}

static void print(const Check *check, const WeftPassport *p) {
    if (check->header)
        passport_header(p);
    else if (check->lines)
        passport_line(p);
    else
        passport_text(p);
}

/* Makes one more passport; prints it, unless as JSON. */
static int add(Check *check, const char *id, int of) {
    WeftError error;
    WeftPassport *p = &check->passports[check->count];
    if (check->watched) fprintf(stderr, "\rchecking %s (%d of %d)\033[K", id, check->count + 1, of);
    check->desc.id = id;
    WeftResult result = weft_passport_measure(&check->desc, p, &error);
    if (check->watched) fprintf(stderr, "\r\033[K");
    if (result != WEFT_OK) return report_error(&error);
    check->count++;
    if (!check->json) print(check, p);
    fflush(stdout);
    if (!check->header) judge(check, p);
    return 0;
}

static int add_all(Check *check) {
    int lobes = weft_lobe_count(), profiles = 0, result = 0;
    while (!check->header && weft_profile_name(profiles)) profiles++;
    check->passports = calloc((size_t)lobes + (size_t)profiles, sizeof *check->passports);
    if (!check->passports) return report(WEFT_RESOURCES, "check: %s", weft_message_text(WEFT_MESSAGE_MEMORY));
    if (check->lines && !check->json && !check->header) passport_line_heading();
    for (int k = 0; k < lobes + profiles && result == 0; k++)
        result = add(check, k < lobes ? weft_lobe_info(k)->id : weft_profile_name(k - lobes), lobes + profiles);
    return result;
}

static int unknown(const char *id) {
    char hint[96];
    Nearest nearest = {.typed = id};
    for (int k = 0; k < weft_lobe_count(); k++) nearest_offer(&nearest, weft_lobe_info(k)->id);
    for (int k = 0; weft_profile_name(k); k++) nearest_offer(&nearest, weft_profile_name(k));
    return report(WEFT_USAGE, "%.200s: %s%s", id, weft_message_text(WEFT_MESSAGE_CHECK_NAME),
                  nearest.name ? nearest_hint(&nearest, hint, sizeof hint) : "; `weft models` lists them");
}

/* Returns true if id names a preset, a material file or a scene. */
static bool is_material(const char *id) {
    return strncmp(id, "preset:", 7) == 0 || kind_find(kind_of("preset"), id) >= 0 || strstr(id, ".json") ||
           strstr(id, ".glb") || strstr(id, ".gltf");
}

/* Takes a woven material. */
static int take_weave(Check *check, const char *id) {
    int result = model_read(id, &check->model);
    if (result != 0) return result;
    if (!check->model.cloth)
        return report(WEFT_USAGE, "%.200s: is a material that is not woven; check its profile or its lobes", id);
    check->desc.material = &check->model.material;
    check->desc.cloth = check->model.cloth;
    return 0;
}

static int add_one(Check *check, const char *id) {
    const bool set = option_given(check->options, "-p"), profile = kind_find(kind_of("profile"), id) >= 0,
               woven = !profile && weft_lobe_find(id) < 0 && is_material(id);
    if (!profile && !woven && weft_lobe_find(id) < 0) return unknown(id);
    if ((profile || woven) && (set || check->header))
        return report(WEFT_USAGE, "%s: is for lobes, and %s is a %s", set ? "-p" : "--header", id,
                      woven ? "material" : "profile");
    if (woven) {
        int result = take_weave(check, id);
        if (result != 0) return result;
    }
    if (set) {
        int result = given_lobe(check->options, id, true, &check->lobe);
        if (result != 0) return result;
        check->desc.lobe = &check->lobe;
    }
    check->passports = calloc(1, sizeof *check->passports);
    if (!check->passports) return report(WEFT_RESOURCES, "check: %s", weft_message_text(WEFT_MESSAGE_MEMORY));
    return add(check, id, 1);
}

static bool check_read(const Options *options, Check *check) {
    *check = (Check){.options = options,
                     .json = option_given(options, "--json"),
                     .header = option_given(options, "--header"),
                     .lines = strcmp(options->operands[0], "all") == 0,
                     .watched = isatty(STDERR_FILENO) != 0};
    check->desc.quick = option_given(options, "--quick") && !check->header;
    check->desc.no_gpu = option_given(options, "--no-gpu");
    check->desc.brief = check->header;
    for (int k = 0; k < BOUNDS; k++) {
        check->most[k] = bounds[k].most;
        if (bounds[k].option && !option_number(options, bounds[k].option, &check->most[k])) return false;
    }
    return option_integer(options, "--threads", &check->desc.threads);
}

static int page_write(const char *path, const Check *check) {
    Output output;
    int result = output_begin(&output, path);
    if (result != 0) return result;
    passports_page(output.stream, check->passports, check->count);
    return output_end(&output);
}

static int check_run(const Options *options) {
    Check check;
    if (!check_read(options, &check)) return WEFT_USAGE;
    const char *page = option_text(options, "--html");
    if (check.header && (check.json || page)) return report(WEFT_USAGE, "--header: does not go with --json or --html");
    if (check.lines && option_given(options, "-p")) return report(WEFT_USAGE, "-p: does not go with \"all\"");
    int result = page ? output_probe(page) : 0; /* before minutes of measuring */
    if (result == 0) result = check.lines ? add_all(&check) : add_one(&check, options->operands[0]);
    if (result == 0 && check.json) {
        Json json = {.stream = stdout};
        if (check.lines) json_open(&json, NULL, '[');
        for (int k = 0; k < check.count; k++) passport_json(&json, &check.passports[k]);
        if (check.lines) json_close(&json, ']');
    }
    if (result == 0 && page) result = page_write(page, &check);
    free(check.passports);
    model_free(&check.model);
    return result ? result : check.broken ? WEFT_FAILED : 0;
}

static const Option check_options[] = {
    OPTION_HEADING("Options"),
    OPTION_PARAMS("; but not the first, over which the rows of the passport run"),
    OPTION_LOBES,
    OPTION_ROOT,
    OPTION_SWITCH("--quick", "fewer rows, pairs and samples: a first look"),
    OPTION_SWITCH("--no-gpu", "do not compare with the GPU"),
    OPTION_WHOLE("--threads", "COUNT", "0", 0, 256, "processors to use; 0: all; no influence on the numbers"),
    OPTION_SWITCH("--json", "JSON instead of text; of all, an array"),
    OPTION_TEXT("--html", "FILE", NULL, "write one page with plots, which needs no other file"),
    OPTION_SWITCH("--header", "only the lines that the opening comment of the lobe's file ends with"),
    OPTION_HEADING("Bounds: exit 1 where one is broken"),
    OPTION_NUMBER("--max-albedo", "E", NULL, 0, 1e6, "of E, anywhere in its table"),
    OPTION_NUMBER("--max-reciprocity", "ERROR", NULL, 0, 1e6, "of |f(wo, wi) - f(wi, wo)| over the larger"),
    OPTION_NUMBER("--max-furnace", "E", NULL, 0, 1e6,
                  "of the furnace, under every layer rule that is to conserve energy"),
    OPTION_NUMBER("--max-variance", "RATIO", NULL, 0, 1e6,
                  "of the variance of f cos / pdf, to that of sampling by the cosine"),
    OPTION_END,
};

const Verb verb_check = {
    .name = "check",
    .operands = "LOBE|PROFILE|WEAVE|all [options]",
    .help = "validates a lobe, profile or weave: energy, reciprocity, sampling",
    .operands_least = 1,
    .operands_most = 1,
    .options = check_options,
    .notes = "The passport shows where more light comes back than arrived, whether f is\n"
             "reciprocal, what each layer rule makes of a white cloth, whether samples follow\n"
             "their pdf and how much their weights scatter, what hard directions and 16-bit\n"
             "floats do, and whether the GPU agrees. docs/check.md explains the numbers. Of\n"
             "`all`, a line each. A weave is a woven preset, material file or material of a\n"
             "scene, from afar and in its own colours.\n\n"
             "Whatever the options, the exit code is 1 too where a result is not finite, is\n"
             "negative or comes from below the horizon, where samples do not follow their pdf\n"
             "or miss more than 1e-4 of the albedo, and where more than 0.1 % of the results\n"
             "on the GPU differ.\n\n"
             "Examples\n"
             "  weft check charlie-neubelt\n"
             "  weft check charlie-neubelt --max-albedo 1\n"
             "  weft check cook-torrance -p d=charlie -p v=neubelt -p f=none\n"
             "  weft check preset:woven-denim\n"
             "  weft check all --html passports.html\n",
    .run = check_run,
};
