/* json_writer.h - writing one JSON value to a stream
 *
 * Keys are NULL inside arrays and at the top. Texts may contain any bytes; those that are not UTF-8 become U+FFFD.
 * Infinities and NaN become null. */
#pragma once

#include <stdbool.h>
#include <stdio.h>

/* Zero-initialise all but the stream. compact: on one line. */
typedef struct Json {
    FILE *stream;
    bool compact;
    bool follows; /* the next value needs a comma before it */
    int depth;
} Json;

/* Writes a bracket: json_open takes '{' or '[', json_close '}' or ']'. A newline follows the outermost bracket. */
void json_open(Json *json, const char *key, char bracket);
void json_close(Json *json, char bracket);

void json_text(Json *json, const char *key, const char *text);
void json_bool(Json *json, const char *key, bool value);
void json_whole(Json *json, const char *key, long long value);

/* Writes value with nine significant digits. */
void json_number(Json *json, const char *key, double value);

/* Writes the fewest digits that read back as the same float; json_floats writes an array. */
void json_float(Json *json, const char *key, float value);
void json_floats(Json *json, const char *key, const float *values, int count);
