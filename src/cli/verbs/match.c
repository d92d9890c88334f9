/* match.c - `weft match`: the parameters of one lobe, profile or material that come closest to another */
#include "cli/match/match_verb.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/path.h"
#include "cli/console/json_writer.h"
#include "cli/console/output.h"
#include "cli/console/report.h"
#include "cli/console/two_columns.h"
#include "cli/operands/each_asset.h"
#include "cli/operands/lobes.h"
#include "cli/operands/root.h"
#include "cli/verbs/verbs.h"

/* The parts that materials have, in the order of WeftPart. */
static const struct {
    int part;
    const char *name;
} parts[] = {{WEFT_PART_DIFFUSE, "diffuse"},
             {WEFT_PART_SPECULAR, "specular"},
             {WEFT_PART_SHEEN, "sheen"},
             {WEFT_PART_COAT, "coat"}};
enum { PARTS = sizeof parts / sizeof *parts };

/* One parameter or input, before and after. */
typedef struct Row {
    const char *name;
    int count; /* of numbers: 1 or 3 */
    bool free;
    float copied[3], matched[3];
} Row;

enum { ROWS_MOST = WEFT_INPUTS_MAX };

static bool same(const float *a, const float *b, int count) {
    for (int k = 0; k < count; k++)
        if (a[k] < b[k] || a[k] > b[k]) return false;
    return true;
}

static Row row_of(const char *name, int count, bool free, const float *copied, const float *matched) {
    Row row = {.name = name, .count = count, .free = free};
    memcpy(row.copied, copied, (size_t)count * sizeof *copied);
    memcpy(row.matched, matched, (size_t)count * sizeof *matched);
    return row;
}

static int lobe_rows(const WeftLobe *copied, const WeftLobe *matched, Row rows[ROWS_MOST]) {
    const WeftLobeInfo *info = weft_lobe_info(copied->lobe);
    int count = 0;
    for (int k = 0; k < info->param_count; k++)
        if (!info->params[k].choices)
            rows[count++] = row_of(info->params[k].name, 1, true, &copied->params[k], &matched->params[k]);
    rows[count++] = row_of("color", 3, true, copied->f0, matched->f0);
    if (info->traits & WEFT_LOBE_TWO_COLORS) rows[count++] = row_of("f90", 3, true, copied->f90, matched->f90);
    return count;
}

/* Lists the inputs that may change, and those that did. */
static int material_rows(const WeftMaterial *copied, const WeftMaterial *matched, Row rows[ROWS_MOST]) {
    int count = 0;
    WeftInputInfo info;
    for (int k = 0; weft_material_input_info(k, &info); k++) {
        int numbers = info.kind == WEFT_INPUT_COLOR ? 3 : 1;
        const float *a = copied->inputs[k].value, *b = matched->inputs[k].value;
        bool may = weft_match_is_free(copied, k) != 0;
        if (may || !same(a, b, numbers)) rows[count++] = row_of(info.name, numbers, may, a, b);
    }
    return count;
}

static int rows_of(const Match *match, Row rows[ROWS_MOST]) {
    return match->to.kind == MODEL_LOBE ? lobe_rows(&match->copy.lobe, &match->to.lobe, rows)
                                        : material_rows(&match->copy.material, &match->to.material, rows);
}

/* Measures the errors of the parts that `from` has; the others get -1. */
static int part_errors(const Match *match, double errors[PARTS][2]) {
    for (int k = 0; k < PARTS; k++) {
        const WeftReflection *to[2] = {match->copy.reflection, match->to.reflection};
        errors[k][0] = errors[k][1] = -1.0;
        float e[3];
        weft_reflection_albedo(match->from.reflection, parts[k].part, 0.5f, e);
        if (!match_has_parts(match) || !(e[0] + e[1] + e[2] > 0.0f)) continue;
        for (int c = 0; c < 2; c++) {
            WeftError error;
            if (weft_brdf_distance(to[c], match->from.reflection, parts[k].part, match->metric, &errors[k][c],
                                   &error) != WEFT_OK)
                return report_error(&error);
        }
    }
    return 0;
}

static const char *numbers_text(const float *values, int count, char text[64]) {
    if (count == 1 || same(values, (const float[3]){values[0], values[0], values[0]}, 3))
        snprintf(text, 64, "%.4g", (double)values[0]);
    else
        snprintf(text, 64, "%.4g,%.4g,%.4g", (double)values[0], (double)values[1], (double)values[2]);
    return text;
}

static void text_write(const Match *match, double errors[PARTS][2]) {
    Row rows[ROWS_MOST];
    char text[2][64];
    int count = rows_of(match, rows);
    print_name(match->from.words);
    printf(" as ");
    print_name(match->to.words);
    printf("\n\n  %-18s %-22s %s\n", "", "copied", "matched");
    for (int k = 0; k < count; k++)
        printf("  %-18s %-22s %s\n", rows[k].name, numbers_text(rows[k].copied, rows[k].count, text[0]),
               numbers_text(rows[k].matched, rows[k].count, text[1]));
    printf("\n  %-18s %-22.4f %.4f\n", weft_brdf_metric_name(match->metric), match->found.copied, match->found.matched);
    for (int k = 0; k < PARTS; k++)
        if (errors[k][0] >= 0.0) printf("    %-16s %-22.4f %.4f\n", parts[k].name, errors[k][0], errors[k][1]);
}

static void json_row(Json *json, const Row *row, const float *values) {
    if (row->count == 1)
        json_float(json, row->name, values[0]);
    else
        json_floats(json, row->name, values, 3);
}

static void json_side(Json *json, const char *key, const Row *rows, int count, bool matched, double error) {
    json_open(json, key, '{');
    json_number(json, "error", error);
    json_open(json, "values", '{');
    for (int k = 0; k < count; k++) json_row(json, &rows[k], matched ? rows[k].matched : rows[k].copied);
    json_close(json, '}');
    json_close(json, '}');
}

static void json_write(const Match *match, double errors[PARTS][2]) {
    Row rows[ROWS_MOST];
    Json json = {.stream = stdout};
    int count = rows_of(match, rows);
    json_open(&json, NULL, '{');
    json_text(&json, "from", match->from.words);
    json_text(&json, "to", match->to.words);
    json_text(&json, "metric", weft_brdf_metric_name(match->metric));
    json_side(&json, "copied", rows, count, false, match->found.copied);
    json_side(&json, "matched", rows, count, true, match->found.matched);
    json_open(&json, "parts", '[');
    for (int k = 0; k < PARTS; k++) {
        if (errors[k][0] < 0.0) continue;
        json_open(&json, NULL, '{');
        json_text(&json, "part", parts[k].name);
        json_number(&json, "copied", errors[k][0]);
        json_number(&json, "matched", errors[k][1]);
        json_close(&json, '}');
    }
    json_close(&json, ']');
    json_whole(&json, "evaluations", match->found.evaluations);
    json_close(&json, '}');
}

/* Writes the match as a material file, by putting it on a built-in scene, which can write it. */
static int material_write(const WeftMaterial *material, const char *path) {
    WeftError error;
    WeftScene *scene;
    WeftResult result = weft_scene_load("builtin:cloth", &scene, NULL, &error);
    if (result == WEFT_OK) result = weft_scene_put_material(scene, 0, material, &error);
    if (result == WEFT_OK) result = weft_scene_save_material(scene, 0, path, &error);
    weft_scene_free(scene);
    return result == WEFT_OK ? 0 : report_error(&error);
}

static int output_check(const Match *match) {
    const char *path = option_text(match->options, "-o");
    if (!path) return 0;
    if (path_ends(path, ".json") && match->to.kind == MODEL_LOBE)
        return report(WEFT_USAGE, "%s: a lobe is not a material; write pictures as .png", path);
    if (path_ends(path, ".json") || path_ends(path, ".png")) return output_probe_other(match->options, path);
    return report(WEFT_USAGE, "%s: a match is written as .png (pictures) or .json (a material)", path);
}

static int output_write(const Match *match) {
    const char *path = option_text(match->options, "-o");
    if (!path) return 0;
    return path_ends(path, ".png") ? match_sheet_write(match, path) : material_write(&match->to.material, path);
}

static int pair_run(Match *match) {
    double errors[PARTS][2];
    const Options *options = match->options;
    int result = match_begin(match, options->operands[0], options->operands[1]);
    if (result == 0) result = output_check(match);
    if (result == 0) result = match_search(match);
    if (result == 0) result = part_errors(match, errors);
    if (result == 0) result = output_write(match);
    if (result != 0) return result;
    if (option_given(options, "--json"))
        json_write(match, errors);
    else
        text_write(match, errors);
    return 0;
}

/* A mode of the verb: its number of operands and the options that it takes. */
typedef struct MatchMode {
    const char *option; /* the option that selects this mode; NULL: none */
    int operands;
    const char *needs;
    const char *with[5]; /* beside --json and --metric */
} MatchMode;

static const MatchMode modes[] = {{"--table", 0, "takes no names", {NULL}},
                                  {"--maps", 0, "takes no names", {NULL}},
                                  {"--to", 1, "needs an asset, a .gltf or .glb", {"--from", "-o", NULL}},
                                  {"--workflow", 1, "needs an asset, a .gltf or .glb", {"-o", NULL}},
                                  {NULL, 2, "match needs two names, FROM and TO", {"--hold", "-o", NULL}}};
enum { MODES = sizeof modes / sizeof *modes };

static bool goes_with(const MatchMode *mode, const char *option) {
    bool good = mode->option && strcmp(mode->option, option) == 0;
    for (int k = 0; mode->with[k]; k++) good |= strcmp(mode->with[k], option) == 0;
    return good;
}

/* Returns the mode that is requested; -1 after one line if the options do not go together. */
static int mode_of(const Options *options) {
    static const char *const all[] = {"--table", "--maps", "--to", "--workflow", "--from", "--hold", "-o"};
    int mode = 0;
    while (modes[mode].option && !option_given(options, modes[mode].option)) mode++;
    const char *name = modes[mode].option ? modes[mode].option : "";
    for (size_t k = 0; k < sizeof all / sizeof *all; k++)
        if (option_given(options, all[k]) && !goes_with(&modes[mode], all[k])) {
            report(WEFT_USAGE, "%s: does not go with %s", all[k], *name ? name : "FROM and TO");
            return -1;
        }
    const bool several = modes[mode].operands == 1 && options->operand_count > 1;
    if (several || options->operand_count == modes[mode].operands) return mode;
    report(WEFT_USAGE, "%s%s%s; see weft match --help", name, *name ? ": " : "", modes[mode].needs);
    return -1;
}

static bool metric_read(const Options *options, WeftBrdfMetric *metric) {
    static const char *const metrics[] = {"cosine", "log", "picture", NULL};
    int index = 0;
    if (!option_choice(options, "--metric", metrics, &index)) return false;
    *metric = (WeftBrdfMetric)index;
    return true;
}

static int asset_run(const Options *options) {
    WeftBrdfMetric metric;
    return metric_read(options, &metric) ? match_asset(options, metric) : WEFT_USAGE;
}

static int match_run(const Options *options) {
    static const EachOutput outputs[] = {{"-o", NULL}, {NULL, NULL}};
    Match match = {.options = options};
    if (!metric_read(options, &match.metric)) return WEFT_USAGE;
    int mode = mode_of(options);
    if (mode < 0) return WEFT_USAGE;
    if (option_given(options, "--table")) return match_table(options, match.metric);
    if (option_given(options, "--maps")) return match_maps(options, match.metric);
    if (modes[mode].operands == 1) return each_run(options, outputs, asset_run);
    int result = pair_run(&match);
    match_free(&match);
    return result;
}

static const Option match_options[] = {
    OPTION_HEADING("Match"),
    OPTION_TEXT("--metric", "NAME", "cosine", "what is made least: cosine, log or picture"),
    OPTION_LIST("--hold", "NAME", "a parameter or input of TO that keeps the number it was typed with"),
    OPTION_SWITCH("--table", "match every profile to every other and print what was left"),
    OPTION_SWITCH("--maps", "match every sheen lobe to every other over a sweep of its width, and print a formula "
                            "where one adds no more than 0.03 to the error"),
    OPTION_LOBES,
    OPTION_ROOT,
    OPTION_HEADING("A whole asset"),
    OPTION_TEXT("--from", "PROFILE", "khronos", "the engine it was made for"),
    OPTION_TEXT("--to", "PROFILE", NULL, "the engine it is for now: its sheens are rewritten"),
    OPTION_TEXT("--workflow", "NAME", NULL, "rewrite it for workflow metallic or specular instead"),
    OPTION_HEADING("Result"),
    OPTION_TEXT("-o", "OUT", NULL,
                "write both as pictures beside how they differ (.png), the match as a material (.json), or "
                "the asset (.glb, .gltf)"),
    OPTION_SWITCH("--json", "figures as JSON on standard output"),
    OPTION_END,
};

const Verb verb_match = {
    .name = "match",
    .operands = "FROM TO | ASSET... [options]",
    .help = "converts a model: finds the parameters closest to another model",
    .operands_least = 0,
    .operands_most = EACH_MOST,
    .options = match_options,
    .notes = "FROM and TO are " MODEL_FORM ": a lobe, an engine profile, a\n"
             "preset, a material file, a material of a scene (chair.glb:fabric); FROM may be a\n"
             "measured BRDF (.binary, .bsdf, .bin). The numbers of FROM are first copied to\n"
             "TO, then searched for what comes closest; both errors are printed.\n\n"
             "Metrics, over pairs of directions, of x = f cos\n"
             "  cosine   sum of |x_to - x_from| over sum of x_from, as a sphere shows them\n"
             "  log      the same of ln(1 + x / mean of x_from)\n"
             "  picture  mean difference of display values, 0 .. 1, of a lit sphere\n\n"
             "Several assets are converted one after another: OUT is then a folder, or {} in\n"
             "it stands for the asset's name (docs/batches.md).\n\n"
             "docs/match.md has the formulas, and what is free in TO; docs/rosetta.md the\n"
             "tables of all pairs.\n\n"
             "Examples\n"
             "  weft match charlie-neubelt:alpha=0.3 fibre -o velvet.png\n"
             "  weft match khronos:sheen_roughness=0.4 three\n"
             "  weft match cotton.binary filament-cloth --metric log -o cotton.json\n"
             "  weft match chair.glb --from khronos --to three -o chair-three.glb\n"
             "  weft match chair.glb --workflow specular -o chair-specular.glb\n"
             "  weft match assets/*.glb --to three -o 'three/{}.glb'\n",
    .run = match_run,
};
