/* RGL's .bsdf: evaluation against the formulas written a second time, in double precision and by quadrature in
 * place of sums kept in tables; files of lobes come back; sampling is what its pdf says; hostile files end in
 * one line. No file of the database was at hand. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

#include <cmocka.h>

#include "base/pi.h"
#include "brdf/rgl.h"
#include "brdf/spectrum.h"
#include "measure/check/chi_square.h"
#include "scratch.h"
#include "tensor_bytes.h"
#include "weft/weft.h"

#undef sin /* of the dialect, which is single precision */
#undef cos
#undef sqrt
#undef acos
#undef floor

static TensorBytes file;

/* The tables of one file. */
enum { PHIS = 4, THETAS = 3, WIDE = 4, HIGH = 3, SIDE = 3, WAVES = 4, SLICES = PHIS * THETAS };
typedef struct Tables {
    size_t phis;
    float phi[PHIS], theta[THETAS], ndf[HIGH * WIDE], sigma[2 * WIDE];
    float normals[SLICES * HIGH * WIDE], luminance[SLICES * SIDE * SIDE], color[SLICES * WAVES * SIDE * SIDE];
    float waves[WAVES];
} Tables;

static double drawn(void) {
    static uint32_t seed = 7;
    seed = seed * 1664525u + 1013904223u;
    return (seed >> 8) * 0x1p-24;
}

static void fill(float *values, size_t count, double low, double high) {
    for (size_t k = 0; k < count; k++) values[k] = (float)(low + (high - low) * drawn());
}

/* Azimuths from -pi over `span`, or one alone. */
static Tables random_tables(size_t phis, double span) {
    Tables t = {.phis = phis};
    for (size_t k = 0; k < phis; k++)
        t.phi[k] = phis > 1 ? (float)(span * (double)k / (double)(phis - 1) - PI_DOUBLE) : 0.0f;
    for (size_t k = 0; k < THETAS; k++) t.theta[k] = 0.1f + 0.6f * (float)k;
    for (size_t k = 0; k < WAVES; k++) t.waves[k] = 430.0f + 65.0f * (float)k;
    fill(t.ndf, sizeof t.ndf / 4, 0.2, 3.0);
    fill(t.sigma, sizeof t.sigma / 4, 0.2, 1.0);
    fill(t.normals, sizeof t.normals / 4, 0.1, 4.0);
    fill(t.luminance, sizeof t.luminance / 4, 0.1, 4.0);
    fill(t.color, sizeof t.color / 4, 0.1, 0.9);
    return t;
}

static void file_make(const Tables *t, size_t channels) {
    const size_t one[] = {1}, phis[] = {t->phis}, thetas[] = {THETAS}, ndf[] = {HIGH, WIDE}, sigma[] = {2, WIDE},
                 normals[] = {t->phis, THETAS, HIGH, WIDE}, light[] = {t->phis, THETAS, SIDE, SIDE},
                 color[] = {t->phis, THETAS, channels, SIDE, SIDE}, waves[] = {WAVES};
    bytes_begin(&file, channels == 3 ? 9 : 10);
    bytes_array(&file, "description", NULL, 1, one);
    bytes_array(&file, "jacobian", NULL, 1, one);
    bytes_array(&file, "phi_i", t->phi, 1, phis);
    bytes_array(&file, "theta_i", t->theta, 1, thetas);
    bytes_array(&file, "ndf", t->ndf, 2, ndf);
    bytes_array(&file, "sigma", t->sigma, 2, sigma);
    bytes_array(&file, "vndf", t->normals, 4, normals);
    bytes_array(&file, "luminance", t->luminance, 4, light);
    bytes_array(&file, channels == 3 ? "rgb" : "spectra", t->color, 5, color);
    if (channels != 3) bytes_array(&file, "wavelengths", t->waves, 1, waves);
    bytes_end(&file);
}

static Rgl file_read_back(void) {
    Rgl rgl;
    WeftError error;
    if (rgl_read_memory(file.data, file.size, "file", &rgl, &error) != WEFT_OK) fail_msg("%s", error.text);
    return rgl;
}

/* A table at a place, straight from its definition. */
static double bilinear(const float *table, int width, int height, double x, double y) {
    int column = (int)fmin(floor(x * (width - 1)), width - 2), row = (int)fmin(floor(y * (height - 1)), height - 2);
    double s = x * (width - 1) - column, t = y * (height - 1) - row, sum = 0.0;
    for (int k = 0; k < 4; k++)
        sum +=
            (k & 1 ? s : 1.0 - s) * (k >> 1 ? t : 1.0 - t) * (double)table[(row + (k >> 1)) * width + column + (k & 1)];
    return sum;
}

/* The integral of a function that is quadratic on each of n equal pieces of 0 .. 1, up to x: Simpson's rule. */
typedef double Along(const void *user, double x);
static double integral(Along *f, const void *user, int n, double x) {
    double sum = 0.0;
    for (int k = 0; k < n; k++) {
        double from = (double)k / n, to = fmin((k + 1.0) / n, x);
        if (to > from) sum += (to - from) / 6.0 * (f(user, from) + 4.0 * f(user, 0.5 * (from + to)) + f(user, to));
    }
    return sum;
}

/* Slices of one table, blended; each is scaled to an integral of 1 by itself. */
typedef struct Mixed {
    const float *table;
    int width, height, count;
    size_t slice[4];
    double weight[4], y;
} Mixed;

static double mixed_row(const void *user, double x) {
    const Mixed *m = user;
    double sum = 0.0;
    for (int k = 0; k < m->count; k++)
        sum += m->weight[k] *
               bilinear(m->table + m->slice[k] * (size_t)(m->width * m->height), m->width, m->height, x, m->y);
    return sum;
}
static double mixed_rows(const void *user, double y) {
    Mixed at = *(const Mixed *)user;
    at.y = y;
    return integral(mixed_row, &at, at.width - 1, 1.0);
}

/* Weights of the slices about a direction. */
static Mixed mixed_at(const Tables *t, const float *table, int width, int height, double phi, double theta) {
    Mixed m = {.table = table, .width = width, .height = height};
    size_t p = 0, h = 0;
    while (t->phis > 1 && p + 2 < t->phis && phi >= (double)t->phi[p + 1]) p++;
    while (h + 2 < THETAS && theta >= (double)t->theta[h + 1]) h++;
    double a = t->phis > 1 ? (phi - (double)t->phi[p]) / (double)(t->phi[p + 1] - t->phi[p]) : 0.0;
    double b = (theta - (double)t->theta[h]) / (double)(t->theta[h + 1] - t->theta[h]);
    a = fmin(fmax(a, 0.0), 1.0), b = fmin(fmax(b, 0.0), 1.0);
    for (size_t k = 0; k < (t->phis > 1 ? 4u : 2u); k++) {
        m.slice[m.count] = (p + (k >> 1)) * THETAS + h + (k & 1);
        m.weight[m.count++] = (k >> 1 ? a : 1.0 - a) * (k & 1 ? b : 1.0 - b);
    }
    return m;
}

/* Divides the weights by the integrals of the slices. */
static void mixed_scale(Mixed *m) {
    for (int k = 0; k < m->count; k++) {
        Mixed one = {m->table, m->width, m->height, 1, {m->slice[k]}, {1.0}, 0.0};
        m->weight[k] /= integral(mixed_rows, &one, m->height - 1, 1.0);
    }
}

/* f and pdf by the formulas of rgl.h. */
typedef struct Expected {
    double f[3], pdf;
} Expected;

/* s of a pair; the blend of luminances there; what the rest asks for. */
typedef struct Places {
    double phi, theta, ux, uy, sin_m, length, density;
} Places;
static void expected_place(const Tables *t, const double o[3], const double i[3], int parts, SquarePoint *s, Mixed *l,
                           Places *places) {
    double w[2][3];
    for (int k = 0; k < 3; k++) w[0][k] = o[k], w[1][k] = i[k];
    double sy = parts > 1 && o[1] > 0.0 ? -1.0 : 1.0, sx = parts == 4 ? (o[0] > 0.0 ? -1.0 : 1.0) : sy;
    for (int d = 0; d < 2; d++) w[d][0] *= sx, w[d][1] *= sy;
    double m[3], length = 0.0;
    for (int k = 0; k < 3; k++) m[k] = w[0][k] + w[1][k], length += m[k] * m[k];
    length = sqrt(length);
    double theta = acos(w[0][2]), phi = atan2(w[0][1], w[0][0]), theta_m = acos(m[2] / length),
           phi_m = atan2(m[1], m[0]) - (t->phis <= 2 ? phi : 0.0);
    double ux = sqrt(2.0 * theta_m / PI_DOUBLE), uy = (phi_m + PI_DOUBLE) / (2.0 * PI_DOUBLE);
    uy -= floor(uy);
    Mixed n = mixed_at(t, t->normals, WIDE, HIGH, phi, theta);
    mixed_scale(&n);
    n.y = uy;
    s->x = integral(mixed_row, &n, WIDE - 1, ux) / integral(mixed_row, &n, WIDE - 1, 1.0);
    s->y = integral(mixed_rows, &n, HIGH - 1, uy);
    *l = mixed_at(t, t->luminance, SIDE, SIDE, phi, theta);
    mixed_scale(l);
    if (places) *places = (Places){phi, theta, ux, uy, sin(theta_m), length, mixed_row(&n, ux)};
}

static Expected expected(const Tables *t, const double o[3], const double i[3], int parts) {
    SquarePoint s;
    Mixed l;
    Places p;
    Expected e;
    expected_place(t, o, i, parts, &s, &l, &p);
    l.y = s.y;
    double sigma =
        bilinear(t->sigma, WIDE, 2, sqrt(2.0 * p.theta / PI_DOUBLE), (p.phi + PI_DOUBLE) / (2.0 * PI_DOUBLE));
    double scale = bilinear(t->ndf, WIDE, HIGH, p.ux, p.uy) / (4.0 * sigma * i[2]);
    e.pdf = p.density * mixed_row(&l, s.x) / (2.0 * PI_DOUBLE * PI_DOUBLE * p.ux * p.sin_m * 4.0 * 0.5 * p.length);
    for (int c = 0; c < 3; c++) {
        double color = 0.0;
        Mixed r = mixed_at(t, t->color, SIDE, SIDE, p.phi, p.theta);
        for (int k = 0; k < r.count; k++)
            color +=
                r.weight[k] * bilinear(t->color + (r.slice[k] * 3 + (size_t)c) * SIDE * SIDE, SIDE, SIDE, s.x, s.y);
        e.f[c] = color * scale;
    }
    return e;
}

static void direction_drawn(double w[3]) {
    double z = 0.05 + 0.94 * drawn(), phi = 2.0 * PI_DOUBLE * drawn(), r = sqrt(1.0 - z * z);
    w[0] = r * cos(phi), w[1] = r * sin(phi), w[2] = z;
}

static Dir dir_from(const double w[3]) { return dir((float)w[0], (float)w[1], (float)w[2]); }

static void tables_are_as_by_hand(const Tables *t, int parts) {
    file_make(t, 3);
    Rgl rgl = file_read_back();
    assert_int_equal(rgl.parts, parts);
    assert_int_equal(rgl_isotropic(&rgl), t->phis <= 2);
    for (int n = 0; n < 3000; n++) {
        double o[3], i[3];
        direction_drawn(o);
        direction_drawn(i);
        float f[3];
        rgl_at(&rgl, dir_from(o), dir_from(i), f);
        float pdf = rgl_pdf(&rgl, dir_from(o), dir_from(i));
        Expected e = expected(t, o, i, parts);
        for (int c = 0; c < 3; c++)
            if (!(fabs((double)f[c] - e.f[c]) <= 2e-5 * e.f[c])) fail_msg("f %.9g, not %.9g", (double)f[c], e.f[c]);
        if (!(fabs((double)pdf - e.pdf) <= 2e-4 * e.pdf + 1e-6)) fail_msg("pdf %.9g, not %.9g", (double)pdf, e.pdf);
    }
    rgl_free(&rgl);
}

static void evaluation_is_the_formula(void **state) {
    (void)state;
    const Tables isotropic = random_tables(1, 0.0), two = random_tables(2, 2.0 * PI_DOUBLE),
                 whole = random_tables(4, 2.0 * PI_DOUBLE), half = random_tables(3, PI_DOUBLE),
                 quarter = random_tables(3, 0.5 * PI_DOUBLE);
    tables_are_as_by_hand(&isotropic, 1);
    tables_are_as_by_hand(&two, 1);
    tables_are_as_by_hand(&whole, 1);
    tables_are_as_by_hand(&half, 2);
    tables_are_as_by_hand(&quarter, 4);
}

/* f and pdf are as beside where parts of the circle meet, at y = 0. */
static void seams_do_not_show(void **state) {
    (void)state;
    const struct {
        Tables tables;
        int parts;
    } all[] = {{random_tables(3, PI_DOUBLE), 2}, {random_tables(3, 0.5 * PI_DOUBLE), 4}};
    for (size_t k = 0; k < sizeof all / sizeof *all; k++) {
        file_make(&all[k].tables, 3);
        Rgl rgl = file_read_back();
        assert_int_equal(rgl.parts, all[k].parts);
        for (int side = 0; side < 2; side++) {
            const float x = side ? 0.6f : -0.6f;
            const Dir i = dir(0.3f, 0.4f, 0.8660254f), o = dir(x, 0.0f, 0.8f), near = dir(x, -1e-6f, 0.8f);
            float at[3], beside[3], pdf = rgl_pdf(&rgl, o, i);
            rgl_at(&rgl, o, i, at);
            rgl_at(&rgl, near, i, beside);
            for (int c = 0; c < 3; c++) assert_float_equal(at[c], beside[c], 1e-4f * beside[c]);
            assert_float_equal(pdf, rgl_pdf(&rgl, near, i), 1e-3f * pdf);
        }
        rgl_free(&rgl);
    }
}

/* On paper: D 2, sigma 1/2 and R (0.3, 0.6, 0.9) everywhere give f = R 2 / (4 1/2 cos) = R / cos. */
static void even_tables_give_a_number_known_on_paper(void **state) {
    (void)state;
    Tables t = random_tables(1, 0.0);
    for (size_t k = 0; k < sizeof t.ndf / 4; k++) t.ndf[k] = 2.0f;
    for (size_t k = 0; k < sizeof t.sigma / 4; k++) t.sigma[k] = 0.5f;
    for (size_t k = 0; k < sizeof t.color / 4; k++) t.color[k] = 0.3f * (float)(1 + k / (SIDE * SIDE) % 3);
    file_make(&t, 3);
    Rgl rgl = file_read_back();
    float f[3];
    rgl_at(&rgl, dir(0.6f, 0.0f, 0.8f), dir(0.0f, 0.866025404f, 0.5f), f);
    for (int c = 0; c < 3; c++) assert_float_equal(f[c], 0.6f * (float)(c + 1), 1e-5f);
    rgl_at(&rgl, dir(0.6f, 0.0f, 0.8f), dir(0.0f, 0.8f, -0.6f), f);
    assert_true(!(f[0] > 0.0f));
    rgl_free(&rgl);
}

/* An even spectrum is grey; one that rises towards red is redder than blue; f is linear in it. */
static void spectra_become_colors(void **state) {
    (void)state;
    Tables t = random_tables(4, 2.0 * PI_DOUBLE), half = t;
    const double o[3] = {0.48, 0.36, 0.8}, i[3] = {-0.6, 0.0, 0.8};
    float grey[3], red[3], less[3];
    for (int rising = 0; rising < 2; rising++) {
        for (size_t k = 0; k < sizeof t.color / 4; k++)
            t.color[k] = rising ? 0.2f * (float)(1 + k / (SIDE * SIDE) % WAVES) : 0.5f;
        file_make(&t, WAVES);
        Rgl rgl = file_read_back();
        rgl_at(&rgl, dir_from(o), dir_from(i), rising ? red : grey);
        rgl_free(&rgl);
    }
    for (size_t k = 0; k < sizeof t.color / 4; k++) half.color[k] = 0.5f * t.color[k];
    file_make(&half, WAVES);
    Rgl rgl = file_read_back();
    rgl_at(&rgl, dir_from(o), dir_from(i), less);
    rgl_free(&rgl);
    assert_true(grey[0] > 0.0f && red[0] > red[1] && red[1] > red[2]);
    for (int c = 0; c < 3; c++) {
        assert_float_equal(grey[c], grey[0], 1e-5f * grey[0]);
        assert_float_equal(less[c], 0.5f * red[c], 1e-5f * red[c]);
    }
    const float narrow[2] = {900.0f, 950.0f};
    double weights[6];
    assert_false(spectrum_weights(narrow, 2, weights));
    float fine[81];
    double many[3 * 81], sum = 0.0;
    for (int k = 0; k < 81; k++) fine[k] = 380.0f + 5.0f * (float)k;
    assert_true(spectrum_weights(fine, 81, many));
    for (int k = 0; k < 81; k++) sum += many[k] * (k == 46); /* 610 nm: red is its largest */
    assert_true(sum > 0.0 && many[46] > many[81 + 46] && many[46] > many[162 + 46]);
}

/* The record that chi_square.h knows by pointer only. */
typedef struct Sampled {
    Bsdf bsdf;
    const Rgl *rgl;
} Sampled;

static void sampled_pdf(const BsdfView *view, Dirs i, float *pdf) {
    const Sampled *self = (const Sampled *)view->bsdf;
    for (size_t k = 0; k < i.n; k++) pdf[k] = rgl_pdf(self->rgl, view->o, dir(i.x[k], i.y[k], i.z[k]));
}
static Dir sampled_draw(const BsdfView *view, float u, float v) {
    return rgl_sample(((const Sampled *)view->bsdf)->rgl, view->o, u, v);
}

static void check_sampling(const Rgl *rgl, const char *name) {
    static const float cosines[] = {0.97f, 0.8f, 0.5f, 0.2f};
    static Sampled sampled;
    sampled = (Sampled){.bsdf = {.pdf = sampled_pdf, .sample = sampled_draw}, .rgl = rgl};
    for (int k = 0; k < 4; k++) {
        float r = sqrtf(1.0f - cosines[k] * cosines[k]);
        const BsdfView view = {.bsdf = &sampled.bsdf, .o = dir(0.8f * r, -0.6f * r, cosines[k])};
        ChiSquare found;
        assert_true(chi_square_measure(&view, 40000, 20, 3, &found));
        print_message("%s, cos_o %.2f: pdf integrates to %.4f, p = %.3f\n", name, (double)cosines[k], found.integral,
                      found.p);
        assert_true(found.integral <= 1.002);
        assert_int_equal(found.stray, 0);
        assert_true(found.p > 0.01 / 32);
    }
}

static WeftLobe lobe_of_name(const char *id) {
    WeftLobe lobe;
    WeftError error;
    assert_int_equal(weft_lobe_init(id, &lobe, &error), WEFT_OK);
    lobe.f0[0] = 0.9f, lobe.f0[1] = 0.5f, lobe.f0[2] = 0.1f;
    return lobe;
}

/* A file of a lobe, read as tables. */
static Rgl written(const WeftLobe *lobe, const WeftBsdfDesc *desc) {
    char folder[SCRATCH_SIZE], path[SCRATCH_SIZE + 16];
    WeftReflection *of;
    WeftError error;
    Rgl rgl;
    assert_true(scratch_make(folder));
    snprintf(path, sizeof path, "%s/lobe.bsdf", folder);
    assert_int_equal(weft_reflection_of_lobe(lobe, &of, &error), WEFT_OK);
    if (weft_reflection_write(of, path, desc, &error) != WEFT_OK) fail_msg("%s", error.text);
    FILE *stream = fopen(path, "rb");
    assert_non_null(stream);
    fseek(stream, 0, SEEK_END);
    size_t size = (size_t)ftell(stream);
    rewind(stream);
    unsigned char *bytes = malloc(size);
    assert_non_null(bytes);
    assert_int_equal(fread(bytes, 1, size, stream), size);
    fclose(stream);
    if (rgl_read_memory(bytes, size, path, &rgl, &error) != WEFT_OK) fail_msg("%s", error.text);
    WeftReflection *back;
    assert_int_equal(weft_reflection_read(path, &back, &error), WEFT_OK);
    const float wo[3] = {0.6f, 0.0f, 0.8f}, wi[1][3] = {{0.0f, 0.6f, 0.8f}};
    float f[1][3], g[3];
    weft_reflection_eval(back, WEFT_PART_ALL, wo, 1, wi, f);
    rgl_at(&rgl, dir(wo[0], wo[1], wo[2]), dir(wi[0][0], wi[0][1], wi[0][2]), g);
    for (int c = 0; c < 3; c++) assert_float_equal(f[0][c], g[c], 0.0f);
    weft_reflection_free(back);
    free(bytes);
    unlink(path);
    assert_true(scratch_remove_empty(folder));
    weft_reflection_free(of);
    return rgl;
}

/* Mean and largest difference of f from the lobe, over its mean, of pairs up to 80 degrees; wo at a slice or
 * anywhere. */
static void compare(const Rgl *rgl, const WeftLobe *lobe, bool anywhere, double *mean, double *most) {
    double sum = 0.0, off = 0.0;
    enum { PAIRS = 20000 };
    *most = 0.0;
    for (int n = 0; n < PAIRS; n++) {
        const double drawn_theta = 80.0 * RADIANS * drawn();
        int slice = 0;
        while ((double)rgl->theta[slice] + (double)rgl->theta[slice + 1] < 2.0 * drawn_theta) slice++;
        double theta = (double)rgl->theta[slice];
        double phi = (double)rgl->phi[(int)(drawn() * rgl->phis)];
        if (anywhere) theta = 80.0 / 180.0 * PI_DOUBLE * drawn(), phi = 2.0 * PI_DOUBLE * drawn() - PI_DOUBLE;
        const double o[3] = {sin(theta) * cos(phi), sin(theta) * sin(phi), cos(theta)};
        double i[3];
        do direction_drawn(i);
        while (i[2] < 0.1737);
        const float wo[3] = {(float)o[0], (float)o[1], (float)o[2]}, wi[3] = {(float)i[0], (float)i[1], (float)i[2]};
        float f[3], g[3];
        weft_lobe_eval(lobe, wo, wi, f);
        rgl_at(rgl, dir_from(o), dir_from(i), g);
        for (int c = 0; c < 3; c++) {
            double d = fabs((double)f[c] - (double)g[c]);
            sum += (double)f[c], off += d;
            *most = fmax(*most, d);
        }
    }
    *mean = off / sum;
    *most *= 3.0 * PAIRS / sum;
}

static void lobes_come_back(void **state) {
    (void)state;
    static const struct {
        const char *id;
        float alpha; /* 0: its default */
        WeftBsdfDesc desc;
        double slice, anywhere; /* mean differences */
    } rows[] = {{"ggx", 0.0f, {0}, 1e-3, 1e-3},
                {"ggx", 0.1f, {0}, 1.7e-3, 1e-3},
                {"body", 0.0f, {0}, 1e-3, 1e-3},
                {"fabric", 0.0f, {0}, 1e-3, 1e-3},
                {"charlie-neubelt", 0.0f, {0}, 1e-3, 1e-3},
                {"charlie-neubelt", 0.05f, {0}, 1.7e-3, 1e-3},
                {"silk", 0.0f, {0}, 1.7e-3, 1e-3},
                {"threads", 0.0f, {.thetas = 16, .phis = 9, .side = 32}, 0.012, 0.01},
                {"threads", 0.0f, {0}, 1.7e-3, 1e-3}}; /* 230 MB */
    for (size_t k = 0; k < sizeof rows / sizeof *rows - (getenv("WEFT_TEST_LONG") ? 0 : 1); k++) {
        WeftLobe lobe = lobe_of_name(rows[k].id);
        if (rows[k].alpha > 0.0f) lobe.params[0] = rows[k].alpha;
        Rgl rgl = written(&lobe, &rows[k].desc);
        double mean[2], most[2];
        compare(&rgl, &lobe, false, &mean[0], &most[0]);
        compare(&rgl, &lobe, true, &mean[1], &most[1]);
        print_message("%s %.2f, %dx%d, %d azimuths of 1/%d: wo of a slice: mean %.5f, most %.3f of the mean; "
                      "anywhere %.5f, %.3f\n",
                      rows[k].id, (double)rows[k].alpha, rgl.thetas, rgl.side, rgl.phis, rgl.parts, mean[0], most[0],
                      mean[1], most[1]);
        assert_true(mean[0] <= rows[k].slice && mean[1] <= rows[k].anywhere);
        check_sampling(&rgl, rows[k].id);
        rgl_free(&rgl);
    }
}

/* The two numbers that a direction is drawn by, from its half vector by the formulas. */
static void numbers_of(const Tables *t, const double o[3], Dir i, int parts, double *u, double *v) {
    const double w[3] = {(double)i.x, (double)i.y, (double)i.z};
    SquarePoint s;
    Mixed l;
    expected_place(t, o, w, parts, &s, &l, NULL);
    l.y = s.y;
    *u = integral(mixed_row, &l, SIDE - 1, s.x) / integral(mixed_row, &l, SIDE - 1, 1.0);
    *v = integral(mixed_rows, &l, SIDE - 1, s.y);
}

static void sampling_is_the_inverse(void **state) {
    (void)state;
    const struct {
        Tables tables;
        int parts;
    } all[] = {{random_tables(1, 0.0), 1},
               {random_tables(4, 2.0 * PI_DOUBLE), 1},
               {random_tables(3, PI_DOUBLE), 2},
               {random_tables(3, 0.5 * PI_DOUBLE), 4}};
    for (size_t k = 0; k < sizeof all / sizeof *all; k++) {
        file_make(&all[k].tables, 3);
        Rgl rgl = file_read_back();
        int above = 0;
        for (int n = 0; n < 3000; n++) {
            double o[3], u = drawn(), v = drawn(), back[2];
            direction_drawn(o);
            Dir i = rgl_sample(&rgl, dir_from(o), (float)u, (float)v);
            Dir half = angles_between(dir_from(o), i).h;
            if (!(i.z > 0.02f) || half.z > 0.99f) continue; /* of which single precision leaves too little */
            above++;
            numbers_of(&all[k].tables, o, i, all[k].parts, &back[0], &back[1]);
            if (fabs(back[0] - u) > 2e-4 || fabs(back[1] - v) > 2e-4)
                fail_msg("%g %g, not %g %g", back[0], back[1], u, v);
        }
        assert_true(above > 500);
        rgl_free(&rgl);
    }
}

static void refused(const char *word) {
    Rgl rgl;
    WeftError error;
    assert_int_equal(rgl_read_memory(file.data, file.size, "file", &rgl, &error), WEFT_INPUT);
    assert_int_equal(error.message, WEFT_MESSAGE_BSDF);
    if (!strstr(error.text, word)) fail_msg("%s: no %s in it", error.text, word);
    assert_null(strchr(error.text, '\n'));
    rgl_free(&rgl);
}

static void put_at(size_t at, uint64_t value, int count) {
    size_t size = file.size;
    file.size = at;
    bytes_put(&file, value, count);
    file.size = size;
}

/* Extents whose product wraps around, offsets behind the end, numbers that are none: all without asking for
 * memory in their size. */
static void hostile_files_end_in_one_line(void **state) {
    (void)state;
    const Tables t = random_tables(1, 0.0);
    enum { NDF = 4, VNDF = 6, RGB = 8 };
    const uint64_t wraps[] = {0, UINT64_MAX, 1ull << 62, 1ull << 32, 100000};
    file_make(&t, 3);
    file.data[3] = 'x';
    refused("begin");
    file_make(&t, 3);
    file.data[12] = 2;
    refused("version");
    file_make(&t, 3);
    put_at(14, 4000000000u, 4);
    refused("arrays");
    file_make(&t, 3);
    file.size = 40;
    refused("cut short");
    file_make(&t, 3);
    file.size -= 4;
    refused("does not lie within");
    for (size_t k = 0; k < sizeof wraps / sizeof *wraps; k++)
        for (size_t axis = 0; axis < 4; axis++) {
            file_make(&t, 3);
            put_at(file.offset_at[VNDF] + 8 + 8 * axis, wraps[k], 8);
            refused("vndf");
        }
    file_make(&t, 3);
    put_at(file.offset_at[RGB], UINT64_MAX - 3, 8);
    refused("does not lie within");
    file_make(&t, 3);
    put_at(file.offset_at[NDF] - 1, 11, 1); /* doubles */
    refused("ndf");
    file_make(&t, 3);
    put_at(file.offset_at[NDF] - 1, 12, 1); /* behind the last */
    refused("type 12");
    file_make(&t, 3);
    put_at(file.offset_at[NDF] - 3, 0, 2);
    refused("0 axes");
    file_make(&t, 3);
    file.data[file.offset_at[NDF] - 5] = 'g';
    refused("\"ndf\" is missing");
    Tables bad = t;
    bad.theta[1] = bad.theta[0];
    file_make(&bad, 3);
    refused("ascend");
    bad = t;
    bad.color[5] = NAN;
    file_make(&bad, 3);
    refused("finite");
    bad = t;
    bad.waves[0] = 1000.0f, bad.waves[1] = 1100.0f, bad.waves[2] = 1200.0f, bad.waves[3] = 1300.0f;
    file_make(&bad, WAVES);
    refused("red to blue");
}

/* A copy of the first bytes in memory of just that size, which a sanitizer watches. */
static void files_cut_anywhere_end_in_one_line(void **state) {
    (void)state;
    const Tables t = random_tables(PHIS, 6.0);
    file_make(&t, WAVES);
    for (size_t size = 0; size < file.size; size++) {
        unsigned char *cut = malloc(size ? size : 1);
        Rgl rgl;
        WeftError error;
        assert_non_null(cut);
        memcpy(cut, file.data, size);
        assert_int_equal(rgl_read_memory(cut, size, "file", &rgl, &error), WEFT_INPUT);
        assert_int_equal(error.message, WEFT_MESSAGE_BSDF);
        assert_null(strchr(error.text, '\n'));
        if (size >= 12 && strstr(error.text, "does not begin")) fail_msg("%zu bytes: %s", size, error.text);
        rgl_free(&rgl);
        free(cut);
    }
}

/* A slice of zeros is drawn as one of ones; where sigma is 0 nothing is reflected. */
static void empty_tables_are_even(void **state) {
    (void)state;
    Tables t = random_tables(1, 0.0);
    Rgl both[2];
    for (int ones = 0; ones < 2; ones++) {
        for (size_t k = 0; k < sizeof t.normals / 4; k++) t.normals[k] = (float)ones;
        for (size_t k = 0; k < sizeof t.luminance / 4; k++) t.luminance[k] = (float)ones;
        memset(t.sigma, 0, sizeof t.sigma);
        file_make(&t, 3);
        both[ones] = file_read_back();
    }
    for (int n = 0; n < 1000; n++) {
        double o[3], i[3];
        direction_drawn(o);
        direction_drawn(i);
        float f[3], pdf[2], u = (float)drawn(), v = (float)drawn();
        Dir way[2];
        for (int ones = 0; ones < 2; ones++) {
            pdf[ones] = rgl_pdf(&both[ones], dir_from(o), dir_from(i));
            way[ones] = rgl_sample(&both[ones], dir_from(o), u, v);
            rgl_at(&both[ones], dir_from(o), dir_from(i), f);
            for (int c = 0; c < 3; c++) assert_float_equal(f[c], 0.0f, 0.0f);
        }
        assert_true(pdf[0] > 0.0f);
        assert_float_equal(pdf[0], pdf[1], 0.0f);
        assert_float_equal(dir_dot(way[0], way[1]), 1.0f, 1e-5f);
    }
    for (int ones = 0; ones < 2; ones++) rgl_free(&both[ones]);
}

static void bad_sizes_are_refused(void **state) {
    (void)state;
    static const WeftBsdfDesc bad[] = {{.thetas = 1}, {.thetas = 257}, {.side = 7},
                                       {.side = 513}, {.phis = 2},     {.thetas = 256, .side = 512}};
    const WeftLobe lobe = lobe_of_name("ggx"), walk = lobe_of_name("fibre-walk");
    const WeftBsdfDesc plain = {0};
    WeftReflection *of;
    WeftError error;
    assert_int_equal(weft_reflection_of_lobe(&lobe, &of, &error), WEFT_OK);
    for (size_t k = 0; k < sizeof bad / sizeof *bad; k++)
        assert_int_equal(weft_reflection_write(of, "none.bsdf", &bad[k], &error), WEFT_USAGE);
    weft_reflection_free(of);
    assert_int_equal(weft_reflection_of_lobe(&walk, &of, &error), WEFT_OK);
    assert_int_equal(weft_reflection_write(of, "none.bsdf", &plain, &error), WEFT_USAGE);
    weft_reflection_free(of);
    assert_int_not_equal(access("none.bsdf", F_OK), 0);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(evaluation_is_the_formula),
        cmocka_unit_test(seams_do_not_show),
        cmocka_unit_test(even_tables_give_a_number_known_on_paper),
        cmocka_unit_test(spectra_become_colors),
        cmocka_unit_test(sampling_is_the_inverse),
        cmocka_unit_test(lobes_come_back),
        cmocka_unit_test(hostile_files_end_in_one_line),
        cmocka_unit_test(files_cut_anywhere_end_in_one_line),
        cmocka_unit_test(empty_tables_are_even),
        cmocka_unit_test(bad_sizes_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
