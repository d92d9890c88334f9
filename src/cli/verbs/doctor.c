/* doctor.c - `weft doctor`: finds faults of an asset and the engines that they affect, and repairs them */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/path.h"
#include "cli/console/interrupt.h"
#include "cli/console/json_writer.h"
#include "cli/console/output.h"
#include "cli/console/progress.h"
#include "cli/console/report.h"
#include "cli/console/two_columns.h"
#include "cli/operands/each_asset.h"
#include "cli/operands/root.h"
#include "cli/verbs/verbs.h"
#include "weft/weft.h"

enum { COLUMN = 11 };

typedef struct Visit {
    const Options *options;
    const char *path, *output; /* output: NULL without --fix */
    WeftDoctor *doctor;
    Progress progress;
    bool no_notes;
    int counts[3], fixable, left; /* left: errors and warnings, after --fix those that remain */
} Visit;

/* Writes the names of a mask's engines, "three, babylon"; "" stands for every reader of the file. */
static const char *engines_text(unsigned engines, char *text, size_t size) {
    text[0] = '\0';
    for (int k = 0; k < 32 && weft_profile_name(k); k++) {
        if (!(engines >> k & 1u)) continue;
        size_t used = strlen(text);
        snprintf(text + used, size - used, "%s%s", used ? ", " : "", weft_profile_name(k));
    }
    return text;
}

static const char *of_name(WeftFindingOf of) {
    static const char *const names[] = {"asset", "material", "mesh", "image"};
    return names[of];
}

static bool is_shown(const Visit *visit, const WeftFinding *finding) {
    return !visit->no_notes || finding->severity != WEFT_SEVERITY_NOTE;
}

static void count_all(Visit *visit) {
    for (int k = 0; k < weft_doctor_count(visit->doctor); k++) {
        const WeftFinding *finding = weft_doctor_finding(visit->doctor, k);
        visit->counts[finding->severity]++;
        visit->fixable += finding->fixable;
    }
    visit->left = visit->counts[WEFT_SEVERITY_ERROR] + visit->counts[WEFT_SEVERITY_WARNING];
}

/* Writes the repaired asset, examines it and counts what is left. */
static WeftResult fix(Visit *visit, WeftError *error) {
    WeftDoctor *repaired;
    WeftResult result = weft_doctor_fix(visit->doctor, visit->output, error);
    if (result == WEFT_OK)
        result = weft_doctor_open_watched(visit->output, progress_heed, &visit->progress, &repaired, NULL, error);
    if (result != WEFT_OK) return result;
    visit->left = 0;
    for (int k = 0; k < weft_doctor_count(repaired); k++)
        visit->left += weft_doctor_finding(repaired, k)->severity != WEFT_SEVERITY_NOTE;
    weft_doctor_close(repaired);
    return WEFT_OK;
}

/* Returns true if two findings differ only in their subject. */
static bool is_same_fault(const WeftFinding *a, const WeftFinding *b) {
    return a->kind == b->kind && a->severity == b->severity && a->of == b->of && a->fixable == b->fixable &&
           strcmp(a->words, b->words) == 0;
}

static bool is_repeated(const Visit *visit, int index) {
    for (int k = 0; k < index; k++)
        if (is_same_fault(weft_doctor_finding(visit->doctor, k), weft_doctor_finding(visit->doctor, index)))
            return true;
    return false;
}

/* Writes "A, B, C and 5 more", the other subjects of a finding; "" if there are none. */
static const char *others_text(const Visit *visit, int index, char *text, size_t size) {
    enum { NAMED = 6 };
    int others = 0;
    text[0] = '\0';
    for (int k = index + 1; k < weft_doctor_count(visit->doctor); k++) {
        const WeftFinding *other = weft_doctor_finding(visit->doctor, k);
        if (!is_same_fault(weft_doctor_finding(visit->doctor, index), other) || others++ >= NAMED) continue;
        size_t used = strlen(text);
        snprintf(text + used, size - used, "%s%.60s", used ? ", " : "", other->subject);
    }
    size_t used = strlen(text);
    if (others > NAMED) snprintf(text + used, size - used, " and %d more", others - NAMED);
    return text;
}

static void finding_text(const Visit *visit, int index) {
    const WeftFinding *finding = weft_doctor_finding(visit->doctor, index);
    char engines[160], text[800], others[500];
    engines_text(finding->engines, engines, sizeof engines);
    snprintf(text, sizeof text, "%s%s%s: %s", weft_finding_name((int)finding->kind), engines[0] ? " in " : "", engines,
             finding->words);
    layout_entry(stdout, COLUMN, weft_severity_name(finding->severity), text);
    snprintf(text, sizeof text, "%s: %s", finding->fixable ? "--fix" : "fix", finding->fix);
    if (finding->fix[0]) layout_entry(stdout, COLUMN, "", text);
    if (!others_text(visit, index, others, sizeof others)[0]) return;
    snprintf(text, sizeof text, "the same of %s", others);
    layout_entry(stdout, COLUMN, "", text);
}

static void counted(const char *word, int count, const char *more) {
    printf("%d %s%s%s", count, word, count == 1 ? "" : "s", more);
}

static void fixed_text(const Visit *visit) {
    printf("\n%d fixed in ", visit->fixable);
    print_name(visit->output);
    printf(", where %d %s left", visit->left, visit->left == 1 ? "error or warning is" : "errors and warnings are");
}

static void summary_text(const Visit *visit) {
    const int *counts = visit->counts;
    int all = counts[0] + counts[1] + counts[2];
    if (!all) {
        printf("\nnothing found\n");
        return;
    }
    printf("\n");
    counted("error", counts[WEFT_SEVERITY_ERROR], ", ");
    counted("warning", counts[WEFT_SEVERITY_WARNING], ", ");
    counted("note", counts[WEFT_SEVERITY_NOTE], "");
    if (visit->output)
        fixed_text(visit);
    else if (visit->fixable)
        printf("; --fix -o FILE repairs %d", visit->fixable);
    printf("\n");
}

static void text_write(const Visit *visit) {
    WeftDoctorInfo info = weft_doctor_info(visit->doctor);
    const WeftFinding *before = NULL;
    print_name(visit->path);
    printf(": ");
    counted("material", info.material_count, "");
    printf(" (%d with a sheen), %d mesh%s, ", info.sheen_count, info.mesh_count, info.mesh_count == 1 ? "" : "es");
    counted("image", info.image_count, "\n");
    for (int k = 0; k < weft_doctor_count(visit->doctor); k++) {
        const WeftFinding *finding = weft_doctor_finding(visit->doctor, k);
        if (!is_shown(visit, finding) || is_repeated(visit, k)) continue;
        if (!before || before->of != finding->of || before->index != finding->index) {
            printf("\n%s", of_name(finding->of));
            if (finding->of != WEFT_OF_ASSET) printf(" %s", finding->subject);
            printf("\n");
        }
        finding_text(visit, k);
        before = finding;
    }
    summary_text(visit);
}

static void finding_json(Json *json, const WeftFinding *finding) {
    json_open(json, NULL, '{');
    json_text(json, "id", weft_finding_name((int)finding->kind));
    json_text(json, "severity", weft_severity_name(finding->severity));
    json_text(json, "of", of_name(finding->of));
    json_whole(json, "index", finding->index);
    json_text(json, "subject", finding->subject);
    json_text(json, "place", finding->place);
    json_open(json, "engines", '[');
    for (int k = 0; k < 32 && weft_profile_name(k); k++)
        if (finding->engines >> k & 1u) json_text(json, NULL, weft_profile_name(k));
    json_close(json, ']');
    json_text(json, "words", finding->words);
    json_text(json, "fix", finding->fix);
    json_bool(json, "fixable", finding->fixable);
    if (!isnan(finding->figure)) json_number(json, "figure", finding->figure);
    json_close(json, '}');
}

static void json_write(const Visit *visit) {
    WeftDoctorInfo info = weft_doctor_info(visit->doctor);
    Json json = {.stream = stdout};
    json_open(&json, NULL, '{');
    json_text(&json, "asset", visit->path);
    json_whole(&json, "materials", info.material_count);
    json_whole(&json, "sheens", info.sheen_count);
    json_whole(&json, "meshes", info.mesh_count);
    json_whole(&json, "images", info.image_count);
    json_whole(&json, "errors", visit->counts[WEFT_SEVERITY_ERROR]);
    json_whole(&json, "warnings", visit->counts[WEFT_SEVERITY_WARNING]);
    json_whole(&json, "notes", visit->counts[WEFT_SEVERITY_NOTE]);
    if (visit->output) json_text(&json, "fixed", visit->output);
    json_whole(&json, "left", visit->left);
    json_open(&json, "findings", '[');
    for (int k = 0; k < weft_doctor_count(visit->doctor); k++) {
        const WeftFinding *finding = weft_doctor_finding(visit->doctor, k);
        if (is_shown(visit, finding)) finding_json(&json, finding);
    }
    json_close(&json, ']');
    json_close(&json, '}');
}

/* Prints the catalogue of findings. */
static void list_print(void) {
    printf("\nFindings; * where --fix can repair it\n");
    for (int k = 0; k < WEFT_FINDING_COUNT; k++) {
        char text[200];
        snprintf(text, sizeof text, "%-7s %s %s", weft_severity_name(weft_finding_severity(k)),
                 weft_finding_fixable(k) ? "*" : "-", weft_finding_help(k));
        layout_entry(stdout, 26, weft_finding_name(k), text);
    }
}

static int list_json(void) {
    Json json = {.stream = stdout};
    json_open(&json, NULL, '[');
    for (int k = 0; k < WEFT_FINDING_COUNT; k++) {
        json_open(&json, NULL, '{');
        json_text(&json, "id", weft_finding_name(k));
        json_text(&json, "severity", weft_severity_name(weft_finding_severity(k)));
        json_bool(&json, "fixable", weft_finding_fixable(k));
        json_text(&json, "help", weft_finding_help(k));
        json_close(&json, '}');
    }
    json_close(&json, ']');
    return 0;
}

static int output_check(const Visit *visit) {
    bool fix = option_given(visit->options, "--fix");
    if (fix && !visit->output) return report(WEFT_USAGE, "--fix: needs a file to write: -o FILE");
    if (!fix && visit->output) return report(WEFT_USAGE, "-o: goes with --fix alone");
    if (!visit->output) return 0;
    if (!path_ends(visit->output, ".gltf") && !path_ends(visit->output, ".glb"))
        return report(WEFT_USAGE, "-o: \"%.200s\" is not a .gltf or .glb file", visit->output);
    return output_probe(visit->output);
}

/* Examines the asset, and repairs it with --fix. */
static int examine(Visit *visit) {
    WeftError error;
    visit->progress = progress_start_count(false, "of the materials and meshes", 0.0);
    interrupt_watch();
    WeftResult result =
        weft_doctor_open_watched(visit->path, progress_heed, &visit->progress, &visit->doctor, NULL, &error);
    if (result == WEFT_OK) {
        count_all(visit);
        if (visit->output) result = fix(visit, &error);
    }
    progress_finish(&visit->progress);
    if (result == WEFT_INTERRUPTED) return report(WEFT_INTERRUPTED, "%s: interrupted", visit->path);
    return result == WEFT_OK ? 0 : report_error(&error);
}

static int visit_make(Visit *visit) {
    int result = output_check(visit);
    if (result != 0) return result;
    if (path_builtin(visit->path))
        return report(WEFT_INPUT, "%s: has no file; weft render %s --save FILE.glb makes one", visit->path,
                      visit->path);
    if (path_is_cloth(visit->path) && !path_is_u3m(visit->path))
        return report(WEFT_INPUT,
                      "%s: is a material of MaterialX and no glTF; weft render %s says what of it is not shown",
                      visit->path, visit->path);
    if (path_is_u3m(visit->path) && visit->output)
        return report(WEFT_USAGE, "--fix: %s is a U3M, which is examined and not repaired", visit->path);
    result = examine(visit);
    if (result != 0) return result;
    if (option_given(visit->options, "--json"))
        json_write(visit);
    else
        text_write(visit);
    return visit->left ? WEFT_FAILED : 0;
}

static int asset_run(const Options *options) {
    Visit visit = {.options = options,
                   .output = option_text(options, "-o"),
                   .no_notes = option_given(options, "--no-notes"),
                   .path = options->operand_count ? options->operands[0] : NULL};
    if (option_given(options, "--list")) {
        if (visit.path) return report(WEFT_USAGE, "--list: takes no asset");
        if (option_given(options, "--json")) return list_json();
        list_print();
        return 0;
    }
    if (!visit.path) return report(WEFT_USAGE, "doctor: lacks an operand; weft doctor ASSET... [options]");
    int result = visit_make(&visit);
    weft_doctor_close(visit.doctor);
    return result;
}

static int doctor_run(const Options *options) {
    static const EachOutput outputs[] = {{"-o", NULL}, {NULL, NULL}};
    return each_run(options, outputs, asset_run);
}

static const Option doctor_options[] = {
    OPTION_HEADING("Options"),
    OPTION_SWITCH("--fix", "write the asset with what can be fixed fixed, and nothing else changed"),
    OPTION_TEXT("-o", "FILE", NULL, "where --fix writes: a .gltf or a .glb; it may be ASSET itself"),
    OPTION_ROOT,
    OPTION_SWITCH("--no-notes", "errors and warnings alone"),
    OPTION_SWITCH("--json", "findings as JSON on standard output"),
    OPTION_SWITCH("--list", "print the findings that there are, and end"),
    OPTION_END,
};

const Verb verb_doctor = {
    .name = "doctor",
    .operands = "ASSET... [options]",
    .help = "validates (lints) a cloth asset for each engine, and repairs it",
    .operands_least = 0,
    .operands_most = EACH_MOST,
    .options = doctor_options,
    .lists = list_print,
    .notes = "ASSET is a .gltf or .glb file, or a material .u3m or .u3ma. It is examined as it\n"
             "is, before anything is clamped or repaired; what is said of light is measured on\n"
             "the lobes of the engine profiles. An error breaks glTF or shows nothing of what\n"
             "is there, a warning looks wrong in some engine, a note looks otherwise than one\n"
             "may think. docs/doctor.md has each.\n\n"
             "Several assets are examined one after another, and FILE is then a folder, or\n"
             "{} in it stands for the asset's name (docs/batches.md).\n\n"
             "Exit 0: no errors and warnings, or --fix left none; 1: there are some.\n\n"
             "Examples\n"
             "  weft doctor chair.gltf\n"
             "  weft doctor chair.gltf --fix -o mended.glb\n"
             "  weft doctor chair.gltf --no-notes --json\n"
             "  weft doctor assets/*.glb --fix -o mended/\n",
    .run = doctor_run,
};
