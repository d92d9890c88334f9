#include <stdlib.h> /* before the dialect, whose abs() shadows its own */

#include "trace/frame/film.h"

#include "base/fail.h"
#include "image/difference.h"

bool film_create(Film *film, int width, int height, FilmRecords records) {
    *film = (Film){.width = width, .height = height, .halves = records.halves ? 2 : 1, .hits = records.hits};
    film->tiles_across = (width + STREAM_TILE - 1) / STREAM_TILE;
    film->tile_count = film->tiles_across * ((height + STREAM_TILE - 1) / STREAM_TILE);
    size_t pixels = (size_t)width * (size_t)height;
    bool made = true;
    for (int h = 0; h < film->halves; h++) {
        FilmHalf *half = &film->half[h];
        half->samples = alloc_array((size_t)film->tile_count, sizeof(int));
        half->sums = alloc_array(pixels, 4 * sizeof(float));
        half->caught = records.floor ? alloc_array(pixels, sizeof(Caught)) : NULL;
        half->hits = records.hits ? alloc_array(pixels, FIRST_NUMBERS * sizeof(float)) : NULL;
        made &= half->samples && half->sums && !half->caught == !records.floor && !half->hits == !records.hits;
    }
    film->places = records.places ? alloc_array(pixels, PLACE_NUMBERS * sizeof(float)) : NULL;
    for (int m = 0; m < FILM_MATTES; m++) {
        film->matte[m] = records.mattes ? alloc_array(pixels, sizeof(Matte)) : NULL;
        made &= !film->matte[m] == !records.mattes;
    }
    film->slots = records.slots ? alloc_array(pixels, LIT_SLOTS * 3 * sizeof(float)) : NULL;
    return made && !film->places == !records.places && !film->slots == !records.slots;
}

void film_free(Film *film) {
    for (int h = 0; h < 2; h++) {
        free(film->half[h].samples);
        free(film->half[h].sums);
        free(film->half[h].caught);
        free(film->half[h].hits);
    }
    for (int m = 0; m < FILM_MATTES; m++) free(film->matte[m]);
    free(film->places);
    free(film->slots);
    *film = (Film){0};
}

static bool finite(const float c[4]) {
    float sum = c[0] + c[1] + c[2];
    return sum < INFINITY && sum > -INFINITY;
}

/* Adds where the samples of a pixel are, and what they show. */
static void add_places(Film *film, size_t pixel, const FirstHits *first, int first_id, int count) {
    for (int a = 0; film->places && a < PLACE_NUMBERS; a++)
        for (int id = first_id; id < first_id + count; id++)
            film->places[PLACE_NUMBERS * pixel + (size_t)a] += first->place[a][id];
    for (int m = 0; m < FILM_MATTES && film->matte[m]; m++)
        for (int id = first_id; id < first_id + count; id++)
            if (first->mesh[id] != GEOMETRY_NOTHING) matte_add(&film->matte[m][pixel], film->names[m][first->mesh[id]]);
}

/* Adds the light of a sample by slots. */
static void add_slots(float *sum, const LightBySlot *light, int id) {
    for (int slot = 0; slot < LIT_SLOTS; slot++)
        for (int c = 0; c < 3; c++) sum[3 * slot + c] += light->direct[slot][c][id];
}

int film_add(Film *film, int half, size_t pixel, const Stream *stream, int first_id, int count) {
    FilmHalf *to = &film->half[half];
    float *sum = to->sums + 4 * pixel;
    int non_finite = 0;
    for (int id = first_id; id < first_id + count; id++) {
        float c[4] = {stream->radiance.rgba[0][id], stream->radiance.rgba[1][id], stream->radiance.rgba[2][id],
                      stream->radiance.rgba[3][id]};
        const bool counts = finite(c);
        if (!counts) {
            non_finite++;
            c[0] = c[1] = c[2] = 0.0f;
        }
        if (film->slots && counts) add_slots(film->slots + 3 * LIT_SLOTS * pixel, stream->slots, id);
        for (int a = 0; a < 4; a++) sum[a] += c[a];
    }
    for (int a = 0; to->hits && a < FIRST_NUMBERS; a++)
        for (int id = first_id; id < first_id + count; id++)
            to->hits[FIRST_NUMBERS * pixel + (size_t)a] += stream->first->number[a][id];
    if (film->places || film->matte[0]) add_places(film, pixel, stream->first, first_id, count);
    return non_finite;
}

static size_t pixel_at(const Film *film, int x, int y) { return (size_t)y * (size_t)film->width + (size_t)x; }

/* Returns how many samples a pixel has in one half or FILM_BOTH. */
static int samples_at(const Film *film, int half, int x, int y) {
    int tile = y / STREAM_TILE * film->tiles_across + x / STREAM_TILE;
    if (half != FILM_BOTH) return film->half[half].samples[tile];
    return film->half[0].samples[tile] + (film->halves > 1 ? film->half[1].samples[tile] : 0);
}

static void add_caught(Caught *sum, const Caught *of) {
    for (int c = 0; c < 3; c++) sum->behind[c] += of->behind[c];
    sum->clear += of->clear, sum->whole += of->whole, sum->reached += of->reached;
}

/* Adds up a pixel's samples, and applies the floor's shadow; returns how many samples there are. */
static int pixel_sum(const Film *film, int half, int x, int y, float rgba[4]) {
    size_t pixel = pixel_at(film, x, y);
    Caught caught = {0};
    for (int c = 0; c < 4; c++) rgba[c] = 0.0f;
    for (int h = 0; h < film->halves; h++) {
        if (half != FILM_BOTH && h != half) continue;
        for (int c = 0; c < 4; c++) rgba[c] += film->half[h].sums[4 * pixel + (size_t)c];
        if (film->half[h].caught) add_caught(&caught, &film->half[h].caught[pixel]);
    }
    if (film->half[0].caught) catcher_resolve(&caught, rgba);
    return samples_at(film, half, x, y);
}

int film_pixel(const Film *film, int half, int x, int y, float rgba[4]) {
    int n = pixel_sum(film, half, x, y, rgba);
    for (int c = 0; n && c < 4; c++) rgba[c] /= (float)n;
    return n;
}

int film_hits(const Film *film, int half, int x, int y, float numbers[FIRST_NUMBERS]) {
    int n = samples_at(film, half, x, y);
    for (int a = 0; a < FIRST_NUMBERS; a++) numbers[a] = 0.0f;
    for (int h = 0; n && h < film->halves; h++) {
        if (half != FILM_BOTH && h != half) continue;
        const float *sums = film->half[h].hits + FIRST_NUMBERS * pixel_at(film, x, y);
        for (int a = 0; a < FIRST_NUMBERS; a++) numbers[a] += sums[a] / (float)n;
    }
    return n;
}

void film_matte(const Film *film, int matte, int pair, int x, int y, float rgba[4]) {
    float ranks[2 * MATTE_RANKS] = {0};
    const int samples = samples_at(film, FILM_BOTH, x, y);
    if (samples) matte_rank(&film->matte[matte][pixel_at(film, x, y)], samples, ranks);
    memcpy(rgba, ranks + 4 * pair, 4 * sizeof(float));
}

WeftResult film_image(const Film *film, WeftImage *out, WeftError *error) {
    WeftResult result = weft_image_create(film->width, film->height, 4, WEFT_PIXEL_F32, out, error);
    if (result != WEFT_OK) return result;
    float *pixel = out->pixels;
    for (int y = 0; y < film->height; y++)
        for (int x = 0; x < film->width; x++, pixel += 4) {
            float sum[4];
            int samples = pixel_sum(film, FILM_BOTH, x, y, sum);
            if (!samples || !(sum[3] > 0.0f)) continue;
            for (int c = 0; c < 3; c++) pixel[c] = sum[c] / sum[3]; /* straight alpha */
            pixel[3] = sum[3] / (float)samples;
        }
    return WEFT_OK;
}

/* Estimates the variance of a pixel's mean from the halves; 0 with only one. */
static void pixel_variance(const Film *film, int x, int y, float variance[3]) {
    float a[4], b[4];
    float n = (float)film_pixel(film, 0, x, y, a), m = (float)film_pixel(film, 1, x, y, b);
    for (int c = 0; c < 3; c++) {
        float difference = a[c] - b[c];
        variance[c] = n * m > 0.0f ? difference * difference * (n / (n + m)) * (m / (n + m)) : 0.0f;
    }
}

double film_noise(const Film *film) {
    double sum = 0.0;
    if (film->halves < 2) return -1.0;
    for (int y = 0; y < film->height; y++)
        for (int x = 0; x < film->width; x++) {
            float variance[3], mean[4];
            if (!samples_at(film, 0, x, y) || !samples_at(film, 1, x, y)) return -1.0;
            film_pixel(film, FILM_BOTH, x, y, mean);
            pixel_variance(film, x, y, variance);
            for (int c = 0; c < 3; c++) sum += relative_square(mean[c] + sqrtf(variance[c]), mean[c]);
        }
    return sum / (3.0 * film->width * film->height);
}

static const struct {
    const char *name;
    int channels;
} aovs[WEFT_AOV_COUNT] = {{"albedo", 3},   {"normal", 3}, {"depth", 1},  {"variance", 3}, {"samples", 1},
                          {"position", 3}, {"uv", 2},     {"object", 4}, {"material", 4}, {"diffuse", 3},
                          {"specular", 3}, {"sheen", 3},  {"coat", 3},   {"dust", 3},     {"other", 3}};

const char *weft_aov_name(int aov) { return aov >= 0 && aov < WEFT_AOV_COUNT ? aovs[aov].name : NULL; }

/* The depth if nothing is hit, which compositing programs treat as the background. */
static const float nowhere = 1e10f;

/* Gives means over the samples that hit a surface, which are the part `seen` of all. */
static void mean_place(const Film *film, int x, int y, float seen, int from, int count, float *to) {
    const float *sums = film->places + PLACE_NUMBERS * pixel_at(film, x, y) + from;
    const float hits = seen * (float)samples_at(film, FILM_BOTH, x, y);
    for (int a = 0; a < count; a++) to[a] = hits > 0.0f ? sums[a] / hits : 0.0f;
}

/* Gives the light of a slot, or of LIT_SLOTS what the slots leave of the picture. */
static void slot_pixel(const Film *film, int slot, int x, int y, float to[3]) {
    const float *sums = film->slots + 3 * LIT_SLOTS * pixel_at(film, x, y);
    float rgba[4];
    const int n = film_pixel(film, FILM_BOTH, x, y, rgba);
    for (int c = 0; c < 3; c++) {
        float all = 0.0f;
        for (int k = 0; k < LIT_SLOTS; k++) all += n ? sums[3 * k + c] / (float)n : 0.0f;
        to[c] = slot == LIT_SLOTS ? rgba[c] - all : n ? sums[3 * slot + c] / (float)n : 0.0f;
    }
}

static void aov_pixel(const Film *film, WeftAov aov, int x, int y, float *to) {
    float hits[FIRST_NUMBERS] = {0};
    if (film->hits) film_hits(film, FILM_BOTH, x, y, hits);
    switch (aov) {
    case WEFT_AOV_ALBEDO:
        for (int c = 0; c < 3; c++) to[c] = hits[FIRST_ALBEDO + c];
        break;
    case WEFT_AOV_NORMAL:
        for (int c = 0; c < 3; c++) to[c] = hits[FIRST_NORMAL + c];
        break;
    case WEFT_AOV_DEPTH: *to = hits[FIRST_SEEN] > 0.0f ? hits[FIRST_DEPTH] / hits[FIRST_SEEN] : nowhere; break;
    case WEFT_AOV_VARIANCE: pixel_variance(film, x, y, to); break;
    case WEFT_AOV_POSITION: mean_place(film, x, y, hits[FIRST_SEEN], PLACE_POSITION, 3, to); break;
    case WEFT_AOV_UV: mean_place(film, x, y, hits[FIRST_SEEN], PLACE_UV, 2, to); break;
    case WEFT_AOV_OBJECT: film_matte(film, FILM_OBJECTS, 0, x, y, to); break;
    case WEFT_AOV_MATERIAL: film_matte(film, FILM_MATERIALS, 0, x, y, to); break;
    case WEFT_AOV_DIFFUSE:
    case WEFT_AOV_SPECULAR:
    case WEFT_AOV_SHEEN:
    case WEFT_AOV_COAT:
    case WEFT_AOV_DUST:
    case WEFT_AOV_OTHER: slot_pixel(film, (int)aov - WEFT_AOV_DIFFUSE, x, y, to); break;
    default: *to = (float)samples_at(film, FILM_BOTH, x, y);
    }
}

WeftResult film_aov(const Film *film, WeftAov aov, WeftImage *out, WeftError *error) {
    *out = (WeftImage){0};
    if ((unsigned)aov >= WEFT_AOV_COUNT) return fail(error, WEFT_MESSAGE_DESC, "aov", "%d", (int)aov);
    if (aov <= WEFT_AOV_DEPTH && !film->hits)
        return fail(error, WEFT_MESSAGE_DESC, aovs[aov].name, "it was not gathered (first_hits)");
    if ((aov == WEFT_AOV_POSITION || aov == WEFT_AOV_UV) && !film->places)
        return fail(error, WEFT_MESSAGE_DESC, aovs[aov].name, "it was not gathered (places)");
    if ((aov == WEFT_AOV_OBJECT || aov == WEFT_AOV_MATERIAL) && !film->matte[0])
        return fail(error, WEFT_MESSAGE_DESC, aovs[aov].name, "it was not gathered (mattes)");
    if (aov >= WEFT_AOV_DIFFUSE && !film->slots)
        return fail(error, WEFT_MESSAGE_DESC, aovs[aov].name, "it was not gathered (slots)");
    if (aov == WEFT_AOV_VARIANCE && film->halves < 2)
        return fail(error, WEFT_MESSAGE_DESC, aovs[aov].name, "it was not gathered (halves)");
    int channels = aovs[aov].channels;
    WeftResult result = weft_image_create(film->width, film->height, channels, WEFT_PIXEL_F32, out, error);
    if (result != WEFT_OK) return result;
    float *pixel = out->pixels;
    for (int y = 0; y < film->height; y++)
        for (int x = 0; x < film->width; x++, pixel += channels) aov_pixel(film, aov, x, y, pixel);
    return WEFT_OK;
}
