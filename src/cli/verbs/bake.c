/* bake.c - `weft bake`: tables for engines, from the library's list of kinds, and the audit of other tables */
#include "cli/bake/bake.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/steady_clock.h"
#include "cli/console/interrupt.h"
#include "cli/console/json_writer.h"
#include "cli/console/names.h"
#include "cli/console/output.h"
#include "cli/console/report.h"
#include "cli/console/two_columns.h"
#include "cli/files/table_file.h"
#include "cli/operands/command.h"
#include "cli/operands/lobes.h"
#include "cli/operands/root.h"
#include "cli/verbs/verbs.h"

/* A bake as the command line describes it. */
typedef struct BakeVerb {
    const Options *options;
    const WeftBakeKind *kind;
    BakeCommon common;
    WeftBakeDesc desc;
    WeftLobe lobe;
    WeftBakeInfo info;
    WeftImage table;
    double seconds;
} BakeVerb;

static const WeftBakeKind *kind_of_table(const char *id) {
    char hint[96];
    Nearest nearest = {.typed = id};
    nearest_offer(&nearest, "audit");
    nearest_offer(&nearest, "fibre-model");
    nearest_offer(&nearest, "bsdf");
    nearest_offer(&nearest, "lobe");
    for (int k = 0; weft_bake_kind(k); k++) {
        if (strcmp(weft_bake_kind(k)->id, id) == 0) return weft_bake_kind(k);
        nearest_offer(&nearest, weft_bake_kind(k)->id);
    }
    report(WEFT_USAGE, "%.200s: %s%s", id, weft_message_text(WEFT_MESSAGE_BAKE_KIND),
           nearest.name ? nearest_hint(&nearest, hint, sizeof hint) : "; weft bake --help lists them");
    return NULL;
}

/* Reads a number from 1 to 65536. Returns the text after it, or NULL if there is none. */
static const char *side_read(const char *text, int *side) {
    char *end;
    long value = text[0] >= '0' && text[0] <= '9' ? strtol(text, &end, 10) : 0;
    *side = (int)value;
    return value >= 1 && value <= 65536 ? end : NULL;
}

static bool size_read(const Options *options, const WeftBakeKind *kind, WeftBakeDesc *desc) {
    const char *text = option_text(options, "--size"), *end;
    desc->width = kind->width;
    desc->height = kind->height;
    if (!text) return true;
    end = side_read(text, &desc->width);
    end = end && *end == 'x' ? side_read(end + 1, &desc->height) : NULL;
    if (end && !*end) return true;
    report(WEFT_USAGE, "--size: \"%.80s\" is not WIDTHxHEIGHT, each from 1 to 65536", text);
    return false;
}

/* Returns false after one line if one of the options, which have no effect here, is given. */
static bool none_given(const Options *options, const char *const *names, const char *where) {
    for (; *names; names++)
        if (option_given(options, *names)) {
            report(WEFT_USAGE, "%s: does not go with bake %s", *names, where);
            return false;
        }
    return true;
}

static int bake_read(const Options *options, BakeVerb *bake) {
    static const char *const others[] = {"--lobe", "--channel", "--max", "--rounds", NULL};
    static const char *const form[] = {"--axes", NULL}; /* where a kind has axes of its own */
    const WeftBakeKind *kind = kind_of_table(options->operands[0]);
    const char *lobe = options->operand_count > 1 ? options->operands[1] : NULL;
    int cursor = 0, result = 0;
    bake->options = options;
    bake->kind = kind;
    if (!kind || !none_given(options, others, kind->id) || (!kind->formed && !none_given(options, form, kind->id)) ||
        !bake_common(options, &bake->common) || !size_read(options, kind, &bake->desc))
        return WEFT_USAGE;
    if (!lobe && kind->lobe == 2)
        return report(WEFT_USAGE, "bake %s: needs a lobe: weft bake %s LOBE -o OUT", kind->id, kind->id);
    if (lobe && !kind->lobe) return report(WEFT_USAGE, "%.200s: is one operand too many for %s", lobe, kind->id);
    if (!lobe && option_given(options, "-p")) return report(WEFT_USAGE, "-p: is for a lobe, and none is given");
    if (lobe) result = bake_lobe(options, lobe, &bake->lobe);
    if (result == 0 && !option_given(options, "-o"))
        result = report(WEFT_USAGE, "bake: needs -o OUT, a .h, .png, .exr, .dds, .npy, .csv or .txt file");
    for (const char *path; result == 0 && (path = option_next(options, "-o", &cursor));)
        if (!table_suffix_check(path)) result = WEFT_USAGE;
    bake->desc.kind = kind->id;
    bake->desc.lobe = lobe ? &bake->lobe : NULL;
    bake->desc.form = bake->common.form;
    bake->desc.tolerance = bake->common.tolerance;
    bake->desc.threads = bake->common.threads;
    return result;
}

static int table_make(BakeVerb *bake) {
    WeftError error;
    const double started = clock_now(), texels = (double)bake->desc.width * bake->desc.height;
    Progress progress = progress_start_count(bake->common.quiet, "texels", texels);
    bake->desc.progress = bake_progress;
    bake->desc.user = &progress;
    const WeftLog log = bake_log(&bake->common);
    bake->desc.log = &log;
    WeftResult result = weft_bake(&bake->desc, &bake->info, &bake->table, &error);
    progress_finish(&progress);
    bake->seconds = clock_now() - started;
    if (result == WEFT_INTERRUPTED) return report(WEFT_INTERRUPTED, "interrupted; nothing was written");
    return result == WEFT_OK ? 0 : report_error(&error);
}

static void warnings(const BakeVerb *bake) {
    const WeftBakeInfo *info = &bake->info;
    if (bake->common.quiet) return;
    if (info->unmet)
        report(0, "warning: the quadrature of %lld values did not reach %g; they may be off by %.2g", info->unmet,
               bake->common.tolerance, info->error);
    if (info->beyond)
        report(0, "warning: %lld texels are beyond the range of a parameter, and hold its end", info->beyond);
}

static int files_write(const BakeVerb *bake) {
    char elements[WEFT_TABLE_FORM_TEXT], about[384];
    char *command = command_text(bake->options);
    int cursor = 0, result = command ? 0 : report(WEFT_RESOURCES, "out of memory");
    snprintf(about, sizeof about, "%s: %s%s%s; within %.2g", bake->info.words, bake->info.channels,
             bake->kind->formed ? "; " : "", bake->kind->formed ? weft_table_form_text(&bake->desc.form, elements) : "",
             bake->info.error);
    const TableFile file = {.table = &bake->table,
                            .command = command,
                            .about = about,
                            .low = bake->info.low,
                            .high = bake->info.high,
                            .scale = bake->common.scale,
                            .half = option_given(bake->options, "--half")};
    for (const char *path; command && (path = option_next(bake->options, "-o", &cursor));) {
        int one = table_write(&file, path);
        if (result == 0) result = one;
    }
    free(command);
    return result;
}

static void json_write(const BakeVerb *bake) {
    const WeftBakeInfo *info = &bake->info;
    char elements[WEFT_TABLE_FORM_TEXT];
    int cursor = 0;
    Json json = {.stream = stdout};
    json_open(&json, NULL, '{');
    json_text(&json, "kind", bake->desc.kind);
    if (bake->desc.lobe) json_text(&json, "lobe", weft_lobe_info(bake->lobe.lobe)->id);
    json_whole(&json, "width", bake->table.width);
    json_whole(&json, "height", bake->table.height);
    json_text(&json, "channels", info->channels);
    if (bake->kind->formed) json_text(&json, "axes", weft_table_form_text(&bake->desc.form, elements));
    json_number(&json, "tolerance", bake->common.tolerance);
    json_number(&json, "error", info->error);
    json_whole(&json, "unmet", info->unmet);
    json_whole(&json, "beyond", info->beyond);
    json_float(&json, "low", info->low);
    json_float(&json, "high", info->high);
    json_number(&json, "seconds", bake->seconds);
    json_open(&json, "outputs", '[');
    for (const char *path; (path = option_next(bake->options, "-o", &cursor));) json_text(&json, NULL, path);
    json_close(&json, ']');
    json_close(&json, '}');
}

static int table_run(const Options *options) {
    BakeVerb bake = {0};
    int cursor = 0, result = bake_read(options, &bake);
    for (const char *path; result == 0 && (path = option_next(options, "-o", &cursor));)
        result = output_probe(path); /* before minutes of quadrature */
    if (result != 0) return result;
    interrupt_watch();
    result = table_make(&bake);
    if (result != 0) return result;
    warnings(&bake);
    result = files_write(&bake);
    if (result == 0 && !bake.common.quiet)
        report(0, "%s: %d x %d texels in %.2f s, values %.3g to %.3g within %.2g", bake.info.words, bake.table.width,
               bake.table.height, bake.seconds, (double)bake.info.low, (double)bake.info.high, bake.info.error);
    if (result == 0 && option_given(options, "--json")) json_write(&bake);
    weft_image_free(&bake.table);
    return result;
}

static int bake_run(const Options *options) {
    static const char *const others[] = {"--size", "--half", "--rounds", NULL};
    static const char *const forms[] = {"--form", "--error", "--from", NULL};
    static const char *const tables[] = {"--size", "--half", "--axes", "--scale", "-p", "--lobe", "--json", NULL};
    static const char *const numbers[] = {"--half", "--axes", "--scale",   "--tolerance", "-p", "--rounds",
                                          "--lobe", "--max",  "--channel", "--json",      NULL};
    static const char *const sizes[] = {"--size", NULL};
    static const char *const functions[] = {"--size", "--half", "--axes",    "--scale", "--tolerance", "--rounds",
                                            "--lobe", "--max",  "--channel", "--json",  NULL};
    const char *kind = options->operands[0];
    if (strcmp(kind, "albedo") == 0 && option_given(options, "--form"))
        return none_given(options, functions, "albedo --form") ? bake_form_run(options) : WEFT_USAGE;
    if (!none_given(options, forms, kind)) return WEFT_USAGE;
    if (strcmp(kind, "fibre-model") == 0)
        return none_given(options, tables, kind) ? fibre_model_run(options) : WEFT_USAGE;
    if (strcmp(kind, "bsdf") == 0) return none_given(options, numbers, kind) ? bake_bsdf_run(options) : WEFT_USAGE;
    if (strcmp(kind, "lobe") == 0)
        return none_given(options, numbers, kind) && none_given(options, sizes, kind) ? bake_lobe_run(options)
                                                                                      : WEFT_USAGE;
    if (strcmp(kind, "audit") != 0) return table_run(options);
    return none_given(options, others, kind) ? audit_run(options) : WEFT_USAGE;
}

static void lists(void) {
    printf("\nKinds\n");
    for (int k = 0; weft_bake_kind(k); k++) {
        char name[64], help[200];
        const WeftBakeKind *kind = weft_bake_kind(k);
        snprintf(name, sizeof name, "%s%s", kind->id, kind->lobe == 2 ? " LOBE" : kind->lobe ? " [LOBE]" : "");
        snprintf(help, sizeof help, "%s [%dx%d]", kind->help, kind->width, kind->height);
        layout_entry(stdout, 26, name, help);
    }
    layout_entry(stdout, 26, "fibre-model", "the numbers of the lobe fibre, fitted to solved slabs: minutes");
    layout_entry(stdout, 26, "bsdf MODEL",
                 "a whole BRDF as a file of RGL's format, .bsdf; --size polar angles x points along each side "
                 "[as many as bring f back within 1e-3]");
    layout_entry(stdout, 26, "lobe DATA",
                 "a measured BRDF as a lobe of one's own, NAME.h, which --lobe takes, and a material of it, .json");
    layout_entry(stdout, 26, "audit FILE --lobe LOBE", "how far a table of E in FILE is off, and why");
    printf("\nAxes\n");
    for (int k = 0; weft_table_form_name(k); k++) {
        char help[160], elements[WEFT_TABLE_FORM_TEXT];
        const WeftTableForm form = weft_table_form_at(k);
        snprintf(help, sizeof help, "%s: %s", weft_table_form_text(&form, elements), weft_table_form_help(k));
        layout_entry(stdout, 26, weft_table_form_name(k), help);
    }
}

static const Option bake_options[] = {
    OPTION_HEADING("Output"),
    OPTION_LIST("-o", "OUT",
                "write OUT: .h a C array, .png 16 bit, .exr or .dds 32 bit floats, .npy, .csv or .txt; of a bsdf "
                ".bsdf, of a lobe .h and .json; of an audit the errors: .png a sheet, .exr or .npy the numbers"),
    OPTION_NUMBER("--scale", "NUMBER", NULL, 1e-6, 1e6,
                  "a .png holds the table / NUMBER, and an audit takes FILE times NUMBER [1; for values above "
                  "1 the least power of two]"),
    OPTION_SWITCH("--half", "an .exr of 16 bit floats"),
    OPTION_HEADING("Table"),
    OPTION_TEXT("--size", "WxH", NULL, "texels [what the kind has, below]"),
    OPTION_TEXT("--axes", "AXES", NULL,
                "what runs along x and y: a name, or elements, both below [gltf; of an audit what fits best]"),
    OPTION_NUMBER("--tolerance", "ERROR", "1e-4", 1e-7, 1e-1, "error budget of the quadrature, absolute"),
    OPTION_LIST("-p", "NAME=VALUE",
                "a parameter of the lobe, as `weft eval` has it; but neither the first, which is an axis, nor "
                "a color"),
    OPTION_TEXT(
        "--form", "FORM", NULL,
        "polynomial: of an albedo a short function instead of a table, .glsl .hlsl .metal .wgsl or .h [standard "
        "output]"),
    OPTION_NUMBER("--error", "ERROR", "0.01", 1e-6, 1, "the largest error of that function"),
    OPTION_NUMBER("--from", "ROUGHNESS", "0.2", 0, 0.9, "the least roughness for which it holds"),
    OPTION_WHOLE("--rounds", "COUNT", "120", 1, 1000, "of the search that makes a fibre-model"),
    OPTION_HEADING("Audit"),
    OPTION_LOBES_OR("whose E the table should hold, any: the lobe and axes it is nearest to"),
    OPTION_ROOT,
    OPTION_TEXT("--channel", "CHANNEL", NULL, "r, g, b, a or its number from 0 [the only one]"),
    OPTION_NUMBER("--max", "ERROR", "0.01", 1e-9, 1e9, "exit 1 where a texel is off by more"),
    OPTION_HEADING("Reports"),
    OPTION_WHOLE("--threads", "COUNT", "0", 0, 256, "processors to use; 0: all; no influence on the numbers"),
    OPTION_SWITCH("--quiet", "no progress, no warnings, no summary"),
    OPTION_SWITCH("--json", "figures as JSON on standard output"),
    OPTION_END,
};

const Verb verb_bake = {
    .name = "bake",
    .operands = "KIND [LOBE] -o OUT [options]",
    .help = "bakes lookup tables (LUTs) of albedo, and audits existing ones",
    .operands_least = 1,
    .operands_most = 2,
    .options = bake_options,
    .lists = lists,
    .notes = "AXES are a name or elements, comma between: first what runs along x and along\n"
             "y, of which one is cos or sqrt-cos and the other roughness or alpha (the lobe's\n"
             "first parameter itself; roughness is squared where that is called alpha). Then,\n"
             "as wished, centres (of texels) or edges (0 and 1 at the outer texels), flip-x,\n"
             "flip-y, and total: of two colours the part of f90 and the sum, where without it\n"
             "there are the parts of f0 and f90.\n\n"
             "A .h, .csv or .txt begins with the command that made it; .png and .exr keep it\n"
             "as metadata. Ctrl-C writes nothing and exits with 130. docs/bake.md explains\n"
             "the numbers.\n\n"
             "Examples\n"
             "  weft bake albedo charlie-neubelt -o charlie.h\n"
             "  weft bake albedo charlie-neubelt --form polynomial -o charlie.glsl\n"
             "  weft bake dfg charlie-neubelt --axes filament -o dfg.exr\n"
             "  weft bake albedo patry -p density=2 --size 32x32 --axes zeltner -o patry.npy\n"
             "  weft bake lobe felt.binary -o felt_measured.h -o felt.json\n"
             "  weft bake bsdf velvet -o velvet.bsdf\n"
             "  weft bake audit lut_sheen_E.png --lobe charlie-khronos -o errors.png\n"
             "  weft bake audit dfg.exr --channel b --lobe charlie-neubelt --axes filament\n",
    .run = bake_run,
};
