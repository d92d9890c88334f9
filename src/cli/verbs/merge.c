/* merge.c - `weft merge`: the parts of a picture become the picture */
#include "base/path.h"
#include "cli/console/output.h"
#include "cli/console/report.h"
#include "cli/render/picture_merge.h"
#include "cli/verbs/verbs.h"
#include "weft/weft.h"

/* Tests that every -o names a supported format and a place that can be written, which no part is at. */
static int outputs_check(const Options *options) {
    int cursor = 0, result = 0;
    if (!option_given(options, "-o")) return report(WEFT_USAGE, "merge: needs -o OUT, a .png, .exr, .hdr or .npy file");
    for (const char *path; result == 0 && (path = option_next(options, "-o", &cursor));)
        result = weft_image_suffix_known(path)
                     ? output_probe_other(options, path)
                     : report(WEFT_USAGE, "%s: %s", path, weft_message_text(WEFT_MESSAGE_OUTPUT_SUFFIX));
    return result;
}

static int merge_run(const Options *options) {
    Request request = {.options = options, .engine = ENGINE_TRACE, .quiet = option_given(options, "--quiet")};
    Job job = {.request = &request, .engine = ENGINE_TRACE, .noise = -1.0};
    WeftError error = {0};
    char files[REQUEST_FILES];
    int checked = outputs_check(options);
    if (checked != 0) return checked;
    WeftResult result = picture_parts_read(options->operands, options->operand_count, &request, &job, &error);
    if (result == WEFT_OK) result = job_finish(&job, &error);
    if (result == WEFT_OK) result = job_write(&job, NULL, &error);
    if (result != WEFT_OK)
        report_error(&error);
    else if (!request.quiet && job.part.left)
        report(0, "merged %d parts of %d samples/pixel, and left %d of fewer; wrote %s",
               options->operand_count - job.part.left, job.part.spp, job.part.left,
               request_outputs_text(&request, files));
    else if (!request.quiet)
        report(0, "merged %d parts; wrote %s", options->operand_count, request_outputs_text(&request, files));
    job_free(&job);
    return (int)result;
}

static const Option merge_options[] = {
    OPTION_LIST("-o", "OUT", "write the picture: .exr, .hdr and .npy linear, .png as displayed"),
    OPTION_SWITCH("--quiet", "no summary"),
    OPTION_END,
};

const Verb verb_merge = {
    .name = "merge",
    .operands = "PART... -o OUT",
    .help = "joins the parts of a picture that several processes rendered",
    .operands_least = 1,
    .operands_most = CHUNKS_MOST,
    .options = merge_options,
    .notes = "PART is a file of weft render --chunk I/N; all N are needed, in any order. OUT\n"
             "is, byte for byte, what one process would have written with the same options,\n"
             "for whatever N. A part that is damaged, is there twice, or is of another scene,\n"
             "other options, another version or instruction set (--isa) is refused by name. Of\n"
             "parts with different --spp those with the most are merged.\n\n"
             "Examples\n"
             "  for i in 1 2 3; do weft render chair.glb --chunk $i/3 -o part-$i.exr; done\n"
             "  weft merge part-*.exr -o chair.png -o chair.exr\n",
    .run = merge_run,
};
