/* fuzz_wif - the reader of weaving drafts (WIF, and the text of Fiberworks), and the notation of drafts
 *
 * Any input must be read or refused with one line. What is read has its threads in their ranges, and written
 * as a WIF and read again it is the same cloth. A WIF that is read without a warning has in the sections of threads and
 * looms nothing but keys and values of the format, by a second, simpler list of what these are. */
#define _GNU_SOURCE /* strcasestr */
#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "base/cache.h"
#include "weave/dtx.h"
#include "weave/ini.h"
#include "weave/weave_draft.h"
#include "weave/wpo.h"

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

static void count_warning(void *user, WeftMessage message, const char *text) {
    demand(message == WEFT_MESSAGE_DRAFT_COMPLETED && text[0] && !strchr(text, '\n'));
    ++*(int *)user;
}

/* Demands that a line is one that a reader can have understood. An empty value is a missing one. */
static void check_line(const IniLine *line) {
    static const char *const numbered[] = {"THREADING",    "TIEUP",          "TREADLING",     "LIFTPLAN",
                                           "COLOR TABLE",  "WARP COLORS",    "WEFT COLORS",   "WARP SPACING",
                                           "WEFT SPACING", "WARP THICKNESS", "WEFT THICKNESS"};
    static const char numerals[] = "0123456789abcdefxpABCDEFXP.,+- \t", letters[] = "Thread Color Spacing Thickness";
    demand(line->section[0] != '\0');
    bool of_numbers = false;
    for (size_t k = 0; k < sizeof numbered / sizeof *numbered; k++)
        of_numbers |= strcasecmp(line->section, numbered[k]) == 0;
    const bool of_threads = strcasecmp(line->section, "WARP") == 0 || strcasecmp(line->section, "WEFT") == 0;
    if (!of_numbers && !of_threads) return;
    demand(line->value != NULL);
    const size_t size = strcspn(line->value, ";");
    if (of_numbers) demand(line->key[0] >= '0' && line->key[0] <= '9');
    if (of_numbers || (strcasestr(letters, line->key) && line->key[0])) demand(strspn(line->value, numerals) >= size);
    if (strcasecmp(line->key, "Units") == 0 && size) demand(strchr("dicmDICM\"", line->value[0]) != NULL);
}

static void check_understood(const uint8_t *data, size_t size) {
    Ini ini;
    if (ini_read(data, size, "fuzz", &ini, NULL) == WEFT_OK)
        for (int k = 0; k < ini.count; k++) check_line(&ini.lines[k]);
    ini_free(&ini);
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
    int warnings = 0;
    const WeftLog log = {.fn = count_warning, .user = &warnings};
    WeftResult result = weft_draft_read_memory(data, size, "fuzz", &draft, &log, &error);
    if (result == WEFT_OK && !warnings && !dtx_is(data, size) && !wpo_is(data, size)) check_understood(data, size);
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
