#include "shading/engine_tables.h"

#include <pthread.h>

#include "base/thread.h"

enum { SIDE_MAX = 256, SHEEN_SAMPLES = 4096, GGX_SAMPLES = 1024, THREE_SAMPLES = 4096 };

/* Sums run side by side, so that compilers vectorise them, and each is short enough for floats. */
enum { LANES = 32 };

static double lanes_sum(const float lane[LANES]) {
    double sum = 0.0;
    for (int j = 0; j < LANES; j++) sum += (double)lane[j];
    return sum;
}

typedef struct EngineTable {
    int side, samples;
    bool sheen, shifted;
    float e[SIDE_MAX * SIDE_MAX];
} EngineTable;

static EngineTable tables[ENGINE_COUNT] = {
    [ENGINE_FILAMENT_SHEEN] = {.side = 128, .samples = SHEEN_SAMPLES, .sheen = true, .shifted = true},
    [ENGINE_FILAMENT_GGX] = {.side = 128, .samples = GGX_SAMPLES, .shifted = true},
    [ENGINE_BABYLON_SHEEN] = {.side = 256, .samples = SHEEN_SAMPLES, .sheen = true, .shifted = true},
    [ENGINE_BABYLON_GGX] = {.side = 256, .samples = GGX_SAMPLES, .shifted = true},
    [ENGINE_THREE_GGX] = {.side = 16, .samples = THREE_SAMPLES},
};

/* Point k of n in the unit square: k / n and the bits of k mirrored about the point. John M. Hammersley,
 * "Monte Carlo Methods for Solving Multivariable Problems", 1960. */
static void hammersley(int k, int n, float *u, float *v) {
    uint32_t bits = (uint32_t)k, mirrored = 0;
    for (int b = 0; b < 32; b++, bits >>= 1) mirrored = mirrored << 1 | (bits & 1u);
    *u = (float)k / (float)n;
    *v = (float)mirrored * 0x1p-32f;
}

static float row_alpha(const EngineTable *table, int row) {
    float t = ((float)row + (table->shifted ? 1.5f : 0.5f)) / (float)table->side;
    t = min(t, 1.0f);
    return t * t;
}

/* The two sums are over the same half vectors for all columns of a row: the uniform ones for the sheen are
 * even the same for all rows, so that its weights are a product of two matrices. */
static void fill_sheen_column(void *user, int column, int thread) {
    (void)thread;
    EngineTable *table = user;
    float o = ((float)column + 0.5f) / (float)table->side, sin_o = sqrt(1.0f - o * o);
    static const float scale = 8.0f * PI / SHEEN_SAMPLES;
    float w[SHEEN_SAMPLES], log_sin[SHEEN_SAMPLES];
    int n = 0;
    for (int k = 0; k < SHEEN_SAMPLES; k++) {
        float u, v;
        hammersley(k, SHEEN_SAMPLES, &u, &v);
        float cos_h = 1.0f - v, sin2 = v * (2.0f - v);
        float d = sin_o * sqrt(sin2) * cos(2.0f * PI * u) + o * cos_h, i = 2.0f * d * cos_h - o;
        if (!(i > 0.0f) || !(sin2 > 0.0f)) continue;
        log_sin[n] = 0.5f * log2(sin2);
        w[n++] = scale * i * d / (4.0f * (o + i - o * i));
    }
    while (n % LANES) log_sin[n] = 0.0f, w[n++] = 0.0f;
    for (int row = 0; row < table->side; row++) {
        float power = 1.0f / row_alpha(table, row), lane[LANES] = {0.0f};
        for (int from = 0; from < n; from += LANES)
            for (int j = 0; j < LANES; j++) lane[j] += w[from + j] * exp2(power * log_sin[from + j]);
        table->e[row * table->side + column] = (float)lanes_sum(lane) * (2.0f + power) / (2.0f * PI);
    }
}

static void fill_ggx_row(void *user, int row, int thread) {
    (void)thread;
    EngineTable *table = user;
    float alpha = row_alpha(table, row), a2 = alpha * alpha;
    float cos_h[THREE_SAMPLES] = {0.0f}, x[THREE_SAMPLES] = {0.0f};
    for (int k = 0; k < table->samples; k++) {
        float u, v;
        hammersley(k, table->samples, &u, &v);
        float slope = a2 * v / (1.0f - v), cos2 = 1.0f / (1.0f + slope);
        cos_h[k] = sqrt(cos2);
        x[k] = sqrt(slope * cos2) * cos(2.0f * PI * u);
    }
    for (int column = 0; column < table->side; column++) {
        float o = ((float)column + 0.5f) / (float)table->side, sin_o = sqrt(1.0f - o * o);
        float length_o = sqrt(o * o * (1.0f - a2) + a2), lane[LANES] = {0.0f};
        for (int from = 0; from < table->samples; from += LANES)
            for (int j = 0; j < LANES; j++) {
                float cos_k = cos_h[from + j], d = sin_o * x[from + j] + o * cos_k;
                float i = max(2.0f * d * cos_k - o, 0.0f);
                float v = 0.5f / (i * length_o + o * sqrt(i * i * (1.0f - a2) + a2));
                lane[j] += i * d * v / cos_k;
            }
        table->e[row * table->side + column] = 4.0f * (float)lanes_sum(lane) / (float)table->samples;
    }
}

static void make(int which) {
    EngineTable *table = &tables[which];
    parallel_for(0, table->side, table->sheen ? fill_sheen_column : fill_ggx_row, table);
}

/* pthread_once hands nothing to its function. */
#define MAKE(which)                                                                                          \
    static void make_##which(void) { make(which); }
MAKE(ENGINE_FILAMENT_SHEEN)
MAKE(ENGINE_FILAMENT_GGX)
MAKE(ENGINE_BABYLON_SHEEN)
MAKE(ENGINE_BABYLON_GGX)
MAKE(ENGINE_THREE_GGX)

TableRef engine_table(int which) {
    static pthread_once_t once[ENGINE_COUNT] = {PTHREAD_ONCE_INIT, PTHREAD_ONCE_INIT, PTHREAD_ONCE_INIT,
                                                PTHREAD_ONCE_INIT, PTHREAD_ONCE_INIT};
    static void (*const makers[ENGINE_COUNT])(void) = {
        [ENGINE_FILAMENT_SHEEN] = make_ENGINE_FILAMENT_SHEEN,
        [ENGINE_FILAMENT_GGX] = make_ENGINE_FILAMENT_GGX,
        [ENGINE_BABYLON_SHEEN] = make_ENGINE_BABYLON_SHEEN,
        [ENGINE_BABYLON_GGX] = make_ENGINE_BABYLON_GGX,
        [ENGINE_THREE_GGX] = make_ENGINE_THREE_GGX,
    };
    pthread_once(&once[which], makers[which]);
    const EngineTable *table = &tables[which];
    return (TableRef){.texels = table->e, .kind = TABLE_LINEAR, .rows = table->side, .columns = table->side};
}
