/* catalogue.h - the files of src/shading and src/raster/glsl as they are, inside the library;
 * cmake/generate.cmake makes the table */
#ifndef WEFT_TEXT_CATALOGUE_H
#define WEFT_TEXT_CATALOGUE_H

#include <stdbool.h>

typedef struct CatalogueFile {
    const char *name; /* "shading/lobes/ggx.h" */
    const char *bytes, *end;
} CatalogueFile;

/* Every header below src/shading and every text of src/raster/glsl; ends with a NULL name. */
extern const CatalogueFile catalogue_files[];

/* The file of that name among these, or that of a lobe from outside, "shading/lobes/toy.h"; false where there
 * is none. */
bool catalogue_find(const char *name, CatalogueFile *out);

#endif
