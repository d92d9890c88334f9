/* `weft fit`: what it prints and writes, and how it ends.
 *
 * Labels: unsanitized */
#include "run.h"

#include <math.h>

#include <jansson.h>

#include "weft/weft.h"

/* A table of a lobe, made by `weft eval`. */
static int table_begin(void **state) {
    if (work_begin(state) != 0) return -1;
    FILE *angles = fopen("angles.txt", "w");
    if (!angles) return -1;
    for (int k = 0; k < 900; k++)
        fprintf(angles, "%d %d %d %d\n", 5 + k % 7 * 11, 37 * k % 360, 3 + k / 7 % 8 * 10, 101 * k % 360);
    fclose(angles);
    Ran ran = run_shell("\"$0\" eval ashikhmin-neubelt -p alpha=0.3 -p color=0.8,0.5,0.2 angles.txt >f.txt && "
                        "paste -d' ' angles.txt f.txt | cut -d' ' -f1-7 >table.csv");
    int code = ran.code;
    ran_free(&ran);
    return code;
}

static void fit_finds_the_lobe_that_made_the_data(void **state) {
    (void)state;
    Ran ran = RUN("fit", "table.csv", "--lobe", "ashikhmin-neubelt", "--json", "-o", "m.json");
    if (ran.code != 0) fail_msg("%s", ran.err);
    json_t *json = json_loads(ran.out, JSON_REJECT_DUPLICATES, NULL);
    assert_non_null(json);
    const json_t *best = json_array_get(json_object_get(json, "ranking"), 0);
    assert_string_equal(json_string_value(json_object_get(best, "lobe")), "ashikhmin-neubelt");
    double alpha = json_number_value(json_object_get(json_object_get(best, "params"), "alpha"));
    assert_true(fabs(alpha - 0.3) < 0.003);
    assert_int_equal(json_integer_value(json_object_get(json, "samples_in_file")), 900);
    json_decref(json);
    ran_free(&ran);
    /* the material it wrote is what the table came from */
    WeftMaterial material;
    WeftReflection *of;
    WeftLobe lobe;
    WeftError error;
    if (weft_material_read("m.json", &material, NULL, &error) != WEFT_OK) fail_msg("%s", error.text);
    assert_int_equal(weft_reflection_create(&material, &of, NULL), WEFT_OK);
    assert_int_equal(weft_lobe_init("ashikhmin-neubelt", &lobe, NULL), WEFT_OK);
    lobe.params[0] = 0.3f;
    const float wo[3] = {0.6f, 0.0f, 0.8f}, wi[1][3] = {{-0.28f, 0.0f, 0.96f}};
    float f[1][3], g[3];
    weft_reflection_eval(of, WEFT_PART_ALL, wo, 1, wi, f);
    weft_lobe_eval(&lobe, wo, wi[0], g);
    assert_true(fabsf(f[0][0] - 0.8f * g[0]) < 0.005f * g[0] && fabsf(f[0][2] - 0.2f * g[2]) < 0.005f * g[2]);
    weft_reflection_free(of);
    ran = RUN("render", "builtin:cloth", "--material", "m.json", "--width", "32", "--height", "24", "--spp", "1", "-o",
              "m.png");
    assert_int_equal(ran.code, 0);
    ran_free(&ran);
}

static void fit_prints_a_table_of_lobes_by_error(void **state) {
    (void)state;
    Ran ran = RUN("fit", "table.csv", "--lobe", "charlie-neubelt", "--metric", "cosine");
    assert_int_equal(ran.code, 0);
    assert_non_null(strstr(ran.out, "charlie-neubelt"));
    assert_non_null(strstr(ran.out, "baseline: ggx, f90 = 1, over lambert "));
    assert_non_null(strstr(ran.out, "error is cosine"));
    ran_free(&ran);
}

/* That of Schlick ends at white, whatever f90 is. */
static void f90_is_printed_only_for_lobes_that_read_it(void **state) {
    (void)state;
    Ran ran = run_shell("\"$0\" eval cook-torrance -p v=smith-ggx-correlated -p f=schlick -p alpha=0.3 -p "
                        "color=0.8,0.5,0.2 angles.txt >f2.txt && paste -d' ' angles.txt f2.txt | cut -d' ' "
                        "-f1-7 >plain.csv && \"$0\" fit plain.csv --lobe cook-torrance");
    if (ran.code != 0) fail_msg("%s", ran.err);
    const char *row = strstr(ran.out, "   1  cook-torrance "), *end = row ? strchr(row, '\n') : NULL;
    if (!end || !strstr(row, ", f schlick,")) fail_msg("%s", ran.out);
    const char *f90 = strstr(row, "f90");
    assert_true(!f90 || f90 > end);
    ran_free(&ran);
}

/* A cloth of a reddish ground and a white rim, as a file of the only size there is. */
static void make_measured(const char *path) {
    enum { BINS = 90 * 90 * 180 };
    static const double units[3] = {1500.0, 1500.0 / 1.15, 1500.0 / 1.66}, ground[3] = {0.08, 0.02, 0.03};
    static const int32_t sizes[3] = {90, 90, 180};
    double *f = malloc(BINS * sizeof *f);
    FILE *stream = fopen(path, "wb");
    assert_true(f && stream);
    assert_int_equal(fwrite(sizes, sizeof sizes, 1, stream), 1);
    for (int c = 0; c < 3; c++) {
        for (int k = 0; k < BINS; k++) {
            double th = k / 16200 / 90.0;
            f[k] = (ground[c] + 0.3 * pow(sin(1.5708 * th * th), 3.0)) * units[c];
        }
        assert_int_equal(fwrite(f, BINS * sizeof *f, 1, stream), 1);
    }
    assert_int_equal(fclose(stream), 0);
    free(f);
}

/* The data, the fit and the baseline in two rows, below each the differences. */
static void plot_option_writes_slices(void **state) {
    (void)state;
    make_measured("cloth.binary");
    Ran ran = RUN("fit", "cloth.binary", "--lobe", "charlie-neubelt", "--plot", "slices.png");
    if (ran.code != 0) fail_msg("%s", ran.err);
    ran_free(&ran);
    WeftImage sheet;
    WeftError error;
    if (weft_image_read("slices.png", &sheet, NULL, &error) != WEFT_OK) fail_msg("%s", error.text);
    assert_true(sheet.width > 660 && sheet.height > 4 * 220 && sheet.type == WEFT_PIXEL_U8);
    int cloth[3] = {0}, apart[3] = {0}; /* of a column: reddish grey in its slices, far from grey below */
    const unsigned char *p = sheet.pixels;
    for (int k = 0; k < sheet.width * sheet.height; k++, p += sheet.channels) {
        int column = 3 * (k % sheet.width) / sheet.width, row = 4 * (k / sheet.width) / sheet.height;
        int high = p[0] > p[2] ? p[0] : p[2], low = p[0] > p[2] ? p[2] : p[0];
        cloth[column] += row % 2 == 0 && p[0] > 60 && p[0] > p[2] + 10 && 2 * p[2] > p[0];
        apart[column] += row % 2 == 1 && high > 60 && high > 2 * low;
    }
    for (int c = 0; c < 3; c++) assert_true(cloth[c] > 10000);
    assert_true(apart[1] > 1000 && apart[2] > 1000); /* the data's own column has the scale alone */
    weft_image_free(&sheet);
}

/* A table has gaps: its slices are cells, some of them empty. */
static void slices_of_a_table_are_drawn(void **state) {
    (void)state;
    Ran ran = RUN("fit", "table.csv", "--lobe", "charlie-neubelt", "--plot", "cells.png");
    if (ran.code != 0) fail_msg("%s", ran.err);
    ran_free(&ran);
    WeftImage sheet;
    WeftError error;
    if (weft_image_read("cells.png", &sheet, NULL, &error) != WEFT_OK) fail_msg("%s", error.text);
    int lit[3] = {0}; /* of a column, in the rows of slices */
    const unsigned char *p = sheet.pixels;
    for (int k = 0; k < sheet.width * sheet.height; k++, p += sheet.channels)
        lit[3 * (k % sheet.width) / sheet.width] +=
            4 * (k / sheet.width) / sheet.height % 2 == 0 && (p[0] > p[2] + 10 || p[2] > p[0] + 10);
    print_message("coloured pixels of data, fit and baseline: %d %d %d\n", lit[0], lit[1], lit[2]);
    for (int c = 0; c < 3; c++) assert_true(lit[c] > 300);
    weft_image_free(&sheet);
}

/* The nearest that an engine can do, as a material, an asset and text; each says the same numbers. */
static void engine_nearest_to_data_is_written(void **state) {
    (void)state;
    Ran ran = RUN("fit", "table.csv", "--lobe", "charlie-neubelt", "--to", "khronos", "-o", "near.json", "-o",
                  "near.glb", "-o", "near.hlsl", "--json");
    if (ran.code != 0) fail_msg("%s", ran.err);
    json_t *json = json_loads(ran.out, 0, NULL), *to = json_object_get(json, "to");
    assert_string_equal(json_string_value(json_object_get(to, "profile")), "khronos");
    double error = json_number_value(json_object_get(to, "error")),
           best = json_number_value(json_object_get(json_array_get(json_object_get(json, "ranking"), 0), "error"));
    print_message("khronos %.4f, free %.4f\n", error, best);
    assert_true(error > 0.0 && error < 0.1 && best < 0.1); /* it has a highlight, which may help */
    json_decref(json);
    ran_free(&ran);
    WeftMaterial alone, worn;
    WeftError failed;
    WeftScene *scene;
    assert_int_equal(weft_material_read("near.json", &alone, NULL, &failed), WEFT_OK);
    if (weft_scene_load("near.glb", &scene, NULL, &failed) != WEFT_OK) fail_msg("%s", failed.text);
    bool found = false;
    for (int k = 0; k < weft_scene_info(scene).material_count; k++) {
        bool same = weft_scene_material(scene, k, &worn, NULL) == WEFT_OK;
        for (int n = 0; n < WEFT_INPUTS_MAX && same; n++)
            same = fabsf(worn.inputs[n].value[0] - alone.inputs[n].value[0]) <= 1e-5f;
        found |= same;
    }
    assert_true(found);
    weft_scene_free(scene);
    FILE *text = fopen("near.hlsl", "r");
    char line[256];
    assert_non_null(text);
    bool named = false;
    while (fgets(line, sizeof line, text)) named |= strstr(line, "khronos") != NULL;
    assert_true(named);
    fclose(text);
}

/* A material as it is has the error of the fit that it was written from. */
static void error_of_a_material_is_that_of_its_fit(void **state) {
    (void)state;
    double errors[2];
    for (int again = 0; again < 2; again++) {
        Ran ran = again ? RUN("fit", "table.csv", "--lobe", "burley-sheen", "--to", "same.json", "--json")
                        : RUN("fit", "table.csv", "--lobe", "burley-sheen", "-o", "same.json", "--json");
        if (ran.code != 0) fail_msg("%s", ran.err);
        json_t *json = json_loads(ran.out, 0, NULL), *to = json_object_get(json, "to");
        const json_t *best = json_array_get(json_object_get(json, "ranking"), 0);
        errors[again] = json_number_value(json_object_get(again ? to : best, "error"));
        if (again) assert_string_equal(json_string_value(json_object_get(to, "material")), "same.json");
        json_decref(json);
        ran_free(&ran);
    }
    print_message("fitted %.5f, its material %.5f\n", errors[0], errors[1]);
    assert_true(errors[0] > 0.0 && fabs(errors[1] - errors[0]) < 0.002 * errors[0] + 1e-5);
}

/* A fit of fabric over body is written whole: no warning, and the numbers that the table was made with. */
static void whole_fit_of_fabric_is_written(void **state) {
    (void)state;
    Ran ran =
        run_shell("awk 'BEGIN { for (k = 0; k < 3000; k++) print 79 * (k * .618034 % 1), 37 * k % 360, 79 * (k * "
                  ".754878 % 1), "
                  "101 * k % 360 }' >pairs.txt && "
                  "\"$0\" eval fabric -p alpha=0.3 -p tail=1.4 -p rise=2.5 -p color=0.2,0.1,0.05 -p f90=0.6,0.5,0.4 "
                  "pairs.txt >over.txt && "
                  "\"$0\" eval body -p edge=0.2 -p retro=1 -p lift=1.5 -p color=0.3,0.1,0.1 pairs.txt >under.txt && "
                  "paste -d' ' pairs.txt over.txt under.txt | awk '{ print $1, $2, $3, $4, $5 + $9, $6 + $10, $7 + $11 "
                  "}' >whole.csv && "
                  "\"$0\" fit whole.csv --base body --lobe fabric -o whole.json");
    if (ran.code != 0) fail_msg("%s", ran.err);
    if (strstr(ran.err, "has no inputs")) fail_msg("%s", ran.err);
    ran_free(&ran);
    WeftMaterial material;
    WeftError error;
    assert_int_equal(weft_material_read("whole.json", &material, NULL, &error), WEFT_OK);
    static const struct {
        const char *name;
        float value;
    } inputs[] = {{"sheen_tail", 1.4f},
                  {"sheen_rise", 2.5f},
                  {"diffuse_retro", 1.0f},
                  {"diffuse_lift", 1.5f},
                  {"roughness", 0.2f}};
    for (size_t k = 0; k < sizeof inputs / sizeof *inputs; k++) {
        int input = weft_material_input_find(inputs[k].name);
        float found = material.inputs[input].value[0];
        if (!(fabsf(found - inputs[k].value) <= 0.03f * inputs[k].value))
            fail_msg("%s is %g, not %g", inputs[k].name, (double)found, (double)inputs[k].value);
        assert_true(weft_material_reads(&material, input));
    }
}

/* The material of a fit may name what it was fitted to, by which the path tracer then reflects. */
static void material_of_a_fit_names_its_data(void **state) {
    (void)state;
    make_measured("cloth.binary");
    for (int named = 0; named < 2; named++) {
        Ran ran = RUN("fit", "cloth.binary", "--lobe", "charlie-neubelt", "-o", "cloth.json",
                      named ? "--measured" : "--json");
        if (ran.code != 0) fail_msg("%s", ran.err);
        ran_free(&ran);
        ran = RUN("render", "builtin:cloth", "--material", "cloth.json", "--width", "32", "--height", "24", "--spp",
                  "2", "-o", named ? "table.exr" : "fitted.exr");
        if (ran.code != 0) fail_msg("%s", ran.err);
        ran_free(&ran);
    }
    Ran ran = RUN("diff", "fitted.exr", "table.exr", "--max", "1e-4");
    assert_int_equal(ran.code, 1); /* the fit is not the table */
    ran_free(&ran);
    assert_complaint(NULL, LIST("fit", "table.csv", "--measured", "-o", "a.json"), 2, "is no .binary");
    assert_complaint(NULL, LIST("fit", "cloth.binary", "--measured", "-o", "a.glb"), 2, "only a material file");
}

static void fit_of_bad_data_or_options_is_refused(void **state) {
    (void)state;
    file_make("bad.csv", "1,2,3\n", 6);
    file_make("short.binary", "abc", 3);
    assert_complaint(NULL, LIST("fit", "bad.csv"), 3, "line 1");
    assert_complaint(NULL, LIST("fit", "short.binary"), 3, "3 bytes");
    assert_complaint(NULL, LIST("fit", "not-there.csv"), 3, "not-there");
    assert_complaint(NULL, LIST("fit", "table.csv", "--lobe", "velours"), 2, "velours");
    assert_complaint(NULL, LIST("fit", "table.csv", "--base", "ggx"), 2, "diffuse");
    assert_complaint(NULL, LIST("fit", "table.csv", "--lobe", "lambert"), 2, "--base");
    assert_complaint(NULL, LIST("fit", "table.csv", "--base", "woven", "--lobe", "silk"), 2, "--lobe woven");
    assert_complaint(NULL, LIST("fit", "table.csv", "--base", "woven", "-o", "a.json"), 2, "no material");
    assert_complaint(NULL, LIST("fit", "cloth.binary", "--base", "woven"), 2, "do not tell warp from weft");
    assert_complaint(NULL, LIST("fit", "table.csv", "--lobe", "fibre-walk"), 2, "fit fibre");
    assert_complaint(NULL, LIST("fit", "table.csv", "-o", "a.png"), 2, ".json");
    assert_complaint(NULL, LIST("fit", "table.csv", "--plot", "a.jpg"), 2, ".png");
    assert_complaint(NULL, LIST("fit", "table.csv", "--to", "unreal5"), 2, "unreal4");
    assert_complaint(NULL, LIST("fit", "table.csv", "--to", "ggx"), 2, "neither a profile nor a material");
    assert_complaint(NULL, LIST("fit", "table.csv", "-o", "table.csv"), 2, ".json");
    file_make("short.bsdf", "abc", 3);
    assert_complaint(NULL, LIST("fit", "short.bsdf"), 3, "RGL's format");
    file_make("short.bin", "abc", 3);
    assert_complaint(NULL, LIST("fit", "short.bin"), 3, "UTIA's format");
    assert_complaint(NULL, LIST("fit", "table.csv", "--metric", "picture"), 2, "picture");
}

/* Interrupts the longest fit, of a table so large that no machine ends it first. */
static void interrupted_fit_ends(void **state) {
    (void)state;
    Ran made = run_shell("for k in $(seq 200); do cat table.csv; done >long.csv");
    assert_int_equal(made.code, 0);
    ran_free(&made);
    pid_t child = program_start(WEFT_PROGRAM, NULL, LIST("fit", "long.csv", "--lobe", "threads"));
    await_handler(child);
    sleep_seconds(0.2);
    double asked = clock_now();
    kill(child, SIGINT);
    Ran ran = program_end(child);
    if (ran.code != 130 || !one_complaint(ran.err) || !strstr(ran.err, "interrupted") || ran.out[0])
        fail_msg("%d: %s", ran.code, ran.err);
    print_message("ended after %.2f s\n", clock_now() - asked);
    ran_free(&ran);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(fit_finds_the_lobe_that_made_the_data),
                                       cmocka_unit_test(fit_prints_a_table_of_lobes_by_error),
                                       cmocka_unit_test(f90_is_printed_only_for_lobes_that_read_it),
                                       cmocka_unit_test(plot_option_writes_slices),
                                       cmocka_unit_test(slices_of_a_table_are_drawn),
                                       cmocka_unit_test(engine_nearest_to_data_is_written),
                                       cmocka_unit_test(error_of_a_material_is_that_of_its_fit),
                                       cmocka_unit_test(whole_fit_of_fabric_is_written),
                                       cmocka_unit_test(interrupted_fit_ends),
                                       cmocka_unit_test(material_of_a_fit_names_its_data),
                                       cmocka_unit_test(fit_of_bad_data_or_options_is_refused)};
    return cmocka_run_group_tests(tests, table_begin, work_end);
}
