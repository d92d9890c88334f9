/* fitted_model.h - fit of the polynomials of multiple scattering that shading/media/fibre_model.h evaluates
 *
 *   M = exp(A_o + A_i + h_o h_i - g_o g_i - k_o k_i (wo . wi - nu_o nu_i) - sum_b p_b L_b(o, i))       [1/sr]
 *   M(w) = w^2 M(1) r_o r_i exp((1 - w) (v_o v_i - u_o u_i - k'_o k'_i (wo . wi - nu_o nu_i))),
 *   r = (1 - q) / (1 - w q)
 *
 * A, h, g, k, q, v, u, k' are sums of features of a direction (shading/media/fibre_model.h) times numbers, which are
 * polynomials in t, the logarithm of alpha, in l, the logarithm of density, and in the squared sine of the tilt. They
 * are fitted in stages, each of which adds to the last without changing it: white of alpha 0.19 and up, white of
 * thinner fibres, density, nap, colour, colour of thinner fibres. */
#pragma once

#include <stdio.h>

#include "fibre/slab_fit.h"

typedef enum FibreStage {
    FIBRE_WHITE,
    FIBRE_THIN,
    FIBRE_DENSITY,
    FIBRE_NAP,
    FIBRE_COLOR,
    FIBRE_THIN_COLOR,
    FIBRE_STAGES
} FibreStage;

/* Coefficients of all stages, as one list; release with fibre_model_free. */
typedef struct FibreModelFit {
    int count;
    double *coefficients;
    FitError errors[FIBRE_STAGES]; /* over the slabs of the fit: mean of the means, largest of the others */
} FibreModelFit;

/* Solves the slabs and fits stage by stage, which takes minutes. Returns false if memory is short or progress stops
 * it. */
bool fibre_model_fit(FibreStage last, int rounds, int threads, SolveProgress progress, void *user, FibreModelFit *out);
void fibre_model_free(FibreModelFit *model);

/* Writes shading/tables/fibre_model.h, in the dialect. Returns false if memory is short. */
bool fibre_model_write(const FibreModelFit *model, const char *command, FILE *file);

/* Returns the number of coefficients that the stage adds. */
int fibre_model_count(FibreStage stage);
