/* fuzz_brdf_table - the reader of measurements that are lines of numbers
 *
 * Any input must be read or refused with one line; what is read must be finite and above the horizon, and every line
 * but comments and one of names is a sample. */
#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "measure/fit/brdf_table.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static void demand(int condition) {
    if (!condition) abort();
}

/* Counts the lines that are neither empty nor a comment. */
static int lines_of(const uint8_t *data, size_t size) {
    int count = 0;
    for (size_t at = 0; at < size;) {
        const uint8_t *end = memchr(data + at, '\n', size - at);
        const size_t length = end ? (size_t)(end - data) - at : size - at;
        size_t first = 0;
        while (first < length && strchr(" \t\r", data[at + first]) && data[at + first]) first++;
        count += first < length && data[at + first] != '#';
        at += length + 1;
    }
    return count;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    BrdfTable table;
    WeftError error;
    const WeftResult result = brdf_table_read((const char *)data, size, "fuzz", &table, &error);
    const int lines = lines_of(data, size);
    const bool marked = size >= 3 && memcmp(data, "\xef\xbb\xbf", 3) == 0;
    demand(result != WEFT_OK || table.count == lines || table.count == lines - 1 || marked);
    if (result == WEFT_OK)
        for (int k = 0; k < table.count; k++)
            for (int c = 0; c < 3; c++) {
                demand(isfinite(table.wo[k][c]) && isfinite(table.wi[k][c]));
                demand(isfinite(table.f[k][c]) && (table.f[k][c] >= 0.0f || (int)table.f[k][c] == -1));
                demand(c < 2 || (table.wo[k][2] >= 0.0f && table.wi[k][2] >= 0.0f));
            }
    else
        demand(error.text[0] && !strchr(error.text, '\n'));
    brdf_table_free(&table);
    return 0;
}
