/* wif_check.c - the table of the sections and keys of WIF, and the lines that differ from it
 *
 * Ralph Nielsen et al., "Weaving Information File Version", 1.1, 20 April 1997, and Shannon Young, "Weaving Information
 * File (WIF)", the guide to it of 2026: a ; after a number, a list or a flag begins a comment, after a text it does not;
 * an empty value is a missing one; [CONTENTS] is a hint that is often wrong. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "base/fail.h"
#include "base/memory.h"
#include "base/number.h"
#include "weave/wif.h"

/* The kinds of values: who reads a LIST, an RGB or a RANGE refuses what is none; a TEXT may be anything. */
typedef enum ValueKind { TEXT, WHOLE, FLAG, UNIT, LENGTH, COLOR, FORM, LIST, RGB, RANGE } ValueKind;

typedef struct KeyRow {
    const char *section, *key; /* key: "" stands for any, "#" for a number from 1 */
    ValueKind kind;
} KeyRow;

/* The rows of a section follow one another. */
static const KeyRow rows[] = {
    {"WIF", "", TEXT},
    {"CONTENTS", "", TEXT},
    {"TEXT", "", TEXT},
    {"NOTES", "", TEXT},
    {"WEAVING", "Shafts", WHOLE},
    {"WEAVING", "Treadles", WHOLE},
    {"WEAVING", "Rising Shed", FLAG},
    {"WEAVING", "Profile", FLAG},
    {"WARP", "Threads", WHOLE},
    {"WARP", "Units", UNIT},
    {"WARP", "Spacing", LENGTH},
    {"WARP", "Thickness", LENGTH},
    {"WARP", "Color", COLOR},
    {"WARP", "Spacing Zoom", TEXT},
    {"WARP", "Thickness Zoom", TEXT},
    {"WARP", "Symbol", TEXT},
    {"WARP", "Symbol Number", TEXT},
    {"WARP", "Colors", TEXT},
    {"WARP", "Palette", TEXT},
    {"WARP", "ColorMix", TEXT},
    {"WEFT", "Threads", WHOLE},
    {"WEFT", "Units", UNIT},
    {"WEFT", "Spacing", LENGTH},
    {"WEFT", "Thickness", LENGTH},
    {"WEFT", "Color", COLOR},
    {"WEFT", "Spacing Zoom", TEXT},
    {"WEFT", "Thickness Zoom", TEXT},
    {"WEFT", "Symbol", TEXT},
    {"WEFT", "Symbol Number", TEXT},
    {"WEFT", "Colors", TEXT},
    {"WEFT", "Palette", TEXT},
    {"WEFT", "ColorMix", TEXT},
    {"THREADING", "#", LIST},
    {"TIEUP", "#", LIST},
    {"TREADLING", "#", LIST},
    {"LIFTPLAN", "#", LIST},
    {"COLOR PALETTE", "Entries", WHOLE},
    {"COLOR PALETTE", "Range", RANGE},
    {"COLOR PALETTE", "Form", FORM},
    {"COLOR TABLE", "#", RGB},
    {"WARP COLORS", "#", COLOR},
    {"WEFT COLORS", "#", COLOR},
    {"WARP SPACING", "#", LENGTH},
    {"WEFT SPACING", "#", LENGTH},
    {"WARP THICKNESS", "#", LENGTH},
    {"WEFT THICKNESS", "#", LENGTH},
    /* in the format, and without any effect on a cloth */
    {"WARP SPACING ZOOM", "", TEXT},
    {"WEFT SPACING ZOOM", "", TEXT},
    {"WARP THICKNESS ZOOM", "", TEXT},
    {"WEFT THICKNESS ZOOM", "", TEXT},
    {"WARP SYMBOL PALETTE", "", TEXT},
    {"WEFT SYMBOL PALETTE", "", TEXT},
    {"WARP SYMBOL TABLE", "", TEXT},
    {"WEFT SYMBOL TABLE", "", TEXT},
    {"WARP SYMBOLS", "", TEXT},
    {"WEFT SYMBOLS", "", TEXT},
    {"BITMAP FILE", "", TEXT},
    {"BITMAP IMAGE", "", TEXT},
    {"BITMAP IMAGE DATA", "", TEXT},
    {"TRANSLATIONS", "", TEXT},
    {"DESIGN", "", TEXT},
};

enum { ROWS = sizeof rows / sizeof *rows, INDEX_MAX = 65536 };

static const char *const reasons[] = {
    [WIF_OUTSIDE] = "it stands before the first section and was passed over",
    [WIF_SECTION] = "WIF has no such section; it was passed over",
    [WIF_KEY] = "WIF has no such key there; it was passed over",
    [WIF_EQUALS] = "there is no \"=\"; it counts as an empty value",
    [WIF_TWICE] = "the key stands there twice; the last line counts",
    [WIF_VALUE] = "the value is not understood and counts as missing",
    [WIF_FLAG] = "it is neither yes nor no and counts as missing, which is yes",
    [WIF_UNIT] = "it is not a unit (decipoints, inches, centimeters); 20 threads a centimetre were taken",
    [WIF_UNIT_MISSING] = "there are no Units for it; centimeters were taken",
    [WIF_LENGTH] = "it is no length from a micrometre to a metre; the common one was taken",
    [WIF_COLOR] = "the [COLOR TABLE] has no such colour; the common one was taken",
    [WIF_CLIPPED] = "it is outside the Range of the [COLOR PALETTE] and was clipped",
    [WIF_RANGE] = "two numbers are expected; from 0 to this one was taken",
    [WIF_BEYOND] = "there are fewer threads; it was left out",
    [WIF_VERSION] = "weft knows 1.0 to 1.2; it was read as 1.1",
    [WIF_FEWER] = "more are used than it says; those that are used were taken",
};

/* ---- values ---- */

int wif_next(const char **cursor, long *number) {
    const char *text = *cursor + strspn(*cursor, " \t,");
    if (*text == '\0' || *text == ';') return 0;
    if (*text < '0' || *text > '9') return -1;
    char *end;
    *number = strtol(text, &end, 10);
    *cursor = end;
    return *end == '\0' || strchr(" \t,;", *end) ? 1 : -1;
}

int wif_numbers(const char *text, int most, float *values) {
    for (int count = 0; count < most;) {
        const char *end = number_prefix(text, &values[count]);
        if (!end) return -1;
        end += strspn(end, " \t");
        count++;
        if (*end == '\0' || *end == ';') return count;
        if (*end != ',') return -1;
        text = end + 1;
    }
    return -1;
}

bool wif_whole(const char *text, long *number) {
    long after;
    return wif_next(&text, number) == 1 && wif_next(&text, &after) == 0;
}

/* Returns the place of the word before the comment in a list that ends in NULL, or -1. */
static int word_of(const char *text, const char *const *words) {
    size_t size = strcspn(text, ";");
    while (size && strchr(" \t", text[size - 1])) size--;
    for (int k = 0; words[k]; k++)
        if (strlen(words[k]) == size && strncasecmp(text, words[k], size) == 0) return k;
    return -1;
}

bool wif_flag(const char *text, bool *flag) {
    static const char *const words[] = {"true", "yes", "t", "y", "on", "1", "false", "no", "f", "n", "off", "0", NULL};
    const int word = word_of(text, words);
    if (word >= 0) *flag = word < 6;
    return word >= 0;
}

/* Knows a decipoint, a 720th of an inch, and the other units. The format has the first of each line; the others can mean nothing else. */
bool wif_unit(const char *text, double *metres) {
    static const char *const words[] = {"decipoints",  "decipoint",                                     //
                                        "inches",      "inch",       "in",          "\"",               //
                                        "centimeters", "centimeter", "centimetres", "centimetre", "cm", //
                                        "millimeters", "millimeter", "millimetres", "millimetre", "mm", NULL};
    const int word = word_of(text, words);
    *metres = word < 2 ? 0.0254 / 720.0 : word < 6 ? 0.0254 : word < 11 ? 0.01 : 0.001;
    return word >= 0;
}

/* Returns true if the value is of the kind. */
static bool is_understood(ValueKind kind, const char *text) {
    static const char *const forms[] = {"RGB", NULL};
    float values[4];
    long number;
    bool flag;
    double metres;
    switch (kind) {
    case WHOLE: return wif_whole(text, &number);
    case FLAG: return wif_flag(text, &flag);
    case UNIT: return wif_unit(text, &metres);
    case LENGTH: return wif_numbers(text, 1, values) == 1;
    case COLOR: {
        const int count = wif_numbers(text, 4, values);
        return count == 3 || ((count == 1 || count == 4) && wif_next(&text, &number) == 1);
    }
    case FORM: return word_of(text, forms) >= 0;
    case TEXT:
    case LIST:
    case RGB:
    case RANGE: break;
    }
    return true;
}

/* ---- lines ---- */

/* Returns the first row of a section, or ROWS. */
static int section_row(const char *section) {
    int row = 0;
    while (row < ROWS && strcasecmp(rows[row].section, section) != 0) row++;
    return row;
}

/* Returns the row of a line, whose section begins at row `from`, or ROWS if the section has no such key. Numbered rows
 * take any key that is there with a value: the reader of the section refuses those that are no numbers. */
static int row_of(const IniLine *line, int from) {
    const bool numbered = ini_index(line) > 0 || line->value;
    for (int row = from; row < ROWS && strcasecmp(rows[row].section, rows[from].section) == 0; row++)
        if (rows[row].key[0] == '\0' || (rows[row].key[0] == '#' && numbered) ||
            strcasecmp(rows[row].key, line->key) == 0)
            return row;
    return ROWS;
}

/* Notes `reason` for a line of a row. */
static void note(Wif *wif, int row, const IniLine *line, WifReason reason) {
    WifNote *of = &wif->notes[row][reason];
    if (!of->count++) of->first = line;
}

void wif_note(Wif *wif, const IniLine *line, WifReason reason) {
    const int from = section_row(line->section);
    note(wif, from < ROWS ? row_of(line, from) : ROWS, line, reason);
}

/* Returns true if the key of that row was there before, and remembers it. seen: bits by row and index. */
static bool seen_before(unsigned char *seen, int row, const IniLine *line) {
    const long index = rows[row].key[0] == '#' ? ini_index(line) : 0;
    if (index > INDEX_MAX || (rows[row].key[0] == '#' && !index)) return false;
    unsigned char *byte = &seen[(size_t)row * (INDEX_MAX / 8 + 1) + (size_t)index / 8];
    const bool before = *byte >> (index % 8) & 1;
    *byte = (unsigned char)(*byte | 1u << (index % 8));
    return before;
}

/* Checks a line of a section that begins at row `from`. */
static void check_line(Wif *wif, IniLine *line, int from, unsigned char *seen) {
    static const WifReason by_kind[] = {[WHOLE] = WIF_VALUE,  [FLAG] = WIF_FLAG,   [UNIT] = WIF_UNIT,
                                        [LENGTH] = WIF_VALUE, [COLOR] = WIF_VALUE, [FORM] = WIF_VALUE};
    const int row = row_of(line, from);
    const bool has_value = line->value != NULL;
    if (row == ROWS || (!has_value && rows[row].key[0] == '\0' && line->key[0] == '['))
        note(wif, row == ROWS ? from : row, line, WIF_KEY);
    else if (!has_value && rows[row].kind != TEXT)
        note(wif, row, line, WIF_EQUALS);
    else if (has_value && line->value[0] != '\0' && line->value[0] != ';' &&
             !is_understood(rows[row].kind, line->value))
        note(wif, row, line, by_kind[rows[row].kind]);
    if (row < ROWS && rows[row].kind != TEXT && seen_before(seen, row, line)) note(wif, row, line, WIF_TWICE);
    if (row == ROWS) line->section = "";
    if (!has_value || (row < ROWS && rows[row].kind != TEXT && line->value[0] == ';')) line->value = "";
}

/* Notes a version of the format that is not known, and a section whose bracket is missing. */
static void check_version(Wif *wif) {
    const IniLine *line = ini_find(&wif->ini, "WIF", "Version");
    float version;
    if (line && line->value[0] != '\0' && wif_numbers(line->value, 1, &version) == 1 &&
        !(version >= 1.0f && version < 1.25f))
        wif_note(wif, line, WIF_VERSION);
    if (wif->ini.unclosed)
        warn(wif->log, WEFT_MESSAGE_DRAFT_COMPLETED, wif->ini.name,
             "line %d: the section has no closing bracket; it was read as if there were one", wif->ini.unclosed);
}

WeftResult wif_check(Wif *wif) {
    unsigned char *seen = alloc_array(ROWS, INDEX_MAX / 8 + 1);
    wif->notes = alloc_array(ROWS + 1, sizeof *wif->notes);
    const char *section = NULL;
    int from = ROWS;
    for (int k = 0; seen && wif->notes && k < wif->ini.count; k++) {
        IniLine *line = &wif->ini.lines[k];
        if (line->section != section) from = section_row(line->section);
        section = line->section;
        if (from < ROWS)
            check_line(wif, line, from, seen);
        else if (!section || section[0] == '\0')
            note(wif, ROWS, line, WIF_OUTSIDE);
        else if (strncasecmp(section, "PRIVATE", 7) != 0)
            note(wif, ROWS, line, WIF_SECTION);
    }
    const bool done = seen && wif->notes;
    if (done) check_version(wif);
    free(seen);
    return done ? WEFT_OK : wif_memory(wif);
}

/* Writes "line 7: [WARP] Units=ells" into text. */
static void line_name(const IniLine *line, const char *section, char text[static 240]) {
    snprintf(text, 240, "line %d: %s%.40s%s%.60s%s%.60s", line->number, section[0] ? "[" : "", section,
             section[0] ? "] " : "", line->key, line->value && line->value[0] ? "=" : "",
             line->value ? line->value : "");
}

void wif_tell(const Wif *wif) {
    for (int row = 0; wif->notes && row <= ROWS; row++)
        for (int reason = 0; reason < WIF_REASONS; reason++) {
            const WifNote *of = &wif->notes[row][reason];
            char name[240], more[40] = "";
            if (!of->count) continue;
            line_name(of->first, row < ROWS ? rows[row].section : of->first->section, name);
            if (of->count > 1) snprintf(more, sizeof more, " (and %d more lines)", of->count - 1);
            warn(wif->log, WEFT_MESSAGE_DRAFT_COMPLETED, wif->ini.name, "%s: %s%s", name, reasons[reason], more);
        }
}

WeftResult wif_refuse(const Wif *wif, const IniLine *line, const char *why) {
    char name[240];
    line_name(line, line->section, name);
    return fail(wif->error, WEFT_MESSAGE_DRAFT, wif->ini.name, "%s: %s", name, why);
}

WeftResult wif_memory(const Wif *wif) { return fail(wif->error, WEFT_MESSAGE_MEMORY, wif->ini.name, NULL); }
