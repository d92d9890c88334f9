/* fit.c - `weft fit`: a measured BRDF, and the lobes that come closest to it */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/path.h"
#include "cli/console/interrupt.h"
#include "cli/console/json_writer.h"
#include "cli/console/names.h"
#include "cli/console/output.h"
#include "cli/console/progress.h"
#include "cli/console/report.h"
#include "cli/fit/fit_files.h"
#include "cli/fit/fit_sheet.h"
#include "cli/operands/lobes.h"
#include "cli/operands/model.h"
#include "cli/operands/root.h"
#include "cli/verbs/verbs.h"
#include "weft/weft.h"

typedef struct Fitting {
    const Options *options;
    const char *path, *base, *plot, *engine; /* plot, engine: NULL: not requested */
    WeftBrdfMetric metric;
    WeftData *data;
    WeftFit fit;
    Model stated;         /* --to, where that is a material */
    WeftMaterial nearest; /* the nearest material of --to, and its error */
    double error;
} Fitting;

/* Returns true if the lobe's value depends on f90; not every Fresnel term reads it. */
static bool reads_f90(const WeftLobe *lobe) {
    static const float ways[][3] = {{0.9f, 0.1f, 0.4243f}, {-0.8f, 0.2f, 0.5657f}, {0.3f, -0.6f, 0.7416f}};
    WeftLobe other = *lobe;
    bool reads = false;
    for (int c = 0; c < 3; c++) other.f90[c] = lobe->f90[c] > 0.5f ? 0.0f : 1.0f;
    for (int k = 0; k < 3; k++) {
        float is[3], would[3];
        weft_lobe_eval(lobe, ways[k], ways[(k + 1) % 3], is);
        weft_lobe_eval(&other, ways[k], ways[(k + 1) % 3], would);
        for (int c = 0; c < 3; c++) reads |= is[c] < would[c] || is[c] > would[c];
    }
    return reads;
}

/* Writes "d charlie, alpha 0.31" from `used` on; returns the new end. */
static size_t numbers_text(const WeftLobe *lobe, char *text, size_t size, size_t used) {
    const WeftLobeInfo *info = weft_lobe_info(lobe->lobe);
    for (int k = 0; k < info->param_count && used < size; k++) {
        const WeftParamInfo *p = &info->params[k];
        used += (size_t)snprintf(text + used, size - used, "%s%s ", used ? ", " : "", p->name);
        if (used < size && p->choices)
            used += (size_t)snprintf(text + used, size - used, "%s", p->choices[(int)lobe->params[k]]);
        else if (used < size)
            used += (size_t)snprintf(text + used, size - used, "%.3g", (double)lobe->params[k]);
    }
    return used;
}

/* Writes "f90 0.1,0.1,0.2" from `used` on; returns the new end. */
static size_t f90_text(const WeftLobe *lobe, char *text, size_t size, size_t used) {
    const float *c = lobe->f90;
    if (used >= size) return used;
    return used + (size_t)snprintf(text + used, size - used, "%sf90 %.3g,%.3g,%.3g", used ? ", " : "", (double)c[0],
                                   (double)c[1], (double)c[2]);
}

/* Writes all of lobe and base but their first colours: "f90 0.1,0.1,0.2, d charlie, alpha 0.31, edge 0.1". */
static const char *params_text(const WeftFitted *fitted, char *text, size_t size) {
    size_t used = 0;
    text[0] = '\0';
    if (weft_fitted_is_weave(fitted) || reads_f90(&fitted->lobe)) used = f90_text(&fitted->lobe, text, size, used);
    used = numbers_text(&fitted->lobe, text, size, used);
    if (weft_fitted_is_weave(fitted) && used < size) {
        used += (size_t)snprintf(text + used, size - used, "; weft");
        used = f90_text(&fitted->base, text, size, used);
    }
    if (used < size) numbers_text(&fitted->base, text, size, used);
    return text;
}

/* Remarks, which a row of the table may end with. */
static const struct {
    unsigned note;
    const char *words;
} notes[] = {
    {WEFT_FITTED_NOTHING, "adds nothing"},
    {WEFT_FITTED_BRIGHT, "a colour above 1"},
    {WEFT_FITTED_EDGE, "at an end of its range"},
    {WEFT_FITTED_GAINS, "reflects more than it receives"},
};
enum { NOTES = sizeof notes / sizeof *notes };

static void row_write(const char *rank, const char *name, const WeftFitted *fitted) {
    char params[512], base[64], color[64];
    snprintf(base, sizeof base, "%.3f,%.3f,%.3f", (double)fitted->base.f0[0], (double)fitted->base.f0[1],
             (double)fitted->base.f0[2]);
    snprintf(color, sizeof color, "%.3g,%.3g,%.3g", (double)fitted->lobe.f0[0], (double)fitted->lobe.f0[1],
             (double)fitted->lobe.f0[2]);
    printf("%4s  %-44s %7.4f  %7.4f  %5.3f  %7d  %-19s  %-24s %s", rank, name, fitted->error, fitted->free_error,
           (double)fitted->albedo, fitted->numbers, base, color, params_text(fitted, params, sizeof params));
    for (int k = 0; k < NOTES; k++)
        if (weft_fitted_notes(fitted) & notes[k].note) printf("  (%s)", notes[k].words);
    putchar('\n');
}

static void text_write(const Fitting *fitting) {
    const WeftFit *fit = &fitting->fit;
    int all = 0, count = weft_data_count(fitting->data, &all), better = 0, idle = 0;
    print_name(fitting->path);
    printf(": %d samples of %d; error is %s, relative; base %s\n\n", count, all, weft_brdf_metric_name(fitting->metric),
           fitting->base);
    printf("%4s  %-44s %7s  %7s  %5s  %7s  %-19s  %-24s %s\n", "", "lobe over base", "error", "free", "E", "numbers",
           "base color", "lobe color", "parameters");
    for (int k = 0; k < fit->count; k++) {
        const WeftLobeInfo *info = weft_lobe_info(fit->fitted[k].lobe.lobe);
        char rank[16], name[96];
        snprintf(rank, sizeof rank, "%d", k + 1);
        snprintf(name, sizeof name, "%s%s over %s", info->id, reads_f90(&fit->fitted[k].lobe) ? ", f90 free," : "",
                 weft_lobe_info(fit->fitted[k].base.lobe)->id);
        row_write(rank, name, &fit->fitted[k]);
        better += fit->fitted[k].error < 0.999 * fit->baseline.error; /* not ggx by another name */
        idle += (weft_fitted_notes(&fit->fitted[k]) & WEFT_FITTED_NOTHING) != 0;
    }
    row_write("", "baseline: ggx, f90 = 1, over lambert", &fit->baseline);
    printf("%4s  %-44s %7.4f\n\n", "", weft_fitted_is_weave(&fit->fitted[0]) ? "lambert alone" : "the base alone",
           fit->base_alone);
    printf("these are fits to a measurement: what they say of directions that it has not is a guess. "
           "Numbers: how "
           "many were free, three of each colour\n");
    printf("E: the most that is reflected of uniform light%s; free: the error without that bound\n",
           option_given(fitting->options, "--free") ? "" : ", which a fit keeps within 1");
    printf("%d of %d are closer than the baseline, which is ggx over lambert with f90 = 1\n", better, fit->count);
    if (fitting->engine)
        printf(fitting->stated.reflection ? "%s has an error of %.4f, %.2f times the best\n"
                                          : "the nearest that %s can do has an error of %.4f, %.2f times the best\n",
               fitting->engine, fitting->error, fitting->error / fmax(fit->fitted[0].error, 1e-9));
    if (idle) printf("%d of %d add nothing to the base: their best colour is 0\n", idle, fit->count);
}

static void json_params(Json *json, const char *key, const WeftLobe *lobe) {
    const WeftLobeInfo *info = weft_lobe_info(lobe->lobe);
    json_open(json, key, '{');
    for (int k = 0; k < info->param_count; k++)
        if (info->params[k].choices)
            json_text(json, info->params[k].name, info->params[k].choices[(int)lobe->params[k]]);
        else
            json_float(json, info->params[k].name, lobe->params[k]);
    json_close(json, '}');
}

static void json_fitted(Json *json, const char *key, const WeftFitted *fitted) {
    const WeftLobeInfo *info = weft_lobe_info(fitted->lobe.lobe);
    json_open(json, key, '{');
    json_text(json, "lobe", info->id);
    json_number(json, "error", fitted->error);
    json_number(json, "free_error", fitted->free_error);
    json_float(json, "albedo", fitted->albedo);
    json_text(json, "base", weft_lobe_info(fitted->base.lobe)->id);
    json_whole(json, "numbers", fitted->numbers);
    json_floats(json, "base_color", fitted->base.f0, 3);
    json_floats(json, "color", fitted->lobe.f0, 3);
    if (weft_fitted_is_weave(fitted) || reads_f90(&fitted->lobe)) json_floats(json, "f90", fitted->lobe.f90, 3);
    if (weft_fitted_is_weave(fitted)) json_floats(json, "base_f90", fitted->base.f90, 3);
    json_params(json, "params", &fitted->lobe);
    json_params(json, "base_params", &fitted->base);
    json_open(json, "notes", '[');
    for (int k = 0; k < NOTES; k++)
        if (weft_fitted_notes(fitted) & notes[k].note) json_text(json, NULL, notes[k].words);
    json_close(json, ']');
    json_whole(json, "evaluations", fitted->evaluations);
    json_close(json, '}');
}

static void json_write(const Fitting *fitting) {
    Json json = {.stream = stdout};
    int all = 0, count = weft_data_count(fitting->data, &all);
    json_open(&json, NULL, '{');
    json_text(&json, "data", fitting->path);
    json_whole(&json, "samples", count);
    json_whole(&json, "samples_in_file", all);
    json_text(&json, "metric", weft_brdf_metric_name(fitting->metric));
    json_text(&json, "base", fitting->base);
    json_open(&json, "ranking", '[');
    for (int k = 0; k < fitting->fit.count; k++) json_fitted(&json, NULL, &fitting->fit.fitted[k]);
    json_close(&json, ']');
    json_fitted(&json, "baseline", &fitting->fit.baseline);
    json_number(&json, "base_alone", fitting->fit.base_alone);
    if (fitting->engine) {
        json_open(&json, "to", '{');
        json_text(&json, fitting->stated.reflection ? "material" : "profile", fitting->engine);
        json_number(&json, "error", fitting->error);
        json_close(&json, '}');
    }
    json_close(&json, '}');
}

/* Returns true if the base is the weft of a cloth, whose warp is of the same lobe. */
static bool is_weave(const Fitting *fitting) {
    const WeftLobeInfo *base = weft_lobe_info(weft_lobe_find(fitting->base));
    return base && base->traits & WEFT_LOBE_SYSTEM;
}

/* Returns the number of fits, with the baseline. */
static int fits_count(const Fitting *fitting, const char *only) {
    int lobes = 0, bases = 0;
    for (int k = 0; k < weft_lobe_count(); k++) {
        unsigned traits = weft_lobe_info(k)->traits;
        bases += (traits & WEFT_LOBE_DIFFUSE) != 0;
        lobes += !(traits & (WEFT_LOBE_DIFFUSE | WEFT_LOBE_REFERENCE));
    }
    return (only || is_weave(fitting) ? 1 : lobes) * (strcmp(fitting->base, "all") == 0 ? bases : 1) + 1;
}

/* Finds the best fit that a material can express: parameters without an input stay at their defaults, and the
 * others are refitted. */
static WeftResult expressible_fit(const Fitting *fitting, WeftFit *refit, WeftMaterial *material, WeftError *error) {
    const WeftFitted *best = &fitting->fit.fitted[0];
    *refit = fitting->fit;
    if (weft_fitted_material(best, material)) return WEFT_OK;
    const WeftFitDesc desc = {.metric = fitting->metric,
                              .chosen = 1,
                              .base = weft_lobe_info(best->base.lobe)->id,
                              .only = weft_lobe_info(best->lobe.lobe)->id,
                              .free = option_given(fitting->options, "--free"),
                              .expressible = 1};
    WeftResult result = weft_fit(fitting->data, &desc, refit, error);
    if (result == WEFT_OK && weft_fitted_material(&refit->fitted[0], material))
        report(0,
               "warning: %s: a material has no inputs for all numbers of %s over %s; with those at their "
               "defaults the error is %.4f",
               fitting->path, desc.only, desc.base, refit->fitted[0].error);
    return result;
}

/* Writes the best fit that can be expressed by a material to every -o. */
static int material_write(const Fitting *fitting) {
    WeftError error;
    WeftMaterial material;
    WeftFit refit;
    WeftResult result = expressible_fit(fitting, &refit, &material, &error);
    if (result != WEFT_OK) return report_error(&error);
    if (!weft_fitted_material(&refit.fitted[0], &material))
        return report(WEFT_FAILED, "%s: no fit can be expressed by the inputs of a material", fitting->path);
    if (weft_fitted_notes(&refit.fitted[0]) & WEFT_FITTED_GAINS)
        report(0, "warning: %s: the material reflects up to %.3f times the light it receives", fitting->path,
               (double)refit.fitted[0].albedo);
    return fit_files_write(fitting->options, &material);
}

/* Measures the error of the material of --to, without fitting it. */
static int error_of_material(Fitting *fitting) {
    WeftError error;
    const WeftFitDesc desc = {.metric = fitting->metric, .chosen = 1};
    fitting->nearest = fitting->stated.material;
    WeftResult result = weft_data_distance(fitting->data, &desc, fitting->stated.reflection, &fitting->error, &error);
    return result == WEFT_OK ? 0 : report_error(&error);
}

/* Finds the nearest that the engine of --to can do, from a cloth with a grey sheen. */
static int nearest_make(Fitting *fitting) {
    static const char *const cloth[][2] = {
        {"base_color", "0.3"}, {"sheen_color", "0.3"}, {"sheen_roughness", "0.5"}, {"roughness", "0.8"}};
    WeftError error;
    WeftMatch found = {.matched = 0.0};
    const WeftFitDesc desc = {.metric = fitting->metric, .chosen = 1};
    if (fitting->stated.reflection) return error_of_material(fitting);
    weft_material_default(&fitting->nearest);
    WeftResult result = weft_material_set(&fitting->nearest, "profile", fitting->engine, NULL, &error);
    for (size_t k = 0; result == WEFT_OK && k < sizeof cloth / sizeof *cloth; k++)
        result = weft_material_set(&fitting->nearest, cloth[k][0], cloth[k][1], NULL, &error);
    if (result == WEFT_OK) result = weft_fit_material(fitting->data, &desc, &fitting->nearest, &found, &error);
    fitting->error = found.matched;
    return result == WEFT_OK ? 0 : report_error(&error);
}

static int outputs_check(Fitting *fitting) {
    fitting->plot = option_text(fitting->options, "--plot");
    fitting->engine = option_text(fitting->options, "--to");
    if (fitting->plot && !path_ends(fitting->plot, ".png"))
        return report(WEFT_USAGE, "%s: slices are written as .png", fitting->plot);
    int result = 0;
    if (fitting->engine && kind_find(kind_of("profile"), fitting->engine) <= 0)
        result = model_read(fitting->engine, &fitting->stated);
    if (result == 0 && fitting->stated.reflection && !model_is_material(&fitting->stated))
        return report(WEFT_USAGE, "--to %.200s: is neither a profile nor a material", fitting->engine);
    if (result == 0) result = fit_files_check(fitting->options);
    if (result == 0 && fitting->plot) result = output_probe_other(fitting->options, fitting->plot);
    return result;
}

/* Checks the combination of --lobe and --base. The library reports names that are no lobe. */
static int lobes_check(const Fitting *fitting) {
    const char *only = option_text(fitting->options, "--lobe");
    const WeftLobeInfo *base = weft_lobe_info(weft_lobe_find(fitting->base)),
                       *lobe = only ? weft_lobe_info(weft_lobe_find(only)) : NULL;
    const bool weave = is_weave(fitting);
    if (weave && only && strcmp(only, base->id) != 0)
        return report(WEFT_USAGE, "--base %s: is the weft; it goes with --lobe %s, the warp, alone", base->id,
                      base->id);
    if (weave && option_given(fitting->options, "-o") && !option_given(fitting->options, "--to"))
        return report(WEFT_USAGE, "--base %s: is fitted as two lobes, of which no material can be written", base->id);
    if (base && !weave && !(base->traits & WEFT_LOBE_DIFFUSE))
        return report(WEFT_USAGE, "--base %s: is not a diffuse lobe", base->id);
    if (lobe && lobe->traits & WEFT_LOBE_DIFFUSE)
        return report(WEFT_USAGE, "--lobe %s: is a diffuse lobe, which is fitted as --base alone", lobe->id);
    if (lobe && lobe->traits & WEFT_LOBE_REFERENCE)
        return report(WEFT_USAGE, "--lobe %s: is an estimate by random walks; fit fibre, which is its mean", lobe->id);
    return 0;
}

static int interrupted(const Fitting *fitting) {
    return report(WEFT_INTERRUPTED, "%s: interrupted; nothing was written", fitting->path);
}

static int fit_make(Fitting *fitting) {
    WeftError error;
    const char *only = option_text(fitting->options, "--lobe");
    interrupt_watch();
    WeftResult result = weft_data_read(fitting->path, &fitting->data, &error);
    if (result != WEFT_OK) return report_error(&error);
    if (interrupt_seen()) return interrupted(fitting);
    Progress progress = progress_start_count(false, "fits", fits_count(fitting, only));
    const WeftFitDesc desc = {.metric = fitting->metric,
                              .chosen = 1,
                              .base = fitting->base,
                              .only = only,
                              .free = option_given(fitting->options, "--free"),
                              .progress = progress_heed,
                              .user = &progress};
    result = weft_fit(fitting->data, &desc, &fitting->fit, &error);
    progress_finish(&progress);
    for (int k = 0; result == WEFT_OK && k < fitting->fit.count; k++) {
        Model found = {.kind = MODEL_LOBE, .lobe = fitting->fit.fitted[k].lobe};
        snprintf(found.name, sizeof found.name, "%s", weft_lobe_info(found.lobe.lobe)->id);
        model_warn(&found);
    }
    if (result == WEFT_INTERRUPTED) return interrupted(fitting);
    return result == WEFT_OK ? 0 : report_error(&error);
}

static int fit_run(const Options *options) {
    static const char *const metrics[] = {"cosine", "log", NULL};
    Fitting fitting = {.options = options, .path = options->operands[0]};
    int metric = 0;
    if (!option_choice(options, "--metric", metrics, &metric)) return WEFT_USAGE;
    fitting.metric = (WeftBrdfMetric)metric;
    fitting.base = option_text(options, "--base");
    int result = lobes_check(&fitting);
    if (result == 0) result = outputs_check(&fitting);
    if (result == 0) result = fit_make(&fitting);
    if (result == 0 && fitting.engine) result = nearest_make(&fitting);
    if (result == 0 && fitting.engine)
        result = fit_files_write(options, &fitting.nearest);
    else if (result == 0 && option_given(options, "-o"))
        result = material_write(&fitting);
    if (result == 0 && fitting.plot) result = fit_sheet_write(fitting.path, fitting.data, &fitting.fit, fitting.plot);
    if (result == 0 && option_given(options, "--json"))
        json_write(&fitting);
    else if (result == 0)
        text_write(&fitting);
    weft_data_free(fitting.data);
    model_free(&fitting.stated);
    return result;
}

static const Option fit_options[] = {
    OPTION_HEADING("Fit"),
    OPTION_TEXT("--metric", "NAME", "log", "what is made least: log or cosine"),
    OPTION_TEXT("--base", "LOBE|all|woven", "body",
                "the diffuse lobe below, or each of them; woven: fit warp and weft of a cloth alone"),
    OPTION_SWITCH("--free", "let base and lobe reflect more light than they receive, where that is closer"),
    OPTION_LOBES_OR("fit this lobe alone"),
    OPTION_ROOT,
    OPTION_TEXT("--to", "PROFILE", NULL,
                "find the nearest that this engine can do, too; of a preset or material file, how near it is"),
    OPTION_HEADING("Result"),
    OPTION_LIST("-o", "FILE",
                "write the best, or with --to the nearest, as a material (.json), a cloth of it (.glb, .gltf) or "
                "engine text (.glsl, .hlsl, .wgsl, .h)"),
    OPTION_SWITCH("--measured", "let a .json name DATA too, by which the path tracer then reflects"),
    OPTION_TEXT("--plot", "FILE.png", NULL, "draw slices: data, the best fit, the baseline, and how these differ"),
    OPTION_SWITCH("--json", "the ranking as JSON on standard output"),
    OPTION_END,
};

const Verb verb_fit = {
    .name = "fit",
    .operands = "DATA [options]",
    .help = "fits the lobes of the catalogue to a measured BRDF",
    .operands_least = 1,
    .operands_most = 1,
    .options = fit_options,
    .notes = "DATA is a measured BRDF in the format of MERL (.binary), RGL (.bsdf) or UTIA\n"
             "(.bin), or a table of lines\n"
             "\"theta_o, phi_o, theta_i, phi_i, r, g, b\": degrees from the normal and from the\n"
             "tangent, f in 1/sr. Lines that start with # are passed over; one line of names\n"
             "may stand above. A negative number was not measured.\n\n"
             "Every lobe of the catalogue that is no diffuse term is fitted, over a diffuse\n"
             "base: all parameters and colours of both, so that neither direction nor channel\n"
             "reflects more light than it receives. The baseline is ggx over lambert.\n"
             "The error is the sum of |g(fit) - g(data)| over that of g(data), of x = f cos:\n"
             "  log      g = ln(1 + x / mean x)\n"
             "  cosine   g = x\n"
             "With --base woven a cloth's two systems of threads, lobes woven at right angles,\n"
             "are fitted instead, to data that tell azimuths apart.\n"
             "Directions more than 80 degrees off the normal do not count. docs/fit.md\n"
             "explains more.\n\n"
             "Examples\n"
             "  weft fit red-fabric.binary --base all\n"
             "  weft fit felt.binary -o felt.json --plot felt.png\n"
             "  weft fit felt.binary --base body --lobe fabric --measured -o felt.json\n"
             "  weft fit felt.bsdf --to three -o felt.glb\n"
             "  weft fit denim.bsdf --base woven --json\n"
             "  weft fit gonio.csv --metric cosine --base eon --json\n",
    .run = fit_run,
};
