/* fuzz_brdf_table - the reader of measurements that are lines of numbers
 *
 * Any input must be read or refused with one line; what is read must be finite and above the horizon. */
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "measure/fit/brdf_table.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static void demand(int condition) {
    if (!condition) abort();
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    BrdfTable table;
    WeftError error;
    if (brdf_table_read((const char *)data, size, "fuzz", &table, &error) == WEFT_OK)
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
