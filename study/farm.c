/* study_farm - the time of a picture by many ranks of weft-mpi, from the times of one and of two
 *
 *   study_farm ONE TWO [TILES]
 *
 * ONE and TWO are the seconds that `mpirun -n 1` and `-n 2` of weft-mpi say for the samples of a picture of TILES tiles (300:
 * 320 x 240) with one thread each. A rank asks, waits until the leader looks (on average half of what the leader's thread
 * needs for 16 samples of a tile), and renders its block; the leader answers one message after another. What a message
 * costs is found so that the time of two ranks is TWO. The model then has a film picture of 1920 x 1080 pixels and 4,096
 * samples by ranks of 1 and of 64 threads, as they begin (start, scene, tree and tables: 3 s) and as rank 0 writes (1 s). */
#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

#include "base/pi.h"

enum { SHARES = 3, BLOCK = 16 }; /* as src/mpi/deal.c and weft/render.h have them */

typedef struct Farm {
    int ranks, threads, tiles;
    double tile;    /* s of a thread, mean */
    double spread;  /* of tiles, standard deviation of the logarithm */
    double message; /* s of the leader for one */
    int samples;
} Farm;

/* Returns a number in (0, 1) of a tile. */
static double uniform(uint32_t tile, uint32_t kind) {
    uint32_t x = tile * 2654435761u + kind * 2246822519u;
    x = (x ^ x >> 15) * 2246822519u;
    x = (x ^ x >> 13) * 3266489917u;
    return ((double)(x ^ x >> 16) + 0.5) / 4294967296.0;
}

/* Returns the cost of a tile, whose logarithm is normal: what shows cloth takes longer than what shows none. */
static double tile_cost(const Farm *farm, int tile) {
    const double z = sqrt(-2.0 * log(uniform((uint32_t)tile, 1u))) * cos(2.0 * PI_DOUBLE * uniform((uint32_t)tile, 2u));
    return farm->tile * exp(farm->spread * z - 0.5 * farm->spread * farm->spread);
}

/* Returns the time that a rank needs for tiles one after another from `first` on. */
static double block_time(const Farm *farm, int first, int count) {
    double sum = 0.0, longest = 0.0;
    for (int k = first; k < first + count; k++) {
        const double cost = tile_cost(farm, k);
        sum += cost, longest = fmax(longest, cost);
    }
    return fmax(longest, sum / farm->threads);
}

/* A heap of ranks by the time at which they are free. */
static void sink(double *heap, int count, int at) {
    for (;;) {
        int least = at;
        for (int k = 2 * at + 1; k <= 2 * at + 2; k++)
            if (k < count && heap[k] < heap[least]) least = k;
        if (least == at) return;
        const double other = heap[at];
        heap[at] = heap[least], heap[least] = other, at = least;
    }
}

/* Returns the seconds until the leader has all tiles. */
static double gather_time(const Farm *farm) {
    double *heap = calloc((size_t)farm->ranks, sizeof *heap), leader = 0.0, last = 0.0;
    if (!heap) return 0.0;
    const double look = farm->ranks > 1 ? 0.5 * farm->tile * BLOCK / farm->samples : 0.0;
    for (int dealt = 0; dealt < farm->tiles;) {
        const int rest = farm->tiles - dealt;
        int count = rest / (farm->ranks * SHARES);
        if (count < farm->threads) count = farm->threads;
        if (count > rest) count = rest;
        leader = fmax(leader, heap[0] + look) + (farm->ranks > 1 ? farm->message : 0.0);
        heap[0] = leader + block_time(farm, dealt, count);
        last = fmax(last, heap[0]);
        sink(heap, farm->ranks, 0);
        dealt += count;
    }
    free(heap);
    return fmax(last, leader);
}

/* Finds the cost of a message by which two ranks take `two` seconds. */
static void message_fit(Farm *farm, double two) {
    double low = 0.0, high = 1.0;
    farm->ranks = 2;
    for (int k = 0; k < 60; k++) {
        farm->message = 0.5 * (low + high);
        if (gather_time(farm) < two)
            low = farm->message;
        else
            high = farm->message;
    }
}

int main(int count, char **arguments) {
    double numbers[3] = {0.0, 0.0, 300.0}; /* one, two, tiles */
    bool good = count > 2 && count < 5;
    for (int k = 0; good && k < count - 1; k++) {
        char *end;
        numbers[k] = strtod(arguments[1 + k], &end);
        good = end != arguments[1 + k] && !*end && numbers[k] > 0.0 && numbers[k] < 1e6;
    }
    if (!good) {
        fprintf(stderr, "study_farm ONE TWO [TILES]\n");
        return 2;
    }
    Farm farm = {
        .ranks = 1, .threads = 1, .tiles = (int)fmax(numbers[2], 1.0), .spread = 0.5, .samples = 256, .tile = 1.0};
    farm.tile = numbers[0] / gather_time(&farm);
    message_fit(&farm, numbers[1]);
    printf("tile of 256 samples %.4g s, message %.3g s; two ranks %.3f times as fast as one\n", farm.tile, farm.message,
           numbers[0] / gather_time(&farm));
    farm.tile *= 4096.0 / 256.0, farm.samples = 4096, farm.tiles = 120 * 68;
    printf("\n1920 x 1080, 4,096 samples: seconds, and speed over that of one thread as a share of all threads\n\n"
           "| ranks | of 1 thread | share | of 64 threads | share |\n|---|---|---|---|---|\n");
    farm.ranks = farm.threads = 1;
    const double alone = 4.0 + gather_time(&farm);
    for (int ranks = 1; ranks <= 10000; ranks *= 10) {
        double seconds[2];
        for (int k = 0; k < 2; k++) {
            farm.ranks = ranks, farm.threads = k ? 64 : 1;
            seconds[k] = 4.0 + gather_time(&farm);
        }
        printf("| %d | %.0f | %.2f | %.0f | %.2f |\n", ranks, seconds[0], alone / seconds[0] / ranks, seconds[1],
               alone / seconds[1] / ranks / 64.0);
    }
    return 0;
}
