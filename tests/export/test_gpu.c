/* The texts for GPUs compile (glslangValidator, and the driver) and answer as the library does: GLSL and ESSL
 * as they are, HLSL by way of SPIR-V. Every lobe, workflow and profile; presets in the long runs.
 *
 * What is put in place of a text's samplers are layers of one array texture, which is what compute.h has.
 *
 * Labels: slow unsanitized */
#include "export/models.h"

#include <unistd.h>

#include "raster/frame/compute.h"
#include "scratch.h"

typedef enum Way { WAY_GLSL, WAY_ESSL, WAY_HLSL, WAYS } Way;
static const char *const way_names[WAYS] = {"glsl", "essl", "hlsl"};
static const WeftExportTarget targets[WAYS] = {WEFT_EXPORT_GLSL, WEFT_EXPORT_ESSL, WEFT_EXPORT_HLSL};

enum { BODY = 1 << 14 };

static Exported models[MODELS_MAX];
static int lobe_count, model_count;
static char folder[SCRATCH_SIZE];
static GlContext *contexts[2]; /* GLSL 3.30, ES 3.00; NULL where the machine has none */
static Arrays arrays[MODELS_MAX];
static WeftExport exported[WAYS][MODELS_MAX];

static bool has_program(const char *name) {
    char command[128];
    snprintf(command, sizeof command, "command -v %s >/dev/null 2>&1", name);
    return system(command) == 0;
}

static char *file_text(const char *path) {
    FILE *stream = fopen(path, "rb");
    if (!stream) return NULL;
    char *text = calloc(1, 1 << 22);
    assert_non_null(text);
    assert_true(fread(text, 1, (1 << 22) - 1, stream) > 0);
    fclose(stream);
    return text;
}

static void file_put(const char *name, const char *head, const char *text, const char *tail) {
    char path[256];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    FILE *stream = fopen(path, "wb");
    assert_non_null(stream);
    fprintf(stream, "%s%s%s", head, text, tail);
    assert_int_equal(fclose(stream), 0);
}

/* All that is in the folder, compiled by one line of the shell; its words go to this test's output. */
static void shell(const char *line) {
    char command[1024];
    snprintf(command, sizeof command, "cd %s && %s", folder, line);
    if (system(command) != 0) fail_msg("%s", line);
}

/* "uniform ... NAME;" becomes the number of a layer, and comments, which may hold anything, go nowhere. */
static void put_line_as_layer(Text *out, const char *line, int size, int *layer) {
    int name = size - 1;
    while (name > 0 && line[name - 1] != ' ') name--;
    text_line(out, "const int %.*s = %d;", size - 1 - name, line + name, (*layer)++);
}

static bool begins(const char *line, const char *with) { return strncmp(line, with, strlen(with)) == 0; }

/* The text as compute.h takes it. */
static void put_text(Text *out, const char *text, bool crossed) {
    int layer = 0;
    text_line(out, "vec4 layer_fetch(int layer, ivec2 at) { return texelFetch(weft_tables, ivec3(at, layer), 0); }\n"
                   "#define texelFetch(s, at, lod) layer_fetch(s, at)");
    for (const char *line = text; *line;) {
        int size = (int)strcspn(line, "\n");
        if (begins(line, "uniform "))
            put_line_as_layer(out, line, size, &layer);
        else if (crossed && begins(line, "in vec4 "))
            text_line(out, "%.*s", size - 3, line + 3);
        else if (crossed && begins(line, "layout(location"))
            text_line(out, "%.*s", size - (int)(strstr(line, "vec4") - line), strstr(line, "vec4"));
        else if (crossed && begins(line, "void main()"))
            text_line(out, "void hlsl_main()");
        else if (!crossed || *line != '#')
            text_line(out, "%.*s", size, line);
        line += size + (line[size] == '\n');
    }
    text_line(out, "#undef texelFetch");
}

static bool ends_word(const char *c) { return *c == ';' || begins(c, "SPIRV"); }

/* The tables in the order of the text's samplers: spirv-cross may have left some out, or in another order. */
static int order_tables(const WeftExport *made, const char *text, TextTable *out) {
    int count = 0;
    for (const char *at = text; (at = strstr(at, "uniform ")); at++) {
        if (at != text && at[-1] != '\n') continue;
        for (int k = 0; k < made->table_count; k++) {
            const char *name = strstr(at, made->tables[k].name), *end = strchr(at, ';');
            if (!name || name > end || !ends_word(name + strlen(made->tables[k].name))) continue;
            const WeftImage *image = &made->tables[k].texels;
            out[count++] = (TextTable){image->pixels, image->height, image->width, NULL};
            break;
        }
    }
    return count;
}

static void run(const Exported *s, GlContext *context, const WeftExport *made, const char *text, const char *body,
                bool crossed, Arrays *a) {
    Text shader;
    Compute *compute = NULL;
    WeftError error = {0};
    TextTable tables[WEFT_EXPORT_TABLES_MAX];
    int count = order_tables(made, text, tables);
    text_begin(&shader, &(TextDesc){.language = context_language(context), .tables = true});
    put_text(&shader, text, crossed);
    if (text_end(&shader, &error) != WEFT_OK) fail_msg("%s: %s", s->id, error.text);
    ComputeDesc desc = {.name = s->id, .text = &shader, .body = body, .inputs = INPUTS, .outputs = OUTPUTS};
    if (compute_create(context, &desc, &compute, &error) != WEFT_OK ||
        (count && compute_tables(compute, tables, count, &error) != WEFT_OK) ||
        compute_run(compute, PAIRS, (const float *const *)a->in, a->out, &error) != WEFT_OK)
        fail_msg("%s: %s", s->id, error.text);
    compute_destroy(compute);
    text_free(&shader);
}

/* A file of a model's: a lobe and a preset may share a name. */
static void name_file(const Exported *s, const char *end, char name[128]) {
    snprintf(name, 128, "%03d-%s%s", (int)(s - models), s->id, end);
}

/* A whole shader of HLSL around the body. */
static void hlsl_put(const Exported *s, const WeftExport *made) {
    char *body = malloc(BODY), *tail = malloc(BODY + 2048), name[128];
    assert_true(body && tail);
    model_body(s, made, "weft_", &language_hlsl, body, BODY);
    snprintf(tail, BODY + 2048,
             "struct Answers { float4 out0 : SV_Target0; float4 out1 : SV_Target1; };\n"
             "Answers main(float4 a0 : TEXCOORD0, float4 a1 : TEXCOORD1, float4 a2 : TEXCOORD2,\n"
             "             float4 a3 : TEXCOORD3, float4 a4 : TEXCOORD4, float4 a5 : TEXCOORD5) {\n"
             "    float4 in0 = a0, in1 = a1, in2 = a2, in3 = a3, in4 = a4, in5 = a5;\n"
             "    float4 out0 = float4(0.0, 0.0, 0.0, 0.0), out1 = out0;\n%s"
             "    Answers r;\n    r.out0 = out0;\n    r.out1 = out1;\n    return r;\n}\n",
             body);
    name_file(s, ".frag.hlsl", name);
    file_put(name, "", made->text, tail);
    free(body);
    free(tail);
}

/* What calls the shader that came back from SPIR-V, in which inputs that are not read are missing. */
static void crossed_body(const char *text, char *body) {
    size_t used = 0;
    body[0] = 0;
    for (int k = 0; k < INPUTS; k++) {
        char line[32];
        snprintf(line, sizeof line, "in vec4 a%d;", k);
        if (strstr(text, line)) used += (size_t)snprintf(body + used, BODY - used, "    a%d = in%d;\n", k, k);
    }
    snprintf(body + used, BODY - used,
             "    hlsl_main();\n    out0 = _entryPointOutput_out0;\n    out1 = _entryPointOutput_out1;\n");
}

static void agree(Way way) {
    GlContext *context = contexts[way == WAY_ESSL];
    char *body = malloc(BODY);
    assert_non_null(body);
    if (!context) skip();
    for (int k = 0; k < model_count; k++) {
        const Exported *s = &models[k];
        const WeftExport *made = &exported[way][k];
        if (way == WAY_HLSL) {
            char path[256], name[128];
            name_file(s, ".cross", name);
            snprintf(path, sizeof path, "%s/%s", folder, name);
            char *text = file_text(path);
            if (!text) fail_msg("%s: no shader came back from SPIR-V", s->id);
            crossed_body(text, body);
            run(s, context, made, text, body, true, &arrays[k]);
            free(text);
        } else {
            model_body(s, made, "weft_", &language_glsl, body, BODY);
            run(s, context, made, made->text, body, false, &arrays[k]);
        }
        assert_agree(s, way_names[way], &arrays[k]);
    }
    free(body);
}

static void glsl_text_of_every_model_compiles(void **state) {
    (void)state;
    if (!has_program("glslangValidator")) skip();
    for (int k = 0; k < model_count; k++)
        for (Way way = WAY_GLSL; way <= WAY_ESSL; way++) {
            char name[128], end[16];
            snprintf(end, sizeof end, ".%s.frag", way_names[way]);
            name_file(&models[k], end, name);
            file_put(name, way == WAY_ESSL ? "#version 300 es\nprecision highp float;\n" : "#version 330 core\n",
                     exported[way][k].text, "\nout vec4 pixel;\nvoid main() { pixel = vec4(1.0); }\n");
        }
    shell("glslangValidator -S frag *.frag >log 2>&1 || { grep -B1 ERROR log | head -6; exit 1; }");
}

static void hlsl_text_of_every_model_compiles(void **state) {
    (void)state;
    if (!has_program("glslangValidator")) skip();
    for (int k = 0; k < model_count; k++) hlsl_put(&models[k], &exported[WAY_HLSL][k]);
    shell("for f in *.frag.hlsl; do glslangValidator -D -V -e main -S frag $f -o ${f%.frag.hlsl}.spv >log "
          "2>&1 || "
          "{ grep ERROR log | head -3; exit 1; }; done");
}

static void glsl_text_agrees_with_the_library(void **state) {
    (void)state;
    agree(WAY_GLSL);
}

static void essl_text_agrees_with_the_library(void **state) {
    (void)state;
    agree(WAY_ESSL);
}

static void hlsl_text_agrees_with_the_library(void **state) {
    (void)state;
    if (!has_program("spirv-cross") || !has_program("glslangValidator")) skip();
    shell("for f in *.spv; do spirv-cross --version 330 --no-es $f >${f%.spv}.cross || exit 1; done");
    agree(WAY_HLSL);
}

static int begin(void **state) {
    (void)state;
    lobe_count = models_lobes(models);
    model_count = lobe_count + models_profiles(models + lobe_count);
    model_count += models_choices(models + model_count);
    model_count += models_woven(models + model_count);
    if (getenv("WEFT_TEST_LONG")) model_count += models_presets(models + model_count);
    context_create(TEXT_GLSL_330, &contexts[0], NULL);
    context_create(TEXT_GLSL_ES_300, &contexts[1], NULL);
    for (int k = 0; k < model_count; k++) {
        arrays[k] = arrays_make();
        arrays_fill(&models[k], &arrays[k]);
        for (Way way = WAY_GLSL; way < WAYS; way++) {
            WeftExportDesc desc = model_desc(&models[k], targets[way]);
            exported[way][k] = model_export(&desc);
        }
    }
    return scratch_make(folder) ? 0 : -1;
}

static int end(void **state) {
    (void)state;
    for (int k = 0; k < model_count; k++) {
        arrays_free(&arrays[k]);
        for (Way way = WAY_GLSL; way < WAYS; way++) weft_export_free(&exported[way][k]);
    }
    for (int k = 0; k < 2; k++) context_destroy(contexts[k]);
    return scratch_remove(folder) ? 0 : -1;
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(glsl_text_of_every_model_compiles), cmocka_unit_test(hlsl_text_of_every_model_compiles),
        cmocka_unit_test(glsl_text_agrees_with_the_library), cmocka_unit_test(essl_text_agrees_with_the_library),
        cmocka_unit_test(hlsl_text_agrees_with_the_library),
    };
    return cmocka_run_group_tests(tests, begin, end);
}
