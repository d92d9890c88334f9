/* ambient_fit.c - fits the weights of a lobe's look-ups, its mean direction and its width, at every node of a table
 *
 * A look-up of L filters L about an axis; one with two axes is the mean of both. L is a residual, an environment
 * without its small lights (ambient_lobe.h). The weights w_k >= 0 make sum_k w_k (look-up k of L) as close as possible
 * to the light that a lobe reflects, in the mean square over all L. With G_k the filter of look-up k, the error for one
 * L is
 *
 *   integral of L (f cos - sum_k w_k G_k)
 *
 * If L is rotated at random, the mean of L(x) L(y) is sum_l (2l + 1) / (4 pi) C_l P_l(x . y), with the spectrum C_l of
 * L and the Legendre polynomials P_l. So the mean square of the error is
 *
 *   w^T A w - 2 w^T b + const
 *   A_jk = sum_l (2l + 1) / (4 pi) C_l a_jl a_kl P_l(axis_j . axis_k)
 *   b_k  = integral of f cos(i) S_k(i . axis_k),   S_k(mu) = sum_l (2l + 1) / (4 pi) C_l a_kl P_l(mu)
 *
 * where a_kl are the Legendre coefficients of G_k about its axis. C_l falls as (l + 1)^-2.5: Ron Dror,
 * Alan Willsky, Edward Adelson, "Statistical Characterization of Real-World Illumination", Journal of Vision 4(9),
 * 2004, find powers between 2 and 3. */
#include "shading/ambient/ambient_fit.h"

#include "base/equal.h"
#include "base/matrix.h"
#include "base/thread.h"
#include "shading/dialect/points.h"

/* The planes of group SHAPE. A group is four planes (ambient_table.h): FIRST has w_1 / E to w_3 / E and E of the first
 * colour, SECOND has w_0 to w_3 of the second. */
enum { PLANE_AXIS = 4 * AMBIENT_GROUP_SHAPE, PLANE_KAPPA, PLANE_TAIL, PLANE_DENSITY };
enum { LOOKUPS = 4, BANDS = 24, STEPS = 256, SAMPLES = 1024 };

/* A look-up: its filter and its axes. */
typedef struct AmbientLookup {
    double kappa; /* the filter is exp(kappa (mu - 1)); 0: a cosine */
    int axes;
    Dir axis[2]; /* x towards wo */
} AmbientLookup;

/* The look-ups of ambient_residual_lookups. */
static const AmbientLookup lookups[LOOKUPS] = {
    {0.0, 1, {{AMBIENT_AXIS_0}}},
    {(double)AMBIENT_KAPPA_1, 2, {{AMBIENT_AXIS_1_LEFT}, {AMBIENT_AXIS_1_RIGHT}}},
    {(double)AMBIENT_KAPPA_2, 1, {{AMBIENT_AXIS_2}}},
    {(double)AMBIENT_KAPPA_3, 2, {{AMBIENT_AXIS_3_LEFT}, {AMBIENT_AXIS_3_RIGHT}}},
};

/* The filter G of a look-up. */
typedef struct Filter {
    double a[BANDS];     /* Legendre coefficients, for an integral of 1 over the sphere */
    double s[STEPS + 1]; /* S at even steps of mu from -1 to 1 */
} Filter;

typedef struct Fitter {
    Filter filters[LOOKUPS];
    double a[LOOKUPS][LOOKUPS]; /* A */
    AmbientFit *fit;
    const AmbientMixture *mixture; /* NULL: the lobe of the fit alone */
} Fitter;

/* Fills p with P_0 to P_(BANDS - 1) of mu. */
static void legendre(double mu, double p[BANDS]) {
    p[0] = 1.0;
    p[1] = mu;
    for (int l = 2; l < BANDS; l++) p[l] = ((2 * l - 1) * mu * p[l - 1] - (l - 1) * p[l - 2]) / l;
}

/* Returns (2l + 1) / (4 pi) C_l. (pow) and (exp) are those of C for doubles, not our macros for floats. */
static double band_weight(int l) { return (2 * l + 1) / 12.5663706143592 * (pow)(l + 1.0, -2.5); }

static double filter_at(double kappa, double mu) { return kappa > 0.0 ? (exp)(kappa * (mu - 1.0)) : fmax(mu, 0.0); }

static void make_filter(Filter *filter, double kappa) {
    enum { NODES = 2000 }; /* of the quadrature */
    double p[BANDS], sum = 0.0;
    for (int k = 0; k < NODES; k++) {
        double mu = 2.0 * (k + 0.5) / NODES - 1.0, g = filter_at(kappa, mu);
        legendre(mu, p);
        sum += g;
        for (int l = 0; l < BANDS; l++) filter->a[l] += g * p[l];
    }
    for (int l = 0; l < BANDS; l++) filter->a[l] /= sum;
    for (int k = 0; k <= STEPS; k++) {
        legendre(2.0 * k / STEPS - 1.0, p);
        for (int l = 0; l < BANDS; l++) filter->s[k] += band_weight(l) * filter->a[l] * p[l];
    }
}

/* Returns S at mu, linear between steps. */
static double s_at(const Filter *filter, double mu) {
    double x = fmin(fmax(0.5 * (mu + 1.0), 0.0), 1.0) * STEPS;
    int k = x < STEPS - 1 ? (int)x : STEPS - 1;
    return filter->s[k] + (filter->s[k + 1] - filter->s[k]) * (x - k);
}

/* Returns A_mn, the mean over the axes of look-ups m and n. */
static double a_of(const Fitter *fitter, int m, int n) {
    const AmbientLookup *x = &lookups[m], *y = &lookups[n];
    double p[BANDS], sum = 0.0;
    for (int j = 0; j < x->axes; j++)
        for (int k = 0; k < y->axes; k++) {
            legendre((double)dir_dot(x->axis[j], y->axis[k]), p);
            for (int l = 0; l < BANDS; l++)
                sum += band_weight(l) * fitter->filters[m].a[l] * fitter->filters[n].a[l] * p[l];
        }
    return sum / (x->axes * y->axes);
}

/* The light that a lobe reflects from one wo, as weighted directions. A sum over them stands for the integral of
 * f cos. */
typedef struct Reflected {
    int count;
    Dir i[SAMPLES];      /* x towards wo */
    float w[2][SAMPLES]; /* weights, of the first colour and of the second */
    double e[2];         /* E: the sums of the weights */
    double s;            /* sum of the weights times s of the tint */
    double log2_density; /* mean of log2(f cos_i) over the reflected light */
} Reflected;

/* Samples the light that a mixture reflects from wo, its lobes one after the other by multiples of the golden ratio,
 * which are as evenly spread as the samples' numbers. The second number of a sample is that of J. M. Hammersley's points,
 * "Monte Carlo Methods for Solving Multivariable Problems", 1960: k with its binary digits mirrored at the binary point. azimuth: of wo. If the lobes depend on it, half of the samples
 * have the mirrored azimuth. Tables are indexed by its cosine, which both share, so a node is the mean of both. Yarns
 * across wo, for example, reflect differently to their two sides. */
static void reflect(Reflected *light, const AmbientMixture *from, float cos_o, float azimuth, bool by_azimuth) {
    const float sin_o = sqrt(max(1.0f - cos_o * cos_o, 0.0f)), tx = cos(azimuth), side = sin(azimuth);
    light->count = 0;
    light->e[0] = light->e[1] = light->s = light->log2_density = 0.0;
    for (int k = 0; k < SAMPLES; k++) {
        const float ty = by_azimuth && k & 1 ? -side : side;
        const int pair = by_azimuth ? k / 2 : k;
        const AmbientPart *part = &from->parts[(int)(from->count * fmod(0.6180339887498949 * pair, 1.0))];
        Dir o = dir(sin_o * tx, sin_o * ty, cos_o);
        Dir i = lobe_sample(&part->lobe, o, ((float)k + 0.5f) / SAMPLES, point_fraction(reverse_bits((uint)pair)));
        if (!(i.z > 0.0f)) continue;
        LobeValue value = lobe_value(&part->lobe, angles_between(o, i));
        if (!(value.pdf > 0.0f)) continue;
        float w = value.f * i.z / (value.pdf * SAMPLES);
        int n = light->count++;
        light->i[n] = dir(i.x * tx + i.y * ty, i.y * tx - i.x * ty, i.z);
        light->w[0][n] = w * (1.0f - fresnel_weight_uncolored(value.s)) * part->first;
        light->w[1][n] = w * fresnel_weight_uncolored(value.s) * part->second;
        for (int c = 0; c < 2; c++) light->e[c] += (double)light->w[c][n];
        light->s += (double)(light->w[0][n] * value.tint.s);
        const float both = light->w[0][n] + light->w[1][n];
        light->log2_density += (double)(both * log2(max(value.f * i.z, 1e-30f)));
    }
    light->log2_density /= fmax(light->e[0] + light->e[1], 1e-30);
}

/* Sets b of both colours. */
static void fill_b(const Fitter *fitter, const Reflected *light, double b[2][LOOKUPS]) {
    memset(b, 0, 2 * sizeof b[0]);
    for (int n = 0; n < light->count; n++)
        for (int k = 0; k < LOOKUPS; k++) {
            double s = 0.0;
            for (int j = 0; j < lookups[k].axes; j++)
                s += s_at(&fitter->filters[k], (double)dir_dot(lookups[k].axis[j], light->i[n]));
            for (int c = 0; c < 2; c++) b[c][k] += (double)light->w[c][n] * s / lookups[k].axes;
        }
}

/* Sets w to the minimum of w^T A w - 2 w^T b over w >= 0, then scales it to the sum e. It sets one weight after the
 * other to its best value until all change by less than 1e-9 of e. The problem is that of C. L. Lawson, R. J. Hanson,
 * "Solving Least Squares Problems", 1974, chapter 23. */
static void solve(const Fitter *fitter, const double b[LOOKUPS], double e, double w[LOOKUPS]) {
    double sum = 0.0, moved = 1.0;
    for (int k = 0; k < LOOKUPS; k++) w[k] = e / LOOKUPS;
    for (int round = 0; round < 2000 && moved > 1e-9 * e; round++) {
        moved = 0.0;
        for (int k = 0; k < LOOKUPS; k++) {
            double rest = b[k];
            for (int j = 0; j < LOOKUPS; j++) rest -= j == k ? 0.0 : fitter->a[k][j] * w[j];
            double x = fmax(rest / fitter->a[k][k], 0.0);
            moved = fmax(moved, fabs(x - w[k]));
            w[k] = x;
        }
    }
    for (int k = 0; k < LOOKUPS; k++) sum += w[k];
    for (int k = 0; k < LOOKUPS; k++) w[k] = sum > 0.0 ? w[k] * e / sum : e / LOOKUPS;
}

/* Returns the mean direction of the light, within the plane of wo. */
static Dir mean_direction(const Reflected *light) {
    Dir mean = dir(0.0f, 0.0f, 1e-20f);
    for (int n = 0; n < light->count; n++) {
        float w = light->w[0][n] + light->w[1][n];
        mean = dir(mean.x + w * light->i[n].x, mean.y, mean.z + w * light->i[n].z);
    }
    float r = 1.0f / sqrt(mean.x * mean.x + mean.z * mean.z);
    return dir(mean.x * r, 0.0f, mean.z * r);
}

/* Returns the distance 1 - mu from the axis within which `part` of the light is. */
static double distance_of_part(const Reflected *light, Dir axis, double part) {
    enum { BINS = 96 }; /* four an octave, from 2^-22 up */
    double bins[BINS] = {0}, all = 0.0, sum = 0.0;
    for (int n = 0; n < light->count; n++) {
        double t = fmax(1.0 - (double)dir_dot(axis, light->i[n]), 0x1p-22);
        double w = (double)light->w[0][n] + (double)light->w[1][n];
        int bin = (int)(4.0f * (log2((float)t) + 22.0f));
        bins[bin < BINS - 1 ? bin : BINS - 1] += w;
        all += w;
    }
    int k = 0;
    while (k < BINS - 1 && sum + bins[k] < part * all) sum += bins[k++];
    double rest = bins[k] > 0.0 ? (part * all - sum) / bins[k] : 0.0;
    return (double)exp2((float)(0.25 * (k + rest) - 22.0));
}

/* A node of a table. */
typedef struct FitNode {
    int heading, row, column; /* azimuth of wo in steps of 45 degrees, parameter 0 of the lobe, cos_o */
} FitNode;

static float *entry(AmbientFit *fit, FitNode at, int plane) {
    return &fit->texels[(at.heading * AMBIENT_PLANES + plane) * fit->rows + at.row][at.column];
}

/* Sets the planes of the lobe's shape, which a lobe that reflects nothing does not have. exp(kappa (mu - 1)) has half
 * of its weight within kappa (1 - mu) = ln 2. It has three quarters within twice that distance, ggx within three times.
 * The tail is this factor less 2. If exp(kappa (mu - 1)) is scaled to a sum of 1, the mean of its own logarithm over it
 * is ln(kappa / (2 pi e)). So the density plane has the kappa of the same mean; 2 pi e = 17.079... */
static void fit_shape(AmbientFit *fit, const Reflected *light, FitNode at) {
    double e = light->e[0] + light->e[1];
    if (!(e > 0.0)) return;
    Dir axis = mean_direction(light);
    double half = distance_of_part(light, axis, 0.5), more = distance_of_part(light, axis, 0.75);
    *entry(fit, at, PLANE_AXIS) = axis.x;
    *entry(fit, at, PLANE_KAPPA) = log2((float)(0.693147180559945 / half));
    *entry(fit, at, PLANE_TAIL) = (float)fmin(fmax(more / half - 2.0, 0.0), 1.0);
    *entry(fit, at, PLANE_DENSITY) = (float)light->log2_density + log2((float)(17.0794684453471 / e));
}

/* Returns true if the lobe's tint takes the place of a second colour. */
static bool is_tinted(const AmbientFit *fit) {
    return (weft_lobe_info(fit->lobe.id)->traits & (TRAIT_TINTED | TRAIT_TWO_COLORS)) == TRAIT_TINTED;
}

/* Sets the planes of the weights, of E and of s. */
static void fit_weights(const Fitter *fitter, const Reflected *light, FitNode at) {
    AmbientFit *fit = fitter->fit;
    double b[2][LOOKUPS], w[LOOKUPS];
    fill_b(fitter, light, b);
    solve(fitter, b[0], light->e[0], w);
    for (int k = 1; k < LOOKUPS; k++) {
        double part = light->e[0] > 0.0 ? w[k] / light->e[0] : 1.0 / LOOKUPS;
        *entry(fit, at, 4 * AMBIENT_GROUP_FIRST + k - 1) = (float)part;
    }
    *entry(fit, at, AMBIENT_PLANE_E) = (float)light->e[0];
    solve(fitter, b[1], light->e[1], w);
    for (int k = 0; k < LOOKUPS; k++) *entry(fit, at, 4 * AMBIENT_GROUP_SECOND + k) = (float)w[k];
    *entry(fit, at, AMBIENT_PLANE_E_SECOND) = (float)light->e[1];
    if (is_tinted(fit)) *entry(fit, at, 4 * AMBIENT_GROUP_SECOND) = (float)(light->s / fmax(light->e[0], 1e-30));
}

/* Returns the number of headings that have entries. */
static int heading_count(const AmbientFit *fit) { return fit->by_azimuth ? AMBIENT_HEADINGS : 1; }

/* Returns the square root of cos_o at a column. */
static float root_cos_at(int column) {
    float y = 1.0f - (float)column / (AMBIENT_COLUMNS - 1);
    return 1.0f - y * y;
}

static void fit_node(const Fitter *fitter, Reflected *light, FitNode at) {
    AmbientFit *fit = fitter->fit;
    Lobe lobe = fit->lobe;
    float root = fit->root_low, x = root_cos_at(at.column);
    if (fit->rows > 1) root = mix(root, fit->root_high, (float)at.row / (AMBIENT_ROWS - 1));
    if (weft_lobe_info(lobe.id)->param_count > 0) lobe_set(&lobe, 0, root * root);
    const AmbientPart part = {lobe, 1.0f, 1.0f};
    const AmbientMixture alone = {1, &part};
    reflect(light, fitter->mixture ? fitter->mixture : &alone, max(x * x, 1e-4f), (float)at.heading * 0.25f * PI,
            fit->by_azimuth);
    fit_weights(fitter, light, at);
    fit_shape(fit, light, at);
}

static void fit_column(void *user, int column, int thread) {
    (void)thread;
    const Fitter *fitter = user;
    Reflected light;
    for (int heading = 0; heading < heading_count(fitter->fit); heading++)
        for (int row = 0; row < fitter->fit->rows; row++) fit_node(fitter, &light, (FitNode){heading, row, column});
}

int ambient_lean_azimuth(int lobe) {
    return weft_lobe_param_find(lobe, "tilt") > 0 ? weft_lobe_param_find(lobe, "azimuth") : -1;
}

void ambient_fit_shape(AmbientFit *fit, const Lobe *lobe, float low, float high) {
    const WeftLobeInfo *info = weft_lobe_info(lobe->id);
    int azimuth = ambient_lean_azimuth(lobe->id);
    fit->lobe = *lobe;
    if (azimuth > 0) lobe_set(&fit->lobe, azimuth, 0.0f);
    fit->by_azimuth = lobe_depends_on_azimuth(lobe);
    fit->low = low;
    fit->high = high;
    if (info->param_count > 0) {
        low = clamp(low, info->params[0].hard_low, info->params[0].hard_high);
        high = clamp(high, info->params[0].hard_low, info->params[0].hard_high);
    }
    fit->root_low = sqrt(low);
    fit->root_high = sqrt(high);
    fit->rows = info->param_count > 0 && low < high ? AMBIENT_ROWS : 1;
}

void ambient_fit_finish(AmbientFit *fit) {
    float denser = 0.0f, light = 1e-20f;
    fit->finest = -100.0f;
    /* Headings 1 and 3 are left out, since wo is neither along the fibres nor across them there. The mean direction is
     * then beside the plane of wo, and a width about an axis in that plane means nothing. */
    for (int heading = 0; heading < heading_count(fit); heading += 2)
        for (int row = 0; row < fit->rows; row++)
            for (int column = 0; column < AMBIENT_COLUMNS; column++) {
                const FitNode at = {heading, row, column};
                float kappa = *entry(fit, at, PLANE_KAPPA);
                float y = 1.0f - (float)column / (AMBIENT_COLUMNS - 1), x = root_cos_at(column);
                float e = *entry(fit, at, AMBIENT_PLANE_E) + *entry(fit, at, AMBIENT_PLANE_E_SECOND);
                float part = e * x * x * x * y; /* a lit sphere sends E cos_o d(cos_o), which goes as E x^3 y */
                fit->finest = max(fit->finest, kappa);
                denser += part * (*entry(fit, at, PLANE_DENSITY) - kappa); /* than one axis of that width */
                light += part;
            }
    fit->denser = denser / light;
}

/* Fills the table, whose shape is set. mixture: NULL for the lobe of the fit. */
static void fit_table(AmbientFit *fit, const AmbientMixture *mixture, int threads) {
    Fitter fitter = {.fit = fit, .mixture = mixture};
    for (int k = 0; k < LOOKUPS; k++) make_filter(&fitter.filters[k], lookups[k].kappa);
    for (int j = 0; j < LOOKUPS; j++)
        for (int k = 0; k < LOOKUPS; k++) fitter.a[j][k] = a_of(&fitter, j, k);
    parallel_for(threads, AMBIENT_COLUMNS, fit_column, &fitter);
    ambient_fit_finish(fit);
}

void ambient_fit(AmbientFit *fit, const Lobe *lobe, float low, float high, int threads) {
    ambient_fit_shape(fit, lobe, low, high);
    fit_table(fit, NULL, threads);
}

void ambient_fit_mixture(AmbientFit *fit, const AmbientMixture *mixture, int threads) {
    const Lobe *first = &mixture->parts[0].lobe;
    ambient_fit_shape(fit, first, first->params[0], first->params[0]);
    fit->by_azimuth = true;
    fit_table(fit, mixture, threads);
    fit->denser = 0.0f; /* each of the lobes is denser than their mean */
}

/* Returns true if both lobes have the same parameters from number `first` on. The azimuth of leaning fibres may differ:
 * one table serves all. */
static bool alike_from(const Lobe *a, const Lobe *b, int first) {
    if (a->id != b->id) return false;
    for (int k = first; k < weft_lobe_info(a->id)->param_count; k++)
        if (k != ambient_lean_azimuth(a->id) && !is_equal(a->params[k], b->params[k])) return false;
    return true;
}

bool ambient_alike(const Lobe *a, const Lobe *b) { return alike_from(a, b, 0); }

bool ambient_fit_serves(const AmbientFit *fit, const Lobe *lobe, float low, float high) {
    return alike_from(&fit->lobe, lobe, 1) && is_equal(fit->low, low) && is_equal(fit->high, high);
}

/* Returns true if E is 1 for every wo. */
static bool is_flat(const AmbientFit *fit) {
    for (int heading = 0; heading < heading_count(fit); heading++)
        for (int row = 0; row < fit->rows; row++)
            for (int column = 0; column < AMBIENT_COLUMNS; column++) {
                const float *plane = fit->texels[(heading * AMBIENT_PLANES + AMBIENT_PLANE_E) * fit->rows + row];
                if (fabsf(plane[column] - 1.0f) > 1e-4f) return false;
            }
    return true;
}

AmbientTable ambient_table(const AmbientFit *fit, int strategy) {
    bool second = (weft_lobe_info(fit->lobe.id)->traits & TRAIT_TWO_COLORS) != 0;
    return (AmbientTable){.texels = fit->texels[0],
                          .rows = fit->rows,
                          .columns = AMBIENT_COLUMNS,
                          .low = fit->root_low,
                          .high = fit->root_high,
                          .focus = fit->finest > AMBIENT_CLOSE - AMBIENT_BLEND, /* some are too narrow for look-ups */
                          .narrow = true,
                          .second = second,
                          .lossless = !second && is_flat(fit),
                          .strips = lobe_names(fit->lobe.id)->strips, /* whether it is sampled in strips */
                          .by_azimuth = fit->by_azimuth,
                          .strategy = strategy,
                          .baked = -1 /* no coefficients */};
}

/* A baked table has polynomials along its columns instead of texels. */
enum { TERMS = AMBIENT_DEGREE + 1, PLANES_BAKED = 4 * AMBIENT_GROUPS };

/* Errors of E count relative to E, down to this part of the greatest E: where a lobe fades away, an absolute error that
 * is small elsewhere would be as large as E itself. */
static const double FADED = 0.01;

static double value_at(const AmbientFit *fit, int heading, int plane, int column) {
    return (double)fit->texels[heading * AMBIENT_PLANES + plane][column];
}
static double albedo_at(const AmbientFit *fit, int heading, int column) {
    return value_at(fit, heading, AMBIENT_PLANE_E, column) + value_at(fit, heading, AMBIENT_PLANE_E_SECOND, column);
}

/* Sets the coefficients of planes first .. end - 1, by least squares with a weight for each column. The members a to d
 * of out[k] are for the four planes of group k / TERMS, and have coefficient k % TERMS of each. */
static void bake_planes(const AmbientFit *fit, int heading, int first, int end, const double weight[AMBIENT_COLUMNS],
                        AmbientWeights out[AMBIENT_HEADING]) {
    double a[TERMS][TERMS] = {{0.0}}, b[PLANES_BAKED][TERMS] = {{0.0}};
    for (int column = 0; column < AMBIENT_COLUMNS; column++) {
        double power[TERMS] = {1.0}, t = 2.0 * column / (AMBIENT_COLUMNS - 1) - 1.0;
        for (int k = 1; k < TERMS; k++) power[k] = power[k - 1] * t;
        for (int j = 0; j < TERMS; j++) {
            for (int k = 0; k < TERMS; k++) a[j][k] += weight[column] * power[j] * power[k];
            for (int n = first; n < end; n++) b[n][j] += weight[column] * power[j] * value_at(fit, heading, n, column);
        }
    }
    if (!matrix_factor(TERMS, a[0], TERMS) || !matrix_solve(TERMS, a[0], TERMS, PLANES_BAKED, b[0], TERMS))
        memset(b, 0, sizeof b); /* nothing has weight */
    for (int k = 0; k < AMBIENT_HEADING; k++) {
        float *to[4] = {&out[k].a, &out[k].b, &out[k].c, &out[k].d};
        for (int n = 0; n < 4; n++) {
            int plane = 4 * (k / TERMS) + n;
            if (plane >= first && plane < end) *to[n] = (float)b[plane][k % TERMS];
        }
    }
}

/* Sets the coefficients of a heading. For the ratios w / E, the shape of the lobe and its s, columns count where the
 * lobe is bright, and only a little where it fades away. */
static void bake_heading(const AmbientFit *fit, int heading, AmbientWeights out[AMBIENT_HEADING]) {
    double most = 1e-9, value[AMBIENT_COLUMNS], shape[AMBIENT_COLUMNS]; /* weights for E and w, and for these */
    for (int column = 0; column < AMBIENT_COLUMNS; column++) most = fmax(most, albedo_at(fit, heading, column));
    for (int column = 0; column < AMBIENT_COLUMNS; column++) {
        double e = albedo_at(fit, heading, column) / most;
        value[column] = 1.0 / ((e + FADED) * (e + FADED));
        shape[column] = fmin(e, 0.1) + 1e-9;
    }
    bake_planes(fit, heading, 0, AMBIENT_PLANE_E, shape, out);
    bake_planes(fit, heading, AMBIENT_PLANE_E, AMBIENT_PLANE_E + 1, value, out);
    bake_planes(fit, heading, PLANE_AXIS, PLANE_TAIL + 1, shape, out);
    bake_planes(fit, heading, 4 * AMBIENT_GROUP_SECOND, PLANES_BAKED, is_tinted(fit) ? shape : value, out);
}

void ambient_bake(const AmbientFit *fit, AmbientWeights out[AMBIENT_BAKED]) {
    for (int heading = 0; heading < AMBIENT_HEADINGS; heading++)
        bake_heading(fit, fit->by_azimuth ? heading : 0, out + heading * AMBIENT_HEADING);
}

int ambient_strategy(int lobe, bool by_azimuth, bool dense) {
    return dense || (by_azimuth && lobe_names(lobe)->strips) ? AMBIENT_SAMPLED : AMBIENT_FITTED;
}
