#include "export/draft.h"

#include "base/fail.h"

WeftResult draft_material(Draft *draft, WeftError *error) {
    return fail(error, WEFT_MESSAGE_DESC, "export", draft->desc->profile ? "profile" : "material");
}
