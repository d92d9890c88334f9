/* The catalogue's text is GLSL (3.30 core, ES 3.00, 4.50 for Vulkan), compiled by glslangValidator where it
 * is installed; and what the flattener makes of macros, tables, enumerations, and of text that is none */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cmocka.h>

#include "scratch.h"
#include "shading/catalogue/engine_tables.h"
#include "shading/lobe/lobe_tables.h"
#include "shading/stack/layer.h"
#include "text/assemble/catalogue.h"
#include "text/assemble/dispatch.h"
#include "text/assemble/tables.h"
#include "text/passes/items.h"

static const TextLanguage languages[] = {TEXT_GLSL_330, TEXT_GLSL_ES_300, TEXT_GLSL_450};
enum { LANGUAGES = 3 };
static const char *const language_names[] = {"330 core", "300 es", "450"};

static bool has_validator(void) { return system("command -v glslangValidator >/dev/null 2>&1") == 0; }

/* Many fragment shaders, to be compiled by one call of the compiler. */
typedef struct Batch {
    char folder[SCRATCH_SIZE];
    int count;
} Batch;

static void batch_begin(Batch *batch) {
    *batch = (Batch){.count = 0};
    assert_true(scratch_make(batch->folder));
}

static void batch_add(Batch *batch, const char *name, TextLanguage language, const char *bytes) {
    char path[256];
    snprintf(path, sizeof path, "%s/%s.%s.frag", batch->folder, name, language_names[language]);
    for (char *c = path + strlen(batch->folder) + 1; *c; c++)
        if (*c == '/' || *c == ' ') *c = '_';
    FILE *stream = fopen(path, "wb");
    assert_non_null(stream);
    assert_true(fputs(bytes, stream) >= 0);
    assert_int_equal(fclose(stream), 0);
    batch->count++;
}

/* The compiler's status; its words go to this test's output. */
static int batch_compile(Batch *batch) {
    char command[512];
    snprintf(command, sizeof command,
             "cd %s && s=0; for f in *.frag; do case $f in *450.frag) v='-V -o /dev/null';; *) v=;; esac; "
             "glslangValidator $v -S frag $f >log 2>&1 || { s=1; grep -v '^$' log | head -5; }; done; exit $s",
             batch->folder);
    int status = system(command);
    assert_true(scratch_remove(batch->folder));
    return status;
}

/* No comment, string, directive (but the first line), joined line or blank at a line's end; never two blank
 * lines, and none behind an opening brace. */
static void assert_clean(const char *name, const char *bytes) {
    static const char *const banned[] = {"/*", "//", "\"", "##", "\\", " \n", "\t", "\n\n\n", "{\n\n", " WEFT_", "\r"};
    for (size_t k = 0; k < sizeof banned / sizeof *banned; k++)
        if (strstr(bytes, banned[k]))
            fail_msg("%s: the text has '%s': %.60s", name, banned[k], strstr(bytes, banned[k]));
    assert_memory_equal(bytes, "#version ", 9);
    if (strchr(bytes + 1, '#')) fail_msg("%s: %.60s", name, strchr(bytes + 1, '#'));
    size_t size = strlen(bytes);
    assert_true(bytes[size - 1] == '\n' && bytes[size - 2] != '\n');
}

static int occurrences(const char *bytes, const char *word) {
    int n = 0;
    for (const char *c = bytes; (c = strstr(c, word)); c += strlen(word)) n++;
    return n;
}

static void end_clean(Text *text, const char *name) {
    WeftError error = {0};
    if (text_end(text, &error) != WEFT_OK) fail_msg("%s: %s", name, error.text);
    assert_int_equal(strlen(text->bytes), text->size);
    assert_clean(name, text->bytes);
}

static void put_main(Text *text, const char *line) {
    bool vulkan = text->desc.language == TEXT_GLSL_450;
    text_line(text, "\n%suniform Inputs { vec4 u[4]; };", vulkan ? "layout(set = 0, binding = 1) " : "layout(std140) ");
    text_line(text, "%sout vec4 color;\n", vulkan ? "layout(location = 0) " : "");
    text_line(text, "void main() {\n    %s\n}", line);
}

static const char all_calls[] =
    "Lobe m;\n    m.id = int(u[0].x);\n    for (int k = 0; k < 8; k++) m.params[k] = u[1][k & 3];\n"
    "    Angles a = angles_between(dir(u[2].x, u[2].y, u[2].z), dir(u[3].x, u[3].y, u[3].z));\n"
    "    Dir s = lobe_sample(m, a.o, u[0].y, u[0].z);\n"
    "    color = vec4(lobe_f(m, a), lobe_pdf(m, a), lobe_fresnel_weight(m, a), lobe_second(m, s.x, s.y)) *\n"
    "            lobe_color(lobe_value(m, a), s.x, s.y);";

/* The lobes that the GPU has. */
static int gpu_lobes(int ids[LOBE_COUNT]) {
    int n = 0;
    for (int k = 0; k < LOBE_COUNT; k++)
        if (!(weft_lobe_info(k)->traits & TRAIT_REFERENCE)) ids[n++] = k;
    return n;
}

/* Together in all languages; and each alone, in the strictest, whether it includes what it needs. */
static void text_of_every_lobe_is_valid_glsl(void **state) {
    (void)state;
    int ids[LOBE_COUNT];
    int count = gpu_lobes(ids);
    Batch batch;
    batch_begin(&batch);
    for (int k = 0; k <= count; k++)
        for (int l = 0; l < LANGUAGES; l++) {
            const char *name = k < count ? weft_lobe_info(ids[k])->id : "all-lobes";
            Text text;
            text_begin(&text, &(TextDesc){.language = languages[l], .tables = true});
            text_dispatch(&text, k < count ? &ids[k] : ids, k < count ? 1 : count);
            put_main(&text, all_calls);
            end_clean(&text, name);
            assert_int_equal(occurrences(text.bytes, "struct Angles"), 1);
            assert_int_equal(occurrences(text.bytes, "const int LOBE_"),
                             2 + (k < count ? 1 : count)); /* and two sums */
            if (k == count || languages[l] == TEXT_GLSL_ES_300) batch_add(&batch, name, languages[l], text.bytes);
            text_free(&text);
        }
    int status = batch_compile(&batch);
    if (!has_validator()) skip();
    assert_int_equal(status, 0);
}

static bool is_below(const char *name, const char *folder) { return strncmp(name, folder, strlen(folder)) == 0; }

/* Terms and layers that nothing uses yet are shading text too, and so is the medium of fibres; all of them
 * together, since names are unique. */
static void text_of_every_term_is_valid_glsl(void **state) {
    (void)state;
    Batch batch;
    batch_begin(&batch);
    int files = 0;
    for (int l = 0; l < LANGUAGES; l++) {
        Text all;
        text_begin(&all, &(TextDesc){.language = languages[l]});
        for (const CatalogueFile *file = catalogue_files; file->name; file++) {
            if (!is_below(file->name, "shading/terms/") && !is_below(file->name, "shading/layers/") &&
                strcmp(file->name, "shading/media/fibre_medium.h") != 0)
                continue;
            text_include(&all, file->name);
            files++;
            Text text;
            text_begin(&text, &(TextDesc){.language = languages[l]});
            text_include(&text, file->name);
            put_main(&text, "color = u[0];");
            end_clean(&text, file->name);
            if (languages[l] == TEXT_GLSL_ES_300) batch_add(&batch, file->name, languages[l], text.bytes);
            text_free(&text);
        }
        put_main(&all, "color = u[0];");
        end_clean(&all, "all terms");
        batch_add(&batch, "all-terms", languages[l], all.bytes);
        text_free(&all);
    }
    assert_true(files >= 3 * 8);
    int status = batch_compile(&batch);
    if (!has_validator()) skip();
    assert_int_equal(status, 0);
}

/* A whole surface, with every workflow, profile, layer and lobe. */
static void text_of_a_surface_is_valid_glsl(void **state) {
    (void)state;
    int ids[LOBE_COUNT];
    int count = gpu_lobes(ids);
    Batch batch;
    batch_begin(&batch);
    for (int l = 0; l < LANGUAGES; l++) {
        Text text;
        text_begin(&text, &(TextDesc){.language = languages[l], .tables = true});
        text_dispatch(&text, ids, count);
        text_engine_tables(&text, (const int[]){ENGINE_THREE_GGX}, 1);
        assert_int_equal(text.table_count, LOBE_TABLE_COUNT + 1);
        assert_int_equal(text_table(&text, (TextTable){.rows = 1, .columns = 1}),
                         LOBE_TABLE_COUNT + 1); /* the surface's own E */
        text_include(&text, "shading/material/stack_value.h");
        for (const CatalogueFile *file = catalogue_files; file->name; file++)
            if (is_below(file->name, "shading/workflows/") || is_below(file->name, "shading/profiles/"))
                text_include(&text, file->name);
        put_main(&text, "Surface s;\n    Choices c;\n    TableRef e;\n    e.kind = TABLE_NONE;\n"
                        "    Dir o = dir(u[2].x, u[2].y, u[2].z);\n    Angles a = angles_between(o, o);\n"
                        "    Stack m;\n    surface_stack(m, s, c, e);\n    StackView w;\n    stack_view(m, o, w);\n"
                        "    StackValue v = stack_value(m, w, a, a);\n"
                        "    color = vec4(v.f_cos.r, v.f_cos.g, v.f_cos.b, v.pdf);");
        end_clean(&text, "surface");
        batch_add(&batch, "surface", languages[l], text.bytes);
        text_free(&text);
    }
    int status = batch_compile(&batch);
    if (!has_validator()) skip();
    assert_int_equal(status, 0);
}

/* Each by itself, in the strictest language, whether it includes what it needs. */
static void text_of_every_composition_is_valid_glsl(void **state) {
    (void)state;
    Batch batch;
    int files = 0;
    batch_begin(&batch);
    for (const CatalogueFile *file = catalogue_files; file->name; file++) {
        if (!is_below(file->name, "shading/workflows/") && !is_below(file->name, "shading/profiles/")) continue;
        Text text;
        text_begin(&text, &(TextDesc){.language = TEXT_GLSL_ES_300, .tables = true});
        text_dispatch(&text, &(int){LOBE_LAMBERT}, 1);
        text_engine_tables(&text, NULL, 0);
        text_include(&text, file->name);
        put_main(&text, "color = u[0];");
        end_clean(&text, file->name);
        batch_add(&batch, file->name, TEXT_GLSL_ES_300, text.bytes);
        text_free(&text);
        files++;
    }
    assert_true(files >= 5 + 13);
    int status = batch_compile(&batch);
    if (!has_validator()) skip();
    assert_int_equal(status, 0);
}

static void text_that_is_not_glsl_is_found(void **state) {
    (void)state;
    if (!has_validator()) skip();
    for (int l = 0; l < LANGUAGES; l++) {
        Batch batch;
        batch_begin(&batch);
        Text text;
        text_begin(&text, &(TextDesc){.language = languages[l]});
        text_include(&text, "shading/dialect/angles.h");
        text_line(&text, "float half_of(Dir d) { return d->x * 0.5; }");
        put_main(&text, "color = u[0];");
        assert_int_equal(text_end(&text, NULL), WEFT_OK);
        batch_add(&batch, "wrong", languages[l], text.bytes);
        text_free(&text);
        print_message("an error is expected here:\n");
        assert_int_not_equal(batch_compile(&batch), 0);
    }
}

static void file_included_twice_stands_once(void **state) {
    (void)state;
    Text once, twice;
    text_begin(&once, &(TextDesc){.language = TEXT_GLSL_330});
    text_lobe(&once, LOBE_GGX);
    text_lobe(&once, LOBE_LAMBERT);
    text_begin(&twice, &(TextDesc){.language = TEXT_GLSL_330});
    for (int k = 0; k < 3; k++) {
        text_lobe(&twice, LOBE_GGX);
        text_lobe(&twice, LOBE_LAMBERT);
        text_include(&twice, "shading/dialect/angles.h");
        text_include(&twice, "shading/dialect/lang.h");
    }
    assert_int_equal(text_end(&once, NULL), WEFT_OK);
    assert_int_equal(text_end(&twice, NULL), WEFT_OK);
    assert_string_equal(once.bytes, twice.bytes);
    assert_int_equal(occurrences(once.bytes, "Dir dir("), 1);
    assert_int_equal(occurrences(once.bytes, "struct Ggx {"), 1);
    text_free(&once);
    text_free(&twice);
}

/* Files of a folder of the test's own, laid over the library's. */
static char overlay[SCRATCH_SIZE];

static int make_overlay(void **state) {
    (void)state;
    char path[128];
    if (!scratch_make(overlay)) return -1;
    snprintf(path, sizeof path, "%s/shading", overlay);
    return mkdir(path, 0700);
}

static int remove_overlay(void **state) {
    (void)state;
    return scratch_remove(overlay) ? 0 : -1;
}

static void write_overlay(const char *name, const char *bytes) {
    char path[128];
    snprintf(path, sizeof path, "%s/shading/%s", overlay, name);
    FILE *stream = fopen(path, "wb");
    assert_non_null(stream);
    assert_true(fputs(bytes, stream) >= 0);
    assert_int_equal(fclose(stream), 0);
}

/* What the flattener makes of one file, behind "#version 330 core" and a blank line. */
static WeftResult flatten(const char *source, char out[4096], WeftError *error) {
    write_overlay("own.h", source);
    Text text;
    text_begin(&text, &(TextDesc){.language = TEXT_GLSL_330, .folder = overlay});
    text_include(&text, "shading/own.h");
    WeftResult result = text_end(&text, error);
    out[0] = 0;
    if (result == WEFT_OK) {
        assert_clean(source, text.bytes);
        snprintf(out, 4096, "%s", text.size > 19 ? text.bytes + 19 : "");
    }
    text_free(&text);
    return result;
}

static void assert_flat(const char *source, const char *expected) {
    char out[4096];
    WeftError error = {0};
    if (flatten(source, out, &error) != WEFT_OK) fail_msg("%s: %s", source, error.text);
    assert_string_equal(out, expected);
}

static void macros_are_expanded_in_the_text(void **state) {
    (void)state;
    assert_flat("#ifndef X_H\n#define X_H\nfloat a; /* c */\n#endif\n", "float a;\n");
    assert_flat("/* one\n * two */\n\n\n/* three */\nfloat a;// four\n\n\n\nfloat b;\n", "float a;\n\nfloat b;\n");
    assert_flat("#define TWO 2.0f\n#define SIX 6\n#define MINUS -1e-3f\n#define MASK 0xef\nfloat a = TWO;\n",
                "const float TWO = 2.0f;\nconst int SIX = 6;\nconst float MINUS = -1e-3f;\nconst int MASK = 0xef;\n"
                "float a = TWO;\n");
    assert_flat("#define SQUARE(x) ((x) * (x))\nfloat f(float a) { return SQUARE(SQUARE(a + 1.0f)); }\n",
                "float f(float a) { return ((((a + 1.0f) * (a + 1.0f))) * (((a + 1.0f) * (a + 1.0f)))); }\n");
    /* a macro does not expand itself, nor where its name is not called */
    assert_flat("#define a(x) a(x + b)\n#define b a\nfloat f = a(1);\nfloat g = a;\n",
                "float f = a(1 + a);\nfloat g = a;\n");
    assert_flat("#define ROWS(P) \\\n    P(float, alpha, \"say \\\"(,\") \\\n    P(int, kind, \"\")\n"
                "#define FIELD_OF(type, name, help) type name;\nstruct Own{ROWS(FIELD_OF)};\n",
                "struct Own {\n    float alpha;\n    int kind;\n};\n");
    assert_flat("#define LIST(L) L(red, RED) L(blue, BLUE)\n#define ONE(name, NAME) COLOR_##NAME,\n"
                "typedef enum Color { LIST(ONE) COLOR_COUNT } Color;\nColor next(Color c) { return c; }\n",
                "const int COLOR_RED = 0;\nconst int COLOR_BLUE = 1;\nconst int COLOR_COUNT = 2;\n"
                "int next(int c) { return c; }\n");
    assert_flat("enum { A, B = 4, C, D, E = B, F };\n",
                "const int A = 0;\nconst int B = 4;\nconst int C = B + 1;\n"
                "const int D = B + 2;\nconst int E = B;\nconst int F = E + 1;\n");
    assert_flat("#define NONE\n#define NO_ROWS(P)\nNONE float f() {\n    NO_ROWS(ROW)\n    return 1.0f; NONE\n}\n",
                "float f() {\n    return 1.0f;\n}\n");
    assert_flat("typedef float Metre;\nMetre up(Metre m) { return m; }\n", "float up(float m) { return m; }\n");
    assert_flat("#if defined(GL_ES) || defined(GL_core_profile)\nfloat gl;\n#else\n#include <math.h>\nfloat "
                "c;\n#endif\n"
                "#if !(1 && defined NO)\nfloat yes;\n#elif 1\nfloat no;\n#endif\n#undef NO\n#ifdef NO\nfloat "
                "no;\n#endif\n",
                "float gl;\nfloat yes;\n");
}

static void references_become_parameters_that_are_read_or_written(void **state) {
    (void)state;
    assert_flat("STRUCTURE\nfloat f(const Own *m, Own *out, float x) {\n    out->x = m->x * x;\n"
                "    *out = *m;\n    return f(&out->inner, out, -x) + m->x;\n}\n",
                "STRUCTURE\nfloat f(Own m, inout Own out, float x) {\n    out.x = m.x * x;\n"
                "    out = m;\n    return f(out.inner, out, -x) + m.x;\n}\n");
    /* operators of two operands stay */
    assert_flat("bool g(float a, float b) {\n    return a * b > (a) * b - 1.0f && a * f(b) > b;\n}\n",
                "bool g(float a, float b) {\n    return a * b > (a) * b - 1.0f && a * f(b) > b;\n}\n");
    assert_flat("void h(\n    const Own *a,\n    Own *b\n);\n", "void h(\n    Own a,\n    inout Own b\n);\n");
}

/* The record that a name stands for in a function, among those that its text declares; size 0: none. */
static Token record_of(const Items *items, const Item *function, Token name) {
    Token before = {0}, record = {0};
    const char *c = function->code;
    bool list = false; /* "Dir a = .., b = ..": b too */
    int depth = 0;
    for (Token token; (token = token_solid(&c, function->end)).kind != TOKEN_NONE; before = token) {
        depth += token_is(token, "(") - token_is(token, ")");
        const Item *type = before.kind == TOKEN_NAME ? items_find(items, before) : NULL;
        if (token.kind == TOKEN_NAME && type && type->kind == ITEM_RECORD) {
            record = before;
            list = depth == 0;
        } else if (!(token.kind == TOKEN_NAME && list && depth == 0 && token_is(before, ","))) {
            list = list && !token_is(token, ";");
            continue;
        }
        if (token.size == name.size && memcmp(token.at, name.at, name.size) == 0) return record;
    }
    return (Token){0};
}

/* The record that an expression comes to: a variable's, a member's, what a function returns. */
static Token record_at(const Items *items, const Item *function, const char *c, const char *end) {
    Token token = token_solid(&c, end);
    while (token_is(token, "(")) token = token_solid(&c, end);
    const Item *called = token.kind == TOKEN_NAME ? items_find(items, token) : NULL;
    Token record = {0};
    if (called && called->kind == ITEM_FUNCTION) {
        const char *head = called->code;
        record = token_solid(&head, called->end);
        int depth = 0;
        do {
            token = token_solid(&c, end);
            depth += token_is(token, "(") - token_is(token, ")");
        } while (depth > 0);
    } else if (token.kind == TOKEN_NAME) {
        record = record_of(items, function, token);
    }
    for (;;) {
        const Item *type = record.size ? items_find(items, record) : NULL;
        if (!type || type->kind != ITEM_RECORD) return (Token){0};
        if (!token_is(token_solid(&c, end), ".")) return record;
        record = record_of(items, type, token_solid(&c, end));
    }
}

/* WebGL takes "?:" of numbers alone. */
static void conditional_expression_of_records_is_absent(void **state) {
    (void)state;
    static const char *const also[] = {"Dir bad(Angles a, bool x) { return x ? a.o : a.i; }",
                                       "Dir bad(Dir a, bool x) { return x ? dir(a.x, a.y, a.z) : a; }",
                                       "float good(Angles a, bool x) { return x ? a.o.x : dir(1.0, a.d, 1.0).x; }"};
    static const char *const of[] = {"shading/terms/",
                                     "shading/layers/",
                                     "shading/workflows/",
                                     "shading/profiles/",
                                     "shading/material/stack_value.h",
                                     "shading/area/area.h",
                                     "shading/ambient/ambient.h",
                                     "shading/stack/frame.h",
                                     "shading/area/punctual.h",
                                     "shading/dialect/texel.h",
                                     "shading/dialect/tone.h"};
    for (int k = 0; k < 4; k++) {
        int ids[LOBE_COUNT], count = gpu_lobes(ids), records = 0, choices = 0;
        Text text;
        text_begin(&text, &(TextDesc){.language = TEXT_PLAIN, .tables = true});
        text_dispatch(&text, ids, count);
        text_engine_tables(&text, NULL, 0);
        text_provide(&text, "shading/ambient/ambient_source.h"); /* a shader's own */
        for (const CatalogueFile *file = catalogue_files; file->name; file++) {
            bool shading = false;
            for (size_t n = 0; n < sizeof of / sizeof *of; n++) shading |= is_below(file->name, of[n]);
            if (shading) text_include(&text, file->name);
        }
        if (k < 3) text_line(&text, "\n%s", also[k]);
        WeftError error = {0};
        if (text_end(&text, &error) != WEFT_OK) fail_msg("%s", error.text);
        Items items;
        items_cut(text.bytes, &items);
        assert_false(items.short_of_memory);
        for (int n = 0; n < items.count; n++) {
            const Item *item = &items.all[n];
            if (item->kind != ITEM_FUNCTION) continue;
            const char *c = item->code;
            for (Token token; (token = token_next(&c, item->end)).kind != TOKEN_NONE;) {
                if (!token_is(token, "?")) continue;
                choices++;
                Token record = record_at(&items, item, c, item->end);
                records += record.size > 0;
                if (record.size && k == 3)
                    fail_msg("%.*s chooses between two %.*s", (int)item->name.size, item->name.at, (int)record.size,
                             record.at);
            }
        }
        assert_int_equal(records, k < 2);
        assert_true(choices > 30);
        items_free(&items);
        text_free(&text);
    }
}

static void text_outside_the_dialect_is_refused(void **state) {
    (void)state;
    static const struct {
        const char *source, *why;
        int line;
    } wrong[] = {
        {"#include <math.h>\n", "includes a header of C", 1},
        {"/* one\n * two */\n\n#include \"shading/none.h\"\n", "includes shading/none.h, which does not exist", 4},
        {"const char *s =\n    \"text\";\n", "a string", 2},
        {"float a;\n#if 1 + 1\n#endif\n", "an #if of more", 2},
        {"\n#if 1\nfloat a;\n", "an #if without its #endif", 2},
        {"float a;\n\n#endif\n", "without its #if", 3},
        {"#pragma pack(1)\n", "a directive", 1},
        {"#define F(a, b) a\nfloat a;\nfloat x = F(1);\nfloat b;\n", "F is called with", 3},
        {"float a;\n#define F(a...) a\nfloat b;\n", "F has parameters", 2},
        {"float a;\ntypedef struct Own { float x; } Own;\n", "a record not made with STRUCT", 2},
        {"float f(float x) {\n    return x;\n}\nfloat g(float x) {\n    return \\ 1.0;\n}\n", "a joined line", 5},
    };
    for (size_t k = 0; k < sizeof wrong / sizeof *wrong; k++) {
        char out[4096];
        WeftError error = {0};
        if (flatten(wrong[k].source, out, &error) != WEFT_INPUT) fail_msg("taken: %s", wrong[k].source);
        assert_int_equal(error.message, WEFT_MESSAGE_TEXT_DIALECT);
        if (!strstr(error.text, wrong[k].why)) fail_msg("%s: %s", wrong[k].source, error.text);
        char place[160];
        snprintf(place, sizeof place, "%s/shading/own.h:%d: ", overlay, wrong[k].line);
        if (strncmp(error.text, place, strlen(place)) != 0) fail_msg("not at %s: %s", place, error.text);
    }
    Text text;
    WeftError error = {0};
    text_begin(&text, &(TextDesc){.language = TEXT_GLSL_330});
    text_include(&text, "shading/nothing.h");
    text_include(&text, "shading/dialect/angles.h"); /* the first failure stays */
    assert_int_equal(text_end(&text, &error), WEFT_USAGE);
    assert_int_equal(error.message, WEFT_MESSAGE_TEXT_NAME);
    assert_null(text.bytes);
    text_free(&text);
}

/* What grows without end stops, whether it grows in size, in time or in depth. */
static void endless_text_is_refused(void **state) {
    (void)state;
    static const char *const first[] = {"xxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxx", ""};
    char *source = calloc(1, 1 << 18), out[4096];
    WeftError error;
    assert_non_null(source);
    for (int k = 0; k < 2; k++) {
        int size = sprintf(source, "#define M0 %s\n", first[k]);
        for (int m = 1; m < 40; m++) size += sprintf(source + size, "#define M%d M%d M%d\n", m, m - 1, m - 1);
        sprintf(source + size, "float M39;\n");
        assert_int_not_equal(flatten(source, out, &error), WEFT_OK);
    }
    int size = sprintf(source, "#define F(x) x\nfloat a = ");
    for (int k = 0; k < 20000; k++) size += sprintf(source + size, "F(");
    for (int k = 0; k < 20000; k++) size += sprintf(source + size, ")");
    sprintf(source + size, ";\n");
    assert_int_equal(flatten(source, out, &error), WEFT_INPUT);
    assert_non_null(strstr(error.text, "F expands without end"));
    size = sprintf(source, "#define LONG ");
    for (int k = 0; k < 32768; k++) size += sprintf(source + size, "x ");
    size += sprintf(source + size, "\nfloat ");
    for (int k = 0; k < 80; k++) size += sprintf(source + size, "LONG "); /* 5 MiB in 80 steps */
    sprintf(source + size, ";\n");
    assert_int_equal(flatten(source, out, &error), WEFT_INPUT);
    assert_non_null(strstr(error.text, "LONG expands without end"));
    size = sprintf(source, "#if ");
    for (int k = 0; k < 100000; k++) size += sprintf(source + size, "!");
    sprintf(source + size, "1\n#endif\n");
    assert_int_equal(flatten(source, out, &error), WEFT_INPUT);
    free(source);
}

/* own.h includes own1.h, which includes own2.h, and so on: `files` in all. */
static WeftResult flatten_chain(int files, WeftError *error) {
    char name[32], source[64], out[4096];
    for (int k = 1; k < files; k++) {
        snprintf(name, sizeof name, "own%d.h", k);
        snprintf(source, sizeof source, k + 1 < files ? "#include \"own%d.h\"\n" : "float a;\n", k + 1);
        write_overlay(name, source);
    }
    return flatten("#include \"own1.h\"\n", out, error);
}

static void includes_nested_too_deep_are_refused(void **state) {
    (void)state;
    WeftError error = {0};
    assert_int_equal(flatten_chain(32, &error), WEFT_OK);
    assert_int_equal(flatten_chain(33, &error), WEFT_INPUT);
    assert_int_equal(error.message, WEFT_MESSAGE_TEXT_DIALECT);
    assert_non_null(strstr(error.text, "own32.h"));
}

/* Without its lobe dust is a few lines that say nothing; with it, it is there without a second dispatch. */
static void text_of_dust_brings_its_lobe(void **state) {
    (void)state;
    for (int there = 0; there < 2; there++) {
        Text text;
        text_begin(&text, &(TextDesc){.language = TEXT_GLSL_330, .tables = true});
        text_dispatch(&text, (const int[]){LOBE_GGX, LOBE_LAMBERT, LOBE_LTC_FIBRE}, 2 + there);
        text_lobe_tables(&text);
        text_engine_tables(&text, NULL, 0);
        text_include(&text, "shading/material/stack_value.h");
        end_clean(&text, "dust");
        assert_int_equal(occurrences(text.bytes, "float dust_albedo(Lobe m, float cos_o) {"), 1);
        assert_int_equal(strstr(text.bytes, "ltc_fibre_value") != NULL, there);
        assert_non_null(strstr(text.bytes, "Surface dust_accumulate(Surface s, Dir n, Dir p) {"));
        text_free(&text);
    }
}

/* The files and lines that a text's lines come from are these, in words; "-" for none. */
static void assert_origins(const Text *text, const char *const *expected) {
    int lines = occurrences(text->bytes, "\n");
    for (int k = 1; k <= lines + 1; k++) {
        char origin[256] = "-";
        Origin found = text_origin(text, k);
        bool blank = false;
        const char *c = text->bytes;
        for (int n = 1; n < k && c; n++) c = strchr(c, '\n') + 1;
        blank = *c == '\n';
        if (blank) continue;
        if (found.file) snprintf(origin, sizeof origin, "%s:%d", found.file, found.line);
        if (!*expected) fail_msg("line %d is one too many: %.60s", k, c);
        if (strcmp(origin, *expected) != 0)
            fail_msg("line %d, \"%.*s\": %s, not %s", k, (int)strcspn(c, "\n"), c, origin, *expected);
        expected++;
    }
    assert_null(*expected);
}

/* Through comments, blank and joined lines, macros, conditions, records, enumerations and includes. */
static void lines_are_traced_to_their_file(void **state) {
    (void)state;
    char inner[256], own[256], places[32][280];
    const char *expected[32];
    write_overlay("inner.h", "/* two\n   lines */ float before;\n\n#define ROWS(P) P(a) \\\n    P(b)\n");
    write_overlay("own.h",                               /* line */
                  "/* own.h - what it is\n"              /*  1 */
                  " *\n"                                 /*  2 */
                  " * more */\n"                         /*  3 */
                  "\n\n"                                 /*  4 */
                  "#include \"shading/inner.h\"\n"       /*  6 */
                  "#define ROW(name) float name;\n"      /*  7 */
                  "STRUCT(Own) {\n"                      /*  8 */
                  "    /* of the table */\n"             /*  9 */
                  "    ROWS(ROW)\n"                      /* 10 */
                  "    float c; // one more\n"           /* 11 */
                  "};\n"                                 /* 12 */
                  "enum { ONE,\n"                        /* 13 */
                  "       /* then */ TWO };\n"           /* 14 */
                  "#define LONG(x) ((x) * \\\n"          /* 15 */
                  "    (x))\n"                           /* 16 */
                  "#define HALF 0.5f\n"                  /* 17 */
                  "#ifdef NOT_THERE\n"                   /* 18 */
                  "float wrong;\n"                       /* 19 */
                  "#else\n"                              /* 20 */
                  "FN float own_f(Own m,\n"              /* 21 */
                  "               float x) { /* it\n"    /* 22 */
                  "        goes on */\n"                 /* 23 */
                  "\n"                                   /* 24 */
                  "    float y = LONG(x) * /* here */\n" /* 25 */
                  "              LONG(m.a\n"             /* 26 */
                  "                   + 1.0f);\n"        /* 27 */
                  "    /* the line\n     * below */\n"   /* 28 */
                  "    return y + LONG(x);\r\n"          /* 30 */
                  "}\n"                                  /* 31 */
                  "#endif\n");                           /* 32 */
    static const char *const in_order[] = {"-",  "i2", "8",  "10", "10", "11", "12", "13", "14", "17", "21",
                                           "22", "25", "25", "26", "26", "26", "26", "30", "30", "31", "-"};
    enum { COUNT = sizeof in_order / sizeof in_order[0] };
    Text text;
    snprintf(inner, sizeof inner, "%s/shading/inner.h", overlay);
    snprintf(own, sizeof own, "%s/shading/own.h", overlay);
    for (int k = 0; k < COUNT; k++) {
        const char *c = in_order[k];
        bool included = *c == 'i';
        snprintf(places[k], sizeof places[k], *c == '-' ? "-" : "%s:%s", included ? inner : own, c + included);
        expected[k] = places[k];
    }
    expected[COUNT] = "-"; /* there is no such line */
    expected[COUNT + 1] = NULL;
    text_begin(&text, &(TextDesc){.language = TEXT_GLSL_330, .folder = overlay});
    text_include(&text, "shading/own.h");
    text_line(&text, "float mine;");
    assert_int_equal(text_end(&text, NULL), WEFT_OK);
    assert_origins(&text, expected);
    assert_null(text_origin(&text, 0).file);
    assert_null(text_origin(&text, -1).file);
    assert_null(text_origin(&text, 1000000).file);
    text_free(&text);
}

/* The only line of a file that holds these words and does not go on as a macro's; 0 where there is none or another. */
static int only_line_with(const char *bytes, const char *words, size_t size) {
    int line = 1, found = 0;
    for (const char *c = bytes; *c; line += *c++ == '\n')
        if (strncmp(c, words, size) == 0 && c[size + strspn(c + size, " ")] != '\\') {
            if (found) return 0;
            found = line;
        }
    return found;
}

/* Whatever stands in a text as it does in its file is where the text says. */
static void catalogue_lines_are_found_by_file_and_line(void **state) {
    (void)state;
    Text text;
    int ids[LOBE_COUNT], count = gpu_lobes(ids), line = 1, found = 0;
    text_begin(&text, &(TextDesc){.language = TEXT_GLSL_330, .tables = true});
    text_dispatch(&text, ids, count);
    text_engine_tables(&text, NULL, 0);
    text_include(&text, "shading/material/stack_value.h");
    end_clean(&text, "lobes");
    for (const char *c = text.bytes; *c; line++) {
        size_t size = strcspn(c, "\n"), blank = strspn(c, " ");
        Origin origin = text_origin(&text, line);
        const CatalogueFile *file = catalogue_files;
        while (origin.file && strcmp(file->name, origin.file) != 0) file++;
        int only = origin.file && size > blank + 20 ? only_line_with(file->bytes, c + blank, size - blank) : 0;
        if (only && only != origin.line) fail_msg("%s:%d, not %d: %.*s", origin.file, origin.line, only, (int)size, c);
        found += only > 0;
        c += size + 1;
    }
    text_free(&text);
    print_message("%d of %d lines\n", found, line);
    assert_true(found > 500);
}

/* A file of the caller's may stand on the dispatch, as registry.h serves C; own lines may take a file's
 * place. */
static void lines_of_the_caller_may_replace_a_file(void **state) {
    (void)state;
    write_overlay("own.h",
                  "#include \"shading/catalogue/registry.h\"\n#include \"shading/mine.h\"\n"
                  "FN float own_f(int id, Lobe m, Angles a, Table t) {\n"
                  "    return id == LOBE_GGX ? lobe_f(m, a) * table_texel(t, 1, 0, LOBE_PARAMS_MAX) : mine(m);\n}\n");
    Batch batch;
    batch_begin(&batch);
    for (int l = 0; l < LANGUAGES; l++) {
        Text text;
        text_begin(&text, &(TextDesc){.language = languages[l], .tables = true, .folder = overlay});
        text_dispatch(&text, (const int[]){LOBE_GGX, LOBE_LAMBERT, LOBE_GGX}, 3);
        text_provide(&text, "shading/mine.h");
        text_line(&text, "\nfloat mine(Lobe m) { return m.params[%d]; }", 2);
        text_include(&text, "shading/own.h");
        put_main(&text, "color = u[0];");
        end_clean(&text, "own.h");
        assert_int_equal(occurrences(text.bytes, "const int LOBE_GGX"), 1);
        assert_non_null(strstr(text.bytes, "float own_f(int id, Lobe m, Angles a, int t) {"));
        batch_add(&batch, "own", languages[l], text.bytes);
        text_free(&text);
    }
    int status = batch_compile(&batch);
    if (!has_validator()) skip();
    assert_int_equal(status, 0);
}

int main(void) {
    if (!has_validator()) print_message("glslangValidator is not installed: nothing is compiled\n");
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(text_of_every_lobe_is_valid_glsl),
        cmocka_unit_test(text_of_every_term_is_valid_glsl),
        cmocka_unit_test(text_of_a_surface_is_valid_glsl),
        cmocka_unit_test(text_of_every_composition_is_valid_glsl),
        cmocka_unit_test(text_that_is_not_glsl_is_found),
        cmocka_unit_test(file_included_twice_stands_once),
        cmocka_unit_test_setup_teardown(macros_are_expanded_in_the_text, make_overlay, NULL),
        cmocka_unit_test(references_become_parameters_that_are_read_or_written),
        cmocka_unit_test(conditional_expression_of_records_is_absent),
        cmocka_unit_test(text_outside_the_dialect_is_refused),
        cmocka_unit_test(endless_text_is_refused),
        cmocka_unit_test(includes_nested_too_deep_are_refused),
        cmocka_unit_test(lines_are_traced_to_their_file),
        cmocka_unit_test(catalogue_lines_are_found_by_file_and_line),
        cmocka_unit_test(text_of_dust_brings_its_lobe),
        cmocka_unit_test_setup_teardown(lines_of_the_caller_may_replace_a_file, NULL, remove_overlay),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
