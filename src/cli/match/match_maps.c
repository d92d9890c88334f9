/* match_maps.c - the parameter of one lobe as a function of another's: matched over a sweep, and as a formula
 * if that is good enough */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/console/interrupt.h"
#include "cli/console/json_writer.h"
#include "cli/console/progress.h"
#include "cli/console/report.h"
#include "cli/match/match_verb.h"

/* The sweep, as a fraction of the plausible range of the first parameter: at its ends the lobes are too
 * narrow for a fit. */
enum { SWEEP = 7, LOBES_MOST = 32 };
static const double places[SWEEP] = {0.1, 0.2, 0.3, 0.45, 0.6, 0.75, 0.9};

/* The formula is printed if it adds no more than this to the error of the match. */
static const double good_enough = 0.03;

typedef struct Maps {
    int lobes[LOBES_MOST], count;
    WeftReflection *from[LOBES_MOST][SWEEP];
    WeftLobe source[LOBES_MOST][SWEEP];
    WeftMatchJob *jobs; /* [from][to][sweep] */
} Maps;

/* The formula p' = a p^b, colour' = c colour p^d, fitted by least squares of the logarithms. */
typedef struct MapFormula {
    double a, b, c, d;
    double matched, worst; /* mean error of the matches; largest error that the formula adds to one */
} MapFormula;

/* Returns true if the lobe is a sheen of one colour whose first parameter is a width. */
static int is_sheen(int lobe) {
    const WeftLobeInfo *info = weft_lobe_info(lobe);
    unsigned other = WEFT_LOBE_DIFFUSE | WEFT_LOBE_REFERENCE | WEFT_LOBE_TWO_COLORS;
    return !(info->traits & other) && info->param_count > 0 && !info->params[0].choices;
}

static WeftMatchJob *job_of(const Maps *maps, int from, int to, int k) {
    return &maps->jobs[(from * maps->count + to) * SWEEP + k];
}

static int prepare(Maps *maps) {
    WeftError error;
    for (int k = 0; k < weft_lobe_count() && maps->count < LOBES_MOST; k++)
        if (is_sheen(k)) maps->lobes[maps->count++] = k;
    maps->jobs = calloc((size_t)LOBES_MOST * LOBES_MOST * SWEEP, sizeof *maps->jobs);
    if (!maps->jobs) return report(WEFT_RESOURCES, "%s", weft_message_text(WEFT_MESSAGE_MEMORY));
    for (int n = 0; n < maps->count; n++)
        for (int k = 0; k < SWEEP; k++) {
            WeftLobe *lobe = &maps->source[n][k];
            const WeftParamInfo *p = weft_lobe_info(maps->lobes[n])->params;
            if (weft_lobe_init(weft_lobe_info(maps->lobes[n])->id, lobe, &error) != WEFT_OK)
                return report_error(&error);
            lobe->params[0] = p->low + (float)places[k] * (p->high - p->low);
            for (int c = 0; c < 3; c++) lobe->f0[c] = 0.8f;
            if (weft_reflection_of_lobe(lobe, &maps->from[n][k], &error) != WEFT_OK) return report_error(&error);
        }
    for (int j = 0; j < maps->count * maps->count * SWEEP; j++) {
        int k = j % SWEEP, to = j / SWEEP % maps->count, from = j / SWEEP / maps->count;
        maps->jobs[j] = (WeftMatchJob){.from = maps->from[from][k],
                                       .is_lobe = 1,
                                       .hold = 0xfe, /* all but the first */
                                       .lobe = maps->source[to][k]};
    }
    return 0;
}

/* Fits y = a x^b to points with x, y > 0 by least squares of the logarithms. */
static void power_law(const double *x, const double *y, double *a, double *b) {
    double n = 0.0, sx = 0.0, sy = 0.0, sxx = 0.0, sxy = 0.0;
    for (int k = 0; k < SWEEP; k++) {
        double u = log(x[k]), v = log(fmax(y[k], 1e-6));
        n += 1.0, sx += u, sy += v, sxx += u * u, sxy += u * v;
    }
    *b = (n * sxy - sx * sy) / fmax(n * sxx - sx * sx, 1e-12);
    *a = exp((sy - *b * sx) / n);
}

static int formula_of(const Maps *maps, int from, int to, WeftBrdfMetric metric, MapFormula *out) {
    double x[SWEEP], y[SWEEP], z[SWEEP];
    *out = (MapFormula){.worst = 0.0};
    for (int k = 0; k < SWEEP; k++) {
        const WeftMatchJob *job = job_of(maps, from, to, k);
        x[k] = (double)maps->source[from][k].params[0];
        y[k] = (double)job->lobe.params[0];
        z[k] = (double)job->lobe.f0[0] / (double)maps->source[from][k].f0[0];
        out->matched += job->found.matched / SWEEP;
    }
    power_law(x, y, &out->a, &out->b);
    power_law(x, z, &out->c, &out->d);
    for (int k = 0; k < SWEEP; k++) {
        WeftLobe lobe = job_of(maps, from, to, k)->lobe;
        WeftReflection *of_formula;
        WeftError error;
        double distance = 1.0;
        lobe.params[0] = (float)(out->a * pow(x[k], out->b));
        for (int c = 0; c < 3; c++)
            lobe.f0[c] = (float)((double)maps->source[from][k].f0[c] * out->c * pow(x[k], out->d));
        WeftResult result = weft_reflection_of_lobe(&lobe, &of_formula, &error);
        if (result == WEFT_OK)
            result = weft_brdf_distance(of_formula, maps->from[from][k], WEFT_PART_ALL, metric, &distance, &error);
        weft_reflection_free(of_formula);
        if (result != WEFT_OK) return report_error(&error);
        out->worst = fmax(out->worst, distance - job_of(maps, from, to, k)->found.matched);
    }
    return 0;
}

static void text_write(const Maps *maps, int from, int to, const MapFormula *f) {
    const WeftLobeInfo *a = weft_lobe_info(maps->lobes[from]), *b = weft_lobe_info(maps->lobes[to]);
    printf("%-27s %-27s %7.4f  ", a->id, b->id, f->matched);
    if (f->worst <= good_enough) {
        printf("%s' = %.3f %s^%.3f, color' = %.3f %s^%.3f color; adds %.4f\n", b->params[0].name, f->a,
               a->params[0].name, f->b, f->c, a->params[0].name, f->d, f->worst);
        return;
    }
    for (int k = 0; k < SWEEP; k++)
        printf("%s%.3g:%.3g", k ? "  " : "", (double)maps->source[from][k].params[0],
               (double)job_of(maps, from, to, k)->lobe.params[0]);
    printf("\n");
}

static void json_write(Json *json, const Maps *maps, int from, int to, const MapFormula *f) {
    json_open(json, NULL, '{');
    json_text(json, "from", weft_lobe_info(maps->lobes[from])->id);
    json_text(json, "to", weft_lobe_info(maps->lobes[to])->id);
    json_number(json, "matched", f->matched);
    json_open(json, "formula", '{');
    json_number(json, "a", f->a);
    json_number(json, "b", f->b);
    json_number(json, "c", f->c);
    json_number(json, "d", f->d);
    json_number(json, "adds", f->worst);
    json_close(json, '}');
    json_open(json, "sweep", '[');
    for (int k = 0; k < SWEEP; k++) {
        const WeftMatchJob *job = job_of(maps, from, to, k);
        json_open(json, NULL, '{');
        json_float(json, "from", maps->source[from][k].params[0]);
        json_float(json, "to", job->lobe.params[0]);
        json_number(json, "color", (double)job->lobe.f0[0] / (double)maps->source[from][k].f0[0]);
        json_number(json, "copied", job->found.copied);
        json_number(json, "matched", job->found.matched);
        json_close(json, '}');
    }
    json_close(json, ']');
    json_close(json, '}');
}

static int write_all(const Maps *maps, WeftBrdfMetric metric, bool as_json) {
    Json json = {.stream = stdout};
    int result = 0;
    if (as_json)
        json_open(&json, NULL, '[');
    else
        printf("%-27s %-27s %7s  %s\n", "from", "to", weft_brdf_metric_name(metric),
               "formula, and what it adds at worst; or FROM:TO");
    for (int j = 0; j < maps->count * maps->count && result == 0; j++) {
        MapFormula formula;
        int from = j / maps->count, to = j % maps->count;
        if (from == to) continue;
        result = formula_of(maps, from, to, metric, &formula);
        if (result != 0) break;
        if (as_json)
            json_write(&json, maps, from, to, &formula);
        else
            text_write(maps, from, to, &formula);
    }
    if (as_json) json_close(&json, ']');
    return result;
}

static int match_all(Maps *maps, WeftBrdfMetric metric) {
    WeftError error;
    int count = maps->count * maps->count * SWEEP;
    Progress progress = progress_start_count(false, "matches", count);
    interrupt_watch();
    WeftResult result = weft_match_many(maps->jobs, count, metric, 0, progress_heed, &progress, &error);
    progress_finish(&progress);
    if (result == WEFT_INTERRUPTED) return report(WEFT_INTERRUPTED, "interrupted");
    return result == WEFT_OK ? 0 : report_error(&error);
}

int match_maps(const Options *options, WeftBrdfMetric metric) {
    Maps *maps = calloc(1, sizeof *maps);
    if (!maps) return report(WEFT_RESOURCES, "%s", weft_message_text(WEFT_MESSAGE_MEMORY));
    int result = prepare(maps);
    if (result == 0) result = match_all(maps, metric);
    if (result == 0) result = write_all(maps, metric, option_given(options, "--json"));
    for (int n = 0; n < maps->count; n++)
        for (int k = 0; k < SWEEP; k++) weft_reflection_free(maps->from[n][k]);
    free(maps->jobs);
    free(maps);
    return result;
}
