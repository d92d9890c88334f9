/* verbs.h - the commands of the program: one row and one file each */
#pragma once

#include "cli/console/options.h"

#ifdef WEFT_VIEW
#define VERB_VIEW(V) V(view)
#else
#define VERB_VIEW(V)
#endif

/* V(name): verb_name of the file NAME.c, in the order of `weft --help`. */
#define VERBS(V)                                                                                                       \
    V(render)                                                                                                          \
    V(merge)                                                                                                           \
    V(farm)                                                                                                            \
    VERB_VIEW(V)                                                                                                       \
    V(models)                                                                                                          \
    V(eval)                                                                                                            \
    V(check)                                                                                                           \
    V(plot)                                                                                                            \
    V(bake)                                                                                                            \
    V(export)                                                                                                          \
    V(match)                                                                                                           \
    V(deliver)                                                                                                         \
    V(fit)                                                                                                             \
    V(diff)                                                                                                            \
    V(convert)                                                                                                         \
    V(judge)                                                                                                           \
    V(doctor)                                                                                                          \
    V(weave)

#define VERB_DECLARED(name) extern const Verb verb_##name;
VERBS(VERB_DECLARED)
