/* judge.c - `weft judge`: expected values of an asset's objects, and the cause of what sets a picture of it apart */
#include <stdio.h>

#include "base/path.h"
#include "cli/console/output.h"
#include "cli/console/report.h"
#include "cli/console/two_columns.h"
#include "cli/judge/judge_verb.h"
#include "cli/operands/root.h"
#include "cli/verbs/verbs.h"
#include "weft/weft.h"

static int outputs_check(const Options *options) {
    int cursor = 0, result = 0;
    for (const char *path; result == 0 && (path = option_next(options, "-o", &cursor));)
        result = weft_image_suffix_known(path)
                     ? output_probe_other(options, path)
                     : report(WEFT_USAGE, "%s: %s", path, weft_message_text(WEFT_MESSAGE_OUTPUT_SUFFIX));
    return result;
}

/* Writes the reference: linear as 32-bit floats, else as displayed. */
static WeftResult reference_write(const JudgeRun *run, const char *path, WeftError *error) {
    const WeftImage *reference = weft_judge_reference(run->judge);
    const WeftImageWriting how = {.single = 1, .isa = weft_isa()};
    WeftImage shown = {0};
    if (weft_image_suffix_linear(path)) return weft_image_write_as(path, reference, &how, error);
    WeftResult result = weft_image_show(reference, &run->scene_options.tone, NULL, &shown, error);
    if (result == WEFT_OK) result = weft_image_write_as(path, &shown, &how, error);
    weft_image_free(&shown);
    return result;
}

static int references_write(const JudgeRun *run) {
    int cursor = 0;
    WeftError error;
    for (const char *path; (path = option_next(run->options, "-o", &cursor));)
        if (reference_write(run, path, &error) != WEFT_OK) return report_error(&error);
    return 0;
}

/* Says in one line for each picture that fails how much does, and why. */
static int verdict_code(const JudgeRun *run) {
    int code = 0;
    fflush(stdout);
    for (int k = 0; k < run->count; k++) {
        const WeftVerdict *verdict = &run->verdicts[k];
        if (!verdict->failed) continue;
        code = report(WEFT_FAILED, "%.300s: %d of %d objects are off; %s%s", run->paths[k], verdict->failed,
                      verdict->object_count, verdict->explained ? "the likely cause is " : "no cause explains it",
                      verdict->explained ? weft_judge_cause(verdict->causes[0].cause).name : "");
    }
    return code;
}

static int run_all(JudgeRun *run) {
    const Options *options = run->options;
    int result = judge_pictures_read(run, options->operands + 1, options->operand_count - 1);
    if (result == 0) result = judge_load(run);
    if (result == 0) result = judge_make(run);
    if (result == 0) result = references_write(run);
    if (result == 0) result = judge_pictures(run);
    if (result != 0) return result;
    if (option_given(options, "--json"))
        judge_json(run, stdout, NULL, 0);
    else
        judge_text(run);
    return verdict_code(run);
}

static int judge_run(const Options *options) {
    JudgeRun run = {0};
    const char *folder = option_text(options, "--write");
    if (folder && (options->operand_count || option_given(options, "-o") || option_given(options, "--json")))
        return report(WEFT_USAGE, "--write: goes with neither an asset nor -o nor --json");
    if (folder) return judge_sweeps(options, folder);
    if (!options->operand_count) return report(WEFT_USAGE, "judge: needs an ASSET, or --write DIR");
    int result = outputs_check(options);
    if (result == 0 && !judge_read(&run, options, options->operands[0])) result = WEFT_USAGE;
    if (result == 0) result = run_all(&run);
    judge_close(&run);
    return result;
}

static void causes_list(void) {
    enum { COLUMN = 24 };
    printf("\nCauses, beside every engine of `weft models profile:`\n");
    for (int k = 0; weft_judge_cause(k).name; k++) {
        const WeftCause cause = weft_judge_cause(k);
        if (cause.kind != WEFT_CAUSE_ENGINE) layout_entry(stdout, COLUMN, cause.name, cause.help);
    }
}

static const Option judge_options[] = {
    OPTION_HEADING("Reference"),
    OPTION_LIST("-o", "OUT", "write the reference: .exr, .hdr and .npy linear, .png as displayed"),
    OPTION_WHOLE("--width", "PIXELS", NULL, 1, 65536, "width of the picture [of the first PICTURE, else 640]"),
    OPTION_WHOLE("--height", "PIXELS", NULL, 1, 65536, "height of the picture [of the first PICTURE, else 480]"),
    OPTION_WHOLE("--spp", "COUNT", "64", 2, 1 << 24, "samples a pixel of the reference, and of the causes"),
    OPTION_WHOLE("--max-depth", "COUNT", "1", 1, 1000, "scattering events on a path; 1 is direct light"),
    OPTION_SWITCH("--no-shadows", "light reaches every point that faces it, as in most viewers"),
    OPTION_WHOLE("--seed", "NUMBER", "0", 0, 2147483647, "another seed, other noise"),
    OPTION_WHOLE("--threads", "COUNT", NULL, 1, WEFT_THREADS_MAX,
                 "processors to use, 1 to 256; no influence on the numbers [all]"),
    OPTION_ROOT,
    OPTION_HEADING("Judgement"),
    OPTION_NUMBER("--tolerance", "SHARE", "0.05", 1e-6, 1e3,
                  "an object fails where its mean is off by more, relative to what is expected, in any channel"),
    OPTION_NUMBER("--spread", "SHARE", "0.2", 1e-6, 1e3,
                  "or where the root of its mean squared difference is, relative to its mean"),
    OPTION_NUMBER("--explained", "SHARE", "0.75", 1e-6, 0.999999,
                  "a cause explains a picture where it leaves out this share of the squared error"),
    OPTION_SWITCH("--linear", "the values of a PICTURE of integers are linear, not sRGB"),
    LIGHT_OPTIONS,
    OPTION_HEADING("Display of a .png"),
    TONE_OPTIONS,
    ASSIGN_OPTIONS,
    OPTION_HEADING("Sweeps"),
    OPTION_TEXT("--write", "DIR", NULL,
                "write weft's own sweeps to a folder: spheres of weave, nap and measured fabric as .glb, and what is "
                "expected of them as .json"),
    OPTION_HEADING("Reports"),
    OPTION_SWITCH("--quiet", "no progress, no warnings of the scene"),
    OPTION_SWITCH("--json", "print figures on standard output as JSON"),
    OPTION_END,
};

const Verb verb_judge = {
    .name = "judge",
    .operands = "ASSET [PICTURE...] [options]",
    .help = "computes expected values of an asset; explains a wrong picture",
    .operands_least = 0,
    .operands_most = 1024,
    .options = judge_options,
    .lists = causes_list,
    .notes = "Path traces ASSET and prints the mean linear value of each object, a primitive\n"
             "of a node, without its outline. Light is what is given: --env, --light and the\n"
             "lights of the file; without any, a sun from the upper right in front,\n"
             "sun;-1,-1,-2;3.14159,3.14159,3.14159, which shows a white diffuse face as 1. The\n"
             "camera is the first of the file, else auto.\n\n"
             "Each PICTURE of the same view, in any format that weft reads, is compared with\n"
             "that. Where an object fails, the scene is rendered as every known engine does\n"
             "and with each single term left out or exchanged; the one that leaves the least\n"
             "squared error is the likely cause. .exr, .hdr and float .npy are linear, all\n"
             "else is sRGB, shown through --exposure and --tonemap.\n\n"
             "The exit code is 0 where all objects are within tolerance, 1 where one is not.\n"
             "docs/judge.md has the formulas and the list of causes.\n\n"
             "Examples\n"
             "  weft judge SheenTestGrid.glb -o expected.exr\n"
             "  weft judge SheenTestGrid.glb engine.exr --json\n"
             "  weft judge SheenTestGrid.glb screenshot.png --tonemap none --no-shadows\n"
             "  weft judge AnisotropyStrengthTest.glb engine.exr --env studio.hdr --spp 256\n"
             "  weft judge --write sweeps\n",
    .run = judge_run,
};
