#include "measure/match/match_factor.h"

#include <math.h>

const InputId match_factors[FACTORS] = {INPUT_base_color, INPUT_roughness, INPUT_sheen_color, INPUT_sheen_roughness,
                                        INPUT_specular};

void factors_unlock(int locked[WEFT_INPUTS_MAX]) {
    for (int k = 0; k < WEFT_INPUTS_MAX; k++) locked[k] = 1;
    for (int f = 0; f < FACTORS; f++) locked[match_factors[f]] = 0;
}

json_t *factor_home(json_t *object, const char *name) {
    if (!json_object_get(object, name)) json_object_set_new(object, name, json_object());
    return json_object_get(object, name);
}

static double rounded(double x) { return round(x * 1e6) / 1e6; }

void factor_put(json_t *home, const MaterialField *field, const float *value) {
    if (material_field_numbers(field) == 1) {
        json_object_set_new(home, field->factor, json_real(rounded((double)value[0])));
        return;
    }
    json_t *before = json_object_get(home, field->factor), *now = json_array();
    for (int c = 0; c < material_field_numbers(field); c++) {
        const json_t *alpha = json_array_get(before, 3); /* NULL, and then 1, if there was none */
        const double kept = alpha ? json_number_value(alpha) : 1.0;
        json_array_append_new(now, json_real(c < 3 ? rounded((double)value[c]) : kept));
    }
    json_object_set_new(home, field->factor, now);
}
