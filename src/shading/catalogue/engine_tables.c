#include "shading/catalogue/engine_tables.h"

#include <pthread.h>
#include <stdatomic.h>

#include "base/thread.h"

enum { SIDE_MAX = 256, POINTS_MAX = 4096 };

/* Sums run side by side, so that compilers vectorise them, and each is short enough for floats. */
enum { LANES = 32 };

static double lanes_sum(const float lane[LANES]) {
    double sum = 0.0;
    for (int j = 0; j < LANES; j++) sum += (double)lane[j];
    return sum;
}

typedef struct EngineTable {
    int side, points;
    bool sheen, shifted;
    pthread_mutex_t making;
    atomic_bool made;
    float e[SIDE_MAX * SIDE_MAX];
} EngineTable;

#define ENGINE_TABLE_ROW(NAME, name, side, points, sheen, shifted)                                                     \
    {side, points, sheen, shifted, PTHREAD_MUTEX_INITIALIZER, false, {0.0f}},
static EngineTable tables[ENGINE_COUNT] = {ENGINE_TABLES(ENGINE_TABLE_ROW)};

/* Fills u and v with point k of n in the unit square: k / n and the bits of k mirrored about the binary point. John M.
 * Hammersley, "Monte Carlo Methods for Solving Multivariable Problems", 1960. */
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

/* Fills a column of the sheen. All columns of a row share the half vectors of both sums; all rows share the uniform
 * ones too, so their weights are a product of two matrices. */
static void fill_sheen_column(void *user, int column, int thread) {
    (void)thread;
    EngineTable *table = user;
    float o = ((float)column + 0.5f) / (float)table->side, sin_o = sqrt(1.0f - o * o);
    const float scale = 8.0f * PI / (float)table->points;
    float w[POINTS_MAX], log_sin[POINTS_MAX];
    int n = 0;
    for (int k = 0; k < table->points; k++) {
        float u, v;
        hammersley(k, table->points, &u, &v);
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
    float cos_h[POINTS_MAX] = {0.0f}, x[POINTS_MAX] = {0.0f};
    for (int k = 0; k < table->points; k++) {
        float u, v;
        hammersley(k, table->points, &u, &v);
        float slope = a2 * v / (1.0f - v), cos2 = 1.0f / (1.0f + slope);
        cos_h[k] = sqrt(cos2);
        x[k] = sqrt(slope * cos2) * cos(2.0f * PI * u);
    }
    for (int column = 0; column < table->side; column++) {
        float o = ((float)column + 0.5f) / (float)table->side, sin_o = sqrt(1.0f - o * o);
        float length_o = sqrt(o * o * (1.0f - a2) + a2), lane[LANES] = {0.0f};
        for (int from = 0; from < table->points; from += LANES)
            for (int j = 0; j < LANES; j++) {
                float cos_k = cos_h[from + j], d = sin_o * x[from + j] + o * cos_k;
                float i = max(2.0f * d * cos_k - o, 0.0f);
                float v = 0.5f / (i * length_o + o * sqrt(i * i * (1.0f - a2) + a2));
                lane[j] += i * d * v / cos_k;
            }
        table->e[row * table->side + column] = 4.0f * (float)lanes_sum(lane) / (float)table->points;
    }
}

TableRef engine_table(int which) {
    EngineTable *table = &tables[which];
    if (!atomic_load(&table->made)) { /* read at every hit, so without the lock */
        pthread_mutex_lock(&table->making);
        if (!atomic_load(&table->made))
            parallel_for(0, table->side, table->sheen ? fill_sheen_column : fill_ggx_row, table);
        atomic_store(&table->made, true);
        pthread_mutex_unlock(&table->making);
    }
    return (TableRef){.texels = table->e, .kind = TABLE_LINEAR, .rows = table->side, .columns = table->side};
}
