/* fabric.c - which form of lobe fits measured fabrics: the figures of docs/fabrics.md
 *
 *   study_fabric a.binary b.binary ...      measurements as weft fit takes them, at most 16
 *
 * Prints the error of each form on each fabric, all numbers free that it has; and the choice by
 * leave-one-out: for each fabric the form that is best in the mean of all others, and what that comes to on
 * the fabric that had no say. Forms are those that led to the lobes body and fabric, with the constants that
 * they fix. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/pi.h"
#include "base/thread.h"
#include "measure/fit/blend.h"
#include "measure/fit/data.h"
#include "measure/fit/search.h"

/* f = color (cos_i cos_o)^edge (1 + retro peak + lift sin^2 d) / pi + D V (f0 (1 - s) + f90 s)
 * peak = exp(-tan d / width), or width / (width + tan d) where width is below 0 (its size counts)
 * D: GTR of alpha cos(d)^narrow and tail, alpha^2 (1 + wider (1 - cos d)) in t; V: Smith of mask + tie alpha
 * s = (1 - cos d)^rise */
enum { EDGE, RETRO, LIFT, WIDTH, ALPHA, TAIL, NARROW, WIDER, MASK, TIE, RISE, NUMBERS };
#define FREE(number) (1u << (number))
static const SearchAxis axes[NUMBERS] = {{0.0, 1.0},  {0.0, 6.0}, {0.0, 8.0}, {-0.6, -0.01}, {0.05, 0.99}, {0.25, 4.0},
                                         {-0.3, 2.0}, {0.0, 1.0}, {0.1, 1.0}, {0.0, 1.0},    {1.0, 6.0}};

typedef struct Form {
    const char *name;
    unsigned free;
    double number[NUMBERS]; /* where the search begins, or what it is */
} Form;

#define YARN  (FREE(EDGE) | FREE(RETRO) | FREE(ALPHA) | FREE(TAIL) | FREE(NARROW))
#define CLOTH (FREE(EDGE) | FREE(RETRO) | FREE(LIFT) | FREE(ALPHA) | FREE(TAIL) | FREE(RISE))
/*                                              edge retro lift width alpha tail narrow wider mask tie rise */
static const Form forms[] = {
    {"ggx, f90 free, over lambert", FREE(ALPHA), {0, 0, 0, 1, .4, 2, 0, 0, 0, 1, 5}},
    {"the same, rise and retro free", FREE(ALPHA) | FREE(RISE) | FREE(RETRO), {0, .2, 0, -.12, .4, 2, 0, 0, 0, 1, 5}},
    {"narrowing, mask", YARN | FREE(MASK), {.1, .2, 0, -.12, .4, .6, .24, 0, .5, 0, 3.5}},
    {"narrowing, mask, rise, width",
     YARN | FREE(MASK) | FREE(RISE) | FREE(WIDTH),
     {.1, .2, 0, -.12, .4, .6, .24, 0, .5, 0, 3.5}},
    {"narrowing, rise", YARN | FREE(RISE), {.1, .2, 0, -.12, .4, .6, .24, 0, .5, 0, 3.5}},
    {"lift, hyperbola 0.2", CLOTH, {.1, .2, .3, -.2, .4, .6, 0, 0, .5, 0, 3}},
    {"lift, exp 0.3", CLOTH, {.1, .2, .3, .3, .4, .6, 0, 0, .5, 0, 3}},
    {"lift, exp 0.35, mask of alpha", CLOTH, {.1, .2, .3, .35, .4, .6, 0, 0, .25, .5, 3}},
    {"that, wider 0.2", CLOTH, {.1, .2, .3, .35, .4, .6, 0, .2, .25, .5, 3}},
    {"that, wider 0.5: fabric over body", CLOTH, {.1, .2, .3, .35, .4, .6, 0, .5, .25, .5, 3}},
    {"that, wider 1", CLOTH, {.1, .2, .3, .35, .4, .6, 0, 1, .25, .5, 3}},
};
enum { FORMS = sizeof forms / sizeof *forms, FABRICS = 16 };

/* The numbers of a pair of directions that the forms read: cosines, and sin_h squared. */
typedef struct Pair {
    float i, o, d, sin2_h;
} Pair;

typedef struct Work {
    int fabrics;
    Samples samples[FABRICS];
    Pair *pairs[FABRICS];
    double error[FORMS][FABRICS];
} Work;

typedef struct Fit {
    const Form *form;
    const Samples *samples;
    const Pair *pairs;
    float *column[3], *work; /* x of the body, of f0, of f90 */
} Fit;

static float peak_of(float width, float tan_d) {
    return width < 0.0f ? -width / (tan_d - width) : expf(-tan_d / width);
}

static float shadow_of(float m, Pair p) {
    float rest = 1.0f - m * m, o = sqrtf(m * m + rest * p.o * p.o), i = sqrtf(m * m + rest * p.i * p.i);
    return 0.5f / (p.i * o + p.o * i);
}

static float spread_of(const float *n, Pair p) {
    float tail = fabsf(n[TAIL] - 1.0f) < 1e-3f ? 1.001f : n[TAIL];
    float alpha = fminf(fmaxf(n[ALPHA] * powf(p.d, n[NARROW]), 0.005f), 0.995f), a2 = alpha * alpha;
    float t = p.sin2_h + a2 * (1.0f + n[WIDER] * (1.0f - p.d)) * (1.0f - p.sin2_h);
    return (tail - 1.0f) * (1.0f - a2) / (PI_FLOAT * (powf(a2, 1.0f - tail) - 1.0f)) * powf(t, -tail);
}

static void columns_fill(const Fit *fit, const float *n, int count) {
    for (int k = 0; k < count; k++) {
        Pair p = fit->pairs[k];
        float sin2 = fmaxf(1.0f - p.d * p.d, 0.0f), s = powf(fmaxf(1.0f - p.d, 1e-9f), n[RISE]);
        float body = 1.0f + n[RETRO] * peak_of(n[WIDTH], sqrtf(sin2) / p.d) + n[LIFT] * sin2;
        float facets = spread_of(n, p) * shadow_of(n[MASK] + n[TIE] * n[ALPHA], p) * p.i;
        fit->column[0][k] = powf(p.i * p.o, n[EDGE]) * body * p.i;
        fit->column[1][k] = facets * (1.0f - s);
        fit->column[2][k] = facets * s;
    }
}

/* The free numbers of a form, from x. */
static void numbers_of(const Form *form, const double *x, float *n) {
    for (int k = 0; k < NUMBERS; k++) n[k] = (float)(form->free >> k & 1u ? *x++ : form->number[k]);
}

static double error_at(void *user, double *x, SearchCare care) {
    const Fit *fit = user;
    const Samples *s = fit->samples;
    int count = care == SEARCH_FULL ? s->count : s->first;
    float n[NUMBERS];
    double sum = 0.0, weights[BLEND_MOST];
    numbers_of(fit->form, x, n);
    columns_fill(fit, n, count);
    for (int c = 0; c < s->channels; c++) {
        Blend blend = {.columns = 3, .work = fit->work};
        for (int k = 0; k < 3; k++) blend.column[k][c] = fit->column[k];
        sum += blend_solve(s, count, c, &blend, weights);
    }
    return sum;
}

static double fit_error(const Form *form, const Samples *samples, const Pair *pairs) {
    size_t n = (size_t)samples->count;
    float *block = malloc(6 * n * sizeof *block);
    double x[SEARCH_MOST];
    if (!block) return (double)NAN;
    Fit fit = {form, samples, pairs, {block, block + n, block + 2 * n}, block + 3 * n};
    Search search = {.error = error_at, .user = &fit, .grid = 600, .descents = 4, .most = 1000};
    for (int k = 0; k < NUMBERS; k++) {
        if (!(form->free >> k & 1u)) continue;
        x[search.axes] = form->number[k];
        search.axis[search.axes++] = axes[k];
    }
    double error = search_run(&search, x, NULL);
    free(block);
    return error;
}

static void fit_one(void *user, int item, int thread) {
    (void)thread;
    Work *work = user;
    int form = item / work->fabrics, fabric = item % work->fabrics;
    work->error[form][fabric] = fit_error(&forms[form], &work->samples[fabric], work->pairs[fabric]);
}

static int read_fabric(Work *work, const char *path) {
    WeftData *data;
    WeftError error;
    Samples *s = &work->samples[work->fabrics];
    if (weft_data_read(path, &data, &error) != WEFT_OK) return fprintf(stderr, "%s\n", error.text);
    int good = data_samples(data, WEFT_BRDF_METRIC_LOG, s);
    weft_data_free(data);
    Pair *pairs = good ? malloc((size_t)s->count * sizeof *pairs) : NULL;
    if (!pairs) return fprintf(stderr, "%s: memory is short\n", path);
    for (int k = 0; k < s->count; k++) {
        float x = s->o[0][k] + s->i[0][k], y = s->o[1][k] + s->i[1][k], z = s->o[2][k] + s->i[2][k];
        float t2 = x * x + y * y, s2 = t2 + z * z;
        pairs[k] = (Pair){s->i[2][k], s->o[2][k], fminf(0.5f * sqrtf(s2), 1.0f), t2 / s2};
    }
    work->pairs[work->fabrics++] = pairs;
    return 0;
}

/* The mean error of a form over all fabrics but one; of all where there is no such one. */
static double mean_without(const Work *work, int form, int left_out) {
    double sum = 0.0;
    int count = 0;
    for (int k = 0; k < work->fabrics; k++)
        if (k != left_out) sum += work->error[form][k], count++;
    return sum / count;
}

static int numbers_count(const Form *form) {
    int count = 9; /* three colours */
    for (int k = 0; k < NUMBERS; k++) count += (int)(form->free >> k & 1u);
    return count;
}

/* The best of the forms of at most 15 numbers, by all fabrics but one. */
static int choose(const Work *work, int left_out) {
    int best = 0;
    for (int form = 0; form < FORMS; form++)
        if (numbers_count(&forms[form]) <= 15 &&
            mean_without(work, form, left_out) < mean_without(work, best, left_out))
            best = form;
    return best;
}

static void print_all(const Work *work) {
    double sum = 0.0;
    printf("%-36s numbers  errors by fabric, as in the order given; mean\n", "form");
    for (int form = 0; form < FORMS; form++) {
        printf("%-36s %7d ", forms[form].name, numbers_count(&forms[form]));
        for (int k = 0; k < work->fabrics; k++) printf(" %.4f", work->error[form][k]);
        printf("  %.4f\n", mean_without(work, form, -1));
    }
    printf("\nleave-one-out, of forms of at most 15 numbers:\n");
    for (int k = 0; k < work->fabrics; k++) {
        int form = choose(work, k);
        printf("without fabric %d: %-36s %.4f on it\n", k + 1, forms[form].name, work->error[form][k]);
        sum += work->error[form][k];
    }
    printf("mean %.4f, which is %.3f of %s\n", sum / work->fabrics, sum / work->fabrics / mean_without(work, 0, -1),
           forms[0].name);
    printf("these are fits of measurements, which the fabrics themselves need not follow\n");
}

int main(int argc, char **argv) {
    static Work work;
    if (argc < 3 || argc > FABRICS + 1) {
        fprintf(stderr, "usage: study_fabric a.binary b.binary ...: two to %d measurements\n", FABRICS);
        return 2;
    }
    for (int k = 1; k < argc; k++)
        if (read_fabric(&work, argv[k])) return 3;
    parallel_for(0, FORMS * work.fabrics, fit_one, &work);
    print_all(&work);
    for (int k = 0; k < work.fabrics; k++) {
        samples_free(&work.samples[k]);
        free(work.pairs[k]);
    }
    return 0;
}
