#include "cli/operands/given_lobe.h"

#include <stdio.h>
#include <string.h>

#include "cli/console/names.h"
#include "cli/console/report.h"

/* Reports a warning that differs from the last one, so that the three channels of a colour cause only one. */
static void warning(void *user, WeftMessage message, const char *text) {
    WeftError *last = user;
    (void)message;
    if (strcmp(last->text, text) != 0) report(0, "warning: %s", text);
    snprintf(last->text, sizeof last->text, "%s", text);
}

static int set_param(WeftLobe *lobe, const char *text, const char *taken) {
    WeftError error, warned = {0};
    WeftLog log = {.fn = warning, .user = &warned};
    char param[64];
    const char *equals = strchr(text, '=');
    if (!equals || equals == text || (size_t)(equals - text) >= sizeof param)
        return report(WEFT_USAGE, "-p: \"%.80s\" is not name=value", text);
    snprintf(param, sizeof param, "%.*s", (int)(equals - text), text);
    if (taken && (strcmp(param, taken) == 0 || strcmp(param, "roughness") == 0))
        return report(WEFT_USAGE, "-p: the rows of the report run over %s", param);
    return weft_lobe_set(lobe, param, equals + 1, &log, &error) == WEFT_OK ? 0 : report_error(&error);
}

int given_lobe(const Options *options, const char *id, bool rows_run, WeftLobe *lobe) {
    WeftError error;
    if (kind_named(kind_of("lobe"), id) < 0) return WEFT_USAGE;
    if (weft_lobe_init(id, lobe, &error) != WEFT_OK) return report_error(&error);
    const WeftParamInfo *first = weft_lobe_info(lobe->lobe)->params;
    const char *taken = rows_run && first->name && !first->choices ? first->name : NULL;
    int cursor = 0, result = 0;
    for (const char *text; result == 0 && (text = option_next(options, "-p", &cursor));)
        result = set_param(lobe, text, taken);
    WeftLobe sharpest = *lobe; /* of the rows */
    WeftError warned = {0};
    const WeftLog log = {.fn = warning, .user = &warned};
    if (taken) sharpest.params[0] = first->low;
    if (result == 0) weft_lobe_fitted(&sharpest, id, &log);
    return result;
}
