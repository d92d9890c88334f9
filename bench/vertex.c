/* vertex - prints what a vertex of a path costs: its stack made, its value for a light, a sample, the value
 * of that; ratios to the first module in one run, and how far values are from that one's
 *
 *   bench_vertex MODULE...
 *
 * A module is the libvertex_run.so of a build: the first of an older one, or the only one. Each figure is the
 * least of many short rounds, in which all modules take turns, so that load and clock fall on all alike. */
#define _POSIX_C_SOURCE 200809L
#include <dlfcn.h>
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

#include "base/steady_clock.h"
#include "vertex.h"

enum { MODULES_MAX = 4, ROUNDS = 2000 };

static float draw(uint32_t *state) {
    *state = *state * 1664525u + 1013904223u;
    return ((float)(*state >> 8) + 0.5f) / 16777216.0f;
}

static void direction(uint32_t *state, float w[3][VERTEX_COUNT], int k) {
    float z = 0.02f + 0.98f * draw(state), phi = 6.2831853f * draw(state), r = sqrtf(1.0f - z * z);
    w[0][k] = r * cosf(phi), w[1][k] = r * sinf(phi), w[2][k] = z;
}

static void fill(VertexArrays *a) {
    uint32_t state = 1;
    for (int k = 0; k < VERTEX_COUNT; k++) {
        direction(&state, a->o, k);
        direction(&state, a->light, k);
        a->u[k] = draw(&state), a->v[k] = draw(&state);
        for (int c = 0; c < 3; c++) a->base[c][k] = draw(&state), a->sheen[c][k] = draw(&state);
        a->roughness[k] = 0.2f + 0.8f * draw(&state), a->sheen_roughness[k] = 0.2f + 0.8f * draw(&state);
    }
}

/* The greatest relative difference among values for the light. */
static double difference(const VertexArrays *a, const VertexArrays *b) {
    double worst = 0.0;
    for (int c = 0; c < 4; c++)
        for (int k = 0; k < VERTEX_COUNT; k++) {
            double x = (double)a->out[c][k], y = (double)b->out[c][k];
            worst = fmax(worst, fabs(x - y) / fmax(fabs(x), 1e-3));
        }
    return worst;
}

int main(int argc, char **argv) {
    static VertexArrays first, a;
    VertexRun *run[2 * MODULES_MAX];
    const char *name[2 * MODULES_MAX];
    double best[2 * MODULES_MAX][VERTEX_MATERIALS][2];
    int count = 0;
    if (argc < 2 || argc > 1 + MODULES_MAX) {
        fputs("bench_vertex MODULE... (up to 4)\n", stderr);
        return 2;
    }
    for (int m = 1; m < argc; m++) {
        void *module = dlopen(argv[m], RTLD_NOW | RTLD_LOCAL);
        for (int kind = 0; kind < 2; kind++) {
            void *symbol = module ? dlsym(module, kind ? "vertex_run_kind" : "vertex_run") : NULL;
            if (!symbol && kind) break; /* an older build has none */
            if (!symbol) {
                fprintf(stderr, "bench_vertex: %s\n", dlerror());
                return 1;
            }
            *(void **)&run[count] = symbol;
            name[count] = kind ? "its kind" : argv[m];
            for (int k = 0; k < 2 * VERTEX_MATERIALS; k++) best[count][k / 2][k % 2] = 1e30;
            count++;
        }
    }
    fill(&first), fill(&a);
    for (int round = 0; round < ROUNDS; round++)
        for (int k = 0; k < 2 * VERTEX_MATERIALS; k++)
            for (int m = 0; m < count; m++) {
                double start = clock_now();
                run[m](&a, k / 2, k % 2);
                best[m][k / 2][k % 2] = fmin(best[m][k / 2][k % 2], clock_now() - start);
            }
    puts("ns a vertex, ratio to the first, difference of values");
    for (int k = 0; k < 2 * VERTEX_MATERIALS; k++)
        for (int m = 0; m < count; m++) {
            run[0](&first, k / 2, k % 2);
            run[m](&a, k / 2, k % 2);
            printf("%-6s %-14s %8.1f %6.3f %8.1e  %s\n", k / 2 ? "floor" : "cloth",
                   k % 2 ? "made once" : "made each time", 1e9 * best[m][k / 2][k % 2] / VERTEX_COUNT,
                   best[m][k / 2][k % 2] / best[0][k / 2][k % 2], difference(&first, &a), name[m]);
        }
    return 0;
}
