/* draft_operand.h - a weaving draft and yarns, as the command line names them */
#pragma once

#include "weft/weave.h"

/* The functions below return 0, or an exit code after one line on standard error. */

/* Reads a draft: a file, or words. log may be NULL. Release with weft_draft_free. */
int draft_read(const char *what, const WeftLog *log, WeftDraft **out);

/* Sets the threads per centimetre: "E", or "E,P" for warp and weft. text may be NULL: the draft stays as it is. */
int draft_sett(const char *text, WeftDraft *draft);

/* Finds the yarns of warp and weft: "NAME", or "WARP,WEFT". */
int yarns_read(const char *text, WeftYarn yarns[2]);
