/* each - the cost of a lobe of its own for each element of an array, lobe by lobe
 *
 *   bench_each [--quick]
 *
 * Million elements a second of one core, f and pdf and then samples with their pdf: by the calls for one
 * pair, a lobe made before; by those of arrays with one lobe for all; and by those with parameters and
 * colours of each element. Every figure is the best of many short runs over 4096 elements, the columns taken
 * in turn. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/steady_clock.h"
#include "weft/arrays.h"

enum { N = 4096, ROWS = 6 + 2 + 6 + WEFT_LOBE_PARAMS_MAX, COLUMNS = 6 };

static float in[ROWS][N], out[8][N];
static WeftLobe lobe;
static WeftLobes lobes;

static const WeftDirections wo = {in[0], in[1], in[2]}, wi = {in[3], in[4], in[5]};
static const WeftColors f = {out[0], out[1], out[2]};

static void pairs_one_by_one(void) {
    for (int k = 0; k < N; k++) {
        const float o[3] = {in[0][k], in[1][k], in[2][k]}, i[3] = {in[3][k], in[4][k], in[5][k]};
        float color[3];
        weft_lobe_eval(&lobe, o, i, color);
        for (int c = 0; c < 3; c++) out[c][k] = color[c];
        out[3][k] = weft_lobe_pdf(&lobe, o, i);
    }
}
static void pairs_of_one(void) {
    weft_eval_n(&lobe, N, wo, wi, f, NULL);
    weft_pdf_n(&lobe, N, wo, wi, out[3], NULL);
}
static void pairs_of_each(void) { weft_eval_each(&lobes, N, wo, wi, f, out[3], NULL); }

static void samples_one_by_one(void) {
    for (int k = 0; k < N; k++) {
        const float o[3] = {in[0][k], in[1][k], in[2][k]}, u[2] = {in[6][k], in[7][k]};
        float i[3];
        out[7][k] = weft_lobe_sample(&lobe, o, u, i);
        for (int c = 0; c < 3; c++) out[4 + c][k] = i[c];
    }
}
static void samples_of_one(void) { weft_sample_n(&lobe, N, wo, in[6], in[7], out[4], out[5], out[6], out[7], NULL); }
static void samples_of_each(void) {
    weft_sample_each(&lobes, N, wo, in[6], in[7], out[4], out[5], out[6], out[7], NULL);
}

static void (*const columns[COLUMNS])(void) = {pairs_one_by_one,   pairs_of_one,   pairs_of_each,
                                               samples_one_by_one, samples_of_one, samples_of_each};

static float unit(void) { return (float)(rand() % (1 << 20)) / (float)(1 << 20); }

static void random_direction(int row, int k) {
    float z = 1.0f - unit(), s = sqrtf(1.0f - z * z), phi = 6.2831853f * unit();
    in[row][k] = s * cosf(phi);
    in[row + 1][k] = s * sinf(phi);
    in[row + 2][k] = z;
}

/* Parameters over their plausible ranges, choices as they are. */
static void inputs_make(const WeftLobeInfo *info) {
    lobes = (WeftLobes){.lobe = lobe};
    for (int k = 0; k < N; k++) {
        random_direction(0, k);
        random_direction(3, k);
        for (int row = 6; row < 14; row++) in[row][k] = unit();
        for (int p = 0; p < info->param_count; p++)
            in[14 + p][k] = info->params[p].low + (info->params[p].high - info->params[p].low) * unit();
    }
    for (int c = 0; c < 3; c++) lobes.f0[c] = in[8 + c], lobes.f90[c] = in[11 + c];
    for (int p = 0; p < info->param_count; p++)
        if (!info->params[p].choices) lobes.params[p] = in[14 + p];
}

int main(int argc, char **argv) {
    int rounds = argc > 1 && strcmp(argv[1], "--quick") == 0 ? 10 : 60;
    printf("each: million elements a second of one core\n%-28s %9s %9s %9s %9s %9s %9s\n%-28s %9s %9s %9s "
           "%9s %9s %9s\n",
           "", "f, pdf", "", "", "samples", "", "", "lobe", "pairs", "one lobe", "each", "pairs", "one lobe", "each");
    for (int id = 0; weft_lobe_info(id); id++) {
        const WeftLobeInfo *info = weft_lobe_info(id);
        if (info->traits & WEFT_LOBE_REFERENCE || weft_lobe_init(info->id, &lobe, NULL) != WEFT_OK) continue;
        inputs_make(info);
        double best[COLUMNS];
        for (int r = 0; r < rounds; r++)
            for (int c = 0; c < COLUMNS; c++) {
                double start = clock_now(), seconds;
                columns[c]();
                seconds = clock_now() - start;
                if (r == 0 || seconds < best[c]) best[c] = seconds;
            }
        printf("%-28s", info->id);
        for (int c = 0; c < COLUMNS; c++) printf(" %9.1f", 1e-6 * N / best[c]);
        printf("\n");
        fflush(stdout);
    }
    return 0;
}
