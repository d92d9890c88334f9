#include "cli/console/json_writer.h"

#include <math.h>
#include <stdlib.h>

#include "base/printable.h"

/* Writes a text in quotes. What a terminal would obey is escaped; a character beyond U+FFFF takes two escapes. */
static void quoted(FILE *stream, const char *text) {
    const unsigned char *s = (const unsigned char *)text;
    unsigned code;
    fputc('"', stream);
    while (*s) {
        const int length = utf8_read(s, &code);
        if (length == 0)
            fputs("\\ufffd", stream);
        else if (*s == '"' || *s == '\\')
            fprintf(stream, "\\%c", *s);
        else if (is_unprintable(code) && code > 0xffff)
            fprintf(stream, "\\u%04x\\u%04x", 0xd7c0 + (code >> 10), 0xdc00 + (code & 0x3ff));
        else if (is_unprintable(code))
            fprintf(stream, "\\u%04x", code);
        else
            fwrite(s, 1, (size_t)length, stream);
        s += length ? length : 1;
    }
    fputc('"', stream);
}

static void new_line(Json *json) {
    if (!json->compact) fprintf(json->stream, "\n%*s", 2 * json->depth, "");
}

/* Writes the comma, line break and key before a value. */
static void lead(Json *json, const char *key) {
    if (json->follows) fputs(json->compact ? ", " : ",", json->stream);
    if (json->depth > 0) new_line(json);
    if (key) {
        quoted(json->stream, key);
        fputs(": ", json->stream);
    }
    json->follows = true;
}

void json_open(Json *json, const char *key, char bracket) {
    lead(json, key);
    fputc(bracket, json->stream);
    json->depth++;
    json->follows = false;
}

void json_close(Json *json, char bracket) {
    json->depth--;
    if (json->follows) new_line(json);
    fputc(bracket, json->stream);
    json->follows = json->depth > 0;
    if (json->depth == 0) fputc('\n', json->stream);
}

void json_text(Json *json, const char *key, const char *text) {
    lead(json, key);
    quoted(json->stream, text);
}

void json_bool(Json *json, const char *key, bool value) {
    lead(json, key);
    fputs(value ? "true" : "false", json->stream);
}

void json_whole(Json *json, const char *key, long long value) {
    lead(json, key);
    fprintf(json->stream, "%lld", value);
}

void json_number(Json *json, const char *key, double value) {
    lead(json, key);
    if (isfinite(value))
        fprintf(json->stream, "%.9g", value);
    else
        fputs("null", json->stream);
}

static void shortest(FILE *stream, float value) {
    char text[32] = "null";
    for (int digits = 6; digits <= 9 && isfinite(value); digits++) {
        snprintf(text, sizeof text, "%.*g", digits, (double)value);
        float back = strtof(text, NULL);
        if (!(back < value || back > value)) break;
    }
    fputs(text, stream);
}

void json_float(Json *json, const char *key, float value) {
    lead(json, key);
    shortest(json->stream, value);
}

void json_floats(Json *json, const char *key, const float *values, int count) {
    lead(json, key);
    fputc('[', json->stream);
    for (int k = 0; k < count; k++) {
        if (k) fputs(", ", json->stream);
        shortest(json->stream, values[k]);
    }
    fputc(']', json->stream);
}
