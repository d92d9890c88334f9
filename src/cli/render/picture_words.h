/* picture_words.h - all that the pixels of a picture depend on, and how it is shown, as words KEY=VALUE with a blank
 * between, by which files of several processes are known to be of one picture */
#pragma once

#include "cli/render/job.h"

/* Appends the words of the picture of a job to `words`, of PART_WORDS bytes. desc is that of its render, with a crop. */
WeftResult picture_words(const Job *job, const WeftRenderDesc *desc, char *words, WeftError *error);

/* Returns the value of a word, and its length; NULL where there is no such key. */
const char *word_value(const char *words, const char *key, size_t *length);

/* Reads `wanted` numbers of a word, with "," or "x" between; returns true if there are just so many. */
bool word_numbers(const char *words, const char *key, int wanted, double *numbers);

enum { WORDS_DIFFERENCE = 160 };

/* Returns true if the words are those wanted, but for those with keys in `but`, which ends with NULL; else writes to
 * `text` how they differ, "spp=21, and not spp=20". */
bool words_same(const char *words, const char *wanted, const char *const *but, char text[WORDS_DIFFERENCE]);
