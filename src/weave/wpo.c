#define _POSIX_C_SOURCE 200809L /* open_memstream */
#include "weave/wpo.h"

#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

#include "base/fail.h"

enum { MARK = 123, LIFT_PLAN = 100, TREADLES = 102, GRIDS = 66, WIDER_COLORS = 4 };

/* The file, and the WIF that is made of it. */
typedef struct Wpo {
    const uint8_t *at, *end;
    bool is_short; /* more was read than there is */
    FILE *stream;
} Wpo;

/* Returns the next number of so many bytes; 0 beyond the end. */
static int take(Wpo *wpo, int bytes) {
    int number = 0;
    for (int k = 0; k < bytes; k++) {
        if (wpo->at == wpo->end) wpo->is_short = true;
        number = 256 * number + (wpo->at < wpo->end ? *wpo->at++ : 0);
    }
    return number;
}

static void skip(Wpo *wpo, int bytes) {
    for (int k = 0; k < bytes; k++) take(wpo, 1);
}

/* Writes a list of numbers as a section, each with `plus` added. */
static void put_list(Wpo *wpo, const char *section, int plus) {
    const int count = take(wpo, 2);
    fprintf(wpo->stream, "[%s]\n", section);
    for (int k = 1; k <= count && !wpo->is_short; k++) fprintf(wpo->stream, "%d=%d\n", k, take(wpo, 1) + plus);
}

/* Writes a list of sets of up to `members` as a section. */
static void put_sets(Wpo *wpo, const char *section, int members, int count) {
    fprintf(wpo->stream, "[%s]\n", section);
    for (int k = 1; k <= count && !wpo->is_short; k++) {
        fprintf(wpo->stream, "%d=", k);
        for (int byte = 0; byte < (members + 7) / 8; byte++) {
            const int bits = take(wpo, 1);
            for (int bit = 0; bit < 8; bit++)
                if (bits >> bit & 1) fprintf(wpo->stream, "%d,", 8 * byte + bit + 1);
        }
        fputc('\n', wpo->stream);
    }
}

static void put_system(Wpo *wpo, const char *section, int threads, int per_inch) {
    fprintf(wpo->stream, "[%s]\nThreads=%d\n", section, threads);
    if (per_inch) fprintf(wpo->stream, "Units=inches\nSpacing=%.9g\n", 1.0 / per_inch);
}

/* Writes what lifts the shafts. */
static void put_lift(Wpo *wpo, int kind, int shafts, int treadles) {
    if (kind == LIFT_PLAN) {
        put_sets(wpo, "LIFTPLAN", shafts, take(wpo, 2));
        return;
    }
    put_sets(wpo, "TIEUP", shafts, treadles);
    if (kind == TREADLES)
        put_sets(wpo, "TREADLING", treadles, take(wpo, 2));
    else
        put_list(wpo, "TREADLING", 0);
}

static void put_file(Wpo *wpo) {
    skip(wpo, 1);
    const int version = take(wpo, 1), kind = take(wpo, 1);
    skip(wpo, 1);
    const int shafts = take(wpo, 1), treadles = take(wpo, 1);
    skip(wpo, 1);
    const bool rises = take(wpo, 1) == 0;
    skip(wpo, 1);
    const int epi = take(wpo, 1), ppi = take(wpo, 1);
    skip(wpo, 2);
    fprintf(wpo->stream, "[WIF]\nVersion=1.1\n[WEAVING]\nRising Shed=%s\n", rises ? "yes" : "no");
    put_system(wpo, "WARP", take(wpo, 2), epi);
    put_system(wpo, "WEFT", take(wpo, 2), ppi);
    skip(wpo, 7);
    put_list(wpo, "THREADING", 0);
    put_list(wpo, "WARP COLORS", 1);
    put_list(wpo, "WEFT COLORS", 1);
    put_lift(wpo, kind, shafts, treadles);
    skip(wpo, GRIDS);
    const int colors = take(wpo, 1);
    fprintf(wpo->stream, "[COLOR PALETTE]\nRange=0,%d\n[COLOR TABLE]\n", version < WIDER_COLORS ? 63 : 255);
    for (int k = 1; k <= colors && !wpo->is_short; k++) {
        const int r = take(wpo, 1), g = take(wpo, 1), b = take(wpo, 1);
        fprintf(wpo->stream, "%d=%d,%d,%d\n", k, r, g, b);
    }
}

bool wpo_is(const void *data, size_t size) {
    const uint8_t *bytes = data;
    return size > 2 && bytes[0] == MARK && bytes[1] < 32 && bytes[2] >= LIFT_PLAN && bytes[2] <= TREADLES;
}

WeftResult wpo_read(const void *data, size_t size, const char *name, Ini *out, WeftError *error) {
    Wpo wpo = {.at = data, .end = (const uint8_t *)data + size};
    char *text = NULL;
    size_t length = 0;
    *out = (Ini){.name = name};
    wpo.stream = open_memstream(&text, &length);
    if (wpo.stream) put_file(&wpo);
    const bool written = wpo.stream && fclose(wpo.stream) == 0;
    WeftResult result = !written ? fail(error, WEFT_MESSAGE_MEMORY, name, NULL)
                        : wpo.is_short
                            ? fail(error, WEFT_MESSAGE_DRAFT, name, "it is a file of WeavePoint that is cut short")
                            : ini_read(text, length, name, out, error);
    free(text);
    return result;
}
