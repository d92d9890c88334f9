/* The solved slab against what is known: its phase function, conservation, both ways of solving, figures of
 * finer quadratures, and the random walk
 *
 * Labels: unsanitized */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

#include <cmocka.h>

#include "base/pi.h"
#include "base/random.h"
#include "fibre/slab.h"
#include "fibre/tilted.h"
#include "fibre/walk.h"

static double albedo(Slab slab, SlabEffort effort, double mu, double *through, double *defect) {
    double up;
    assert_true(slab_mode(&slab, effort, 0, 1, 1, &mu, &(Layered){.up = &up, .down = through}, defect));
    return up;
}

/* f of the single scattering, its modes summed, against the closed form. */
static void modes_of_a_thin_slab_sum_to_single_scattering(void **state) {
    (void)state;
    Slab slab = {0.6, 0.7, 1.3};
    for (int k = 0; k < 8; k++) {
        double mu_i = 0.05 + 0.11 * k, mu_o = 0.93 - 0.1 * k, phi = 0.4 * k, f = 0.0;
        for (int m = 0; m < 60; m++)
            f += (m ? 2.0 : 1.0) * slab_single_mode(&slab, m, mu_i, mu_o) * cos(m * phi) / (2.0 * PI_DOUBLE);
        double reference = slab_single(&slab, mu_i, mu_o, cos(phi));
        assert_true(fabs(f - reference) < 1e-9 * reference + 1e-12);
    }
}

/* White fibres lose nothing, dark ones all but what meets one. */
static void white_slab_conserves_light(void **state) {
    (void)state;
    double through, defect, mu[] = {1e-3, 0.05, 0.4, 0.95};
    for (double alpha = 0.1; alpha < 1.01; alpha += 0.3)
        for (int k = 0; k < 4; k++) {
            Slab slab = {fmin(alpha, 1.0), 1.0, 0.25 * (1 << (2 * k))};
            SlabEffort effort = slab_effort(slab.alpha);
            effort.halvings += 8;
            double up = albedo(slab, effort, mu[k], &through, &defect);
            if (fabs(up + through - 1.0) > 1e-5)
                printf("alpha %g mu %g: R + T - 1 = %g\n", alpha, mu[k], up + through - 1.0);
            assert_true(fabs(up + through - 1.0) <= 1e-5);
            slab.albedo = 0.0;
            assert_true(albedo(slab, effort, mu[k], &through, NULL) == 0.0);
        }
}

/* alpha 1 is a slab of isotropic scatterers but for 1 / (4 pi) D = 1 / pi: R of the half-space limit grows
 * to 1. */
static void deep_white_slab_returns_all_light(void **state) {
    (void)state;
    double before = 0.0;
    for (double depth = 1.0; depth < 600.0; depth *= 8.0) {
        double up = albedo((Slab){1.0, 1.0, depth}, (SlabEffort){48, 34}, 0.7, NULL, NULL);
        assert_true(up > before && up < 1.0);
        before = up;
    }
    assert_true(before > 0.99);
}

/* Depths come from one run as they do from one each. */
static void several_depths_of_one_run_equal_runs_of_one_depth(void **state) {
    (void)state;
    double mu[] = {0.2, 0.8}, r[3 * 4], one[4];
    assert_true(slab_mode(&(Slab){0.4, 0.9, 2.0}, (SlabEffort){48, 30}, 1, 3, 2, mu, &(Layered){.r = r}, NULL));
    for (int k = 0; k < 3; k++) {
        assert_true(slab_mode(&(Slab){0.4, 0.9, 0.5 * (1 << k)}, (SlabEffort){48, 28 + k}, 1, 1, 2, mu,
                              &(Layered){.r = one}, NULL));
        for (int c = 0; c < 4; c++) assert_true(fabs(one[c] - r[4 * k + c]) < 1e-10 * fabs(one[c]) + 1e-13);
    }
}

/* R and f do not move when the quadrature doubles: where this fails is where the solver is not to be trusted.
 */
static void doubled_quadrature_changes_nothing(void **state) {
    (void)state;
    const double mu[] = {0.01, 0.2, 0.7};
    for (double alpha = 0.065; alpha < 1.0; alpha *= 2.4) {
        double coarse[3], fine[3];
        SlabEffort effort = slab_effort(alpha);
        Slab slab = {alpha, 1.0, 1.0};
        assert_true(slab_mode(&slab, effort, 0, 1, 3, mu, &(Layered){.up = coarse}, NULL));
        effort.nodes += effort.nodes / 2;
        assert_true(slab_mode(&slab, effort, 0, 1, 3, mu, &(Layered){.up = fine}, NULL));
        for (int k = 0; k < 3; k++) {
            if (fabs(coarse[k] - fine[k]) > 1e-4)
                printf("alpha %g mu %g: %g against %g\n", alpha, mu[k], coarse[k], fine[k]);
            assert_true(fabs(coarse[k] - fine[k]) <= 1e-4);
        }
    }
}

static double upright_f(const Slab *slab, double mu_i, double mu_o, double phi) {
    double mu[] = {mu_i, mu_o}, r[4], f = slab_single(slab, mu_i, mu_o, cos(phi));
    for (int m = 0; m < 8; m++) {
        assert_true(slab_mode(slab, (SlabEffort){64, 30}, m, 1, 2, mu, &(Layered){.r = r}, NULL));
        f += (m ? 2.0 : 1.0) * (r[1] - slab_single_mode(slab, m, mu_i, mu_o)) * cos(m * phi) / (2.0 * PI_DOUBLE);
    }
    return f;
}

/* The two solvers have no line in common but the doubling. */
static void tilted_solver_without_tilt_equals_the_upright_one(void **state) {
    (void)state;
    Slab slab = {0.6, 0.9, 1.5};
    Heading at[] = {{0.3, 0.4}, {0.7, 2.0}};
    double same[4], across[4];
    assert_true(tilted_f(&slab, 0.0, (TiltEffort){14, 28, 28}, 1, 2, at, same, across, NULL));
    assert_true(fabs(same[1] / upright_f(&slab, 0.3, 0.7, 1.6) - 1.0) < 2e-3);
    assert_true(fabs(across[1] / upright_f(&slab, 0.3, 0.7, 2.4) - 1.0) < 2e-3);
    assert_true(fabs(same[1] - same[2]) < 1e-12);
}

/* ---- against the walk ---- */

typedef struct Score {
    double worst;
    int count;
} Score;

static void compare(Score *score, const WalkDesc *desc, const WalkEstimate *walked, const double *solved) {
    for (int k = 0; k < desc->directions; k++) {
        /* where one walk in ten thousand brings all of it, means of batches are skewed, and say too little */
        if (walked[k].error * sqrt((double)desc->walks) > 100.0 * solved[k]) continue;
        /* what the solver's own quadrature may err by, beside the walk's error */
        double margin = 3e-3 * solved[k], off = fmax(fabs(walked[k].mean - solved[k]) - margin, 0.0);
        score->worst = fmax(score->worst, off / walked[k].error);
        score->count++;
        if (off > 4.1 * walked[k].error)
            printf("alpha %g tilt %g albedo %g depth %g wi %g %g %g: solved %g, walked %g +- %g\n", desc->alpha,
                   desc->tilt, desc->albedo, desc->thickness, desc->wi[3 * k], desc->wi[3 * k + 1], desc->wi[3 * k + 2],
                   solved[k], walked[k].mean, walked[k].error);
    }
}

enum { WIS = 5 };

/* f towards five directions, light scattered once left out of both. */
static void case_run(Score *score, uint32_t seed, bool tilts, long long walks) {
    double u[12];
    for (int k = 0; k < 12; k++) u[k] = (double)unit_float(hash_combine(seed, (uint32_t)k));
    Slab slab = {0.3 + 0.7 * u[0], 0.3 + 0.7 * u[1], 0.25 + 2.0 * u[2]};
    double tilt = tilts ? 0.75 * u[3] : 0.0, wi[3 * WIS], solved[WIS];
    Heading at[WIS + 1] = {{0.05 + 0.9 * u[4], PI_DOUBLE * u[5]}};
    WalkEstimate walked[WIS];
    for (int k = 1; k <= WIS; k++) at[k] = (Heading){0.05 + 0.18 * (k - 1 + u[5 + k]), PI_DOUBLE * u[11] * k / WIS};
    for (int k = 0; k < WIS; k++) {
        double r = sqrt(1.0 - at[k + 1].mu * at[k + 1].mu);
        wi[3 * k] = r * cos(at[k + 1].phi), wi[3 * k + 1] = r * sin(at[k + 1].phi), wi[3 * k + 2] = at[k + 1].mu;
    }
    double r = sqrt(1.0 - at[0].mu * at[0].mu);
    WalkDesc desc = {
        slab.alpha, slab.depth, slab.albedo, tilt,  0.0,  {r * cos(at[0].phi), r * sin(at[0].phi), at[0].mu},
        WIS,        wi,         true,        walks, seed, 0};
    WalkCount count;
    assert_true(walk_run(&desc, &count, walked));
    double same[(WIS + 1) * (WIS + 1)], across[(WIS + 1) * (WIS + 1)];
    if (tilts) assert_true(tilted_f(&slab, tilt, (TiltEffort){12, 24, 28}, 1, WIS + 1, at, same, across, NULL));
    for (int k = 0; k < WIS; k++)
        solved[k] = tilts ? same[k + 1] - tilted_single(&slab, tilt, at[0], at[k + 1])
                          : upright_f(&slab, at[0].mu, at[k + 1].mu, at[k + 1].phi - at[0].phi) -
                                slab_single(&slab, at[0].mu, at[k + 1].mu, cos(at[k + 1].phi - at[0].phi));
    compare(score, &desc, walked, solved);
}

/* 1 % that any of the points is out by chance: 1 - (1 - 0.01)^(1 / n), two-sided; 4.1 for 300. */
static void slab_solver_agrees_with_random_walks(void **state) {
    (void)state;
    int cases = getenv("WEFT_TEST_LONG") ? 64 : getenv("WEFT_TEST_SHORT") ? 2 : 4;
    long long walks = getenv("WEFT_TEST_LONG") ? 4000000 : 40000;
    Score score = {0.0, 0};
    for (int k = 0; k < cases; k++) case_run(&score, 71u + (uint32_t)k, k % 2 == 1, walks);
    printf("%d points, largest deviation %.2f standard errors beyond 0.3 %%\n", score.count, score.worst);
    assert_true(score.worst < 4.1 && score.count >= (getenv("WEFT_TEST_LONG") ? 300 : 3 * cases));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(modes_of_a_thin_slab_sum_to_single_scattering),
        cmocka_unit_test(white_slab_conserves_light),
        cmocka_unit_test(deep_white_slab_returns_all_light),
        cmocka_unit_test(several_depths_of_one_run_equal_runs_of_one_depth),
        cmocka_unit_test(doubled_quadrature_changes_nothing),
        cmocka_unit_test(tilted_solver_without_tilt_equals_the_upright_one),
        cmocka_unit_test(slab_solver_agrees_with_random_walks),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
