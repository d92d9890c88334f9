#include "cli/files/export_files.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/console/output.h"
#include "cli/console/report.h"
#include "cli/files/table_file.h"

/* Returns the path of table k, as "velvet.weft_texels_sheen.exr" beside "velvet.hlsl". Release with free; NULL where
 * memory is short. */
static char *table_path(const ExportFiles *self, int k) {
    static const char *const suffixes[WEFT_EXPORT_LUTS] = {".h", ".png", ".exr", ".dds", ".npy"};
    const char *path = self->path, *slash = strrchr(path, '/');
    const char *dot = strrchr(slash ? slash : path, '.');
    int stem = dot && dot > (slash ? slash + 1 : path) ? (int)(dot - path) : (int)strlen(path);
    size_t capacity = (size_t)stem + WEFT_EXPORT_NAME + 8;
    char *out = malloc(capacity);
    if (out) snprintf(out, capacity, "%.*s.%s%s", stem, path, self->made->tables[k].name, suffixes[self->lut]);
    return out;
}

static int table_file_write(const ExportFiles *self, int k, const char *path) {
    const WeftExportTable *table = &self->made->tables[k];
    char about[160];
    const float *texels = table->texels.pixels;
    float low = texels[0], high = texels[0];
    for (int n = 0; n < table->texels.width * table->texels.height; n++) {
        low = texels[n] < low ? texels[n] : low;
        high = texels[n] > high ? texels[n] : high;
    }
    snprintf(about, sizeof about, "%.95s%s", table->name, table->scale > 1.0f ? ", scaled as the text says" : "");
    const TableFile file = {.table = &table->texels,
                            .command = self->command,
                            .about = about,
                            .low = low,
                            .high = high,
                            .scale = self->lut == WEFT_EXPORT_LUT_PNG16 ? 1.0 : 0.0};
    return table_write(&file, path);
}

int export_tables_write(const ExportFiles *self, Json *json) {
    int result = 0;
    for (int k = 0; k < self->made->table_count && result == 0; k++) {
        char *path = table_path(self, k);
        result = path ? table_file_write(self, k, path) : report(WEFT_RESOURCES, "out of memory");
        if (result == 0 && json) json_text(json, NULL, path);
        if (result == 0 && !json && !self->quiet)
            report(0, "%s: %d x %d texels", path, self->made->tables[k].texels.width,
                   self->made->tables[k].texels.height);
        free(path);
    }
    return result;
}

int export_text_write(const ExportFiles *self) {
    Output output;
    int result = output_begin(&output, self->path);
    if (result != 0) return result;
    fwrite(self->made->text, 1, self->made->size, output.stream);
    return output_end(&output);
}
