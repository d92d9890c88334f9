/* bake_common.c - the options, progress and warnings that baking and auditing share */
#include <stdint.h>

#include "cli/bake/bake.h"
#include "cli/console/interrupt.h"
#include "cli/console/report.h"
#include "cli/operands/given_lobe.h"

bool bake_common(const Options *options, BakeCommon *common) {
    WeftError error;
    const char *axes = option_text(options, "--axes");
    *common = (BakeCommon){.quiet = option_given(options, "--quiet")};
    if (axes && weft_table_form_parse(axes, &common->form, &error) != WEFT_OK) {
        report_error(&error);
        return false;
    }
    common->formed = axes != NULL;
    return option_number(options, "--tolerance", &common->tolerance) &&
           option_number(options, "--scale", &common->scale) && option_integer(options, "--threads", &common->threads);
}

int bake_lobe(const Options *options, const char *id, WeftLobe *lobe) {
    int result = given_lobe(options, id, true, lobe);
    for (int c = 0; result == 0 && c < 3; c++)
        if (lobe->f0[c] < 1.0f || lobe->f0[c] > 1.0f || lobe->f90[c] < 1.0f || lobe->f90[c] > 1.0f)
            result = report(WEFT_USAGE, "-p: a table is of the white lobe, and takes no color");
    return result;
}

int bake_progress(void *progress, double fraction) {
    progress_draw(progress, fraction);
    return interrupt_seen();
}

static void on_warning(void *user, WeftMessage message, const char *text) {
    (void)message;
    if (!((const BakeCommon *)user)->quiet) report(0, "warning: %s", text);
}

WeftLog bake_log(const BakeCommon *common) { return (WeftLog){on_warning, (void *)(uintptr_t)common}; }
