/* gl_tables.h - the tables of a text as one array texture */
#pragma once

#include "text/assemble/text.h"

/* Makes a texture for weft_tables in the context that is current: layer k has tables[k] in its corner. Returns 0 on
 * failure: WEFT_MESSAGE_GL_MEMORY or _GL_CONTEXT. count >= 1. Release with glDeleteTextures. */
unsigned tables_create(const TextTable *tables, int count, WeftError *error);
