/* ltc - prints how far the linearly transformed cosines of each lobe stay from it, and what they cost:
 *
 *   study_ltc [SIDE]        a table of SIDE by SIDE nodes for each lobe, 32 unless said
 *   study_ltc norms [SIDE]  the mean error, and the mean of the third norm, when the first, the second or the
 *                           third norm of the difference is made least
 *
 * Errors are in hundredths of E: the integral of |f cos_i - amplitude D| over wi, where E >= 1e-3. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "measure/ltc/ltc_bake.h"
#include "measure/ltc/ltc_fit.h"

enum { CELLS = 96 };

/* What a table says at one wo, beside the lobe itself for f0 and f90 = 1. */
typedef struct Difference {
    double e, first, third; /* E; the norms of f cos_i / E - D */
    double e_off;           /* the table's E less the lobe's */
} Difference;

static LtcEntries entries_of(WeftLtcLobe at) { return (LtcEntries){at.z, at.q, at.b, at.r}; }

static Difference difference(LtcTarget *target, const WeftLtc *ltc, const Lobe *lobe, float cos_o, float f0) {
    float second = lobe_second(lobe, f0, 1.0f);
    WeftLtcLobe at = weft_ltc_at(ltc, cos_o, lobe->params[0]);
    Ltc m = ltc_of(at.z, at.q, at.b, at.r, cos_o);
    ltc_target_fill(target, cos_o);
    ltc_target_lobe(target, lobe, f0, second);
    Difference d = {.e = target->e};
    if (!(d.e >= 1e-3)) return d;
    d.first = ltc_error(target, entries_of(at), 1);
    d.third = ltc_error(target, entries_of(at), 3);
    d.e_off = fabs((double)((f0 * at.amplitude + second * at.amplitude_f90) * ltc_above(m, target->o)) - d.e);
    return d;
}

/* Over the nodes of a table, or over the middles between four of them. */
static Difference mean_difference(LtcTarget *target, const WeftLtc *ltc, bool between, float f0, Difference *worst) {
    Difference mean = {0};
    *worst = mean;
    int rows = between && ltc->rows > 1 ? ltc->rows - 1 : ltc->rows, columns = ltc->columns - between, n = 0;
    for (int row = 0; row < rows; row++)
        for (int column = 0; column < columns; column++) {
            Lobe lobe = ltc_lobe(ltc, row);
            float cos_o = ltc_cos_o(ltc, column);
            if (between) {
                float x = 0.5f * (sqrt(cos_o) + sqrt(ltc_cos_o(ltc, column + 1)));
                cos_o = x * x;
            }
            if (between && ltc->rows > 1) {
                float y = 0.5f * (sqrt(lobe.params[0]) + sqrt(ltc_lobe(ltc, row + 1).params[0]));
                lobe_set(&lobe, 0, y * y);
            }
            Difference d = difference(target, ltc, &lobe, cos_o, f0);
            if (!(d.e >= 1e-3)) continue;
            n++;
            mean.first += d.first, mean.third += d.third;
            worst->first = fmax(worst->first, d.first);
            worst->e_off = fmax(worst->e_off, d.e_off);
        }
    mean.first /= n, mean.third /= n;
    return mean;
}

static WeftLtc *make(int id, WeftLtcDesc desc) {
    WeftLobe lobe;
    WeftLtc *ltc;
    WeftError error;
    desc.no_cache = 1;
    if (weft_lobe_init(weft_lobe_info(id)->id, &lobe, &error) == WEFT_OK &&
        weft_ltc_create(&lobe, &desc, &ltc, NULL, &error) == WEFT_OK)
        return ltc;
    printf("%s\n", error.text);
    return NULL;
}

static void print_table(LtcTarget *target, int side) {
    printf("%d by %d nodes; errors in %% of E\n"
           "                             at the nodes                      between them           f0 0.04\n"
           "lobe                         mean  worst  at value, cos_o      mean  worst  E off     white  own"
           "    seconds\n",
           side, side);
    for (int id = 0; id < weft_lobe_count(); id++) {
        WeftLtcDesc desc = {.rows = side, .columns = side};
        WeftLtc *white = make(id, desc), *own = NULL;
        if (!white) continue;
        WeftLtcInfo info = weft_ltc_info(white);
        Difference worst, mean = mean_difference(target, white, true, 1.0f, &worst);
        printf("%-27s %5.1f  %5.1f  %7.3g %-8.2g   %7.1f %6.1f  %.4f  ", weft_lobe_info(id)->id,
               100.0 * (double)info.mean_error, 100.0 * (double)info.worst_error, (double)info.worst_value,
               (double)info.worst_cos_o, 100.0 * mean.first, 100.0 * worst.first, worst.e_off);
        if (weft_lobe_info(id)->traits & TRAIT_TWO_COLORS) {
            desc.f0 = 0.04f, desc.f90 = 1.0f;
            own = make(id, desc);
        }
        if (own)
            printf("%7.1f %5.1f", 100.0 * mean_difference(target, white, false, 0.04f, &worst).first,
                   100.0 * (double)weft_ltc_info(own).mean_error);
        else
            printf("%7s %5s", "-", "-");
        printf("   %6.2f\n", info.seconds);
        weft_ltc_free(white);
        weft_ltc_free(own);
    }
}

static void print_norms(LtcTarget *target, int side) {
    printf("%d by %d nodes; means over the nodes, by the norm that was made least\n"
           "                             first norm, %%         third norm\n"
           "lobe                              1      2      3       1       2       3\n",
           side, side);
    for (int id = 0; id < weft_lobe_count(); id++) {
        Difference mean[3], worst;
        bool made = true;
        for (int norm = 1; norm <= 3 && made; norm++) {
            WeftLtc *ltc = make(id, (WeftLtcDesc){.rows = side, .columns = side, .norm = norm});
            made = ltc != NULL;
            if (made) mean[norm - 1] = mean_difference(target, ltc, false, 1.0f, &worst);
            weft_ltc_free(ltc);
        }
        if (!made) continue;
        printf("%-27s", weft_lobe_info(id)->id);
        for (int k = 0; k < 3; k++) printf(" %6.2f", 100.0 * mean[k].first);
        for (int k = 0; k < 3; k++) printf(" %7.3f", mean[k].third);
        printf("\n");
    }
}

int main(int argc, char **argv) {
    bool norms = argc > 1 && strcmp(argv[1], "norms") == 0;
    int at = norms ? 2 : 1, side = argc > at ? atoi(argv[at]) : 32;
    LtcTarget target;
    if (argc > at + 1 || side < 4 || side > 256) {
        fputs("study_ltc [norms] [SIDE], SIDE 4 to 256\n", stderr);
        return WEFT_USAGE;
    }
    if (!ltc_target_create(&target, CELLS)) {
        fputs("study_ltc: out of memory\n", stderr);
        return WEFT_RESOURCES;
    }
    if (norms)
        print_norms(&target, side);
    else
        print_table(&target, side);
    ltc_target_free(&target);
    return 0;
}
