/* given_lobe.h - a lobe as the command line gives it: an id and its -p name=value */
#pragma once

#include "cli/console/options.h"
#include "weft/lobe.h"

#define OPTION_PARAMS(more)                                                                                            \
    OPTION_LIST("-p", "NAME=VALUE",                                                                                    \
                "a parameter of the lobe, a number or, where it is a choice, an id; color=r,g,b or "                   \
                "f90=r,g,b" more)

/* Reads the lobe `id` with every -p. If rows_run, the first parameter must not be given, since the rows of a report
 * vary it. Returns 0, or an exit code after one line on standard error. */
int given_lobe(const Options *options, const char *id, bool rows_run, WeftLobe *lobe);
