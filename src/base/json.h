/* json.h - parsing of JSON with jansson that detects a shortage of memory, and floats as JSON has them
 *
 * If the buffer of a string cannot grow, jansson's parser drops characters silently, and it clears errno at every
 * number. Therefore its allocations are watched. */
#pragma once

#include <jansson.h>
#include <stdbool.h>
#include <stddef.h>

/* Parses as json_loadb does, but returns NULL with *starved = true if memory was short. starved must not be NULL. */
json_t *json_parse(const char *text, size_t size, size_t flags, json_error_t *where, bool *starved);

/* Returns the real whose shortest decimal is read as this float; NULL if memory is short or it is not finite. */
json_t *json_of_float(float value);

/* Writes ", not VALUE" for messages, cut short where the value is long; "" for NULL. Returns text. */
enum { JSON_SHOWN = 48 };
const char *json_but(const json_t *value, char text[JSON_SHOWN]);
