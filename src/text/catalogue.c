#include "text/catalogue.h"

#include <string.h>

#include "weft/lobe.h"

const char *weft_catalogue_text(const char *path) {
    const char *folder = "shading/";
    for (const CatalogueFile *file = catalogue_files; file->name; file++)
        if (strcmp(file->name + strlen(folder), path) == 0) return file->bytes;
    return NULL;
}
