#include "measure/fit/brdf_table.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "base/fail.h"
#include "base/mark.h"
#include "base/memory.h"
#include "base/number.h"
#include "base/pi.h"

enum { NUMBERS = 7, LINE_MOST = 400 };

/* Returns a direction from degrees. The cosine is computed as the sine of 90 - theta, so that it is exactly 0 at 90. */
static void direction(double theta, double phi, float w[3]) {
    const double radians = RADIANS;
    w[0] = (float)(sin(theta * radians) * cos(phi * radians));
    w[1] = (float)(sin(theta * radians) * sin(phi * radians));
    w[2] = (float)sin((90.0 - theta) * radians);
}

/* Returns the count of numbers in a line, of which the first seven are kept. *rest is the text that is no
 * number, or NULL. */
static int line_numbers(const char *line, float numbers[NUMBERS], const char **rest) {
    int count = 0;
    for (*rest = NULL;;) {
        line += strspn(line, " \t\r");
        if (count && (*line == ',' || *line == ';')) line += 1 + strspn(line + 1, " \t\r");
        if (!*line) return count;
        float number;
        const char *after = number_prefix(line, &number);
        if (!after || !strchr(" \t\r,;", *after)) {
            *rest = line;
            return count;
        }
        line = after;
        if (count < NUMBERS) numbers[count] = number;
        count++;
    }
}

/* Returns true if a line has names, which may be above the numbers. */
static bool is_header(const char *line) {
    return strchr("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ_\"", line[strspn(line, " \t\r")]) != NULL;
}

static WeftResult refuse_line(const char *rest, int count, int number, const char *name, WeftError *error) {
    if (rest) return fail(error, WEFT_MESSAGE_BRDF_TABLE, name, "line %d: no number begins at \"%.20s\"", number, rest);
    return fail(error, WEFT_MESSAGE_BRDF_TABLE, name, "line %d has %d numbers instead of seven", number, count);
}

static WeftResult take_line(BrdfTable *table, const char *line, int number, bool *header, const char *name,
                            WeftError *error) {
    float v[NUMBERS];
    const char *first = line + strspn(line, " \t\r");
    if (!*first || *first == '#') return WEFT_OK;
    if (!*header && is_header(line)) {
        *header = true;
        return WEFT_OK;
    }
    *header = true;
    const char *rest;
    int count = line_numbers(line, v, &rest);
    if (rest || count != NUMBERS) return refuse_line(rest, count, number, name, error);
    if (table->count == BRDF_TABLE_ROWS)
        return fail(error, WEFT_MESSAGE_BRDF_TABLE, name, "it has more than %d samples", BRDF_TABLE_ROWS);
    for (int k = 0; k < 4; k += 2)
        if (!(v[k] >= 0.0f && v[k] <= 90.0f) || !(fabsf(v[k + 1]) <= 3600.0f))
            return fail(error, WEFT_MESSAGE_BRDF_TABLE, name, "line %d: %g, %g is no direction above", number,
                        (double)v[k], (double)v[k + 1]);
    bool measured = v[4] >= 0.0f && v[5] >= 0.0f && v[6] >= 0.0f;
    if (measured && (v[4] > 1e6f || v[5] > 1e6f || v[6] > 1e6f))
        return fail(error, WEFT_MESSAGE_BRDF_TABLE, name, "line %d: more than 1e6 per steradian", number);
    direction((double)v[0], (double)v[1], table->wo[table->count]);
    direction((double)v[2], (double)v[3], table->wi[table->count]);
    for (int c = 0; c < 3; c++) table->f[table->count][c] = measured ? v[4 + c] : -1.0f;
    table->count++;
    return WEFT_OK;
}

/* Returns a number of samples that is enough: at most one a line, and no more than a table may have. */
static size_t capacity_for(const char *text, size_t size) {
    size_t count = 1;
    for (size_t k = 0; k < size && count < BRDF_TABLE_ROWS; k++) count += text[k] == '\n';
    return count;
}

static WeftResult take_lines(BrdfTable *table, const char *text, size_t size, const char *name, WeftError *error) {
    WeftResult result = WEFT_OK;
    bool header = false;
    int number = 1;
    for (const char *at = text, *end = text + size; at < end && result == WEFT_OK; number++) {
        char line[LINE_MOST + 1];
        const char *stop = memchr(at, '\n', (size_t)(end - at));
        size_t length = (size_t)((stop ? stop : end) - at);
        if (length > LINE_MOST || memchr(at, 0, length))
            return fail(error, WEFT_MESSAGE_BRDF_TABLE, name, "line %d is too long or not text", number);
        memcpy(line, at, length);
        line[length] = '\0';
        result = take_line(table, line, number, &header, name, error);
        at += length + 1;
    }
    return result;
}

WeftResult brdf_table_read(const char *text, size_t size, const char *name, BrdfTable *out, WeftError *error) {
    *out = (BrdfTable){0};
    size_t mark = mark_size(text, size), capacity = capacity_for(text, size);
    out->wo = alloc_array(capacity, sizeof *out->wo);
    out->wi = alloc_array(capacity, sizeof *out->wi);
    out->f = alloc_array(capacity, sizeof *out->f);
    if (!out->wo || !out->wi || !out->f) return fail(error, WEFT_MESSAGE_MEMORY, name, NULL);
    return take_lines(out, text + mark, size - mark, name, error);
}

void brdf_table_free(BrdfTable *table) {
    free(table->wo);
    free(table->wi);
    free(table->f);
    *table = (BrdfTable){0};
}
