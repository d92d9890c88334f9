/* fuzz_wif - the reader of weaving drafts, and the notation of drafts
 *
 * Any input must be read or refused with one line. What is read has its threads in their ranges, and written
 * as a WIF and read again it is the same cloth. */
#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/cache.h"
#include "weave/weave_draft.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static void demand(int condition) {
    if (!condition) abort();
}

static void check_threads(const WeftDraft *draft) {
    for (int t = 0; t < 2; t++)
        for (int k = 0; k < draft->count[t]; k++) {
            const WeftThread thread = weft_draft_thread(draft, (WeftThreads)t, k);
            for (int c = 0; c < 3; c++) demand(thread.color[c] >= 0.0f && thread.color[c] <= 1.0f);
            demand(thread.spacing > 0.0f && thread.spacing <= 1.0f);
            demand(thread.thickness > 0.0f && thread.thickness <= 1.0f);
        }
}

static void check_round_trip(const WeftDraft *draft) {
    char *text = NULL;
    size_t size = 0;
    FILE *stream = open_memstream(&text, &size);
    demand(stream && wif_write(draft, stream, "fuzz", NULL) == WEFT_OK && fclose(stream) == 0);
    WeftDraft *again;
    WeftError error;
    demand(weft_draft_read_memory(text, size, "again", &again, NULL, &error) == WEFT_OK);
    demand(memcmp(again->count, draft->count, sizeof draft->count) == 0);
    demand(memcmp(again->up, draft->up, (size_t)draft->count[0] * (size_t)draft->count[1]) == 0);
    weft_draft_free(again);
    free(text);
}

/* A cloth of it is sound wherever it is looked at. */
static void check_cloth(const WeftDraft *draft) {
    WeftYarn yarn;
    WeftCloth *cloth;
    demand(weft_yarn_find("linen", &yarn, NULL) == WEFT_OK);
    demand(weft_cloth_create(draft, (WeftYarn[2]){yarn, yarn}, 1, &cloth, NULL) == WEFT_OK);
    const WeftClothInfo info = weft_cloth_info(cloth);
    for (int t = 0; t < 2; t++) demand(info.share[t] >= 0.0f && info.share[t] <= 1.0f && info.size[t] > 0.0f);
    weft_cloth_free(cloth);
}

/* has_cloth: a cloth is made too, which takes ten thousand times as long as reading, so that one input in 4096 has one. */
static void take(WeftResult result, WeftDraft *draft, bool has_cloth, const WeftError *error) {
    demand((result == WEFT_OK) == (draft != NULL));
    if (!draft) {
        demand(error->text[0] && !strchr(error->text, '\n'));
        return;
    }
    check_threads(draft);
    if ((long)draft->count[0] * draft->count[1] <= 4096) check_round_trip(draft);
    if (has_cloth && (long)draft->count[0] * draft->count[1] <= 256) check_cloth(draft);
    weft_draft_free(draft);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    WeftDraft *draft;
    WeftError error;
    const bool has_cloth = cache_hash(CACHE_HASH, data, size) % 4096 == 100;
    WeftResult result = weft_draft_read_memory(data, size, "fuzz", &draft, NULL, &error);
    take(result, draft, has_cloth, &error);
    char *words = malloc(size + 1);
    if (!words) return 0;
    memcpy(words, data, size);
    words[size] = '\0';
    result = weft_draft_parse(words, &draft, &error);
    take(result, draft, has_cloth, &error);
    free(words);
    return 0;
}
