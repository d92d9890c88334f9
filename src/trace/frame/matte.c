#include "trace/frame/matte.h"

#include <jansson.h>
#include <stdio.h>
#include <string.h>

static uint32_t rotated(uint32_t x, int by) { return (x << by) | (x >> (32 - by)); }

static uint32_t scrambled(uint32_t block) { return rotated(block * 0xcc9e2d51u, 15) * 0x1b873593u; }

uint32_t matte_hash(const char *name) {
    const size_t size = strlen(name), whole = size / 4 * 4;
    uint32_t hash = 0, tail = 0;
    for (size_t k = 0; k < whole; k += 4) {
        uint32_t block = 0;
        for (size_t b = 0; b < 4; b++) block |= (uint32_t)(unsigned char)name[k + b] << (8 * b);
        hash = rotated(hash ^ scrambled(block), 13) * 5 + 0xe6546b64u;
    }
    for (size_t k = whole; k < size; k++) tail |= (uint32_t)(unsigned char)name[k] << (8 * (k - whole));
    if (size > whole) hash ^= scrambled(tail);
    hash ^= (uint32_t)size;
    hash = (hash ^ (hash >> 16)) * 0x85ebca6bu;
    hash = (hash ^ (hash >> 13)) * 0xc2b2ae35u;
    return hash ^ (hash >> 16);
}

uint32_t matte_id(const char *name) {
    const uint32_t hash = matte_hash(name), exponent = (hash >> 23) & 255u;
    return exponent == 0u || exponent == 255u ? hash ^ (1u << 23) : hash;
}

void matte_add(Matte *matte, uint32_t id) {
    for (int k = 0; k < MATTE_IDS; k++) {
        if (matte->samples[k] && matte->id[k] != id) continue;
        matte->id[k] = id;
        matte->samples[k]++;
        return;
    }
}

static bool is_before(const Matte *matte, int a, int b) {
    if (matte->samples[a] != matte->samples[b]) return matte->samples[a] > matte->samples[b];
    return matte->id[a] < matte->id[b];
}

void matte_rank(const Matte *matte, int samples, float ranks[2 * MATTE_RANKS]) {
    memset(ranks, 0, 2 * MATTE_RANKS * sizeof *ranks);
    for (int k = 0; k < MATTE_IDS && matte->samples[k]; k++) {
        int place = 0;
        for (int j = 0; j < MATTE_IDS; j++) place += j != k && is_before(matte, j, k);
        if (place >= MATTE_RANKS) continue;
        memcpy(&ranks[2 * place], &matte->id[k], sizeof(float));
        ranks[2 * place + 1] = (float)matte->samples[k] / (float)samples;
    }
}

char *matte_manifest(const char *const *names, int count) {
    json_t *object = json_object();
    bool good = object != NULL;
    for (int k = 0; good && k < count; k++) {
        char id[9];
        snprintf(id, sizeof id, "%08x", (unsigned)matte_id(names[k]));
        good = json_object_set_new(object, names[k], json_string(id)) == 0;
    }
    char *text = good ? json_dumps(object, JSON_COMPACT | JSON_SORT_KEYS | JSON_ENSURE_ASCII) : NULL;
    json_decref(object);
    return text;
}
