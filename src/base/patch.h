/* patch.h - JSON text after its values were edited: what was not edited stays, byte for byte */
#pragma once

#include <jansson.h>
#include <stddef.h>

/* Writes `now` as text, made from `text`, whose value is `was`. Members and elements that are equal in both
 * are copied with the blanks around them, and numbers as they were written; new ones come last in their
 * object or array, spaced like their neighbours. The text has size bytes and a zero byte. Returns NULL if
 * memory is short. Release with free(). */
char *patch_text(const char *text, size_t length, json_t *was, json_t *now, size_t *size);
