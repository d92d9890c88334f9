#include "view/input_names.h"

#include <string.h>

#include "weft/scene.h"

int input_number(const char *name) {
    for (int k = 0; weft_material_input_name(k); k++)
        if (strcmp(weft_material_input_name(k), name) == 0) return k;
    return -1;
}

int choice_number(const char *name) {
    for (int k = 0; weft_material_choice_name(k); k++)
        if (strcmp(weft_material_choice_name(k), name) == 0) return k;
    return -1;
}

int choice_values(int choice) {
    int count = 0;
    while (weft_material_choice_value(choice, count)) count++;
    return count;
}
