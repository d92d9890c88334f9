/* weave_draft.h - a weaving draft: the crossings of one repeat, and its threads */
#pragma once

#include <stdbool.h>
#include <stdio.h>

#include "weft/weave.h"

struct WeftDraft {
    char title[128];
    int count[2];           /* warp ends, picks */
    unsigned char *up;      /* [pick * count[WEFT_WARP] + warp]: 1 where the warp lies on top */
    WeftThread *threads[2]; /* of warp and weft */
};

/* Makes a draft with the weft on top everywhere: warp black, weft white, 20 threads a centimetre. More threads or
 * crossings than weave.h allows, or none, fail with the message `refusal`. */
WeftResult draft_create(const char *name, long warps, long picks, WeftMessage refusal, WeftDraft **out,
                        WeftError *error);

/* Defaults, metres: distance from thread to thread, and width of a thread. */
#define DRAFT_SPACING   5e-4f
#define DRAFT_THICKNESS 5e-4f

/* Copies text into the title. Control characters become blanks; a text that is too long is cut between characters. */
void draft_title(WeftDraft *draft, const char *text);

/* Returns true if both have the same threads and crossings. */
bool draft_same(const WeftDraft *a, const WeftDraft *b);

/* Returns true if the words can only be a path: they end in a suffix that is no fraction, or are one word with a
 * slash. */
bool draft_names_file(const char *what);

/* Reads a draft from a picture. text: the file begins with text, which changes the error of one that is no picture. */
WeftResult draft_from_picture(const char *path, bool text, WeftDraft **out, const WeftLog *log, WeftError *error);

/* Writes a WIF 1.1. Fails only if memory is short. */
WeftResult wif_write(const WeftDraft *draft, FILE *stream, const char *name, WeftError *error);

/* Returns the text of wif_write, to be released with free(); NULL if memory is short. */
char *wif_text(const WeftDraft *draft);
