/* wgsl_questions - writes what a browser asks every WGSL text, and the library's answers: texts, tables and
 * numbers as a script, on standard output
 *
 *   const models = [{name, code, tables: [{width, height, texels}], questions, answers}], ...];
 *
 * questions: six numbers of four parts for each of COUNT pairs; answers: two. Every lobe, workflow, profile
 * and preset, and then texts of several. */
#include "export/models.h"

enum { COUNT = 512, BODY = 1 << 14 };

static Exported models[MODELS_MAX];

/* As a string of JavaScript. */
static void put_string(const char *text) {
    putchar('"');
    for (const char *c = text; *c; c++) {
        if (*c == '\n')
            fputs("\\n", stdout);
        else if (*c == '"' || *c == '\\')
            printf("\\%c", *c);
        else
            putchar(*c);
    }
    putchar('"');
}

static void put_floats(const char *name, const float *values, size_t count) {
    printf("%s: [", name);
    for (size_t k = 0; k < count; k++) printf("%.9g,", (double)values[k]);
    printf("],\n");
}

static void put_rows(const char *name, float *const *rows, int row_count) {
    printf("%s: [\n", name);
    for (int row = 0; row < row_count; row++) {
        printf("[");
        for (size_t k = 0; k < (size_t)4 * COUNT; k++) printf("%.9g,", (double)rows[row][k]);
        printf("],\n");
    }
    printf("],\n");
}

static void put_tables(const WeftExport *text) {
    printf("tables: [\n");
    for (int k = 0; k < text->table_count; k++) {
        const WeftImage *image = &text->tables[k].texels;
        printf("{width: %d, height: %d, ", image->width, image->height);
        put_floats("texels", image->pixels, (size_t)image->width * (size_t)image->height);
        printf("},\n");
    }
    printf("],\n");
}

/* The text, and around its calls what reads questions and writes answers. */
static void put_code(const Exported *s, const WeftExport *text) {
    static char body[BODY], tail[BODY + 1024];
    model_body(s, text, "weft_", &language_wgsl, body, BODY);
    snprintf(tail, sizeof tail,
             "\n@group(1) @binding(0) var<storage, read> questions: array<vec4f>;\n"
             "@group(1) @binding(1) var<storage, read_write> answers: array<vec4f>;\n"
             "@compute @workgroup_size(64) fn answer(@builtin(global_invocation_id) id: vec3u) {\n"
             "    let in0 = questions[id.x];\n    let in1 = questions[%du + id.x];\n"
             "    let in2 = questions[%du + id.x];\n    let in3 = questions[%du + id.x];\n"
             "    let in4 = questions[%du + id.x];\n    let in5 = questions[%du + id.x];\n"
             "    var out0 = vec4f(0.0);\n    var out1 = out0;\n%s"
             "    answers[id.x] = out0;\n    answers[%du + id.x] = out1;\n}\n",
             COUNT, 2 * COUNT, 3 * COUNT, 4 * COUNT, 5 * COUNT, body, COUNT);
    printf("code: ");
    put_string(text->text);
    printf(" +\n");
    put_string(tail);
    printf(",\n");
}

static void put_model(const Exported *s, Arrays *a) {
    WeftExportDesc desc = model_desc(s, WEFT_EXPORT_WGSL);
    WeftExport text = model_export(&desc);
    printf("{name: \"%s\", lobe: %s,\n", s->id, s->is_lobe ? "true" : "false");
    put_code(s, &text);
    put_tables(&text);
    put_rows("questions", a->in, INPUTS);
    put_rows("answers", a->expected, OUTPUTS);
    printf("},\n");
    weft_export_free(&text);
}

/* Three neighbours in one text, tables inside it where they are small: it is compiled and nothing more. */
static void put_several(int first, int count) {
    WeftExportDesc descs[3];
    WeftExport made;
    WeftError error;
    for (int k = 0; k < count; k++) {
        descs[k] = model_desc(&models[first + k], WEFT_EXPORT_WGSL);
        descs[k].lut = WEFT_EXPORT_LUT_C;
    }
    if (weft_export_all(descs, count, &made, &error) != WEFT_OK) fail_msg("%s", error.text);
    printf("{name: \"%s and %d more\", code: ", models[first].id, count - 1);
    put_string(made.text);
    printf("},\n");
    weft_export_free(&made);
}

int main(void) {
    int count = models_lobes(models), catalogue;
    count += models_profiles(models + count);
    catalogue = count;
    count += models_choices(models + count);
    count += models_presets(models + count);
    count += models_woven(models + count);
    Arrays arrays = arrays_make();
    printf("const models = [\n");
    for (int k = 0; k < count; k++) {
        arrays_fill(&models[k], &arrays);
        put_model(&models[k], &arrays);
    }
    for (int k = 0; k < catalogue; k += 3) put_several(k, catalogue - k < 3 ? catalogue - k : 3);
    printf("];\n");
    arrays_free(&arrays);
    return ferror(stdout) ? 4 : 0;
}
