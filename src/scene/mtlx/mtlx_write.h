/* mtlx_write.h - a material as a MaterialX document: one surface node, and a graph of its textures */
#pragma once

#include <stdio.h>

#include "scene/mtlx/mtlx_nodes.h"

typedef struct MtlxWriting {
    WeftMtlxNode node;
    const char *name;         /* of the material; other characters than MaterialX takes become _ */
    const Material *material; /* in the numbers of the node (mtlx_to_node) */
    const Texture *textures;  /* of the scene, as are the images */
    const WeftImage *images;
    const char *const *files; /* of the texture of each input, as the document names it */
} MtlxWriting;

/* Writes the document. */
void mtlx_write(const MtlxWriting *writing, FILE *out);

/* Says in a line each what of a material the document does not have. given: the material before mtlx_to_node; back: it has
 * a back of its own; subject: the file. */
void mtlx_losses(const MtlxWriting *writing, const Material *given, bool back, const char *subject, const WeftLog *log);
