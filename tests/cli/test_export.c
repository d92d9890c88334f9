/* `weft export`: the text and its tables are there and hold the same numbers, whatever file holds them;
 * nonsense is refused in one line
 *
 * Labels: unsanitized */
#include "run.h"

#include <ctype.h>
#include <math.h>

#include <jansson.h>

#include "weft/export.h"

static Ran done(const char *const *arguments) {
    Ran ran = run_with(NULL, arguments);
    if (ran.code != 0) fail_msg("%d: %s", ran.code, ran.err);
    return ran;
}

static void finish(Ran ran) { ran_free(&ran); }

static void export_help_names_every_target(void **state) {
    (void)state;
    Ran ran = done(LIST("export", "--help"));
    for (int k = 0; weft_export_target_name(k); k++) assert_non_null(strstr(ran.out, weft_export_target_name(k)));
    for (int k = 0; weft_export_lut_name(k); k++) assert_non_null(strstr(ran.out, weft_export_lut_name(k)));
    for (const char *line = ran.out; *line; line += strcspn(line, "\n") + 1)
        if (strcspn(line, "\n") > 80) fail_msg("over 80 columns: %.100s", line);
    ran_free(&ran);
}

static void assert_has(const char *path, const char *part) {
    size_t size;
    char *text = file_bytes(path, &size);
    if (!text || !strstr(text, part)) fail_msg("%s: no \"%s\"", path, part);
    free(text);
}

static void export_finds_every_model(void **state) {
    (void)state;
    static const char *const models[][2] = {{"charlie-neubelt", "weftx_charlie_neubelt_eval"},
                                            {"khronos", "weftx_khronos_shade"},
                                            {"metallic", "weftx_metallic_shade"},
                                            {"velvet", "weftx_velvet_shade"},
                                            {"preset:silk", "weftx_silk_shade"},
                                            {"scene.gltf", "weftx_cloth_shade"},
                                            {"scene.gltf:cloth", "weftx_cloth_shade"},
                                            {"scene.gltf:0", "weftx_cloth_shade"},
                                            {"own.json", "weftx_own_shade"}};
    static const char own[] = "{\"base_color\": [0.5, 0.25, 0.125], \"sheen_color\": [1, 0.5, 0.25]}";
    file_make("own.json", own, sizeof own - 1);
    for (size_t k = 0; k < sizeof models / sizeof models[0]; k++) {
        finish(done(LIST("export", models[k][0], "--target", "c", "-o", "out.h")));
        assert_has("out.h", models[k][1]);
        assert_has("out.h", "SPDX-License-Identifier: MIT");
        assert_has("out.h", "Conventions");
    }
    assert_has("out.h", "0.5f, 0.25f, 0.125f");
}

/* A preset, a file, words, a material file and a material of a scene, each with its threads and without a warning. */
static void woven_material_is_exported_with_its_threads(void **state) {
    (void)state;
    static const char own[] = "{\"weave\": {\"draft\": \"twill 2/2 z\", \"rotation\": 45}}";
    static const char *const models[][2] = {{"preset:woven-denim", "woven_denim"},
                                            {"herring.wif", "herring"},
                                            {"twill 3/1 s; warp 4b", "twill"},
                                            {"threads.json", "threads"},
                                            {"woven.glb:ball", "ball"}};
    file_make("threads.json", own, sizeof own - 1);
    finish(done(LIST("weave", "herringbone 2/2 8", "-o", "herring.wif")));
    finish(done(LIST("render", "builtin:ball", "--material", "threads.json", "--save", "woven.glb")));
    for (size_t k = 0; k < sizeof models / sizeof *models; k++) {
        char wanted[64];
        Ran ran = done(LIST("export", models[k][0], "--target", "c", "-o", "out.h"));
        if (strstr(ran.err, "warning")) fail_msg("%s: %s", models[k][0], ran.err);
        ran_free(&ran);
        snprintf(wanted, sizeof wanted, "WeftxWeaveSeen weftx_%s_see(", models[k][1]);
        assert_has("out.h", wanted);
        snprintf(wanted, sizeof wanted, "weftx_%s_shade(", models[k][1]);
        assert_has("out.h", wanted);
        if (k > 2) assert_has("out.h", "m.rotation_cos = 0.70710677f;");
    }
    Ran ran = done(LIST("export", "preset:woven-denim", "--target", "glsl", "-o", "denim.glsl"));
    assert_non_null(strstr(ran.err, "denim.weft_texels_colors.exr: 16 x 28 texels"));
    assert_non_null(strstr(ran.err, "woven-denim: the back of the cloth, hair and normal maps are left out"));
    ran_free(&ran);
    ran = run_with(NULL, LIST("export", "preset:woven-tartan", "--target", "shadertoy", "-o", "toy"));
    assert_int_equal(ran.code, WEFT_USAGE);
    assert_non_null(strstr(ran.err, "woven-tartan: is invalid: tables of "));
    assert_non_null(strstr(ran.err, "take another target, or a smaller draft"));
    ran_free(&ran);
}

static void export_options_change_the_text(void **state) {
    (void)state;
    finish(done(LIST("export", "charlie-neubelt:alpha=0.5", "--target", "glsl", "--prefix", "fuzz_", "-o", "a.glsl")));
    assert_has("a.glsl", "m.alpha = 0.5;");
    assert_has("a.glsl", "vec3 fuzz_charlie_neubelt_eval(FuzzCharlieNeubelt m");
    assert_has("a.glsl", "EXPLICIT");
    finish(done(LIST("export", "charlie-neubelt", "--target", "hlsl", "--light-pi", "folded", "-o", "a.hlsl")));
    assert_has("a.hlsl", "FOLDED");
    assert_has("a.hlsl", "Unreal");
    assert_has("a.hlsl", "Unity");
    finish(done(LIST("export", "ashikhmin-neubelt", "charlie-neubelt", "--target", "shadertoy", "-o", "toy")));
    assert_has("toy", "void mainImage");
    Ran ran = done(LIST("export", "ltc-fibre", "--target", "glsl", "--lut", "npy", "--json", "-o", "f.glsl"));
    json_t *json = json_loads(ran.out, 0, NULL);
    assert_non_null(json);
    assert_int_equal(json_array_size(json_object_get(json, "tables")), 1);
    assert_string_equal(json_string_value(json_array_get(json_object_get(json, "tables"), 0)),
                        "f.weft_texels_ltc_fibre.npy");
    json_decref(json);
    ran_free(&ran);
}

static void several_models_make_one_file(void **state) {
    (void)state;
    finish(done(LIST("export", "khronos", "velvet", "ggx", "--target", "hlsl", "-o", "all.hlsl")));
    assert_has("all.hlsl", "weft_khronos_shade(");
    assert_has("all.hlsl", "weft_velvet_shade(");
    assert_has("all.hlsl", "weft_ggx_eval(");
    assert_has("all.hlsl", "WeftVelvetSurface");
    Ran ran = run_with(NULL, LIST("export", "ggx", "ggx:alpha=0.3", "--target", "c", "-o", "twice.h"));
    assert_int_equal(ran.code, 2);
    assert_non_null(strstr(ran.err, "ggx"));
    ran_free(&ran);
}

static WeftImage image_of(const char *path) {
    WeftImage image;
    WeftError error = {0};
    if (weft_image_read(path, &image, NULL, &error) != WEFT_OK) fail_msg("%s", error.text);
    return image;
}

/* Every file holds the library's numbers: to the last bit as floats, to half a step as 16 bits. */
static void exported_table_files_read_back_as_written(void **state) {
    (void)state;
    enum { HEADER = 148 };
    WeftLobe lobe;
    WeftExport made;
    assert_int_equal(weft_lobe_init("ltc-fibre", &lobe, NULL), WEFT_OK);
    assert_int_equal(weft_export(&(WeftExportDesc){.lobe = &lobe, .lut = WEFT_EXPORT_LUT_EXR}, &made, NULL), WEFT_OK);
    assert_int_equal(made.table_count, 1);
    const WeftImage *own = &made.tables[0].texels;
    const float *texels = own->pixels;
    size_t count = (size_t)own->width * (size_t)own->height, size;
    for (int k = 0; weft_export_lut_name(k); k++)
        finish(done(LIST("export", "ltc-fibre", "--target", "glsl", "--lut", weft_export_lut_name(k), "--quiet", "-o",
                         "t.glsl")));
    static const char *const floats[] = {"t.weft_texels_ltc_fibre.exr", "t.weft_texels_ltc_fibre.npy"};
    for (int f = 0; f < 2; f++) {
        WeftImage image = image_of(floats[f]);
        assert_int_equal(image.width, own->width);
        assert_int_equal(image.height, own->height);
        assert_int_equal(image.channels, 1);
        for (size_t k = 0; k < count; k++)
            if (fabsf(((float *)image.pixels)[k] - texels[k]) > 0.0f) fail_msg("%s: texel %zu", floats[f], k);
        weft_image_free(&image);
    }
    char *dds = file_bytes("t.weft_texels_ltc_fibre.dds", &size);
    assert_int_equal(size, HEADER + 4 * count);
    assert_memory_equal(dds, "DDS ", 4);
    assert_memory_equal(dds + 84, "DX10", 4);
    uint32_t height, width, format;
    memcpy(&height, dds + 12, 4);
    memcpy(&width, dds + 16, 4);
    memcpy(&format, dds + 128, 4);
    assert_int_equal(height, own->height);
    assert_int_equal(width, own->width);
    assert_int_equal(format, 41); /* R32_FLOAT */
    for (size_t k = 0; k < count; k++) {
        float texel;
        memcpy(&texel, dds + HEADER + 4 * k, 4);
        if (fabsf(texel - texels[k]) > 0.0f) fail_msg("dds: texel %zu", k);
    }
    free(dds);
    char *array = file_bytes("t.weft_texels_ltc_fibre.h", &size);
    assert_non_null(array);
    char *at = strstr(array, "] = {");
    assert_non_null(at);
    at += 5;
    for (size_t k = 0; k < count; k++) {
        at += strspn(at, "\n ,f");
        if (fabsf(strtof(at, &at) - texels[k]) > 0.0f) fail_msg("array: texel %zu", k);
    }
    free(array);
    weft_export_free(&made);
}

/* 16 bits: pixels times the factor in the text. */
static void png_table_above_one_is_scaled(void **state) {
    (void)state;
    WeftLobe lobe;
    WeftExport plain, scaled;
    assert_int_equal(weft_lobe_init("charlie-neubelt", &lobe, NULL), WEFT_OK);
    WeftExportDesc desc = {.lobe = &lobe, .albedo = 1, .lut = WEFT_EXPORT_LUT_EXR};
    assert_int_equal(weft_export(&desc, &plain, NULL), WEFT_OK);
    desc.lut = WEFT_EXPORT_LUT_PNG16;
    assert_int_equal(weft_export(&desc, &scaled, NULL), WEFT_OK);
    finish(done(LIST("export", "charlie-neubelt", "--albedo", "--target", "glsl", "--lut", "png16", "--quiet", "-o",
                     "p.glsl")));
    float scale = scaled.tables[0].scale;
    char factor[32];
    snprintf(factor, sizeof factor, ".r * %.1f;", (double)scale);
    assert_true(scale > 1.0f);
    assert_has("p.glsl", factor);
    WeftImage image = image_of("p.weft_texels_charlie_neubelt_albedo.png");
    assert_int_equal(image.type, WEFT_PIXEL_U16);
    for (int k = 0; k < image.width * image.height; k++) {
        float got = (float)((uint16_t *)image.pixels)[k] / 65535.0f * scale;
        float own = ((float *)plain.tables[0].texels.pixels)[k];
        if (fabsf(got - own) > scale * 0.51f / 65535.0f) fail_msg("texel %d: %g, not %g", k, (double)got, (double)own);
    }
    weft_image_free(&image);
    weft_export_free(&plain);
    weft_export_free(&scaled);
}

/* The lines of NAME_surface() in the text of a model. */
static void surface_of(const char *model, char lines[8192]) {
    Ran ran = RUN("export", model, "--target", "glsl", "-o", "s.glsl", "--quiet");
    if (ran.code != 0) fail_msg("%s: %s", model, ran.err);
    ran_free(&ran);
    size_t size;
    char *text = file_bytes("s.glsl", &size), *start = text ? strstr(text, "_surface() {") : NULL;
    assert_non_null(start);
    snprintf(lines, 8192, "%.*s", (int)(strstr(start, "\n}") - start), start);
    free(text);
}

/* Every line of `plain` but the one that begins with `changed` stands in `with` as it is. */
static void assert_defaults_stay(const char *plain, const char *with, const char *changed) {
    char line[512];
    for (const char *c = plain; *c; c += strcspn(c, "\n"), c += *c == '\n') {
        snprintf(line, sizeof line, "%.*s", (int)strcspn(c, "\n"), c);
        if (strncmp(line + strspn(line, " "), changed, strlen(changed)) == 0) continue;
        if (!strstr(with, line)) fail_msg("differs: %s", line);
    }
}

/* A setting behind a workflow or a profile changes no other default. A rule may read inputs that the model
 * alone does not, so that more lines are there. */
static void set_parameter_leaves_other_defaults(void **state) {
    (void)state;
    static char plain[8192], with[8192];
    static const char none[] = "no line";
    surface_of("metallic", plain);
    surface_of("metallic:layer=additive", with);
    assert_defaults_stay(plain, with, none);
    surface_of("khronos", plain);
    surface_of("khronos:layer=seed", with);
    assert_defaults_stay(plain, with, none);
    surface_of("disney", plain);
    surface_of("disney:subsurface=0.5", with);
    assert_defaults_stay(plain, with, "s.subsurface");
    assert_non_null(strstr(plain, "s.subsurface = 0.0"));
    assert_non_null(strstr(with, "s.subsurface = 0.5"));
}

/* Two lobes beside each other, with and without second colours and tints, are one text that names no record
 * twice. */
static void two_lobes_share_one_record_of_values(void **state) {
    (void)state;
    static const char *const pairs[][2] = {{"ashikhmin-neubelt", "charlie-neubelt"},
                                           {"charlie-neubelt", "ggx"},
                                           {"fibre", "charlie-neubelt"},
                                           {"charlie-neubelt", "fibre"}};
    for (size_t k = 0; k < sizeof pairs / sizeof *pairs; k++) {
        Ran ran = RUN("export", pairs[k][0], pairs[k][1], "--target", "shadertoy", "-o", "s.glsl", "--quiet");
        if (ran.code != 0) fail_msg("%s: %s", pairs[k][0], ran.err);
        ran_free(&ran);
        size_t size;
        char *text = file_bytes("s.glsl", &size), *first = text ? strstr(text, "struct WeftLobeValue {") : NULL;
        assert_non_null(first);
        assert_null(strstr(first + 1, "struct WeftLobeValue {"));
        free(text);
    }
}

/* Fails if a shell line does, unless its compiler is not here. */
static void compiles(const char *compiler, const char *line) {
    char command[700];
    snprintf(command, sizeof command, "command -v %s >/dev/null 2>&1 || exit 77; %s", compiler, line);
    Ran ran = run_shell(command);
    if (ran.code != 0 && ran.code != 77) fail_msg("%s: %s%s", line, ran.out, ran.err);
    ran_free(&ran);
}

/* A program that uses the library may include what it exported. */
static void c_text_stands_beside_the_header_of_the_library(void **state) {
    (void)state;
    static const char *const models[] = {"khronos", "metallic", "velvet",      "ltc-fibre",
                                         "fibre",   "openpbr",  "preset:denim"};
    static const char program[] = "#include <weft/weft.h>\n#include \"beside.h\"\nint main(void) { return 0; }\n";
    file_make("beside.c", program, sizeof program - 1);
    for (size_t k = 0; k < sizeof models / sizeof *models; k++) {
        finish(done(LIST("export", models[k], "--target", "c", "--quiet", "-o", "beside.h")));
        compiles("gcc", "gcc -std=c11 -Wall -Werror -fsyntax-only -I" WEFT_SOURCE_DIR "/include beside.c");
        compiles("g++", "g++ -std=c++17 -Wall -Werror -fsyntax-only -I" WEFT_SOURCE_DIR "/include -x c++ beside.c");
    }
}

static void assert_no_name_begins_with_a_digit(const char *path) {
    size_t size;
    char *text = file_bytes(path, &size);
    assert_non_null(text);
    for (const char *c = strstr(text, "*/"); *c; c++) /* behind the comment; a number may end in f, x or e3 */
        if (*c >= '0' && *c <= '9' && !isalnum((unsigned char)c[-1]) && c[-1] != '_' && c[-1] != '.') {
            const char *end = c;
            while (isdigit((unsigned char)*end) || *end == '.') end++;
            if (*end == '_' || (isalpha((unsigned char)*end) && !strchr("efux", *end))) fail_msg("%s: %.40s", path, c);
        }
    free(text);
}

/* Whatever a material is called, in each language. */
static void material_of_any_name_gives_text_that_compiles(void **state) {
    (void)state;
    static const char *const names[] = {"#1 Cloth",
                                        "(2)",
                                        "_1",
                                        "\xc3\xa9"
                                        "1",
                                        "3",
                                        "float",
                                        "in",
                                        "texture",
                                        "main",
                                        "-",
                                        "a__b",
                                        "gl_1",
                                        "A name of more than sixty-three letters, for which a record "
                                        "in the exporter has no room at all, since it is cut"};
    static const char *const shaders[][3] = {{"glsl", "frag", "#version 330 core"},
                                             {"essl", "frag", "#version 300 es\nprecision highp float;"},
                                             {"shadertoy", "frag",
                                              "#version 330 core\nuniform vec3 iResolution; uniform float iTime; "
                                              "uniform vec4 iMouse;"},
                                             {"hlsl", "hlsl", ""}};
    size_t size;
    char *scene = file_bytes("scene.gltf", &size), *at = strstr(scene, "\"name\":\"cloth\""), *own = malloc(size + 256);
    assert_true(at && own);
    for (size_t k = 0; k < sizeof names / sizeof *names; k++) {
        char line[600];
        snprintf(own, size + 256, "%.*s\"name\":\"%s\"%s", (int)(at - scene), scene, names[k],
                 at + strlen("\"name\":\"cloth\""));
        file_make("named.gltf", own, strlen(own));
        for (int t = 0; weft_export_target_name(t); t++) {
            finish(done(
                LIST("export", "named.gltf:0", "--target", weft_export_target_name(t), "--quiet", "-o", "named.h")));
            assert_no_name_begins_with_a_digit("named.h");
        }
        for (size_t s = 0; s < sizeof shaders / sizeof *shaders; s++) {
            finish(done(LIST("export", "named.gltf:0", "--target", shaders[s][0], "--quiet", "-o", "named.txt")));
            snprintf(line, sizeof line,
                     "{ printf '%%b\\n' '%s'; cat named.txt; echo 'void %s() {}'; } >named.%s && "
                     "glslangValidator %s named.%s",
                     shaders[s][2], strcmp(shaders[s][0], "shadertoy") == 0 ? "unused_" : "begin_", shaders[s][1],
                     strcmp(shaders[s][1], "hlsl") == 0 ? "-D -e begin_ -S frag -V -o /dev/null" : "", shaders[s][1]);
            compiles("glslangValidator", line);
        }
        finish(done(LIST("export", "named.gltf:0", "--target", "c", "--quiet", "-o", "named.h")));
        compiles("gcc", "gcc -std=c99 -Wall -Werror -fsyntax-only -x c named.h");
    }
    free(scene);
    free(own);
}

/* A table that the language cannot hold is a picture that engines load, unless another form is asked for. */
static void tables_outside_the_text_are_exr_by_default(void **state) {
    (void)state;
    static const char *const targets[] = {"glsl", "essl", "hlsl"};
    for (int k = 0; k < 3; k++) {
        finish(done(LIST("export", "ltc-fibre", "--target", targets[k], "--quiet", "-o", "alone.txt")));
        assert_int_equal(access("alone.weft_texels_ltc_fibre.exr", R_OK), 0);
        assert_true(access("alone.weft_texels_ltc_fibre.h", R_OK) != 0);
        finish(done(LIST("export", "ltc-fibre", "--target", targets[k], "--lut", "npy", "--quiet", "-o", "alone.txt")));
        finish(
            done(LIST("diff", "alone.weft_texels_ltc_fibre.exr", "alone.weft_texels_ltc_fibre.npy", "--max", "1e-9")));
        unlink("alone.weft_texels_ltc_fibre.exr");
        unlink("alone.weft_texels_ltc_fibre.npy");
    }
    finish(done(LIST("export", "ltc-fibre", "--target", "c", "--quiet", "-o", "alone.txt")));
    assert_has("alone.txt", "static const float weftx_texels_ltc_fibre[");
    assert_true(access("alone.weftx_texels_ltc_fibre.exr", R_OK) != 0);
    finish(done(LIST("export", "ltc-fibre", "--target", "glsl", "--lut", "c", "--quiet", "-o", "alone.txt")));
    assert_int_equal(access("alone.weft_texels_ltc_fibre.h", R_OK), 0);
}

static void export_options_without_sense_are_refused(void **state) {
    (void)state;
    const struct {
        const char *const *arguments;
        int code;
        const char *part;
    } cases[] = {
        {LIST("export"), 2, "operand"},
        {LIST("export", "ggx", "-o", "x"), 2, "needs --target"},
        {LIST("export", "ggx", "--target", "glsl"), 2, "needs -o"},
        {LIST("export", "ggx", "--target", "metal", "-o", "x"), 2, "--target"},
        {LIST("export", "ggx", "--target", "c", "--lut", "tiff", "-o", "x"), 2, "--lut"},
        {LIST("export", "ggx", "--target", "c", "--light-pi", "no", "-o", "x"), 2, "--light-pi"},
        {LIST("export", "charlie-neubet", "--target", "c", "-o", "x"), 2, "did you mean charlie-neubelt?"},
        {LIST("export", "preset:velvt", "--target", "c", "-o", "x"), 2, "is not a preset"},
        {LIST("export", "fibre-walk", "--target", "c", "-o", "x"), 2, "is a random walk"},
        {LIST("export", "fibre-walk", "--target", "glsl", "-o", "x"), 2, "is a random walk"},
        {LIST("export", "ggx:beta=1", "--target", "c", "-o", "x"), 2, "is not a parameter"},
        {LIST("export", "khronos:alpha=1", "--target", "c", "-o", "x"), 2, "is not a parameter"},
        {LIST("export", "khronos", "--albedo", "--target", "c", "-o", "x"), 2, "--albedo"},
        {LIST("export", "khronos", "--ambient", "--target", "c", "-o", "x"), 2, "--ambient: is for a lobe"},
        {LIST("export", "ggx", "--ambient", "--target", "c", "-o", "x"), 2, "ggx: "},
        {LIST("export", "ggx", "silk", "lambert", "--target", "shadertoy", "-o", "x"), 2, "two lobes"},
        {LIST("export", "khronos", "silk", "--target", "shadertoy", "-o", "x"), 2, "two lobes"},
        {LIST("export", "ggx", "--prefix", "9a", "--target", "c", "-o", "x"), 2, "prefix"},
        {LIST("export", "ggx", "--prefix", "gl_", "--target", "c", "-o", "x"), 2, "prefix"},
        {LIST("export", "ggx", "--prefix", "a__", "--target", "c", "-o", "x"), 2, "prefix"},
        {LIST("export", "scene.gltf:0", "--target", "c", "-o", "scene.gltf"), 2, "would be lost"},
        {LIST("export", "ggx", "--prefix", "a b", "--target", "c", "-o", "x"), 2, "prefix"},
        {LIST("export", "missing.json", "--target", "c", "-o", "x"), 3, "missing.json"},
        {LIST("export", "missing.gltf", "--target", "c", "-o", "x"), 3, "missing.gltf"},
        {LIST("export", "scene.gltf:wool", "--target", "c", "-o", "x"), 2, "is not a material"},
        {LIST("export", "scene.gltf:7", "--target", "c", "-o", "x"), 2, "is not a material"},
        {LIST("export", "ggx", "--target", "c", "-o", "no/such/folder/x"), 4, "no/such/folder/x"},
    };
    for (size_t k = 0; k < sizeof cases / sizeof cases[0]; k++)
        assert_complaint(NULL, cases[k].arguments, cases[k].code, cases[k].part);
    assert_int_not_equal(access("x", F_OK), 0);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(export_help_names_every_target),
        cmocka_unit_test(export_finds_every_model),
        cmocka_unit_test(woven_material_is_exported_with_its_threads),
        cmocka_unit_test(export_options_change_the_text),
        cmocka_unit_test(several_models_make_one_file),
        cmocka_unit_test(exported_table_files_read_back_as_written),
        cmocka_unit_test(png_table_above_one_is_scaled),
        cmocka_unit_test(c_text_stands_beside_the_header_of_the_library),
        cmocka_unit_test(material_of_any_name_gives_text_that_compiles),
        cmocka_unit_test(tables_outside_the_text_are_exr_by_default),
        cmocka_unit_test(export_options_without_sense_are_refused),
        cmocka_unit_test(set_parameter_leaves_other_defaults),
        cmocka_unit_test(two_lobes_share_one_record_of_values),
    };
    return cmocka_run_group_tests(tests, scene_begin, work_end);
}
