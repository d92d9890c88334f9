/* Every lobe that the GPU has, every term and every table of albedos, over random directions and over all that
 * their numbers may be; and a wrong text, which is found
 *
 * Labels: unsanitized */
#include "raster/parity.h"

#include <sys/stat.h>

#include "scratch.h"
#include "shading/catalogue/engine_tables.h"
#include "shading/lobe/lobe_tables.h"

static void put_lobe(Text *text, int which) {
    text_dispatch(text, &which, 1);
    text_line(text, "\nconst int FIRST = %d;", which);
}

static void fill_lobe(Random *random, int which, float *row) {
    const WeftLobeInfo *info = weft_lobe_info(which);
    fill_pair(random, row);
    for (int p = 0; p < info->param_count; p++) row[8 + p] = any_param(random, &info->params[p]);
}

static void answer_lobe(int which, const float *row, float *answers) {
    Lobe lobe = {.id = which};
    memcpy(lobe.params, row + 8, sizeof lobe.params);
    LobeValue v = lobe_value(&lobe, row_angles(row));
    Dir s = lobe_sample(&lobe, row_o(row), row[3], row[7]);
    const float second = lobe_second(&lobe, 0.25f, 0.75f);
    const float all[] = {v.f, v.s, v.pdf, second, s.x, s.y, s.z, v.f * lobe_color(v, 0.25f, second)};
    memcpy(answers, all, sizeof all);
}

static const Model lobes = {
    .body = ANGLES "    Lobe m;\n    m.id = in0.w < 2.0 ? FIRST : -1;\n" /* no constant to the compiler */
                   "    for (int k = 0; k < 4; k++) {\n"
                   "        m.params[k] = in2[k];\n        m.params[k + 4] = in3[k];\n    }\n"
                   "    LobeValue v = lobe_value(m, a);\n    Dir s = lobe_sample(m, o, in0.w, in1.w);\n"
                   "    out0 = vec4(v.f, v.s, v.pdf, lobe_second(m, 0.25, 0.75));\n"
                   "    out1 = vec4(s.x, s.y, s.z, v.f * lobe_color(v, 0.25, out0.w));\n",
    .inputs = 4,
    .answers = "nnnndddn",
    .put = put_lobe,
    .fill = fill_lobe,
    .answer = answer_lobe,
};

static void lobes_in_glsl_agree_with_c(void **state) {
    (void)state;
    need_gpu();
    bool good = true;
    for (int id = 0; id < LOBE_COUNT; id++)
        if (on_gpu(id)) good &= agree(&lobes, id, weft_lobe_info(id)->id);
    assert_true(good);
}

static void fill_any_lobe(Random *random, int which, float *row) {
    int ids[LOBE_COUNT];
    int count = lobes_on_gpu(ids);
    fill_pair(random, row);
    row[8] = (float)ids[random_bits(random) % (uint32_t)count];
}

static void answer_any_lobe(int which, const float *row, float *answers) {
    Angles a = row_angles(row);
    Lobe plain = lobe_default((int)row[8]), rough = lobe_rough(plain.id, row[7]);
    LobeValue v = lobe_value(&plain, a), w = lobe_value(&rough, a);
    const float second = lobe_second(&plain, 0.25f, 0.75f);
    const float all[] = {v.f, v.s, v.pdf, second, w.f, w.s, w.pdf, w.f * lobe_color(w, 0.25f, second)};
    memcpy(answers, all, sizeof all);
}

/* The chain of questions finds each lobe, with its defaults and its own meaning of roughness. */
static void dispatch_in_glsl_finds_each_lobe(void **state) {
    (void)state;
    static const Model model = {
        .body = ANGLES "    Lobe m = lobe_default(int(in2.x));\n"
                       "    LobeValue v = lobe_value(m, a), w = lobe_value(lobe_rough(m.id, in1.w), a);\n"
                       "    out0 = vec4(v.f, v.s, v.pdf, lobe_second(m, 0.25, 0.75));\n"
                       "    out1 = vec4(w.f, w.s, w.pdf, w.f * lobe_color(w, 0.25, out0.w));\n",
        .inputs = 3,
        .answers = "nnnnnnnn",
        .put = put_all_lobes,
        .fill = fill_any_lobe,
        .answer = answer_any_lobe,
    };
    need_gpu();
    assert_true(agree(&model, 0, "all lobes"));
}

static void put_term(Text *text, int which) {
    text_include(text, "shading/lobe/terms.h");
    text_line(text, "\nconst int TERM = %d;", which);
}

/* in2: alpha, its stretch along x, ior, k, over the ranges that the composed lobe gives them. */
static void fill_term(Random *random, int which, float *row) {
    static const int params[] = {0, COOK_TORRANCE_STRETCH, COOK_TORRANCE_IOR, COOK_TORRANCE_K};
    const WeftLobeInfo *info = weft_lobe_info(LOBE_COOK_TORRANCE);
    fill_pair(random, row);
    for (int p = 0; p < 4; p++) row[8 + p] = any_param(random, &info->params[params[p]]);
}

static void answer_d(int which, const float *row, float *answers) {
    float alpha = row[8], ax = alpha * row[9];
    Dir h = term_facet(which, alpha, ax, alpha, row[3], row[7]);
    const float all[] = {term_d(which, alpha, ax, alpha, row_angles(row).h), h.x, h.y, h.z};
    memcpy(answers, all, sizeof all);
}
static void answer_v(int which, const float *row, float *answers) {
    answers[0] = term_v(which, row[8], row[8] * row[9], row[8], row_angles(row));
}
static void answer_f(int which, const float *row, float *answers) {
    answers[0] = term_f(which, row[10], row[11], row_angles(row).d);
    answers[1] = term_second(which, row[3], row[7]);
    answers[2] = fresnel_weight_mix(answers[0], row[3], 1.0f);
}

static const Model d_terms = {
    .body = ANGLES "    float ax = in2.x * in2.y;\n    Dir h = term_facet(TERM, in2.x, ax, in2.x, in0.w, in1.w);\n"
                   "    out0 = vec4(term_d(TERM, in2.x, ax, in2.x, a.h), h.x, h.y, h.z);\n",
    .inputs = 3,
    .answers = "nddd",
    .put = put_term,
    .fill = fill_term,
    .answer = answer_d,
};
static const Model v_terms = {
    .body = ANGLES "    out0.x = term_v(TERM, in2.x, in2.x * in2.y, in2.x, a);\n",
    .inputs = 3,
    .answers = "n",
    .put = put_term,
    .fill = fill_term,
    .answer = answer_v,
};
static const Model f_terms = {
    .body = ANGLES "    out0.x = term_f(TERM, in2.z, in2.w, a.d);\n"
                   "    out0.y = term_second(TERM, in0.w, in1.w);\n"
                   "    out0.z = fresnel_weight_mix(out0.x, in0.w, 1.0);\n",
    .inputs = 3,
    .answers = "nnn",
    .put = put_term,
    .fill = fill_term,
    .answer = answer_f,
};

static void terms_in_glsl_agree_with_c(void **state) {
    (void)state;
    static const Model *const models[] = {[WEFT_TERM_D] = &d_terms, [WEFT_TERM_V] = &v_terms, [WEFT_TERM_F] = &f_terms};
    need_gpu();
    bool good = true;
    char name[64];
    for (int kind = WEFT_TERM_D; kind <= WEFT_TERM_F; kind++)
        for (int k = 0; weft_term_name((WeftTermKind)kind, k); k++) {
            snprintf(name, sizeof name, "%c %s", "dvf"[kind], weft_term_name((WeftTermKind)kind, k));
            good &= agree(models[kind], k, name);
        }
    assert_true(good);
}

/* E of a tinted lobe, with s, q and e; and of one whose fibres lean, by one tilt and by all. */
static AlbedoTable tinted, leaning, scaled;

static void put_table(Text *text, const char *name, const AlbedoTable *table) {
    TableRef e = albedo_table_ref(table);
    int layer = text_table(text, (TextTable){e.texels, e.rows * table->maps, e.columns + 1, NULL});
    text_line(text, "\nTableRef %s() {\n    TableRef t;\n    t.texels = %d;\n    t.kind = %d;", name, layer, e.kind);
    text_line(text, "    t.rows = %d;\n    t.columns = %d;\n    t.low = %s;\n    t.high = %s;", e.rows, e.columns,
              number(e.low).text, number(e.high).text);
    text_line(text, "    t.tilts = %d;\n    t.tilt = %s;\n    return t;\n}", e.tilts, number(e.tilt).text);
}

static void put_tables(Text *text, int which) {
    text_lobe_tables(text);
    text_engine_tables(text, (const int[]){ENGINE_THREE_GGX, ENGINE_FILAMENT_GGX}, 2);
    put_table(text, "tinted", &tinted);
}

static void fill_cosine(Random *random, int which, float *row) {
    row[0] = any_direction(random).z;
    row[1] = any_value(random, 0.0f, 1.0f, 0.0f, 4.0f);
    row[2] = any_value(random, 0.0f, 1.0f, 0.0f, 1.0f);
}

static void answer_tables(int which, const float *row, float *answers) {
    TableRef e = lobe_table_charlie_neubelt();
    const float all[] = {
        table_albedo(e, row[0], row[1]),
        table_sheen_average(e, table_rows(e, row[1])).e,
        table_albedo(engine_table(ENGINE_THREE_GGX), row[0], row[1]),
        table_albedo(engine_table(ENGINE_FILAMENT_GGX), row[0], row[1]),
        0.0f,
        sheen_e_in(table_sheen(albedo_table_ref(&tinted), row[0], row[1]), row[2]),
        sheen_e_in(table_sheen_average(albedo_table_ref(&tinted), table_rows(albedo_table_ref(&tinted), row[1])),
                   row[2])};
    memcpy(answers, all, sizeof all);
}

/* Each table is found in its own layer and mixed alike; one that the text was not given is 0. */
static void tables_in_glsl_agree_with_c(void **state) {
    (void)state;
    static const Model model = {
        .body = "    TableRef e = lobe_table_charlie_neubelt();\n"
                "    out0 = vec4(table_albedo(e, in0.x, in0.y), table_sheen_average(e, table_rows(e, in0.y)).e,\n"
                "                table_albedo(engine_table(ENGINE_THREE_GGX), in0.x, in0.y),\n"
                "                table_albedo(engine_table(ENGINE_FILAMENT_GGX), in0.x, in0.y));\n"
                "    out1.x = table_albedo(engine_table(ENGINE_BABYLON_GGX), in0.x, in0.y);\n"
                "    out1.y = sheen_e_in(table_sheen(tinted(), in0.x, in0.y), in0.z);\n"
                "    out1.z = sheen_e_in(table_sheen_average(tinted(), table_rows(tinted(), in0.y)), in0.z);\n",
        .inputs = 1,
        .answers = "nnnnnnn",
        .put = put_tables,
        .fill = fill_cosine,
        .answer = answer_tables,
    };
    need_gpu();
    assert_true(agree(&model, 0, "tables"));
}

static void put_leaning(Text *text, int which) {
    text_include(text, "shading/lobe/table.h");
    put_table(text, "leaning", &leaning);
    put_table(text, "scaled", &scaled);
}

static void fill_nap(Random *random, int which, float *row) {
    Dir w = any_direction(random), to = any_direction(random);
    row[0] = w.x, row[1] = w.y, row[2] = w.z;
    row[3] = any_value(random, 0.05f, 1.0f, 0.0f, 4.0f);
    row[4] = to.x, row[5] = to.y;
    row[6] = any_value(random, 0.0f, 0.8f, 0.0f, 2.0f);
    row[7] = any_value(random, 0.0f, 1.0f, 0.0f, 1.0f);
}

static void answer_nap(int which, const float *row, float *answers) {
    Dir w = dir(row[0], row[1], row[2]);
    Nap nap = nap_of(row[6], dir(row[4], row[5], 0.0f));
    TableRef one = albedo_table_ref(&leaning), all = albedo_table_ref(&scaled);
    const float e[] = {table_sheen_nap(one, w, nap, table_rows(one, row[3])).e,
                       sheen_e_in(table_sheen_nap(all, w, nap, table_rows(all, row[3])), row[7]),
                       table_sheen_nap_average(one, nap, table_rows(one, row[3])).e,
                       sheen_e_in(table_sheen_nap_average(all, nap, table_rows(all, row[3])), row[7])};
    memcpy(answers, e, sizeof e);
}

static void nap_tables_in_glsl_agree_with_c(void **state) {
    (void)state;
    static const Model model = {
        .body = "    Dir w = dir(in0.x, in0.y, in0.z);\n    Nap nap = nap_of(in1.z, dir(in1.x, in1.y, 0.0));\n"
                "    out0.x = table_sheen_nap(leaning(), w, nap, table_rows(leaning(), in0.w)).e;\n"
                "    out0.y = sheen_e_in(table_sheen_nap(scaled(), w, nap, table_rows(scaled(), in0.w)), "
                "in1.w);\n"
                "    out0.z = table_sheen_nap_average(leaning(), nap, table_rows(leaning(), in0.w)).e;\n"
                "    out0.w = sheen_e_in(table_sheen_nap_average(scaled(), nap, table_rows(scaled(), in0.w)), "
                "in1.w);\n",
        .inputs = 2,
        .answers = "nnnn",
        .put = put_leaning,
        .fill = fill_nap,
        .answer = answer_nap,
    };
    need_gpu();
    assert_true(agree(&model, 0, "naps"));
}

/* A term whose text says something else by a thousandth, laid over the library's. */
static void parity_finds_a_wrong_text(void **state) {
    (void)state;
    need_gpu();
    char folder[SCRATCH_SIZE], path[128];
    assert_true(scratch_make(folder));
    for (int part = 0; part < 2; part++) {
        static const char *const parts[] = {"shading", "shading/terms"};
        snprintf(path, sizeof path, "%s/%s", folder, parts[part]);
        assert_int_equal(mkdir(path, 0700), 0);
    }
    snprintf(path, sizeof path, "%s/shading/terms/f_schlick.h", folder);
    FILE *stream = fopen(path, "wb");
    assert_non_null(stream);
    assert_true(fputs("#include \"shading/dialect/lang.h\"\nFN float schlick_s(float d) {\n    float m = 1.001f - d;\n"
                      "    return m * m * m * m * m;\n}\n",
                      stream) >= 0);
    assert_int_equal(fclose(stream), 0);
    fill(&f_terms, F_SCHLICK);
    Programs programs = make_programs(&f_terms, F_SCHLICK, "a wrong schlick", folder);
    run_programs(&programs);
    free_programs(&programs);
    for (int language = 0; language < LANGUAGES; language++) {
        if (!contexts[language]) continue;
        Tally tally = compare(&f_terms, language);
        assert_true(tally.beyond > samples / 2);
        assert_false(holds(&tally, MIXED_SHARE));
    }
    assert_true(scratch_remove(folder));
}

static int begin(void **state) {
    Lobe lobe = lobe_default(LOBE_FIBRE);
    albedo_table_fill(&tinted, &lobe, 0.05f, 1.0f, 0);
    lobe = lobe_fibres(lobe, 1.0f, 0.7f, 0.0f);
    albedo_table_fill(&leaning, &lobe, 0.5f, 0.5f, 0);
    albedo_table_fill_tilts(&scaled, &lobe, 0.3f, 1.0f, 0);
    return parity_begin(state);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(lobes_in_glsl_agree_with_c),      cmocka_unit_test(dispatch_in_glsl_finds_each_lobe),
        cmocka_unit_test(terms_in_glsl_agree_with_c),      cmocka_unit_test(tables_in_glsl_agree_with_c),
        cmocka_unit_test(nap_tables_in_glsl_agree_with_c), cmocka_unit_test(parity_finds_a_wrong_text),
    };
    return cmocka_run_group_tests(tests, begin, parity_end);
}
