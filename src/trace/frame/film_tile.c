#include "trace/frame/film_tile.h"

/* Sums of some kind: `numbers` floats for each pixel of the film. */
typedef struct Plane {
    float *at;
    int numbers;
} Plane;

enum {
    PLANES_MOST = 8,
    CAUGHT_NUMBERS = (int)(sizeof(Caught) / sizeof(float)),
    MATTE_NUMBERS = 3 * MATTE_IDS, /* upper and lower half of an id, and its samples, which a float all holds */
    COUNT_MOST = 1 << 24           /* the largest whole number up to which a float holds each */
};

/* Lists the sums that a film has; returns their number. */
static int planes_of(const Film *film, Plane planes[PLANES_MOST]) {
    int count = 0;
    for (int h = 0; h < film->halves; h++) {
        planes[count++] = (Plane){film->half[h].sums, 4};
        if (film->half[h].caught) planes[count++] = (Plane){film->half[h].caught->behind, CAUGHT_NUMBERS};
        if (film->half[h].hits) planes[count++] = (Plane){film->half[h].hits, FIRST_NUMBERS};
    }
    if (film->slots) planes[count++] = (Plane){film->slots, 3 * LIT_SLOTS};
    if (film->places) planes[count++] = (Plane){film->places, PLACE_NUMBERS};
    return count;
}

int film_pixel_numbers(const Film *film) {
    Plane planes[PLANES_MOST];
    const int count = planes_of(film, planes);
    int numbers = film->matte[0] ? FILM_MATTES * MATTE_NUMBERS : 0;
    for (int k = 0; k < count; k++) numbers += planes[k].numbers;
    return numbers;
}

/* Returns the index in the film of pixel k of a tile; -1 of one beyond the picture. */
static ptrdiff_t pixel_of(const Film *film, int tile, int k) {
    const int x = tile % film->tiles_across * STREAM_TILE + k % STREAM_TILE;
    const int y = tile / film->tiles_across * STREAM_TILE + k / STREAM_TILE;
    return x < film->width && y < film->height ? (ptrdiff_t)y * film->width + x : -1;
}

static void matte_get(const Matte *matte, float *to) {
    for (int k = 0; k < MATTE_IDS; k++) {
        to[3 * k] = (float)(matte->id[k] >> 16);
        to[3 * k + 1] = (float)(matte->id[k] & 0xffffu);
        to[3 * k + 2] = (float)matte->samples[k];
    }
}

static void matte_set(Matte *matte, const float *from) {
    for (int k = 0; k < MATTE_IDS; k++) {
        matte->id[k] = (uint32_t)from[3 * k] << 16 | (uint32_t)from[3 * k + 1];
        matte->samples[k] = (uint32_t)from[3 * k + 2];
    }
}

void film_tile_get(const Film *film, int tile, long long non_finite, float *to) {
    Plane planes[PLANES_MOST];
    const int count = planes_of(film, planes), numbers = film_pixel_numbers(film);
    to[0] = (float)film->half[0].samples[tile];
    to[1] = film->halves > 1 ? (float)film->half[1].samples[tile] : 0.0f;
    to[2] = (float)(non_finite < COUNT_MOST ? non_finite : COUNT_MOST);
    to += FILM_TILE_HEAD;
    for (int k = 0; k < STREAM_TILE * STREAM_TILE; k++, to += numbers) {
        const ptrdiff_t pixel = pixel_of(film, tile, k);
        memset(to, 0, (size_t)numbers * sizeof *to);
        float *next = to;
        for (int p = 0; pixel >= 0 && p < count; next += planes[p++].numbers)
            memcpy(next, planes[p].at + pixel * planes[p].numbers, (size_t)planes[p].numbers * sizeof *to);
        for (int m = 0; pixel >= 0 && m < FILM_MATTES && film->matte[m]; m++, next += MATTE_NUMBERS)
            matte_get(&film->matte[m][pixel], next);
    }
}

static bool is_count(float number, int most) {
    return number >= 0.0f && number <= (float)most && !(number > (float)(int)number);
}

/* Returns true if all numbers of a tile may be set. */
static bool tile_good(const Film *film, const float *from) {
    const int numbers = film_pixel_numbers(film), mattes = film->matte[0] ? FILM_MATTES * MATTE_NUMBERS : 0;
    for (int k = 0; k < FILM_TILE_HEAD; k++)
        if (!is_count(from[k], COUNT_MOST)) return false;
    if (film->halves < 2 && from[1] > 0.0f) return false;
    from += FILM_TILE_HEAD;
    for (int k = 0; k < STREAM_TILE * STREAM_TILE; k++, from += numbers) {
        for (int n = 0; n < numbers; n++)
            if (!isfinite(from[n])) return false;
        for (int n = numbers - mattes; n < numbers; n++)
            if (!is_count(from[n], (n - numbers + mattes) % 3 < 2 ? 0xffff : COUNT_MOST)) return false;
    }
    return true;
}

bool film_tile_set(Film *film, int tile, const float *from, long long *non_finite) {
    Plane planes[PLANES_MOST];
    const int count = planes_of(film, planes), numbers = film_pixel_numbers(film);
    if (!tile_good(film, from)) return false;
    film->half[0].samples[tile] = (int)from[0];
    if (film->halves > 1) film->half[1].samples[tile] = (int)from[1];
    *non_finite = (long long)from[2];
    from += FILM_TILE_HEAD;
    for (int k = 0; k < STREAM_TILE * STREAM_TILE; k++, from += numbers) {
        const ptrdiff_t pixel = pixel_of(film, tile, k);
        const float *next = from;
        for (int p = 0; pixel >= 0 && p < count; next += planes[p++].numbers)
            memcpy(planes[p].at + pixel * planes[p].numbers, next, (size_t)planes[p].numbers * sizeof *from);
        for (int m = 0; pixel >= 0 && m < FILM_MATTES && film->matte[m]; m++, next += MATTE_NUMBERS)
            matte_set(&film->matte[m][pixel], next);
    }
    return true;
}
