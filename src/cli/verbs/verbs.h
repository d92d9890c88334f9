/* verbs.h - the commands of the program: one table and one file each */
#ifndef WEFT_CLI_VERBS_H
#define WEFT_CLI_VERBS_H

#include "cli/console/options.h"

extern const Verb verb_render, verb_models, verb_eval, verb_check, verb_plot, verb_bake, verb_export,
    verb_diff, verb_doctor, verb_match, verb_fit, verb_weave;
#ifdef WEFT_VIEW
extern const Verb verb_view;
#endif

#endif
