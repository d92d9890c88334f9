/* fuzz_u3m - the reader of U3M materials: JSON from memory, without pictures, which need a file to lie beside, and archives,
 * which begin with PK
 *
 * Any input must be read or refused with one line; sanitizers watch the rest. What was read must be fit to shade with:
 * finite, and in its hard range. Use the dictionary u3m.dict. */
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "scene/material/u3m.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static void demand(int condition) {
    if (!condition) abort();
}

static void check(const MaterialFile *file) {
    for (int k = 0; k < INPUT_COUNT; k++) {
        const WeftInputInfo *info = &input_infos[k];
        const Input *input = &file->material.inputs[k];
        for (int c = 0; c < (info->kind == WEFT_INPUT_COLOR ? 3 : 1); c++)
            demand(isfinite(input->value[c]) && input->value[c] >= info->hard_low &&
                   input->value[c] <= info->hard_high);
        demand(input->texture == 0);
    }
    demand(file->image_count == 0 && file->texture_count == 0);
}

static void note(void *user, WeftMessage message, const char *text) {
    (void)user;
    (void)message;
    demand(text[0] && !strchr(text, '\n'));
}

/* Reads the .u3m of an archive with its pictures. */
static void archive_read(const uint8_t *data, size_t size) {
    const WeftLog log = {.fn = note};
    U3mArchive *archive;
    FileBytes bytes = {0};
    WeftError error;
    if (u3m_archive_open(data, size, "fuzz", &archive, &error) != WEFT_OK) {
        demand(error.text[0] && !strchr(error.text, '\n'));
        return;
    }
    MaterialFile file;
    if (u3m_archive_read(archive, u3m_archive_material(archive), &bytes, &error) == WEFT_OK) {
        const WeftResult result =
            u3m_read(bytes.data, bytes.size, "fuzz", &(U3mFiles){"", archive}, &file, &log, &error);
        demand(result == WEFT_OK || (error.text[0] && !strchr(error.text, '\n')));
        material_file_free(&file);
    }
    free(bytes.data);
    u3m_archive_close(archive);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    if (size >= 2 && data[0] == 'P' && data[1] == 'K') {
        archive_read(data, size);
        return 0;
    }
    const WeftLog log = {.fn = note};
    MaterialFile file;
    WeftError error;
    const WeftResult result = u3m_read(data, size, "fuzz", &(U3mFiles){.folder = NULL}, &file, &log, &error);
    if (result == WEFT_OK)
        check(&file);
    else
        demand(error.result == result && error.text[0] && !strchr(error.text, '\n'));
    material_file_free(&file);
    return 0;
}
