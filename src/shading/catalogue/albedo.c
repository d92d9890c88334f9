#include "shading/catalogue/albedo.h"

#include "base/equal.h"
#include "base/pi.h"
#include "base/thread.h"
#include "shading/lobe/lobe_tables.h"

/* Quadrature in (theta_i, phi), split at the mirror polar angle theta_o, where f bends
 * (lobe_creases), and at the plane of incidence. Each zone is integrated by the double-exponential rule, whose nodes
 * crowd towards the ends of an interval: x = 1 / (1 + exp(-pi sinh t)), dx/dt = pi cosh t x (1 - x). There the lobes
 * have their peaks (mirror direction, horizon, backscatter), however narrow. Hidetosi Takahasi, Masatake Mori,
 * "Double Exponential Formulas for Numerical Integration", 1974. */
enum { NODES_MAX = 2 * 99 + 1 }; /* at the finest step, 1/32 */

typedef struct QuadratureRule {
    int count;
    double x[NODES_MAX], rest[NODES_MAX], w[NODES_MAX]; /* on (0, 1); rest = 1 - x without cancellation */
    double cos_phi[NODES_MAX], sin_phi[NODES_MAX];      /* of phi = pi x */
    double cos_half[NODES_MAX], sin_half[NODES_MAX];    /* of phi = pi x / 2 */
} QuadratureRule;

static QuadratureRule rule_make(double step) {
    QuadratureRule rule = {0};
    const double reach = 3.1; /* x(-3.1) is 8e-16 */
    int half = (int)(reach / step);
    for (int k = -half; k <= half; k++) {
        double t = k * step, q = PI_DOUBLE * sinh(t);
        double x = 1.0 / (1.0 + (exp)(-q)), rest = 1.0 / (1.0 + (exp)(q));
        rule.x[rule.count] = x;
        rule.rest[rule.count] = rest;
        rule.cos_phi[rule.count] = (cos)(PI_DOUBLE * x);
        rule.sin_phi[rule.count] = (sin)(PI_DOUBLE * (x < rest ? x : rest));
        rule.cos_half[rule.count] = (sin)(0.5 * PI_DOUBLE * rest);
        rule.sin_half[rule.count] = (sin)(0.5 * PI_DOUBLE * x);
        rule.w[rule.count++] = step * PI_DOUBLE * cosh(t) * x * rest;
    }
    return rule;
}

/* The integrand of a lobe. Without a colour it has two parts, f (1 - s) and f s. With one it is f in three channels:
 * for a tinted lobe the colour is that of its flakes, for a lobe that computes F from f0 it is f0. */
typedef struct Integrand {
    const Lobe *lobe;
    const float *color; /* three channels; NULL: two parts */
    int rough;          /* 1: begins with a longer step, for what is only compared */
} Integrand;

typedef struct Sum {
    double part[3];
} Sum;

static void add(Sum *sum, double weight, const Sum *more) {
    for (int p = 0; p < 3; p++) sum->part[p] += weight * more->part[p];
}

static double distance(const Sum *a, const Sum *b) {
    return fabs(a->part[0] - b->part[0]) + fabs(a->part[1] - b->part[1]) + fabs(a->part[2] - b->part[2]);
}

/* Returns the sum over one ring of constant theta_i, all azimuths, phi measured from the direction opposite to wo. */
static Sum ring(const Integrand *integrand, Dir wo, const QuadratureRule *rule, double sin_i, double cos_i) {
    float ox[2 * NODES_MAX], oy[2 * NODES_MAX], oz[2 * NODES_MAX];
    float ix[2 * NODES_MAX], iy[2 * NODES_MAX], iz[2 * NODES_MAX], f[3][2 * NODES_MAX];
    double w[2 * NODES_MAX];
    unsigned traits = weft_lobe_info((int)integrand->lobe->id)->traits;
    bool diffuse = (traits & TRAIT_DIFFUSE) != 0;                 /* some have a kink at phi = pi / 2 */
    int mirrored = diffuse || traits & TRAIT_ANISOTROPIC ? 2 : 1; /* isotropic lobes are even in phi */
    double s = hypot((double)wo.x, (double)wo.y);
    double tx = s > 0.0 ? -(double)wo.x / s : -1.0, ty = s > 0.0 ? -(double)wo.y / s : 0.0;
    size_t n = 0;
    for (int side = 0; side < mirrored; side++)
        for (int k = 0; k < rule->count; k++) {
            double c = rule->cos_phi[k] * sin_i, t = rule->sin_phi[k] * (side ? -sin_i : sin_i);
            if (diffuse) {
                c = (side ? -rule->sin_half[k] : rule->cos_half[k]) * sin_i;
                t = (side ? rule->cos_half[k] : rule->sin_half[k]) * sin_i;
            }
            ox[n] = wo.x, oy[n] = wo.y, oz[n] = wo.z;
            ix[n] = (float)(c * tx - t * ty), iy[n] = (float)(c * ty + t * tx), iz[n] = (float)cos_i;
            w[n++] = rule->w[k] * PI_DOUBLE * (mirrored == 1 ? 2.0 : 1.0);
        }
    Sum sum = {0};
    if (integrand->color && traits & TRAIT_TINTED) {
        lobe_tinted_n(integrand->lobe, integrand->color, n, ox, oy, oz, ix, iy, iz,
                      (float *const[3]){f[0], f[1], f[2]});
        for (int p = 0; p < 3; p++)
            for (size_t k = 0; k < n; k++) sum.part[p] += w[k] * (double)f[p][k];
        return sum;
    }
    float *share = f[1];
    lobe_eval_n(integrand->lobe, n, ox, oy, oz, ix, iy, iz, f[0], share);
    for (size_t k = 0; k < n && !integrand->color; k++) {
        double weight = w[k] * (double)f[0][k], of_f90 = weight * (double)fresnel_weight_uncolored(share[k]);
        sum.part[0] += weight - of_f90;
        sum.part[1] += of_f90;
    }
    for (size_t k = 0; k < n && integrand->color; k++)
        for (int p = 0; p < 3; p++)
            sum.part[p] += w[k] * (double)f[0][k] * (double)fresnel_weight_mix(share[k], integrand->color[p], 1.0f);
    return sum;
}

/* The rules, by the halvings of a step of 1. Each is made at its first use. */
enum { HALVINGS_MOST = 5 };
typedef struct Rules {
    QuadratureRule at[HALVINGS_MOST + 1];
} Rules;

static const QuadratureRule *rule_of(Rules *rules, int halvings) {
    QuadratureRule *rule = &rules->at[halvings];
    if (rule->count == 0) *rule = rule_make(ldexp(1.0, -halvings));
    return rule;
}

/* The integral between two angles above the horizon, on either side of the mirror angle if that lies between. */
typedef struct Zone {
    double low, high, mirror;
    int halvings;  /* of the rule's step */
    Sum sum;       /* by that rule */
    double change; /* from the sum by the rule before */
} Zone;

/* Adds the integral between two angles. */
static void band_add(const Integrand *integrand, Dir wo, const QuadratureRule *rule, double low, double high,
                     Sum *sum) {
    const double width = high - low;
    const bool steep = high >= 0.5 * PI_DOUBLE;
    if (width < 1e-9) return;
    for (int k = 0; k < rule->count; k++) {
        /* a is the angle from the horizon, so that small cosines keep their digits; in the last band from the
         * normal */
        double a = steep ? width * rule->x[k] : low + width * rule->rest[k];
        double sin_i = steep ? (sin)(a) : (cos)(a), cos_i = steep ? (cos)(a) : (sin)(a);
        Sum part = ring(integrand, wo, rule, sin_i, cos_i);
        add(sum, rule->w[k] * width * sin_i * cos_i, &part);
    }
}

static void zone_take(const Integrand *integrand, Dir wo, Zone *zone, Rules *rules) {
    const QuadratureRule *rule = rule_of(rules, zone->halvings);
    const double middle = fmin(fmax(zone->mirror, zone->low), zone->high);
    Sum sum = {0};
    band_add(integrand, wo, rule, middle, zone->high, &sum);
    band_add(integrand, wo, rule, zone->low, middle, &sum);
    zone->change = distance(&sum, &zone->sum);
    zone->sum = sum;
}

static void zone_halve(const Integrand *integrand, Dir wo, Zone *zone, Rules *rules) {
    zone->halvings++;
    zone_take(integrand, wo, zone, rules);
}

/* Cuts the hemisphere at the cosines of wi where f bends. Between them f is smooth but for the mirror
 * angle, and a longer step will do. Returns the number of zones. */
static int zones_make(const Integrand *integrand, Dir wo, Zone zones[LOBE_CREASES_MOST + 1], Rules *rules) {
    float creases[LOBE_CREASES_MOST];
    const int count = lobe_creases(integrand->lobe, wo.z, creases) + 1;
    const double mirror = atan2((double)wo.z, hypot((double)wo.x, (double)wo.y));
    for (int k = 0; k < count; k++) {
        zones[k] = (Zone){.low = k > 0 ? zones[k - 1].high : 0.0,
                          .high = k + 1 < count ? asin((double)creases[k]) : 0.5 * PI_DOUBLE,
                          .mirror = mirror,
                          .halvings = (count > 1 ? 1 : 2) - integrand->rough};
        zone_take(integrand, wo, &zones[k], rules);
        zone_halve(integrand, wo, &zones[k], rules);
    }
    return count;
}

/* Integrates. Halves the step in the zone whose sum has changed most until all changes are within the tolerance.
 * Halving about squares the error, so the last changes are a safe bound. */
static Sum quadrature(const Integrand *integrand, Dir wo, double tolerance, double *error) {
    Zone zones[LOBE_CREASES_MOST + 1], *worst;
    Rules rules;
    for (int k = 0; k <= HALVINGS_MOST; k++) rules.at[k].count = 0;
    const int count = zones_make(integrand, wo, zones, &rules);
    Sum sum;
    do {
        worst = NULL;
        sum = (Sum){0};
        *error = 0.0;
        for (int k = 0; k < count; k++) {
            add(&sum, 1.0, &zones[k].sum);
            *error += zones[k].change;
            if (zones[k].halvings < HALVINGS_MOST && (!worst || zones[k].change > worst->change)) worst = &zones[k];
        }
        if (*error < tolerance) break;
        if (worst) zone_halve(integrand, wo, worst, &rules);
    } while (worst);
    return sum;
}

Albedo albedo_quadrature_error(const Lobe *lobe, Dir wo, double tolerance, double *error) {
    if (weft_lobe_info(lobe->id)->traits & TRAIT_REFERENCE) {
        *error = tolerance; /* walks have no step to halve; their number follows from the tolerance */
        return (Albedo){lobe_walked_albedo(lobe, wo, (int)(4.0 / tolerance)), 0.0f};
    }
    Sum e = quadrature(&(Integrand){.lobe = lobe}, wo, tolerance, error);
    return (Albedo){(float)e.part[0], (float)e.part[1]};
}

Albedo albedo_quadrature(const Lobe *lobe, Dir wo, double tolerance) {
    double error;
    return albedo_quadrature_error(lobe, wo, tolerance, &error);
}

bool albedo_depends_on_color(const Lobe *lobe) {
    Dir n = dir(0.0f, 0.0f, 1.0f);
    return weft_lobe_info(lobe->id)->traits & TRAIT_TINTED ||
           FRESNEL_WEIGHT_IS_COSINE(lobe_value(lobe, angles_between(n, n)).s);
}

void albedo_in_color(const Lobe *lobe, Dir wo, const float w[3], double tolerance, float e[3]) {
    double error;
    Sum sum = quadrature(&(Integrand){.lobe = lobe, .color = w}, wo, tolerance, &error);
    for (int c = 0; c < 3; c++) e[c] = (float)sum.part[c];
}

static float fourth_root(float x) { return sqrt(sqrt(x)); }
static float eighth_root(float x) { return sqrt(fourth_root(x)); }

typedef struct Fill {
    AlbedoTable *table;
    const Lobe *lobe;
} Fill;

/* The colours other than white for which E of a tinted lobe is integrated; the last stands for the limit 0. */
static const float map_colors[3] = {0.875f, 0.5f, 0x1p-10f};

/* Returns the tilt of the lobe's fibres; 0 for a lobe without one. */
static float tilt_of(const Lobe *lobe) {
    int tilt = weft_lobe_param_find(lobe->id, "tilt");
    return tilt > 0 && weft_lobe_param_find(lobe->id, "azimuth") > 0 ? lobe->params[tilt] : 0.0f;
}

/* Returns the number of tilts that have maps. scaled: a texture scales the tilt. */
static int tilts_of(const Lobe *lobe, bool scaled) {
    if (!(tilt_of(lobe) > 0.0f)) return 0;
    return scaled ? TABLE_TILTS : 1;
}

enum { ACROSS = TABLE_HEADINGS / 2 + 1 }; /* distance of the map for heading 0, greatest tilt, from the end */

/* Returns E of a lobe with azimuth 0 towards a wo of that heading. */
static float towards(const Lobe *lobe, float heading, float cos_o, double tolerance) {
    float s = sqrt(max(1.0f - cos_o * cos_o, 0.0f)), side = sqrt(1.0f - heading * heading);
    Albedo e = albedo_quadrature(lobe, dir(s * heading, s * side, cos_o), tolerance);
    return e.f0 + e.f90;
}

/* Fills one texel of all maps by heading. The tolerance grows with their number, so that random walks, if the lobe is
 * estimated by them, are as many in all as for one E. */
static void fill_headings(AlbedoTable *table, Lobe lobe, int row, int column, float cos_o) {
    int tilt = weft_lobe_param_find(lobe.id, "tilt"), map = table->maps - table->tilts * TABLE_HEADINGS;
    float most = lobe.params[tilt];
    double tolerance = 1e-4 * table->tilts * TABLE_HEADINGS;
    for (int t = 0; t < table->tilts; t++) {
        float root = table->tilts > 1 ? (float)t / (TABLE_TILTS - 1) : 1.0f;
        lobe_set(&lobe, tilt, most * root * root);
        for (int k = 0; k < TABLE_HEADINGS; k++)
            table->e[map++ * table->rows + row][column] =
                towards(&lobe, 2.0f * (float)k / (TABLE_HEADINGS - 1) - 1.0f, cos_o, tolerance);
    }
}

/* Replaces the last column of the maps of one tilt by their mean over azimuths. The weights are exact for polynomials
 * of degree 5 in the heading. */
static void average_headings(AlbedoTable *table, int map, int row) {
    static const float weights[TABLE_HEADINGS] = {1.0f / 6, 1.0f / 3, 0.0f, 1.0f / 3, 1.0f / 6};
    float mean = 0.0f;
    for (int k = 0; k < TABLE_HEADINGS; k++) mean += weights[k] * table->e[(map + k) * table->rows + row][ALBEDO_MU];
    for (int k = 0; k < TABLE_HEADINGS; k++) table->e[(map + k) * table->rows + row][ALBEDO_MU] = mean;
}

Dir albedo_brightest(const Lobe *lobe, float cos_o) {
    enum { AZIMUTHS = 4 };
    float most = -1.0f, s = sqrt(max(1.0f - cos_o * cos_o, 0.0f));
    const int own = weft_lobe_param_find((int)lobe->id, "azimuth");
    Dir best = dir(s, 0.0f, cos_o);
    for (int k = 0; lobe_depends_on_azimuth(lobe) && k < AZIMUTHS; k++) {
        float azimuth = PI * (float)k / AZIMUTHS + (own > 0 ? lobe->params[own] : 0.0f);
        Dir wo = dir(s * cos(azimuth), s * sin(azimuth), cos_o);
        double error;
        Sum sum = quadrature(&(Integrand){.lobe = lobe, .rough = 1}, wo, 1e-2, &error);
        float e = (float)(sum.part[0] + sum.part[1]);
        if (e > most) most = e, best = wo;
    }
    return best;
}

static void fill_column(void *user, int column, int thread) {
    (void)thread;
    const Fill *fill = user;
    AlbedoTable *table = fill->table;
    bool tinted = (weft_lobe_info(fill->lobe->id)->traits & TRAIT_TINTED) != 0;
    float y = 1.0f - (float)column / (ALBEDO_MU - 1), x = 1.0f - y * y, cos_o = max(x * x * x * x, 1e-7f);
    float s = sqrt(max(1.0f - cos_o * cos_o, 0.0f));
    for (int row = 0; row < table->rows; row++) {
        float t = table->rows > 1 ? (float)row / (ALBEDO_ROWS - 1) : 0.0f;
        float r = mix(table->root_low, table->root_high, t), r2 = r * r, r4 = r2 * r2;
        Lobe lobe = *fill->lobe;
        if (weft_lobe_info((int)lobe.id)->param_count > 0) lobe_set(&lobe, 0, r4 * r4);
        if (table->tilts) fill_headings(table, lobe, row, column, cos_o);
        if (table->tilts && !tinted) {
            table->e[row][column] = table->e[(table->maps - ACROSS) * table->rows + row][column];
            continue;
        }
        Dir wo = table->tilts ? dir(0.0f, s, cos_o) : albedo_brightest(&lobe, cos_o);
        Albedo e = albedo_quadrature(&lobe, wo, 1e-4);
        table->e[row][column] = e.f0 + e.f90;
        if (!tinted) continue;
        float colors[3];
        albedo_in_color(&lobe, wo, map_colors, 1e-4, colors);
        for (int c = 0; c < 3; c++) table->e[(1 + c) * table->rows + row][column] = colors[c];
    }
}

/* Returns 2 integral of E mu dmu, mu = x^4, of the interpolated row by the midpoint rule over x. */
static double row_average(const AlbedoTable *table, int row) {
    enum { STEPS = 8 * ALBEDO_MU };
    TableRef one = {.texels = table->e[row], .rows = 1, .columns = ALBEDO_MU};
    double sum = 0.0;
    for (int k = 0; k < STEPS; k++) {
        double x = (k + 0.5) / STEPS, x3 = x * x * x;
        sum += (double)table_roots(one, (float)(x * x3), 0.0f) * 8.0 * x * x3 * x3 / STEPS;
    }
    return sum;
}

/* Returns log r^2 at w_1 = 7/8 minus a quarter of log r^2 at w_2 = 1/2, r = (1 - q) / (1 - w q). Since
 * (1 - w_1) / (1 - w_2) = 1/4, this combination of the two equations contains no e. It decreases with q. */
static double without_e(double q) { return 1.5 * log1p(-q) - 2.0 * log1p(-0.875 * q) + 0.5 * log1p(-0.5 * q); }

/* Replaces E of white and of the three colours w by E, s, q and e:
 *
 *   E(w) / w -> (1 - s) E(1) for w -> 0,   (E(w) / E(1) - (1 - s) w) / (s w^2) = r^2 exp((1 - w) e) */
static void solve_maps(float *map[ALBEDO_MAPS]) {
    double white = fmax((double)*map[0], 1e-30), low = 0.0, high = 0.999;
    double s = fmin(fmax(1.0 - (double)*map[3] / ((double)map_colors[2] * white), 1e-6), 1.0), y[2];
    for (int c = 0; c < 2; c++) {
        double w = (double)map_colors[c], more = (double)*map[1 + c] / white - (1.0 - s) * w;
        y[c] = log1p(fmax(more / (s * w * w), 1e-9) - 1.0);
    }
    for (int halving = 0; halving < 40; halving++) {
        double q = 0.5 * (low + high);
        *(without_e(q) > y[0] - 0.25 * y[1] ? &low : &high) = q;
    }
    *map[1] = (float)s;
    *map[2] = (float)low;
    *map[3] = (float)fmin(fmax(2.0 * (y[1] - 2.0 * (log1p(-low) - log1p(-0.5 * low))), -20.0), 20.0);
}

static void table_fill(AlbedoTable *table, const Lobe *lobe, float low, float high, bool scaled, int threads) {
    const WeftLobeInfo *info = weft_lobe_info((int)lobe->id);
    bool tinted = (info->traits & TRAIT_TINTED) != 0;
    table->lobe = *lobe;
    table->tilts = tilts_of(lobe, scaled);
    if (table->tilts) lobe_set(&table->lobe, weft_lobe_param_find(lobe->id, "azimuth"), 0.0f);
    table->low = low;
    table->high = high;
    if (info->param_count > 0) {
        low = clamp(low, info->params[0].hard_low, info->params[0].hard_high);
        high = clamp(high, info->params[0].hard_low, info->params[0].hard_high);
    }
    table->root_low = eighth_root(low);
    table->root_high = eighth_root(high);
    table->rows = info->param_count > 0 && low < high ? ALBEDO_ROWS : 1;
    int colors = tinted ? ALBEDO_MAPS : 1;
    table->maps = colors + table->tilts * TABLE_HEADINGS;
    parallel_for(threads, ALBEDO_MU, fill_column, &(Fill){table, &table->lobe});
    for (int row = 0; row < table->maps * table->rows; row++) table->e[row][ALBEDO_MU] = (float)row_average(table, row);
    for (int map = colors; map < table->maps; map += TABLE_HEADINGS)
        for (int row = 0; row < table->rows; row++) average_headings(table, map, row);
    if (!tinted) return;
    for (int row = 0; row < table->rows; row++)
        for (int column = 0; column <= ALBEDO_MU; column++) {
            float *map[ALBEDO_MAPS];
            for (int k = 0; k < ALBEDO_MAPS; k++) map[k] = &table->e[k * table->rows + row][column];
            solve_maps(map);
        }
}

void albedo_table_fill(AlbedoTable *table, const Lobe *lobe, float low, float high, int threads) {
    table_fill(table, lobe, low, high, false, threads);
}

void albedo_table_fill_tilts(AlbedoTable *table, const Lobe *lobe, float low, float high, int threads) {
    table_fill(table, lobe, low, high, true, threads);
}

bool albedo_table_serves(const AlbedoTable *table, const Lobe *lobe, float low, float high, bool scaled) {
    if (table->lobe.id != lobe->id) return false;
    int azimuth = weft_lobe_param_find(lobe->id, "tilt") > 0 ? weft_lobe_param_find(lobe->id, "azimuth") : -1;
    for (int k = 1; k < weft_lobe_info(lobe->id)->param_count; k++)
        if (k != azimuth && !is_equal(table->lobe.params[k], lobe->params[k])) return false;
    return table->tilts == tilts_of(lobe, scaled) && is_equal(table->low, low) && is_equal(table->high, high);
}

TableRef albedo_table_ref(const AlbedoTable *table) {
    bool tinted = (weft_lobe_info(table->lobe.id)->traits & TRAIT_TINTED) != 0;
    return (TableRef){.texels = table->e[0],
                      .kind = tinted ? TABLE_TINTED : TABLE_ROOTS,
                      .rows = table->rows,
                      .columns = ALBEDO_MU,
                      .low = table->root_low,
                      .high = table->root_high,
                      .tilts = table->tilts,
                      .tilt = table->tilts ? tilt_of(&table->lobe) : 0.0f};
}
