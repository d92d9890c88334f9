/* `weft models` says what the library has, in words and as JSON. */
#include "run.h"

#include <jansson.h>

#include "weft/weft.h"

static json_t *parsed(const char *text) {
    json_error_t error;
    json_t *value = json_loads(text, 0, &error);
    if (!value) fail_msg("not JSON: line %d: %s\n%s", error.line, error.text, text);
    return value;
}

static void text_names_everything(void **state) {
    (void)state;
    Ran ran = RUN("models");
    assert_int_equal(ran.code, 0);
    for (int k = 0; k < weft_lobe_count(); k++) assert_non_null(strstr(ran.out, weft_lobe_info(k)->id));
    for (int k = 0; weft_layer_id(k); k++) assert_non_null(strstr(ran.out, weft_layer_id(k)));
    for (int k = 0; weft_material_input_name(k); k++)
        assert_non_null(strstr(ran.out, weft_material_input_name(k)));
    for (int k = 0; weft_builtin_name(k); k++) assert_non_null(strstr(ran.out, weft_builtin_name(k)));
    ran_free(&ran);
}

static void json_names_everything(void **state) {
    (void)state;
    Ran ran = RUN("models", "--json");
    assert_int_equal(ran.code, 0);
    json_t *all = parsed(ran.out), *lobes = json_object_get(all, "lobes");
    assert_int_equal(json_array_size(lobes), weft_lobe_count());
    for (int k = 0; k < weft_lobe_count(); k++)
        assert_string_equal(json_string_value(json_object_get(json_array_get(lobes, (size_t)k), "id")),
                            weft_lobe_info(k)->id);
    assert_non_null(weft_layer_id((int)json_array_size(json_object_get(all, "layers")) - 1));
    assert_null(weft_layer_id((int)json_array_size(json_object_get(all, "layers"))));
    assert_null(weft_material_input_name((int)json_array_size(json_object_get(all, "inputs"))));
    assert_null(weft_builtin_name((int)json_array_size(json_object_get(all, "scenes"))));
    json_decref(all);
    ran_free(&ran);
}

/* Every number of every parameter table comes through as the same float. */
static void parameters_come_through(void **state) {
    (void)state;
    for (int k = 0; k < weft_lobe_count(); k++) {
        const WeftLobeInfo *info = weft_lobe_info(k);
        Ran ran = RUN("models", info->id, "--json");
        json_t *lobe = parsed(ran.out), *params = json_object_get(lobe, "parameters");
        assert_int_equal(json_array_size(params), info->param_count);
        for (int p = 0; p < info->param_count; p++) {
            json_t *param = json_array_get(params, (size_t)p), *range = json_object_get(param, "range"),
                   *clamp = json_object_get(param, "clamp");
            const WeftParamInfo *own = &info->params[p];
            const float values[5] = {own->def, own->low, own->high, own->hard_low, own->hard_high};
            json_t *said[5] = {json_object_get(param, "default"), json_array_get(range, 0),
                               json_array_get(range, 1), json_array_get(clamp, 0), json_array_get(clamp, 1)};
            for (int v = 0; v < 5; v++) {
                float again = (float)json_number_value(said[v]);
                assert_memory_equal(&again, &values[v], sizeof again);
            }
            assert_string_equal(json_string_value(json_object_get(param, "name")), own->name);
        }
        json_decref(lobe);
        ran_free(&ran);
        ran = RUN("models", info->id);
        for (int p = 0; p < info->param_count; p++) assert_non_null(strstr(ran.out, info->params[p].name));
        ran_free(&ran);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(text_names_everything),
                                       cmocka_unit_test(json_names_everything),
                                       cmocka_unit_test(parameters_come_through)};
    return cmocka_run_group_tests(tests, work_begin, work_end);
}
