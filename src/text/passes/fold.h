/* fold.h - constant folding of a text's conditions: only the branch that is taken stays */
#ifndef WEFT_TEXT_FOLD_H
#define WEFT_TEXT_FOLD_H

#include "text/source/buffer.h"

/* Something that a text asks for and that is known: "m.layer" is 2. */
typedef struct FoldFact {
    const char *path;
    int value;
} FoldFact;

/* Appends the text with every if and ?: whose condition follows from the facts and from the text's own whole
 * constants replaced by what it chooses; of others the parts that hold anyway are left out. A bool that is
 * known from its declaration on is one of these conditions, and its declaration is gone. Other lines stay as
 * they are, comments too. */
void fold_text(const char *text, const FoldFact *facts, int count, Buffer *out);

#endif
