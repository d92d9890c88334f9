/* loss.h - parts of the original that a written file does not show */
#ifndef WEFT_LOSS_H
#define WEFT_LOSS_H

#include "weft/result.h"

#ifdef __cplusplus
extern "C" {
#endif

/* A thing of the original that a file does not show. Texts are UTF-8 and one line. */
typedef struct WeftLoss {
    int material;  /* the index of the material in the original; -1: no single one */
    char name[64]; /* of the material, truncated; may be empty */
    char what[64]; /* the thing: an extension such as "KHR_materials_sheen", an input such as "dust", or words */
    char why[256]; /* why, or what is shown instead: a sentence without its end; may be empty */
} WeftLoss;

/* A list of losses, each once. Zero-initialise; release with weft_losses_free. */
typedef struct WeftLosses {
    WeftLoss *items; /* count of them; owned */
    int count;       /* the number of items */
} WeftLosses;

/* Adds a loss to a list unless an equal one is in it. name and why may be NULL: empty. Returns 0 where memory is short. */
WEFT_API int weft_losses_add(WeftLosses *losses, int material, const char *name, const char *what, const char *why);

/* Adds what a warning of a writer tells, such as that of weft_scene_save_u3m to its WeftLog: "subject: text of its message:
 * WHAT: WHY". subject: the path that was given to the writer. Returns 0 where memory is short. */
WEFT_API int weft_losses_hear(WeftLosses *losses, int material, const char *name, const char *subject,
                              WeftMessage message, const char *text);

/* Releases what a list owns, and empties it. losses may be NULL. */
WEFT_API void weft_losses_free(WeftLosses *losses);

#ifdef __cplusplus
}
#endif

#endif
