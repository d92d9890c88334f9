/* wif_write.c - writer of WIF 1.1 with threading, tie-up and treadling of the smallest loom */
#define _POSIX_C_SOURCE 200809L /* open_memstream */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/fail.h"
#include "base/memory.h"
#include "weave/loom.h"

/* The colours of all threads, in the order of their first use. */
typedef struct Colors {
    unsigned char (*table)[3]; /* sRGB */
    int count;
    int *of[2]; /* index in the table, by thread */
} Colors;

/* Collects the colours. Returns false if memory is short. */
static bool colors_of(const WeftDraft *draft, Colors *out) {
    const size_t all = (size_t)draft->count[0] + (size_t)draft->count[1];
    *out = (Colors){.table = alloc_array(all, sizeof *out->table)};
    for (int t = 0; t < 2; t++) {
        out->of[t] = alloc_array((size_t)draft->count[t], sizeof(int));
        for (int k = 0; out->table && out->of[t] && k < draft->count[t]; k++) {
            unsigned char color[3];
            int place = 0;
            for (int c = 0; c < 3; c++) color[c] = (unsigned char)lroundf(255.0f * draft->threads[t][k].color[c]);
            while (place < out->count && memcmp(out->table[place], color, 3) != 0) place++;
            if (place == out->count) memcpy(out->table[out->count++], color, 3);
            out->of[t][k] = place;
        }
    }
    return out->table && out->of[0] && out->of[1];
}

static void colors_free(Colors *colors) {
    free(colors->table);
    free(colors->of[0]);
    free(colors->of[1]);
}

static void write_head(const WeftDraft *draft, const Loom *loom, FILE *stream) {
    fputs("[WIF]\nVersion=1.1\nDate=April 20, 1997\nDevelopers=wif@mhsoft.com\nSource Program=weft\n"
          "Source Version=" WEFT_VERSION "\n\n[CONTENTS]\nCOLOR PALETTE=true\nCOLOR TABLE=true\n"
          "WEAVING=true\nWARP=true\nWEFT=true\nTHREADING=true\nTIEUP=true\nTREADLING=true\nWARP COLORS=true\n"
          "WEFT COLORS=true\nWARP SPACING=true\nWEFT SPACING=true\nWARP THICKNESS=true\nWEFT THICKNESS=true\n",
          stream);
    if (draft->title[0]) fprintf(stream, "TEXT=true\n\n[TEXT]\nTitle=%s\n", draft->title);
    fprintf(stream, "\n[WEAVING]\nShafts=%d\nTreadles=%d\nRising Shed=true\n", loom->shafts, loom->treadles);
}

static void write_threads(const WeftDraft *draft, const Colors *colors, FILE *stream) {
    static const char *const names[] = {"WARP", "WEFT"};
    for (int t = 0; t < 2; t++) {
        const WeftThread *of = draft->threads[t];
        fprintf(stream, "\n[%s]\nThreads=%d\nUnits=centimeters\nSpacing=%.6g\nThickness=%.6g\n", names[t],
                draft->count[t], 100.0 * (double)of[0].spacing, 100.0 * (double)of[0].thickness);
        fprintf(stream, "\n[%s COLORS]\n", names[t]);
        for (int k = 0; k < draft->count[t]; k++) fprintf(stream, "%d=%d\n", k + 1, colors->of[t][k] + 1);
        fprintf(stream, "\n[%s SPACING]\n", names[t]);
        for (int k = 0; k < draft->count[t]; k++) fprintf(stream, "%d=%.6g\n", k + 1, 100.0 * (double)of[k].spacing);
        fprintf(stream, "\n[%s THICKNESS]\n", names[t]);
        for (int k = 0; k < draft->count[t]; k++) fprintf(stream, "%d=%.6g\n", k + 1, 100.0 * (double)of[k].thickness);
    }
    fprintf(stream, "\n[COLOR PALETTE]\nEntries=%d\nForm=RGB\nRange=0,255\n\n[COLOR TABLE]\n", colors->count);
    for (int k = 0; k < colors->count; k++)
        fprintf(stream, "%d=%d,%d,%d\n", k + 1, colors->table[k][0], colors->table[k][1], colors->table[k][2]);
}

static void write_loom(const WeftDraft *draft, const Loom *loom, FILE *stream) {
    fputs("\n[THREADING]\n", stream);
    for (int k = 0; k < draft->count[WEFT_WARP]; k++) fprintf(stream, "%d=%d\n", k + 1, loom->threading[k] + 1);
    fputs("\n[TIEUP]\n", stream);
    for (int treadle = 0; treadle < loom->treadles; treadle++) {
        const char *before = "";
        fprintf(stream, "%d=", treadle + 1);
        for (int shaft = 0; shaft < loom->shafts; shaft++) {
            if (!loom->tieup[treadle * loom->shafts + shaft]) continue;
            fprintf(stream, "%s%d", before, shaft + 1);
            before = ",";
        }
        fputc('\n', stream);
    }
    fputs("\n[TREADLING]\n", stream);
    for (int k = 0; k < draft->count[WEFT_WEFT]; k++) fprintf(stream, "%d=%d\n", k + 1, loom->treadling[k] + 1);
}

WeftResult wif_write(const WeftDraft *draft, FILE *stream, const char *name, WeftError *error) {
    Loom loom;
    Colors colors;
    const bool made = loom_of(draft, &loom), dyed = colors_of(draft, &colors);
    if (made && dyed) {
        write_head(draft, &loom, stream);
        write_threads(draft, &colors, stream);
        write_loom(draft, &loom, stream);
    }
    loom_free(&loom);
    colors_free(&colors);
    return made && dyed ? WEFT_OK : fail(error, WEFT_MESSAGE_MEMORY, name, NULL);
}

char *wif_text(const WeftDraft *draft) {
    char *text = NULL;
    size_t size = 0;
    FILE *stream = open_memstream(&text, &size);
    if (!stream) return NULL;
    const bool written = wif_write(draft, stream, draft->title, NULL) == WEFT_OK;
    const bool whole = fclose(stream) == 0 && written;
    if (!whole) free(text);
    return whole ? text : NULL;
}
