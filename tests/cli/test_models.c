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

static void text_names_every_model(void **state) {
    (void)state;
    Ran ran = RUN("models");
    assert_int_equal(ran.code, 0);
    for (int k = 0; k < weft_lobe_count(); k++) assert_non_null(strstr(ran.out, weft_lobe_info(k)->id));
    for (int k = 0; weft_layer_name(k); k++) assert_non_null(strstr(ran.out, weft_layer_name(k)));
    for (int k = 0; weft_material_input_name(k); k++) assert_non_null(strstr(ran.out, weft_material_input_name(k)));
    for (int k = 0; weft_builtin_name(k); k++) assert_non_null(strstr(ran.out, weft_builtin_name(k)));
    ran_free(&ran);
}

static void json_names_every_model(void **state) {
    (void)state;
    Ran ran = RUN("models", "--json");
    assert_int_equal(ran.code, 0);
    json_t *all = parsed(ran.out), *lobes = json_object_get(all, "lobes");
    assert_int_equal(json_array_size(lobes), weft_lobe_count());
    for (int k = 0; k < weft_lobe_count(); k++)
        assert_string_equal(json_string_value(json_object_get(json_array_get(lobes, (size_t)k), "id")),
                            weft_lobe_info(k)->id);
    assert_non_null(weft_layer_name((int)json_array_size(json_object_get(all, "layers")) - 1));
    assert_null(weft_layer_name((int)json_array_size(json_object_get(all, "layers"))));
    assert_null(weft_material_input_name((int)json_array_size(json_object_get(all, "inputs"))));
    assert_null(weft_builtin_name((int)json_array_size(json_object_get(all, "scenes"))));
    json_decref(all);
    ran_free(&ran);
}

static bool is_among(const json_t *list, const char *id) {
    for (size_t k = 0; k < json_array_size(list); k++)
        if (strcmp(json_string_value(json_array_get(list, k)), id) == 0) return true;
    return false;
}

static void values_of_a_choice_are_those_that_set_takes(void **state) {
    (void)state;
    Ran ran = RUN("models", "--json");
    json_t *all = parsed(ran.out), *choices = json_object_get(all, "choices");
    for (int c = 0; weft_material_choice_name(c); c++) {
        const json_t *values = json_object_get(json_array_get(choices, (size_t)c), "values");
        for (int k = 0; weft_material_choice_value(c, k); k++) {
            const char *id = weft_material_choice_value(c, k);
            if (is_among(values, id) != (weft_material_choice_fits(c, k) != 0))
                fail_msg("%s %s", weft_material_choice_name(c), id);
        }
    }
    json_decref(all);
    ran_free(&ran);
    ran = RUN("models", "choice:diffuse");
    assert_non_null(strstr(ran.out, "oren-nayar"));
    assert_null(strstr(ran.out, "burley-sheen"));
    ran_free(&ran);
}

/* Every number of every parameter table comes through as the same float. */
static void json_has_every_number_of_the_parameter_tables(void **state) {
    (void)state;
    for (int k = 0; k < weft_lobe_count(); k++) {
        const WeftLobeInfo *info = weft_lobe_info(k);
        char named[64];
        snprintf(named, sizeof named, "lobe:%s", info->id);
        Ran ran = RUN("models", named, "--json");
        json_t *found = parsed(ran.out), *lobe = json_array_get(found, 0),
               *params = json_object_get(lobe, "parameters");
        assert_int_equal(json_array_size(params), info->param_count);
        for (int p = 0; p < info->param_count; p++) {
            json_t *param = json_array_get(params, (size_t)p), *range = json_object_get(param, "range"),
                   *clamp = json_object_get(param, "clamp");
            const WeftParamInfo *own = &info->params[p];
            if (own->choices) { /* ids in place of numbers */
                size_t value = 0;
                for (; own->choices[value]; value++)
                    assert_string_equal(json_string_value(json_array_get(json_object_get(param, "values"), value)),
                                        own->choices[value]);
                assert_int_equal(json_array_size(json_object_get(param, "values")), value);
                assert_string_equal(json_string_value(json_object_get(param, "default")), own->choices[(int)own->def]);
                continue;
            }
            const float values[5] = {own->def, own->low, own->high, own->hard_low, own->hard_high};
            json_t *said[5] = {json_object_get(param, "default"), json_array_get(range, 0), json_array_get(range, 1),
                               json_array_get(clamp, 0), json_array_get(clamp, 1)};
            for (int v = 0; v < 5; v++) {
                float again = (float)json_number_value(said[v]);
                assert_memory_equal(&again, &values[v], sizeof again);
            }
            assert_string_equal(json_string_value(json_object_get(param, "name")), own->name);
        }
        json_decref(found);
        ran_free(&ran);
        ran = RUN("models", info->id);
        for (int p = 0; p < info->param_count; p++) assert_non_null(strstr(ran.out, info->params[p].name));
        ran_free(&ran);
    }
}

/* The design's table of ids; what comes later is not in it. */
static const struct {
    const char *kind, *ids;
} promised[] = {
    {"d", "blinn-phong beckmann ggx ggx-aniso gtr1 ashikhmin charlie"},
    {"v", "implicit neumann cook-torrance kelemen smith-beckmann smith-ggx smith-ggx-correlated smith-ggx-fast "
          "schlick-beckmann schlick-ggx smith-ggx-aniso neubelt conty-kulla conty-kulla-clamped"},
    {"f", "none schlick schlick-f90 cook-torrance dielectric conductor"},
    {"diffuse", "lambert burley burley-subsurface oren-nayar eon fabric-lambert wrap body"},
    {"layer", "additive seed albedo-view albedo-min albedo-max reciprocal stochastic"},
    {"lobe", "lambert ggx burley-sheen ashikhmin-neubelt ashikhmin-conty-kulla charlie-neubelt charlie-conty-kulla "
             "charlie-khronos charlie-neubelt-normalised exponential exponential-lit patry silk threads fabric"},
    {"workflow", "metallic specular disney cloth free"},
    {"profile", "unreal4 hdrp-cotton hdrp-silk urp filament-cloth filament-sheen khronos three babylon materialx "
                "cycles-velvet disney-2012 order-1886"},
    {"alias", "ashikhmin-v ashikhmin-d charlie-d charlie-v"},
    {"preset", "velvet cotton denim wool silk satin linen felt corduroy microfibre"},
};

static bool has_row(const char *text, const char *id) {
    char row[64];
    int length = snprintf(row, sizeof row, "\n  %s", id);
    for (const char *at = text; (at = strstr(at, row)); at++)
        if (strchr(" \n", at[length])) return true;
    return false;
}

/* Each is listed, has a page under KIND:ID and under its id alone, and the page of a model holds a source. */
static void every_listed_id_has_a_page(void **state) {
    (void)state;
    Ran all = RUN("models");
    for (size_t k = 0; k < sizeof promised / sizeof *promised; k++) {
        char ids[512], named[64];
        snprintf(ids, sizeof ids, "%s", promised[k].ids);
        for (char *id = strtok(ids, " "); id; id = strtok(NULL, " ")) {
            if (!has_row(all.out, id)) fail_msg("`weft models` lacks %s %s", promised[k].kind, id);
            snprintf(named, sizeof named, "%s:%s", promised[k].kind, id);
            Ran page = RUN("models", named);
            bool model = strcmp(promised[k].kind, "alias") != 0 && strcmp(promised[k].kind, "preset") != 0;
            if (page.code != 0) fail_msg("%s: %s", named, page.err);
            if (model && strcmp(id, "none") != 0 && strlen(page.out) < 250)
                fail_msg("%s: says little:\n%s", named, page.out);
            if (strstr(page.out, "/*") || strstr(page.out, "*/") || strstr(page.out, "#include"))
                fail_msg("%s: is code:\n%s", named, page.out);
            ran_free(&page);
        }
    }
    ran_free(&all);
}

static void id_of_several_catalogues_prints_all_pages(void **state) {
    (void)state;
    Ran ran = RUN("models", "cook-torrance");
    assert_int_equal(ran.code, 0);
    assert_true(strstr(ran.out, "\nV term\n") || strncmp(ran.out, "V term\n", 7) == 0);
    assert_true(strstr(ran.out, "\nF term\n") && strstr(ran.out, "\nLobe\n"));
    ran_free(&ran);
    ran = RUN("models", "cook-torrance", "--json");
    json_t *found = parsed(ran.out);
    assert_int_equal(json_array_size(found), 3);
    for (size_t k = 0; k < 3; k++)
        assert_non_null(json_string_value(json_object_get(json_array_get(found, k), "page")));
    json_decref(found);
    ran_free(&ran);
    ran = RUN("models", "schlick-f90"); /* lives in the file of schlick */
    assert_non_null(strstr(ran.out, "Christophe Schlick"));
    ran_free(&ran);
    ran = RUN("models", "d:charlie");
    assert_null(strstr(ran.out, "Lobe"));
    ran_free(&ran);
    ran = RUN("models", "layers:");
    assert_true(has_row(ran.out, "reciprocal") && !has_row(ran.out, "lambert"));
    ran_free(&ran);
    ran = RUN("models", "presets:");
    Ran plain = RUN("models", "presets"), single = RUN("models", "preset");
    assert_true(has_row(ran.out, "velvet"));
    assert_string_equal(plain.out, ran.out);
    assert_string_equal(single.out, ran.out);
    ran_free(&ran);
    ran_free(&plain);
    ran_free(&single);
    assert_complaint(NULL, LIST("models", "lay"), 2, "is not an id");
    assert_complaint(NULL, LIST("models", "chalrie-neubelt"), 2, "did you mean charlie-neubelt?");
    assert_complaint(NULL, LIST("models", "d:neubelt"), 2, "is not a D term");
    assert_complaint(NULL, LIST("models", "paint:ggx"), 2, "is not a kind");
    assert_complaint(NULL, LIST("models", ":ggx"), 2, "is not a kind");
}

/* Presets stand under the heading of their group, each once, with a line that no other has. */
static void presets_are_listed_by_groups(void **state) {
    (void)state;
    Ran ran = RUN("models", "presets");
    const char *headings[16] = {ran.out};
    int groups = 0;
    for (; weft_preset_group_name(groups); groups++) {
        char heading[64];
        snprintf(heading, sizeof heading, "\n %s: ", weft_preset_group_name(groups));
        headings[groups + 1] = strstr(headings[groups], heading);
        assert_non_null(headings[groups + 1]);
    }
    assert_true(groups > 4);
    for (int k = 0; weft_preset_name(k); k++) {
        char row[64];
        int g = 0;
        while (weft_preset_group_name(g) && strcmp(weft_preset_group_name(g), weft_preset_group(k)) != 0) g++;
        if (g == groups) fail_msg("%s: no group is called %s", weft_preset_name(k), weft_preset_group(k));
        snprintf(row, sizeof row, "\n  %s ", weft_preset_name(k));
        const char *at = strstr(ran.out, row);
        if (!at || at < headings[g + 1] || (g + 1 < groups && at > headings[g + 2]) || strstr(at + 1, row))
            fail_msg("%s is not once in %s", weft_preset_name(k), weft_preset_group(k));
        for (int j = 0; j < k; j++) assert_string_not_equal(weft_preset_help(j), weft_preset_help(k));
    }
    ran_free(&ran);
    assert_null(weft_preset_group(-1));
    assert_null(weft_preset_group_name(groups));
}

/* Each weave that is listed can be written as its line says, and so can each yarn. */
static void weaves_and_yarns_are_listed(void **state) {
    (void)state;
    static const char *const examples[][2] = {{"plain", "plain"},
                                              {"basket", "basket 2 3"},
                                              {"twill", "twill 2/1 s"},
                                              {"satin", "satin 8/3"},
                                              {"sateen", "sateen 5/2"},
                                              {"herringbone", "herringbone 2/2 8"},
                                              {"houndstooth", "houndstooth"},
                                              {"picks", "picks #.. .#. ..#"}};
    Ran ran = RUN("models");
    size_t k = 0;
    for (; weft_weave_name((int)k); k++) {
        WeftDraft *draft;
        assert_true(k < sizeof examples / sizeof *examples && has_row(ran.out, weft_weave_name((int)k)));
        assert_string_equal(weft_weave_name((int)k), examples[k][0]);
        assert_int_equal(weft_draft_parse(examples[k][1], &draft, NULL), WEFT_OK);
        weft_draft_free(draft);
    }
    assert_int_equal(k, sizeof examples / sizeof *examples);
    for (int y = 0; weft_yarn_name(y); y++) assert_true(has_row(ran.out, weft_yarn_name(y)));
    ran_free(&ran);
    assert_complaint(NULL, LIST("models", "weave:tvill"), 2, "is not a weave; did you mean twill?");
}

/* What preset:NAME prints is a material file that dresses a scene just so. */
static void printed_preset_is_a_material_file_with_the_same_picture(void **state) {
    (void)state;
    size_t size;
    Ran ran =
        run_shell("\"$0\" models preset:silk > silk.json && "
                  "\"$0\" render builtin:cloth --quiet --width 16 --height 12 --spp 1 --preset silk -o a.exr && "
                  "\"$0\" render builtin:cloth --quiet --width 16 --height 12 --spp 1 --material silk.json -o b.exr");
    assert_int_equal(ran.code, 0);
    assert_string_equal(ran.err, "");
    char *bytes = file_bytes("a.exr", &size);
    assert_true(same_bytes("b.exr", bytes, size));
    free(bytes);
    ran_free(&ran);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(text_names_every_model),
                                       cmocka_unit_test(json_names_every_model),
                                       cmocka_unit_test(values_of_a_choice_are_those_that_set_takes),
                                       cmocka_unit_test(json_has_every_number_of_the_parameter_tables),
                                       cmocka_unit_test(every_listed_id_has_a_page),
                                       cmocka_unit_test(id_of_several_catalogues_prints_all_pages),
                                       cmocka_unit_test(presets_are_listed_by_groups),
                                       cmocka_unit_test(weaves_and_yarns_are_listed),
                                       cmocka_unit_test(printed_preset_is_a_material_file_with_the_same_picture)};
    return cmocka_run_group_tests(tests, work_begin, work_end);
}
