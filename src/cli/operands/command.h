/* command.h - the command line as text that a shell reads */
#pragma once

#include "cli/console/options.h"

/* Returns "weft VERB ..." on one line, with quotes where a shell needs them; control characters become '?'. Release
 * with free; NULL where memory is short. */
char *command_text(const Options *options);

/* Returns a word as a shell reads it, in quotes if it needs them. Release with free; NULL where memory is short. */
char *command_word(const char *word);

/* Returns the options given that assign materials and add lights, as they could be typed; else as above. */
char *command_assign_text(const Options *options);
