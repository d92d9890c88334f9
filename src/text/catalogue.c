#include "text/catalogue.h"

#include <stdio.h>
#include <string.h>

#include "shading/registry.h"
#include "weft/lobe.h"

bool catalogue_find(const char *name, CatalogueFile *out) {
    for (const CatalogueFile *file = catalogue_files; file->name; file++)
        if (strcmp(file->name, name) == 0) {
            *out = *file;
            return true;
        }
    const OutsideLobe *lobe;
    for (int id = LOBE_COUNT; (lobe = outside_lobe(id)); id++)
        if (strcmp(lobe->file, name) == 0) {
            *out = (CatalogueFile){lobe->file, lobe->text, lobe->text + strlen(lobe->text)};
            return true;
        }
    return false;
}

const char *weft_catalogue_text(const char *path) {
    char name[256];
    CatalogueFile file;
    return (size_t)snprintf(name, sizeof name, "shading/%s", path) < sizeof name &&
                   catalogue_find(name, &file)
               ? file.bytes
               : NULL;
}
