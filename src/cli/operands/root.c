#include "cli/operands/root.h"

#include "cli/console/report.h"
#include "weft/root.h"

int root_take(const Options *options) {
    WeftError error;
    if (!option_given(options, "--root")) return 0;
    return weft_root_use(option_text(options, "--root"), &error) == WEFT_OK ? 0 : report_error(&error);
}
