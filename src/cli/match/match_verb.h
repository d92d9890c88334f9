/* match_verb.h - one match of `weft match`: what was typed, where the search begins, and what it found */
#pragma once

#include "cli/console/options.h"
#include "cli/operands/model.h"

typedef struct Match {
    const Options *options;
    WeftBrdfMetric metric;
    Model from, to; /* `to` becomes the match */
    Model copy;     /* `to` with the numbers of `from` as they are: where the search begins */
    WeftMatch found;
} Match;

/* Reads both and makes the copy; release with match_free in any case. Returns 0 or an exit code after one
 * line on standard error; so do the next two. */
int match_begin(Match *match, const char *from, const char *to);
int match_search(Match *match);
void match_free(Match *match);

/* Returns true if both models have inputs: profiles and materials do. */
bool match_has_parts(const Match *match);

/* Writes the sheet: from, copy and match, and how the last two differ from the first. */
int match_sheet_write(const Match *match, const char *path);

/* Runs `weft match --table`, which matches every profile to every other. */
int match_table(const Options *options, WeftBrdfMetric metric);

/* Runs `weft match --maps`, which matches every sheen to every other over a sweep of its width. */
int match_maps(const Options *options, WeftBrdfMetric metric);

/* Runs `weft match ASSET --from P --to Q -o OUT` and `--workflow`. */
int match_asset(const Options *options, WeftBrdfMetric metric);
