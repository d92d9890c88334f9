/* root.h - the folder whose files an asset may name: --root FOLDER, of every verb that reads assets */
#pragma once

#include "cli/console/options.h"

#define OPTION_ROOT                                                                                                    \
    OPTION_TEXT("--root", "FOLDER", NULL, "let an asset name files in FOLDER or below it, not in its own folder alone")

/* Opens the folder, if the verb has the option and it was given. Returns 0, or an exit code after one line. */
int root_take(const Options *options);
