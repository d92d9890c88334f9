/* cloth_file.h - the weave of a material file: a draft and its yarns (docs/weave.md has the keys) */
#pragma once

#include <jansson.h>

#include "weft/weave.h"

/* The source of a weave that is read. */
typedef struct ClothSource {
    const char *name;    /* the subject of errors: the file, or the value of a setting */
    WeftMessage refusal; /* WEFT_MESSAGE_MATERIAL_FILE or _PARAM_VALUE */
    const char *folder; /* of files of drafts: "" or with a slash at its end; NULL: drafts may only be words or the text
                            of a WIF */
    const WeftLog *log;
    WeftError *error;
} ClothSource;

/* Weaves {"draft": DRAFT, "warp": YARN, "weft": YARN, "sett": [20, 20], "metres": "auto", "seed": 0, "rotation": 0, "relief": "folds"}.
 * Fails with the source's message, WEFT_MESSAGE_MEMORY and as weft_draft_read does. */
WeftResult cloth_from_json(const json_t *json, const ClothSource *source, WeftCloth **out);

/* Returns the key of a weave that another word is likely to mean, such as metres by scale; NULL if none is. */
const char *cloth_key_meant(const char *word);

/* Returns the weave of a cloth as cloth_from_json reads it, or NULL if memory is short. draft: file of its draft; NULL:
 * the draft is written in words or as the text of a WIF. */
json_t *cloth_to_json(const WeftCloth *cloth, const char *draft);
