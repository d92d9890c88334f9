/* viewer_reads.h - the extensions of materials that a viewer reads, and a glTF material without the others */
#pragma once

#include <jansson.h>
#include <stdbool.h>

#include "gltf/save/rewrite.h"
#include "weft/deliver.h"

/* The place for what a material loses: the list, and the material's index and name. */
typedef struct ViewerLimit {
    WeftLosses *losses;
    int material;
    const char *name;
} ViewerLimit;

/* Takes out of a material of the rewritten file the extensions that target `target` does not read, and extras.weft.
 * *changed becomes true if what is left reflects light in another way. Fails with WEFT_MESSAGE_GLTF_EXTENSION where
 * the target lacks what the whole material stands on, or with _MEMORY. */
WeftResult viewer_limit(Rewrite *rewrite, int target, json_t *material, const ViewerLimit *limit, bool *changed,
                        WeftError *error);

/* Moves the factor of KHR_materials_specular into its colour where the target would dim metals by the factor. Both
 * multiply F0, and none but the factor multiplies F90, which such a target computes of F0. */
void viewer_strength_fold(int target, json_t *material);

/* Writes KHR_materials_specular with its usual numbers beside a sheen where the target would else draw no specular
 * reflection. Fails with WEFT_MESSAGE_MEMORY. */
WeftResult viewer_specular_put(Rewrite *rewrite, int target, json_t *material, WeftError *error);

/* Removes from extensionsUsed and extensionsRequired the extensions that viewer_limit takes out. */
void viewer_uses(Rewrite *rewrite, int target);

/* Returns the extensions that a file uses, a line each. Release with free; NULL where memory is short. */
char *viewer_extensions_text(const json_t *root);
