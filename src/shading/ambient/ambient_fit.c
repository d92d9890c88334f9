#include "shading/ambient/ambient_fit.h"

#include "base/matrix.h"
#include "base/thread.h"

/* Wanted: w >= 0 that makes least, on average over environments, the square of
 *
 *   integral of L (f cos - sum_k w_k G_k)
 *
 * An environment turned at random has E[L(x) L(y)] = sum_l (2l + 1) / (4 pi) C_l P_l(x . y), so that is
 *
 *   w^T A w - 2 w^T b + const,   b_k = integral of f cos S_k(i . axis_k),  A_jk = sum_l C_l a_jl a_kl Q_l
 *   S_k(mu) = sum_l (2l + 1) / (4 pi) C_l a_kl P_l(mu),                    Q_l = (2l + 1) / (4 pi) P_l(axes)
 *
 * with a_kl the Legendre coefficients of G_k about its axis. C_l falls as (l + 1)^-2.5: Ron Dror, Alan
 * Willsky, Edward Adelson, "Statistical Characterization of Real-World Illumination", Journal of Vision 4(9),
 * 2004, find powers between 2 and 3. */
enum { PLANE_AXIS = 4 * AMBIENT_GROUP_SHAPE, PLANE_KAPPA, PLANE_TAIL, PLANE_DENSE };
enum { BANDS = 24, GRAIN = 256, KERNELS = 3, ATOMS = 4, SAMPLES = 1024 };

typedef struct FitKernel {
    double a[BANDS];
    double s[GRAIN + 1]; /* S over mu, even from -1 to 1 */
} FitKernel;

typedef struct Atom {
    int kernel, axes; /* with two axes each has half of the weight */
    Dir axis[2];
} Atom;

typedef struct Fitter {
    FitKernel kernels[KERNELS];
    double a[ATOMS][ATOMS];
    AmbientFit *fit;
} Fitter;

/* The directions and widths of the look-ups of ambient_broad_light. */
static const Atom atoms[ATOMS] = {
    {2, 1, {{0.0f, 0.0f, 1.0f}}},
    {1, 2, {{0.612372436f, 0.612372436f, 0.5f}, {0.612372436f, -0.612372436f, 0.5f}}},
    {0, 1, {{-0.866025404f, 0.0f, 0.5f}}},
    {0, 2, {{-0.696364240f, 0.696364240f, 0.173648178f}, {-0.696364240f, -0.696364240f, 0.173648178f}}}};

/* P_0 .. P_(BANDS - 1) of mu. */
static void legendre(double mu, double p[BANDS]) {
    p[0] = 1.0;
    p[1] = mu;
    for (int l = 2; l < BANDS; l++) p[l] = ((2 * l - 1) * mu * p[l - 1] - (l - 1) * p[l - 2]) / l;
}

static double band_weight(int l) { return (2 * l + 1) / 12.5663706143592 * (pow)(l + 1.0, -2.5); }

/* The concentrations of the look-ups of ambient_residual. */
static const double kappas[KERNELS] = {12.5, 3.125, 0.0};
static double weight_at(double kappa, double mu) {
    return kappa > 0.0 ? (exp)(kappa * (mu - 1.0)) : fmax(mu, 0.0);
}

static void make_kernel(FitKernel *kernel, double kappa) {
    enum { STEPS = 2000 };
    double p[BANDS], sum = 0.0;
    for (int k = 0; k < STEPS; k++) {
        double mu = 2.0 * (k + 0.5) / STEPS - 1.0, w = weight_at(kappa, mu);
        legendre(mu, p);
        sum += w;
        for (int l = 0; l < BANDS; l++) kernel->a[l] += w * p[l];
    }
    for (int l = 0; l < BANDS; l++) kernel->a[l] /= sum;
    for (int k = 0; k <= GRAIN; k++) {
        legendre(2.0 * k / GRAIN - 1.0, p);
        for (int l = 0; l < BANDS; l++) kernel->s[k] += band_weight(l) * kernel->a[l] * p[l];
    }
}

static double kernel_at(const FitKernel *kernel, double mu) {
    double x = fmin(fmax(0.5 * (mu + 1.0), 0.0), 1.0) * GRAIN;
    int k = x < GRAIN - 1 ? (int)x : GRAIN - 1;
    return kernel->s[k] + (kernel->s[k + 1] - kernel->s[k]) * (x - k);
}

static double product(const Fitter *fitter, const Atom *x, const Atom *y) {
    double p[BANDS], sum = 0.0;
    for (int j = 0; j < x->axes; j++)
        for (int k = 0; k < y->axes; k++) {
            legendre((double)dir_dot(x->axis[j], y->axis[k]), p);
            for (int l = 0; l < BANDS; l++)
                sum +=
                    band_weight(l) * fitter->kernels[x->kernel].a[l] * fitter->kernels[y->kernel].a[l] * p[l];
        }
    return sum / (x->axes * y->axes);
}

/* The light that a lobe reflects from one wo, as weighted directions with x towards wo. */
typedef struct Cloud {
    int count;
    Dir i[SAMPLES];
    float w[2][SAMPLES]; /* of the first colour and of the second */
    double e[2];
    double dense; /* mean of log2(f cos_i) over all that is sent on */
} Cloud;

/* The bits of k mirrored behind the point, for Hammersley's points. J. M. Hammersley, "Monte Carlo Methods
 * for Solving Multivariable Problems", 1960. */
static float mirrored(uint32_t k) {
    float x = 0.0f;
    for (float place = 0.5f; k; k >>= 1, place *= 0.5f)
        if (k & 1) x += place;
    return x;
}

/* Seen at that azimuth, and, where the lobe turns, half of it at the opposite one: a table knows only the cosine of
 * the azimuth, and a lobe need not be the same on both sides, as a yarn that runs athwart is not. */
static void make_cloud(Cloud *cloud, const Lobe *lobe, float cos_o, float azimuth, bool turning) {
    const float s = sqrt(max(1.0f - cos_o * cos_o, 0.0f)), tx = cos(azimuth), side = sin(azimuth);
    cloud->count = 0;
    cloud->e[0] = cloud->e[1] = cloud->dense = 0.0;
    for (int k = 0; k < SAMPLES; k++) {
        const float ty = turning && k & 1 ? -side : side;
        Dir o = dir(s * tx, s * ty, cos_o);
        Dir i = lobe_sample(lobe, o, ((float)k + 0.5f) / SAMPLES, mirrored((uint32_t)(turning ? k / 2 : k)));
        if (!(i.z > 0.0f)) continue;
        LobeValue value = lobe_value(lobe, angles_between(o, i));
        if (!(value.pdf > 0.0f)) continue;
        float w = value.f * i.z / (value.pdf * SAMPLES);
        int n = cloud->count++;
        cloud->i[n] = dir(i.x * tx + i.y * ty, i.y * tx - i.x * ty, i.z);
        cloud->w[0][n] = w * (1.0f - fresnel_weight_plain(value.s));
        cloud->w[1][n] = w * fresnel_weight_plain(value.s);
        for (int c = 0; c < 2; c++) cloud->e[c] += (double)cloud->w[c][n];
        cloud->dense += (double)(w * log2(max(value.f * i.z, 1e-30f)));
    }
    cloud->dense /= fmax(cloud->e[0] + cloud->e[1], 1e-30);
}

/* The least of w^T A w - 2 w^T b over w >= 0, one after the other until none moves; then their sum is made e.
 * C. L. Lawson, R. J. Hanson, "Solving Least Squares Problems", 1974, chapter 23, has the problem. */
static void solve(const Fitter *fitter, const double b[ATOMS], double e, double w[ATOMS]) {
    double sum = 0.0, moved = 1.0;
    for (int k = 0; k < ATOMS; k++) w[k] = e / ATOMS;
    for (int round = 0; round < 2000 && moved > 1e-9 * e; round++) {
        moved = 0.0;
        for (int k = 0; k < ATOMS; k++) {
            double rest = b[k];
            for (int j = 0; j < ATOMS; j++) rest -= j == k ? 0.0 : fitter->a[k][j] * w[j];
            double x = fmax(rest / fitter->a[k][k], 0.0);
            moved = fmax(moved, fabs(x - w[k]));
            w[k] = x;
        }
    }
    for (int k = 0; k < ATOMS; k++) sum += w[k];
    for (int k = 0; k < ATOMS; k++) w[k] = sum > 0.0 ? w[k] * e / sum : e / ATOMS;
}

/* 1 - mu about the axis within which that part of the cloud is. */
static double cloud_within(const Cloud *cloud, Dir axis, double part) {
    enum { BINS = 96 }; /* four an octave, from 2^-22 up */
    double bins[BINS] = {0}, all = 0.0, sum = 0.0;
    for (int n = 0; n < cloud->count; n++) {
        double t = fmax(1.0 - (double)dir_dot(axis, cloud->i[n]), 0x1p-22);
        double w = (double)cloud->w[0][n] + (double)cloud->w[1][n];
        int bin = (int)(4.0f * (log2((float)t) + 22.0f));
        bins[bin < BINS - 1 ? bin : BINS - 1] += w;
        all += w;
    }
    int k = 0;
    while (k < BINS - 1 && sum + bins[k] < part * all) sum += bins[k++];
    double rest = bins[k] > 0.0 ? (part * all - sum) / bins[k] : 0.0;
    return (double)exp2((float)(0.25 * (k + rest) - 22.0));
}

/* A node of a plane. */
static float *entry(AmbientFit *fit, int heading, int plane, int row, int column) {
    return &fit->texels[(heading * AMBIENT_PLANES + plane) * fit->rows + row][column];
}

/* Half of what exp(kappa (mu - 1)) weighs is within kappa (1 - mu) = ln 2, and three quarters within twice
 * that, of ggx within thrice. Of its density, the mean of the logarithm by
 * itself is ln(kappa / (2 pi e)). */
static void fit_width(AmbientFit *fit, const Cloud *cloud, Dir axis, int row, int column, int heading) {
    if (!(cloud->e[0] + cloud->e[1] > 0.0)) return; /* there is nothing to be narrow */
    double half = cloud_within(cloud, axis, 0.5), more = cloud_within(cloud, axis, 0.75);
    double e = cloud->e[0] + cloud->e[1];
    *entry(fit, heading, PLANE_AXIS, row, column) = axis.x;
    *entry(fit, heading, PLANE_KAPPA, row, column) = log2((float)(0.693147180559945 / half));
    *entry(fit, heading, PLANE_TAIL, row, column) = (float)fmin(fmax(more / half - 2.0, 0.0), 1.0);
    *entry(fit, heading, PLANE_DENSE, row, column) =
        (float)cloud->dense + log2((float)(17.0794684453471 / e));
}

static void fit_node(const Fitter *fitter, Cloud *cloud, int row, int column, int heading) {
    AmbientFit *fit = fitter->fit;
    Lobe lobe = fit->lobe;
    float root = fit->root_low, y = 1.0f - (float)column / (AMBIENT_COLUMNS - 1);
    float x = 1.0f - y * y;
    if (fit->rows > 1) root = mix(root, fit->root_high, (float)row / (AMBIENT_ROWS - 1));
    if (weft_lobe_info(lobe.id)->param_count > 0) lobe_set(&lobe, 0, root * root);
    make_cloud(cloud, &lobe, max(x * x, 1e-4f), (float)heading * 0.25f * PI, fit->turning);
    Dir mean = dir(0.0f, 0.0f, 1e-20f);
    double b[2][ATOMS] = {{0.0}};
    for (int n = 0; n < cloud->count; n++) {
        float w = cloud->w[0][n] + cloud->w[1][n];
        mean = dir(mean.x + w * cloud->i[n].x, mean.y, mean.z + w * cloud->i[n].z);
        for (int k = 0; k < ATOMS; k++) {
            double s = 0.0;
            for (int j = 0; j < atoms[k].axes; j++)
                s += kernel_at(&fitter->kernels[atoms[k].kernel],
                               (double)dir_dot(atoms[k].axis[j], cloud->i[n]));
            for (int c = 0; c < 2; c++) b[c][k] += (double)cloud->w[c][n] * s / atoms[k].axes;
        }
    }
    float r = 1.0f / sqrt(mean.x * mean.x + mean.z * mean.z);
    Dir axis = dir(mean.x * r, 0.0f, mean.z * r);
    double w[ATOMS];
    solve(fitter, b[0], cloud->e[0], w);
    for (int k = 1; k < ATOMS; k++) {
        double part = cloud->e[0] > 0.0 ? w[k] / cloud->e[0] : 1.0 / ATOMS;
        *entry(fit, heading, 4 * AMBIENT_GROUP_FIRST + k - 1, row, column) = (float)part;
    }
    *entry(fit, heading, AMBIENT_PLANE_E, row, column) = (float)cloud->e[0];
    solve(fitter, b[1], cloud->e[1], w);
    for (int k = 0; k < ATOMS; k++)
        *entry(fit, heading, 4 * AMBIENT_GROUP_SECOND + k, row, column) = (float)w[k];
    *entry(fit, heading, AMBIENT_PLANE_E_SECOND, row, column) = (float)cloud->e[1];
    fit_width(fit, cloud, axis, row, column, heading);
}

static void fit_column(void *user, int column, int thread) {
    (void)thread;
    const Fitter *fitter = user;
    Cloud cloud;
    for (int heading = 0; heading < (fitter->fit->turning ? AMBIENT_HEADINGS : 1); heading++)
        for (int row = 0; row < fitter->fit->rows; row++) fit_node(fitter, &cloud, row, column, heading);
}

int ambient_lean_azimuth(int lobe) {
    return weft_lobe_param_find(lobe, "tilt") > 0 ? weft_lobe_param_find(lobe, "azimuth") : -1;
}

void ambient_fit_shape(AmbientFit *fit, const Lobe *lobe, float low, float high) {
    const WeftLobeInfo *info = weft_lobe_info(lobe->id);
    int azimuth = ambient_lean_azimuth(lobe->id);
    fit->lobe = *lobe;
    if (azimuth > 0) lobe_set(&fit->lobe, azimuth, 0.0f);
    fit->turning = lobe_turns(lobe);
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
    /* between those along and across the mean direction is beside the plane of wo: an axis in it says nothing */
    for (int heading = 0; heading < (fit->turning ? AMBIENT_HEADINGS : 1); heading += 2)
        for (int row = 0; row < fit->rows; row++)
            for (int column = 0; column < AMBIENT_COLUMNS; column++) {
                float kappa = *entry(fit, heading, PLANE_KAPPA, row, column);
                float y = 1.0f - (float)column / (AMBIENT_COLUMNS - 1), x = 1.0f - y * y;
                float e = *entry(fit, heading, AMBIENT_PLANE_E, row, column) +
                          *entry(fit, heading, AMBIENT_PLANE_E_SECOND, row, column);
                float part = e * x * x * x * y; /* of the light of a sphere: cos_o = x^2 */
                fit->finest = max(fit->finest, kappa);
                denser += part * (*entry(fit, heading, PLANE_DENSE, row, column) - kappa);
                light += part;
            }
    fit->denser = denser / light;
}

void ambient_fit(AmbientFit *fit, const Lobe *lobe, float low, float high, int threads) {
    Fitter fitter = {.fit = fit};
    ambient_fit_shape(fit, lobe, low, high);
    for (int k = 0; k < KERNELS; k++) make_kernel(&fitter.kernels[k], kappas[k]);
    for (int j = 0; j < ATOMS; j++)
        for (int k = 0; k < ATOMS; k++) fitter.a[j][k] = product(&fitter, &atoms[j], &atoms[k]);
    parallel_for(threads, AMBIENT_COLUMNS, fit_column, &fitter);
    ambient_fit_finish(fit);
}

static bool same(float a, float b) { return !(a < b) && !(a > b); }

/* From parameter `first` on. */
static bool alike_from(const Lobe *a, const Lobe *b, int first) {
    if (a->id != b->id) return false;
    for (int k = first; k < weft_lobe_info(a->id)->param_count; k++)
        if (k != ambient_lean_azimuth(a->id) && !same(a->params[k], b->params[k])) return false;
    return true;
}

bool ambient_alike(const Lobe *a, const Lobe *b) { return alike_from(a, b, 0); }

bool ambient_fit_serves(const AmbientFit *fit, const Lobe *lobe, float low, float high) {
    return alike_from(&fit->lobe, lobe, 1) && same(fit->low, low) && same(fit->high, high);
}

/* Returns true if E is 1 for every wo. */
static bool is_flat(const AmbientFit *fit) {
    for (int heading = 0; heading < (fit->turning ? AMBIENT_HEADINGS : 1); heading++)
        for (int row = 0; row < fit->rows; row++)
            for (int column = 0; column < AMBIENT_COLUMNS; column++) {
                const float *plane =
                    fit->texels[(heading * AMBIENT_PLANES + AMBIENT_PLANE_E) * fit->rows + row];
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
                          .focus = fit->finest > AMBIENT_CLOSE - AMBIENT_BLEND,
                          .narrow = true,
                          .second = second,
                          .lossless = !second && is_flat(fit),
                          .strips = lobe_names(fit->lobe.id)->strips,
                          .turning = fit->turning,
                          .strategy = strategy,
                          .baked = -1};
}

enum { TERMS = AMBIENT_DEGREE + 1, PLANES_HELD = 4 * AMBIENT_GROUPS };

/* Errors count by the E that they are of, down to this part of the greatest: where a lobe fades away an error
 * that is small elsewhere would be all there is. */
static const double FADED = 0.01;

static double node(const AmbientFit *fit, int heading, int plane, int column) {
    return (double)fit->texels[heading * AMBIENT_PLANES + plane][column];
}
static double albedo_at(const AmbientFit *fit, int heading, int column) {
    return node(fit, heading, AMBIENT_PLANE_E, column) + node(fit, heading, AMBIENT_PLANE_E_SECOND, column);
}

/* Coefficients of planes first .. end - 1 by weighted least squares, into members of the groups. */
static void hold_planes(const AmbientFit *fit, int heading, int first, int end,
                        const double weight[AMBIENT_COLUMNS], AmbientWeights out[AMBIENT_HEADING]) {
    double a[TERMS][TERMS] = {{0.0}}, b[PLANES_HELD][TERMS] = {{0.0}};
    for (int column = 0; column < AMBIENT_COLUMNS; column++) {
        double power[TERMS] = {1.0}, t = 2.0 * column / (AMBIENT_COLUMNS - 1) - 1.0;
        for (int k = 1; k < TERMS; k++) power[k] = power[k - 1] * t;
        for (int j = 0; j < TERMS; j++) {
            for (int k = 0; k < TERMS; k++) a[j][k] += weight[column] * power[j] * power[k];
            for (int n = first; n < end; n++)
                b[n][j] += weight[column] * power[j] * node(fit, heading, n, column);
        }
    }
    if (!matrix_factor(TERMS, a[0], TERMS) || !matrix_solve(TERMS, a[0], TERMS, PLANES_HELD, b[0], TERMS))
        memset(b, 0, sizeof b); /* nothing has weight */
    for (int k = 0; k < AMBIENT_HEADING; k++) {
        float *to[4] = {&out[k].a, &out[k].b, &out[k].c, &out[k].d};
        for (int n = 0; n < 4; n++) {
            int plane = 4 * (k / TERMS) + n;
            if (plane >= first && plane < end) *to[n] = (float)b[plane][k % TERMS];
        }
    }
}

/* The shape of a lobe, and how it is spread, count where it is to be seen, up to a hair for what fades away.
 */
static void hold_heading(const AmbientFit *fit, int heading, AmbientWeights out[AMBIENT_HEADING]) {
    double most = 1e-9, value[AMBIENT_COLUMNS], shape[AMBIENT_COLUMNS];
    for (int column = 0; column < AMBIENT_COLUMNS; column++)
        most = fmax(most, albedo_at(fit, heading, column));
    for (int column = 0; column < AMBIENT_COLUMNS; column++) {
        double e = albedo_at(fit, heading, column) / most;
        value[column] = 1.0 / ((e + FADED) * (e + FADED));
        shape[column] = fmin(e, 0.1) + 1e-9;
    }
    hold_planes(fit, heading, 0, AMBIENT_PLANE_E, shape, out);
    hold_planes(fit, heading, AMBIENT_PLANE_E, AMBIENT_PLANE_E + 1, value, out);
    hold_planes(fit, heading, PLANE_AXIS, PLANE_TAIL + 1, shape, out);
    hold_planes(fit, heading, 4 * AMBIENT_GROUP_SECOND, PLANES_HELD, value, out);
}

void ambient_bake(const AmbientFit *fit, AmbientWeights out[AMBIENT_BAKED]) {
    for (int heading = 0; heading < AMBIENT_HEADINGS; heading++)
        hold_heading(fit, fit->turning ? heading : 0, out + heading * AMBIENT_HEADING);
}

int ambient_strategy(int lobe, bool turning, bool dense) {
    return dense || (turning && lobe_names(lobe)->strips) ? AMBIENT_SAMPLED : AMBIENT_FITTED;
}
