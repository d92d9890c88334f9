/* audit_words.h - the sentence on each thing that can be wrong with a table */
#pragma once

#include "measure/audit/audit_probe.h"

/* The functions append to text[WEFT_AUDIT_TEXT]. `stated` is the reading that the caller stated, `found` the
 * one that explains the table. */

/* Describes a table whose `count` texels are all `value`. */
void words_constant(char *text, double value, size_t count);

/* Describes another form. `enough`: a mean error that counts as none. */
void words_form(char *text, const ProbeReading *stated, const ProbeReading *found, double enough);

void words_late(char *text, const ProbeReading *stated, const ProbeReading *found);
void words_encoded(char *text, const ProbeReading *stated, const ProbeReading *found);
/* Describes a table that is cut off at `top` in `texels` texels, while E reaches `highest`. */
void words_clipped(char *text, double top, double highest, size_t texels);

void words_scaled(char *text, const ProbeReading *stated, const ProbeReading *found);
void words_lobe(char *text, const ProbeReading *stated, const ProbeReading *found);

/* Says that the nearest reading of all lobes is not near. */
void words_no_lobe(char *text, const ProbeReading *nearest);

/* Describes a bias. ratios: table / E at a tenth, half and nine tenths of the texels. */
void words_biased(char *text, const WeftAudit *audit, const double ratios[3]);
void words_noisy(char *text, const WeftAudit *audit);
void words_corner(char *text, const WeftAudit *audit, double most, int lobe);
void words_none(char *text, const WeftAudit *audit);
