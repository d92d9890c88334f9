/* `weft bake`: the files of a table agree, the audit finds what is wrong, and nonsense is refused */
#include "run.h"

#include <math.h>

#include <jansson.h>

#include "weft/weft.h"

static void assert_near(double got, double expected, double tolerance) {
    if (!(fabs(got - expected) <= tolerance)) fail_msg("%.9g, not %.9g +- %g", got, expected, tolerance);
}

static json_t *json_of(const char *text) {
    json_error_t error;
    json_t *json = json_loads(text, JSON_REJECT_DUPLICATES, &error);
    if (!json) fail_msg("line %d: %s", error.line, error.text);
    return json;
}

static double number_at(json_t *json, const char *key) {
    json_t *value = json_object_get(json, key);
    if (!json_is_number(value)) fail_msg("no number \"%s\"", key);
    return json_number_value(value);
}

/* A run that must end well. */
static Ran done(const char *const *arguments) {
    Ran ran = run_with(NULL, arguments);
    if (ran.code != 0) fail_msg("%d: %s", ran.code, ran.err);
    return ran;
}

/* The same where only its files matter. */
static void finish(Ran ran) { ran_free(&ran); }

static WeftImage image_of(const char *path) {
    WeftImage image;
    WeftError error = {0};
    if (weft_image_read(path, &image, NULL, &error) != WEFT_OK) fail_msg("%s", error.text);
    return image;
}

static void assert_shape(const WeftImage *image, int width, int height, int channels, WeftPixelType type) {
    assert_int_equal(image->width, width);
    assert_int_equal(image->height, height);
    assert_int_equal(image->channels, channels);
    assert_int_equal(image->type, type);
}

static bool is_there(const char *path) { return access(path, F_OK) == 0; }

static void bake_help_names_every_kind(void **state) {
    (void)state;
    Ran ran = done(LIST("bake", "--help"));
    for (int k = 0; weft_bake_kind(k); k++) {
        char row[64];
        snprintf(row, sizeof row, "\n  %s ", weft_bake_kind(k)->id);
        if (!strstr(ran.out, row)) fail_msg("weft bake --help lacks %s", weft_bake_kind(k)->id);
    }
    for (int k = 0; weft_table_form_name(k); k++) assert_non_null(strstr(ran.out, weft_table_form_name(k)));
    for (const char *line = ran.out; *line; line += strcspn(line, "\n") + 1)
        if (strcspn(line, "\n") > 80) fail_msg("over 80 columns: %.100s", line);
    ran_free(&ran);
}

/* The first `count` numbers behind the first line with `mark`. */
static void numbers_behind(const char *text, const char *mark, int count, double *numbers) {
    const char *at = strstr(text, mark);
    assert_non_null(at);
    at += strcspn(at, "\n");
    for (int k = 0; k < count; k++) {
        char *end;
        at += strspn(at, "\n ,f");
        numbers[k] = strtod(at, &end);
        assert_true(end > at);
        at = end;
    }
}

/* One table in all formats: the same numbers, and the command where it can be. */
static void every_file_format_holds_the_same_table(void **state) {
    (void)state;
    enum { W = 5, H = 3, N = W * H * 2 };
    const char command[] = "weft bake albedo ggx --size 5x3 -p anisotropy=0.5 -o t.h -o t.npy -o t.exr -o t.png -o "
                           "t.csv -o t.txt --quiet";
    Ran ran = done(LIST("bake", "albedo", "ggx", "--size", "5x3", "-p", "anisotropy=0.5", "-o", "t.h", "-o", "t.npy",
                        "-o", "t.exr", "-o", "t.png", "-o", "t.csv", "-o", "t.txt", "--quiet"));
    assert_string_equal(ran.out, "");
    assert_string_equal(ran.err, "");
    ran_free(&ran);

    WeftImage npy = image_of("t.npy"), exr = image_of("t.exr"), png = image_of("t.png");
    assert_shape(&npy, W, H, 2, WEFT_PIXEL_F32);
    assert_shape(&exr, W, H, 3, WEFT_PIXEL_F32);
    assert_shape(&png, W, H, 3, WEFT_PIXEL_U16);
    const float *values = npy.pixels;
    for (int n = 0; n < N; n++) {
        const int wide = n / 2 * 3 + n % 2;
        assert_near((double)((float *)exr.pixels)[wide], (double)values[n], 0.0);
        assert_near((double)((uint16_t *)png.pixels)[wide] / 65535.0, (double)values[n], 0.5001 / 65535.0);
        assert_near((double)((float *)exr.pixels)[n / 2 * 3 + 2], 0.0, 0.0);
        assert_true(values[n] > 0.0f && values[n] < 1.0f);
    }

    static const char *const texts[] = {"t.h", "t.csv", "t.txt"};
    for (int k = 0; k < 3; k++) {
        size_t size;
        double numbers[N];
        char *text = file_bytes(texts[k], &size);
        assert_non_null(text);
        assert_int_equal(strncmp(text + (k ? 2 : 3), command, sizeof command - 1), 0);
        assert_int_equal(strncmp(text, k ? "# " : "// ", k ? 2 : 3), 0);
        numbers_behind(text, k ? "# directional" : "static const float table_t[3 * 5 * 2]", N, numbers);
        for (int n = 0; n < N; n++) assert_near(numbers[n], (double)values[n], 1e-8);
        free(text);
    }
    size_t size;
    char *bytes = file_bytes("t.png", &size);
    bool found = false;
    for (size_t n = 0; n + sizeof command < size; n++) found |= memcmp(bytes + n, command, sizeof command - 1) == 0;
    assert_true(found);
    for (size_t n = 0; n + 4 < size; n++) assert_true(memcmp(bytes + n, "sRGB", 4) != 0);
    free(bytes);
    bytes = file_bytes("t.exr", &size);
    found = false;
    for (size_t n = 0; n + sizeof command < size; n++) found |= memcmp(bytes + n, command, sizeof command - 1) == 0;
    assert_true(found);
    free(bytes);
    weft_image_free(&npy);
    weft_image_free(&exr);
    weft_image_free(&png);
}

/* An audit reads what a bake writes, and arrays and rows of others. */
static void audit_reads_every_format_that_is_baked(void **state) {
    (void)state;
    static const char *const files[] = {"a.h", "a.csv", "a.txt", "a.dds", "a.npy", "a.exr"};
    finish(done(LIST("bake", "dfg", "charlie-neubelt", "--axes", "filament", "--size", "9x6", "-o", "a.h", "-o",
                     "a.csv", "-o", "a.txt", "-o", "a.dds", "-o", "a.npy", "-o", "a.exr", "--quiet")));
    for (size_t k = 0; k < sizeof files / sizeof *files; k++) {
        Ran ran = done(LIST("bake", "audit", files[k], "--lobe", "charlie-neubelt", "--channel", "2", "--quiet"));
        if (!strstr(ran.out, "9 x 6, E of charlie-neubelt")) fail_msg("%s: %s", files[k], ran.out);
        assert_non_null(strstr(ran.out, "filament"));
        assert_non_null(strstr(ran.out, "it is right"));
        ran_free(&ran);
    }
    WeftImage table = image_of("a.npy");
    char text[20000];
    const float *e = table.pixels;
    for (int nested = 0; nested < 3; nested++) {
        static const char *const heads[] = {"const vec3 lut[6 * 9] = vec3[54](\n", "float3 lut[6][9] = {\n",
                                            "/* { 1, 2 } */ const float lut[][9][3] = {\n"};
        int used = snprintf(text, sizeof text, "#define N 54\n%s", heads[nested]);
        for (int n = 0; n < 54; n++)
            used += snprintf(text + used, sizeof text - (size_t)used,
                             nested == 0   ? "vec3(%.7f, %.7f, %.7f), "
                             : nested == 1 ? "float3(%.7ff, %.7ff, %.7ff),\n"
                                           : "{%.7ff, %.7ff, %.7ff}, // c\n",
                             (double)e[3 * n], (double)e[3 * n + 1], (double)e[3 * n + 2]);
        snprintf(text + used, sizeof text - (size_t)used, "%s;\nconst int more[] = {1, 2};\n", nested ? "}" : ")");
        file_make("other.hlsl", text, strlen(text));
        Ran ran = run_with(
            NULL, LIST("bake", "audit", "other.hlsl", "--lobe", "charlie-neubelt", "--channel", "b", "--quiet"));
        if (nested == 2) { /* of rows that are not named */
            assert_int_equal(ran.code, 3);
            assert_non_null(strstr(ran.err, "does not say of how many rows and columns"));
        } else if (ran.code != 0 || !strstr(ran.out, "9 x 6, E of charlie-neubelt")) {
            fail_msg("%d: %s%s", nested, ran.out, ran.err);
        }
        ran_free(&ran);
    }
    weft_image_free(&table);
    file_make("ragged.csv", "1,2,3\n1,2\n", 10);
    assert_complaint(NULL, LIST("bake", "audit", "ragged.csv", "--lobe", "ggx"), 3, "line 2 has 2 numbers");
    file_make("word.csv", "cos,e\n1,2\n1,x\n", 14);
    assert_complaint(NULL, LIST("bake", "audit", "word.csv", "--lobe", "ggx"), 3, "line 3: no number begins at \"x\"");
    file_make("empty.h", "int x;\n", 7);
    assert_complaint(NULL, LIST("bake", "audit", "empty.h", "--lobe", "ggx"), 3, "has no array");
}

/* E as a function of a few terms: in C its values, elsewhere its text. */
static void closed_form_of_an_albedo_is_within_its_error(void **state) {
    (void)state;
    Ran ran = done(LIST("bake", "albedo", "charlie-neubelt", "--form", "polynomial", "--error", "0.01", "-o", "form.h",
                        "-o", "form.glsl", "-o", "form.hlsl", "-o", "form.wgsl"));
    assert_non_null(strstr(ran.err, "charlie_neubelt_albedo: "));
    ran_free(&ran);
    size_t size;
    char *text = file_bytes("form.glsl", &size);
    assert_non_null(strstr(text, "// weft bake albedo charlie-neubelt --form polynomial"));
    assert_non_null(strstr(text, "off by at most 0.00"));
    assert_non_null(strstr(text, "float charlie_neubelt_albedo(float cos_o, float roughness) {"));
    assert_true(size < 1500);
    free(text);
    text = file_bytes("form.wgsl", &size);
    assert_non_null(strstr(text, "fn charlie_neubelt_albedo(cos_o: f32, roughness: f32) -> f32 {"));
    free(text);
    static const char source[] = "#include <stdio.h>\n#include \"form.h\"\nint main(void) {\n"
                                 "    for (int k = 0; k < 400; k++) printf(\"%.9g\\n\", "
                                 "(double)charlie_neubelt_albedo(((float)(k % 20) + 0.3f) / 20.0f,\n"
                                 "        0.2f + 0.8f * (float)(k / 20) / 19.0f));\n    return 0;\n}\n";
    file_make("main.c", source, sizeof source - 1);
    ran = run_shell("command -v cc >/dev/null || exit 77; "
                    "cc -std=c99 -Wall -Wextra -Werror -pedantic -o main main.c -lm && ./main");
    if (ran.code == 77) {
        ran_free(&ran);
        skip();
    }
    assert_int_equal(ran.code, 0);
    const char *at = ran.out;
    WeftLobe lobe;
    assert_int_equal(weft_lobe_init("charlie-neubelt", &lobe, NULL), WEFT_OK);
    for (int k = 0; k < 400; k++) {
        char *end;
        float e[3], r = 0.2f + 0.8f * (float)(k / 20) / 19.0f;
        const double value = strtod(at, &end);
        at = end;
        lobe.params[0] = r * r;
        weft_lobe_albedo(&lobe, ((float)(k % 20) + 0.3f) / 20.0f, e);
        assert_near(value, (double)e[0], 0.0105);
    }
    ran_free(&ran);
    ran = done(LIST("bake", "albedo", "ggx", "--form", "polynomial", "--error", "0.02", "--quiet"));
    assert_non_null(strstr(ran.out, "float ggx_albedo_f0(float cos_o, float roughness) {"));
    assert_non_null(strstr(ran.out, "float ggx_albedo_f90(float cos_o, float roughness) {"));
    ran_free(&ran);
    assert_complaint(NULL, LIST("bake", "albedo", "ggx", "--form", "spline"), 2, "there is polynomial");
    assert_complaint(NULL, LIST("bake", "albedo", "ggx", "--form", "polynomial", "-o", "f.png"), 2,
                     "f.png: a function");
    assert_complaint(NULL, LIST("bake", "albedo", "ggx", "--form", "polynomial", "--size=2x2"), 2, "--size");
    assert_complaint(NULL, LIST("bake", "dfg", "--form", "polynomial", "-o", "f.h"), 2,
                     "--form: does not go with bake dfg");
    assert_complaint(NULL, LIST("bake", "albedo", "lambert", "--form", "polynomial"), 2, "no roughness");
}

/* What a C compiler makes of the array. */
static void c_array_of_the_table_compiles(void **state) {
    (void)state;
    static const char source[] =
        "#include <stdio.h>\n#include \"a b*;.h\"\nint main(void) {\n"
        "    printf(\"%d %d %d %zu %.6f\\n\", table_a_b___width, table_a_b___height, table_a_b___channels,\n"
        "           sizeof table_a_b__ / sizeof table_a_b__[0], (double)table_a_b__[0]);\n    return 0;\n}\n";
    finish(done(LIST("bake", "albedo", "lambert", "--size=2x2", "-o", "a b*;.h", "--quiet")));
    file_make("main.c", source, sizeof source - 1);
    Ran ran = run_shell("command -v cc >/dev/null || exit 77; "
                        "cc -std=c99 -Wall -Wextra -Werror -pedantic -o main main.c && ./main");
    if (ran.code == 77) {
        ran_free(&ran);
        skip();
    }
    assert_string_equal(ran.out, "2 2 1 4 1.000000\n");
    size_t size;
    char *text = file_bytes("a b*;.h", &size);
    const char first[] = "// weft bake albedo lambert --size=2x2 -o 'a b*;.h' --quiet\n";
    assert_memory_equal(text, first, sizeof first - 1);
    free(text);
    ran_free(&ran);
}

/* A .png has a scale where values pass 1, said in one line; nothing is cut off. */
static void png_of_values_above_one_is_scaled_not_clipped(void **state) {
    (void)state;
    Ran ran = done(LIST("bake", "albedo", "charlie-neubelt", "--size", "16x16", "-o", "s.png", "-o", "s.npy"));
    assert_non_null(strstr(ran.err, "weft: s.png: holds the table / 4, whose values go up to 2."));
    ran_free(&ran);
    WeftImage png = image_of("s.png"), npy = image_of("s.npy");
    for (int n = 0; n < 256; n++)
        assert_near((double)((uint16_t *)png.pixels)[n] * 4.0 / 65535.0, (double)((float *)npy.pixels)[n],
                    2.001 / 65535.0);
    weft_image_free(&png);
    weft_image_free(&npy);
    assert_complaint(
        NULL, LIST("bake", "albedo", "charlie-neubelt", "--size", "16x16", "-o", "no.png", "--scale", "1", "--quiet"),
        2, "another --scale");
    assert_false(is_there("no.png"));
}

static void exr_is_rounded_to_half_only_with_half(void **state) {
    (void)state;
    finish(done(LIST("bake", "albedo", "wrap", "--size=9x4", "-o", "w.exr", "--half", "--quiet")));
    finish(done(LIST("bake", "albedo", "wrap", "--size=9x4", "-o", "w.npy", "--quiet")));
    WeftImage half = image_of("w.exr"), full = image_of("w.npy");
    double off = 0.0;
    for (int n = 0; n < 36; n++)
        off = fmax(off, fabs((double)((float *)half.pixels)[n] - (double)((float *)full.pixels)[n]));
    assert_true(off > 1e-6 && off < 6e-4);
    weft_image_free(&half);
    weft_image_free(&full);
}

static void json_describes_the_table(void **state) {
    (void)state;
    Ran ran = done(LIST("bake", "dfg", "charlie-neubelt", "--axes", "filament", "--size", "6x4", "-o", "d.npy",
                        "--json", "--tolerance", "1e-3"));
    json_t *json = json_of(ran.out);
    assert_string_equal(json_string_value(json_object_get(json, "kind")), "dfg");
    assert_string_equal(json_string_value(json_object_get(json, "axes")), "cos,roughness,centres,flip-y,total");
    assert_near(number_at(json, "width"), 6.0, 0.0);
    assert_near(number_at(json, "height"), 4.0, 0.0);
    assert_true(number_at(json, "error") < 1e-3);
    assert_true(number_at(json, "high") > 1.0);
    json_decref(json);
    ran_free(&ran);
}

/* Auditing. */

static void audit_prints_fault_and_error_of_a_table(void **state) {
    (void)state;
    finish(done(
        LIST("bake", "dfg", "ashikhmin-neubelt", "--axes", "three", "--size", "12x10", "-o", "three.exr", "--quiet")));
    Ran ran = done(LIST("bake", "audit", "three.exr", "--channel", "b", "--lobe", "ashikhmin-neubelt"));
    assert_non_null(strstr(ran.out, "roughness,cos,centres (three; they fit best)"));
    assert_non_null(strstr(ran.out, "\n  none "));
    assert_string_equal(ran.err, "");
    for (const char *line = ran.out; *line; line += strcspn(line, "\n") + 1) assert_true(strcspn(line, "\n") <= 80);
    ran_free(&ran);

    /* as if it were Filament's: wrong, with exit 1, and the errors as numbers and as a sheet */
    ran = RUN("bake", "audit", "three.exr", "--channel", "2", "--lobe", "ashikhmin-neubelt", "--axes", "filament", "-o",
              "e.npy", "-o", "e.exr", "-o", "e.png", "--json", "--max", "0.02");
    assert_int_equal(ran.code, 1);
    assert_true(one_complaint(ran.err));
    assert_non_null(strstr(ran.err, "more than 0.02"));
    json_t *json = json_of(ran.out);
    WeftImage npy = image_of("e.npy"), exr = image_of("e.exr"), png = image_of("e.png");
    assert_shape(&npy, 12, 10, 1, WEFT_PIXEL_F32);
    assert_true(png.width > 900 && png.height > 250);
    double largest = 0.0, squares = 0.0, sum = 0.0, beyond = 0.0;
    int x = 0, y = 0;
    for (int n = 0; n < 120; n++) {
        const double e = (double)((float *)npy.pixels)[n];
        assert_near((double)((float *)exr.pixels)[n], e, 0.0);
        squares += e * e;
        sum += e;
        beyond += fabs(e) > 0.02;
        if (fabs(e) <= largest) continue;
        largest = fabs(e);
        x = n % 12, y = n / 12;
    }
    const double texels = number_at(json, "texels");
    json_t *place = json_object_get(json, "largest");
    assert_near(texels + number_at(json, "left_out"), 120.0, 0.0);
    assert_near(number_at(place, "error"), largest, 1e-6);
    assert_near(number_at(place, "x"), x, 0.0);
    assert_near(number_at(place, "y"), y, 0.0);
    assert_near(number_at(place, "table") - number_at(place, "albedo"), (double)((float *)npy.pixels)[y * 12 + x],
                1e-6);
    assert_near(number_at(json, "rms"), sqrt(squares / texels), 1e-6);
    assert_near(number_at(json, "mean"), sum / texels, 1e-6);
    assert_near(number_at(json, "beyond"), beyond / texels, 1e-9);
    json_t *finding = json_array_get(json_object_get(json, "findings"), 0);
    assert_string_equal(json_string_value(json_object_get(finding, "id")), "axes");
    json_decref(json);
    weft_image_free(&npy);
    weft_image_free(&exr);
    weft_image_free(&png);
    ran_free(&ran);
}

/* 8 bits in a file of three equal channels, and what the viewer of glTF once shipped. */
static void picture_of_8_bits_is_audited_as_a_table(void **state) {
    (void)state;
    enum { SIDE = 8 };
    const WeftTableForm form = {0};
    WeftImage grey;
    WeftLobe lobe;
    WeftImage table;
    assert_int_equal(weft_lobe_init("ashikhmin-conty-kulla", &lobe, NULL), WEFT_OK);
    const WeftBakeDesc desc = {
        .kind = "albedo", .lobe = &lobe, .width = SIDE, .height = SIDE, .form = form, .tolerance = 1e-4};
    assert_int_equal(weft_bake(&desc, NULL, &table, NULL), WEFT_OK);
    assert_int_equal(weft_image_create(SIDE, SIDE, 3, WEFT_PIXEL_U8, &grey, NULL), WEFT_OK);
    for (int n = 0; n < SIDE * SIDE * 3; n++)
        ((uint8_t *)grey.pixels)[n] = (uint8_t)(255.0 * fmin((double)((float *)table.pixels)[n / 3], 1.0) + 0.5);
    assert_int_equal(weft_image_write("grey.png", &grey, NULL), WEFT_OK);
    Ran ran = done(LIST("bake", "audit", "grey.png", "--lobe", "ashikhmin-conty-kulla"));
    assert_non_null(strstr(ran.out, "its bits can hold"));
    ran_free(&ran);
    ((uint8_t *)grey.pixels)[1] ^= 128; /* now it has colours */
    assert_int_equal(weft_image_write("rgb.png", &grey, NULL), WEFT_OK);
    assert_complaint(NULL, LIST("bake", "audit", "rgb.png", "--lobe", "ashikhmin-conty-kulla"), 2,
                     "rgb.png: has 3 channels; say which with --channel");
    finish(done(LIST("bake", "audit", "rgb.png", "--lobe", "ashikhmin-conty-kulla", "--channel", "B")));
    memset(grey.pixels, 0, 3);
    grey.width = grey.height = 1;
    assert_int_equal(weft_image_write("black.png", &grey, NULL), WEFT_OK);
    ran = RUN("bake", "audit", "black.png", "--lobe", "charlie-khronos");
    assert_int_equal(ran.code, 1);
    assert_non_null(strstr(ran.out, "it is a single texel of 0"));
    ran_free(&ran);
    weft_image_free(&grey);
    weft_image_free(&table);
}

/* Ctrl-C leaves nothing, an old file included. */
static void interrupted_bake_writes_nothing(void **state) {
    (void)state;
    file_make("old.npy", "old", 3);
    pid_t child = program_start(WEFT_PROGRAM, NULL,
                                LIST("bake", "albedo", "ggx", "--size", "4096x4096", "-o", "old.npy", "-o", "new.h"));
    await_handler(child);
    sleep_seconds(0.2);
    kill(child, SIGINT);
    Ran ran = program_end(child);
    assert_int_equal(ran.code, 130);
    assert_true(one_complaint(ran.err));
    assert_non_null(strstr(ran.err, "interrupted; nothing was written"));
    assert_true(same_bytes("old.npy", "old", 3));
    assert_false(is_there("new.h"));
    ran_free(&ran);
}

/* A material as a .bsdf is a model that other commands take, near the material. */
static void bsdf_of_a_material_is_near_it(void **state) {
    (void)state;
    Ran ran = RUN("bake", "bsdf", "preset:wool", "-o", "wool.bsdf", "--size", "16x32");
    if (ran.code != 0) fail_msg("%s", ran.err);
    ran_free(&ran);
    WeftReflection *file, *of;
    WeftMaterial material;
    WeftError error;
    double distance = 1.0;
    if (weft_reflection_read("wool.bsdf", &file, &error) != WEFT_OK) fail_msg("%s", error.text);
    assert_int_equal(weft_material_read("preset:wool", &material, NULL, &error), WEFT_OK);
    assert_int_equal(weft_reflection_create(&material, &of, &error), WEFT_OK);
    assert_int_equal(weft_brdf_distance(file, of, WEFT_PART_ALL, WEFT_BRDF_METRIC_COSINE, &distance, &error), WEFT_OK);
    print_message("a .bsdf of 16 x 32 is %.4f from its material\n", distance);
    assert_true(distance < 0.02);
    weft_reflection_free(of);
    weft_reflection_free(file);
    ran = RUN("fit", "wool.bsdf", "--lobe", "charlie-conty-kulla", "--base", "oren-nayar");
    if (ran.code != 0) fail_msg("%s", ran.err);
    ran_free(&ran);
}

/* A measurement as a lobe: near what was measured, with all that a lobe has, and worn in both engines. */
static void measured_lobe_is_near_and_renders_in_both_engines(void **state) {
    (void)state;
    FILE *angles = fopen("pairs.txt", "w");
    assert_non_null(angles);
    for (int k = 0; k < 4000; k++)
        fprintf(angles, "%g %d %g %d\n", 79.0 * (k * 0.618034 - (int)(k * 0.618034)), 37 * k % 360,
                79.0 * (k * 0.754878 - (int)(k * 0.754878)), 101 * k % 360);
    fclose(angles);
    Ran ran = run_shell("\"$0\" eval fabric -p alpha=0.4 -p color=0.3,0.1,0.05 -p f90=0.6,0.5,0.4 pairs.txt >f.txt && "
                        "paste -d' ' pairs.txt f.txt | cut -d' ' -f1-7 >cloth.csv && "
                        "\"$0\" bake lobe cloth.csv -o my_cloth.h -o my_cloth.json");
    if (ran.code != 0) fail_msg("%s", ran.err);
    const char *error = strstr(ran.err, "error ");
    assert_non_null(error);
    print_message("%s", ran.err);
    assert_true(strtod(error + 6, NULL) < 0.03);
    ran_free(&ran);
    ran = run_shell("mkdir 'a*' && cp cloth.csv 'a*/b.csv' && \"$0\" bake lobe 'a*/b.csv' -o starred.h && "
                    "\"$0\" eval starred --lobe starred.h pairs.txt >stars.txt && rm -r 'a*'");
    if (ran.code != 0) fail_msg("%s", ran.err); /* the name ends no comment */
    ran_free(&ran);
    ran = RUN("check", "my-cloth", "--lobe", "my_cloth.h", "--quick");
    if (ran.code != 0) fail_msg("%s%s", ran.out, ran.err);
    ran_free(&ran);
    ran = RUN("render", "builtin:cloth", "--lobe", "my_cloth.h", "--material", "my_cloth.json", "--engine", "both",
              "--width", "48", "--height", "36", "--spp", "4", "-o", "worn.png");
    if (ran.code != 0) fail_msg("%s", ran.err);
    ran_free(&ran);
}

static void bake_options_without_sense_are_refused(void **state) {
    (void)state;
    file_make("not.png", "\x89PNG\r\n", 6);
    file_make("hello.npy", "\x93NUMPY\1\0\xff\xff", 10);
    static const struct {
        const char *arguments[10];
        int code;
        const char *part;
    } cases[] = {
        {{"bake"}, 2, "lacks an operand"},
        {{"bake", "fibre-model"}, 2, "needs -o"},
        {{"bake", "fibre-model", "--size", "4x4", "-o", "x.h"}, 2, "--size"},
        {{"bake", "lobe", "-o", "x.h"}, 2, "needs a measurement"},
        {{"bake", "lobe", "x.binary"}, 2, "needs -o NAME.h"},
        {{"bake", "lobe", "x.binary", "-o", "x.png"}, 2, "x.png"},
        {{"bake", "lobe", "x.binary", "-o", "x.h", "-o", "y.h"}, 2, "y.h"},
        {{"bake", "lobe", "x.binary", "-o", "x.h"}, 3, "x.binary: cannot be opened"},
        {{"bake", "lobe", "x.binary", "-o", "x.h", "--size", "4x4"}, 2, "--size"},
        {{"bake", "bsdf", "-o", "x.bsdf"}, 2, "needs a model"},
        {{"bake", "bsdf", "velvet"}, 2, "needs -o OUT.bsdf"},
        {{"bake", "bsdf", "velvet", "-o", "x.exr"}, 2, ".bsdf"},
        {{"bake", "bsdf", "velvet", "-o", "x.bsdf", "--size", "12"}, 2, "--size"},
        {{"bake", "bsdf", "velvet", "-o", "x.bsdf", "--size", "1x64"}, 2, "polar angles"},
        {{"bake", "bsdf", "velvet", "-o", "x.bsdf", "--axes", "gltf"}, 2, "--axes"},
        {{"bake", "bsdf", "fibre-walk", "-o", "x.bsdf"}, 2, "random walks"},
        {{"bake", "fibre-truth", "charlie-neubelt", "-o", "x.npy"}, 2, "fibre"},
        {{"bake", "ltc", "silk", "-o", "x.npy"}, 2, "silk"},
        {{"bake", "ltc", "ggx", "--axes", "zeltner", "-o", "x.npy"}, 2, "--axes"},
        {{"bake", "fibre-table", "ggx", "-o", "x.npy"}, 2, "ggx"},
        {{"bake", "fibre-table", "--size", "1x4", "-o", "x.npy"}, 2, "2 to 64"},
        {{"bake", "albdo", "ggx", "-o", "x.h"}, 2, "did you mean albedo?"},
        {{"bake", "audits", "x.png"}, 2, "did you mean audit?"},
        {{"bake", "albedo", "-o", "x.h"}, 2, "needs a lobe"},
        {{"bake", "albedo", "charly-neubelt", "-o", "x.h"}, 2, "did you mean charlie-neubelt?"},
        {{"bake", "albedo", "ggx"}, 2, "needs -o OUT"},
        {{"bake", "albedo", "ggx", "-o", "x.jpg"}, 2, "x.jpg: is not a table file"},
        {{"bake", "albedo", "ggx", "-o", "x.hdr"}, 2, "x.hdr: is not a table file"},
        {{"bake", "albedo", "ggx", "-o", "png"}, 2, "png: is not a table file"},
        {{"bake", "albedo", "ggx", "-o", "nowhere/x.h"}, 4, "nowhere/x.h"},
        {{"bake", "albedo", "ggx", "-o", "x.h", "--size", "64"}, 2, "is not WIDTHxHEIGHT"},
        {{"bake", "albedo", "ggx", "-o", "x.h", "--size", "0x64"}, 2, "is not WIDTHxHEIGHT"},
        {{"bake", "albedo", "ggx", "-o", "x.h", "--size", "64x64x1"}, 2, "is not WIDTHxHEIGHT"},
        {{"bake", "albedo", "ggx", "-o", "x.h", "--size", "x64"}, 2, "is not WIDTHxHEIGHT"},
        {{"bake", "albedo", "ggx", "-o", "x.h", "--size", "64x +8"}, 2, "is not WIDTHxHEIGHT"},
        {{"bake", "albedo", "ggx", "-o", "x.h", "--size", "99999999999x9"}, 2, "is not WIDTHxHEIGHT"},
        {{"bake", "albedo", "ggx", "-o", "x.h", "--size", "65536x65536"}, 2, "a table has 1 to 16777216 texels"},
        {{"bake", "albedo", "ggx", "-o", "x.h", "--axes", "cos,cos"}, 2, "cos,cos: is not a form"},
        {{"bake", "albedo", "ggx", "-o", "x.h", "--tolerance", "0"}, 2, "--tolerance"},
        {{"bake", "albedo", "ggx", "-o", "x.h", "-p", "alpha=1"}, 2, "alpha"},
        {{"bake", "albedo", "ggx", "-o", "x.h", "-p", "beta=1"}, 2, "beta: is not a parameter"},
        {{"bake", "albedo", "ggx", "-o", "x.h", "-p", "color=1,0,0"}, 2, "white lobe"},
        {{"bake", "albedo", "ggx", "-o", "x.h", "--max", "1"}, 2, "--max: does not go with bake albedo"},
        {{"bake", "dfg", "-o", "x.h", "-p", "alpha=1"}, 2, "-p: is for a lobe"},
        {{"bake", "audit", "--lobe", "ggx"}, 2, "needs a file"},
        {{"bake", "audit", "x.png"}, 2, "needs --lobe"},
        {{"bake", "audit", "x.png", "--lobe", "gx"}, 2, "did you mean ggx?"},
        {{"bake", "audit", "x.png", "--lobe", "ggx", "--size", "4x4"}, 2, "does not go with bake audit"},
        {{"bake", "audit", "x.png", "--lobe", "ggx", "-o", "e.h"}, 2, "as .png, .exr or .npy"},
        {{"bake", "audit", "none.png", "--lobe", "ggx"}, 3, "none.png: cannot be opened"},
        {{"bake", "audit", "not.png", "--lobe", "ggx"}, 3, "not.png: is damaged"},
        {{"bake", "audit", "hello.npy", "--lobe", "ggx"}, 3, "hello.npy: is damaged"},
    };
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++)
        assert_complaint(NULL, cases[k].arguments, cases[k].code, cases[k].part);
    assert_false(is_there("x.h"));
    finish(done(LIST("bake", "albedo", "ggx", "--size=4x4", "-o", "two.npy", "--quiet")));
    assert_complaint(NULL, LIST("bake", "audit", "two.npy", "--lobe", "ggx"), 2, "has 2 channels; say which");
    assert_complaint(NULL, LIST("bake", "audit", "two.npy", "--lobe", "ggx", "--channel", "b"), 2,
                     "two.npy has 2 channels, and no b");
    assert_complaint(NULL, LIST("bake", "audit", "two.npy", "--lobe", "ggx", "--channel", "red"), 2,
                     "is not one of r, g, b, a");
}

/* What fibres reflect and what goes through them is all there is, in either orientation of the axes. */
static void solved_slabs_are_baked(void **state) {
    (void)state;
    finish(done(LIST("bake", "fibre-truth", "--size", "5x3", "--quiet", "-o", "truth.npy")));
    finish(done(LIST("bake", "fibre-truth", "fibre-walk", "-p", "density=1", "--size", "3x5", "--quiet", "--axes",
                     "roughness,cos", "-o", "turned.npy")));
    WeftImage truth = image_of("truth.npy"), turned = image_of("turned.npy");
    assert_shape(&truth, 5, 3, 2, WEFT_PIXEL_F32);
    assert_shape(&turned, 3, 5, 2, WEFT_PIXEL_F32);
    const float *a = truth.pixels, *b = turned.pixels;
    for (int y = 0; y < 3; y++)
        for (int x = 0; x < 5; x++) {
            const float *p = a + 2 * (5 * y + x), *q = b + 2 * (3 * x + y);
            assert_near((double)(p[0] + p[1]), 1.0, 1e-4);
            assert_near((double)p[0], (double)q[0], 1e-6);
        }
    weft_image_free(&truth);
    weft_image_free(&turned);
}

/* Tables of the tree begin with what made them, and a kind that is text takes no options of tables. */
static void kinds_of_fibre_bake_the_tables_of_the_tree(void **state) {
    (void)state;
    const char *text = weft_catalogue_text("tables/fibre_model.h");
    assert_non_null(text);
    assert_true(strncmp(text, "/* weft bake fibre-model ", 25) == 0);
    finish(done(LIST("bake", "ltc", "charlie-neubelt", "--size", "4x3", "--quiet", "-o", "ltc.npy")));
    WeftImage ltc = image_of("ltc.npy");
    assert_shape(&ltc, 4, 3, 4, WEFT_PIXEL_F32);
    for (int k = 0; k < 12; k++) assert_true(((float *)ltc.pixels)[4 * k] > 0.0f);
    weft_image_free(&ltc);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bake_help_names_every_kind),
        cmocka_unit_test(every_file_format_holds_the_same_table),
        cmocka_unit_test(audit_reads_every_format_that_is_baked),
        cmocka_unit_test(closed_form_of_an_albedo_is_within_its_error),
        cmocka_unit_test(c_array_of_the_table_compiles),
        cmocka_unit_test(png_of_values_above_one_is_scaled_not_clipped),
        cmocka_unit_test(exr_is_rounded_to_half_only_with_half),
        cmocka_unit_test(json_describes_the_table),
        cmocka_unit_test(audit_prints_fault_and_error_of_a_table),
        cmocka_unit_test(picture_of_8_bits_is_audited_as_a_table),
        cmocka_unit_test(interrupted_bake_writes_nothing),
        cmocka_unit_test(bsdf_of_a_material_is_near_it),
        cmocka_unit_test(measured_lobe_is_near_and_renders_in_both_engines),
        cmocka_unit_test(bake_options_without_sense_are_refused),
        cmocka_unit_test(solved_slabs_are_baked),
        cmocka_unit_test(kinds_of_fibre_bake_the_tables_of_the_tree),
    };
    return cmocka_run_group_tests(tests, work_begin, work_end);
}
