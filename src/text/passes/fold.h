/* fold.h - constant folding of a text's conditions: only the branch that is taken stays */
#pragma once

#include "text/source/buffer.h"

/* An expression of a text with a constant value: "m.layer" is 2. */
typedef struct FoldFact {
    const char *path;
    int value;
} FoldFact;

/* Appends the text with every if and ?: replaced by its branch, if the condition follows from the facts and from the
 * text's own integer constants; parts of other conditions that are always true are removed. A bool whose declaration
 * has a constant value counts as a fact, and its declaration is removed. Other lines stay as they are, comments too. */
void fold_text(const char *text, const FoldFact *facts, int count, Buffer *out);
