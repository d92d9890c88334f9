/* viewer_reads.h - the extensions of materials that a viewer reads, and a glTF material without the others */
#pragma once

#include <jansson.h>
#include <stdbool.h>

#include "gltf/save/rewrite.h"
#include "weft/deliver.h"

enum { VIEWER_EXTENSIONS = 24 };

/* The extensions that were taken out of the materials of a file. */
typedef struct ViewerLosses {
    int materials[VIEWER_EXTENSIONS]; /* how many showed each extension that was taken out */
    int opaque_glass;                 /* materials of glass that were matched and judged as if they were opaque */
} ViewerLosses;

/* Takes out of a material of the rewritten file the extensions that target `target` does not read, and extras.weft.
 * *changed becomes true if what is left reflects light in another way. Fails with WEFT_MESSAGE_GLTF_EXTENSION where
 * the target lacks what the whole material stands on, or with _MEMORY. */
WeftResult viewer_limit(Rewrite *rewrite, int target, json_t *material, ViewerLosses *losses, bool *changed,
                        WeftError *error);

/* Moves the factor of KHR_materials_specular into its colour where the target would dim metals by the factor. Both
 * multiply F0, and none but the factor multiplies F90, which such a target computes of F0. */
void viewer_strength_fold(int target, json_t *material);

/* Removes from extensionsUsed and extensionsRequired the extensions that viewer_limit takes out. */
void viewer_uses(Rewrite *rewrite, int target);

/* Returns a sentence on each loss, a line each. Release with free; NULL where memory is short. */
char *viewer_losses_text(const ViewerLosses *losses, int materials);
