/* cloth.h - models of figures, with all they are made of */
#ifndef WEFT_TESTS_PLOT_CLOTH_H
#define WEFT_TESTS_PLOT_CLOTH_H

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "weft/weft.h"

/* A model with all it is made of. */
typedef struct Cloth {
    WeftLobe lobe;
    WeftMaterial material;
    WeftReflection *reflection;
    WeftPlotModel model;
} Cloth;

/* Returns true if a kind of figure takes too long under sanitizers: that of a map, which has tests of its own. */
static inline bool is_long(int kind) { return kind == WEFT_PLOT_AMBIENT && getenv("WEFT_TEST_SHORT"); }

static inline void cloth_of_lobe(Cloth *cloth, const char *id, const char *param, const char *value) {
    WeftError error;
    assert_int_equal(weft_lobe_init(id, &cloth->lobe, &error), WEFT_OK);
    if (param) assert_int_equal(weft_lobe_set(&cloth->lobe, param, value, NULL, &error), WEFT_OK);
    assert_int_equal(weft_reflection_of_lobe(&cloth->lobe, &cloth->reflection, &error), WEFT_OK);
    cloth->model = (WeftPlotModel){.reflection = cloth->reflection, .lobe = &cloth->lobe, .label = id};
}

static inline void cloth_of_profile(Cloth *cloth, const char *id) {
    WeftError error;
    weft_material_default(&cloth->material);
    assert_int_equal(weft_material_set(&cloth->material, "profile", id, NULL, &error), WEFT_OK);
    assert_int_equal(weft_material_set(&cloth->material, "sheen_color", "1", NULL, &error), WEFT_OK);
    assert_int_equal(weft_material_set(&cloth->material, "sheen_roughness", "0.5", NULL, &error), WEFT_OK);
    assert_int_equal(weft_reflection_create(&cloth->material, &cloth->reflection, &error), WEFT_OK);
    cloth->model = (WeftPlotModel){.reflection = cloth->reflection, .material = &cloth->material, .label = id};
}

static inline void cloth_free(Cloth *cloth) { weft_reflection_free(cloth->reflection); }

static inline WeftPlotData data_of(const WeftPlotDesc *desc) {
    WeftPlotData data;
    WeftError error;
    if (weft_plot_data(desc, &data, &error) != WEFT_OK) fail_msg("%s", error.text);
    return data;
}

#endif
