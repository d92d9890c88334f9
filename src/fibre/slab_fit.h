/* slab_fit.h - fit of a formula to solved slabs: least absolute error by reweighted Gauss-Newton
 *
 * A form has local numbers theta, valid for one slab, which are linear in the coefficients that are fitted: theta[q] =
 * fixed[q] + sum of coefficients[column] * basis. The error of a slab is the integral of |f - f_true| mu over R for
 * each direction, as FitError has it. The error of the albedo counts in addition. It counts a hundredfold if the form
 * reflects more than 0.96 of the light and too much, so that its albedo between the directions of the fit stays below
 * 1. */
#pragma once

#include "fibre/solver_reference.h"

/* theta[moving[at]] depends on `coefficient` by factor `basis`. */
typedef struct FitTerm {
    int at, coefficient;
    double basis;
} FitTerm;

/* A formula with free coefficients. */
typedef struct FitForm {
    int locals, coefficients;
    int movings; /* local numbers that have free coefficients */
    const int *moving;
    void *user;
    /* Computes log f of every pair of slab number `slab`, and if slope is not NULL its derivatives by theta,
     * slope[pair * locals + q]. Called from several threads at the same time. */
    void (*value)(void *user, int slab, const SolvedSlab *reference, const double *theta, double *log_f, double *slope);
    const FitTerm *const *terms; /* for each slab, those of free coefficients */
    const int *term_counts;
    const double *const *fixed; /* for each slab, [locals] */
} FitForm;

/* Rounds of a fit, and the weights of its cost. */
typedef struct FitEffort {
    int rounds;
    double albedo;  /* weight of the error of R */
    double grazing; /* added to the weight of every direction, so that the few at the horizon count */
    double worst;   /* an error of 1 / worst counts one and a half times */
    double size;    /* weight of the coefficients' squares, so that unconstrained ones stay small */
} FitEffort;

/* Fits the coefficients, which contain the start and become the best found. Returns false if memory is short or
 * progress stops it. */
bool fit_run(const FitForm *form, const SolvedSet *set, FitEffort effort, int threads, SolveProgress progress,
             void *user, double *coefficients);

/* Computes the form's error over the set: the mean of the slabs' means, and the largest of the other errors.
 * Returns false if memory is short. */
bool fit_error(const FitForm *form, const SolvedSet *set, const double *coefficients, FitError *all);
