/* Cloth from afar, as it is drawn, against light that was walked through tubes of fibres (study/yarn.c). Numbers are
 * compared of cloths that weave/cloth and weave/far make under sanitizers too.
 *
 * Labels: unsanitized */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "base/pi.h"
#include "shading/weave/weave_base.h"
#include "weave/weft_cloth.h"
#include "weave/yarn_cases.h"

enum { FINE = 6 }; /* directions along a bin's side */

/* Results of walks: light through the cloth, the noise, and light that goes up. */
typedef struct Walked {
    double through, apart, up[BINS];
} Walked;

static Walked walked[YARN_CASES][KINDS_OF_LIGHT];

static void read_walked(void) {
    FILE *file = fopen(WEFT_SOURCE_DIR "/tests/weave/yarn_truth.txt", "r");
    char line[4096];
    int rows = 0;
    assert_non_null(file);
    while (fgets(line, sizeof line, file)) {
        char *at = line;
        if (*at == '#') continue;
        const long number = strtol(at, &at, 10), kind = strtol(at, &at, 10);
        assert_true(number >= 0 && number < YARN_CASES && kind >= 0 && kind < KINDS_OF_LIGHT);
        Walked *of = &walked[number][kind];
        of->through = strtod(at, &at);
        of->apart = strtod(at, &at);
        for (int k = 0; k < BINS; k++) of->up[k] = strtod(at, &at);
        rows++;
    }
    fclose(file);
    assert_int_equal(rows, YARN_CASES * KINDS_OF_LIGHT);
}

/* Light of one kind on a cloth from afar: the lobes of both systems, and their colours for light that met one fibre and
 * for all other. */
typedef struct Lit {
    WovenPrepared lobes[2];
    double once[2], again[2];
} Lit;

static Dir direction(double z, double phi) {
    const double r = (sqrt)(1.0 - z * z);
    return dir((float)(r * (cos)(phi)), (float)(r * (sin)(phi)), (float)z);
}

/* Adds up what goes into each bin. */
static void light_bins(const Lit *lit, double theta, double up[BINS]) {
    const Dir o = direction((cos)(theta * RADIANS), yarn_azimuth * RADIANS);
    for (int k = 0; k < BINS; k++) up[k] = 0.0;
    for (int t = 0; t < 2; t++) {
        const WovenPrepared *p = &lit->lobes[t];
        WovenView w;
        woven_view(p, o, &w);
        for (int k = 0; k < BINS * FINE * FINE; k++) {
            const int bin = k / (FINE * FINE), row = bin / AZIMUTHS, column = bin % AZIMUTHS;
            const int fine = k % (FINE * FINE), down = fine / FINE;
            const double z = (row + (down + 0.5) / FINE) / COSINES;
            const double phi = 2.0 * PI_DOUBLE * (column + (fine % FINE + 0.5) / FINE) / AZIMUTHS;
            const LobeValue v = woven_value(p, &w, angles_between(o, direction(z, phi)));
            const double f = (double)v.f, s = (double)v.s, solid = 2.0 * PI_DOUBLE / (BINS * FINE * FINE);
            up[bin] += f * z * solid * ((1.0 - s) * lit->once[t] + s * lit->again[t]);
        }
    }
}

static double sum_of(const double up[BINS]) {
    double sum = 0.0;
    for (int k = 0; k < BINS; k++) sum += up[k];
    return sum;
}

/* Sum |model - truth| / sum truth. */
static double apart(const double model[BINS], const double truth[BINS]) {
    double sum = 0.0;
    for (int k = 0; k < BINS; k++) sum += fabs(model[k] - truth[k]);
    return sum / sum_of(truth);
}

/* A kind of light: of fibres of albedo 1 that it met once, or of all light where they have another albedo. */
static double albedo_of_kind(int kind) { return kind ? yarn_albedos[kind - 1] : 1.0; }

/* The mean colour of a layer over the repeat. */
static double layer_mean(const WeftCloth *cloth, int layer) {
    int width, height;
    const float *top = cloth_far_level(&cloth->far, cloth->far.levels - 1, &width, &height);
    return (double)top[4 * layer];
}

/* The lobes are those of the cloth drawn from afar. */
static Lit lit_cloth(const WeftCloth *cloth, int kind) {
    Lit lit;
    for (int t = 0; t < 2; t++) {
        lit.lobes[t] = cloth->far.woven[t];
        const double share = (double)lit.lobes[t].share;
        lit.once[t] = layer_mean(cloth, t ? FAR_WEFT_SINGLE : FAR_WARP_SINGLE) / share;
        lit.again[t] = kind ? layer_mean(cloth, t ? FAR_WEFT_MULTIPLE : FAR_WARP_MULTIPLE) / share : 0.0;
    }
    return lit;
}

/* An even cloth of threads whose fibres have the albedo of that kind of light. */
static WeftCloth *cloth_of(const YarnCase *yarn, int kind) {
    const double a = albedo_of_kind(kind), once = 0.328 - 0.111 * yarn->alpha;
    const double c = a * once + (double)yarn_reflectance((float)a) * (1.0 - once);
    const double encoded = c <= 0.0031308 ? 12.92 * c : 1.055 * (pow)(c, 1.0 / 2.4) - 0.055;
    const int code = (int)lrint(255.0 * encoded);
    const WeftYarn one = {.alpha = (float)yarn->alpha,
                          .crimp = (float)(yarn->crimp * RADIANS),
                          .roundness = (float)yarn_roundness,
                          .twist = (float)(yarn->twist * RADIANS),
                          .width = (float)yarn->width,
                          .floats = (float)yarn->floats,
                          .slub_length = 10.0f,
                          .barre_width = 10.0f,
                          .uneven_size = 10.0f};
    const WeftYarn both[2] = {one, one};
    char words[128];
    WeftDraft *draft;
    WeftCloth *cloth;
    WeftError error;
    snprintf(words, sizeof words, "%s; both 1#%02x%02x%02x", yarn->draft, code, code, code);
    assert_int_equal(weft_draft_parse(words, &draft, &error), WEFT_OK);
    assert_int_equal(weft_cloth_create(draft, both, 0, &cloth, &error), WEFT_OK);
    weft_draft_free(draft);
    return cloth;
}

/* Errors of a case in each kind of light, and its brightness, in parts of the truth. */
typedef struct CaseErrors {
    double off[KINDS_OF_LIGHT], bright[KINDS_OF_LIGHT];
} CaseErrors;

static CaseErrors errors_of(int number) {
    CaseErrors errors;
    for (int kind = 0; kind < KINDS_OF_LIGHT; kind++) {
        const Walked *truth = &walked[number][kind];
        double up[BINS];
        WeftCloth *cloth = cloth_of(&yarn_cases[number], kind);
        const Lit lit = lit_cloth(cloth, kind);
        light_bins(&lit, yarn_cases[number].theta, up);
        errors.off[kind] = apart(up, truth->up);
        errors.bright[kind] = sum_of(up) / sum_of(truth->up);
        weft_cloth_free(cloth);
    }
    return errors;
}

/* Light that met one fibre is within 0.05 where threads are not steep and light does not graze, else within 0.15; all
 * light within 0.12 where fibres are rough, else within 0.18. */
static void assert_near(const YarnCase *y, const CaseErrors *e) {
    const double once = y->crimp <= 32 && y->theta <= 60 ? 0.05 : 0.15, all = y->alpha >= 0.25 ? 0.12 : 0.18;
    for (int kind = 0; kind < KINDS_OF_LIGHT; kind++)
        if (!(e->off[kind] <= (kind ? all : once)))
            fail_msg("%s, crimp %g, theta %g: kind %d is off by %.3f", y->draft, y->crimp, y->theta, kind,
                     e->off[kind]);
}

static void cloth_from_afar_is_near_what_was_walked(void **state) {
    (void)state;
    read_walked();
    print_message("weave     crimp twist alpha width theta | once: off bright | A .5: off bright | .8: off bright | "
                  ".95: off bright | through noise\n");
    for (int k = 0; k < YARN_CASES; k++) {
        const YarnCase *y = &yarn_cases[k];
        const CaseErrors e = errors_of(k);
        print_message("%-9s %5.0f %5.0f %5.2f %5.1f %5.0f", y->draft, y->crimp, y->twist, y->alpha, y->width, y->theta);
        for (int kind = 0; kind < KINDS_OF_LIGHT; kind++) print_message(" | %.3f %.3f", e.off[kind], e.bright[kind]);
        print_message(" | %.3f %.3f\n", walked[k][2].through, 0.5 * walked[k][0].apart);
        assert_near(y, &e);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(cloth_from_afar_is_near_what_was_walked)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
