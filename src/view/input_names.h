/* input_names.h - a material's inputs and choices by name */
#ifndef WEFT_VIEW_INPUT_NAMES_H
#define WEFT_VIEW_INPUT_NAMES_H

/* Their numbers; -1 where there is no such. */
int input_number(const char *name);
int choice_number(const char *name);

/* Returns the number of values of a choice. */
int choice_values(int choice);

#endif
