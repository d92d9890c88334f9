/* choice.h - what each choice of inputs.h may be, by id */
#ifndef WEFT_SHADING_CHOICE_H
#define WEFT_SHADING_CHOICE_H

#include "shading/input_ids.h"

/* The id of value k of a choice, NULL past the last. */
const char *choice_id(ChoiceId choice, int k);

/* The value of an id or of an alias; -1 is none. CHOICE_AUTO is not found: see choice_parse. */
int choice_find(ChoiceId choice, const char *id);

/* Whether a material can be made from that value: a diffuse term as the diffuse lobe, any lobe as a sheen. */
int choice_fits(ChoiceId choice, int k);

#endif
