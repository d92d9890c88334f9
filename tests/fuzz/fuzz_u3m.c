/* fuzz_u3m - the reader of U3M materials: JSON from memory, without pictures, which need a file to lie beside, and archives,
 * which begin with PK
 *
 * Any input must be read or refused with one line; sanitizers watch the rest. What was read must be fit to shade with:
 * finite, and in its hard range. Use the dictionary u3m.dict. */
#include "material_input.h"
#include "scene/material/u3m.h"
#include "scene/material/u3m_weave.h"

/* Looks the words up in place of the program's own, and weaves nothing. To weave one of its own drafts takes a tenth of a
 * second, and the file has no influence on that. */
WeftResult u3m_weave(const json_t *physics, const char *name, MaterialFile *out, const WeftLog *log, WeftError *error) {
    const char *draft, *yarn;
    (void)name, (void)log, (void)error;
    json_decref(u3m_words_weave(physics, out->material.inputs[INPUT_base_color].value, &draft, &yarn));
    demand(yarn && yarn[0]);
    return WEFT_OK;
}

static void check(const MaterialFile *file) {
    demand_ranges(&file->material);
    for (int k = 0; k < INPUT_COUNT; k++) demand(file->material.inputs[k].texture == 0);
    demand(file->image_count == 0 && file->texture_count == 0);
}

/* Reads the .u3m of an archive with its pictures. */
static void archive_read(const uint8_t *data, size_t size) {
    const WeftLog log = {.fn = note};
    U3mArchive *archive;
    FileBytes bytes = {0};
    WeftError error;
    if (u3m_archive_open(data, size, "fuzz", &archive, &error) != WEFT_OK) {
        demand_outcome(error.result, &error);
        return;
    }
    MaterialFile file;
    if (u3m_archive_read(archive, u3m_archive_material(archive), &bytes, &error) == WEFT_OK) {
        const WeftResult result =
            u3m_read(bytes.data, bytes.size, "fuzz", &(U3mFiles){"", archive}, &file, &log, &error);
        demand_outcome(result, &error);
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
    demand_outcome(result, &error);
    if (result == WEFT_OK) check(&file);
    material_file_free(&file);
    return 0;
}
