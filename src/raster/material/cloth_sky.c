/* cloth_sky.c - integrates what the facets of a cloth reflect, of which the path tracer makes the cloth from afar */
#include <math.h>
#include <stdlib.h> /* before the dialect, whose abs() shadows its own */

#include "raster/material/cloth_sky.h"

#include "base/matrix.h"
#include "base/memory.h"
#include "base/thread.h"
#include "shading/dialect/points.h"
#include "shading/weave/weave_light.h"

enum {
    KINDS = 4,      /* of light: two of each system */
    NODES = 16,     /* over cos_o */
    AZIMUTHS = 6,   /* over half a turn */
    SAMPLES = 2048, /* of each system from each direction */
    MIXED = 512,    /* facets of each system in the mixture */
};

/* Returns the yarn of a facet. */
static Yarn facet_yarn(const WeftCloth *cloth, int t, const ClothFacet *facet) {
    const WeavePoint p = {.weft = t == 1, .fibre = {1.0f, 0.0f, 0.0f}};
    Yarn yarn = weave_yarn(&cloth->weave, p);
    yarn.slope_x = facet->slope_x;
    yarn.slope_y = facet->slope_y;
    yarn.azimuth = facet->azimuth;
    return yarn;
}

/* Returns facet k of n that are evenly spread over all of a system. */
static const ClothFacet *facet_of(const WeftCloth *cloth, int t, int k, int n) {
    return &cloth->facets[t][(int)(((double)k + 0.5) * cloth->facet_count[t] / n)];
}

/* Adds what a system reflects towards o, and towards o turned by half: of light that met one fibre, and of all other. */
static void reflect(const WeftCloth *cloth, int t, Dir o, double e[2]) {
    for (int k = 0; k < SAMPLES; k++) {
        const ClothFacet *facet = facet_of(cloth, t, k, SAMPLES);
        const Dir from = k & 1 ? dir(-o.x, -o.y, o.z) : o;
        YarnPrepared p;
        YarnView w;
        yarn_prepare(facet_yarn(cloth, t, facet), &p);
        yarn_view(&p, from, &w);
        const Dir i =
            yarn_sample(&p, &w, from, point_fraction(reverse_bits((uint)k)), (float)fmod(0.6180339887498949 * k, 1.0));
        if (!(i.z > 0.0f)) continue;
        const LobeValue v = yarn_value(&p, &w, angles_between(from, i));
        if (!(v.pdf > 0.0f)) continue;
        const double part = (double)(v.f * i.z / v.pdf) / SAMPLES;
        e[0] += part * (double)((1.0f - v.s) * facet->single);
        e[1] += part * (double)(v.s * facet->multiple);
    }
}

/* The waves of E at each node. */
typedef struct SkyWaves {
    const WeftCloth *cloth;
    double e[NODES][CLOTH_SKY_WAVES][KINDS];
} SkyWaves;

/* Sets the values of the waves at an azimuth. */
static void waves_at(double azimuth, double waves[CLOTH_SKY_WAVES]) {
    waves[0] = 1.0;
    waves[1] = (cos)(2.0 * azimuth), waves[2] = (sin)(2.0 * azimuth);
    waves[3] = (cos)(4.0 * azimuth), waves[4] = (sin)(4.0 * azimuth);
}

/* Returns t at a node. */
static double t_at(int node) { return 2.0 * (double)node / (NODES - 1) - 1.0; }

static void find_node(void *user, int node, int thread) {
    (void)thread;
    SkyWaves *self = user;
    const double y = 0.5 + 0.5 * t_at(node), root = 1.0 - (1.0 - y) * (1.0 - y), z = fmax(root * root, 1e-3);
    for (int k = 0; k < AZIMUTHS; k++) {
        const double azimuth = (double)PI * k / AZIMUTHS, r = (sqrt)(1.0 - z * z);
        const Dir o = dir((float)(r * (cos)(azimuth)), (float)(r * (sin)(azimuth)), (float)z);
        double e[KINDS] = {0.0}, waves[CLOTH_SKY_WAVES];
        for (int t = 0; t < 2; t++) reflect(self->cloth, t, o, e + 2 * t);
        waves_at(azimuth, waves);
        for (int w = 0; w < CLOTH_SKY_WAVES; w++)
            for (int n = 0; n < KINDS; n++) self->e[node][w][n] += waves[w] * e[n] * (w ? 2.0 : 1.0) / AZIMUTHS;
    }
}

/* Sets the polynomials, by least squares over the nodes. Returns false if memory is short. */
static bool fit_polynomials(const SkyWaves *self, AmbientWeights out[CLOTH_SKY]) {
    double a[CLOTH_SKY_TERMS][CLOTH_SKY_TERMS] = {{0.0}}, b[CLOTH_SKY_WAVES * KINDS][CLOTH_SKY_TERMS] = {{0.0}};
    for (int node = 0; node < NODES; node++) {
        double power[CLOTH_SKY_TERMS] = {1.0};
        for (int k = 1; k < CLOTH_SKY_TERMS; k++) power[k] = power[k - 1] * t_at(node);
        for (int j = 0; j < CLOTH_SKY_TERMS; j++) {
            for (int k = 0; k < CLOTH_SKY_TERMS; k++) a[j][k] += power[j] * power[k];
            for (int n = 0; n < CLOTH_SKY_WAVES * KINDS; n++) b[n][j] += power[j] * self->e[node][n / KINDS][n % KINDS];
        }
    }
    if (!matrix_factor(CLOTH_SKY_TERMS, a[0], CLOTH_SKY_TERMS) ||
        !matrix_solve(CLOTH_SKY_TERMS, a[0], CLOTH_SKY_TERMS, CLOTH_SKY_WAVES * KINDS, b[0], CLOTH_SKY_TERMS))
        return false;
    for (int w = 0; w < CLOTH_SKY_WAVES; w++)
        for (int j = 0; j < CLOTH_SKY_TERMS; j++)
            out[w * CLOTH_SKY_TERMS + j] = (AmbientWeights){(float)b[KINDS * w][j], (float)b[KINDS * w + 1][j],
                                                            (float)b[KINDS * w + 2][j], (float)b[KINDS * w + 3][j]};
    return true;
}

/* Returns the mean of a colour of the whole repeat. layer: FAR_... */
static float color_mean(const ClothFar *far, int layer) {
    int w, h;
    const float *c = cloth_far_level(far, far->levels - 1, &w, &h) + 4 * layer;
    return (c[0] + c[1] + c[2]) / 3.0f;
}

/* Sets E of a table to 1. */
static void leave_division(AmbientFit *fit) {
    for (int heading = 0; heading < AMBIENT_HEADINGS; heading++)
        for (int column = 0; column < AMBIENT_COLUMNS; column++) {
            float(*planes)[AMBIENT_COLUMNS] = fit->texels + (size_t)heading * AMBIENT_PLANES;
            const float second = max(planes[AMBIENT_PLANE_E_SECOND][column], 1e-9f);
            for (int k = 0; k < 4; k++) planes[4 * AMBIENT_GROUP_SECOND + k][column] /= second;
            planes[AMBIENT_PLANE_E][column] = planes[AMBIENT_PLANE_E_SECOND][column] = 1.0f;
        }
}

/* Fills the table of the mean facet in the colours of the whole repeat. parts: 2 MIXED. */
static void fit_division(const WeftCloth *cloth, int threads, AmbientPart *parts, AmbientFit *fit) {
    for (int k = 0; k < 2 * MIXED; k++) {
        const int t = k / MIXED;
        const ClothFacet *facet = facet_of(cloth, t, k % MIXED, MIXED);
        const Yarn yarn = facet_yarn(cloth, t, facet);
        Lobe lobe = lobe_default(LOBE_YARN);
        int p = 0;
#define PUT_PARAM(type, name, def, low, high, hard_low, hard_high, help) lobe.params[p++] = yarn.name;
        YARN_PARAMS(PUT_PARAM)
        parts[k] = (AmbientPart){.lobe = lobe,
                                 .first = facet->single * color_mean(&cloth->far, 2 * t),
                                 .second = facet->multiple * color_mean(&cloth->far, 2 * t + 1)};
    }
    ambient_fit_mixture(fit, &(AmbientMixture){2 * MIXED, parts}, threads);
    leave_division(fit);
}

bool cloth_sky_fit(const WeftCloth *cloth, int threads, AmbientFit *fit, AmbientWeights albedo[CLOTH_SKY]) {
    SkyWaves *waves = alloc_array(1, sizeof *waves);
    AmbientPart *parts = alloc_array(2 * MIXED, sizeof *parts);
    bool made = waves && parts;
    if (made) {
        waves->cloth = cloth;
        parallel_for(threads, NODES, find_node, waves);
        made = fit_polynomials(waves, albedo);
    }
    if (made) fit_division(cloth, threads, parts, fit);
    free(waves);
    free(parts);
    return made;
}
