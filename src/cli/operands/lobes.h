/* lobes.h - lobes of the user's own: --lobe FILE.h, of every verb that names lobes */
#pragma once

#include "cli/console/options.h"

#define LOBES_HELP   "take a lobe of your own (docs/adding-a-lobe.md); it runs as native code: only one that you trust"
#define OPTION_LOBES OPTION_LIST("--lobe", "FILE.h", LOBES_HELP)

/* The option of a verb whose --lobe has another meaning too. */
#define OPTION_LOBES_OR(words) OPTION_LIST("--lobe", "LOBE|FILE.h", words "; FILE.h: " LOBES_HELP)

/* Loads every file of --lobe and removes the option, so that the verb does not see it. Returns 0, or an exit code after
 * one line on standard error. */
int lobes_take(Options *options);

/* Returns the paths of the files taken, ended by NULL. */
const char *const *lobes_taken(void);
