/* render_command.h - the command line that draws what the window shows */
#pragma once

#include "view/state/viewer.h"

/* Returns the command line. `lost` (may be NULL) is set if a painted nap or a map is not in it. Release with free; NULL
 * where memory is short. */
char *command_line(const Viewer *v, bool *lost);

/* Copies the command line to the clipboard. */
void command_copy(Viewer *v);
