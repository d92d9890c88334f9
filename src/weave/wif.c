/* wif.c - reader of WIF, the Weaving Information File
 *
 * Ralph Nielsen et al., "Weaving Information File Version", 1.1, 20 April 1997. A shaft is a number in
 * THREADING and TIEUP, a treadle one in TREADLING:
 *
 *   up(warp, pick) = THREADING[warp] and lift[pick] share a shaft
 *   lift[pick] = all TIEUP[treadle] of TREADLING[pick], or LIFTPLAN[pick] where the tie-up or the treadling is missing
 *
 * "Rising Shed=no" means that shafts sink, which inverts up. Programs leave out much that the format requires;
 * docs/weave.md lists how it is completed. */
#include "weave/wif.h"

#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "base/fail.h"
#include "base/memory.h"
#include "weave/dtx.h"
#include "weave/wpo.h"

/* Sets of shafts or treadles, numbered from 1: `words` words of 64 each. */
typedef struct Sets {
    uint64_t *bits;
    size_t words;
    long count;
} Sets;

/* Returns the value of a key as a number, or -1 if it is missing or is none; *line is its line. */
static long whole_of(const Wif *wif, const char *section, const char *key, const IniLine **line) {
    long number;
    *line = ini_find(&wif->ini, section, key);
    return *line && wif_whole((*line)->value, &number) ? number : -1;
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
        if (!key || key > WEFT_DRAFT_SIDE_MAX) return wif_refuse(wif, line, "the key is no number from 1 to 8192");
        if (key > *keys) *keys = key;
        const char *cursor = line->value;
        int more;
        while ((more = wif_next(&cursor, &number)) == 1) {
            if (number > WEFT_DRAFT_SIDE_MAX) return wif_refuse(wif, line, "a number is above 8192");
            if (number > *values) *values = number;
        }
        if (more < 0) return wif_refuse(wif, line, "a list of numbers is expected");
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
        for (const char *cursor = line->value; wif_next(&cursor, &number) == 1;)
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
    bool has_plan, has_treadles; /* a lift plan; a tie-up and a treadling */
    Sets threading, lift;        /* shafts of each warp thread, and lifted by each pick */
} Shed;

/* Reads the Threads of a system, or else takes the number of its lines. */
static long threads_of(Wif *wif, const char *section, long lines) {
    const IniLine *line;
    const long threads = whole_of(wif, section, "Threads", &line);
    if (threads == 0) wif_note(wif, line, WIF_VALUE);
    return threads < 1 ? lines : threads;
}

/* Notes that [WEAVING] states fewer than are used. */
static void compare_stated(Wif *wif, const char *key, long used) {
    const IniLine *line;
    const long stated = whole_of(wif, "WEAVING", key, &line);
    if (stated > 0 && stated < used) wif_note(wif, line, WIF_FEWER);
}

/* Finds how many threads, shafts and treadles there are, and what lifts the shafts. A section without a number above 0
 * counts as missing if there is another to take. */
static WeftResult shed_extent(Wif *wif, Shed *shed) {
    long threaded = 0, lifted = 0, tied = 0, pressed = 0, on_treadles = 0, in_plan = 0;
    WeftResult result = section_extent(wif, "THREADING", &threaded, &shed->shafts);
    if (result == WEFT_OK) result = section_extent(wif, "LIFTPLAN", &lifted, &in_plan);
    if (result == WEFT_OK) result = section_extent(wif, "TIEUP", &tied, &on_treadles);
    if (result == WEFT_OK) result = section_extent(wif, "TREADLING", &pressed, &shed->treadles);
    if (result != WEFT_OK) return result;
    shed->has_treadles = tied && pressed && ((on_treadles && shed->treadles) || !in_plan);
    shed->has_plan = lifted && (in_plan || !shed->has_treadles);
    if (tied > shed->treadles) shed->treadles = tied;
    if (in_plan > shed->shafts) shed->shafts = in_plan;
    if (on_treadles > shed->shafts) shed->shafts = on_treadles;
    const char *missing = !threaded                              ? "it has no [THREADING]"
                          : shed->has_plan || shed->has_treadles ? NULL
                                                                 : "it has neither a [LIFTPLAN] nor [TIEUP] and "
                                                                   "[TREADLING]";
    if (missing) return fail(wif->error, WEFT_MESSAGE_DRAFT, wif->ini.name, "%s", missing);
    shed->warps = threads_of(wif, "WARP", threaded);
    shed->picks = threads_of(wif, "WEFT", lifted > pressed ? lifted : pressed);
    compare_stated(wif, "Shafts", shed->shafts);
    compare_stated(wif, "Treadles", pressed ? shed->treadles : 0);
    return WEFT_OK;
}

static void warn_of_beyond(const Wif *wif, int lines, const char *section, long threads, const char *what) {
    if (lines)
        warn(wif->log, WEFT_MESSAGE_DRAFT_COMPLETED, wif->ini.name,
             "%d lines of [%s] are beyond the %ld %s and were left out", lines, section, threads, what);
}

/* Adds the shafts that each pick's treadles lift to `lift`. */
static WeftResult press_treadles(const Wif *wif, const Shed *shed, Sets *lift) {
    Sets tieup = {0}, treadling = {0};
    WeftResult result = WEFT_OK;
    if (sets_create(&tieup, shed->treadles, shed->shafts) && sets_create(&treadling, shed->picks, shed->treadles)) {
        sets_fill(wif, "TIEUP", &tieup);
        warn_of_beyond(wif, sets_fill(wif, "TREADLING", &treadling), "TREADLING", shed->picks, "picks of [WEFT]");
        for (long pick = 1; pick <= shed->picks; pick++)
            for (long treadle = 1; treadle <= shed->treadles; treadle++)
                if (set_has(&treadling, pick, treadle))
                    for (size_t w = 0; w < lift->words; w++) set_at(lift, pick)[w] |= set_at(&tieup, treadle)[w];
    } else
        result = wif_memory(wif);
    free(tieup.bits);
    free(treadling.bits);
    return result;
}

/* Makes the lift of each pick of the tie-up and the treadling, or else reads the lift plan. Where there are both, the
 * guide of 2026 lets tie-up and treadling win: they record how the loom is tied, and programs add a lift plan to each
 * file for readers that know nothing else. */
static WeftResult read_lift(const Wif *wif, Shed *shed) {
    if (!sets_create(&shed->lift, shed->picks, shed->shafts)) return wif_memory(wif);
    if (!shed->has_plan) return press_treadles(wif, shed, &shed->lift);
    Sets plan;
    if (!sets_create(&plan, shed->picks, shed->shafts)) return wif_memory(wif);
    const int beyond = sets_fill(wif, "LIFTPLAN", &plan);
    WeftResult result = shed->has_treadles ? press_treadles(wif, shed, &shed->lift) : WEFT_OK;
    const size_t bytes = (size_t)shed->picks * shed->lift.words * sizeof *plan.bits;
    if (!shed->has_treadles) {
        warn_of_beyond(wif, beyond, "LIFTPLAN", shed->picks, "picks of [WEFT]");
        memcpy(set_at(&shed->lift, 1), set_at(&plan, 1), bytes);
    } else if (result == WEFT_OK && memcmp(set_at(&plan, 1), set_at(&shed->lift, 1), bytes) != 0)
        warn(wif->log, WEFT_MESSAGE_DRAFT_COMPLETED, wif->ini.name,
             "[TREADLING] lifts other shafts than [LIFTPLAN]; tie-up and treadling were taken, since they are the "
             "loom's own (guide to WIF of 2026)");
    free(plan.bits);
    return result;
}

static void warn_of_empty(const Wif *wif, const Sets *sets, const char *what) {
    int empty = 0;
    for (long k = 1; k <= sets->count; k++) empty += set_is_empty(sets, k);
    if (empty) warn(wif->log, WEFT_MESSAGE_DRAFT_COMPLETED, wif->ini.name, "%d of %ld %s", empty, sets->count, what);
}

/* Reads the crossings of the draft. */
static WeftResult read_shed(const Wif *wif, WeftDraft *draft, Shed *shed) {
    if (!sets_create(&shed->threading, shed->warps, shed->shafts)) return wif_memory(wif);
    const int beyond = sets_fill(wif, "THREADING", &shed->threading);
    WeftResult result = read_lift(wif, shed);
    if (result != WEFT_OK) return result;
    warn_of_beyond(wif, beyond, "THREADING", shed->warps, "threads of [WARP]");
    warn_of_empty(wif, &shed->threading, "warp threads are on no shaft and never rise");
    warn_of_empty(wif, &shed->lift, "picks lift no shaft");
    bool rising = true;
    const IniLine *line = ini_find(&wif->ini, "WEAVING", "Rising Shed");
    if (line) wif_flag(line->value, &rising);
    for (long pick = 1; pick <= shed->picks; pick++)
        for (long warp = 1; warp <= shed->warps; warp++) {
            uint64_t shared = 0;
            for (size_t w = 0; w < shed->lift.words; w++)
                shared |= set_at(&shed->threading, warp)[w] & set_at(&shed->lift, pick)[w];
            draft->up[(pick - 1) * shed->warps + warp - 1] = (shared != 0) == rising;
        }
    return WEFT_OK;
}

/* ---- the file ---- */

WeftResult wif_draft(Wif *wif, WeftDraft **out) {
    Shed shed = {0};
    if (!ini_find(&wif->ini, "WIF", NULL))
        return fail(wif->error, WEFT_MESSAGE_DRAFT, wif->ini.name, "it has no section [WIF], or nothing in it");
    WeftResult result = wif_check(wif);
    if (result == WEFT_OK) result = shed_extent(wif, &shed);
    if (result == WEFT_OK)
        result = draft_create(wif->ini.name, shed.warps, shed.picks, WEFT_MESSAGE_DRAFT, out, wif->error);
    if (result == WEFT_OK) result = read_shed(wif, *out, &shed);
    if (result == WEFT_OK) result = wif_read_colors(wif, *out);
    if (result == WEFT_OK) wif_read_lengths(wif, *out);
    const IniLine *title = ini_find(&wif->ini, "TEXT", "Title");
    if (result == WEFT_OK && title) draft_title(*out, title->value);
    if (result == WEFT_OK) wif_tell(wif);
    free(shed.threading.bits);
    free(shed.lift.bits);
    return result;
}

WeftResult weft_draft_read_memory(const void *data, size_t size, const char *name, WeftDraft **out, const WeftLog *log,
                                  WeftError *error) {
    Wif wif = {.log = log, .error = error};
    *out = NULL;
    WeftResult result = dtx_is(data, size)   ? dtx_read(data, size, name, log, &wif.ini, error)
                        : wpo_is(data, size) ? wpo_read(data, size, name, &wif.ini, error)
                                             : ini_read(data, size, name, &wif.ini, error);
    if (result == WEFT_OK) result = wif_draft(&wif, out);
    if (result != WEFT_OK) {
        weft_draft_free(*out);
        *out = NULL;
    }
    free(wif.notes);
    ini_free(&wif.ini);
    return result;
}
