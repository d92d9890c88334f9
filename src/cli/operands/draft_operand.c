#include "cli/operands/draft_operand.h"

#include <stdio.h>
#include <string.h>

#include "cli/console/options.h"
#include "cli/console/report.h"

int draft_read(const char *what, const WeftLog *log, WeftDraft **out) {
    WeftError error;
    if (weft_draft_read(what, out, log, &error) == WEFT_OK) return 0;
    if (error.message != WEFT_MESSAGE_FILE_OPEN) return report_error(&error);
    return report((int)error.result, "%s; words such as twill 2/2 need no file", error.text);
}

int draft_sett(const char *text, WeftDraft *draft) {
    double setts[2];
    WeftError error;
    if (!text) return 0;
    if (!numbers_parse(text, 2, setts)) {
        if (!numbers_parse(text, 1, setts))
            return report(WEFT_USAGE, "--sett %.40s: one or two numbers of threads per centimetre are expected", text);
        setts[WEFT_WEFT] = setts[WEFT_WARP];
    }
    for (int t = 0; t < 2; t++)
        if (weft_draft_set_sett(draft, (WeftThreads)t, (float)(100.0 * setts[t]), &error) != WEFT_OK)
            return report_error(&error);
    return 0;
}

int yarns_read(const char *text, WeftYarn yarns[2]) {
    WeftError error;
    char name[2][64];
    const char *comma = strchr(text, ',');
    const int first = comma ? (int)(comma - text) : (int)strlen(text);
    snprintf(name[0], sizeof name[0], "%.*s", first, text);
    snprintf(name[1], sizeof name[1], "%s", comma ? comma + 1 : name[0]);
    for (int t = 0; t < 2; t++)
        if (weft_yarn_find(name[t], &yarns[t], &error) != WEFT_OK) return report_error(&error);
    return 0;
}
