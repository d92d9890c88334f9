/* The engine profiles against their engines' formulas, written a second time in double precision */
#include "cases.h"

#include "shading/catalogue/engine_tables.h"

enum {
    NONE,
    UNREAL4,
    COTTON,
    SILK,
    URP,
    CLOTH,
    FILAMENT,
    KHRONOS,
    THREE,
    BABYLON,
    MATERIALX,
    VELVET,
    DISNEY,
    ORDER,
    OPENPBR,
    PRINCIPLED,
    KHR_FUZZ,
    KHR_FUZZ_EXACT,
    CORE,
    BABYLON_OPENPBR,
    PROFILES
};

typedef struct Color {
    double c[3];
} Color;

static Color grey(double x) { return (Color){{x, x, x}}; }
static Color color_of(Rgb a) { return (Color){{(double)a.r, (double)a.g, (double)a.b}}; }
static Color times(Color a, double k) { return (Color){{a.c[0] * k, a.c[1] * k, a.c[2] * k}}; }
static double lerp(double a, double b, double t) { return a + (b - a) * t; }
static Color blend(Color a, Color b, double t) {
    return (Color){{lerp(a.c[0], b.c[0], t), lerp(a.c[1], b.c[1], t), lerp(a.c[2], b.c[2], t)}};
}
static double max3(Color a) { return fmax(a.c[0], fmax(a.c[1], a.c[2])); }
static double sat(double x) { return fmin(fmax(x, 0.0), 1.0); }
static double sq(double x) { return x * x; }
static double fifth(double x) { return x * x * x * x * x; }

/* What all formulas start from. */
typedef struct Pair {
    double v, l, nh, vh, s2; /* n.v, n.l, n.h, v.h, 1 - (n.h)^2 */
    double o[3], i[3], h[3];
} Pair;

static Pair pair_of(Dir o, Dir i) {
    Pair p = {.o = {(double)o.x, (double)o.y, (double)o.z}, .i = {(double)i.x, (double)i.y, (double)i.z}};
    double length = 0.0;
    for (int k = 0; k < 3; k++) p.h[k] = p.o[k] + p.i[k], length += sq(p.h[k]);
    for (int k = 0; k < 3; k++) p.h[k] /= (sqrt)(length), p.vh += p.h[k] * p.o[k];
    p.v = p.o[2], p.l = p.i[2], p.nh = p.h[2], p.s2 = sq(p.h[0]) + sq(p.h[1]);
    return p;
}

static double schlick(double x) { return fifth(sat(1.0 - x)); }
static double gaussian(double x) { return (exp2)((-5.55473 * x - 6.98316) * x); }
static double charlie(double a, double s2) { return (2.0 + 1.0 / a) * (pow)(s2, 0.5 / a) / (2.0 * PI_DOUBLE); }
static double neubelt(Pair p) { return 1.0 / (4.0 * (p.l + p.v - p.l * p.v)); }
static double ggx(double a, double nh) { return sq(a) / (PI_DOUBLE * sq(nh * nh * (sq(a) - 1.0) + 1.0)); }
static double ggx_two(double ax, double ay, Pair p) {
    return 1.0 / (PI_DOUBLE * ax * ay * sq(sq(p.h[0] / ax) + sq(p.h[1] / ay) + sq(p.nh)));
}
static double stretched(double ax, double ay, const double w[3]) {
    return (sqrt)(sq(ax * w[0]) + sq(ay * w[1]) + sq(w[2]));
}
static double smith_two(double ax, double ay, Pair p) {
    return 0.5 / (p.l * stretched(ax, ay, p.o) + p.v * stretched(ax, ay, p.i));
}
static double smith(double a, Pair p) {
    double a2 = a * a;
    return 0.5 / (p.l * (sqrt)(p.v * p.v * (1.0 - a2) + a2) + p.v * (sqrt)(p.l * p.l * (1.0 - a2) + a2));
}
static double conty_kulla_lambda_of(double a, double x) {
    static const double p0[] = {21.5473, 3.82987, 0.19823, -1.97760, -4.32054};
    static const double p1[] = {25.3245, 3.32435, 0.16801, -1.27393, -4.85967};
    double t = sq(1.0 - a), m[5], at[2] = {x < 0.5 ? x : 1.0 - x, 0.5}, l[2];
    for (int k = 0; k < 5; k++) m[k] = lerp(p0[k], p1[k], t);
    for (int k = 0; k < 2; k++) l[k] = m[0] / (1.0 + m[1] * (pow)(at[k], m[2])) + m[3] * at[k] + m[4];
    return (exp)(x < 0.5 ? l[0] : 2.0 * l[1] - l[0]);
}

/* Bilinear between texel centres. */
static double read_table(int which, double v, double r) {
    TableRef t = engine_table(which);
    double x = fmin(fmax(v * t.columns - 0.5, 0.0), t.columns - 1.0),
           y = fmin(fmax(r * t.rows - 0.5, 0.0), t.rows - 1.0);
    int k = (int)x, j = (int)y, k1 = k + 1 < t.columns ? k + 1 : k, j1 = j + 1 < t.rows ? j + 1 : j;
    const float *e = t.texels;
    return lerp(lerp((double)e[j * t.columns + k], (double)e[j * t.columns + k1], x - k),
                lerp((double)e[j1 * t.columns + k], (double)e[j1 * t.columns + k1], x - k), y - j);
}

static double three_e(double v, double r) {
    double a = -1.9362 + 1.0678 * r + 0.4573 * r * r - 0.8469 / (r + 0.1);
    double b = -0.6014 + 0.5538 * r - 0.4670 * r * r - 0.1255 / (r + 0.1);
    return sat((exp)(a * v + b));
}
static double materialx_e(double x, double y) {
    double n = 13.67300 - 68.78018 * x + 799.08825 * y - 905.00061 * x * y + 60.28956 * x * x + 1086.96473 * y * y;
    double d = 1 + 61.57746 * x + 442.78211 * y + 2597.49308 * x * y + 121.81241 * x * x + 3045.55075 * y * y;
    return sat(n / d);
}
static void materialx_ab(double x, double y, double ab[2]) {
    static const double r[9][4] = {
        {0.1003, 0.9345, 1, 1},          {-0.6303, -2.323, -1.765, 0.2281}, {9.748, 2.229, 8.263, 15.94},
        {-2.038, -3.748, 11.53, -55.83}, {29.34, 1.424, 28.96, 13.08},      {-8.245, -0.7684, -7.507, 41.26},
        {-26.44, 1.436, -36.11, 54.9},   {19.99, 0.2913, 15.86, 300.2},     {-5.448, 0.6286, 33.37, -285.1}};
    double term[9] = {1, x, y, x * y, x * x, y * y, x * x * y, x * y * y, x * x * y * y}, sum[4] = {0};
    for (int k = 0; k < 9; k++)
        for (int c = 0; c < 4; c++) sum[c] += r[k][c] * term[k];
    ab[0] = sat(sum[0] / sum[2]);
    ab[1] = sat(sum[1] / sum[3]);
}

/* Inputs that several engines read the same way. */
typedef struct Given {
    Color base, sheen, f0, mixed; /* f0: dielectric; mixed: with the metal */
    double metal, r, rs, weight;
    double left; /* what glass leaves of the diffuse lobe */
} Given;

static Given given_of(const Surface *s) {
    Given g = {.base = color_of(s->base_color), .metal = (double)s->metallic, .r = (double)s->roughness};
    g.sheen = times(color_of(s->sheen_color), (double)s->sheen);
    g.rs = (double)s->sheen_roughness, g.weight = (double)s->specular;
    g.left = 1.0 - (double)s->transmission;
    double f = sq(((double)s->ior - 1.0) / ((double)s->ior + 1.0));
    for (int k = 0; k < 3; k++) g.f0.c[k] = fmin(f * color_of(s->specular_color).c[k], 1.0) * g.weight;
    g.mixed = blend(g.f0, g.base, g.metal);
    return g;
}

static double khronos_e[2]; /* towards wo and wi, set before khronos is asked */

static Color engine_khronos(const Surface *s, Pair p) {
    Given g = given_of(s);
    double a = sq(g.r), ax = lerp(a, 1.0, sq((double)s->anisotropy)), as = sq(g.rs), fc = schlick(p.vh);
    double dv = ggx_two(ax, a, p) * smith_two(ax, a, p);
    double v = 1.0 / ((1.0 + conty_kulla_lambda_of(as, p.v) + conty_kulla_lambda_of(as, p.l)) * 4.0 * p.l * p.v);
    double sheen = charlie(as, p.s2) * fmin(v, 1.0);
    double keep = fmin(1.0 - max3(g.sheen) * khronos_e[0], 1.0 - max3(g.sheen) * khronos_e[1]);
    double ac = sq((double)s->clearcoat_roughness);
    double coat = (double)s->clearcoat * lerp(0.04, 1.0, schlick(p.v));
    Color f;
    for (int k = 0; k < 3; k++) {
        double fd = lerp(g.f0.c[k], g.weight, fc), fm = lerp(g.base.c[k], 1.0, fc);
        double dielectric = lerp(g.left * g.base.c[k] / PI_DOUBLE, dv, fd);
        f.c[k] = g.sheen.c[k] * sheen + fmax(keep, 0.0) * lerp(dielectric, dv * fm, g.metal);
        f.c[k] = lerp(f.c[k], ggx(ac, p.nh) * smith(ac, p), coat);
    }
    return f;
}

static Color engine_three(const Surface *s, Pair p) {
    Given g = given_of(s);
    double r = fmax(g.r, 0.045), a = r * r, ax = lerp(a, 1.0, sq((double)s->anisotropy)), w = gaussian(p.vh);
    double f90 = lerp(g.weight, 1.0, g.metal), dv = ggx_two(ax, a, p) * smith_two(ax, a, p);
    double ess = read_table(ENGINE_THREE_GGX, p.v, r);
    double sheen = charlie(sq(g.rs), fmax(p.s2, 0.0078125)) * fmin(neubelt(p), 1.0);
    double keep = 1.0 - max3(g.sheen) * fmax(three_e(p.v, g.rs), three_e(p.l, g.rs));
    double ac = sq(fmax((double)s->clearcoat_roughness, 0.045)), cc = (double)s->clearcoat;
    double coat = lerp(0.04, 1.0, w) * ggx(ac, p.nh) * smith(ac, p);
    Color f;
    for (int k = 0; k < 3; k++) {
        double specular = lerp(g.mixed.c[k], f90, w) * dv * (1.0 + g.mixed.c[k] * (1.0 / ess - 1.0));
        double diffuse = g.left * g.base.c[k] * (1.0 - g.metal) / PI_DOUBLE * (1.0 - lerp(g.f0.c[k], f90, w));
        f.c[k] = g.sheen.c[k] * sheen + fmax(keep, 0.0) * (specular + diffuse);
        f.c[k] = f.c[k] * (1.0 - cc * lerp(0.04, 1.0, gaussian(p.v))) + cc * coat;
    }
    return f;
}

static Color engine_filament(const Surface *s, Pair p) {
    Given g = given_of(s);
    double r = fmax(g.r, 0.045), rs = fmax(g.rs, 0.045), a = r * r, k_d = a / (p.s2 + sq(p.nh * a));
    double f90 = sat(50.0 * 0.33 * (g.mixed.c[0] + g.mixed.c[1] + g.mixed.c[2])), fc = schlick(p.vh);
    double ess = read_table(ENGINE_FILAMENT_GGX, p.v, r);
    double keep = fmax(1.0 - max3(g.sheen) * read_table(ENGINE_FILAMENT_SHEEN, p.v, rs), 0.0);
    double sheen = charlie(rs * rs, fmax(p.s2, 0.0078125)) * neubelt(p);
    Color f;
    for (int k = 0; k < 3; k++) {
        double specular = k_d * k_d / PI_DOUBLE * smith(a, p) * lerp(g.mixed.c[k], f90, fc);
        specular *= 1.0 + g.mixed.c[k] * (1.0 / ess - 1.0);
        f.c[k] = keep * (g.left * g.base.c[k] * (1.0 - g.metal) / PI_DOUBLE + specular) + g.sheen.c[k] * sheen;
    }
    return f;
}

static Color engine_cloth(const Surface *s, Pair p) {
    Given g = given_of(s);
    double rs = fmax(g.rs, 0.045), sheen = charlie(rs * rs, fmax(p.s2, 0.0078125)) * neubelt(p);
    Color f;
    for (int k = 0; k < 3; k++) f.c[k] = g.base.c[k] / PI_DOUBLE + g.sheen.c[k] * sheen;
    return f;
}

static Color engine_babylon(const Surface *s, Pair p) {
    Given g = given_of(s);
    double a = sq(g.r) + 0.0005, as = sq(g.rs) + 0.0005, fc = schlick(p.vh);
    double ess = read_table(ENGINE_BABYLON_GGX, p.v, g.r);
    double keep = fmax(1.0 - max3(g.sheen) * read_table(ENGINE_BABYLON_SHEEN, p.v, g.rs), 0.0);
    Color f;
    for (int k = 0; k < 3; k++) {
        double diffuse = g.left * g.base.c[k] * (1.0 - g.f0.c[k]) * (1.0 - g.metal) / PI_DOUBLE;
        double specular = ggx(a, p.nh) * smith(a, p) * lerp(g.mixed.c[k], g.weight, fc);
        specular *= 1.0 + g.mixed.c[k] * (1.0 / ess - 1.0);
        f.c[k] = keep * (diffuse + specular) + g.sheen.c[k] * charlie(as, p.s2) * neubelt(p);
    }
    return f;
}

static Color engine_materialx(const Surface *s, Pair p) {
    Given g = given_of(s);
    double a = sq(g.r), rho = sq(g.rs), fc = schlick(p.vh), ab[2], w = max3(g.sheen);
    materialx_ab(p.v, a, ab);
    double k_e = (1.0 - ab[0] - ab[1]) / (ab[0] + ab[1]);
    double lambda_l = (sqrt)(a * a + (1.0 - a * a) * p.l * p.l), lambda_v = (sqrt)(a * a + (1.0 - a * a) * p.v * p.v);
    double g2 = 2.0 / (lambda_l / p.l + lambda_v / p.v), dg = ggx(a, p.nh) * g2 / (4.0 * p.v) / p.l, top = 0.0;
    for (int k = 0; k < 3; k++)
        top += (1.0 + lerp(g.f0.c[k], g.weight, fc) * k_e) * (ab[0] * g.f0.c[k] + ab[1] * g.weight) / 3.0;
    Color f;
    for (int k = 0; k < 3; k++) {
        double fd = lerp(g.f0.c[k], g.weight, fc), fm = lerp(g.base.c[k], 1.0, fc);
        double dielectric = dg * fd * (1.0 + fd * k_e) + g.base.c[k] / PI_DOUBLE * (1.0 - top);
        f.c[k] = lerp(dielectric, dg * fm * (1.0 + fm * k_e), g.metal);
        if (w < 1e-8) continue;
        f.c[k] *= 1.0 - w * materialx_e(p.v, rho);
        f.c[k] += g.sheen.c[k] / w * w * charlie(fmax(rho, 0.005), p.s2) / (4.0 * (p.l + p.v - p.l * p.v));
    }
    return f;
}

static Color engine_cotton(const Surface *s, Pair p) {
    Given g = given_of(s);
    double a = sq(g.rs), at = a * (1.0 + (double)s->anisotropy);
    Color f;
    for (int k = 0; k < 3; k++)
        f.c[k] = g.base.c[k] / PI_DOUBLE * lerp(1.0, 0.5, a) + g.sheen.c[k] * charlie(at, p.s2) * neubelt(p);
    return f;
}

static Color engine_silk(const Surface *s, Pair p) {
    Given g = given_of(s);
    double a = sq(g.r), at = a * (1.0 + fmin((double)s->anisotropy, 0.9)),
           ab = a * (1.0 - fmin((double)s->anisotropy, 0.9));
    double lv = p.o[0] * p.i[0] + p.o[1] * p.i[1] + p.o[2] * p.i[2], fd90 = 0.5 + g.r * (1.0 + lv);
    double fd = (1.0 + (fd90 - 1.0) * schlick(p.v)) * (1.0 + (fd90 - 1.0) * schlick(p.l)) / (PI_DOUBLE * 1.03571);
    double dv = ggx_two(at, ab, p) * smith_two(at, ab, p);
    Color f;
    for (int k = 0; k < 3; k++) f.c[k] = g.base.c[k] * fd + dv * lerp(g.f0.c[k], 1.0, schlick(p.vh));
    return f;
}

static Color engine_unreal4(const Surface *s, Pair p) {
    Given g = given_of(s);
    double r = fmax(g.r, 0.02), a = r * r, a2 = a * a, fc = schlick(p.vh);
    Color fuzz = color_of(s->sheen_color);
    double cloth = max3(fuzz) > 0.0 ? sat((double)s->sheen) : 0.0, d = p.nh * p.nh * (1.0 - a2) + a2;
    double d2 = (1.0 + 4.0 * a2 * a2 / (d * d)) / (PI_DOUBLE * (1.0 + 4.0 * a2));
    double v1 = 0.5 / (p.l * (p.v * (1.0 - a) + a) + p.v * (p.l * (1.0 - a) + a));
    Color f;
    for (int k = 0; k < 3; k++) {
        double one = ggx(a, p.nh) * v1 * (sat(50.0 * g.mixed.c[1]) * fc + (1.0 - fc) * g.mixed.c[k]);
        double two = d2 * neubelt(p) * (sat(50.0 * fuzz.c[1]) * fc + (1.0 - fc) * fuzz.c[k]);
        f.c[k] = g.base.c[k] * (1.0 - g.metal) / PI_DOUBLE + lerp(one, two, cloth);
    }
    return f;
}

static Color engine_urp(const Surface *s, Pair p) {
    Given g = given_of(s);
    double a = fmax(sq(g.r), 0.0078125), a2 = fmax(a * a, 6.1035e-5);
    double amount = max3(color_of(s->sheen_color)) > 0.0 ? sat((double)s->sheen) : 0.0;
    double diffuse = lerp(1.0, 0.62 * (1.0 - sq(0.5 * p.v)), a) * 0.96 * (1.0 - g.metal);
    double term = a2 / (sq(p.nh * p.nh * (a2 - 1.0) + 1.00001) * fmax(0.1, p.vh * p.vh) * (4.0 * a + 2.0));
    double sheen = PI_DOUBLE * charlie(a, p.s2) * neubelt(p);
    Color f, c = color_of(s->sheen_color);
    for (int k = 0; k < 3; k++)
        f.c[k] =
            (g.base.c[k] * diffuse + lerp(term * lerp(0.04, g.base.c[k], g.metal), sheen * c.c[k], amount)) / PI_DOUBLE;
    return f;
}

static Color engine_velvet(const Surface *s, Pair p) {
    Given g = given_of(s);
    double sigma = fmax(sat(g.rs), 0.01), cot2 = sq(p.nh) / p.s2, k_h = p.nh / p.vh;
    double d = (exp)(-cot2 / sq(sigma)) / (PI_DOUBLE * sq(sigma) * sq(p.s2));
    double groove = fmin(1.0, fmin(2.0 * k_h * p.v, 2.0 * k_h * p.l));
    Color f;
    for (int k = 0; k < 3; k++) f.c[k] = g.base.c[k] / PI_DOUBLE + g.sheen.c[k] * d * groove / (4.0 * p.v) / p.l;
    return f;
}

static double disney_g(const double w[3], double ax, double ay) {
    return 1.0 / (w[2] + (sqrt)(sq(w[0] * ax) + sq(w[1] * ay) + sq(w[2])));
}

static Color engine_disney(const Surface *s, Pair p) {
    Given g = given_of(s);
    double lum = 0.3 * g.base.c[0] + 0.6 * g.base.c[1] + 0.1 * g.base.c[2];
    Color tint = lum > 0.0 ? times(g.base, 1.0 / lum) : grey(1.0);
    Color spec0 = blend(times(blend(grey(1.0), tint, (double)s->specular_tint), 0.08 * g.weight), g.base, g.metal);
    Color csheen = blend(grey(1.0), tint, (double)s->sheen_tint);
    double fl = schlick(p.l), fv = schlick(p.v), fh = schlick(p.vh);
    double fd90 = 0.5 + 2.0 * sq(p.vh) * g.r, fd = lerp(1.0, fd90, fl) * lerp(1.0, fd90, fv);
    double fss90 = sq(p.vh) * g.r, fss = lerp(1.0, fss90, fl) * lerp(1.0, fss90, fv);
    double ss = 1.25 * (fss * (1.0 / (p.l + p.v) - 0.5) + 0.5), aspect = (sqrt)(1.0 - 0.9 * (double)s->anisotropy);
    double ax = fmax(0.001, sq(g.r) / aspect), ay = fmax(0.001, sq(g.r) * aspect);
    double gs = disney_g(p.i, ax, ay) * disney_g(p.o, ax, ay), ds = ggx_two(ax, ay, p);
    double ac = lerp(0.1, 0.001, (double)s->clearcoat_gloss);
    double dr = (ac * ac - 1.0) / (PI_DOUBLE * (log)(ac * ac) * (1.0 + (ac * ac - 1.0) * sq(p.nh)));
    double gr =
        1.0 / (p.l + (sqrt)(0.0625 + (1.0 - 0.0625) * sq(p.l))) / (p.v + (sqrt)(0.0625 + (1.0 - 0.0625) * sq(p.v)));
    Color f;
    for (int k = 0; k < 3; k++) {
        double below =
            lerp(fd, ss, (double)s->subsurface) * g.base.c[k] / PI_DOUBLE + fh * (double)s->sheen * csheen.c[k];
        f.c[k] = below * (1.0 - g.metal) + gs * lerp(spec0.c[k], 1.0, fh) * ds +
                 0.25 * (double)s->clearcoat * gr * lerp(0.04, 1.0, fh) * dr;
    }
    return f;
}

static Color engine_order(const Surface *s, Pair p) {
    Given g = given_of(s);
    double a2 = sq(sq(g.rs)), cot2 = sq(p.nh) / p.s2, any = max3(g.sheen) > 0.0 ? 1.0 : 0.0;
    double d = (1.0 + 4.0 * (exp)(-cot2 / a2) / sq(p.s2)) / (PI_DOUBLE * (1.0 + 4.0 * a2));
    Color f;
    for (int k = 0; k < 3; k++) {
        double fresnel = any * lerp(g.sheen.c[k], 1.0, schlick(p.vh));
        f.c[k] = g.base.c[k] / PI_DOUBLE * (1.0 - fresnel) + d * neubelt(p) * fresnel;
    }
    return f;
}

/* f of the white fuzz and its E, set before openpbr is asked. */
static double openpbr_fuzz[2];

static Color engine_openpbr(const Surface *s, Pair p) {
    Given g = given_of(s);
    double a = sq(g.r), weight = fmin((double)s->sheen, 1.0), fc = schlick(p.vh);
    double ior = (double)s->ior, strength = fmin((double)s->specular, 1.0);
    double f0 = sq((ior - 1.0) / (ior + 1.0)) * strength;
    double dv = ggx(a, p.nh) * smith(a, p), least = schlick(fmin(p.vh, fmin(p.v, p.l)));
    double ac = sq((double)s->clearcoat_roughness), coat = (double)s->clearcoat * lerp(0.04, 1.0, schlick(p.v));
    Color f, tint = color_of(s->specular_color), fuzz = color_of(s->sheen_color);
    for (int k = 0; k < 3; k++) {
        double dielectric =
            g.left * g.base.c[k] / PI_DOUBLE * (1.0 - lerp(f0, 1.0, least)) + dv * tint.c[k] * lerp(f0, 1.0, fc);
        double metal = dv * strength * lerp(g.base.c[k], 1.0, fc);
        double below = lerp(lerp(dielectric, metal, g.metal), ggx(ac, p.nh) * smith(ac, p), coat);
        f.c[k] = weight * fuzz.c[k] * openpbr_fuzz[0] + (1.0 - weight * openpbr_fuzz[1]) * below;
    }
    return f;
}

/* f of the white fuzz and its E, set before cycles-principled is asked. */
static double principled_fuzz[2];

static Color engine_principled(const Surface *s, Pair p) {
    Given g = given_of(s);
    double a = sq(g.r), ax = lerp(a, 1.0, sq((double)s->anisotropy)), fc = schlick(p.vh);
    double taken = lerp(max3(g.f0), g.weight, schlick(fmin(p.vh, fmin(p.v, p.l))));
    double dv = ggx_two(ax, a, p) * smith_two(ax, a, p), f90 = lerp(g.weight, 1.0, g.metal);
    double keep = fmax(1.0 - max3(g.sheen) * principled_fuzz[1], 0.0), ac = sq((double)s->clearcoat_roughness);
    double coat = (double)s->clearcoat * lerp(0.04, 1.0, schlick(p.v));
    Color f;
    for (int k = 0; k < 3; k++) {
        double diffuse = (1.0 - g.metal) * g.base.c[k] / PI_DOUBLE * (1.0 - taken);
        f.c[k] = g.sheen.c[k] * principled_fuzz[0] + keep * (diffuse + dv * lerp(g.mixed.c[k], f90, fc));
        f.c[k] = lerp(f.c[k], ggx(ac, p.nh) * smith(ac, p), coat);
    }
    return f;
}

/* f of the white fuzz and its E, set before khr-fuzz and khr-fuzz-exact are asked. */
static double khr_fuzz[2];

/* The base of glTF with its clear coat, under fuzz. */
static Color engine_khr_fuzz(const Surface *s, Pair p) {
    Given g = given_of(s);
    double a = sq(g.r), ax = lerp(a, 1.0, sq((double)s->anisotropy)), fc = schlick(p.vh);
    double dv = ggx_two(ax, a, p) * smith_two(ax, a, p), weight = fmin((double)s->sheen, 1.0);
    double ac = sq((double)s->clearcoat_roughness), coat = (double)s->clearcoat * lerp(0.04, 1.0, schlick(p.v));
    Color f, fuzz = color_of(s->sheen_color);
    for (int k = 0; k < 3; k++) {
        double fd = lerp(g.f0.c[k], g.weight, fc), fm = lerp(g.base.c[k], 1.0, fc);
        double dielectric = lerp(g.left * g.base.c[k] / PI_DOUBLE, dv, fd);
        f.c[k] = (1.0 - weight * khr_fuzz[1]) * lerp(dielectric, dv * fm, g.metal) + weight * fuzz.c[k] * khr_fuzz[0];
        f.c[k] = lerp(f.c[k], ggx(ac, p.nh) * smith(ac, p), coat);
    }
    return f;
}

/* The published table of 32 cosines by 32 alphas as Babylon.js reads it: filtered between the centres of texels, which
 * are shares of a range, and then decoded as if they had a gamma of 2.2. */
static double babylon_table(int channel, double cosine, double alpha) {
    static const double low[] = {0.005, -0.18, 0.0}, high[] = {0.88, 0.002, 0.75};
    const TableRef t = lobe_table_refs[LOBE_TABLE_ltc_fibre_published];
    const int rows = t.rows / 3, last = t.columns - 1;
    const double u = fmin(fmax(cosine * t.columns - 0.5, 0.0), last), v = fmin(fmax(alpha * rows - 0.5, 0.0), last);
    const int k = (int)fmin(u, last - 1.0), j = (int)fmin(v, last - 1.0);
    const float *e = t.texels + ((size_t)channel * (size_t)rows + (size_t)j) * (size_t)t.columns + k;
    const double x = u - k, y = v - j;
    const double stored =
        lerp(lerp((double)e[0], (double)e[1], x), lerp((double)e[t.columns], (double)e[t.columns + 1], x), y);
    const double range = high[channel] - low[channel], share = fmin(fmax((stored - low[channel]) / range, 0.0), 1.0);
    return low[channel] + range * (pow)(share, 2.2);
}

static Color engine_babylon_openpbr(const Surface *s, Pair p) {
    Given g = given_of(s);
    const double alpha = (sqrt)(g.rs), r = babylon_table(2, p.nh, alpha), weight = fmin((double)s->sheen, 1.0) * r;
    const double x = babylon_table(0, p.nh, alpha) * p.i[0] + babylon_table(1, p.nh, alpha) * p.i[1];
    const double fuzz = p.l / (sqrt)(x * x + sq(p.i[1]) + sq(p.l)), fc = schlick(p.vh);
    const double strength = fmin((double)s->specular, 1.0), ior = (double)s->ior;
    const double f0 = sq((ior - 1.0) / (ior + 1.0)) * strength, dv = ggx(sq(g.r), p.nh) * smith(sq(g.r), p);
    const double ac = sq((double)s->clearcoat_roughness), coat = (double)s->clearcoat * lerp(0.04, 1.0, schlick(p.v));
    Color f, tint = color_of(s->specular_color), color = color_of(s->sheen_color);
    for (int k = 0; k < 3; k++) {
        double dielectric =
            g.left * g.base.c[k] / PI_DOUBLE * (1.0 - lerp(f0, 1.0, fc)) + dv * tint.c[k] * lerp(f0, 1.0, fc);
        double metal = dv * strength * lerp(g.base.c[k], 1.0, fc);
        double below = lerp(lerp(dielectric, metal, g.metal), ggx(ac, p.nh) * smith(ac, p), coat);
        f.c[k] = lerp(below, color.c[k] * fuzz, weight);
    }
    return f;
}

static Color engine_core(const Surface *s, Pair p) {
    Given g = given_of(s);
    double dv = ggx(sq(g.r), p.nh) * smith(sq(g.r), p), fd = lerp(0.04, 1.0, schlick(p.vh));
    Color f;
    for (int k = 0; k < 3; k++) {
        double fm = lerp(g.base.c[k], 1.0, schlick(p.vh));
        f.c[k] = lerp(lerp(g.base.c[k] / PI_DOUBLE, dv, fd), dv * fm, g.metal);
    }
    return f;
}

static Color (*const engines[PROFILES])(const Surface *, Pair) = {
    [UNREAL4] = engine_unreal4,
    [COTTON] = engine_cotton,
    [SILK] = engine_silk,
    [URP] = engine_urp,
    [CLOTH] = engine_cloth,
    [FILAMENT] = engine_filament,
    [KHRONOS] = engine_khronos,
    [THREE] = engine_three,
    [BABYLON] = engine_babylon,
    [MATERIALX] = engine_materialx,
    [VELVET] = engine_velvet,
    [DISNEY] = engine_disney,
    [ORDER] = engine_order,
    [OPENPBR] = engine_openpbr,
    [PRINCIPLED] = engine_principled,
    [KHR_FUZZ] = engine_khr_fuzz,
    [KHR_FUZZ_EXACT] = engine_khr_fuzz,
    [CORE] = engine_core,
    [BABYLON_OPENPBR] = engine_babylon_openpbr,
};

static Choices only_profile(int profile) {
    Choices c = test_choices(CHOICE_AUTO, CHOICE_AUTO);
    c.profile = profile;
    return c;
}

/* Below roughness 0.1 the profiles say where their floors differ. */
static Surface any_surface(Random *random) {
    Surface s = random_surface(random, false);
    s.roughness = weft_mix(0.1f, 1.0f, random_unit(random));
    if (s.anisotropy > 0.0f) s.roughness = max(s.roughness, 0.3f);
    s.sheen_roughness = weft_mix(0.1f, 1.0f, random_unit(random));
    s.clearcoat_roughness = weft_mix(0.1f, 1.0f, random_unit(random));
    s.sheen = random_unit(random);
    s.sheen_tint = random_unit(random), s.specular_tint = random_unit(random);
    s.subsurface = random_unit(random), s.clearcoat_gloss = 0.8f * random_unit(random);
    if (random_unit(random) < 0.5f) s.transmission = random_unit(random);
    return s;
}

static AlbedoTable khronos_table;

static TableRef khronos_ref(void) {
    if (!khronos_table.rows) {
        Lobe lobe = lobe_default(LOBE_CHARLIE_KHRONOS);
        albedo_table_fill(&khronos_table, &lobe, 0.005f, 1.0f, 0);
    }
    return albedo_table_ref(&khronos_table);
}

/* The tables of two fuzzes, whose parameter is their alpha. */
static TableRef fuzz_ref(int id) {
    static AlbedoTable tables[2];
    AlbedoTable *table = &tables[id == LOBE_LTC_FIBRE_PUBLISHED];
    if (!table->rows) {
        Lobe lobe = lobe_default(id);
        albedo_table_fill(table, &lobe, 0.05f, 1.0f, 0);
    }
    return albedo_table_ref(table);
}

/* Sets f of a white fuzz and its E. */
static void fuzz_ask(int id, float alpha, Dir o, Dir i, double fuzz[2]) {
    Lobe lobe = lobe_default(id);
    lobe_set(&lobe, 0, alpha);
    fuzz[0] = (double)lobe_eval(&lobe, angles_between(o, i));
    fuzz[1] = (double)albedo_quadrature(&lobe, o, 1e-4).f0;
}

/* The lobe of a profile's fuzz; -1: it has none. */
static int fuzz_of(int profile) {
    if (profile == OPENPBR || profile == KHR_FUZZ_EXACT) return LOBE_LTC_FIBRE;
    return profile == PRINCIPLED || profile == KHR_FUZZ ? LOBE_LTC_FIBRE_PUBLISHED : -1;
}

static void profiles_follow_the_formulas_of_their_engines(void **state) {
    (void)state;
    Random random = {71};
    double worst[PROFILES] = {0};
    int surfaces = test_short() ? 60 : 600;
    for (int n = 0; n < surfaces; n++) {
        Surface s = any_surface(&random);
        Dir o = direction_cos(0.15 + 0.85 * (double)random_unit(&random), 6.28 * (double)random_unit(&random));
        Dir i = direction_cos(0.15 + 0.85 * (double)random_unit(&random), 6.28 * (double)random_unit(&random));
        if (n % 4 == 0) { /* near the mirror direction, where highlights are */
            double phi = atan2(-(double)o.y, -(double)o.x), at = acos((double)o.z);
            i = direction(fmin(at + 0.2 * (double)random_unit(&random), 1.4), phi + 0.2 * (double)random_unit(&random));
        }
        Pair p = pair_of(o, i);
        for (int profile = 1; profile < PROFILES; profile++) {
            Choices choices = only_profile(profile);
            SeenStack stack;
            double tolerance = 0.0;
            if (profile == KHRONOS) {
                Lobe lobe = lobe_rough(LOBE_CHARLIE_KHRONOS, s.sheen_roughness);
                khronos_e[0] = fmin((double)albedo_quadrature(&lobe, o, 1e-4).f0, 1.0);
                khronos_e[1] = fmin((double)albedo_quadrature(&lobe, i, 1e-4).f0, 1.0);
            }
            const int fuzz = fuzz_of(profile);
            if (fuzz >= 0)
                fuzz_ask(fuzz, s.sheen_roughness, o, i,
                         profile == OPENPBR      ? openpbr_fuzz
                         : profile == PRINCIPLED ? principled_fuzz
                                                 : khr_fuzz);
            seen_make(&stack, &s, &choices,
                      profile == KHRONOS ? khronos_ref()
                      : fuzz >= 0        ? fuzz_ref(fuzz)
                                         : (TableRef){.kind = TABLE_NONE},
                      o);
            Color got = times(color_of(seen_eval(&stack, i, 0).f_cos), 1.0 / p.l), want = engines[profile](&s, p);
            if (profile == KHRONOS) { /* 2e-3 of what E takes away */
                Surface bare = s;
                bare.sheen_color = (Rgb){0.0f, 0.0f, 0.0f};
                tolerance = 2e-3 * max3(given_of(&s).sheen) * max3(engine_khronos(&bare, p));
            }
            if (profile == OPENPBR) {
                Surface bare = s;
                bare.sheen = 0.0f;
                tolerance = 6e-3 * (double)s.sheen * max3(engine_openpbr(&bare, p));
            }
            if (profile == PRINCIPLED) {
                Surface bare = s;
                bare.sheen_color = (Rgb){0.0f, 0.0f, 0.0f};
                tolerance = 6e-3 * max3(given_of(&s).sheen) * max3(engine_principled(&bare, p));
            }
            if (profile == BABYLON_OPENPBR) tolerance = 1e-5; /* of v, whose a and b are small numbers */
            if (profile == KHR_FUZZ || profile == KHR_FUZZ_EXACT) {
                Surface bare = s;
                bare.sheen = 0.0f;
                tolerance = 6e-3 * (double)s.sheen * max3(engine_khr_fuzz(&bare, p));
            }
            for (int k = 0; k < 3; k++) {
                double error = fmax(fabs(got.c[k] - want.c[k]) - tolerance, 0.0) / fmax(fabs(want.c[k]), 1e-4);
                worst[profile] = fmax(worst[profile], error);
                if (!(error <= 1e-5))
                    fail_msg("%s, surface %d, channel %d: %.7g and not %.7g", weft_profile_name(profile), n, k,
                             got.c[k], want.c[k]);
            }
        }
    }
    for (int profile = 1; profile < PROFILES; profile++)
        print_message("%-15s off by %.1e at most\n", weft_profile_name(profile), worst[profile]);
    assert_null(weft_profile_name(PROFILES));
}

static float hard(Random *random, float low, float high) {
    float u = random_unit(random);
    return u < 0.2f ? low : u < 0.4f ? high : weft_mix(low, high, random_unit(random));
}

static void profiles_are_finite_and_not_negative(void **state) {
    (void)state;
    Random random = {72};
    static const double cosines[] = {1e-6, 1e-4, 0.01, 0.3, 0.8, 1.0};
    static const double azimuths[] = {0.0, PI_DOUBLE, 1.0, PI_DOUBLE / 2};
    for (int n = 0; n < 400; n++) {
        Surface s = any_surface(&random);
        s.base_color = (Rgb){hard(&random, 0, 1), hard(&random, 0, 1), hard(&random, 0, 1)};
        s.sheen_color = (Rgb){hard(&random, 0, 1), hard(&random, 0, 1000), hard(&random, 0, 1)};
        s.specular_color = (Rgb){hard(&random, 0, 1), hard(&random, 0, 1000), hard(&random, 0, 1)};
        s.roughness = hard(&random, 0, 2), s.sheen_roughness = hard(&random, 0, 2);
        s.clearcoat_roughness = hard(&random, 0, 2), s.clearcoat = hard(&random, 0, 1);
        s.specular = hard(&random, 0, 2), s.sheen = hard(&random, 0, 10), s.metallic = hard(&random, 0, 1);
        s.anisotropy = hard(&random, 0, 1), s.ior = hard(&random, 0, 1e6f),
        s.reflectance = hard(&random, -0.34f, 19.66f);
        s.clearcoat_gloss = hard(&random, 0, 1), s.subsurface = hard(&random, 0, 1);
        s.clearcoat_normal = direction(1.5 * (double)random_unit(&random), 6.0 * (double)random_unit(&random));
        for (int d = 0; d < 6 * 6 * 4; d++) {
            Dir o = direction_cos(cosines[d % 6], 0.3), i = direction_cos(cosines[d / 6 % 6], 0.3 + azimuths[d / 36]);
            o.z = max(o.z, 1e-6f), i.z = max(i.z, 1e-6f);
            int profile = 1 + (n + d) % (PROFILES - 1);
            Choices choices = only_profile(profile);
            SeenStack stack;
            seen_make(&stack, &s, &choices, khronos_ref(), o);
            StackValue value = seen_eval(&stack, i, 0);
            Rgb f = value.f_cos;
            if (!(isfinite(f.r) && isfinite(f.g) && isfinite(f.b) && isfinite(value.pdf) && f.r >= 0.0f &&
                  f.g >= 0.0f && f.b >= 0.0f && value.pdf >= 0.0f))
                fail_msg("%s, surface %d: %g %g %g, pdf %g", weft_profile_name(profile), n, (double)f.r, (double)f.g,
                         (double)f.b, (double)value.pdf);
            Dir w = seen_sample(&stack, random_unit(&random), random_unit(&random));
            assert_true(isfinite(w.x) && isfinite(w.y) && isfinite(w.z));
        }
    }
}

/* E of the white sheen of a profile, as the research of these engines found it by other means. */
static void sheens_of_profiles_have_the_albedo_of_their_engines(void **state) {
    (void)state;
    static const struct {
        int profile;
        float r;
        double v, e;
    } known[] = {
        {THREE, 0.10f, 0.02, 1.54},    {THREE, 0.25f, 0.02, 1.10},    {THREE, 0.5f, 0.3, 0.381},
        {THREE, 1.0f, 0.5, 0.287},     {UNREAL4, 0.1f, 0.02, 0.470},  {UNREAL4, 0.5f, 0.02, 0.684},
        {UNREAL4, 0.5f, 0.5, 0.266},   {UNREAL4, 1.0f, 0.5, 0.307},   {UNREAL4, 1.0f, 1.0, 0.25},
        {ORDER, 0.1f, 0.02, 0.470},    {ORDER, 0.5f, 0.02, 0.730},    {ORDER, 0.5f, 0.5, 0.253},
        {ORDER, 1.0f, 0.5, 0.310},     {ORDER, 1.0f, 1.0, 0.132},     {VELVET, 0.5f, 0.02, 0.968},
        {VELVET, 0.5f, 0.5, 0.280},    {VELVET, 0.5f, 1.0, 0.0037},   {VELVET, 1.0f, 0.5, 0.610},
        {COTTON, 0.1f, 0.1, 0.899},    {COTTON, 0.25f, 0.02, 1.382},  {COTTON, 0.5f, 0.3, 0.381},
        {COTTON, 0.7f, 0.02, 0.688},   {COTTON, 1.0f, 1.0, 0.141},    {FILAMENT, 0.1f, 0.02, 2.693},
        {FILAMENT, 0.5f, 0.02, 0.837}, {MATERIALX, 0.5f, 0.5, 0.230}, {KHRONOS, 0.1f, 0.02, 1.240},
        {KHRONOS, 0.25f, 0.02, 0.817}, {KHRONOS, 0.5f, 0.1, 0.553},   {KHRONOS, 1.0f, 0.02, 0.760},
        {KHRONOS, 1.0f, 0.3, 0.490},
    };
    for (size_t k = 0; k < sizeof known / sizeof *known; k++) {
        Random random = {5};
        Surface s = any_surface(&random);
        s.roughness = s.sheen_roughness = known[k].r;
        s.sheen_color = (Rgb){1.0f, 1.0f, 1.0f};
        s.sheen = 1.0f;
        s.clearcoat = s.anisotropy = 0.0f;
        Dir o = direction_cos(known[k].v, 0.0);
        Choices choices = only_profile(known[k].profile);
        SeenStack stack;
        seen_make(&stack, &s, &choices, (TableRef){.kind = TABLE_NONE}, o);
        Albedo e = albedo_quadrature(&stack.stack.sheen.lobe, o, 1e-5);
        double got = (double)stack.stack.sheen.f0.g * (double)e.f0 + (double)stack.stack.sheen.f90.g * (double)e.f90;
        if (!(fabs(got - known[k].e) < 0.004 * known[k].e + 5e-4))
            fail_msg("%s at %g, cos_o %g: %.5f and not %g", weft_profile_name(known[k].profile), (double)known[k].r,
                     known[k].v, got, known[k].e);
    }
}

static void engine_formulas_have_their_known_values(void **state) {
    (void)state;
    assert_float_equal(three_albedo(0.02f, 0.10f), 0.27f, 0.005f);
    assert_float_equal(three_albedo(0.02f, 0.25f), 0.39f, 0.005f);
    assert_float_equal(three_albedo(0.3f, 0.5f), 0.232f, 0.0006f);
    assert_float_equal(three_albedo(0.5f, 1.0f), 0.296f, 0.0006f);
    assert_float_equal(materialx_albedo(0.5f, 0.01f), 0.0f, 0.0f); /* -0.026, clamped */
    assert_float_equal(materialx_albedo(0.02f, 0.06f), 1.0f, 0.02f);
    /* white ggx: all of what a smooth one receives, 1 - ln 2 at the normal of the roughest */
    assert_float_equal(materialx_a(0.5f, 0.001f) + materialx_b(0.5f, 0.001f), 1.0f, 0.02f);
    assert_float_equal(materialx_a(1.0f, 1.0f) + materialx_b(1.0f, 1.0f), 0.3069f, 0.03f);
    /* a norm of 1, for D with a floor */
    for (int k = 1; k <= 10; k++) {
        float alpha = sqrt(0.1f * (float)k);
        double sum = 0.0;
        enum { STEPS = 20000 };
        for (int j = 0; j < STEPS; j++) {
            float s2 = ((float)j + 0.5f) / STEPS;
            sum += PI_DOUBLE * (double)charlie_floored_d(alpha, dir(sqrt(s2), 0.0f, sqrt(1.0f - s2))) / STEPS;
        }
        assert_true(fabs(sum - 1.0) < 2e-5);
    }
    assert_float_equal(charlie_floored_gain(1.0f), 1.00035f, 1e-5f);
}

/* Filament's sum for E of white ggx. */
static double ggx_sum(double r, double v, int points) {
    double a2 = sq(r * r), sum = 0.0;
    for (int k = 0; k < points; k++) {
        double mirrored = 0.0, place = 0.5;
        for (int bit = 0; bit < 16; bit++, place *= 0.5) mirrored += (k >> bit & 1) ? place : 0.0;
        double nh = (sqrt)((1.0 - mirrored) / (1.0 + (a2 - 1.0) * mirrored));
        double hx = (sqrt)(1.0 - nh * nh) * (cos)(2.0 * PI_DOUBLE * k / points);
        double vh = (sqrt)(1.0 - v * v) * hx + v * nh, l = 2.0 * vh * nh - v;
        if (l > 0.0) sum += 4.0 / points * smith(r * r, (Pair){.v = v, .l = l}) * l * vh / nh;
    }
    return sum;
}

/* Texels against a quadrature that shares nothing with the sums they come from. */
static void tables_of_engines_are_near_a_quadrature(void **state) {
    (void)state;
    static const int all[] = {ENGINE_FILAMENT_SHEEN, ENGINE_FILAMENT_GGX, ENGINE_BABYLON_SHEEN, ENGINE_BABYLON_GGX};
    for (int t = 0; t < 4; t++) {
        TableRef table = engine_table(all[t]);
        bool sheen = t % 2 == 0;
        double worst = 0.0;
        assert_int_equal(table.rows, t < 2 ? 128 : 256);
        for (int j = table.rows / 10; j < table.rows; j += table.rows / 9)
            for (int k = table.columns / 20; k < table.columns; k += table.columns / 7) {
                double r = fmin((j + 1.5) / table.rows, 1.0), v = (k + 0.5) / table.columns; /* the shift */
                Lobe lobe = lobe_default(sheen ? LOBE_CHARLIE_NEUBELT : LOBE_GGX);
                lobe.params[0] = (float)(r * r);
                Albedo e = albedo_quadrature(&lobe, direction_cos(v, 0.0), 1e-5);
                worst = fmax(worst, fabs((double)(e.f0 + e.f90 - table.texels[j * table.columns + k])));
            }
        print_message("table %d: texels within %.1e of the integral\n", all[t], worst);
        assert_true(worst < (sheen ? 2e-3 : 1e-2));
    }
    for (int j = 3; j < 128; j += 31)
        for (int k = 0; k < 128; k += 21) {
            float got = engine_table(ENGINE_FILAMENT_GGX).texels[j * 128 + k];
            assert_float_equal(got, (float)ggx_sum(fmin((j + 1.5) / 128.0, 1.0), (k + 0.5) / 128.0, 1024), 2e-4f);
        }
    /* .0548 by the integral */
    assert_float_equal(table_albedo(engine_table(ENGINE_FILAMENT_SHEEN), 0.3f, 0.1f), 0.0711f, 5e-4f);
    assert_float_equal(table_albedo(engine_table(ENGINE_FILAMENT_SHEEN), 0.3f, 0.5f), 0.381f, 0.01f);

    /* of DFGLUTData.js, scale plus bias: roughness, cosine */
    static const struct {
        int r, v;
        float e;
    } shipped[] = {{1, 0, 0.9531f},  {2, 0, 0.8831f},  {6, 0, 0.9380f},   {4, 1, 0.8804f}, {8, 4, 0.8266f},
                   {12, 8, 0.6303f}, {15, 0, 0.8989f}, {15, 15, 0.3453f}, {9, 12, 0.8094f}};
    TableRef three = engine_table(ENGINE_THREE_GGX);
    for (size_t k = 0; k < sizeof shipped / sizeof *shipped; k++)
        assert_float_equal(three.texels[shipped[k].r * 16 + shipped[k].v], shipped[k].e,
                           (shipped[k].v ? 9e-3f : 0.015f));
}

/* What the substitute for glTF's picture may be off by, if that was made without the clamp on V. */
static void substitute_for_the_table_of_gltf_is_near(void **state) {
    (void)state;
    double grazing = 0.0, elsewhere = 0.0;
    for (int k = 2; k <= 20; k++)
        for (int c = 0; c < 4; c++) {
            static const double cosines[] = {0.02, 0.1, 0.2, 0.5};
            Dir o = direction_cos(cosines[c], 0.0);
            Lobe clamped = lobe_rough(LOBE_CHARLIE_KHRONOS, 0.05f * (float)k);
            Lobe plain = lobe_rough(LOBE_CHARLIE_CONTY_KULLA, 0.05f * (float)k);
            double e = fmin((double)albedo_quadrature(&plain, o, 1e-4).f0, 1.0) -
                       fmin((double)albedo_quadrature(&clamped, o, 1e-4).f0, 1.0);
            if (c == 0) grazing = fmax(grazing, e);
            if (c > 0) elsewhere = fmax(elsewhere, e);
        }
    print_message("without the clamp E of khronos is up to %.3f more at cos_o 0.02, %.3f from 0.1 on\n", grazing,
                  elsewhere);
    assert_true(grazing < 0.16 && elsewhere < 0.06);
}

static void no_two_profiles_are_the_same(void **state) {
    (void)state;
    Random random = {73};
    static double apart[PROFILES][PROFILES];
    for (int n = 0; n < 200; n++) {
        Surface s = any_surface(&random);
        Dir o = random_direction(&random), i = random_direction(&random);
        double f[PROFILES];
        for (int profile = 0; profile < PROFILES; profile++) {
            Choices choices = only_profile(profile);
            SeenStack stack;
            seen_make(&stack, &s, &choices, khronos_ref(), o);
            f[profile] = (double)seen_eval(&stack, i, 0).f_cos.g;
        }
        for (int j = 0; j < PROFILES; j++)
            for (int k = 0; k < j; k++)
                apart[j][k] = fmax(apart[j][k], fabs(f[j] - f[k]) / fmax(fmax(f[j], f[k]), 1e-6));
    }
    for (int j = 0; j < PROFILES; j++)
        for (int k = 0; k < j; k++)
            if (!(apart[j][k] > 0.05)) fail_msg("%s is %s", weft_profile_name(j), weft_profile_name(k));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(profiles_follow_the_formulas_of_their_engines),
        cmocka_unit_test(profiles_are_finite_and_not_negative),
        cmocka_unit_test(sheens_of_profiles_have_the_albedo_of_their_engines),
        cmocka_unit_test(engine_formulas_have_their_known_values),
        cmocka_unit_test(tables_of_engines_are_near_a_quadrature),
        cmocka_unit_test(substitute_for_the_table_of_gltf_is_near),
        cmocka_unit_test(no_two_profiles_are_the_same),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
