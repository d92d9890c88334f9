/* json.h - text in JSON as jansson's values, and whether memory was short for it
 *
 * Where the buffer of a string cannot grow, jansson's parser drops characters without a word, and it clears
 * errno at every number. So its allocation is watched. */
#ifndef WEFT_BASE_JSON_H
#define WEFT_BASE_JSON_H

#include <jansson.h>
#include <stdbool.h>
#include <stddef.h>

/* json_loadb, but NULL also where memory was short, which *starved (not NULL) then says. */
json_t *json_parse(const char *text, size_t size, size_t flags, json_error_t *where, bool *starved);

#endif
