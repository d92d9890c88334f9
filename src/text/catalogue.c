#include "text/catalogue.h"

#include <string.h>

#include "weft/lobe.h"

const char *weft_catalogue_text(const char *path) {
    const char *folder = "shading/";
    size_t size = strlen(folder);
    for (const CatalogueFile *file = catalogue_files; file->name; file++)
        if (strncmp(file->name, folder, size) == 0 && strcmp(file->name + size, path) == 0)
            return file->bytes;
    return NULL;
}
