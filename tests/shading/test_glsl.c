/* The catalogue's text is GLSL, 3.30 core and ES 3.00: compiled by glslangValidator where it is installed */
#include <dirent.h>
#include <unistd.h>

#include "cases.h"

typedef struct Text {
    char *bytes;
    size_t size, room;
} Text;

static void put(Text *text, const char *bytes, size_t size) {
    if (text->size + size + 1 > text->room) {
        text->room = 2 * (text->size + size + 1);
        text->bytes = realloc(text->bytes, text->room);
        assert_non_null(text->bytes);
    }
    memcpy(text->bytes + text->size, bytes, size);
    text->size += size;
    text->bytes[text->size] = 0;
}

static void put_line(Text *text, const char *line) { put(text, line, strlen(line)); }

/* Appends a file of src/ with its own includes in place of the lines that name them; without comments,
 * strings and joined lines, none of which GLSL 3.30 has. */
static void inline_file(Text *text, const char *file) {
    char path[512];
    snprintf(path, sizeof path, "%s/src/%s", WEFT_SOURCE_DIR, file);
    FILE *stream = fopen(path, "rb");
    if (!stream) fail_msg("%s cannot be opened", path);
    char *source = calloc(1, 1 << 16);
    size_t size = fread(source, 1, (1 << 16) - 1, stream);
    source[size] = 0;
    fclose(stream);
    for (const char *c = source; *c;) {
        if (strncmp(c, "/*", 2) == 0) {
            c = strstr(c, "*/") + 2;
        } else if (strncmp(c, "\\\n", 2) == 0) {
            c += 2;
        } else if (strncmp(c, "#include \"", 10) == 0) {
            const char *name = c + 10, *end = strchr(name, '"');
            char included[256];
            snprintf(included, sizeof included, "%.*s", (int)(end - name), name);
            if (strcmp(included, "shading/lobe_tables.h") == 0) { /* C's own way to find a table */
                inline_file(text, "shading/table.h");
                put_line(text, "\nTableRef lobe_table_charlie_neubelt() { TableRef t; t.texels = 0; t.kind = "
                               "TABLE_ROOTS; "
                               "t.rows = 32; t.columns = 40; t.low = 0.5; t.high = 1.2; return t; }\n");
            } else {
                inline_file(text, included);
            }
            c = end + 1;
        } else if (*c == '"') {
            put(text, "0", 1);
            c = strchr(c + 1, '"') + 1;
        } else {
            put(text, c++, 1);
        }
    }
    free(source);
}

static bool has_validator(void) { return system("command -v glslangValidator >/dev/null 2>&1") == 0; }

/* Compiles as a fragment shader of that version; the compiler's words go to this test's output. */
static int compile(const char *version, const char *body) {
    char path[] = "/tmp/weft-test-glsl-XXXXXX", command[256];
    int handle = mkstemp(path);
    assert_true(handle >= 0);
    FILE *stream = fdopen(handle, "wb");
    fprintf(stream, "#version %s\n%s%s", version,
            strstr(version, "es") ? "precision highp float;\nprecision highp int;\n" : "", body);
    assert_int_equal(fclose(stream), 0);
    snprintf(command, sizeof command, "glslangValidator -S frag %s >%s.log 2>&1", path, path);
    int status = system(command);
    if (status != 0) {
        snprintf(command, sizeof command, "grep -v '^$' %s.log | head -20", path);
        if (system(command) != 0) print_message("the compiler said nothing\n");
    }
    unlink(path);
    snprintf(command, sizeof command, "%s.log", path);
    unlink(command);
    return status;
}

static void check_both(const char *what, const Text *text) {
    static const char *const versions[] = {"330 core", "300 es"};
    for (int k = 0; k < 2; k++)
        if (compile(versions[k], text->bytes) != 0) fail_msg("%s is not GLSL %s", what, versions[k]);
}

static const char inputs[] =
    "uniform highp sampler2DArray weft_tables;\nuniform float u[16];\nout vec4 color;\n";

/* The body of a function that calls all of a lobe. */
static void put_calls(Text *text, int id, const char *name, const char *record) {
    char line[512];
    const WeftLobeInfo *info = weft_lobe_info(id);
    snprintf(line, sizeof line, "vec4 shade_%s() {\n    %s m;\n", name, record);
    put_line(text, line);
    if (!info->param_count) put_line(text, "    m.none = 0.0;\n");
    for (int p = 0; p < info->param_count; p++) {
        snprintf(line, sizeof line,
                 info->params[p].choices ? "    m.%s = int(u[%d]);\n" : "    m.%s = u[%d];\n",
                 info->params[p].name, p);
        put_line(text, line);
    }
    snprintf(line, sizeof line,
             "    Angles a = angles_between(dir(u[8], u[9], u[10]), dir(u[11], u[12], u[13]));\n"
             "    Dir s = %s_sample(m, a.o, u[14], u[15]);\n"
             "    return vec4(%s_eval(m, a), %s_pdf(m, a), s.x, s.z);\n}\n",
             name, name, name);
    put_line(text, line);
}

static void put_lobe(Text *text, int id, const char *name, const char *record) {
    char file[128];
    snprintf(file, sizeof file, "shading/lobes/%s.h", name);
    inline_file(text, file);
    put_calls(text, id, name, record);
}

static void inline_layer(Text *text, const char *id) {
    char file[128];
    snprintf(file, sizeof file, "shading/layers/%s.h", id);
    for (char *c = file; *c; c++)
        if (*c == '-') *c = '_';
    inline_file(text, file);
}

static void every_lobe_compiles(void **state) {
    (void)state;
    if (!has_validator()) {
        print_message("glslangValidator is not installed\n");
        skip();
    }
    Text all = {0};
    put_line(&all, inputs);
    Text calls = {0};
#define CHECK_LOBE(id, name, Record, NAME)                                                                   \
    {                                                                                                        \
        Text one = {0};                                                                                      \
        put_line(&one, inputs);                                                                              \
        put_lobe(&one, LOBE_##NAME, #name, #Record);                                                         \
        put_line(&one, "void main() { color = shade_" #name "(); }\n");                                      \
        check_both(id, &one);                                                                                \
        free(one.bytes);                                                                                     \
        put_lobe(&all, LOBE_##NAME, #name, #Record);                                                         \
        put_line(&calls, "    color += shade_" #name "();\n");                                               \
    }
    WEFT_LOBES(CHECK_LOBE)
#undef CHECK_LOBE
#define CHECK_LAYER(id, index, base, help)                                                                   \
    inline_layer(&all, id);                                                                                  \
    put_line(&calls, "    color *= " #base ";\n");
    WEFT_LAYERS(CHECK_LAYER)
#undef CHECK_LAYER
    put_line(&all, "void main() {\n    float c = u[0], e_o = u[1], e_i = u[2], e_avg = u[3];\n"
                   "    color = vec4(0.0);\n");
    put(&all, calls.bytes, calls.size);
    put_line(&all, "}\n");
    check_both("all of the catalogue together", &all);
    free(calls.bytes);
    free(all.bytes);
}

/* Terms that no lobe uses yet are shading text too. */
static void every_term_compiles(void **state) {
    (void)state;
    if (!has_validator()) skip();
    DIR *folder = opendir(WEFT_SOURCE_DIR "/src/shading/terms");
    assert_non_null(folder);
    int terms = 0;
    for (struct dirent *entry; (entry = readdir(folder));) {
        if (entry->d_name[0] == '.') continue;
        char file[300];
        snprintf(file, sizeof file, "shading/terms/%s", entry->d_name);
        Text text = {0};
        put_line(&text, inputs);
        inline_file(&text, file);
        put_line(&text, "void main() { color = vec4(u[0]); }\n");
        check_both(file, &text);
        free(text.bytes);
        terms++;
    }
    closedir(folder);
    assert_true(terms > 0);
}

static void what_is_not_glsl_is_found(void **state) {
    (void)state;
    if (!has_validator()) skip();
    Text text = {0};
    put_line(&text, inputs);
    inline_file(&text, "shading/angles.h");
    put_line(&text, "float half_of(Dir d) { return d->x * 0.5; }\nvoid main() { color = vec4(1.0); }\n");
    print_message("an error is expected here:\n");
    assert_int_not_equal(compile("330 core", text.bytes), 0);
    free(text.bytes);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_lobe_compiles),
        cmocka_unit_test(every_term_compiles),
        cmocka_unit_test(what_is_not_glsl_is_found),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
