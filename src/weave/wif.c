/* wif.c - reader of WIF, the Weaving Information File
 *
 * Ralph Nielsen et al., "Weaving Information File Version", 1.1, 20 April 1997. A shaft is a number in
 * THREADING and TIEUP, a treadle one in TREADLING:
 *
 *   up(warp, pick) = THREADING[warp] and LIFTPLAN[pick] share a shaft
 *   LIFTPLAN[pick] = all TIEUP[treadle] of TREADLING[pick], if there is none
 *
 * "Rising Shed=no" means that shafts sink, which inverts up. Programs leave out much that the format requires;
 * docs/weave.md lists how it is completed. */
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "base/fail.h"
#include "base/memory.h"
#include "base/number.h"
#include "weave/ini.h"
#include "weave/weave_draft.h"

/* Sets of shafts or treadles, numbered from 1: `words` words of 64 each. */
typedef struct Sets {
    uint64_t *bits;
    size_t words;
    long count;
} Sets;

typedef struct Wif {
    Ini ini;
    const WeftLog *log;
    WeftError *error;
} Wif;

static const char *const thread_sections[] = {"WARP", "WEFT"};

static WeftResult refuse_line(const Wif *wif, const IniLine *line, const char *why) {
    return fail(wif->error, WEFT_MESSAGE_DRAFT, wif->ini.name, "line %d: [%.40s] %.40s: %s", line->number,
                line->section, line->key, why);
}

static WeftResult memory_short(const Wif *wif) { return fail(wif->error, WEFT_MESSAGE_MEMORY, wif->ini.name, NULL); }

/* ---- values ---- */

/* Reads the next number of a list "1,2,3", which ends at a comment. Returns 1, 0 at the end, or -1 for anything
 * else. */
static int next_number(const char **cursor, long *number) {
    const char *text = *cursor + strspn(*cursor, " \t,");
    if (*text == '\0' || *text == ';') return 0;
    if (*text < '0' || *text > '9') return -1;
    char *end;
    *number = strtol(text, &end, 10);
    *cursor = end;
    return *end == '\0' || strchr(" \t,;", *end) ? 1 : -1;
}

/* Returns the value of a key as a number, or -1 if it is missing or is none. */
static long whole_of(const Wif *wif, const char *section, const char *key) {
    const IniLine *line = ini_find(&wif->ini, section, key);
    long number;
    const char *cursor = line ? line->value : NULL;
    return cursor && next_number(&cursor, &number) == 1 ? number : -1;
}

/* Returns the value of a key as a flag, or `otherwise` if it is missing or is none. */
static bool flag_of(const Wif *wif, const char *section, const char *key, bool otherwise) {
    static const char *const yes[] = {"true", "yes", "t", "y", "on", "1"}, *const no[] = {"false", "no",  "f",
                                                                                          "n",     "off", "0"};
    const IniLine *line = ini_find(&wif->ini, section, key);
    for (size_t k = 0; line && line->value && k < sizeof yes / sizeof *yes; k++) {
        if (strcasecmp(line->value, yes[k]) == 0) return true;
        if (strcasecmp(line->value, no[k]) == 0) return false;
    }
    return otherwise;
}

/* ---- sections of numbered lines ---- */

/* Raises *keys and *values to the greatest key and the greatest number in the values of a section. Fails if either is
 * no number, or beyond the limits of a draft. */
static WeftResult section_extent(const Wif *wif, const char *section, long *keys, long *values) {
    for (int k = 0; k < wif->ini.count; k++) {
        const IniLine *line = &wif->ini.lines[k];
        if (strcasecmp(line->section, section) != 0) continue;
        const long key = ini_index(line);
        long number;
        if (!key || key > WEFT_DRAFT_SIDE_MAX) return refuse_line(wif, line, "the key is no number from 1 to 8192");
        if (key > *keys) *keys = key;
        if (!line->value) return refuse_line(wif, line, "there is no \"=\"");
        const char *cursor = line->value;
        int more;
        while ((more = next_number(&cursor, &number)) == 1) {
            if (number > WEFT_DRAFT_SIDE_MAX) return refuse_line(wif, line, "a number is above 8192");
            if (number > *values) *values = number;
        }
        if (more < 0) return refuse_line(wif, line, "a list of numbers is expected");
    }
    return WEFT_OK;
}

static bool sets_create(Sets *sets, long count, long members) {
    *sets = (Sets){.words = (size_t)members / 64 + 1, .count = count};
    sets->bits = alloc_array((size_t)count + 1, sets->words * sizeof *sets->bits);
    return sets->bits != NULL;
}

static uint64_t *set_at(const Sets *sets, long k) { return sets->bits + (size_t)k * sets->words; }

static bool set_has(const Sets *sets, long k, long member) { return set_at(sets, k)[member / 64] >> (member % 64) & 1; }

/* Reads a section into sets; the number 0 stands for no member. Skips lines beyond the last set, and returns how
 * many. */
static int sets_fill(const Wif *wif, const char *section, Sets *sets) {
    int beyond = 0;
    for (int k = 0; k < wif->ini.count; k++) {
        const IniLine *line = &wif->ini.lines[k];
        long number, key = ini_index(line);
        if (strcasecmp(line->section, section) != 0) continue;
        beyond += key > sets->count;
        if (key > sets->count) continue;
        memset(set_at(sets, key), 0, sets->words * sizeof *sets->bits); /* the last line of a key counts */
        for (const char *cursor = line->value; next_number(&cursor, &number) == 1;)
            if (number) set_at(sets, key)[number / 64] |= (uint64_t)1 << (number % 64);
    }
    return beyond;
}

static bool set_is_empty(const Sets *sets, long k) {
    for (size_t w = 0; w < sets->words; w++)
        if (set_at(sets, k)[w]) return false;
    return true;
}

/* ---- the shed ---- */

typedef struct Shed {
    long warps, picks, shafts, treadles;
    Sets threading, lift; /* shafts of each warp thread, and lifted by each pick */
} Shed;

/* Finds how many threads, shafts and treadles there are. */
static WeftResult shed_extent(const Wif *wif, Shed *shed) {
    long threaded = 0, lifted = 0, tied = 0, pressed = 0;
    WeftResult result = section_extent(wif, "THREADING", &threaded, &shed->shafts);
    if (result == WEFT_OK) result = section_extent(wif, "LIFTPLAN", &lifted, &shed->shafts);
    if (result == WEFT_OK) result = section_extent(wif, "TIEUP", &tied, &shed->shafts);
    if (result == WEFT_OK) result = section_extent(wif, "TREADLING", &pressed, &shed->treadles);
    if (result != WEFT_OK) return result;
    if (tied > shed->treadles) shed->treadles = tied;
    const char *missing = !threaded                     ? "it has no [THREADING]"
                          : lifted || (pressed && tied) ? NULL
                                                        : "it has neither a [LIFTPLAN] nor [TIEUP] and [TREADLING]";
    if (missing) return fail(wif->error, WEFT_MESSAGE_DRAFT, wif->ini.name, "%s", missing);
    shed->warps = whole_of(wif, "WARP", "Threads");
    shed->picks = whole_of(wif, "WEFT", "Threads");
    if (shed->warps < 1) shed->warps = threaded;
    if (shed->picks < 1) shed->picks = lifted > pressed ? lifted : pressed;
    return WEFT_OK;
}

/* Adds the shafts that each pick's treadles lift to `lift`. */
static WeftResult press_treadles(const Wif *wif, const Shed *shed, Sets *lift) {
    Sets tieup = {0}, treadling = {0};
    WeftResult result = WEFT_OK;
    if (sets_create(&tieup, shed->treadles, shed->shafts) && sets_create(&treadling, shed->picks, shed->treadles)) {
        sets_fill(wif, "TIEUP", &tieup);
        const int beyond = sets_fill(wif, "TREADLING", &treadling);
        if (beyond)
            warn(wif->log, WEFT_MESSAGE_DRAFT_COMPLETED, wif->ini.name,
                 "%d lines of [TREADLING] are beyond the %ld picks of [WEFT] and were left out", beyond, shed->picks);
        for (long pick = 1; pick <= shed->picks; pick++)
            for (long treadle = 1; treadle <= shed->treadles; treadle++)
                if (set_has(&treadling, pick, treadle))
                    for (size_t w = 0; w < lift->words; w++) set_at(lift, pick)[w] |= set_at(&tieup, treadle)[w];
    } else
        result = memory_short(wif);
    free(tieup.bits);
    free(treadling.bits);
    return result;
}

/* Reads the lift plan, or makes it from the treadling. Warns if there are both and they differ. */
static WeftResult read_lift(const Wif *wif, Shed *shed) {
    if (!sets_create(&shed->lift, shed->picks, shed->shafts)) return memory_short(wif);
    if (!ini_find(&wif->ini, "LIFTPLAN", NULL)) return press_treadles(wif, shed, &shed->lift);
    const int beyond = sets_fill(wif, "LIFTPLAN", &shed->lift);
    if (beyond)
        warn(wif->log, WEFT_MESSAGE_DRAFT_COMPLETED, wif->ini.name,
             "%d lines of [LIFTPLAN] are beyond the %ld picks of [WEFT] and were left out", beyond, shed->picks);
    if (!ini_find(&wif->ini, "TIEUP", NULL) || !ini_find(&wif->ini, "TREADLING", NULL)) return WEFT_OK;
    Sets pressed;
    if (!sets_create(&pressed, shed->picks, shed->shafts)) return memory_short(wif);
    WeftResult result = press_treadles(wif, shed, &pressed);
    const size_t bytes = (size_t)shed->picks * shed->lift.words * sizeof *pressed.bits;
    if (result == WEFT_OK && memcmp(set_at(&pressed, 1), set_at(&shed->lift, 1), bytes) != 0)
        warn(wif->log, WEFT_MESSAGE_DRAFT_COMPLETED, wif->ini.name,
             "[TREADLING] lifts other shafts than [LIFTPLAN]; the lift plan was taken");
    free(pressed.bits);
    return result;
}

static void warn_of_empty(const Wif *wif, const Sets *sets, const char *format) {
    int empty = 0;
    for (long k = 1; k <= sets->count; k++) empty += set_is_empty(sets, k);
    char text[160];
    if (!empty) return;
    snprintf(text, sizeof text, format, empty, sets->count);
    warn(wif->log, WEFT_MESSAGE_DRAFT_COMPLETED, wif->ini.name, "%s", text);
}

/* Reads the crossings of the draft. */
static WeftResult read_shed(const Wif *wif, WeftDraft *draft, Shed *shed) {
    if (!sets_create(&shed->threading, shed->warps, shed->shafts)) return memory_short(wif);
    const int beyond = sets_fill(wif, "THREADING", &shed->threading);
    WeftResult result = read_lift(wif, shed);
    if (result != WEFT_OK) return result;
    if (beyond)
        warn(wif->log, WEFT_MESSAGE_DRAFT_COMPLETED, wif->ini.name,
             "%d lines of [THREADING] are beyond the %ld threads of [WARP] and were left out", beyond, shed->warps);
    warn_of_empty(wif, &shed->threading, "%d of %ld warp threads are on no shaft and never rise");
    warn_of_empty(wif, &shed->lift, "%d of %ld picks lift no shaft");
    const bool rising = flag_of(wif, "WEAVING", "Rising Shed", true);
    for (long pick = 1; pick <= shed->picks; pick++)
        for (long warp = 1; warp <= shed->warps; warp++) {
            uint64_t shared = 0;
            for (size_t w = 0; w < shed->lift.words; w++)
                shared |= set_at(&shed->threading, warp)[w] & set_at(&shed->lift, pick)[w];
            draft->up[(pick - 1) * shed->warps + warp - 1] = (shared != 0) == rising;
        }
    return WEFT_OK;
}

/* ---- colours ---- */

typedef struct Palette {
    float low, range;   /* of the file's numbers */
    float (*colors)[3]; /* 1 .. count, sRGB-encoded; missing ones are grey */
    long count;
} Palette;

static void encode(const Palette *palette, const float values[3], float color[3]) {
    for (int c = 0; c < 3; c++) color[c] = fminf(fmaxf((values[c] - palette->low) / palette->range, 0.0f), 1.0f);
}

static WeftResult read_palette(const Wif *wif, Palette *palette) {
    float ends[2] = {0.0f, 255.0f}, values[3];
    long most = 0;
    const IniLine *range = ini_find(&wif->ini, "COLOR PALETTE", "Range");
    if (range && range->value && (!parse_numbers(range->value, ',', 2, ends) || !(ends[1] > ends[0])))
        return refuse_line(wif, range, "two rising numbers are expected");
    *palette = (Palette){.low = ends[0], .range = ends[1] - ends[0]};
    for (int k = 0; k < wif->ini.count; k++)
        if (strcasecmp(wif->ini.lines[k].section, "COLOR TABLE") == 0 && ini_index(&wif->ini.lines[k]) > most)
            most = ini_index(&wif->ini.lines[k]);
    if (most > 65536)
        return fail(wif->error, WEFT_MESSAGE_DRAFT, wif->ini.name, "[COLOR TABLE] has a colour above 65536");
    palette->colors = alloc_array((size_t)most + 1, sizeof *palette->colors);
    if (!palette->colors) return memory_short(wif);
    palette->count = most;
    for (long k = 0; k <= most; k++)
        for (int c = 0; c < 3; c++) palette->colors[k][c] = 0.5f;
    for (int k = 0; k < wif->ini.count; k++) {
        const IniLine *line = &wif->ini.lines[k];
        if (strcasecmp(line->section, "COLOR TABLE") != 0) continue;
        if (!ini_index(line) || !line->value || !parse_numbers(line->value, ',', 3, values))
            return refuse_line(wif, line, "three numbers are expected");
        encode(palette, values, palette->colors[ini_index(line)]);
    }
    return WEFT_OK;
}

/* Reads "index", "index,r,g,b" (an older form, whose colour is ignored) or "r,g,b". Returns false for anything else, or
 * if the palette lacks the index. */
static bool color_of(const Palette *palette, const char *text, float color[3]) {
    float values[4];
    long index;
    const char *cursor = text;
    if (!text) return false;
    if (parse_numbers(text, ',', 3, values)) {
        encode(palette, values, color);
        return true;
    }
    if (next_number(&cursor, &index) != 1 || index < 1 || index > palette->count) return false;
    memcpy(color, palette->colors[index], sizeof palette->colors[index]);
    return true;
}

/* Reads the colours of threads. A thread without a line gets the colour of [WARP] or [WEFT], or else that of the thread
 * before. */
static WeftResult read_colors(const Wif *wif, WeftDraft *draft, WeftThreads threads, const Palette *palette) {
    static const char *const sections[] = {"WARP COLORS", "WEFT COLORS"};
    const IniLine *common = ini_find(&wif->ini, thread_sections[threads], "Color");
    float color[3];
    const bool has_common = common && color_of(palette, common->value, color);
    WeftThread *of = draft->threads[threads];
    const int count = draft->count[threads];
    unsigned char *given = alloc_array((size_t)count, 1);
    int missing = 0;
    if (!given) return memory_short(wif);
    for (int k = 0; has_common && k < count; k++) memcpy(of[k].color, color, sizeof color);
    for (int k = 0; k < wif->ini.count; k++) {
        const IniLine *line = &wif->ini.lines[k];
        const long index = strcasecmp(line->section, sections[threads]) == 0 ? ini_index(line) : 0;
        if (index < 1 || index > count || !color_of(palette, line->value, color)) continue;
        memcpy(of[index - 1].color, color, sizeof color);
        given[index - 1] = 1;
    }
    for (int k = 0; !has_common && k < count; k++) {
        if (!given[k] && k > 0) memcpy(of[k].color, of[k - 1].color, sizeof color);
        missing += !given[k];
    }
    if (missing && missing < count)
        warn(wif->log, WEFT_MESSAGE_DRAFT_COMPLETED, wif->ini.name,
             "%d of %d threads of [%s] have no colour and take that of the thread before", missing, count,
             thread_sections[threads]);
    free(given);
    return WEFT_OK;
}

/* ---- lengths ---- */

/* Returns the metres of one unit of a system's lengths. A decipoint is a 720th of an inch. */
static double unit_of(const Wif *wif, const char *section) {
    const IniLine *units = ini_find(&wif->ini, section, "Units");
    if (units && units->value && strcasecmp(units->value, "inches") == 0) return 0.0254;
    if (units && units->value && strcasecmp(units->value, "decipoints") == 0) return 0.0254 / 720.0;
    return 0.01;
}

/* Reads a length in metres; returns false unless it is a micrometre to a metre. */
static bool length_of(const IniLine *line, double unit, float *length) {
    float value;
    if (!line || !line->value || !number_prefix(line->value, &value)) return false;
    const double metres = (double)value * unit;
    if (!(metres >= 1e-6 && metres <= 1.0)) return false;
    *length = (float)metres;
    return true;
}

/* Reads the spacing and thickness of threads. */
static void read_lengths(const Wif *wif, WeftDraft *draft, WeftThreads threads) {
    static const char *const spacings[] = {"WARP SPACING", "WEFT SPACING"}, *const thicknesses[] = {"WARP THICKNESS",
                                                                                                    "WEFT THICKNESS"};
    const char *section = thread_sections[threads];
    const double unit = unit_of(wif, section);
    float spacing = DRAFT_SPACING, thickness = 0.0f;
    length_of(ini_find(&wif->ini, section, "Spacing"), unit, &spacing);
    if (!length_of(ini_find(&wif->ini, section, "Thickness"), unit, &thickness)) thickness = spacing;
    WeftThread *of = draft->threads[threads];
    for (int k = 0; k < draft->count[threads]; k++) of[k].spacing = spacing, of[k].thickness = thickness;
    for (int k = 0; k < wif->ini.count; k++) {
        const IniLine *line = &wif->ini.lines[k];
        const long index = ini_index(line);
        if (index < 1 || index > draft->count[threads]) continue;
        if (strcasecmp(line->section, spacings[threads]) == 0) length_of(line, unit, &of[index - 1].spacing);
        if (strcasecmp(line->section, thicknesses[threads]) == 0) length_of(line, unit, &of[index - 1].thickness);
    }
}

static WeftResult read_draft(const Wif *wif, WeftDraft **out) {
    Shed shed = {0};
    Palette palette = {0};
    if (!ini_find(&wif->ini, "WIF", NULL))
        return fail(wif->error, WEFT_MESSAGE_DRAFT, wif->ini.name, "it has no section [WIF], or nothing in it");
    WeftResult result = shed_extent(wif, &shed);
    if (result == WEFT_OK)
        result = draft_create(wif->ini.name, shed.warps, shed.picks, WEFT_MESSAGE_DRAFT, out, wif->error);
    if (result == WEFT_OK) result = read_shed(wif, *out, &shed);
    if (result == WEFT_OK) result = read_palette(wif, &palette);
    for (int t = 0; result == WEFT_OK && t < 2; t++) {
        result = read_colors(wif, *out, (WeftThreads)t, &palette);
        read_lengths(wif, *out, (WeftThreads)t);
    }
    const IniLine *title = ini_find(&wif->ini, "TEXT", "Title");
    if (result == WEFT_OK && title && title->value) draft_title(*out, title->value);
    free(shed.threading.bits);
    free(shed.lift.bits);
    free(palette.colors);
    return result;
}

WeftResult weft_draft_read_memory(const void *data, size_t size, const char *name, WeftDraft **out, const WeftLog *log,
                                  WeftError *error) {
    Wif wif = {.log = log, .error = error};
    *out = NULL;
    WeftResult result = ini_read(data, size, name, &wif.ini, error);
    if (result == WEFT_OK) result = read_draft(&wif, out);
    if (result != WEFT_OK) {
        weft_draft_free(*out);
        *out = NULL;
    }
    ini_free(&wif.ini);
    return result;
}
