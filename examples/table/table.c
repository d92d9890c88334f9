/* A tool of one's own: a table of directional albedo E, cos_o to the right and alpha downwards, by all
 * processors.
 *
 *     table LOBE OUT.exr|OUT.npy [SIZE]
 *
 * Each row is one call for many cosines. Calls of the library may be made from any number of threads: here
 * each takes the next row until there is none. What is printed is the mean of each row over the hemisphere, 2
 * integral of E cos_o dcos_o, by which engines give back what bounced more than once. */
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <threads.h>

#include <weft/weft.h>

enum { THREADS = 16 };

typedef struct Work {
    WeftLobe lobe;
    WeftImage table; /* F32, one channel */
    float *cosines;
    atomic_int next, failures; /* rows */
} Work;

static float centre(int k, int count) { return ((float)k + 0.5f) / (float)count; }

static float *row(const Work *work, int y) {
    return (float *)work->table.pixels + (size_t)y * (size_t)work->table.width;
}

static int rows_fill(void *data) {
    Work *work = data;
    for (int y; (y = atomic_fetch_add(&work->next, 1)) < work->table.height;) {
        WeftLobe lobe = work->lobe; /* plain data: each row has its own */
        lobe.params[0] = centre(y, work->table.height);
        if (weft_albedo_n(&lobe, (size_t)work->table.width, work->cosines, (WeftColors){.r = row(work, y)}, NULL) !=
            WEFT_OK)
            atomic_fetch_add(&work->failures, 1);
    }
    return 0;
}

static void fill(Work *work) {
    thrd_t threads[THREADS];
    int started = 0;
    while (started < THREADS && thrd_create(&threads[started], rows_fill, work) == thrd_success) started++;
    rows_fill(work);
    while (started > 0) thrd_join(threads[--started], NULL);
}

static void print_means(const Work *work) {
    for (int y = 0; y < work->table.height; y++) {
        double sum = 0;
        for (int x = 0; x < work->table.width; x++) sum += 2 * (double)row(work, y)[x] * (double)work->cosines[x];
        printf("alpha %.4f  mean %.4f\n", (double)centre(y, work->table.height), sum / work->table.width);
    }
}

static WeftResult table_make(Work *work, const char *path, int size, WeftError *error) {
    WeftResult result = weft_image_create(size, size, 1, WEFT_PIXEL_F32, &work->table, error);
    if (result != WEFT_OK) return result;
    for (int x = 0; x < size; x++) work->cosines[x] = centre(x, size);
    fill(work);
    if (work->failures) return WEFT_RESOURCES;
    print_means(work);
    return weft_image_write_as(path, &work->table, &(WeftImageWriting){.data = 1, .single = 1}, error);
}

int main(int count, char **arguments) {
    int size = count > 3 ? atoi(arguments[3]) : 32;
    if (count < 3 || size < 1 || size > 1024) {
        fprintf(stderr, "table LOBE OUT.exr|OUT.npy [SIZE, 1 to 1024]\n");
        return WEFT_USAGE;
    }
    WeftError error = {0};
    Work work = {.cosines = malloc((size_t)size * sizeof(float))};
    WeftResult result = work.cosines ? weft_lobe_init(arguments[1], &work.lobe, &error) : WEFT_RESOURCES;
    if (result == WEFT_OK) result = table_make(&work, arguments[2], size, &error);
    if (result != WEFT_OK) fprintf(stderr, "table: %s\n", error.text[0] ? error.text : "out of memory");
    weft_image_free(&work.table);
    free(work.cosines);
    return (int)result;
}
