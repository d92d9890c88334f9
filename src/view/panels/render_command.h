/* render_command.h - the command line that draws what the window shows */
#pragma once

#include "view/state/viewer.h"

/* Returns the command line. `unsaid` (may be NULL) receives what changes the picture and no command line can say, each a
 * line; "" if that is nothing. Release both with free; NULL where memory is short. */
char *command_line(const Viewer *v, char **unsaid);

/* Returns the command line with what it cannot say as comments, each on a line of its own. */
char *command_said(const Viewer *v);

/* Copies that text to the clipboard, and shows what the line cannot say. */
void command_copy(Viewer *v);
