/* measure.h - the passport (validation report) of a lobe or of an engine profile: energy, reciprocity, sampling
 *
 * Everything is measured on the code that renders, with fixed seeds: two runs give the same numbers, whatever
 * the number of threads. docs/check.md explains how to read them. */
#ifndef WEFT_MEASURE_H
#define WEFT_MEASURE_H

#include "weft/lobe.h"
#include "weft/material.h"

#ifdef __cplusplus
extern "C" {
#endif

enum {
    WEFT_PASSPORT_ROWS = 11,    /* values of the parameter, at most */
    WEFT_PASSPORT_COSINES = 21, /* of wo, for E */
    WEFT_PASSPORT_VIEWS = 5,    /* of wo, for furnace and sampling */
    WEFT_PASSPORT_LAYERS = 16,  /* layer rules, at most */
    WEFT_PASSPORT_SHEENS = 3,   /* roughnesses of the sheen in the furnace */
    WEFT_HALF_FREE = 25,        /* in place of a floor's exponent: no floor is needed */
    WEFT_HALF_MOST = 7          /* exponent of the largest floor that is tried */
};

/* The place of a result: the row's parameter and the pair of directions. */
typedef struct WeftPlace {
    float value, cos_o, cos_i, phi; /* the parameter, the two cosines, the azimuth between them in degrees */
} WeftPlace;

/* The passport of a white lobe, of a whole white material under an engine profile, or of a woven material in its own
 * colours. The rows of a lobe run over the plausible range of its first parameter, as `roughness` runs from 0 to 1; the
 * other parameters stay. The rows of a profile run over the roughness of the sheen; a woven material has one row. */
typedef struct WeftPassport {
    char id[64];                      /* of the lobe or of the profile */
    int profile;                      /* 0: a lobe; else a whole material */
    int woven;                        /* 1: that material is a woven one */
    unsigned traits;                  /* of a lobe */
    char parameter[64];               /* what the rows run over; empty where there is one row and no parameter */
    char surface[256];                /* description of a whole material */
    int rows;                         /* 1 .. WEFT_PASSPORT_ROWS */
    int row_default;                  /* the row nearest to the default; of a profile, to roughness 0.5 */
    float values[WEFT_PASSPORT_ROWS]; /* of the parameter, row by row */

    /* Directional albedo, colour white, for wo in the plane of the tangent. */
    float cosines[WEFT_PASSPORT_COSINES]; /* from 1 downwards */
    float albedo[WEFT_PASSPORT_ROWS][WEFT_PASSPORT_COSINES];
    float albedo_most;
    WeftPlace albedo_place;
    int albedo_above; /* cells above 1.001 */
    /* With WEFT_LOBE_TINTED: the same with fibres of albedo 0.5. */
    float albedo_half[WEFT_PASSPORT_ROWS][WEFT_PASSPORT_COSINES];

    /* The largest |f(wo, wi) - f(wi, wo)| over the larger of the two and 1e-3 / sr; with WEFT_LOBE_TINTED in
     * white and at albedo 0.5, like the sweep. */
    float reciprocity;
    WeftPlace reciprocity_place;

    /* For a lobe: the albedo of a white Lambert base under the lobe as a white sheen, for each layer rule
     * (weft_layer_name), roughness of the sheen and view; and its standard error, which is 0 except for the rule that
     * walks at random. For a profile, E is this already. */
    float views[WEFT_PASSPORT_VIEWS]; /* cos_o, from 1 downwards */
    int layers;                       /* 0 of a profile */
    float sheens[WEFT_PASSPORT_SHEENS];
    float furnace[WEFT_PASSPORT_LAYERS][WEFT_PASSPORT_SHEENS][WEFT_PASSPORT_VIEWS];
    float furnace_noise[WEFT_PASSPORT_LAYERS][WEFT_PASSPORT_SHEENS][WEFT_PASSPORT_VIEWS];
    float furnace_most; /* the largest, less three standard errors, of rules that promise to conserve energy */

    /* Sampling. p is the least p value of the chi-square tests; in a run of several passports
     * weft_passport_significance takes the tests of all. */
    float pdf_most;         /* the largest integral of the pdf */
    WeftPlace pdf_place;    /* the place of that integral */
    int tests;              /* the number of chi-square tests */
    double p;               /* the least p value */
    WeftPlace p_place;      /* the place of that value */
    int stray;              /* samples whose own pdf is 0 */
    float missed;           /* the largest fraction of E that comes from directions whose pdf is 0 */
    WeftPlace missed_place; /* the place of that fraction */

    /* Variance of f cos / pdf, with the lobe's own sampling and with cosine sampling; their ratio, summed over views
     * with 1e-3 added to both, at the default row and at the worst row. */
    float variance[WEFT_PASSPORT_ROWS][WEFT_PASSPORT_VIEWS];
    float variance_cosine[WEFT_PASSPORT_ROWS][WEFT_PASSPORT_VIEWS];
    float variance_ratio, variance_worst;
    float variance_value; /* the parameter of the worst row */

    /* The adversarial sweep: grazing, opposite, equal, below the horizon, both ends of each parameter. */
    long long sweep_count;
    long long sweep_infinite, sweep_negative; /* f, pdf or a sample that is not finite; f or pdf below 0 */
    long long sweep_below;                    /* f or pdf that is not 0 below the horizon */

    /* f over the sweep in half precision (with WEFT_LOBE_TINTED at albedo 0.5), every value and operation
     * rounded to 16 bits. A floor is a lower bound on both cosines. half_floor: for each row, the exponent e of the
     * smallest floor 2^-e with which all is finite and not negative; WEFT_HALF_FREE where no floor is needed, 0 where
     * none up to 2^-7 suffices. */
    int half_measured;              /* 0: the compiler that built this has no _Float16; or a profile */
    long long half_count, half_bad; /* without floors, over all rows */
    int half_floor[WEFT_PASSPORT_ROWS];
    WeftPlace half_place; /* a pair that no floor makes finite; all 0 where there is none */
    /* The parameter decreases from its plausible high end to its hard low end. These are the least value down to which
     * a floor keeps all finite, whether that is the hard end, and the exponent of the smallest such floor; 0: none. */
    float half_parameter;
    int half_whole, half_cosine;
    /* For each row, of 4,096 pairs with both cosines at least 0.1: the fraction where f is 0 in half but not in
     * single precision (underflow), and the fraction where it is off by more than 1 %. */
    float half_zero[WEFT_PASSPORT_ROWS], half_off[WEFT_PASSPORT_ROWS];

    /* The shader text run by the GPU: the largest relative difference within the tolerance of 5e-4 and the
     * fraction of pairs beyond it. */
    int parity_measured;
    float parity_worst, parity_beyond;
    char parity_words[160]; /* the driver, or why it was not measured */
} WeftPassport;

/* Zero-initialise. */
typedef struct WeftPassportDesc {
    const char *id;       /* of a lobe or of a profile */
    const WeftLobe *lobe; /* in place of the id: a lobe whose further parameters are not the defaults; NULL */
    /* In place of both: a woven material as for weft_reflection_create_woven; id is its name; NULL. */
    const WeftMaterial *material;
    const WeftCloth *cloth;
    int threads; /* 0: all */
    int quick;   /* not 0: fewer rows, pairs and samples, for a first look */
    int no_gpu;  /* not 0: parity is not measured */
    int brief;   /* not 0: only E, reciprocity, variance and half precision, which the files of lobes state */
} WeftPassportDesc;

/* Measures a passport. Fails with WEFT_MESSAGE_CHECK_NAME, _DESC or _MEMORY. */
WEFT_API WeftResult weft_passport_measure(const WeftPassportDesc *desc, WeftPassport *out, WeftError *error);

/* Returns the probability that the least p value of so many tests is at most p if all samplers are right (Zbynek
 * Sidak, "Rectangular Confidence Regions for the Means of Multivariate Normal Distributions", 1967). */
WEFT_API double weft_passport_significance(double p, int tests);

#ifdef __cplusplus
}
#endif

#endif
