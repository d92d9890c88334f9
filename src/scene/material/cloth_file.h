/* cloth_file.h - the weave of a material file: a draft and its yarns (docs/weave.md has the keys) */
#pragma once

#include <jansson.h>

#include "weft/weave.h"

/* Weaves {"draft": DRAFT, "warp": YARN, "weft": YARN, "sett": [20, 20], "metres": "auto", "seed": 0}. name is the
 * subject of errors, folder ("" or with a slash at its end) that of files of drafts; NULL: drafts may only be words or
 * the text of a WIF. Fails with WEFT_MESSAGE_MATERIAL_FILE, _MEMORY and as weft_draft_read does. */
WeftResult cloth_from_json(const json_t *json, const char *name, const char *folder, WeftCloth **out,
                           const WeftLog *log, WeftError *error);

/* Returns the weave of a cloth as cloth_from_json reads it, or NULL if memory is short. draft: file of its draft; NULL:
 * the draft is written in words or as the text of a WIF. */
json_t *cloth_to_json(const WeftCloth *cloth, const char *draft);
