#include "text/assemble/catalogue.h"

#include <stdio.h>
#include <string.h>

#include "shading/catalogue/registry.h"
#include "weft/lobe.h"

/* Returns the header with the base name of `name` in any folder of shading/ except tables/, or NULL. */
static const CatalogueFile *find_anywhere(const char *name) {
    const char *base = strrchr(name, '/');
    if (!base || strncmp(name, "shading/", 8) != 0) return NULL;
    for (const CatalogueFile *file = catalogue_files; file->name; file++)
        if (strcmp(strrchr(file->name, '/'), base) == 0 && strncmp(file->name, "shading/tables/", 15) != 0) return file;
    return NULL;
}

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
    const CatalogueFile *moved = find_anywhere(name);
    if (moved) *out = *moved;
    return moved != NULL;
}

const char *weft_catalogue_text(const char *path) {
    char name[256];
    CatalogueFile file;
    return (size_t)snprintf(name, sizeof name, "shading/%s", path) < sizeof name && catalogue_find(name, &file)
               ? file.bytes
               : NULL;
}
