/* python - the time of weft_eval_n for pairs of a lobe, in a program in C
 *
 *   bench_python COUNT
 *
 * Reads ids of lobes, one a line, and answers each with the seconds of the fastest of some runs over COUNT pairs.
 * bench/python.py asks it in turn with its own calls. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/steady_clock.h"
#include "weft/arrays.h"

static float unit(void) { return (float)(rand() % (1 << 20)) / (float)(1 << 20); }

/* Fills x, y and z with directions above the horizon. */
static void fill_directions(float *rows[3], int count) {
    for (int k = 0; k < count; k++) {
        float z = 1.0f - unit(), s = sqrtf(1.0f - z * z), phi = 6.2831853f * unit();
        rows[0][k] = s * cosf(phi);
        rows[1][k] = s * sinf(phi);
        rows[2][k] = z;
    }
}

int main(int argc, char **argv) {
    enum { ROWS = 9, RUNS = 10 };
    const int count = argc == 2 ? atoi(argv[1]) : 0;
    if (count < 1) return 2;
    float *rows[ROWS];
    for (int k = 0; k < ROWS; k++)
        if (!(rows[k] = malloc((size_t)count * sizeof *rows[k]))) return 4;
    fill_directions(rows, count);
    fill_directions(rows + 3, count);
    const WeftDirections wo = {rows[0], rows[1], rows[2]}, wi = {rows[3], rows[4], rows[5]};
    const WeftColors f = {rows[6], rows[7], rows[8]};
    char id[128];
    while (fgets(id, sizeof id, stdin)) {
        WeftLobe lobe;
        id[strcspn(id, "\n")] = '\0';
        if (weft_lobe_init(id, &lobe, NULL) != WEFT_OK) return 2;
        double best = HUGE_VAL;
        for (int k = 0; k < RUNS; k++) {
            const double start = clock_now();
            weft_eval_n(&lobe, (size_t)count, wo, wi, f, NULL);
            best = fmin(best, clock_now() - start);
        }
        printf("%.9g\n", best);
        fflush(stdout);
    }
    for (int k = 0; k < ROWS; k++) free(rows[k]);
    return 0;
}
