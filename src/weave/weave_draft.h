/* weave_draft.h - a weaving draft: the crossings of one repeat, and its threads */
#ifndef WEFT_WEAVE_WEAVE_DRAFT_H
#define WEFT_WEAVE_WEAVE_DRAFT_H

#include <stdbool.h>
#include <stdio.h>

#include "weft/weave.h"

struct WeftDraft {
    char title[128];
    int count[2];           /* warp ends, picks */
    unsigned char *up;      /* [pick * count[WEFT_WARP] + warp]: 1 where the warp lies on top */
    WeftThread *threads[2]; /* of warp and weft */
};

/* Makes a draft without a warp on top anywhere: warp black, weft white, 20 threads a centimetre. More threads
 * or crossings than weave.h allows, or none, fail with the message `refusal`. */
WeftResult draft_create(const char *name, long warps, long picks, WeftMessage refusal, WeftDraft **out,
                        WeftError *error);

/* The metres from thread to thread, and the width of a thread, where nothing says otherwise. */
#define DRAFT_SPACING   5e-4f
#define DRAFT_THICKNESS 5e-4f

/* Copies text into the title: control characters become blanks, and what is too long is cut between
 * characters. */
void draft_title(WeftDraft *draft, const char *text);

/* Returns true if both have the same threads and crossings. */
bool draft_same(const WeftDraft *a, const WeftDraft *b);

/* The reader of pictures for weft_draft_read; text: all that its file begins with is text. */
WeftResult draft_from_picture(const char *path, bool text, WeftDraft **out, const WeftLog *log,
                              WeftError *error);

/* Writes a WIF 1.1. WEFT_OK, or memory was short. */
WeftResult wif_write(const WeftDraft *draft, FILE *stream, const char *name, WeftError *error);

/* Returns what that writes as a text, to be released with free(); NULL where memory is short. */
char *wif_text(const WeftDraft *draft);

#endif
