/* terms.c - the public face of the lists of terms */
#include "shading/lobe/terms.h"

#include <stddef.h>

#include "weft/lobe.h"

typedef struct TermText {
    const char *id, *help;
} TermText;

/* Placed by number, so that list and number cannot part. */
#define D_TEXT(id, NAME, value, drawn, proxy, help) [NAME] = {id, help},
#define V_TEXT(id, NAME, value, help)               [NAME] = {id, help},
#define F_TEXT(id, NAME, share, second, help)       [NAME] = {id, help},
static const TermText d_texts[D_COUNT] = {WEFT_D_TERMS(D_TEXT)};
static const TermText v_texts[V_COUNT] = {WEFT_V_TERMS(V_TEXT)};
static const TermText f_texts[F_COUNT] = {WEFT_F_TERMS(F_TEXT)};

static const TermText *text_of(WeftTermKind kind, int k) {
    if (k < 0) return NULL;
    switch (kind) {
    case WEFT_TERM_D: return k < D_COUNT ? &d_texts[k] : NULL;
    case WEFT_TERM_V: return k < V_COUNT ? &v_texts[k] : NULL;
    case WEFT_TERM_F: return k < F_COUNT ? &f_texts[k] : NULL;
    }
    return NULL;
}

const char *weft_term_name(WeftTermKind kind, int k) {
    const TermText *text = text_of(kind, k);
    return text ? text->id : NULL;
}

const char *weft_term_help(WeftTermKind kind, int k) {
    const TermText *text = text_of(kind, k);
    return text ? text->help : NULL;
}
