/* fuzz_mtlx - the reader of MaterialX: XML from memory, to the text of a material file
 *
 * Any input must be read or refused with one line; sanitizers watch the rest. What was read must be a material file, but for
 * its pictures. Use the dictionary mtlx.dict. */
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "scene/material/material_file.h"
#include "scene/mtlx/mtlx_read.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static void demand(int condition) {
    if (!condition) abort();
}

static void note(void *user, WeftMessage message, const char *text) {
    (void)user;
    (void)message;
    demand(text[0] && !strchr(text, '\n'));
}

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
    if (result == WEFT_OK)
        check(json, &log);
    else
        demand(error.result == result && error.text[0] && !strchr(error.text, '\n'));
    json_decref(json);
    return 0;
}
