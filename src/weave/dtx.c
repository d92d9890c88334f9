#define _POSIX_C_SOURCE 200809L /* open_memstream */
#include "weave/dtx.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "base/fail.h"
#include "base/mark.h"
#include "base/memory.h"
#include "base/number.h"

/* The steps of a spacing, in centimetres, and how many stand between threads that have none. */
#define STEP 0.053
enum { STEPS = 4 };

/* The file, cut into lines, and the WIF that is made of it. */
typedef struct Dtx {
    const char *name;
    const WeftLog *log;
    Ini file;     /* lines whose key is all of a line, and whose value is NULL */
    FILE *stream; /* the WIF */
    int *numbers; /* of the line of the file behind each line of the WIF */
    int count;
    bool short_of_memory;
} Dtx;

/* ---- the WIF ---- */

/* Remembers the line of the file behind the line of WIF that is written next. */
static void begin_line(Dtx *dtx, int number) {
    if ((dtx->count & (dtx->count - 1)) == 0) { /* full at each power of two */
        int *grown = realloc_array(dtx->numbers, dtx->count ? 2 * (size_t)dtx->count : 1, sizeof *grown);
        if (!grown) dtx->short_of_memory = true;
        if (!grown) return;
        dtx->numbers = grown;
    }
    dtx->numbers[dtx->count++] = number;
}

/* Writes "key=value", which comes from that line of the file. */
__attribute__((format(printf, 3, 4))) static void put(Dtx *dtx, int number, const char *format, ...) {
    begin_line(dtx, number);
    va_list values;
    va_start(values, format);
    vfprintf(dtx->stream, format, values);
    va_end(values);
    fputc('\n', dtx->stream);
}

static void put_section(Dtx *dtx, const char *name) { fprintf(dtx->stream, "[%s]\n", name); }

/* ---- sections of the file ---- */

/* A section of the file: its name, what reads it, and the section of WIF that it becomes. */
typedef struct Section {
    const char *name;
    void (*read)(Dtx *, const struct Section *);
    const char *wif;
} Section;

static bool is_of(const IniLine *line, const Section *section) { return strcasecmp(line->section, section->name) == 0; }

/* Returns true for a line "%%key value". */
static bool is_key(const IniLine *line) { return line->key[0] == '%'; }

/* Returns the end of the word at text, which goes on after a comma and blanks: "1, 3". */
static const char *word_end(const char *text) {
    for (;;) {
        text += strcspn(text, " \t");
        const char *next = text + strspn(text, " \t");
        if (text[-1] != ',' && *next != ',') return text;
        text = *next ? next + 1 : next;
        if (*next == '\0') return text;
    }
}

/* Writes one word of a section of words as a value of WIF. */
static void put_word(Dtx *dtx, const Section *section, int number, int index, const char *word, int size) {
    float value;
    const bool is_number = number_prefix(word, &value) == word + size;
    if (strstr(section->wif, "COLORS") && is_number)
        put(dtx, number, "%d=%.9g", index, (double)value + 1.0);
    else if (strstr(section->wif, "SPACING") && is_number)
        put(dtx, number, "%d=%.6g", index, (double)value * STEP);
    else
        put(dtx, number, "%d=%.*s", index, size, word);
}

static void read_words(Dtx *dtx, const Section *section) {
    int index = 0;
    put_section(dtx, section->wif);
    for (int k = 0; k < dtx->file.count; k++) {
        const IniLine *line = &dtx->file.lines[k];
        if (!is_of(line, section) || is_key(line)) continue;
        for (const char *word = line->key, *end; *word; word = end + strspn(end, " \t")) {
            end = word_end(word);
            put_word(dtx, section, line->number, ++index, word, (int)(end - word));
        }
    }
}

/* Writes each line as it is: the colours of the palette. */
static void read_lines(Dtx *dtx, const Section *section) {
    int index = 0;
    put_section(dtx, section->wif);
    for (int k = 0; k < dtx->file.count; k++)
        if (is_of(&dtx->file.lines[k], section) && !is_key(&dtx->file.lines[k]))
            put(dtx, dtx->file.lines[k].number, "%d=%s", ++index, dtx->file.lines[k].key);
}

/* Returns the place of the next 0 or 1 of a row, NULL at its end. Other characters are found by row_is_sound. */
static const char *next_bit(const char *text) {
    text += strcspn(text, "01");
    return *text ? text : NULL;
}

static bool row_is_sound(const char *text) { return text[strspn(text, "01 \t,")] == '\0'; }

/* Writes the columns of a row that have a 1 as a list; what is no row, as something that no list is. */
static void put_row(Dtx *dtx, int index, const IniLine *row) {
    int column = 0;
    begin_line(dtx, row->number);
    fprintf(dtx->stream, "%d=", index);
    if (!row_is_sound(row->key)) fprintf(dtx->stream, "not 0 and 1: %s", row->key);
    for (const char *bit = next_bit(row->key); bit; bit = next_bit(bit + 1)) {
        column++;
        if (*bit == '1') fprintf(dtx->stream, "%d,", column);
    }
    fputc('\n', dtx->stream);
}

static void read_plan(Dtx *dtx, const Section *section) {
    int index = 0;
    put_section(dtx, section->wif);
    for (int k = 0; k < dtx->file.count; k++)
        if (is_of(&dtx->file.lines[k], section) && !is_key(&dtx->file.lines[k]))
            put_row(dtx, ++index, &dtx->file.lines[k]);
}

/* A row of the tie-up, and its next column. */
typedef struct TieRow {
    const IniLine *line;
    const char *bit; /* NULL at its end */
} TieRow;

/* Writes the shafts of one treadle: the column of all rows, of which the last is shaft 1. Returns false beyond the last
 * treadle. */
static bool put_treadle(Dtx *dtx, int treadle, TieRow *ties, int count) {
    bool found = false;
    for (int k = 0; k < count; k++) found |= ties[k].bit != NULL;
    if (!found) return false;
    begin_line(dtx, ties[count - 1].line->number);
    fprintf(dtx->stream, "%d=", treadle);
    for (int shaft = 1; shaft <= count; shaft++) {
        TieRow *row = &ties[count - shaft];
        if (!row_is_sound(row->line->key) && treadle == 1) fprintf(dtx->stream, "not 0 and 1: %s", row->line->key);
        if (!row->bit) continue;
        if (*row->bit == '1') fprintf(dtx->stream, "%d,", shaft);
        row->bit = next_bit(row->bit + 1);
    }
    fputc('\n', dtx->stream);
    return true;
}

static void read_tieup(Dtx *dtx, const Section *section) {
    TieRow *ties = alloc_array((size_t)dtx->file.count, sizeof *ties);
    int count = 0;
    put_section(dtx, section->wif);
    if (!ties) dtx->short_of_memory = true;
    for (int k = 0; ties && k < dtx->file.count; k++) {
        const IniLine *line = &dtx->file.lines[k];
        if (is_of(line, section) && !is_key(line)) ties[count++] = (TieRow){line, next_bit(line->key)};
    }
    for (int treadle = 1; ties && put_treadle(dtx, treadle, ties, count); treadle++) {
    }
    free(ties);
}

/* Takes the first line as the title. */
static void read_title(Dtx *dtx, const Section *section) {
    put_section(dtx, section->wif);
    for (int k = 0; k < dtx->file.count; k++)
        if (is_of(&dtx->file.lines[k], section)) {
            put(dtx, dtx->file.lines[k].number, "Title=%s", dtx->file.lines[k].key);
            return;
        }
}

static const Section sections[] = {
    {"Description", read_title, "TEXT"},
    {"Threading", read_words, "THREADING"},
    {"Tieup", read_tieup, "TIEUP"},
    {"Treadling", read_words, "TREADLING"},
    {"Liftplan", read_plan, "LIFTPLAN"},
    {"Color Palet", read_lines, "COLOR TABLE"},
    {"Color Palette", read_lines, "COLOR TABLE"},
    {"Warp Colors", read_words, "WARP COLORS"},
    {"Weft Colors", read_words, "WEFT COLORS"},
    {"Warp Spacing", read_words, "WARP SPACING"},
    {"Weft Spacing", read_words, "WEFT SPACING"},
    {"Info", NULL, NULL},
    /* without any effect on a cloth */
    {"StartDTX", NULL, NULL},
    {"Contents", NULL, NULL},
    {"Imprint", NULL, NULL},
    {"Private", NULL, NULL},
    {"Notes", NULL, NULL},
    {"EndDTX", NULL, NULL},
};
enum { SECTIONS = sizeof sections / sizeof *sections };

/* ---- keys ---- */

/* Writes the value behind "%%key" in Info as a key of WIF. */
static void put_stated(Dtx *dtx, const char *key, const char *wif) {
    const size_t size = strlen(key);
    for (int k = 0; k < dtx->file.count; k++) {
        const IniLine *line = &dtx->file.lines[k];
        const char *text = line->key + strspn(line->key, "%");
        if (is_key(line) && strcasecmp(line->section, "Info") == 0 && strncasecmp(text, key, size) == 0 &&
            strchr(" \t", text[size]))
            put(dtx, line->number, "%s=%s", wif, text + size);
    }
}

/* Returns true if a section says that its shafts sink. */
static bool sinks(const Dtx *dtx, const char *section) {
    for (int k = 0; k < dtx->file.count; k++) {
        const IniLine *line = &dtx->file.lines[k];
        if (is_key(line) && strcasecmp(line->section, section) == 0 &&
            strcasecmp(line->key + strspn(line->key, "%"), "sinking") == 0)
            return true;
    }
    return false;
}

/* Returns true if a line "%%key" is known in its section. */
static bool key_is_known(const IniLine *line) {
    static const char *const known[][2] = {{"StartDTX", "version"}, {"Info", "shafts"},       {"Info", "treadles"},
                                           {"Info", "ends"},        {"Info", "picks"},        {"Tieup", "sinking"},
                                           {"Liftplan", "sinking"}, {"Treadling", "compound"}};
    const char *text = line->key + strspn(line->key, "%");
    for (size_t k = 0; k < sizeof known / sizeof *known; k++) {
        const size_t size = strlen(known[k][1]);
        if (strcasecmp(line->section, known[k][0]) == 0 && strncasecmp(text, known[k][1], size) == 0 &&
            strchr(" \t", text[size]))
            return true;
    }
    return false;
}

static void warn_of(const Dtx *dtx, const IniLine *line, const char *why) {
    warn(dtx->log, WEFT_MESSAGE_DRAFT_COMPLETED, dtx->name, "line %d: @@%.40s: %.60s: %s", line->number, line->section,
         line->key, why);
}

/* Warns of keys and of sections that are not known; of a section once. */
static void check_lines(const Dtx *dtx) {
    const char *told = NULL;
    for (int k = 0; k < dtx->file.count; k++) {
        const IniLine *line = &dtx->file.lines[k];
        int of = 0;
        while (of < SECTIONS && !is_of(line, &sections[of])) of++;
        if (of == SECTIONS && line->section != told) {
            warn_of(dtx, line, "the section is not known and was passed over");
            told = line->section;
        } else if (of < SECTIONS && (sections[of].wif || strcasecmp(sections[of].name, "Info") == 0) && is_key(line) &&
                   !key_is_known(line))
            warn_of(dtx, line, "the key is not known and was passed over");
    }
}

/* ---- the file ---- */

/* Cuts the text into lines by section. Returns false if memory is short. */
static bool cut(Dtx *dtx, const void *data, size_t size) {
    Ini *file = &dtx->file;
    file->text = alloc_array(size + 1, 1);
    if (!file->text) return false;
    memcpy(file->text, data, size);
    const char *section = "";
    int number = 0;
    for (char *line = file->text + mark_size(data, size), *next; *line; line = next) {
        char *end = line + strcspn(line, "\r\n");
        next = end + (*end == '\r' && end[1] == '\n') + (*end != '\0');
        number++;
        *end = '\0';
        while (end > line && strchr(" \t", end[-1])) *--end = '\0';
        line += strspn(line, " \t");
        if (line[0] == '@' && line[1] == '@') section = line + 2 + strspn(line + 2, " \t");
        if (*line == '\0' || (line[0] == '@' && line[1] == '@')) continue;
        if (!ini_add(file, (IniLine){.section = section, .key = line, .number = number})) return false;
    }
    return true;
}

static bool has_section(const Dtx *dtx, const char *name) {
    for (int k = 0; k < dtx->file.count; k++)
        if (strcasecmp(dtx->file.lines[k].section, name) == 0) return true;
    return false;
}

/* Writes the sections of WIF that are of numbers in Info. */
static void put_info(Dtx *dtx) {
    static const char *const wif[][2] = {{"WARP", "ends"}, {"WEFT", "picks"}};
    put_section(dtx, "WIF");
    put(dtx, 1, "Version=1.1");
    put_section(dtx, "WEAVING");
    put(dtx, 1, "Rising Shed=%s", sinks(dtx, has_section(dtx, "Tieup") ? "Tieup" : "Liftplan") ? "no" : "yes");
    put_stated(dtx, "shafts", "Shafts");
    put_stated(dtx, "treadles", "Treadles");
    for (int t = 0; t < 2; t++) {
        put_section(dtx, wif[t][0]);
        put(dtx, 1, "Units=centimeters");
        put(dtx, 1, "Spacing=%.6g", STEPS * STEP);
        if (has_section(dtx, "Color Palet") || has_section(dtx, "Color Palette")) put(dtx, 1, "Color=%d", t + 1);
        put_stated(dtx, wif[t][1], "Threads");
    }
}

bool dtx_is(const void *data, size_t size) {
    static const char mark[] = "@@StartDTX";
    const char *text = data;
    size_t at = mark_size(data, size);
    while (at < size && text[at] && strchr(" \t\r\n", text[at])) at++;
    return size - at >= sizeof mark - 1 && strncasecmp(text + at, mark, sizeof mark - 1) == 0;
}

WeftResult dtx_read(const void *data, size_t size, const char *name, const WeftLog *log, Ini *out, WeftError *error) {
    Dtx dtx = {.name = name, .log = log};
    char *text = NULL;
    size_t length = 0;
    *out = (Ini){.name = name};
    dtx.stream = open_memstream(&text, &length);
    if (memchr(data, '\0', size) == NULL && dtx.stream && cut(&dtx, data, size)) {
        check_lines(&dtx);
        put_info(&dtx);
        for (int k = 0; k < SECTIONS; k++)
            if (sections[k].read && has_section(&dtx, sections[k].name)) sections[k].read(&dtx, &sections[k]);
    } else
        dtx.short_of_memory = true;
    if (dtx.stream && fclose(dtx.stream) != 0) dtx.short_of_memory = true;
    WeftResult result = memchr(data, '\0', size) ? fail(error, WEFT_MESSAGE_DRAFT, name, "it has zero bytes")
                        : dtx.short_of_memory    ? fail(error, WEFT_MESSAGE_MEMORY, name, NULL)
                                                 : ini_read(text, length, name, out, error);
    for (int k = 0; result == WEFT_OK && k < out->count && k < dtx.count; k++) out->lines[k].number = dtx.numbers[k];
    free(text);
    free(dtx.numbers);
    ini_free(&dtx.file);
    return result;
}
