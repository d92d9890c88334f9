/* `weft check`: the passport as text, JSON and page; bounds and complaints
 *
 * Labels: unsanitized */
#include "base/pi.h"
#include "run.h"

#include <math.h>

#include <jansson.h>

#include "weft/lobe.h"
#include "weft/scene.h"
#include "woven_presets.h"

static void passport_text_has_every_section(void **state) {
    (void)state;
    static const char *const parts[] = {"charlie-neubelt\n",
                                        "Directional albedo",
                                        "*3.",
                                        "Reciprocity",
                                        "White furnace",
                                        "additive",
                                        "Sampling",
                                        "missed by sampling: 0\n",
                                        "Adversarial sweep",
                                        "Half precision",
                                        "C and GPU\n  not compared: skipped (--no-gpu)"};
    Ran ran = RUN("check", "charlie-neubelt", "--quick", "--no-gpu");
    assert_int_equal(ran.code, 0);
    assert_string_equal(ran.err, "");
    for (size_t k = 0; k < sizeof parts / sizeof *parts; k++)
        if (!strstr(ran.out, parts[k])) fail_msg("\"%s\" is missing in\n%s", parts[k], ran.out);
    for (const char *line = ran.out; *line; line += strcspn(line, "\n") + 1) assert_true(strcspn(line, "\n") <= 110);
    ran_free(&ran);
}

static void albedo_up_to_one_has_no_mark(void **state) {
    (void)state;
    Ran ran = RUN("check", "lambert", "--quick", "--no-gpu");
    assert_int_equal(ran.code, 0);
    const char *table = strstr(ran.out, "cos_o"), *end = strstr(ran.out, "at most");
    assert_true(table && end && table < end);
    assert_null(memchr(table, '*', (size_t)(end - table)));
    ran_free(&ran);
}

static json_t *json_of(const char *text) {
    json_error_t error;
    json_t *json = json_loads(text, JSON_REJECT_DUPLICATES, &error);
    if (!json) fail_msg("line %d: %s", error.line, error.text);
    return json;
}

static double json_at(json_t *json, const char *outer, const char *inner) {
    json_t *value = json_object_get(json_object_get(json, outer), inner);
    assert_true(json_is_number(value));
    return json_number_value(value);
}

static void json_has_the_numbers_of_the_passport(void **state) {
    (void)state;
    Ran ran = RUN("check", "burley-sheen", "--quick", "--no-gpu", "--json");
    assert_int_equal(ran.code, 0);
    json_t *json = json_of(ran.out), *e;
    assert_string_equal(json_string_value(json_object_get(json, "id")), "burley-sheen");
    assert_string_equal(json_string_value(json_object_get(json, "kind")), "lobe");
    e = json_array_get(json_object_get(json_object_get(json, "albedo"), "e"), 0);
    /* towards the normal: 2 pi integral of (1 - cos(t / 2))^5 cos t sin t dt, by the midpoint rule */
    double sum = 0.0;
    for (int k = 0; k < 1000; k++) {
        double z = (k + 0.5) / 1000.0, d = sqrt(0.5 + 0.5 * z);
        sum += 2.0 * PI_DOUBLE * pow(1.0 - d, 5.0) * z / 1000.0;
    }
    assert_true(fabs(json_number_value(json_array_get(e, 0)) - sum) < 2e-4);
    assert_true(json_at(json, "reciprocity", "worst") < 1e-5);
    assert_true(fabs(json_at(json, "sampling", "integral_most") - 1.0) < 0.02);
    assert_true(json_at(json, "sampling", "missed") == 0.0);
    assert_true(json_at(json, "furnace", "conserving_most") < 1.001);
    assert_true(json_at(json, "sweep", "results") > 1000.0);
    assert_true(json_at(json, "sweep", "not_finite") == 0.0);
    assert_true(json_is_false(json_object_get(json_object_get(json, "parity"), "measured")));
    json_decref(json);
    ran_free(&ran);
}

static void check_of_a_profile_prints_a_passport(void **state) {
    (void)state;
    Ran ran = RUN("check", "filament-cloth", "--quick", "--json");
    assert_int_equal(ran.code, 0);
    json_t *json = json_of(ran.out);
    assert_string_equal(json_string_value(json_object_get(json, "kind")), "profile");
    assert_non_null(json_object_get(json, "surface"));
    assert_true(json_at(json, "albedo", "most") > 1.0); /* nothing is taken from its diffuse lobe */
    json_decref(json);
    ran_free(&ran);
}

static void passport_is_the_same_with_any_number_of_threads(void **state) {
    (void)state;
    Ran one = RUN("check", "oren-nayar", "--quick", "--no-gpu", "--json", "--threads", "1");
    Ran three = RUN("check", "oren-nayar", "--quick", "--no-gpu", "--json", "--threads", "3");
    assert_string_equal(one.out, three.out);
    ran_free(&one);
    ran_free(&three);
}

/* A line on every lobe and profile, under a heading; only the long run has the time. */
static void check_all_prints_a_line_for_each_lobe(void **state) {
    (void)state;
    if (!getenv("WEFT_TEST_LONG")) skip();
    int profiles = 0, lines = 0;
    while (weft_profile_name(profiles)) profiles++;
    Ran ran = RUN("check", "all", "--quick", "--no-gpu");
    assert_int_equal(ran.code, 0);
    assert_string_equal(ran.err, "");
    for (const char *c = ran.out; *c; c++) lines += *c == '\n';
    assert_int_equal(lines, 1 + weft_lobe_count() + profiles);
    assert_non_null(strstr(ran.out, "\ncharlie-neubelt "));
    assert_non_null(strstr(ran.out, "\nfilament-sheen "));
    assert_non_null(strstr(ran.out, "\nnone (weft's own) "));
    ran_free(&ran);
}

static void html_page_refers_to_no_other_file(void **state) {
    (void)state;
    size_t size;
    Ran ran = RUN("check", "charlie-neubelt", "--quick", "--no-gpu", "--html", "page.html");
    assert_int_equal(ran.code, 0);
    char *page = file_bytes("page.html", &size);
    assert_non_null(page);
    assert_non_null(strstr(page, "<!DOCTYPE html>"));
    assert_non_null(strstr(page, "<svg"));
    assert_non_null(strstr(page, "class=\"above\">3."));
    assert_non_null(strstr(page, "0 of E is missed"));
    assert_non_null(strstr(page, "</html>"));
    assert_null(strstr(page, "src="));
    assert_null(strstr(page, "href="));
    assert_null(strstr(page, "url("));
    assert_null(strstr(page, "nan"));
    int open = 0, closed = 0;
    for (const char *c = page; (c = strstr(c, "<svg")); c++) open++;
    for (const char *c = page; (c = strstr(c, "</svg>")); c++) closed++;
    assert_int_equal(open, 3);
    assert_int_equal(closed, 3);
    free(page);
    ran_free(&ran);
}

static void exceeded_bound_is_printed_and_fails(void **state) {
    (void)state;
    Ran ran = RUN("check", "charlie-neubelt", "--quick", "--no-gpu", "--max-albedo", "1");
    assert_int_equal(ran.code, 1);
    assert_true(one_complaint(ran.err));
    assert_non_null(strstr(ran.err, "charlie-neubelt: the directional albedo is 3."));
    assert_non_null(strstr(ran.out, "Directional albedo"));
    ran_free(&ran);
    ran = RUN("check", "charlie-neubelt", "--quick", "--no-gpu", "--max-albedo", "10", "--max-reciprocity", "1e-3");
    assert_int_equal(ran.code, 0);
    ran_free(&ran);
    /* E = 1 to the accuracy of the measurement is not more than 1 */
    ran = RUN("check", "charlie-neubelt-normalised", "--quick", "--no-gpu", "--max-albedo", "1");
    assert_int_equal(ran.code, 0);
    ran_free(&ran);
    ran = RUN("check", "wrap", "--quick", "--no-gpu", "--max-reciprocity", "0.1", "--max-variance", "1e-9");
    assert_int_equal(ran.code, 1);
    assert_non_null(strstr(ran.err, "reciprocity"));
    assert_non_null(strstr(ran.err, "variance"));
    ran_free(&ran);
}

/* A lobe of E <= 1 keeps the bound, though additive, multiplicative and albedo-min gain by their definition,
 * and though one rule walks at random. */
static void max_furnace_bounds_only_rules_that_conserve(void **state) {
    (void)state;
    static const char *const keep[] = {"ashikhmin-neubelt", "lambert", "wrap", "charlie-conty-kulla"};
    for (size_t k = 0; k < sizeof keep / sizeof *keep; k++) {
        Ran ran = RUN("check", keep[k], "--quick", "--no-gpu", "--max-furnace", "1.001");
        if (ran.code != 0) fail_msg("%s: %d, %s", keep[k], ran.code, ran.err);
        const char *additive = strstr(ran.out, "\n  additive "), *star = additive ? strchr(additive, '*') : NULL;
        assert_true(star && star < strstr(additive + 1, "\n")); /* it does gain */
        const char *walk = strstr(ran.out, "\n  stochastic ");
        assert_non_null(walk);
        assert_null(memchr(walk, '*', strcspn(walk + 1, "\n")));
        ran_free(&ran);
    }
    Ran ran = RUN("check", "charlie-neubelt", "--quick", "--no-gpu", "--max-furnace", "1.001");
    assert_int_equal(ran.code, 1);
    assert_true(one_complaint(ran.err));
    assert_non_null(strstr(ran.err, "the furnace under a layer rule that conserves energy is 1.289, more than"));
    ran_free(&ran);
}

static void parameters_given_to_check_reach_the_lobe(void **state) {
    (void)state;
    Ran cloth = RUN("check", "cook-torrance", "--quick", "--no-gpu", "--json", "-p", "d=charlie", "-p", "v=neubelt",
                    "-p", "f=none");
    Ran charlie = RUN("check", "charlie-neubelt", "--quick", "--no-gpu", "--json");
    assert_int_equal(cloth.code, 0);
    json_t *a = json_of(cloth.out), *b = json_of(charlie.out);
    double most_a = json_at(a, "albedo", "most"), most_b = json_at(b, "albedo", "most");
    assert_true(fabs(most_a - most_b) < 2e-3 * most_b);
    json_decref(a);
    json_decref(b);
    ran_free(&cloth);
    ran_free(&charlie);
    assert_complaint(NULL, LIST("check", "ggx", "-p", "alpha=0.5"), 2, "the rows of the report run over alpha");
    assert_complaint(NULL, LIST("check", "ggx", "-p", "beta=0.5"), 2, "is not a parameter");
    assert_complaint(NULL, LIST("check", "ggx", "-p", "0.5"), 2, "is not name=value");
}

static void header_option_prints_the_end_of_a_comment(void **state) {
    (void)state;
    Ran ran = RUN("check", "eon", "--header");
    assert_int_equal(ran.code, 0);
    assert_memory_equal(ran.out, " *   measured by weft check eon: E at most 1.00 (", 49);
    for (const char *line = ran.out; *line; line += strcspn(line, "\n") + 1) {
        assert_memory_equal(line, " * ", 3);
        assert_true(strcspn(line, "\n") <= 107);
    }
    assert_null(strstr(ran.out, "*/"));
    ran_free(&ran);
}

/* Every woven preset keeps energy and is sampled as its pdf says. Without a sheen, which lies on it by a layer rule that is
 * not reciprocal, it is reciprocal. The long run asks all of them, the usual one every third. */
static void weaves_are_checked_as_any_model(void **state) {
    (void)state;
    int count = 0;
    for (int k = 0; weft_preset_name(k); k++) {
        char model[96];
        if (woven_family(weft_preset_name(k)) < 0) continue;
        if (count++ % 3 && !getenv("WEFT_TEST_LONG")) continue;
        snprintf(model, sizeof model, "preset:%s", weft_preset_name(k));
        Ran ran = RUN("check", model, "--quick", "--json", "--max-albedo", "1", "--max-reciprocity",
                      strstr(weft_preset_text(k), "sheen") ? "1" : "1e-3", "--max-variance", "2");
        if (ran.code != 0 || *ran.err) fail_msg("%s: %d: %s", model, ran.code, ran.err);
        json_t *json = json_of(ran.out);
        assert_string_equal(json_string_value(json_object_get(json, "id")), model);
        assert_string_equal(json_string_value(json_object_get(json, "kind")), "weave");
        json_decref(json);
        ran_free(&ran);
    }
    assert_true(count >= WOVEN_PRESETS);
    file_make("none.json", "{\"weave\": {\"draft\": \"plain\", \"warp\": \"silk\"}}", 45);
    Ran ran = RUN("check", "none.json", "--quick");
    if (ran.code != 0 || *ran.err) fail_msg("%d: %s", ran.code, ran.err);
    assert_non_null(strstr(ran.out, "E of the woven material"));
    ran_free(&ran);
    unlink("none.json");
}

static void check_options_without_sense_are_refused(void **state) {
    (void)state;
    assert_complaint(NULL, LIST("check", "charly-neubelt"), 2, "did you mean charlie-neubelt?");
    assert_complaint(NULL, LIST("check", "moleskin"), 2, "is neither a lobe nor an engine profile");
    assert_complaint(NULL, LIST("check", "preset:velvet"), 2, "is a material that is not woven");
    assert_complaint(NULL, LIST("check", "preset:woven-denin"), 2, "did you mean woven-denim?");
    assert_complaint(NULL, LIST("check", "preset:woven-denim", "-p", "alpha=1"), 2, "is for lobes");
    file_make("none.json", "{\"weave\": {\"draft\": \"nowhere.wif\"}}", 35);
    assert_complaint(NULL, LIST("check", "none.json"), 3,
                     "nowhere.wif: cannot be opened: No such file or directory (the draft of none.json)");
    unlink("none.json");
    assert_complaint(NULL, LIST("check"), 2, "check");
    assert_complaint(NULL, LIST("check", "ggx", "lambert"), 2, "");
    assert_complaint(NULL, LIST("check", "ggx", "--max-albedo", "much"), 2, "--max-albedo");
    assert_complaint(NULL, LIST("check", "ggx", "--threads", "-1"), 2, "--threads");
    assert_complaint(NULL, LIST("check", "all", "-p", "alpha=1"), 2, "does not go with \"all\"");
    assert_complaint(NULL, LIST("check", "three", "-p", "alpha=1"), 2, "is for lobes");
    assert_complaint(NULL, LIST("check", "three", "--header"), 2, "is for lobes");
    assert_complaint(NULL, LIST("check", "ggx", "--header", "--json"), 2, "does not go with");
    assert_complaint(NULL, LIST("check", "lambert", "--html", "no/such/folder.html"), 4, "cannot be written");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(passport_text_has_every_section),
        cmocka_unit_test(albedo_up_to_one_has_no_mark),
        cmocka_unit_test(json_has_the_numbers_of_the_passport),
        cmocka_unit_test(check_of_a_profile_prints_a_passport),
        cmocka_unit_test(passport_is_the_same_with_any_number_of_threads),
        cmocka_unit_test(check_all_prints_a_line_for_each_lobe),
        cmocka_unit_test(html_page_refers_to_no_other_file),
        cmocka_unit_test(exceeded_bound_is_printed_and_fails),
        cmocka_unit_test(max_furnace_bounds_only_rules_that_conserve),
        cmocka_unit_test(parameters_given_to_check_reach_the_lobe),
        cmocka_unit_test(header_option_prints_the_end_of_a_comment),
        cmocka_unit_test(weaves_are_checked_as_any_model),
        cmocka_unit_test(check_options_without_sense_are_refused),
    };
    return cmocka_run_group_tests(tests, work_begin, work_end);
}
