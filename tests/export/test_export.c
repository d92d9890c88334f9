/* What weft_export promises of every text: it says what it is, is readable, has what is needed and nothing
 * else; folded or explicit, pi gives one picture; a descriptor that makes no sense is refused */
#include "export/subjects.h"

#include <dlfcn.h>

static Exported subjects[SUBJECTS_MAX];
static int subject_count;

static int begin(void **state) {
    (void)state;
    subject_count = subjects_lobes(subjects);
    subject_count += subjects_profiles(subjects + subject_count);
    subject_count += subjects_choices(subjects + subject_count);
    subject_count += subjects_presets(subjects + subject_count);
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

static void texts_are_clean(void **state) {
    (void)state;
    for (int k = 0; k < subject_count; k++) {
        const Exported *s = &subjects[k];
        if (s->profile && !getenv("WEFT_TEST_LONG") && k % 4) continue; /* test_gpu makes all of them */
        for (int t = 0; t < WEFT_EXPORT_TARGETS; t++) {
            if (!s->is_lobe && t != WEFT_EXPORT_SHADERTOY && !getenv("WEFT_TEST_LONG")) continue;
            WeftExportDesc desc = subject_desc(s, (WeftExportTarget)t);
            desc.albedo = 0;
            WeftExport made = subject_export(&desc);
            assert_int_equal(made.size, strlen(made.text));
            assert_text(s, weft_export_target(t), made.text);
            if (s->is_lobe && t != WEFT_EXPORT_SHADERTOY) assert_non_null(strstr(made.text, "Example"));
            if (t == WEFT_EXPORT_SHADERTOY)
                assert_non_null(strstr(made.text, "void mainImage(out vec4 pixel"));
            weft_export_free(&made);
        }
    }
}

/* A text has the functions that its model calls, and no others: each name is there twice or more. */
static void nothing_is_idle(void **state) {
    (void)state;
    for (int k = 0; k < subject_count && subjects[k].is_lobe; k++) {
        WeftExportDesc desc = subject_desc(&subjects[k], WEFT_EXPORT_C);
        desc.albedo = 0;
        WeftExport made = subject_export(&desc);
        for (const char *c = made.text; (c = strstr(c, "\nstatic inline ")); c++) {
            char name[128];
            const char *open = strchr(c, '('), *start = open;
            while (start[-1] != ' ') start--;
            snprintf(name, sizeof name, "%.*s", (int)(open - start) + 1, start);
            int found = 0;
            for (const char *at = made.text; (at = strstr(at, name)); at++) found++;
            if (found < 2) fail_msg("%s: nothing calls %s)", subjects[k].id, name);
        }
        weft_export_free(&made);
    }
}

/* C with pi folded, times a light over pi, against C with pi explicit, times the light. */
static void pi_gives_one_picture(void **state) {
    (void)state;
    char folder[] = "/tmp/weft-test-export-XXXXXX", path[128], command[256];
    static const char *const ids[] = {"charlie-neubelt", "ggx", "fibre", "filament-cloth", "unreal4"};
    if (system("command -v gcc >/dev/null 2>&1") != 0) skip();
    assert_non_null(mkdtemp(folder));
    snprintf(path, sizeof path, "%s/pi.c", folder);
    FILE *stream = fopen(path, "wb");
    assert_non_null(stream);
    for (int k = 0; k < 5; k++)
        for (int fold = 0; fold < 2; fold++) {
            const Exported *s = NULL;
            char prefix[16], id[64];
            for (int n = 0; n < subject_count; n++)
                if (!subjects[n].fixed && strcmp(subjects[n].id, ids[k]) == 0) s = &subjects[n];
            assert_non_null(s);
            snprintf(prefix, sizeof prefix, "%c%d_", fold ? 'f' : 'e', k);
            WeftExportDesc desc = subject_desc(s, WEFT_EXPORT_C);
            desc.albedo = 0;
            desc.prefix = prefix;
            desc.fold_pi = fold;
            WeftExport made = subject_export(&desc);
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
                fprintf(stream, "  return %s%s_shade(%s%s_surface(), o, i).g * light;\n}\n", prefix, id,
                        prefix, id);
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
        float a = whole.run(2.5f), b = folded.run(2.5f / 3.14159265f);
        assert_true(a > 1e-4f);
        if (fabsf(a - b) > 1e-5f * a) fail_msg("%s: %.8g and %.8g", ids[k], (double)a, (double)b);
    }
    dlclose(library);
    snprintf(command, sizeof command, "rm -r %s", folder);
    assert_int_equal(system(command), 0);
}

/* GLSL keeps names with "__" for itself, and any program may call a material anything. */
static void no_name_has_two_underscores(void **state) {
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

static void nonsense_is_refused(void **state) {
    (void)state;
    WeftLobe ggx, walk, none = {.lobe = 9999};
    WeftMaterial material;
    WeftExport out;
    WeftError error;
    assert_int_equal(weft_lobe_create("ggx", &ggx, NULL), WEFT_OK);
    assert_int_equal(weft_lobe_create("fibre-walk", &walk, NULL), WEFT_OK);
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

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(texts_are_clean),      cmocka_unit_test(nothing_is_idle),
        cmocka_unit_test(pi_gives_one_picture), cmocka_unit_test(no_name_has_two_underscores),
        cmocka_unit_test(nonsense_is_refused),
    };
    return cmocka_run_group_tests(tests, begin, NULL);
}
