/* parity.h - the GPU and the processor get the same numbers from the same text: what is asked of both, in both
 * languages, and how far the answers are apart
 *
 * The two round differently (order of operations, log2 and exp2), so parity is a tolerance; the samples are
 * the same in every run. */
#ifndef WEFT_TEST_RASTER_PARITY_H
#define WEFT_TEST_RASTER_PARITY_H

#include "shading/cases.h"

#include "base/thread.h"
#include "raster/frame/compute.h"
#include "text/assemble/dispatch.h"
#include "text/assemble/tables.h"
#include "text/source/number_text.h"

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

/* Says what is asked of both: the body reads row[0..] as in0.xyzw, in1.x ... and sets out0, out1 to the answers.
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
static inline Dir any_direction(Random *random) {
    double z = 1.0 - (double)random_unit(random), kind = (double)random_unit(random);
    if (kind < 1.0 / 8.0) z = (exp2)(-13.0 * z);
    if (kind > 15.0 / 16.0) z = 1.0 - 1e-4 * z;
    double s = (sqrt)(1.0 - z * z), phi = 2.0 * PI_DOUBLE * (double)random_unit(random);
    return dir((float)(s * (cos)(phi)), (float)(s * (sin)(phi)), (float)z);
}

/* Near the mirror of o as often as anywhere: narrow lobes are nothing elsewhere. */
static inline Dir any_partner(Random *random, Dir o) {
    Dir i = any_direction(random);
    if (random_unit(random) < 0.5f) return i;
    float t = 0.3f * random_unit(random) * random_unit(random);
    i = dir(weft_mix(-o.x, i.x, t), weft_mix(-o.y, i.y, t), weft_mix(o.z, i.z, t));
    float n = 1.0f / sqrtf(dir_dot(i, i));
    return dir(i.x * n, i.y * n, i.z * n);
}

/* Half plausible, half all that is possible; lower values are the finer ones. One in sixteen is at an end. */
static inline float any_value(Random *random, float low, float high, float hard_low, float hard_high) {
    float kind = random_unit(random), t = random_unit(random);
    if (kind < 1.0f / 32.0f) return hard_low;
    if (kind < 1.0f / 16.0f) return hard_high;
    if (kind < 0.5f) return weft_mix(low, high, t * t);
    return weft_mix(hard_low, hard_high, t * t * t);
}

static inline float any_param(Random *random, const WeftParamInfo *p) {
    if (p->choices) return floorf(random_unit(random) * (p->hard_high + 1.0f));
    return any_value(random, p->low, p->high, p->hard_low, p->hard_high);
}

/* in0: o, u.  in1: i, v. */
static inline void fill_pair(Random *random, float *row) {
    Dir o = any_direction(random), i = any_partner(random, o);
    row[0] = o.x, row[1] = o.y, row[2] = o.z, row[3] = random_unit(random);
    row[4] = i.x, row[5] = i.y, row[6] = i.z, row[7] = random_unit(random);
}
static inline Dir row_o(const float *row) { return dir(row[0], row[1], row[2]); }
static inline Angles row_angles(const float *row) { return angles_between(row_o(row), dir(row[4], row[5], row[6])); }

#define ANGLES                                                                                                         \
    "    Dir o = dir(in0.x, in0.y, in0.z);\n"                                                                          \
    "    Angles a = angles_between(o, dir(in1.x, in1.y, in1.z));\n"

/* A model's programs, one a language. */
typedef struct Programs {
    const Model *model;
    int which;
    const char *name, *folder; /* in which other text may lie, or NULL */
    Compute *computes[LANGUAGES];
    WeftError errors[LANGUAGES];
} Programs;

static inline void make_program(void *user, int language, int thread) {
    Programs *programs = user;
    const Model *model = programs->model;
    GlContext *context = contexts[language];
    WeftError *error = &programs->errors[language];
    Text text;
    if (!context) return;
    text_begin(&text, &(TextDesc){.language = context_language(context), .tables = true, .folder = programs->folder});
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

static inline void run_program(void *user, int language, int thread) {
    Programs *programs = user;
    if (contexts[language])
        compute_run(programs->computes[language], samples, (const float *const *)in, out[language],
                    &programs->errors[language]);
}

static inline void check_programs(const Programs *programs) {
    for (int k = 0; k < LANGUAGES; k++)
        if (programs->errors[k].result != WEFT_OK)
            fail_msg("%s %s: %s", language_names[k], programs->name, programs->errors[k].text);
}

/* Both languages at once: most of the time is the drivers', who compile. */
static inline Programs make_programs(const Model *model, int which, const char *name, const char *folder) {
    Programs programs = {.model = model, .which = which, .name = name, .folder = folder};
    parallel_for(LANGUAGES, LANGUAGES, make_program, &programs);
    check_programs(&programs);
    return programs;
}

static inline void run_programs(Programs *programs) {
    parallel_for(LANGUAGES, LANGUAGES, run_program, programs);
    check_programs(programs);
}

static inline void free_programs(Programs *programs) {
    for (int k = 0; k < LANGUAGES; k++) compute_destroy(programs->computes[k]);
}

static inline void fill(const Model *model, int which) {
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

static inline Tally compare(const Model *model, int language) {
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

static inline bool holds(const Tally *tally, double share) {
    return (double)tally->beyond <= ceil(share * (double)samples);
}

static inline void report(const Model *model, int language, const char *name, const Tally *tally) {
    print_message("%-3s %s: %.2g of the tolerance", language_names[language], name, tally->worst);
    if (tally->beyond) print_message(", %zu beyond it", tally->beyond);
    print_message("\n");
    if (!tally->beyond) return;
    size_t s = tally->sample;
    print_message("    answers for what C answers:");
    for (size_t k = 0; model->answers[k]; k++)
        print_message(" %.9g/%.9g", (double)out[language][k / 4][4 * s + k % 4], (double)expected[ANSWERS * s + k]);
    print_message("\n    of");
    for (size_t r = 0; r < 4 * (size_t)model->inputs; r++) print_message(" %.9g", (double)in[r / 4][4 * s + r % 4]);
    print_message("\n");
}

/* Returns true if both languages agree with C. */
static inline bool programs_agree(Programs *programs, int which, const char *name, double share) {
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

static inline bool agree(const Model *model, int which, const char *name) {
    Programs programs = make_programs(model, which, name, NULL);
    bool good = programs_agree(&programs, which, name, 0.0);
    free_programs(&programs);
    return good;
}

static inline void need_gpu(void) {
    if (!contexts[0] && !contexts[1]) skip();
}

static inline bool on_gpu(int id) { return !(weft_lobe_info(id)->traits & TRAIT_REFERENCE); }

static inline int lobes_on_gpu(int ids[LOBE_COUNT]) {
    int count = 0;
    for (int id = 0; id < LOBE_COUNT; id++)
        if (on_gpu(id)) ids[count++] = id;
    return count;
}

static inline void put_all_lobes(Text *text, int which) {
    int ids[LOBE_COUNT];
    text_dispatch(text, ids, lobes_on_gpu(ids));
}

static inline int parity_begin(void **state) {
    (void)state;
    WeftError error = {0};
    for (int k = 0; k < LANGUAGES; k++)
        if (context_create(languages[k], &contexts[k], &error) != WEFT_OK) print_message("%s\n", error.text);
    samples = (size_t)(SAMPLES_MOST / (test_long() ? 1 : test_short() ? 8 : 2));
    for (int k = 0; k < INPUTS; k++) in[k] = calloc(samples, 4 * sizeof(float));
    for (int k = 0; k < LANGUAGES * OUTPUTS; k++) out[k / OUTPUTS][k % OUTPUTS] = calloc(samples, 4 * sizeof(float));
    lobe_tables_make();
    expected = calloc(samples, ANSWERS * sizeof(float));
    return 0;
}

static inline int parity_end(void **state) {
    (void)state;
    for (int k = 0; k < INPUTS; k++) free(in[k]);
    for (int k = 0; k < LANGUAGES * OUTPUTS; k++) free(out[k / OUTPUTS][k % OUTPUTS]);
    free(expected);
    for (int k = 0; k < LANGUAGES; k++) context_destroy(contexts[k]);
    return 0;
}

#endif
