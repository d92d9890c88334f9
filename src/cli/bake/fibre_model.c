/* fibre_model.c - `weft bake fibre-model`: solves and fits the coefficients of the lobe fibre, and writes them */
#include <stdlib.h>

#include "cli/bake/bake.h"
#include "cli/console/interrupt.h"
#include "cli/console/output.h"
#include "cli/console/report.h"
#include "cli/operands/command.h"

static int text_write(const char *text, const char *path) {
    Output output;
    int result = output_begin(&output, path);
    if (result != 0) return result;
    fputs(text, output.stream);
    return output_end(&output);
}

int fibre_model_run(const Options *options) {
    WeftError error;
    BakeCommon common;
    WeftFibreModelDesc desc = {0};
    int cursor = 0, result = 0;
    char *text = NULL, *command = command_text(options);
    if (!bake_common(options, &common) || !option_integer(options, "--rounds", &desc.rounds)) result = WEFT_USAGE;
    if (result == 0 && options->operand_count > 1)
        result = report(WEFT_USAGE, "%.200s: is one operand too many for fibre-model", options->operands[1]);
    if (result == 0 && !option_given(options, "-o")) result = report(WEFT_USAGE, "bake fibre-model: needs -o OUT.h");
    for (const char *path; result == 0 && (path = option_next(options, "-o", &cursor));) result = output_probe(path);
    if (result == 0) {
        Progress progress = progress_start_count(common.quiet, "steps", 1.0);
        interrupt_watch();
        desc.threads = common.threads;
        desc.progress = bake_progress;
        desc.user = &progress;
        WeftResult made = weft_bake_fibre_model(&desc, command ? command : "weft bake fibre-model", &text, &error);
        progress_finish(&progress);
        if (made == WEFT_INTERRUPTED)
            result = report(WEFT_INTERRUPTED, "interrupted; nothing was written");
        else if (made != WEFT_OK)
            result = report_error(&error);
    }
    cursor = 0;
    for (const char *path; result == 0 && (path = option_next(options, "-o", &cursor));)
        result = text_write(text, path);
    free(text);
    free(command);
    return result;
}
