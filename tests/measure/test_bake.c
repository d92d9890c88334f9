/* Baked tables against integrals written out here in double precision; forms, places and refusals */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "base/pi.h"
#include "shading/catalogue/registry.h"
#include "weft/weft.h"

static void assert_near(double got, double expected, double tolerance) {
    if (!(fabs(got - expected) <= tolerance)) fail_msg("%.9g, not %.9g +- %g", got, expected, tolerance);
}

static WeftTableForm form_of(const char *text) {
    WeftTableForm form;
    WeftError error = {0};
    if (weft_table_form_parse(text, &form, &error) != WEFT_OK) fail_msg("%s", error.text);
    return form;
}

static WeftLobe lobe_of_id(const char *id) {
    WeftLobe lobe;
    assert_int_equal(weft_lobe_init(id, &lobe, NULL), WEFT_OK);
    return lobe;
}

static float texel(const WeftImage *table, int x, int y, int c) {
    return ((const float *)table->pixels)[(y * table->width + x) * table->channels + c];
}

static WeftImage baked(const WeftBakeDesc *desc, WeftBakeInfo *info) {
    WeftImage table;
    WeftError error = {0};
    if (weft_bake(desc, info, &table, &error) != WEFT_OK) fail_msg("%s", error.text);
    assert_int_equal(table.type, WEFT_PIXEL_F32);
    return table;
}

/* Forms. */

static void table_form_reads_as_it_is_written(void **state) {
    (void)state;
    int count = 0;
    for (; weft_table_form_name(count); count++) {
        char text[WEFT_TABLE_FORM_TEXT];
        const WeftTableForm named = form_of(weft_table_form_name(count)), at = weft_table_form_at(count);
        const WeftTableForm again = form_of(weft_table_form_text(&named, text));
        assert_memory_equal(&named, &at, sizeof named);
        assert_memory_equal(&named, &again, sizeof named);
        assert_true(weft_table_form_find(&named) >= 0);
        assert_non_null(weft_table_form_help(count));
    }
    assert_true(count >= 5);
    assert_null(weft_table_form_help(count));
    for (int bits = 0; bits < 128; bits++) { /* every form there is */
        char text[WEFT_TABLE_FORM_TEXT];
        const WeftTableForm form = {bits & 1,      bits >> 1 & 1, bits >> 2 & 1, bits >> 3 & 1,
                                    bits >> 4 & 1, bits >> 5 & 1, bits >> 6 & 1};
        const WeftTableForm again = form_of(weft_table_form_text(&form, text));
        assert_memory_equal(&form, &again, sizeof form);
    }
}

static void malformed_table_form_is_refused(void **state) {
    (void)state;
    static const char *const wrong[] = {"",
                                        "glTF",
                                        "cos",
                                        "cos,",
                                        "cos,cos",
                                        "roughness,alpha",
                                        "cos,roughness,",
                                        "cos,roughness,middle",
                                        "cos,roughness,edges,centres",
                                        "cos,roughness,centres,flip-y,cos",
                                        "centres,cos,roughness",
                                        "cos,roughness,a word of many letters"};
    for (size_t k = 0; k < sizeof wrong / sizeof *wrong; k++) {
        WeftTableForm form;
        WeftError error = {0};
        assert_int_equal(weft_table_form_parse(wrong[k], &form, &error), WEFT_USAGE);
        assert_int_equal(error.message, WEFT_MESSAGE_TABLE_FORM);
        assert_null(strchr(error.text, '\n'));
    }
}

/* Places worked out by hand, for charlie-neubelt, whose parameter is an alpha. */
static void texels_of_each_form_are_where_its_engine_has_them(void **state) {
    (void)state;
    static const struct {
        const char *form;
        int width, height, x, y;
        double cos_o, alpha;
    } places[] = {
        {"gltf", 4, 2, 0, 0, 0.125, 0.0625},     {"gltf", 4, 2, 3, 1, 0.875, 0.5625},
        {"filament", 4, 2, 0, 0, 0.125, 0.5625}, {"filament", 4, 2, 3, 1, 0.875, 0.0625},
        {"three", 2, 4, 1, 0, 0.125, 0.5625},    {"three", 2, 4, 0, 3, 0.875, 0.0625},
        {"materialx", 4, 2, 1, 1, 0.375, 0.75},  {"hdrp", 5, 3, 1, 1, 0.0625, 0.25},
        {"hdrp", 5, 3, 4, 2, 1.0, 1.0},          {"cycles", 3, 5, 1, 2, 0.5, 0.25},
        {"zeltner", 5, 3, 3, 1, 0.75, 0.5},      {"zeltner", 5, 3, 0, 0, 0.0, 0.0},
        {"zeltner", 1, 1, 0, 0, 0.0, 0.0},       {"cos,alpha,edges,flip-x", 5, 3, 1, 1, 0.75, 0.5},
    };
    const int lobe = weft_lobe_find("charlie-neubelt");
    for (size_t k = 0; k < sizeof places / sizeof *places; k++) {
        float cos_o, value;
        const WeftTableForm form = form_of(places[k].form);
        weft_table_form_texel(&form, lobe, places[k].width, places[k].height, places[k].x, places[k].y, &cos_o, &value);
        assert_near((double)cos_o, places[k].cos_o, 1e-7);
        assert_near((double)value, places[k].alpha, 1e-7);
    }
}

/* The rows mean what a material's roughness means, lobe by lobe. */
static void baked_roughness_is_that_of_materials(void **state) {
    (void)state;
    const WeftTableForm form = {.edges = 1};
    for (int lobe = 0; lobe < weft_lobe_count(); lobe++)
        for (int y = 0; y < 9; y++) {
            float cos_o, value;
            Lobe own = lobe_default(lobe);
            const Lobe expected = lobe_rough(lobe, (float)y / 8.0f);
            weft_table_form_texel(&form, lobe, 1, 9, 0, y, &cos_o, &value);
            if (weft_lobe_info(lobe)->param_count == 0) continue;
            lobe_set(&own, 0, value);
            assert_near((double)own.params[0], (double)expected.params[0], 1e-6);
        }
}

/* Values. */

/* Integral of f cos_i over the hemisphere, by the midpoint rule over half vectors about the normal: dwi is 4
 * (wo . h) dh. Crowded towards sin_h = 0 by h's polar angle t^2 pi / 2. */
static double integral(double cos_o, double alpha,
                       double (*f)(double alpha, double cos_o, double cos_i, double cos_h, double d)) {
    enum { RINGS = 600, TURNS = 400 };
    const double sin_o = (sqrt)(1.0 - cos_o * cos_o);
    double sum = 0.0;
    for (int j = 0; j < RINGS; j++) {
        const double t = (j + 0.5) / RINGS, theta = 0.5 * PI_DOUBLE * t * t, slope = PI_DOUBLE * t;
        const double s = (sin)(theta), c = (cos)(theta);
        for (int k = 0; k < TURNS; k++) {
            const double phi = PI_DOUBLE * (k + 0.5) / TURNS, d = sin_o * s * (cos)(phi) + cos_o * c;
            const double cos_i = 2.0 * d * c - cos_o;
            if (d <= 0.0 || cos_i <= 0.0) continue;
            sum += f(alpha, cos_o, cos_i, c, d) * cos_i * 4.0 * d * s * slope;
        }
    }
    return sum * 2.0 * PI_DOUBLE / TURNS / RINGS;
}

/* Conty Estevez and Kulla 2017, equation 2, over the denominator of Neubelt and Pettineo 2013. */
static double f_charlie(double alpha, double cos_o, double cos_i, double cos_h, double d) {
    (void)d;
    return (2.0 + 1.0 / alpha) * (pow)(1.0 - cos_h * cos_h, 0.5 / alpha) / (2.0 * PI_DOUBLE) /
           (4.0 * (cos_o + cos_i - cos_o * cos_i));
}

/* Walter et al. 2007 with the height-correlated Smith term, Heitz 2014; Schlick's Fresnel split in two. */
static double lambda_ggx(double alpha, double z) {
    return 0.5 * ((sqrt)(1.0 + alpha * alpha * (1.0 - z * z) / (z * z)) - 1.0);
}
static double f_ggx(double alpha, double cos_o, double cos_i, double cos_h) {
    const double t = cos_h * cos_h * (alpha * alpha - 1.0) + 1.0;
    return alpha * alpha / (PI_DOUBLE * t * t) / (1.0 + lambda_ggx(alpha, cos_o) + lambda_ggx(alpha, cos_i)) /
           (4.0 * cos_o * cos_i);
}
static double f_scale(double alpha, double cos_o, double cos_i, double cos_h, double d) {
    return f_ggx(alpha, cos_o, cos_i, cos_h) * (1.0 - (pow)(1.0 - d, 5.0));
}
static double f_bias(double alpha, double cos_o, double cos_i, double cos_h, double d) {
    return f_ggx(alpha, cos_o, cos_i, cos_h) * (pow)(1.0 - d, 5.0);
}

static void baked_albedo_is_the_integral(void **state) {
    (void)state;
    const WeftLobe lobe = lobe_of_id("charlie-neubelt");
    WeftBakeInfo info;
    const WeftBakeDesc desc = {.kind = "albedo", .lobe = &lobe, .width = 4, .height = 3, .form = form_of("three")};
    WeftImage table = baked(&desc, &info);
    assert_int_equal(table.channels, 1);
    for (int y = 0; y < 3; y++)
        for (int x = 0; x < 4; x++) {
            const double r = (x + 0.5) / 4.0, cos_o = (y + 0.5) / 3.0;
            assert_near((double)texel(&table, x, y, 0), integral(cos_o, r * r, f_charlie), 3e-4);
        }
    assert_true(info.error > 0.0 && info.error < 1e-4 && info.unmet == 0 && info.beyond == 0);
    assert_near((double)info.high, (double)texel(&table, 3, 0, 0), 0.2);
    assert_non_null(strstr(info.words, "charlie-neubelt"));
    weft_image_free(&table);
}

static void baked_split_sum_is_the_integral(void **state) {
    (void)state;
    const WeftLobe lobe = lobe_of_id("charlie-neubelt");
    WeftBakeDesc desc = {.kind = "dfg", .lobe = &lobe, .width = 3, .height = 3};
    WeftImage table = baked(&desc, NULL);
    assert_int_equal(table.channels, 3);
    for (int y = 0; y < 3; y++)
        for (int x = 0; x < 3; x++) {
            const double r = (y + 0.5) / 3.0, cos_o = (x + 0.5) / 3.0;
            assert_near((double)texel(&table, x, y, 0), integral(cos_o, r * r, f_scale), 5e-4);
            assert_near((double)texel(&table, x, y, 1), integral(cos_o, r * r, f_bias), 5e-4);
            assert_near((double)texel(&table, x, y, 2), integral(cos_o, r * r, f_charlie), 3e-4);
        }
    /* Filament's way: upside down, bias and sum */
    desc.form = form_of("filament");
    WeftImage other = baked(&desc, NULL);
    for (int y = 0; y < 3; y++)
        for (int x = 0; x < 3; x++) {
            const double bias = (double)texel(&table, x, 2 - y, 1);
            assert_near((double)texel(&other, x, y, 0), bias, 1e-6);
            assert_near((double)texel(&other, x, y, 1), bias + (double)texel(&table, x, 2 - y, 0), 1e-6);
            assert_near((double)texel(&other, x, y, 2), (double)texel(&table, x, 2 - y, 2), 1e-6);
        }
    weft_image_free(&table);
    weft_image_free(&other);
    desc.lobe = NULL;
    table = baked(&desc, NULL);
    assert_int_equal(table.channels, 2);
    weft_image_free(&table);
}

/* E of the lobe that is set, two parts where it has two colours, and 1 of Lambert whatever the view. */
static void baked_albedo_has_the_parameters_and_parts_of_its_lobe(void **state) {
    (void)state;
    WeftLobe patry = lobe_of_id("patry"), ggx = lobe_of_id("ggx"), lambert = lobe_of_id("lambert");
    assert_int_equal(weft_lobe_set(&patry, "density", "2", NULL, NULL), WEFT_OK);
    WeftBakeDesc desc = {.kind = "albedo", .lobe = &patry, .width = 3, .height = 2};
    WeftImage table = baked(&desc, NULL);
    float e[3];
    assert_int_equal(weft_lobe_set(&patry, "roughness", "0.75", NULL, NULL), WEFT_OK);
    weft_lobe_albedo(&patry, 0.5f, e);
    assert_near((double)texel(&table, 1, 1, 0), (double)e[0], 2e-4);
    weft_image_free(&table);

    desc.lobe = &ggx;
    table = baked(&desc, NULL);
    assert_int_equal(table.channels, 2);
    assert_int_equal(weft_lobe_set(&ggx, "alpha", "0.5625", NULL, NULL), WEFT_OK);
    assert_int_equal(weft_lobe_set(&ggx, "f0", "0.25", NULL, NULL), WEFT_OK);
    assert_int_equal(weft_lobe_set(&ggx, "f90", "0.5", NULL, NULL), WEFT_OK);
    weft_lobe_albedo(&ggx, 0.5f, e);
    assert_near(0.25 * (double)texel(&table, 1, 1, 0) + 0.5 * (double)texel(&table, 1, 1, 1), (double)e[0], 2e-4);
    weft_image_free(&table);

    desc.lobe = &lambert;
    table = baked(&desc, NULL);
    for (int n = 0; n < 6; n++) assert_near((double)texel(&table, n % 3, n / 3, 0), 1.0, 1e-4);
    weft_image_free(&table);
}

static void baked_range_ends_where_the_lobe_does(void **state) {
    (void)state;
    const WeftLobe lobe = lobe_of_id("charlie-khronos"); /* alpha 0.005 to 1 */
    WeftBakeInfo info;
    const WeftBakeDesc desc = {
        .kind = "albedo", .lobe = &lobe, .width = 2, .height = 101, .form = form_of("cos,alpha,edges")};
    WeftImage table = baked(&desc, &info);
    assert_int_equal(info.beyond, 2); /* the row of alpha 0 */
    weft_image_free(&table);
}

static void bake_with_any_number_of_threads_is_the_same(void **state) {
    (void)state;
    const WeftLobe lobe = lobe_of_id("ashikhmin-neubelt");
    WeftBakeInfo info[2];
    WeftBakeDesc desc = {.kind = "dfg", .lobe = &lobe, .width = 7, .height = 5, .threads = 1};
    WeftImage one = baked(&desc, &info[0]);
    desc.threads = 3;
    WeftImage three = baked(&desc, &info[1]);
    assert_memory_equal(one.pixels, three.pixels, 7 * 5 * 3 * sizeof(float));
    assert_memory_equal(&info[0], &info[1], sizeof info[0]);
    weft_image_free(&one);
    weft_image_free(&three);
}

/* Refusals. */

static void refuse(const WeftBakeDesc *desc, WeftMessage message) {
    WeftImage table = {.width = 7};
    WeftError error = {0};
    assert_int_not_equal(weft_bake(desc, NULL, &table, &error), WEFT_OK);
    assert_string_equal(weft_message_text(error.message), weft_message_text(message));
    assert_null(strchr(error.text, '\n'));
    assert_null(table.pixels);
}

static void bake_descriptors_without_sense_are_refused(void **state) {
    (void)state;
    const WeftLobe lobe = lobe_of_id("lambert"), none = {.lobe = 1000};
    refuse(&(WeftBakeDesc){.lobe = &lobe}, WEFT_MESSAGE_BAKE_KIND);
    refuse(&(WeftBakeDesc){.kind = "cake", .lobe = &lobe}, WEFT_MESSAGE_BAKE_KIND);
    refuse(&(WeftBakeDesc){.kind = "albedo"}, WEFT_MESSAGE_DESC);
    refuse(&(WeftBakeDesc){.kind = "albedo", .lobe = &none}, WEFT_MESSAGE_DESC);
    refuse(&(WeftBakeDesc){.kind = "albedo", .lobe = &lobe, .threads = -1}, WEFT_MESSAGE_DESC);
    static const int sizes[][2] = {{-1, 4}, {4, -1}, {65537, 1}, {1, 65537}, {65536, 65536}, {65536, 257}};
    for (size_t k = 0; k < sizeof sizes / sizeof *sizes; k++)
        refuse(&(WeftBakeDesc){.kind = "albedo", .lobe = &lobe, .width = sizes[k][0], .height = sizes[k][1]},
               WEFT_MESSAGE_DESC);
}

static int stop_soon(void *user, double fraction) {
    assert_true(fraction > 0.0 && fraction <= 1.0);
    return ++*(int *)user >= 3;
}

static void stopped_bake_leaves_no_table(void **state) {
    (void)state;
    const WeftLobe lobe = lobe_of_id("lambert");
    int calls = 0;
    WeftImage table;
    const WeftBakeDesc desc = {.kind = "albedo",
                               .lobe = &lobe,
                               .width = 4096,
                               .height = 4096,
                               .threads = 2,
                               .progress = stop_soon,
                               .user = &calls};
    assert_int_equal(weft_bake(&desc, NULL, &table, NULL), WEFT_INTERRUPTED);
    assert_null(table.pixels);
    assert_int_equal(calls, 3);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(table_form_reads_as_it_is_written),
        cmocka_unit_test(malformed_table_form_is_refused),
        cmocka_unit_test(texels_of_each_form_are_where_its_engine_has_them),
        cmocka_unit_test(baked_roughness_is_that_of_materials),
        cmocka_unit_test(baked_albedo_is_the_integral),
        cmocka_unit_test(baked_split_sum_is_the_integral),
        cmocka_unit_test(baked_albedo_has_the_parameters_and_parts_of_its_lobe),
        cmocka_unit_test(baked_range_ends_where_the_lobe_does),
        cmocka_unit_test(bake_with_any_number_of_threads_is_the_same),
        cmocka_unit_test(bake_descriptors_without_sense_are_refused),
        cmocka_unit_test(stopped_bake_leaves_no_table),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
