/* catalogue.h - the files of src/shading and src/raster/glsl as they are, inside the library;
 * cmake/generate.cmake makes the table */
#pragma once

#include <stdbool.h>

typedef struct CatalogueFile {
    const char *name; /* "shading/lobes/ggx.h" */
    const char *bytes, *end;
} CatalogueFile;

/* Every header below src/shading and every text of src/raster/glsl; ends with a NULL name. */
extern const CatalogueFile catalogue_files[];

/* Finds a file by its name, among these or the lobes from outside ("shading/lobes/toy.h"). A header of shading/ is also
 * found as "shading/lobe.h", without its folder, as lobes from outside include it: headers have names of their own.
 * Returns false if there is none. */
bool catalogue_find(const char *name, CatalogueFile *out);
