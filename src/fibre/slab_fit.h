/* slab_fit.h - a closed form made to agree with slabs: least absolute error by reweighted Gauss-Newton
 *
 * A form has local numbers theta, which hold for one slab, and these are linear in the coefficients that are
 * sought: theta[q] = fixed[q] + sum of coefficients[column] * basis. The error of a slab is what is printed
 * everywhere, integral of |f - f_true| mu over R, for each direction; the albedo's own error is weighed in,
 * and heavily where the form would reflect more than 0.96 of what it receives, so that what it
 * does between the directions of the fit stays below 1. */
#ifndef WEFT_FIBRE_SLAB_FIT_H
#define WEFT_FIBRE_SLAB_FIT_H

#include "fibre/solver_reference.h"

/* theta[moving[at]] depends on `coefficient` by factor `basis`. */
typedef struct FitTerm {
    int at, coefficient;
    double basis;
} FitTerm;

typedef struct FitForm {
    int locals, coefficients;
    int movings; /* local numbers that have free coefficients */
    const int *moving;
    void *user;
    /* log f of every pair of slab number `slab`, and where slope is not NULL its derivatives by theta,
     * slope[pair * locals + q]. Called from several threads at once. */
    void (*value)(void *user, int slab, const SolvedSlab *reference, const double *theta, double *log_f,
                  double *slope);
    const FitTerm *const *terms; /* for each slab, those of free coefficients */
    const int *term_counts;
    const double *const *fixed; /* for each slab, [locals] */
} FitForm;

typedef struct FitEffort {
    int rounds;
    double albedo;  /* how much the error of R counts */
    double grazing; /* added to the weight of every direction, so that the few at the horizon count */
    double worst;   /* an error of 1 / worst counts for one and a half times its size */
    double size; /* how much the squares of the coefficients count, so that what nothing asks for is small */
} FitEffort;

/* coefficients come as the start and leave as the best found. False where memory is short or progress says
 * so. */
bool fit_run(const FitForm *form, const SolvedSet *set, FitEffort effort, int threads, SolveProgress progress,
             void *user, double *coefficients);

/* Computes the form's error over the set: the mean of the slabs' means, and the largest of the other errors.
 * Returns false if memory is short. */
bool fit_error(const FitForm *form, const SolvedSet *set, const double *coefficients, FitError *all);

#endif
