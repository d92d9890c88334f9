/* Every text of WGSL reads as WGSL: none of its reserved words, no word or mark of the other languages,
 * braces behind every condition, names that are declared once. Whether a compiler takes it is asked in a
 * browser (tests/extra/wgsl.sh).
 *
 * Labels: unsanitized */
#include "export/models.h"

static Exported models[MODELS_MAX];
static int model_count;

/* World Wide Web Consortium, "WebGPU Shading Language", section 15.4. */
static const char reserved[] =
    " NULL Self abstract active alignas alignof as asm asm_fragment async attribute auto await become cast "
    "catch class co_await co_return co_yield coherent column_major common compile compile_fragment concept "
    "const_cast consteval constexpr constinit crate debugger decltype delete demote demote_to_helper do "
    "dynamic_cast enum explicit export extends extern external fallthrough filter final finally friend from "
    "fxgroup get goto groupshared highp impl implements import inline instanceof interface layout lowp macro "
    "macro_rules match mediump meta mod module move mut mutable namespace new nil noexcept noinline "
    "nointerpolation non_coherent noncoherent noperspective null nullptr of operator package packoffset "
    "partition pass patch pixelfragment precise precision premerge priv protected pub public readonly ref "
    "regardless register reinterpret_cast require resource restrict self set shared sizeof smooth snorm "
    "static "
    "static_assert static_cast std subroutine super target template this thread_local throw trait try type "
    "typedef typeid typename typeof union unless unorm unsafe unsized use using varying virtual volatile "
    "wgsl "
    "where with writeonly yield ";
static const char foreign[] =
    " void float int uint vec2 vec3 vec4 ivec2 float2 float3 float4 Dir Rgb in out inout uniform sampler2D "
    "texelFetch Texture2D lerp fabsf ";

static bool is_word(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' || (c >= '0' && c <= '9');
}

static bool is_space(char c) { return c == ' ' || c == '\n'; }

static bool is_listed(const char *list, const char *word, size_t size) {
    char spaced[128];
    snprintf(spaced, sizeof spaced, " %.*s ", (int)size, word);
    return strstr(list, spaced) != NULL;
}

/* Comments become blanks: one in another would end late, since they nest in WGSL. */
static void blank_comments(const char *name, char *text) {
    for (char *c = text; (c = strstr(c, "/*"));) {
        char *end = strstr(c, "*/"), *inner = strstr(c + 2, "/*");
        assert_non_null(end);
        if (inner && inner < end) fail_msg("%s: a comment in a comment: %.60s", name, c);
        memset(c, ' ', (size_t)(end + 2 - c));
    }
}

static void assert_words(const char *name, const char *code) {
    for (const char *c = code; *c;) {
        size_t size = 0;
        while (is_word(c[size])) size++;
        if (size && is_listed(reserved, c, size)) fail_msg("%s: %.*s is reserved", name, (int)size, c);
        if (size && is_listed(foreign, c, size)) fail_msg("%s: %.60s", name, c);
        c += size ? size : 1;
    }
}

static void assert_marks(const char *name, const char *code) {
    static const char *const banned[] = {"?", "};", "#", "\t", "__", "(&", "(*"};
    int depth[3] = {0};
    for (size_t k = 0; k < sizeof banned / sizeof *banned; k++)
        if (strstr(code, banned[k])) fail_msg("%s: %.60s", name, strstr(code, banned[k]));
    for (const char *c = code; *c; c++) {
        static const char open[] = "({[", close[] = ")}]";
        const char *in = strchr(open, *c), *out = strchr(close, *c);
        if (in) depth[in - open]++;
        if (out && --depth[out - close] < 0) fail_msg("%s: too many %c", name, *c);
    }
    for (int k = 0; k < 3; k++)
        if (depth[k]) fail_msg("%s: brackets do not match", name);
}

/* The next word of that name, or NULL. */
static const char *find_word(const char *c, const char *word) {
    size_t size = strlen(word);
    const char *from = c;
    for (; (c = strstr(c, word)); c++)
        if ((c == from || !is_word(c[-1])) && !is_word(c[size])) return c;
    return NULL;
}

static const char *closed(const char *c) {
    int depth = 0;
    for (; *c; c++) {
        depth += (*c == '(' || *c == '{') - (*c == ')' || *c == '}');
        if (depth == 0) return c + 1;
    }
    return c;
}

static const char *solid(const char *c) {
    while (is_space(*c)) c++;
    return c;
}

static void assert_braces(const char *name, const char *code) {
    for (const char *c = code; (c = find_word(c, "if")); c++)
        if (*solid(closed(solid(c + 2))) != '{') fail_msg("%s: no brace: %.60s", name, c);
    for (const char *c = code; (c = find_word(c, "else")); c++)
        if (*solid(c + 4) != '{' && find_word(solid(c + 4), "if") != solid(c + 4))
            fail_msg("%s: no brace: %.60s", name, c);
    for (const char *c = code; (c = find_word(c, "switch")); c++) {
        const char *open = solid(closed(solid(c + 6))), *standard = find_word(open, "default");
        if (*open != '{' || !standard || standard > closed(open)) fail_msg("%s: no default: %.60s", name, c);
    }
}

/* The name behind a word that declares it is declared nowhere else: functions are not told apart by what they
 * take. */
static void assert_once(const char *name, const char *code, const char *kind) {
    for (const char *c = code; (c = find_word(c, kind)); c++) {
        const char *first = solid(c + strlen(kind));
        for (const char *d = c + 1; (d = find_word(d, kind));) {
            const char *second = solid(d + strlen(kind));
            size_t size = 0;
            while (is_word(first[size]) && first[size] == second[size]) size++;
            if (!is_word(first[size]) && !is_word(second[size]))
                fail_msg("%s: twice: %s %.*s", name, kind, (int)size, first);
            d++;
        }
    }
}

static void assert_wgsl(const char *name, const WeftExport *made) {
    char *code = strdup(made->text);
    assert_non_null(code);
    blank_comments(name, code);
    assert_words(name, code);
    assert_marks(name, code);
    assert_braces(name, code);
    assert_once(name, code, "fn");
    assert_once(name, code, "struct");
    free(code);
}

static void wgsl_text_of_every_model_is_valid(void **state) {
    (void)state;
    for (int k = 0; k < model_count; k++) {
        WeftExportDesc desc = model_desc(&models[k], WEFT_EXPORT_WGSL);
        WeftExport made = model_export(&desc);
        assert_wgsl(models[k].id, &made);
        weft_export_free(&made);
    }
}

static int find_model(const char *id) {
    for (int k = 0; k < model_count; k++)
        if (!models[k].fixed && strcmp(models[k].id, id) == 0) return k;
    fail_msg("no %s", id);
    return 0;
}

static void wgsl_text_of_several_models_is_valid(void **state) {
    (void)state;
    static const char *const ids[] = {"khronos", "disney", "ggx", "charlie-neubelt"};
    WeftExportDesc descs[4];
    WeftExport made;
    WeftError error;
    for (int k = 0; k < 4; k++) descs[k] = model_desc(&models[find_model(ids[k])], WEFT_EXPORT_WGSL);
    if (weft_export_all(descs, 4, &made, &error) != WEFT_OK) fail_msg("%s", error.text);
    assert_wgsl("several", &made);
    assert_non_null(strstr(made.text, "WeftKhronosSurface"));
    weft_export_free(&made);
}

/* Up to 2,047 texels are in the text where arrays are asked for; each of the others has a number of its own.
 */
static void small_tables_stand_in_the_wgsl_text_and_large_ones_outside(void **state) {
    (void)state;
    for (int inside = 0; inside < 2; inside++) {
        WeftExportDesc desc = model_desc(&models[find_model("babylon")], WEFT_EXPORT_WGSL);
        desc.lut = inside ? WEFT_EXPORT_LUT_C : WEFT_EXPORT_LUT_EXR;
        WeftExport made = model_export(&desc);
        bool array = strstr(made.text, " = array<f32, ") != NULL;
        for (int k = 0; k < made.table_count; k++) {
            char line[WEFT_EXPORT_NAME + 64];
            snprintf(line, sizeof line, "@group(0) @binding(%d) var %s: texture_2d<f32>;", k, made.tables[k].name);
            assert_non_null(strstr(made.text, line));
            assert_true(!inside || made.tables[k].texels.width * made.tables[k].texels.height > 2047);
        }
        assert_true(made.table_count > 0 || array);
        assert_true(inside || !array);
        weft_export_free(&made);
    }
}

static int begin(void **state) {
    (void)state;
    model_count = models_lobes(models);
    model_count += models_profiles(models + model_count);
    model_count += models_choices(models + model_count);
    model_count += models_presets(models + model_count);
    model_count += models_woven(models + model_count);
    return 0;
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(wgsl_text_of_every_model_is_valid),
        cmocka_unit_test(wgsl_text_of_several_models_is_valid),
        cmocka_unit_test(small_tables_stand_in_the_wgsl_text_and_large_ones_outside),
    };
    return cmocka_run_group_tests(tests, begin, NULL);
}
