#include "scene/material/u3m_weave.h"

#include "base/fail.h"
#include "scene/material/cloth_file.h"

WeftResult u3m_weave(const json_t *physics, const char *name, MaterialFile *out, const WeftLog *log, WeftError *error) {
    const char *draft, *yarn;
    const ClothSource source = {name, WEFT_MESSAGE_MATERIAL_FILE, NULL, log, error};
    json_t *weave = u3m_words_weave(physics, out->material.inputs[INPUT_base_color].value, &draft, &yarn);
    if (!draft) return WEFT_OK;
    WeftResult result =
        weave ? cloth_from_json(weave, &source, &out->cloth) : fail(error, WEFT_MESSAGE_MEMORY, name, NULL);
    json_decref(weave);
    if (result == WEFT_OK)
        warn(log, WEFT_MESSAGE_DRAFT_COMPLETED, name,
             "it has no texture, so that it is woven by construction and composition: %s of %s", draft, yarn);
    return result;
}
