/* The texts for C compile with gcc and clang, as C99, C11 and C++, without a warning, all in one file under
 * prefixes of their own; and answer as the library does.
 *
 * Labels: unsanitized */
#include "export/models.h"
#include "scratch.h"

#include <dlfcn.h>

enum { BODY = 1 << 14 };

static Exported models[MODELS_MAX];
static int model_count;
static char folder[SCRATCH_SIZE];
static Arrays arrays[MODELS_MAX];

static bool has_program(const char *name) {
    char command[128];
    snprintf(command, sizeof command, "command -v %s >/dev/null 2>&1", name);
    return system(command) == 0;
}

static FILE *file_open(const char *name) {
    char path[256];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    FILE *stream = fopen(path, "wb");
    assert_non_null(stream);
    return stream;
}

/* The text, and a function run_K that puts the questions to it. */
static void put_model(FILE *all, int k) {
    char prefix[16], name[32], type[16], dir[32], rgb[32], *body = malloc(BODY);
    const Exported *s = &models[k];
    snprintf(prefix, sizeof prefix, "w%d_", k);
    snprintf(type, sizeof type, "W%d", k);
    snprintf(dir, sizeof dir, "%sDir", type);
    snprintf(rgb, sizeof rgb, "%sRgb", type);
    snprintf(name, sizeof name, "%d.h", k);
    WeftExportDesc desc = model_desc(s, WEFT_EXPORT_C);
    desc.prefix = prefix;
    WeftExport made = model_export(&desc);
    assert_int_equal(made.table_count, 0);
    FILE *header = file_open(name);
    fputs(made.text, header);
    assert_int_equal(fclose(header), 0);
    assert_non_null(body);
    model_body(s, &made, prefix, &(Language){dir, rgb, "(int)", "(float)", "(void) {", true}, body, BODY);
    fprintf(all, "#include \"%s\"\nvoid run_%d(int n, const float4 *const in[6], float4 *const out[2]);\n", name, k);
    fprintf(all, "void run_%d(int n, const float4 *const in[6], float4 *const out[2]) {\n", k);
    fprintf(all, "  for (int k = 0; k < n; k++) {\n    float4 out0 = {0.0f, 0.0f, 0.0f, 0.0f}, out1 = out0;\n");
    for (int j = 0; j < INPUTS; j++) fprintf(all, "    float4 in%d = in[%d][k];\n", j, j);
    for (int j = 0; j < INPUTS; j++) fprintf(all, "    (void)in%d;\n", j);
    fprintf(all, "%s    out[0][k] = out0;\n    out[1][k] = out1;\n  }\n}\n", body);
    weft_export_free(&made);
    free(body);
}

static void compile(const char *compiler, const char *more) {
    char command[512];
    if (!has_program(compiler)) {
        print_message("%s is not here\n", compiler);
        return;
    }
    snprintf(command, sizeof command, "cd %s && %s -Wall -Wextra -Werror %s", folder, compiler, more);
    if (system(command) != 0) fail_msg("%s %s", compiler, more);
}

static void *library_open(const char *compiler) {
    char path[256];
    snprintf(path, sizeof path, "%s/%s.so", folder, compiler);
    void *library = dlopen(path, RTLD_NOW);
    if (!library) fail_msg("%s", dlerror());
    return library;
}

/* Puts the questions of a model's arrays to its text. */
static void library_run(void *library, int k, const Arrays *a) {
    union {
        void *symbol;
        void (*run)(int n, float *const in[6], float *const out[2]);
    } at;
    char name[32];
    snprintf(name, sizeof name, "run_%d", k);
    at.symbol = dlsym(library, name);
    assert_non_null(at.symbol);
    at.run(PAIRS, a->in, a->out);
}

static void agree(const char *compiler) {
    if (!has_program(compiler)) skip();
    void *library = library_open(compiler);
    for (int k = 0; k < model_count; k++) {
        library_run(library, k, &arrays[k]);
        assert_agree(&models[k], compiler, &arrays[k]);
    }
    dlclose(library);
}

static void c_text_compiled_by_gcc_agrees_with_the_library(void **state) {
    (void)state;
    compile("gcc", "-std=c99 -O1 -shared -fPIC all.c -o gcc.so -lm");
    agree("gcc");
}

static void c_text_compiled_by_clang_agrees_with_the_library(void **state) {
    (void)state;
    compile("clang", "-std=c11 -O0 -shared -fPIC all.c -o clang.so -lm");
    agree("clang");
}

/* Returns the mean of what a cloth's text reflects over all points of the arrays, each seen at that size of a pixel. */
static double mean_seen(void *library, int k, Arrays *a, Dir o, Dir i, float size) {
    double sum = 0.0;
    for (size_t n = 0; n < PAIRS; n++) {
        const float rows[2][3] = {{o.x, o.y, o.z}, {i.x, i.y, i.z}};
        const float steps[4] = {size, 0.0f, 0.0f, size};
        for (int row = 0; row < 2; row++) memcpy(a->in[row] + 4 * n, rows[row], sizeof rows[row]);
        a->in[2][4 * n + 2] = 1.0f;
        memcpy(a->in[3] + 4 * n, steps, sizeof steps);
    }
    library_run(library, k, a);
    for (size_t n = 0; n < PAIRS; n++)
        for (size_t c = 0; c < 3; c++) sum += (double)a->out[0][4 * n + c] / (3.0 * PAIRS);
    return sum;
}

/* The lobes from afar are fits: over six pairs of directions they are 0.15 off in the mean at most. */
static void points_of_a_cloth_have_the_mean_of_the_cloth_from_afar(void **state) {
    (void)state;
    static const double pairs[][4] = {{0.9, 0.3, 0.8, 2.1},   {0.5, 1.0, 0.7, 4.0},  {0.8, 0.0, 0.8, 3.14},
                                      {0.4, 1.57, 0.9, 4.71}, {0.95, 2.0, 0.4, 0.5}, {0.6, 5.0, 0.6, 3.5}};
    enum { DIRECTIONS = sizeof pairs / sizeof *pairs };
    if (!has_program("gcc")) skip();
    void *library = library_open("gcc");
    int cloths = 0;
    for (int k = 0; k < model_count; k++) {
        double error = 0.0, whole = 0.0;
        cloths += models[k].cloth != NULL;
        for (int p = 0; models[k].cloth && p < DIRECTIONS; p++) {
            const Dir o = grid_direction(pairs[p][0], pairs[p][1]), i = grid_direction(pairs[p][2], pairs[p][3]);
            const float threads = 1.0f / models[k].cloth->per_uv[WEFT_WARP];
            const double near = mean_seen(library, k, &arrays[k], o, i, 0.0f);
            const double far = mean_seen(library, k, &arrays[k], o, i, 300.0f * threads);
            error += fabs(near - far);
            whole += near;
        }
        if (getenv("WEFT_TEST_TELL") && models[k].cloth)
            print_message("%s: from afar %.3f of the points off\n", models[k].id, error / whole);
        assert_true(whole > 0.0 || !models[k].cloth);
        if (error > 0.15 * whole) fail_msg("%s: %.3f off", models[k].id, error / whole);
    }
    assert_true(cloths >= 3);
    dlclose(library);
}

/* In a C++ compiler's eyes too; every header guards itself. */
static void c_text_is_valid_cpp(void **state) {
    (void)state;
    compile("g++", "-std=c++11 -fsyntax-only -x c++ all.c");
}

static int begin(void **state) {
    (void)state;
    if (!scratch_make(folder)) return -1;
    model_count = models_lobes(models);
    model_count += models_profiles(models + model_count);
    model_count += models_choices(models + model_count);
    model_count += models_woven(models + model_count);
    if (getenv("WEFT_TEST_LONG")) model_count += models_presets(models + model_count);
    FILE *all = file_open("all.c");
    fprintf(all, "typedef struct { float x, y, z, w; } float4;\n");
    for (int k = 0; k < model_count; k++) {
        put_model(all, k);
        arrays[k] = arrays_make();
        arrays_fill(&models[k], &arrays[k]);
    }
    return fclose(all);
}

static int end(void **state) {
    (void)state;
    for (int k = 0; k < model_count; k++) arrays_free(&arrays[k]);
    return scratch_remove(folder) ? 0 : -1;
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(c_text_compiled_by_gcc_agrees_with_the_library),
                                       cmocka_unit_test(c_text_compiled_by_clang_agrees_with_the_library),
                                       cmocka_unit_test(points_of_a_cloth_have_the_mean_of_the_cloth_from_afar),
                                       cmocka_unit_test(c_text_is_valid_cpp)};
    return cmocka_run_group_tests(tests, begin, end);
}
