/* choice.h - the values of each choice of inputs.h, by id and by other names in use */
#pragma once

#include "shading/stack/input_ids.h"

/* Returns the id of value k of a choice, NULL past the last. */
const char *choice_id(ChoiceId choice, int k);

/* Returns the value of an id or of an alias, or -1 if there is none. "auto", CHOICE_AUTO, is not found. */
int choice_find(ChoiceId choice, const char *id);

/* Returns true if a material may have this value: a diffuse term is a diffuse lobe, any lobe is a sheen. */
int choice_fits(ChoiceId choice, int k);

/* Returns the id for which a name is an alias ("charlie-v": conty-kulla), or the name itself. */
const char *alias_id(const char *name);

/* Fills text with all ids that begin with name and a dash, "a, b, c", if there are at least two, so that the name alone
 * is ambiguous (charlie: a lobe of which visibility?). Returns text, or NULL. */
enum { SEVERAL_SIZE = 200 };
const char *choice_several(ChoiceId choice, const char *name, char text[SEVERAL_SIZE]);
