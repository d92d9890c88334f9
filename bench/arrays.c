/* arrays - evaluations of one core, lobe by lobe: the loops of lobe_eval_n beside the same text in scalar
 * form
 *
 *   bench_arrays [--quick]
 *
 * The first column is the lobe's text compiled with -O2, no loop made parallel, and the C library's powf,
 * expf, exp2f and log2f; the others are times that. Every figure is the best of many short runs, the columns
 * taken in turn, over 1024 pairs of random directions (28 KiB, which fits the first cache). Then how near two
 * lobes come to what the core could do, and how far they are from double precision. */
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

#include "base/random.h"
#include "base/steady_clock.h"
#include "shading/catalogue/registry.h"

/* ---- the columns --------------------------------------------------------------------------------- */

typedef void EvalN(const Lobe *lobe, size_t n, const float *ox, const float *oy, const float *oz, const float *ix,
                   const float *iy, const float *iz, float *f, float *s);
EvalN lobe_eval_n_libm, lobe_eval_n_sse2, lobe_eval_n_avx2, lobe_eval_n_avx512;

typedef float Peak(size_t n);
Peak peak_fma_avx2, peak_any_avx2, peak_divide_avx2, peak_fma_avx512, peak_any_avx512, peak_divide_avx512;

typedef struct Column {
    const char *name, *section; /* section: where its loops are, for `objdump` */
    EvalN *eval_n;
    int lanes; /* of a vector, where peaks are known */
    Peak *fma, *any, *divide;
} Column;

enum { LIBM, SSE2, AVX2, AVX512, LIBRARY, COLUMNS };
static const Column columns[COLUMNS] = {
    [LIBM] = {.name = "libm", .eval_n = lobe_eval_n_libm},
    [SSE2] = {.name = "SSE2", .eval_n = lobe_eval_n_sse2},
    [AVX2] = {"AVX2", "arrays_avx2", lobe_eval_n_avx2, 8, peak_fma_avx2, peak_any_avx2, peak_divide_avx2},
    [AVX512] = {"AVX-512", "arrays_avx512", lobe_eval_n_avx512, 16, peak_fma_avx512, peak_any_avx512,
                peak_divide_avx512},
    [LIBRARY] = {.name = "library", .eval_n = lobe_eval_n}, /* the clone chosen at start-up */
};

static bool runs(int column) {
    if (column == AVX2) return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
    if (column == AVX512)
        return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
               __builtin_cpu_supports("avx512cd") && __builtin_cpu_supports("avx512dq") &&
               __builtin_cpu_supports("avx512vl");
    return true;
}

/* ---- time ---------------------------------------------------------------------------------------- */

enum { PAIRS = 1024, ERROR_PAIRS = 1 << 20 };

/* f comes first: were it after a direction's component by little more than 4 KiB, loads that run ahead would
 * wait for its stores, of which the core compares the last twelve bits. */
static struct { float f[PAIRS], ox[PAIRS], oy[PAIRS], oz[PAIRS], ix[PAIRS], iy[PAIRS], iz[PAIRS]; } block;

static float unit(uint64_t *state) { /* splitmix64 */
    uint64_t x = *state += 0x9e3779b97f4a7c15u;
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
    return unit_float((uint32_t)((x ^ (x >> 31)) >> 32));
}

/* Any direction of the upper hemisphere. */
static void random_direction(uint64_t *state, float *x, float *y, float *z) {
    double c = 1.0 - (double)unit(state), s = (sqrt)(1.0 - c * c);
    double phi = 6.283185307179586 * (double)unit(state);
    *x = (float)(s * (cos)(phi)), *y = (float)(s * (sin)(phi)), *z = (float)c;
}

static double time_eval(EvalN *eval_n, const Lobe *lobe, int times) {
    double start = clock_now();
    for (int k = 0; k < times; k++)
        eval_n(lobe, PAIRS, block.ox, block.oy, block.oz, block.ix, block.iy, block.iz, block.f, NULL);
    return (clock_now() - start) / times / PAIRS;
}

static double time_peak(Peak *peak, size_t n) {
    double start = clock_now();
    volatile float kept = peak(n);
    (void)kept;
    return (clock_now() - start) / (12.0 * (double)n);
}

static void keep_least(double *least, double value) { *least = value < *least ? value : *least; }

/* Seconds an evaluation, per column; and seconds an instruction, of the three peaks of a column. */
static void measure(const Lobe *lobe, int rounds, double best[COLUMNS]) {
    int times[COLUMNS];
    for (int c = 0; c < COLUMNS; c++) {
        if (!runs(c)) continue;
        time_eval(columns[c].eval_n, lobe, 1);
        best[c] = time_eval(columns[c].eval_n, lobe, 1);
        times[c] = 1 + (int)(100e-6 / (best[c] * PAIRS)); /* short, to fit between interruptions */
    }
    for (int r = 0; r < rounds; r++)
        for (int c = 0; c < COLUMNS; c++)
            if (runs(c)) keep_least(&best[c], time_eval(columns[c].eval_n, lobe, times[c]));
}

/* ---- what the loops are made of ------------------------------------------------------------------ */

typedef struct Loop {
    int multiply, divide, all; /* vector arithmetic: products, with or without a sum; quotients and roots; all */
} Loop;

typedef struct Instruction {
    unsigned long at, jump; /* jump: where to, if backwards; else 0 */
    bool multiply, divide, arithmetic;
} Instruction;

static bool begins(const char *text, const char *start) { return strncmp(text, start, strlen(start)) == 0; }

/* "  40a0:\tvmulps %ymm0,%ymm1,%ymm2" */
static Instruction instruction_of(const char *line) {
    Instruction in = {0};
    char *end, name[16] = "";
    in.at = strtoul(line, &end, 16);
    if (*end != ':' || sscanf(end + 1, " %15s", name) != 1) return in;
    const char *operands = strstr(end, name) + strlen(name), *what = name + (name[0] == 'v');
    if (name[0] == 'j') in.jump = strtoul(operands, NULL, 16);
    if (in.jump >= in.at) in.jump = 0;
    bool vector = strstr(operands, "%ymm") || strstr(operands, "%zmm");
    bool moves = begins(what, "mov") || begins(what, "broadcast") || begins(what, "pbroadcast");
    in.arithmetic = vector && !moves && strcmp(what, "zeroupper") != 0;
    in.multiply = in.arithmetic && (begins(what, "mul") || begins(what, "fm") || begins(what, "fnm"));
    in.divide = in.arithmetic && (begins(what, "div") || begins(what, "sqrt"));
    return in;
}

/* The loop of a function with the most vector arithmetic: from a jump backwards to where it leads. */
static Loop loop_of(const char *section, const char *function) {
    enum { MOST = 8192 };
    static Instruction code[MOST];
    char self[PATH_MAX], command[PATH_MAX + 128], line[512], symbol[128];
    Loop best = {0};
    ssize_t length = readlink("/proc/self/exe", self, sizeof self - 1);
    if (length < 0) return best;
    self[length] = 0;
    snprintf(command, sizeof command, "objdump -d --no-show-raw-insn -j %s '%s' 2>/dev/null", section, self);
    snprintf(symbol, sizeof symbol, "<%s", function);
    FILE *stream = popen(command, "r");
    if (!stream) return best;
    int count = 0;
    bool inside = false;
    while (fgets(line, sizeof line, stream)) {
        const char *named = strchr(line, '<');
        if (line[0] != ' ') inside = named && begins(named, symbol) && strchr(">.", named[strlen(symbol)]);
        if (!inside || line[0] != ' ' || count == MOST) continue;
        Instruction in = instruction_of(line);
        code[count++] = in;
        Loop loop = {0};
        for (int k = count - 1; in.jump && k >= 0 && code[k].at >= in.jump; k--) {
            loop.all += code[k].arithmetic;
            loop.multiply += code[k].multiply;
            loop.divide += code[k].divide;
            if (k < count - 1 && code[k].jump) loop.all = INT_MIN / 2; /* it has a loop inside */
        }
        if (loop.all > best.all) best = loop;
    }
    pclose(stream);
    return best;
}

static double larger(double a, double b) { return a > b ? a : b; }

/* One line: the rate of a column, and the limit from its instructions and from what the core can start of
 * each kind in a second. */
static void print_limit(const char *function, const Column *column, const Lobe *lobe, int rounds) {
    Loop loop = loop_of(column->section, function);
    if (!loop.all) {
        printf("  %-8s needs objdump (binutils)\n", column->name);
        return;
    }
    enum { N = 20000 };
    double eval = 1.0, fma = 1.0, any = 1.0, divide = 1.0;
    for (int r = 0; r < rounds; r++) {
        keep_least(&eval, time_eval(column->eval_n, lobe, 100));
        keep_least(&fma, time_peak(column->fma, N));
        keep_least(&any, time_peak(column->any, N));
        keep_least(&divide, time_peak(column->divide, N / 4));
    }
    double by_multiply = loop.multiply * fma, by_any = loop.all * any, by_divide = loop.divide * divide;
    double least = larger(by_multiply, larger(by_any, by_divide)), pass = eval * column->lanes;
    printf("  %-8s %5d %5d %5d %9.2f %8.2f %8.2f %10.0f %10.0f %6.0f %%\n", column->name, loop.all, loop.multiply,
           loop.divide, 1e-9 / any, 1e-9 / fma, 1e-9 / divide, 1e-6 / eval, 1e-6 * column->lanes / least,
           100.0 * least / pass);
}

/* ---- double precision ---------------------------------------------------------------------------- */

static double lerp(double a, double b, double t) { return a + (b - a) * t; }

/* The formulae of the papers as terms d_charlie, v_neubelt and v_conty_kulla cite them. */
static double conty_kulla_l_double(double alpha, double x) {
    double t = (1.0 - alpha) * (1.0 - alpha);
    double power = (pow)(x, lerp(0.19823, 0.16801, t));
    return lerp(21.5473, 25.3245, t) / (1.0 + lerp(3.82987, 3.32435, t) * power) + lerp(-1.97760, -1.27393, t) * x +
           lerp(-4.32054, -4.85967, t);
}

static double conty_kulla_lambda_double(double alpha, double x) {
    double l = conty_kulla_l_double(alpha, x < 0.5 ? x : 1.0 - x);
    return (exp)(x < 0.5 ? l : 2.0 * conty_kulla_l_double(alpha, 0.5) - l);
}

static double charlie_double(int id, double alpha, const double o[3], const double i[3]) {
    double x = o[0] + i[0], y = o[1] + i[1], z = o[2] + i[2];
    double sin2 = (x * x + y * y) / (x * x + y * y + z * z);
    double d = (2.0 + 1.0 / alpha) * (pow)(sin2, 0.5 / alpha) / 6.283185307179586;
    if (id == LOBE_CHARLIE_NEUBELT) return d / (4.0 * (o[2] + i[2] - o[2] * i[2]));
    double lambda = conty_kulla_lambda_double(alpha, o[2]) + conty_kulla_lambda_double(alpha, i[2]);
    return d / ((1.0 + lambda) * 4.0 * fmax(o[2] * i[2], 1e-7));
}

/* The largest relative error of each column. */
static void print_errors(const Lobe *lobe, float *f[7]) {
    printf("  %-22s %6.2f", weft_lobe_info(lobe->id)->id, (double)lobe->params[0]);
    for (int c = 0; c < COLUMNS; c++) {
        if (!runs(c)) {
            printf(" %9s", "-");
            continue;
        }
        columns[c].eval_n(lobe, ERROR_PAIRS, f[1], f[2], f[3], f[4], f[5], f[6], f[0], NULL);
        double worst = 0.0;
        for (int k = 0; k < ERROR_PAIRS; k++) {
            double o[3] = {(double)f[1][k], (double)f[2][k], (double)f[3][k]};
            double i[3] = {(double)f[4][k], (double)f[5][k], (double)f[6][k]};
            double exact = charlie_double(lobe->id, (double)lobe->params[0], o, i);
            worst = fmax(worst, fabs((double)f[0][k] / exact - 1.0));
        }
        printf(" %9.1e", worst);
    }
    printf("\n");
}

/* -------------------------------------------------------------------------------------------------- */

static const struct {
    int id;
    const char *function;
} named[] = {{LOBE_CHARLIE_NEUBELT, "charlie_neubelt_f_n"}, {LOBE_CHARLIE_CONTY_KULLA, "charlie_conty_kulla_f_n"}};
enum { NAMED_LOBES = sizeof named / sizeof named[0] };

int main(int argc, char **argv) {
    int rounds = argc > 1 && strcmp(argv[1], "--quick") == 0 ? 20 : 100;
    uint64_t state = 1;
    for (int k = 0; k < PAIRS; k++) {
        random_direction(&state, &block.ox[k], &block.oy[k], &block.oz[k]);
        random_direction(&state, &block.ix[k], &block.iy[k], &block.iz[k]);
    }

    printf("arrays: million evaluations a second of one core, then times that\n%-28s %8s", "lobe", columns[LIBM].name);
    for (int c = SSE2; c < COLUMNS; c++) printf(" %8s", columns[c].name);
    printf("\n");
    for (int id = 0; id < LOBE_COUNT; id++) {
        if (weft_lobe_info(id)->traits & TRAIT_REFERENCE) continue;
        Lobe lobe = lobe_default(id);
        double best[COLUMNS];
        measure(&lobe, rounds, best);
        printf("%-28s %8.1f", weft_lobe_info(id)->id, 1e-6 / best[LIBM]);
        for (int c = SSE2; c < COLUMNS; c++)
            if (runs(c))
                printf(" %8.2f", best[LIBM] / best[c]);
            else
                printf(" %8s", "-");
        printf("\n");
        fflush(stdout);
    }

    printf("\nlimit: instructions of the loop, G/s that the core can start of them, M evaluations/s\n"
           "  %-8s %5s %5s %5s %9s %8s %8s %10s %10s %8s\n",
           "", "all", "mul", "div", "all", "mul", "div", "reached", "limit", "near");
    for (int k = 0; k < NAMED_LOBES; k++) {
        printf("  %s\n", weft_lobe_info((int)named[k].id)->id);
        Lobe lobe = lobe_default((int)named[k].id);
        for (int c = AVX2; c <= AVX512; c++)
            if (runs(c)) print_limit(named[k].function, &columns[c], &lobe, rounds);
    }

    printf("\nlargest relative error against double, %d random pairs\n  %-22s %6s", (int)ERROR_PAIRS, "lobe", "alpha");
    for (int c = 0; c < COLUMNS; c++) printf(" %9s", columns[c].name);
    printf("\n");
    float *f[7];
    for (int k = 0; k < 7; k++)
        if (!(f[k] = malloc(ERROR_PAIRS * sizeof *f[k]))) return 4;
    for (int k = 0; k < ERROR_PAIRS; k++) {
        random_direction(&state, &f[1][k], &f[2][k], &f[3][k]);
        random_direction(&state, &f[4][k], &f[5][k], &f[6][k]);
    }
    static const float alphas[] = {0.15f, 0.3f, 0.6f, 1.0f};
    for (int k = 0; k < NAMED_LOBES; k++)
        for (int a = 0; a < 4; a++) {
            Lobe lobe = lobe_default((int)named[k].id);
            lobe.params[0] = alphas[a];
            print_errors(&lobe, f);
        }
    for (int k = 0; k < 7; k++) free(f[k]);
    return 0;
}
