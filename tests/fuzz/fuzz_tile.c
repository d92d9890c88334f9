/* fuzz_tile - the sums of a tile and the words of a part, as weft render --from, checkpoints and weft-mpi take them
 *
 * Any numbers must be taken or refused whole, and a picture and its layers be made of what was taken. The first bytes up to
 * a zero are the words. */
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "cli/render/picture_words.h"
#include "weft/render.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static WeftRender *render;

/* Makes a render of one tile that records all that there is. */
static void begin(void) {
    const WeftRenderDesc desc = {.width = 16,
                                 .height = 9,
                                 .threads = 1,
                                 .floor = {.on = 1},
                                 .halves = 1,
                                 .first_hits = 1,
                                 .places = 1,
                                 .mattes = 1,
                                 .slots = 1};
    WeftScene *scene;
    if (weft_scene_load("builtin:cloth", &scene, NULL, NULL) != WEFT_OK) abort();
    if (weft_render_create(scene, &desc, &render, NULL) != WEFT_OK) abort();
}

static void words_read(const uint8_t *data, size_t size) {
    static const char *const but[] = {"part", "spp", NULL};
    char words[PART_WORDS] = "", difference[WORDS_DIFFERENCE];
    double numbers[6];
    size_t length;
    memcpy(words, data, size < sizeof words - 1 ? size : sizeof words - 1);
    const char *value = word_value(words, "isa", &length);
    if (value && length > strlen(value)) abort();
    for (int k = 1; k <= 6; k++)
        if (word_numbers(words, "tone", k, numbers))
            for (int n = 0; n < k; n++)
                if (!isfinite(numbers[n])) abort();
    if (!words_same(words, words, but, difference)) abort();
    if (!words_same(words, "part=1 spp=4 isa=sse2", but, difference) && strlen(difference) >= WORDS_DIFFERENCE) abort();
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    enum { NUMBERS = WEFT_RENDER_TILE_HEAD + WEFT_RENDER_TILE * WEFT_RENDER_TILE * WEFT_RENDER_NUMBERS };
    static float before[NUMBERS], numbers[NUMBERS], after[NUMBERS];
    if (!render) begin();
    words_read(data, strnlen((const char *)data, size));
    const size_t used = WEFT_RENDER_TILE_HEAD +
                        (size_t)(WEFT_RENDER_TILE * WEFT_RENDER_TILE * weft_render_tile_numbers(render)),
                 bytes = used * sizeof *numbers;
    weft_render_tile(render, 0, before);
    memcpy(numbers, before, bytes);
    memcpy(numbers, data, size < bytes ? size : bytes);
    const bool taken = weft_render_tile_set(render, 0, numbers, NULL) == WEFT_OK;
    weft_render_tile(render, 0, after);
    for (size_t k = 0; k < used; k++)
        if (!taken && (after[k] < before[k] || after[k] > before[k])) abort();
    WeftImage image;
    WeftRenderLayers layers;
    if (weft_render_image(render, &image, NULL) != WEFT_OK) abort();
    if (weft_render_layers(render, (1u << WEFT_AOV_COUNT) - 1u, &layers, NULL) != WEFT_OK) abort();
    weft_image_free(&image);
    weft_render_layers_free(&layers);
    return 0;
}
