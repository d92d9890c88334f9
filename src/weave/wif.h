/* wif.h - the reader of WIF: what each line may say, and what becomes of a line that says something else
 *
 * One table has a row for each key of the format with the kind of its value. wif_check goes over all lines once and
 * notes each whose section, key or value is not in the table; the readers of sheds and threads use the same functions
 * for values, pass over what these refuse, and note what only they can know (a colour that the palette lacks). A note is
 * a warning with the first line of its kind and how many there are, so that 500 threads are not 500 warnings. */
#pragma once

#include "weave/ini.h"
#include "weave/weave_draft.h"

/* Why a line does not count as it stands. */
typedef enum WifReason {
    WIF_OUTSIDE,
    WIF_SECTION,
    WIF_KEY,
    WIF_EQUALS,
    WIF_TWICE,
    WIF_VALUE,
    WIF_FLAG,
    WIF_UNIT,
    WIF_UNIT_MISSING,
    WIF_LENGTH,
    WIF_COLOR,
    WIF_CLIPPED,
    WIF_RANGE,
    WIF_BEYOND,
    WIF_FEWER,
    WIF_VERSION,
    WIF_REASONS
} WifReason;

/* The lines of one row of the table that share a reason. */
typedef struct WifNote {
    const IniLine *first;
    int count;
} WifNote;

typedef struct Wif {
    Ini ini;
    const WeftLog *log;
    WeftError *error;
    WifNote (*notes)[WIF_REASONS]; /* by row of the table; the last is of lines that have none */
} Wif;

/* Notes all lines that are not what the table says. A line without "=" becomes an empty value; one that is no key of
 * its section is taken out of it. Fails with WEFT_MESSAGE_MEMORY. */
WeftResult wif_check(Wif *wif);

/* Notes one line. */
void wif_note(Wif *wif, const IniLine *line, WifReason reason);

/* Hands all notes to the log. */
void wif_tell(const Wif *wif);

/* Fails with WEFT_MESSAGE_DRAFT, which names the line. */
WeftResult wif_refuse(const Wif *wif, const IniLine *line, const char *why);
WeftResult wif_memory(const Wif *wif);

/* Reads the next number of a list "1,2,3", which ends at a comment. Returns 1, 0 at the end, or -1 for anything
 * else. */
int wif_next(const char **cursor, long *number);

/* Reads numbers separated by commas, at most `most` of them. Returns how many there are, or -1 for anything else. */
int wif_numbers(const char *text, int most, float *values);

/* Reads a whole number, yes or no, or the metres of a unit of length. Return false for anything else. */
bool wif_whole(const char *text, long *number);
bool wif_flag(const char *text, bool *flag);
bool wif_unit(const char *text, double *metres);

/* Reads the colours, spacings and thicknesses of the threads of a draft. */
WeftResult wif_read_colors(Wif *wif, WeftDraft *draft);
void wif_read_lengths(Wif *wif, WeftDraft *draft);

/* Makes a draft of the lines. */
WeftResult wif_draft(Wif *wif, WeftDraft **out);
