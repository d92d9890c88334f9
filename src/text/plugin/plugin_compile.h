/* plugin_compile.h - a plugin (shading/catalogue/plugin.h) made of a lobe's file by the machine's C compiler */
#pragma once

#include "shading/catalogue/plugin.h"
#include "shading/catalogue/registry.h"

/* Compiles the text of a lobe, or takes from the user's cache what was made of the same text before, and
 * loads it, for as long as the program runs. path: of its file, for messages. Fails with
 * WEFT_MESSAGE_COMPILER, or with _LOBE_COMPILE and the line. */
WeftResult plugin_make(const LobeNames *names, const char *path, const char *bytes, const Plugin **out,
                       const WeftLog *log, WeftError *error);
