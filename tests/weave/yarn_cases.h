/* yarn_cases.h - cloths of fibre tubes through which light was walked, and the bins in which it came out
 *
 * study/yarn.c walks; tests/weave/yarn_truth.txt keeps what it prints; tests/weave/test_truth.c compares. */
#ifndef WEFT_TESTS_WEAVE_YARN_CASES_H
#define WEFT_TESTS_WEAVE_YARN_CASES_H

/* Both systems are of this yarn: crimp and twist in degrees, the rest as WeftYarn has it. theta: from which light
 * comes, degrees from the normal, over the warp towards +x and a little to +y. */
typedef struct YarnCase {
    const char *draft;
    double crimp, twist, alpha, floats, width, theta;
} YarnCase;

static const YarnCase yarn_cases[] = {
    {"plain", 25, 0, 0.2, 0, 1, 15},         {"plain", 25, 0, 0.2, 0, 1, 45},
    {"plain", 25, 0, 0.2, 0, 1, 70},         {"plain", 25, 30, 0.4, 0, 1, 15},
    {"plain", 25, 30, 0.4, 0, 1, 45},        {"plain", 25, 30, 0.4, 0, 1, 70},
    {"plain", 40, 0, 0.2, 0, 1, 15},         {"plain", 40, 0, 0.2, 0, 1, 45},
    {"plain", 40, 0, 0.2, 0, 1, 70},         {"plain", 32, 15, 0.3, 0, 1, 30},
    {"plain", 32, 15, 0.3, 0, 1, 60},        {"plain", 20, 0, 0.15, 0, 1, 20},
    {"plain", 20, 0, 0.15, 0, 1, 60},        {"twill 2/2", 25, -24, 0.4, 1.2, 1, 15},
    {"twill 2/2", 25, -24, 0.4, 1.2, 1, 45}, {"satin 5/2", 22, 0, 0.2, 1.6, 1, 15},
    {"satin 5/2", 22, 0, 0.2, 1.6, 1, 45},   {"plain", 25, 15, 0.3, 0, 0.8, 15},
    {"plain", 25, 15, 0.3, 0, 0.8, 45},      {"plain", 25, 15, 0.3, 0, 0.8, 70},
};
enum { YARN_CASES = sizeof yarn_cases / sizeof *yarn_cases };

static const double yarn_roundness = 0.9, yarn_azimuth = 20.0; /* of the light, degrees from +x */

/* Bins of light that goes up: by its cosine and its azimuth. Each holds what is reflected into it of light that met
 * one fibre of albedo 1, and of all light where fibres have one of these albedos. */
enum { COSINES = 5, AZIMUTHS = 12, BINS = COSINES * AZIMUTHS, ALBEDOS = 3, KINDS_OF_LIGHT = 1 + ALBEDOS };
static const double yarn_albedos[ALBEDOS] = {0.5, 0.8, 0.95};

#endif
