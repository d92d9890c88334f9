/* complaint.h - a driver's compiler message as one line for people */
#pragma once

#include "text/assemble/text.h"

/* Fails with WEFT_MESSAGE_GL_COMPILE and the first error of the driver's log. The subject is the file and line where
 * the error is, if the log names a line and the text (may be NULL) has its origin; else `name`, what the shader is for.
 * Lines after the end of the text are the caller's own. */
void complain(const char *name, const char *log, const Text *text, WeftError *error);
