#include "weave/loom.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"

/* Columns or rows of a draft: `count` lines of crossings, whose bytes lie `step` apart. */
typedef struct LoomLines {
    const unsigned char *cells;
    size_t line_step, step;
    int count, length;
} LoomLines;

static LoomLines columns_of(const WeftDraft *draft) {
    return (LoomLines){draft->up, 1, (size_t)draft->count[WEFT_WARP], draft->count[WEFT_WARP], draft->count[WEFT_WEFT]};
}

static LoomLines rows_of(const WeftDraft *draft) {
    return (LoomLines){draft->up, (size_t)draft->count[WEFT_WARP], 1, draft->count[WEFT_WEFT], draft->count[WEFT_WARP]};
}

static bool same(const LoomLines *lines, int a, int b) {
    const unsigned char *x = lines->cells + (size_t)a * lines->line_step,
                        *y = lines->cells + (size_t)b * lines->line_step;
    for (int k = 0; k < lines->length; k++)
        if (x[(size_t)k * lines->step] != y[(size_t)k * lines->step]) return false;
    return true;
}

/* Returns the hash FNV-1a of a line: lines with different hashes differ. Glenn Fowler, Landon Curt Noll, Kiem-Phong Vo,
 * 1991. */
static uint64_t hash_of(const LoomLines *lines, int line) {
    uint64_t hash = 0xcbf29ce484222325u;
    for (int k = 0; k < lines->length; k++)
        hash = (hash ^ lines->cells[(size_t)line * lines->line_step + (size_t)k * lines->step]) * 0x100000001b3u;
    return hash;
}

/* Gives each different line a number: group[line] is the kind of a line, firsts[kind] the first line of a kind. Returns
 * how many kinds there are, 0 if memory is short. */
static int kinds_of(const LoomLines *lines, int *group, int *firsts) {
    uint64_t *hashes = alloc_array((size_t)lines->count, sizeof *hashes);
    int kinds = 0;
    for (int line = 0; hashes && line < lines->count; line++) {
        const uint64_t hash = hash_of(lines, line);
        int kind = 0;
        while (kind < kinds && !(hashes[kind] == hash && same(lines, firsts[kind], line))) kind++;
        group[line] = kind;
        if (kind < kinds) continue;
        hashes[kinds] = hash;
        firsts[kinds++] = line;
    }
    free(hashes);
    return kinds;
}

bool loom_of(const WeftDraft *draft, Loom *out) {
    const int warps = draft->count[WEFT_WARP], picks = draft->count[WEFT_WEFT];
    const LoomLines columns = columns_of(draft), rows = rows_of(draft);
    int *first_warp = alloc_array((size_t)warps, sizeof *first_warp),
        *first_pick = alloc_array((size_t)picks, sizeof *first_pick);
    *out = (Loom){.threading = alloc_array((size_t)warps, sizeof *out->threading),
                  .treadling = alloc_array((size_t)picks, sizeof *out->treadling)};
    if (first_warp && first_pick && out->threading && out->treadling) {
        out->shafts = kinds_of(&columns, out->threading, first_warp);
        out->treadles = kinds_of(&rows, out->treadling, first_pick);
        out->tieup = alloc_array((size_t)out->shafts * (size_t)out->treadles, 1);
        for (int treadle = 0; out->tieup && treadle < out->treadles; treadle++)
            for (int shaft = 0; shaft < out->shafts; shaft++)
                out->tieup[treadle * out->shafts + shaft] =
                    draft->up[(size_t)first_pick[treadle] * (size_t)warps + (size_t)first_warp[shaft]];
    }
    free(first_warp);
    free(first_pick);
    return out->tieup && out->shafts && out->treadles;
}

void loom_free(Loom *loom) {
    free(loom->threading);
    free(loom->treadling);
    free(loom->tieup);
    *loom = (Loom){0};
}
