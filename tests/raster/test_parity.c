/* The GPU and the processor get the same numbers from the same text: every lobe that the GPU has, every term,
 * layer rule, workflow and profile, over random directions and over all that their numbers may be, in both
 * languages
 *
 * The two round differently (order of operations, log2 and exp2), so parity is a tolerance; the samples are
 * the same in every run. */
#include "shading/cases.h"

#include <sys/stat.h>

#include "base/thread.h"
#include "raster/compute.h"
#include "scratch.h"
#include "shading/choice.h"
#include "shading/dust.h"
#include "shading/engine_tables.h"
#include "shading/lobe_tables.h"
#include "text/dispatch.h"
#include "text/number_text.h"
#include "text/tables.h"

enum { LANGUAGES = 2, SAMPLES_MOST = 65536, INPUTS = COMPUTE_INPUTS_MAX, OUTPUTS = 2, ANSWERS = 4 * OUTPUTS };

/* |gpu - c| is to be at most RELATIVE |c| + ABSOLUTE.
 * Directions have a tolerance of their own: the steep ends of a sampler's maps, where a number that is off by
 * 1e-7 turns a direction by its square root. */
#define RELATIVE 5e-4
#define ABSOLUTE 1e-5
#define TURN     1e-3
/* So have patches of noise: a place is rounded before it is told how far it lies from the lattice. */
#define PATCH 1e-4
/* Only where inputs of the hard range and choices of all kinds are mixed may a few samples be beyond: colours
 * of 1e3 that cancel leave no more digits than they had. */
#define MIXED_SHARE 1e-4 /* and one where there are few samples */

/* What is asked of both: the body reads row[0..] as in0.xyzw, in1.x ... and sets out0, out1 to the answers.
 */
typedef struct Model {
    const char *body;
    int inputs;                     /* vec4 */
    const char *answers;            /* a letter each: n a number, d part of a direction, p of noise */
    void (*put)(Text *, int which); /* declarations */
    void (*fill)(Random *, int which, float row[4 * INPUTS]);
    void (*answer)(int which, const float row[4 * INPUTS], float answers[ANSWERS]);
} Model;

static const TextLanguage languages[LANGUAGES] = {TEXT_GLSL_330, TEXT_GLSL_ES_300};
static const char *const language_names[LANGUAGES] = {"330", "es"};
static GlContext *contexts[LANGUAGES]; /* NULL where the machine has none */
static float *in[INPUTS], *out[LANGUAGES][OUTPUTS], *expected;
static size_t samples;

/* Uniform over the hemisphere; one in eight grazes, down to a cosine of 1e-4; one in sixteen is the normal's
 * neighbour. */
static Dir any_direction(Random *random) {
    double z = 1.0 - (double)random_unit(random), kind = (double)random_unit(random);
    if (kind < 1.0 / 8.0) z = (exp2)(-13.0 * z);
    if (kind > 15.0 / 16.0) z = 1.0 - 1e-4 * z;
    double s = (sqrt)(1.0 - z * z), phi = 2.0 * PI_DOUBLE * (double)random_unit(random);
    return dir((float)(s * (cos)(phi)), (float)(s * (sin)(phi)), (float)z);
}

/* Near the mirror of o as often as anywhere: narrow lobes are nothing elsewhere. */
static Dir any_partner(Random *random, Dir o) {
    Dir i = any_direction(random);
    if (random_unit(random) < 0.5f) return i;
    float t = 0.3f * random_unit(random) * random_unit(random);
    i = dir(weft_mix(-o.x, i.x, t), weft_mix(-o.y, i.y, t), weft_mix(o.z, i.z, t));
    float n = 1.0f / sqrtf(dir_dot(i, i));
    return dir(i.x * n, i.y * n, i.z * n);
}

/* Half plausible, half all that is possible; lower values are the finer ones. One in sixteen is at an end. */
static float any_value(Random *random, float low, float high, float hard_low, float hard_high) {
    float kind = random_unit(random), t = random_unit(random);
    if (kind < 1.0f / 32.0f) return hard_low;
    if (kind < 1.0f / 16.0f) return hard_high;
    if (kind < 0.5f) return weft_mix(low, high, t * t);
    return weft_mix(hard_low, hard_high, t * t * t);
}

static float any_param(Random *random, const WeftParamInfo *p) {
    if (p->choices) return floorf(random_unit(random) * (p->hard_high + 1.0f));
    return any_value(random, p->low, p->high, p->hard_low, p->hard_high);
}

/* in0: o, u.  in1: i, v. */
static void fill_pair(Random *random, float *row) {
    Dir o = any_direction(random), i = any_partner(random, o);
    row[0] = o.x, row[1] = o.y, row[2] = o.z, row[3] = random_unit(random);
    row[4] = i.x, row[5] = i.y, row[6] = i.z, row[7] = random_unit(random);
}
static Dir row_o(const float *row) { return dir(row[0], row[1], row[2]); }
static Angles row_angles(const float *row) { return angles_between(row_o(row), dir(row[4], row[5], row[6])); }

#define ANGLES                                                                                               \
    "    Dir o = dir(in0.x, in0.y, in0.z);\n"                                                                \
    "    Angles a = angles_between(o, dir(in1.x, in1.y, in1.z));\n"

/* A model's programs, one a language. */
typedef struct Programs {
    const Model *model;
    int which;
    const char *name, *folder; /* in which other text may lie, or NULL */
    Compute *computes[LANGUAGES];
    WeftError errors[LANGUAGES];
} Programs;

static void make_program(void *user, int language, int thread) {
    Programs *programs = user;
    const Model *model = programs->model;
    GlContext *context = contexts[language];
    WeftError *error = &programs->errors[language];
    Text text;
    if (!context) return;
    text_begin(&text, &(TextDesc){
                          .language = context_language(context), .tables = true, .folder = programs->folder});
    model->put(&text, programs->which);
    if (text_end(&text, error) == WEFT_OK) {
        ComputeDesc desc = {.name = programs->name,
                            .text = &text,
                            .body = model->body,
                            .inputs = model->inputs,
                            .outputs = ((int)strlen(model->answers) + 3) / 4};
        if (compute_create(context, &desc, &programs->computes[language], error) == WEFT_OK)
            compute_tables(programs->computes[language], text.tables, text.table_count, error);
    }
    text_free(&text);
}

static void run_program(void *user, int language, int thread) {
    Programs *programs = user;
    if (contexts[language])
        compute_run(programs->computes[language], samples, (const float *const *)in, out[language],
                    &programs->errors[language]);
}

static void check_programs(const Programs *programs) {
    for (int k = 0; k < LANGUAGES; k++)
        if (programs->errors[k].result != WEFT_OK)
            fail_msg("%s %s: %s", language_names[k], programs->name, programs->errors[k].text);
}

/* Both languages at once: most of the time is the drivers', who compile. */
static Programs make_programs(const Model *model, int which, const char *name, const char *folder) {
    Programs programs = {.model = model, .which = which, .name = name, .folder = folder};
    parallel_for(LANGUAGES, LANGUAGES, make_program, &programs);
    check_programs(&programs);
    return programs;
}

static void run_programs(Programs *programs) {
    parallel_for(LANGUAGES, LANGUAGES, run_program, programs);
    check_programs(programs);
}

static void free_programs(Programs *programs) {
    for (int k = 0; k < LANGUAGES; k++) compute_destroy(programs->computes[k]);
}

static void fill(const Model *model, int which) {
    Random random = {(uint64_t)which};
    for (size_t s = 0; s < samples; s++) {
        float row[4 * INPUTS] = {0};
        model->fill(&random, which, row);
        model->answer(which, row, expected + ANSWERS * s);
        for (size_t k = 0; k < 4 * (size_t)model->inputs; k++) in[k / 4][4 * s + k % 4] = row[k];
    }
}

typedef struct Tally {
    size_t beyond;
    double worst;  /* error in tolerances, of all */
    size_t sample; /* where */
} Tally;

static Tally compare(const Model *model, int language) {
    Tally tally = {0};
    for (size_t s = 0; s < samples; s++) {
        double most = 0.0;
        for (size_t k = 0; model->answers[k]; k++) {
            double c = (double)expected[ANSWERS * s + k], gpu = (double)out[language][k / 4][4 * s + k % 4];
            double allowed = model->answers[k] == 'd'   ? TURN
                             : model->answers[k] == 'p' ? PATCH
                                                        : RELATIVE * fabs(c) + ABSOLUTE;
            double error = isfinite(gpu) && isfinite(c) ? fabs(gpu - c) / allowed : HUGE_VAL;
            if (error > tally.worst) {
                tally.worst = error;
                tally.sample = s;
            }
            most = fmax(most, error);
        }
        tally.beyond += most > 1.0;
    }
    return tally;
}

static bool holds(const Tally *tally, double share) {
    return (double)tally->beyond <= ceil(share * (double)samples);
}

static void report(const Model *model, int language, const char *name, const Tally *tally) {
    print_message("%-3s %s: %.2g of the tolerance", language_names[language], name, tally->worst);
    if (tally->beyond) print_message(", %zu beyond it", tally->beyond);
    print_message("\n");
    if (!tally->beyond) return;
    size_t s = tally->sample;
    print_message("    answers for what C answers:");
    for (size_t k = 0; model->answers[k]; k++)
        print_message(" %.9g/%.9g", (double)out[language][k / 4][4 * s + k % 4],
                      (double)expected[ANSWERS * s + k]);
    print_message("\n    of");
    for (size_t r = 0; r < 4 * (size_t)model->inputs; r++)
        print_message(" %.9g", (double)in[r / 4][4 * s + r % 4]);
    print_message("\n");
}

/* Whether both languages agree with C. */
static bool programs_agree(Programs *programs, int which, const char *name, double share) {
    bool good = true;
    fill(programs->model, which);
    run_programs(programs);
    for (int language = 0; language < LANGUAGES; language++) {
        if (!contexts[language]) continue;
        Tally tally = compare(programs->model, language);
        report(programs->model, language, name, &tally);
        good &= holds(&tally, share);
    }
    return good;
}

static bool agree(const Model *model, int which, const char *name) {
    Programs programs = make_programs(model, which, name, NULL);
    bool good = programs_agree(&programs, which, name, 0.0);
    free_programs(&programs);
    return good;
}

static void need_gpu(void) {
    if (!contexts[0] && !contexts[1]) skip();
}

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

static bool on_gpu(int id) { return !(weft_lobe_info(id)->traits & TRAIT_REFERENCE); }

static void lobes_in_glsl_agree_with_c(void **state) {
    (void)state;
    need_gpu();
    bool good = true;
    for (int id = 0; id < LOBE_COUNT; id++)
        if (on_gpu(id)) good &= agree(&lobes, id, weft_lobe_info(id)->id);
    assert_true(good);
}

static int lobes_on_gpu(int ids[LOBE_COUNT]) {
    int count = 0;
    for (int id = 0; id < LOBE_COUNT; id++)
        if (on_gpu(id)) ids[count++] = id;
    return count;
}

static void put_all_lobes(Text *text, int which) {
    int ids[LOBE_COUNT];
    text_dispatch(text, ids, lobes_on_gpu(ids));
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
    text_include(text, "shading/terms.h");
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
    .body = ANGLES
    "    float ax = in2.x * in2.y;\n    Dir h = term_facet(TERM, in2.x, ax, in2.x, in0.w, in1.w);\n"
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
    static const Model *const models[] = {
        [WEFT_TERM_D] = &d_terms, [WEFT_TERM_V] = &v_terms, [WEFT_TERM_F] = &f_terms};
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

static void put_layer(Text *text, int which) {
    text_include(text, "shading/layer.h");
    text_line(text, "\nconst int LAYER = %d;", which);
}

/* A colour, and E of a lobe that may reflect three times what it receives. */
static void fill_layer(Random *random, int which, float *row) {
    row[0] = any_value(random, 0.0f, 1.0f, 0.0f, 1000.0f);
    for (int k = 1; k < 4; k++) row[k] = any_value(random, 0.0f, 1.0f, 0.0f, 3.0f);
}

static void answer_layer(int which, const float *row, float *answers) {
    answers[0] = layer_base(which, row[0], row[1], row[2], row[3]);
}

static void layer_rules_in_glsl_agree_with_c(void **state) {
    (void)state;
    static const Model model = {
        .body = "    out0.x = layer_base(LAYER, in0.x, in0.y, in0.z, in0.w);\n",
        .inputs = 1,
        .answers = "n",
        .put = put_layer,
        .fill = fill_layer,
        .answer = answer_layer,
    };
    need_gpu();
    bool good = true;
    for (int k = 0; weft_layer_name(k); k++) good &= agree(&model, k, weft_layer_name(k));
    assert_true(good);
}

/* A surface and its choices are numbers in a row behind the pair of directions. */
enum { SURFACE_AT = 8, CHOICES_AT = SURFACE_AT + sizeof(Surface) / sizeof(float) };
enum { STACK_INPUTS = (CHOICES_AT + CHOICE_COUNT + 3) / 4 };
_Static_assert((int)STACK_INPUTS == 23, "the body of stacks_agree reads as many");

/* Functions that make a Surface and Choices of the row. */
static void put_readers(Text *text) {
    int at = SURFACE_AT;
    text_line(text, "\nfloat row[%d];\n\nSurface row_surface() {\n    Surface s;", 4 * STACK_INPUTS);
#define READ_SCALAR(name) text_line(text, "    s.%s = row[%d];", name, at), at += 1
#define READ_THREE(name, make)                                                                               \
    text_line(text, "    s.%s = %s(row[%d], row[%d], row[%d]);", name, make, at, at + 1, at + 2), at += 3
#define READ_COLOR(name)                                                  READ_THREE(name, "rgb")
#define READ_ANGLE(name)                                                  READ_SCALAR(name)
#define READ_NORMAL(name)                                                 READ_THREE(name, "dir")
#define READ_DIRECTION(name)                                              READ_THREE(name, "dir")
#define READ_INPUT(kind, name, def, low, high, hard_low, hard_high, help) READ_##kind(#name);
    SURFACE_INPUTS(READ_INPUT)
    text_line(text, "    return s;\n}\n\nChoices row_choices() {\n    Choices c;");
#define READ_CHOICE(name, help) text_line(text, "    c." #name " = int(row[%d]);", at++);
    SURFACE_CHOICES(READ_CHOICE)
    text_line(text, "    return c;\n}");
}

static int workflow_count(void) {
    int count = 0;
    while (weft_workflow_name(count)) count++;
    return count;
}

/* The choice that is made for stacks of that number: a workflow, behind them a profile, behind them any. */
static const char *stack_name(int which) {
    int workflows = workflow_count();
    if (which < workflows) return weft_workflow_name(which);
    return weft_profile_name(which - workflows + 1); /* profile 0 is none */
}

static void put_stack(Text *text, int which) {
    static const int engines[] = {ENGINE_FILAMENT_SHEEN, ENGINE_FILAMENT_GGX, ENGINE_BABYLON_SHEEN,
                                  ENGINE_BABYLON_GGX, ENGINE_THREE_GGX};
    put_all_lobes(text, which);
    text_lobe_tables(text);
    text_engine_tables(text, engines, ENGINE_COUNT);
    text_include(text, "shading/compose.h");
    put_readers(text);
}

static float *fill_scalar(Random *random, const float range[4], float *at) {
    *at = any_value(random, range[0], range[1], range[2], range[3]);
    return at + 1;
}
static float *fill_angle(Random *random, const float degrees[4], float *at) {
    at = fill_scalar(random, degrees, at);
    at[-1] *= PI_FLOAT / 180.0f;
    return at;
}
static float *fill_color(Random *random, const float range[4], float *at) {
    for (int c = 0; c < 3; c++) at = fill_scalar(random, range, at);
    return at;
}
static float *fill_normal(Random *random, const float range[4], float *at) {
    Dir n = random_unit(random) < 0.5f ? dir(0.0f, 0.0f, 1.0f) : any_direction(random);
    at[0] = n.x, at[1] = n.y, at[2] = n.z;
    return at + 3;
}
static float *fill_direction(Random *random, const float range[4], float *at) {
    Dir d = direction(0.5 * PI_DOUBLE, 2.0 * PI_DOUBLE * (double)random_unit(random));
    at[0] = d.x, at[1] = d.y, at[2] = 0.0f;
    return at + 3;
}

static int any_choice(Random *random, ChoiceId choice) {
    int count = 0;
    while (choice_id(choice, count)) count++;
    int k = (int)(random_bits(random) % (uint32_t)(count + 1)) - 1;
    bool lobe = choice == CHOICE_diffuse || choice == CHOICE_sheen_lobe;
    return k >= 0 && lobe && !(choice_fits(choice, k) && on_gpu(k)) ? CHOICE_AUTO : k;
}

static void fill_stack(Random *random, int which, float *row) {
    fill_pair(random, row);
    float *at = row + SURFACE_AT;
#define fill_SCALAR    fill_scalar
#define fill_ANGLE     fill_angle
#define fill_COLOR     fill_color
#define fill_NORMAL    fill_normal
#define fill_DIRECTION fill_direction
#define FILL_INPUT(kind, name, def, low, high, hard_low, hard_high, help)                                    \
    at = fill_##kind(random, (const float[]){low, high, hard_low, hard_high}, at);
    SURFACE_INPUTS(FILL_INPUT)
    for (int choice = 0; choice < CHOICE_COUNT; choice++)
        at[choice] = (float)(stack_name(which) ? CHOICE_AUTO : any_choice(random, (ChoiceId)choice));
    int workflows = workflow_count();
    if (which < workflows)
        at[CHOICE_workflow] = (float)which;
    else if (stack_name(which))
        at[CHOICE_profile] = (float)(which - workflows + 1);
}

static void answer_stack(int which, const float *row, float *answers) {
    Surface s;
    Choices c;
    SeenStack seen;
    memcpy(&s, row + SURFACE_AT, sizeof s);
    const float *at = row + CHOICES_AT;
#define ANSWER_CHOICE(name, help) c.name = (int)*at++;
    SURFACE_CHOICES(ANSWER_CHOICE)
    Angles a = row_angles(row);
    seen_make(&seen, &s, &c, lobe_table_charlie_neubelt(), a.o);
    const StackView *w = &seen.view;
    Angles coat = angles_between(w->coat_o, stack_to_coat(&seen.stack, a.i));
    StackValue v = stack_value(&seen.stack, w, &a, &coat), t = stack_transmitted(&seen.stack, w, &a);
    v.f_cos = rgb_add(v.f_cos, t.f_cos);
    v.pdf += t.pdf;
    const float all[ANSWERS] = {
        v.f_cos.r,         v.f_cos.g,       v.f_cos.b, v.pdf, w->select_p.diffuse, w->select_p.specular,
        w->select_p.sheen, w->select_p.coat};
    memcpy(answers, all, sizeof all);
}

#define ROW(k) "        row[4 * " #k " + c] = in" #k "[c];\n"

/* All that a renderer asks of a surface: with each workflow and each profile, and with choices of all kinds
 * mixed. */
static void stacks_in_glsl_agree_with_c(void **state) {
    (void)state;
    static const Model model = {
        .body = "    for (int c = 0; c < 4; c++) {\n" ROW(2) ROW(3) ROW(4) ROW(5) ROW(6) ROW(7) ROW(8) ROW(9)
            ROW(10) ROW(11) ROW(12) ROW(13) ROW(14) ROW(15) ROW(16) ROW(17) ROW(18) ROW(19) ROW(20) ROW(21)
                ROW(22) "    }\n" ANGLES "    Stack m;\n    surface_stack(m, row_surface(), row_choices(), "
                        "lobe_table_charlie_neubelt());\n    StackView w;\n    stack_view(m, o, w);\n"
                        "    Angles coat = angles_between(w.coat_o, stack_to_coat(m, a.i));\n"
                        "    StackValue v = stack_value(m, w, a, coat), t = stack_transmitted(m, w, a);\n"
                        "    v.f_cos = rgb_add(v.f_cos, t.f_cos);\n    v.pdf += t.pdf;\n"
                        "    out0 = vec4(v.f_cos.r, v.f_cos.g, v.f_cos.b, v.pdf);\n"
                        "    out1 = vec4(w.select_p.diffuse, w.select_p.specular, w.select_p.sheen, "
                        "w.select_p.coat);\n",
        .inputs = STACK_INPUTS,
        .answers = "nnnnnnnn",
        .put = put_stack,
        .fill = fill_stack,
        .answer = answer_stack,
    };
    need_gpu();
    Programs programs = make_programs(&model, 0, "stacks", NULL);
    bool good = true;
    int which = 0;
    for (; stack_name(which); which++) good &= programs_agree(&programs, which, stack_name(which), 0.0);
    good &= programs_agree(&programs, which, "any choices", MIXED_SHARE);
    free_programs(&programs);
    assert_true(good);
}

static void put_dust(Text *text, int which) { text_include(text, "shading/dust.h"); }

/* in0: normal, tilt.  in1: place, scale.  in2: direction, falloff, amount.  in3: strength of the noise. */
static void fill_dust(Random *random, int which, float *row) {
    Dir n = any_direction(random), to = any_direction(random);
    float r = 1.0f / sqrtf(max(to.x * to.x + to.y * to.y, 1e-12f));
    row[0] = n.x, row[1] = random_unit(random) < 0.25f ? -n.z : n.z, row[2] = n.y;
    row[3] = any_value(random, 0.0f, 1.5f, 0.0f, PI);
    for (int k = 4; k < 7; k++) row[k] = 2.0f * random_unit(random) - 1.0f;
    row[7] = any_value(random, 0.02f, 0.1f, 0.02f, 10.0f);
    row[8] = to.x * r, row[9] = to.y * r;
    row[10] = any_value(random, 0.5f, 8.0f, 0.1f, 64.0f);
    row[11] = any_value(random, 0.0f, 1.0f, 0.0f, 1.0f);
    row[12] = any_value(random, 0.0f, 1.0f, 0.0f, 1.0f);
}

static void answer_dust(int which, const float *row, float *answers) {
    Surface s = {.dust = row[11],
                 .dust_tilt = row[3],
                 .dust_direction = {row[8], row[9], 0.0f},
                 .dust_falloff = row[10],
                 .dust_noise = row[12],
                 .dust_scale = row[7]};
    Dir p = dir(row[4], row[5], row[6]);
    answers[0] = dust_accumulate(s, dir(row[0], row[1], row[2]), p).dust;
    answers[1] = dust_noise(p, row[7]);
    answers[2] = dust_hash(floorf(289.0f * row[12]));
}

/* The noise has the same patches to 1e-4, the hash below it the same whole numbers. */
static void dust_in_glsl_agrees_with_c(void **state) {
    (void)state;
    static const Model model = {
        .body =
            "    Surface s;\n    s.dust = in2.w;\n    s.dust_tilt = in0.w;\n"
            "    s.dust_direction = dir(in2.x, in2.y, 0.0);\n    s.dust_falloff = in2.z;\n"
            "    s.dust_noise = in3.x;\n    s.dust_scale = in1.w;\n    Dir p = dir(in1.x, in1.y, in1.z);\n"
            "    out0.x = dust_accumulate(s, dir(in0.x, in0.y, in0.z), p).dust;\n"
            "    out0.y = dust_noise(p, in1.w);\n"
            "    out0.z = dust_hash(floor(289.0 * in3.x));\n",
        .inputs = 4,
        .answers = "ppn",
        .put = put_dust,
        .fill = fill_dust,
        .answer = answer_dust,
    };
    need_gpu();
    assert_true(agree(&model, 0, "dust"));
}

/* E of a tinted lobe, with s, q and e; and of one whose fibres lean, by one tilt and by all. */
static AlbedoTable tinted, leaning, scaled;

static void put_table(Text *text, const char *name, const AlbedoTable *table) {
    TableRef e = albedo_table_ref(table);
    int layer = text_table(text, (TextTable){e.texels, e.rows * table->maps, e.columns + 1, NULL});
    text_line(text, "\nTableRef %s() {\n    TableRef t;\n    t.texels = %d;\n    t.kind = %d;", name, layer,
              e.kind);
    text_line(text, "    t.rows = %d;\n    t.columns = %d;\n    t.low = %s;\n    t.high = %s;", e.rows,
              e.columns, number(e.low).text, number(e.high).text);
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
    const float all[] = {table_albedo(e, row[0], row[1]),
                         table_sheen_average(e, table_rows(e, row[1])).e,
                         table_albedo(engine_table(ENGINE_THREE_GGX), row[0], row[1]),
                         table_albedo(engine_table(ENGINE_FILAMENT_GGX), row[0], row[1]),
                         0.0f,
                         sheen_e_in(table_sheen(albedo_table_ref(&tinted), row[0], row[1]), row[2]),
                         sheen_e_in(table_sheen_average(albedo_table_ref(&tinted),
                                                        table_rows(albedo_table_ref(&tinted), row[1])),
                                    row[2])};
    memcpy(answers, all, sizeof all);
}

/* Each table is found in its own layer and mixed alike; one that the text was not given is 0. */
static void tables_in_glsl_agree_with_c(void **state) {
    (void)state;
    static const Model model = {
        .body =
            "    TableRef e = lobe_table_charlie_neubelt();\n"
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
    text_include(text, "shading/table.h");
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
        .body =
            "    Dir w = dir(in0.x, in0.y, in0.z);\n    Nap nap = nap_of(in1.z, dir(in1.x, in1.y, 0.0));\n"
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
    assert_true(
        fputs("#include \"shading/lang.h\"\nFN float schlick_s(float d) {\n    float m = 1.001f - d;\n"
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
    (void)state;
    WeftError error = {0};
    for (int k = 0; k < LANGUAGES; k++)
        if (context_create(languages[k], &contexts[k], &error) != WEFT_OK) print_message("%s\n", error.text);
    samples = (size_t)(SAMPLES_MOST / (test_long() ? 1 : test_short() ? 8 : 2));
    for (int k = 0; k < INPUTS; k++) in[k] = calloc(samples, 4 * sizeof(float));
    for (int k = 0; k < LANGUAGES * OUTPUTS; k++)
        out[k / OUTPUTS][k % OUTPUTS] = calloc(samples, 4 * sizeof(float));
    lobe_tables_make();
    Lobe lobe = lobe_default(LOBE_FIBRE);
    albedo_table_fill(&tinted, &lobe, 0.05f, 1.0f, 0);
    lobe = lobe_fibres(lobe, 1.0f, 0.7f, 0.0f);
    albedo_table_fill(&leaning, &lobe, 0.5f, 0.5f, 0);
    albedo_table_fill_tilts(&scaled, &lobe, 0.3f, 1.0f, 0);
    expected = calloc(samples, ANSWERS * sizeof(float));
    return 0;
}

static int end(void **state) {
    (void)state;
    for (int k = 0; k < INPUTS; k++) free(in[k]);
    for (int k = 0; k < LANGUAGES * OUTPUTS; k++) free(out[k / OUTPUTS][k % OUTPUTS]);
    free(expected);
    for (int k = 0; k < LANGUAGES; k++) context_destroy(contexts[k]);
    return 0;
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(lobes_in_glsl_agree_with_c),      cmocka_unit_test(dispatch_in_glsl_finds_each_lobe),
        cmocka_unit_test(terms_in_glsl_agree_with_c),      cmocka_unit_test(layer_rules_in_glsl_agree_with_c),
        cmocka_unit_test(stacks_in_glsl_agree_with_c),     cmocka_unit_test(tables_in_glsl_agree_with_c),
        cmocka_unit_test(nap_tables_in_glsl_agree_with_c), cmocka_unit_test(dust_in_glsl_agrees_with_c),
        cmocka_unit_test(parity_finds_a_wrong_text),
    };
    return cmocka_run_group_tests(tests, begin, end);
}
