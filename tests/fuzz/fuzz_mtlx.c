/* fuzz_mtlx - the reader of MaterialX: XML from memory, to the text of a material file
 *
 * Any input must be read or refused with one line; sanitizers watch the rest. What was read must be a material file, but for
 * its pictures. Use the dictionary mtlx.dict. */
#include "material_input.h"
#include "scene/mtlx/mtlx_read.h"

/* Demands that the material file is read, or has a picture, which needs a file to lie beside. */
static void check(const json_t *json, const WeftLog *log) {
    char *text = json_dumps(json, JSON_REAL_PRECISION(9));
    MaterialFile file;
    WeftError error;
    demand(text != NULL);
    const WeftResult result = material_file_read(text, strlen(text), "fuzz", NULL, &file, log, &error);
    demand(result == WEFT_OK || strstr(error.text, "a texture needs a file") || strstr(error.text, "placed beyond") ||
           strstr(error.text, "name of a file"));
    material_file_free(&file);
    free(text);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    const WeftLog log = {.fn = note};
    json_t *json;
    WeftError error;
    const WeftResult result = mtlx_read(data, size, "fuzz", &json, &log, &error);
    demand_outcome(result, &error);
    if (result == WEFT_OK) check(json, &log);
    json_decref(json);
    return 0;
}
