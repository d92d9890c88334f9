/* bake_bsdf.c - `weft bake bsdf`: any model as a file of RGL's format */
#include <stdio.h>
#include <stdlib.h>

#include "base/path.h"
#include "cli/bake/bake.h"
#include "cli/console/output.h"
#include "cli/console/report.h"
#include "cli/operands/command.h"
#include "cli/operands/model.h"

/* Reads --threads and --size, which is polar angles x points along each side. Returns 0, or an exit code after one
 * line. */
static int desc_read(const Options *options, WeftBsdfDesc *desc) {
    const char *text = option_text(options, "--size");
    char rest;
    if (!option_integer(options, "--threads", &desc->threads)) return WEFT_USAGE;
    if (text && sscanf(text, "%5dx%5d%c", &desc->thetas, &desc->side, &rest) != 2)
        return report(WEFT_USAGE, "--size: \"%.80s\" is not ANGLESxSIDE, such as 32x96", text);
    if (text && (desc->thetas == 0 || desc->side == 0)) return report(WEFT_USAGE, "--size: \"%.80s\" has a 0", text);
    return 0;
}

/* Prints how near the file comes to its model. */
static int comparison_print(const char *path, const WeftReflection *reflection) {
    WeftReflection *back;
    WeftError error;
    if (weft_reflection_read(path, &back, &error) != WEFT_OK) return report_error(&error);
    print_name(path);
    printf(": f differs by %.5f of its mean, up to 80 degrees\n", weft_reflection_distance(reflection, back));
    weft_reflection_free(back);
    return 0;
}

int bake_bsdf_run(const Options *options) {
    WeftError error;
    WeftBsdfDesc desc = {0};
    Model model = {0};
    int cursor = 0, result = desc_read(options, &desc);
    if (result == 0 && options->operand_count < 2)
        result = report(WEFT_USAGE, "bake bsdf: needs a model: weft bake bsdf MODEL -o OUT.bsdf");
    if (result == 0 && !option_given(options, "-o")) result = report(WEFT_USAGE, "bake bsdf: needs -o OUT.bsdf");
    for (const char *path; result == 0 && (path = option_next(options, "-o", &cursor));)
        result = path_ends(path, ".bsdf") ? output_probe_other(options, path)
                                          : report(WEFT_USAGE, "%.200s: a tabulated BRDF is a .bsdf", path);
    if (result == 0) result = model_read(options->operands[1], &model);
    char *command = command_text(options);
    desc.comment = command;
    cursor = 0;
    for (const char *path; result == 0 && (path = option_next(options, "-o", &cursor));)
        if (weft_reflection_write(model.reflection, path, &desc, &error) != WEFT_OK)
            result = report_error(&error);
        else
            result = comparison_print(path, model.reflection);
    free(command);
    model_free(&model);
    return result;
}
