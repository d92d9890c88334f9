/* What weft_export promises of every text: it says what it is, is readable, has what is needed and nothing
 * else; folded or explicit, pi gives one picture; a descriptor that makes no sense is refused
 *
 * Labels: unsanitized */
#include "base/pi.h"
#include "export/models.h"
#include "scratch.h"

#include <dlfcn.h>

static Exported models[MODELS_MAX];
static int model_count;
static WeftExport made_texts[MODELS_MAX][WEFT_EXPORT_TARGETS]; /* what was asked for so far */

/* Returns a model's text in a target, which is made once for all tests: tables of E take long. */
static const WeftExport *text_of(int model, int target) {
    WeftExport *made = &made_texts[model][target];
    if (made->text) return made;
    WeftExportDesc desc = model_desc(&models[model], (WeftExportTarget)target);
    if (target != WEFT_EXPORT_ESSL) desc.albedo = 0;
    *made = model_export(&desc);
    return made;
}

/* Every lobe and cloth, and a fourth of all profiles, choices and presets, whose tables take long; the long run has all. */
static bool is_asked(int model) {
    return models[model].is_lobe || models[model].cloth || getenv("WEFT_TEST_LONG") || model % 4 == 0;
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

static int end(void **state) {
    (void)state;
    for (int k = 0; k < model_count; k++)
        for (int t = 0; t < WEFT_EXPORT_TARGETS; t++) weft_export_free(&made_texts[k][t]);
    return 0;
}

static void assert_text(const Exported *s, const char *target, const char *text) {
    static const char *const banned[] = {"#if ", "#elif", "STRUCT(", "FN ", " \n", "/*@", "/*!", "\t"};
    for (size_t k = 0; k < sizeof banned / sizeof banned[0]; k++)
        if (strstr(text, banned[k]))
            fail_msg("%s, %s: \"%s\": %.60s", s->id, target, banned[k], strstr(text, banned[k]));
    static const char *const wanted[] = {"SPDX-License-Identifier: MIT", "Conventions", "pi: EXPLICIT"};
    for (size_t k = 0; k < sizeof wanted / sizeof wanted[0]; k++)
        if (!strstr(text, wanted[k])) fail_msg("%s, %s: no \"%s\"", s->id, target, wanted[k]);
    int defines = 0; /* a header's guard, and no other */
    for (const char *c = text; (c = strstr(c, "#define")); c++) defines++;
    assert_true(defines <= 1);
}

static void exported_text_has_no_macro_or_include(void **state) {
    (void)state;
    for (int k = 0; k < model_count; k++) {
        const Exported *s = &models[k];
        if (!is_asked(k)) continue;
        for (int t = 0; t < WEFT_EXPORT_TARGETS; t++) {
            if (!s->is_lobe && t != WEFT_EXPORT_SHADERTOY && !getenv("WEFT_TEST_LONG")) continue;
            const WeftExport *made = text_of(k, t);
            assert_int_equal(made->size, strlen(made->text));
            assert_text(s, weft_export_target_name(t), made->text);
            if (s->is_lobe && t != WEFT_EXPORT_SHADERTOY) assert_non_null(strstr(made->text, "Example"));
            if (t == WEFT_EXPORT_SHADERTOY) assert_non_null(strstr(made->text, "void mainImage(out vec4 pixel"));
        }
    }
}

/* A text has the functions that its model calls, and no others: each name is there twice or more. */
static void exported_text_has_no_unused_function(void **state) {
    (void)state;
    for (int k = 0; k < model_count && models[k].is_lobe; k++) {
        const char *text = text_of(k, WEFT_EXPORT_C)->text;
        for (const char *c = text; (c = strstr(c, "\nstatic inline ")); c++) {
            char name[128];
            const char *open = strchr(c, '('), *start = open;
            while (start[-1] != ' ') start--;
            snprintf(name, sizeof name, "%.*s", (int)(open - start) + 1, start);
            int found = 0;
            for (const char *at = text; (at = strstr(at, name)); at++) found++;
            if (found < 2) fail_msg("%s: nothing calls %s)", models[k].id, name);
        }
    }
}

static bool is_word(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' || (c >= '0' && c <= '9');
}

/* The text without its comments, to be freed. */
static char *code_of(const char *text) {
    char *code = calloc(strlen(text) + 1, 1);
    size_t size = 0;
    assert_non_null(code);
    for (const char *c = text; *c; c++) {
        if (c[0] == '/' && c[1] == '*')
            c = strstr(c, "*/") + 1;
        else
            code[size++] = *c;
    }
    return code;
}

static int count_word(const char *code, const char *word) {
    int count = 0;
    size_t size = strlen(word);
    for (const char *c = code; (c = strstr(c, word)); c += size)
        count += (c == code || !is_word(c[-1])) && !is_word(c[size]);
    return count;
}

/* Each name that "struct NAME {" gives is used again. */
static void assert_records_used(const Exported *s, const char *code) {
    for (const char *c = code; (c = strstr(c, "struct ")); c++) {
        char name[96];
        const char *end = c + 7;
        while (is_word(*end)) end++;
        snprintf(name, sizeof name, "%.*s", (int)(end - c) - 7, c + 7);
        if (count_word(code, name) < 2) fail_msg("%s: nothing uses record %s", s->id, name);
    }
}

/* How many records deep the record of that name is, itself counted. */
static int nesting_of(const char *code, const char *name, size_t size) {
    char head[112];
    snprintf(head, sizeof head, "struct %.*s {", (int)size, name);
    const char *c = strstr(code, head), *end = c ? strchr(c, '}') : NULL;
    int deepest = 0;
    for (c = c ? c + strlen(head) : NULL; c && c < end; c++) {
        if (!is_word(*c)) continue;
        const char *word = c;
        while (is_word(*c)) c++;
        int deep = nesting_of(code, word, (size_t)(c - word));
        deepest = deep > deepest ? deep : deepest;
    }
    return end ? 1 + deepest : 0;
}

/* WebGL takes records in four levels and no more: "WebGL Specification", version 1.0.3, section 6.19. */
static void records_nest_as_webgl_takes_them(void **state) {
    (void)state;
    for (int k = 0; k < model_count; k++) {
        if (!is_asked(k)) continue;
        for (int toy = 0; toy < 2; toy++) {
            char *code = code_of(text_of(k, toy ? WEFT_EXPORT_SHADERTOY : WEFT_EXPORT_ESSL)->text);
            for (const char *c = code; (c = strstr(c, "struct ")); c++) {
                size_t size = strcspn(c + 7, " ");
                int deep = nesting_of(code, c + 7, size);
                if (deep > 4) fail_msg("%s: %.*s is %d deep", models[k].id, (int)size, c + 7, deep);
            }
            free(code);
        }
    }
}

/* Compilers of HLSL make no vector of a single number by a call, though glslangValidator does: it is cast. */
static void assert_vectors_cast(const Exported *s, const char *code) {
    for (const char *c = code; (c = strstr(c, "float3(")); c++) {
        int depth = 0, commas = 0;
        for (const char *at = c + 6; *at && (depth += (*at == '(') - (*at == ')')) > 0; at++)
            commas += depth == 1 && *at == ',';
        if (commas != 2) fail_msg("%s: %.40s", s->id, c);
    }
}

/* No name of a language's own, no call where it has an operator, no number in the notation of C, no record
 * that is filled or idle. */
static void exported_text_uses_operators_of_its_language(void **state) {
    (void)state;
    static const char *const banned[] = {"rgb_add(", "rgb_mul(",   "rgb_scale(", "rgb_grey(", "rgb_mix(",   "dir_dot(",
                                         "dir_add(", "dir_scale(", "weft_dir(",  "weft_rgb(", "dir_mirror("};
    /* The OpenGL Shading Language 4.60, section 3.6; HLSL, appendix "Reserved words". */
    static const char *const reserved[] = {
        "common",   "partition", "active",  "asm",       "class",     "union",    "enum",   "typedef", "template",
        "this",     "resource",  "goto",    "inline",    "noinline",  "public",   "extern", "long",    "short",
        "half",     "fixed",     "input",   "output",    "filter",    "cast",     "using",  "sample",  "patch",
        "point",    "line",      "linear",  "pass",      "matrix",    "vector",   "string", "export",  "shared",
        "triangle", "technique", "precise", "interface", "namespace", "register", "compile"};
    for (int k = 0; k < model_count; k++) {
        const Exported *s = &models[k];
        if (!s->is_lobe && !s->cloth && !getenv("WEFT_TEST_LONG") && k % 6) continue;
        for (int t = WEFT_EXPORT_GLSL; t <= WEFT_EXPORT_HLSL; t++) {
            char *code = code_of(text_of(k, t)->text);
            for (size_t n = 0; n < sizeof banned / sizeof *banned; n++)
                if (strstr(code, banned[n])) fail_msg("%s: %.60s", s->id, strstr(code, banned[n]));
            for (size_t n = 0; n < sizeof reserved / sizeof *reserved; n++)
                if (count_word(code, reserved[n])) fail_msg("%s: %s is a word of a language", s->id, reserved[n]);
            if (s->is_lobe && strstr(code, "inout")) fail_msg("%s: %.60s", s->id, strstr(code, "inout"));
            for (const char *c = code; *c; c++)
                if (c > code && *c == 'f' && c[-1] >= '0' && c[-1] <= '9' && !is_word(c[1])) {
                    const char *first = c;
                    while (first > code && (is_word(first[-1]) || first[-1] == '.')) first--;
                    if (*first >= '0' && *first <= '9') fail_msg("%s: %.12s", s->id, first);
                }
            assert_records_used(s, code);
            if (t == WEFT_EXPORT_HLSL) assert_vectors_cast(s, code);
            free(code);
        }
    }
}

/* C with pi folded, times a light over pi, against C with pi explicit, times the light. */
static void folded_and_explicit_pi_agree(void **state) {
    (void)state;
    char folder[SCRATCH_SIZE], path[128], command[256];
    static const char *const ids[] = {"charlie-neubelt", "ggx", "fibre", "filament-cloth", "unreal4"};
    if (system("command -v gcc >/dev/null 2>&1") != 0) skip();
    assert_true(scratch_make(folder));
    snprintf(path, sizeof path, "%s/pi.c", folder);
    FILE *stream = fopen(path, "wb");
    assert_non_null(stream);
    for (int k = 0; k < 5; k++)
        for (int fold = 0; fold < 2; fold++) {
            const Exported *s = NULL;
            char prefix[16], id[64];
            for (int n = 0; n < model_count; n++)
                if (!models[n].fixed && strcmp(models[n].id, ids[k]) == 0) s = &models[n];
            assert_non_null(s);
            snprintf(prefix, sizeof prefix, "%c%d_", fold ? 'f' : 'e', k);
            WeftExportDesc desc = model_desc(s, WEFT_EXPORT_C);
            desc.albedo = 0;
            desc.prefix = prefix;
            desc.fold_pi = fold;
            WeftExport made = model_export(&desc);
            assert_non_null(strstr(made.text, fold ? "pi: FOLDED" : "pi: EXPLICIT"));
            fputs(made.text, stream);
            snprintf(id, sizeof id, "%s", ids[k]);
            for (char *c = id; *c; c++)
                if (*c == '-') *c = '_';
            char big = fold ? 'F' : 'E';
            fprintf(stream,
                    "\nfloat run_%s%d(float light);\nfloat run_%s%d(float light) {\n"
                    "  %c%dDir o = {0.6f, 0.0f, 0.8f}, i = {-0.48f, 0.64f, 0.6f};\n",
                    fold ? "f" : "e", k, fold ? "f" : "e", k, big, k);
            if (s->is_lobe) {
                bool two = weft_lobe_info(s->lobe.lobe)->traits & WEFT_LOBE_TWO_COLORS;
                fprintf(stream,
                        "  %c%dRgb c = {0.5f, 0.5f, 0.5f};\n  return %s%s_eval(%s%s_default(), c, %so, i).g "
                        "* i.z * light;\n}\n",
                        big, k, prefix, id, prefix, id, two ? "c, " : "");
            } else {
                fprintf(stream, "  return %s%s_shade(%s%s_surface(), o, i).g * light;\n}\n", prefix, id, prefix, id);
            }
            weft_export_free(&made);
        }
    assert_int_equal(fclose(stream), 0);
    snprintf(command, sizeof command, "cd %s && gcc -std=c99 -O1 -shared -fPIC pi.c -o pi.so -lm", folder);
    assert_int_equal(system(command), 0);
    snprintf(path, sizeof path, "%s/pi.so", folder);
    void *library = dlopen(path, RTLD_NOW);
    assert_non_null(library);
    for (int k = 0; k < 5; k++) {
        union {
            void *symbol;
            float (*run)(float light);
        } whole, folded;
        char name[16];
        snprintf(name, sizeof name, "run_e%d", k);
        assert_non_null(whole.symbol = dlsym(library, name));
        snprintf(name, sizeof name, "run_f%d", k);
        assert_non_null(folded.symbol = dlsym(library, name));
        float a = whole.run(2.5f), b = folded.run(2.5f / PI_FLOAT);
        assert_true(a > 1e-4f);
        if (fabsf(a - b) > 1e-5f * a) fail_msg("%s: %.8g and %.8g", ids[k], (double)a, (double)b);
    }
    dlclose(library);
    assert_true(scratch_remove(folder));
}

/* One text of several models, and each in a text of its own, beside each other in one program of C. */
static void several_models_share_one_text(void **state) {
    (void)state;
    enum { COUNT = 5 };
    static const char *const ids[COUNT] = {"khronos", "disney", "hdrp-cotton", "ggx", "charlie-neubelt"};
    char folder[SCRATCH_SIZE], path[128], command[256];
    WeftExportDesc descs[COUNT];
    WeftExport made;
    WeftError error;
    if (system("command -v gcc >/dev/null 2>&1") != 0) skip();
    assert_true(scratch_make(folder));
    snprintf(path, sizeof path, "%s/all.c", folder);
    FILE *stream = fopen(path, "wb");
    assert_non_null(stream);
    size_t apart = 0;
    for (int k = 0; k < COUNT; k++) {
        const Exported *s = NULL;
        for (int n = 0; n < model_count; n++)
            if (!models[n].fixed && strcmp(models[n].id, ids[k]) == 0) s = &models[n];
        assert_non_null(s);
        char prefix[16];
        snprintf(prefix, sizeof prefix, "p%d_", k);
        descs[k] = model_desc(s, WEFT_EXPORT_C);
        descs[k].albedo = 0;
        descs[k].prefix = prefix;
        made = model_export(&descs[k]);
        descs[k].prefix = "all_";
        apart += made.size;
        fputs(made.text, stream);
        weft_export_free(&made);
    }
    if (weft_export_all(descs, COUNT, &made, &error) != WEFT_OK) fail_msg("%s", error.text);
    assert_true(made.size < apart);
    fputs(made.text, stream);
    weft_export_free(&made);
    fprintf(stream, "\nint differ(void);\nint differ(void) {\n  int wrong = 0;\n  for (int n = 1; n < 40; n++) {\n"
                    "    float t = 0.038f * (float)n, q = 1.3f * (float)n;\n"
                    "    All_Dir x = {sinf(t), 0.0f, cosf(t)}, y = {sinf(t) * cosf(q), sinf(t) * sinf(q), cosf(t)};\n");
    for (int k = 0; k < COUNT; k++) {
        char id[32];
        snprintf(id, sizeof id, "%s", ids[k]);
        for (char *c = id; *c; c++)
            if (*c == '-') *c = '_';
        fprintf(stream, "    { P%d_Dir o = {x.x, x.y, x.z}, i = {y.x, y.y, y.z};\n", k);
        if (descs[k].lobe) {
            bool two = weft_lobe_info(descs[k].lobe->lobe)->traits & WEFT_LOBE_TWO_COLORS;
            fprintf(stream,
                    "      P%d_Rgb c = {0.5f, 0.4f, 0.3f}; All_Rgb d = {0.5f, 0.4f, 0.3f};\n"
                    "      wrong += p%d_%s_eval(p%d_%s_default(), c, %so, i).g != "
                    "all_%s_eval(all_%s_default(), d, "
                    "%sx, y).g; }\n",
                    k, k, id, k, id, two ? "c, " : "", id, id, two ? "d, " : "");
        } else {
            fprintf(stream,
                    "      wrong += p%d_%s_shade(p%d_%s_surface(), o, i).g != "
                    "all_%s_shade(all_%s_surface(), x, y).g; }\n",
                    k, id, k, id, id, id);
        }
    }
    fprintf(stream, "  }\n  return wrong;\n}\n");
    assert_int_equal(fclose(stream), 0);
    snprintf(command, sizeof command,
             "cd %s && sed -i 's/\\bP\\([0-9]\\)_/P\\1/g; s/\\bAll_/All/g' all.c && "
             "gcc -std=c99 -O1 -ffp-contract=off -shared -fPIC all.c -o all.so -lm",
             folder);
    assert_int_equal(system(command), 0);
    snprintf(path, sizeof path, "%s/all.so", folder);
    void *library = dlopen(path, RTLD_NOW);
    assert_non_null(library);
    union {
        void *symbol;
        int (*run)(void);
    } differ = {.symbol = dlsym(library, "differ")};
    assert_non_null(differ.symbol);
    assert_int_equal(differ.run(), 0);
    dlclose(library);
    assert_true(scratch_remove(folder));
    descs[1] = descs[0]; /* no two by one name */
    assert_int_not_equal(weft_export_all(descs, 2, &made, &error), WEFT_OK);
    assert_int_equal(error.message, WEFT_MESSAGE_DESC);
    descs[1] = (WeftExportDesc){.profile = "disney", .target = WEFT_EXPORT_GLSL};
    assert_int_not_equal(weft_export_all(descs, 2, &made, &error), WEFT_OK);
    assert_int_not_equal(weft_export_all(descs, 0, &made, &error), WEFT_OK);
    assert_int_not_equal(weft_export_all(descs, WEFT_EXPORT_MODELS_MAX + 1, &made, &error), WEFT_OK);
}

/* GLSL keeps names with "__" for itself, and any program may call a material anything. */
static void exported_names_have_no_two_underscores(void **state) {
    (void)state;
    static const char *const names[] = {"my  cloth", "__", "-rim-", "9 lives_", "\xc3\xa9t\xc3\xa9"};
    WeftMaterial material;
    WeftError error;
    weft_material_default(&material);
    for (int target = 0; target < WEFT_EXPORT_TARGETS; target++)
        for (size_t k = 0; k < sizeof names / sizeof *names; k++) {
            const WeftExportDesc desc = {.target = (WeftExportTarget)target,
                                         .material = &material,
                                         .name = names[k],
                                         .prefix = k % 2 ? "" : NULL};
            WeftExport made;
            if (weft_export(&desc, &made, &error) != WEFT_OK) fail_msg("%s", error.text);
            const char *code = strstr(made.text, "*/"), *twice = code ? strstr(code, "__") : NULL;
            if (twice) fail_msg("%s: %.40s", names[k], twice);
            weft_export_free(&made);
        }
}

static void export_descriptors_without_sense_are_refused(void **state) {
    (void)state;
    WeftLobe ggx, walk, none = {.lobe = 9999};
    WeftMaterial material;
    WeftExport out;
    WeftError error;
    assert_int_equal(weft_lobe_init("ggx", &ggx, NULL), WEFT_OK);
    assert_int_equal(weft_lobe_init("fibre-walk", &walk, NULL), WEFT_OK);
    memset(&material, 0, sizeof material);
    material.inputs[0].value[0] = (float)NAN;
    const struct {
        WeftExportDesc desc;
        WeftMessage message;
    } cases[] = {
        {{0}, WEFT_MESSAGE_DESC},
        {{.lobe = &ggx, .profile = "khronos"}, WEFT_MESSAGE_DESC},
        {{.lobe = &ggx, .target = WEFT_EXPORT_TARGETS}, WEFT_MESSAGE_DESC},
        {{.lobe = &ggx, .lut = WEFT_EXPORT_LUTS}, WEFT_MESSAGE_DESC},
        {{.lobe = &ggx, .prefix = "1x"}, WEFT_MESSAGE_DESC},
        {{.lobe = &ggx, .prefix = "a_prefix_that_is_far_too_long_"}, WEFT_MESSAGE_DESC},
        {{.lobe = &ggx, .right = &ggx}, WEFT_MESSAGE_DESC},
        {{.lobe = &walk}, WEFT_MESSAGE_EXPORT_LOBE},
        {{.lobe = &ggx, .right = &walk, .target = WEFT_EXPORT_SHADERTOY}, WEFT_MESSAGE_EXPORT_LOBE},
        {{.lobe = &none}, WEFT_MESSAGE_LOBE_NAME},
        {{.profile = "none"}, WEFT_MESSAGE_CHECK_NAME},
        {{.profile = "no-such"}, WEFT_MESSAGE_CHECK_NAME},
        {{.material = &material}, WEFT_MESSAGE_PARAM_VALUE},
    };
    for (size_t k = 0; k < sizeof cases / sizeof cases[0]; k++) {
        assert_int_not_equal(weft_export(&cases[k].desc, &out, &error), WEFT_OK);
        if (error.message != cases[k].message) fail_msg("%zu: %s", k, error.text);
        assert_null(out.text);
        assert_int_equal(out.table_count, 0);
    }
    weft_export_free(&out);
    weft_export_free(NULL);
}

/* Exports a draft of that notation. Returns the error's message, or "" where there is a text. */
static const char *woven_refusal(const char *notation, WeftExportTarget target, WeftExportLut lut, WeftError *error) {
    WeftDraft *draft = NULL;
    WeftCloth *cloth = NULL;
    WeftYarn yarns[2];
    WeftMaterial material;
    WeftExport made;
    weft_material_default(&material);
    for (int t = 0; t < 2; t++) assert_int_equal(weft_yarn_find("cotton", &yarns[t], error), WEFT_OK);
    if (weft_draft_parse(notation, &draft, error) != WEFT_OK ||
        weft_cloth_create(draft, yarns, 0, &cloth, error) != WEFT_OK)
        fail_msg("%s", error->text);
    const WeftExportDesc desc = {.material = &material, .cloth = cloth, .name = "cloth", .target = target, .lut = lut};
    const WeftResult result = weft_export(&desc, &made, error);
    assert_true((result == WEFT_OK) == (made.text != NULL));
    weft_export_free(&made);
    weft_cloth_free(cloth);
    weft_draft_free(draft);
    return result == WEFT_OK ? "" : error->text;
}

static void draft_that_a_target_cannot_hold_is_refused_with_what_to_do(void **state) {
    (void)state;
    static const char small[] = "twill 2/2 z", middle[] = "satin 37/8", wide[] = "plain; warp 2099k 1r";
    static const char large[] = "plain; warp 599k 1r; weft 599k 1r";
    static const struct {
        const char *draft;
        WeftExportTarget target;
        WeftExportLut lut;
        const char *words; /* of the refusal; "": there is a text */
    } cases[] = {{small, WEFT_EXPORT_SHADERTOY, WEFT_EXPORT_LUT_C, ""},
                 {middle, WEFT_EXPORT_SHADERTOY, WEFT_EXPORT_LUT_C, "take another target, or a smaller draft"},
                 {middle, WEFT_EXPORT_C, WEFT_EXPORT_LUT_C, ""},
                 {large, WEFT_EXPORT_C, WEFT_EXPORT_LUT_C, "put them beside it with --lut exr"},
                 {large, WEFT_EXPORT_C, WEFT_EXPORT_LUT_EXR, ""},
                 {wide, WEFT_EXPORT_WGSL, WEFT_EXPORT_LUT_EXR, "at most 8192 a side"},
                 {wide, WEFT_EXPORT_GLSL, WEFT_EXPORT_LUT_EXR, ""}};
    WeftError error;
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        const char *refusal = woven_refusal(cases[k].draft, cases[k].target, cases[k].lut, &error);
        if (!*cases[k].words == !!*refusal || !strstr(refusal, cases[k].words))
            fail_msg("%s, %s: \"%s\"", cases[k].draft, weft_export_target_name((int)cases[k].target), refusal);
    }
    WeftExport made;
    assert_int_not_equal(
        weft_export(&(WeftExportDesc){.profile = "khronos", .cloth = models[model_count - 1].cloth}, &made, &error),
        WEFT_OK);
    assert_int_equal(error.message, WEFT_MESSAGE_DESC);
}

/* Each line of a text that begins so. */
static int count_lines(const char *text, const char *begin) {
    int count = strncmp(text, begin, strlen(begin)) == 0;
    for (const char *c = text; (c = strchr(c, '\n')); c++) count += strncmp(c + 1, begin, strlen(begin)) == 0;
    return count;
}

static void assert_has(const char *id, const char *text, const char *wanted) {
    if (!strstr(text, wanted)) fail_msg("%s: no \"%s\"", id, wanted);
}

/* The files of engines have what those ask for: names, guards, uniforms; and their tables are where they can be read. */
static void texts_of_engines_are_laid_out_as_these_load_them(void **state) {
    (void)state;
    WeftLobe fuzz, ggx;
    WeftError error;
    assert_int_equal(weft_lobe_init("ltc-fibre", &fuzz, NULL), WEFT_OK);
    assert_int_equal(weft_lobe_init("ggx", &ggx, NULL), WEFT_OK);
    const WeftExportDesc descs[] = {{.lobe = &fuzz}, {.lobe = &ggx}, {.profile = "khronos"}};
    static const char *const names[] = {"weft_ltc_fibre", "weft_ggx", "weft_khronos"};
    for (size_t k = 0; k < sizeof descs / sizeof *descs; k++) {
        WeftExportDesc desc = descs[k];
        WeftExport made;
        char wanted[96];
        desc.target = WEFT_EXPORT_UNITY;
        assert_int_equal(weft_export(&desc, &made, &error), WEFT_OK);
        snprintf(wanted, sizeof wanted, "\nvoid %s_float(\n", names[k]);
        assert_has(names[k], made.text, wanted);
        snprintf(wanted, sizeof wanted, "\nvoid %s_half(\n", names[k]);
        assert_has(names[k], made.text, wanted);
        assert_has(names[k], made.text, "float3 Wo, float3 Wi, out float3 Out)");
        if (desc.profile) assert_has(names[k], made.text, "    float3 SheenColor,\n    float SheenRoughness,\n");
        assert_int_equal(count_lines(made.text, "#ifndef "), 1);
        assert_int_equal(count_lines(made.text, "#endif"), 1);
        assert_int_equal(made.table_count, 0);
        weft_export_free(&made);
        desc.target = WEFT_EXPORT_UNREAL;
        assert_int_equal(weft_export(&desc, &made, &error), WEFT_OK);
        assert_int_equal(count_lines(made.text, "#pragma once"), 1);
        assert_null(strstr(made.text, "Texture2D")); /* which a Custom node could not bind */
        assert_int_equal(made.table_count, 0);
        weft_export_free(&made);
        desc.target = WEFT_EXPORT_GODOT;
        assert_int_equal(weft_export(&desc, &made, &error), WEFT_OK);
        char *code = code_of(made.text);
        assert_null(strchr(code, '#'));
        assert_null(strstr(code, "highp"));
        int uniforms = 0;
        for (const char *c = code; (c = strstr(c, "uniform ")); c++) uniforms++;
        assert_int_equal(uniforms, made.table_count);
        if (uniforms) assert_has(names[k], code, " : filter_nearest, repeat_disable;");
        free(code);
        weft_export_free(&made);
    }
}

/* Compiles a text that has no entry of its own. Godot's language is that of GLSL ES 3.00 but for hints of uniforms. */
static void compile(const char *text, WeftExportTarget target) {
    static const char hint[] = " : filter_nearest, repeat_disable";
    FILE *file = fopen("text.frag", "w");
    assert_non_null(file);
    if (target == WEFT_EXPORT_GODOT) fprintf(file, "#version 300 es\nprecision highp float;\n");
    for (const char *c = text; *c; c++) {
        if (target == WEFT_EXPORT_GODOT && strncmp(c, hint, sizeof hint - 1) == 0) c += sizeof hint - 1;
        fputc(*c, file);
    }
    fprintf(file, target == WEFT_EXPORT_GODOT ? "out vec4 pixel;\nvoid main() { pixel = vec4(1.0); }\n"
                                              : "\nfloat4 main() : SV_Target { return 1.0; }\n");
    assert_int_equal(fclose(file), 0);
    const char *command = target == WEFT_EXPORT_GODOT
                              ? "glslangValidator -S frag text.frag >log 2>&1"
                              : "glslangValidator -D -V -e main -S frag text.frag -o t.spv >log 2>&1";
    if (system(command) != 0) fail_msg("%s: %s", weft_export_target_name((int)target), command);
}

static void texts_of_engines_compile(void **state) {
    (void)state;
    static const WeftExportTarget targets[] = {WEFT_EXPORT_GODOT, WEFT_EXPORT_UNITY, WEFT_EXPORT_UNREAL};
    char folder[SCRATCH_SIZE];
    if (system("command -v glslangValidator >/dev/null 2>&1") != 0) skip();
    assert_true(scratch_enter(folder));
    for (int k = 0; k < model_count; k++)
        for (size_t t = 0; t < sizeof targets / sizeof *targets; t++)
            if (models[k].cloth || k % (models[k].is_lobe ? 5 : 16) == 0)
                compile(text_of(k, (int)targets[t])->text, targets[t]);
    assert_true(chdir("/") == 0 && scratch_remove(folder));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(exported_text_has_no_macro_or_include),
        cmocka_unit_test(exported_text_has_no_unused_function),
        cmocka_unit_test(exported_text_uses_operators_of_its_language),
        cmocka_unit_test(texts_of_engines_are_laid_out_as_these_load_them),
        cmocka_unit_test(texts_of_engines_compile),
        cmocka_unit_test(records_nest_as_webgl_takes_them),
        cmocka_unit_test(folded_and_explicit_pi_agree),
        cmocka_unit_test(several_models_share_one_text),
        cmocka_unit_test(exported_names_have_no_two_underscores),
        cmocka_unit_test(export_descriptors_without_sense_are_refused),
        cmocka_unit_test(draft_that_a_target_cannot_hold_is_refused_with_what_to_do),
    };
    return cmocka_run_group_tests(tests, begin, end);
}
