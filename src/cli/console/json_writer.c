#include "cli/console/json_writer.h"

#include <math.h>
#include <stdlib.h>

/* Returns the length in bytes, 1 to 4, of the well-formed UTF-8 sequence at s, or 0 if there is none (Unicode Standard,
 * Table 3-7). */
static int utf8_length(const unsigned char *s) {
    if (s[0] < 0x80) return 1;
    int length = s[0] >= 0xc2 && s[0] <= 0xdf ? 2 : (s[0] & 0xf0) == 0xe0 ? 3 : s[0] >= 0xf0 && s[0] <= 0xf4 ? 4 : 0;
    if (length == 0) return 0;
    unsigned char low = s[0] == 0xe0 ? 0xa0 : s[0] == 0xf0 ? 0x90 : 0x80;
    unsigned char high = s[0] == 0xed ? 0x9f : s[0] == 0xf4 ? 0x8f : 0xbf;
    if (s[1] < low || s[1] > high) return 0;
    for (int k = 2; k < length; k++)
        if ((s[k] & 0xc0) != 0x80) return 0;
    return length;
}

static void quoted(FILE *stream, const char *text) {
    const unsigned char *s = (const unsigned char *)text;
    fputc('"', stream);
    while (*s) {
        int length = utf8_length(s);
        if (length == 0)
            fputs("\\ufffd", stream);
        else if (*s == '"' || *s == '\\')
            fprintf(stream, "\\%c", *s);
        else if (*s < 0x20 || *s == 0x7f)
            fprintf(stream, "\\u%04x", *s);
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
