#include "cli/render/picture_gather.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/steady_clock.h"
#include "cli/console/interrupt.h"
#include "cli/render/crew.h"
#include "cli/render/picture_words.h"
#include "cli/render/sums_file.h"
#include "weft/weft.h"

/* Fills in a line with a file's name before the text. */
static WeftResult refuse(WeftError *error, WeftResult result, const char *path, const char *text) {
    char line[sizeof error->text];
    snprintf(line, sizeof line, "%.240s: %.260s", path, text);
    return failure(error, result, line);
}

/* Writes of what picture the sums are, with `form` before. */
static WeftResult words_of(const Gather *gather, const char *form, char words[PART_WORDS], WeftError *error) {
    const Request *request = gather->job->request;
    snprintf(words, PART_WORDS, "%s=1 part=%d of=%d ", form, request->chunk_count ? request->chunk_index + 1 : 1,
             request->chunk_count ? request->chunk_count : 1);
    return picture_words(gather->job, &gather->desc, words, error);
}

/* ---- samples of earlier runs */

/* Reads the comment of a file, by any channel that each file with sums has. Release with free. */
static WeftResult comment_read(const char *path, char **words, WeftError *error) {
    static const char *const head[] = {"head.0"};
    WeftImage image;
    WeftResult result = weft_image_read_channels(path, head, 1, &image, words, error);
    if (result == WEFT_OK) weft_image_free(&image);
    return result;
}

/* Begins with the tiles of a part with fewer samples. */
static WeftResult part_begin(Gather *gather, const char *path, WeftError *error) {
    static const char *const free_words[] = {"part", "of", "spp", "tone", "behind", NULL};
    const int block = WEFT_RENDER_BLOCK * (gather->desc.halves ? 2 : 1);
    char wanted[PART_WORDS], difference[WORDS_DIFFERENCE], text[260], *words = NULL;
    double spp = 0.0;
    WeftResult result = comment_read(path, &words, error);
    if (result != WEFT_OK && error->message == WEFT_MESSAGE_IMAGE_UNSUPPORTED)
        return refuse(error, WEFT_INPUT, path, "is no part of a picture that weft render --chunk wrote");
    if (result == WEFT_OK) result = words_of(gather, "weft-part", wanted, error);
    char *layers = words ? strstr(words, " layers=") : NULL;
    if (layers) *layers = '\0'; /* AOVs that the file has of its own samples */
    if (result == WEFT_OK && (!words || !layers || !word_numbers(words, "spp", 1, &spp)))
        result = refuse(error, WEFT_INPUT, path, "is no part of a picture that weft render --chunk wrote");
    if (result == WEFT_OK && !words_same(words, wanted, free_words, difference)) {
        snprintf(text, sizeof text, "--from is of another picture: %s", difference);
        result = refuse(error, WEFT_USAGE, path, text);
    }
    if (result == WEFT_OK && gather->job->request->spp && spp > (double)gather->job->request->spp) {
        snprintf(text, sizeof text, "has %.9g samples a pixel, more than --spp %d", spp, gather->job->request->spp);
        result = refuse(error, WEFT_USAGE, path, text);
    }
    free(words);
    const bool last = spp >= (double)gather->job->request->spp; /* a part that is done already needs no more */
    return result != WEFT_OK ? result
                             : sums_read(path, gather->desc.crop[2], gather->desc.crop[3], gather->wanted,
                                         last ? 0 : block, gather->render, error);
}

/* Goes on from a checkpoint, if there is one. */
static WeftResult checkpoint_begin(Gather *gather, WeftError *error) {
    static const char *const none[] = {NULL};
    const char *path = gather->job->request->checkpoint;
    char wanted[PART_WORDS], difference[WORDS_DIFFERENCE], text[260], *words = NULL;
    if (access(path, F_OK) != 0) return WEFT_OK;
    WeftResult result = comment_read(path, &words, error);
    if (result != WEFT_OK &&
        (error->message == WEFT_MESSAGE_IMAGE_UNSUPPORTED || error->message == WEFT_MESSAGE_IMAGE_FORMAT)) {
        free(words);
        return refuse(error, WEFT_USAGE, path, "is there and is no checkpoint; name another file");
    }
    if (result == WEFT_OK) result = words_of(gather, "weft-checkpoint", wanted, error);
    if (result == WEFT_OK && !words_same(words ? words : "", wanted, none, difference)) {
        snprintf(text, sizeof text, "is a checkpoint of another picture: %s; name another file, or remove it",
                 difference);
        result = refuse(error, WEFT_USAGE, path, text);
    }
    free(words);
    if (result == WEFT_OK)
        result = sums_read(path, gather->desc.crop[2], gather->desc.crop[3], gather->wanted, 0, gather->render, error);
    return result;
}

/* Warns of tiles that no --from has. */
static void warn_missing(const Gather *gather) {
    const int across = (gather->desc.crop[2] + WEFT_RENDER_TILE - 1) / WEFT_RENDER_TILE;
    const size_t numbers = (size_t)weft_render_tile_numbers(gather->render);
    float *at = calloc(WEFT_RENDER_TILE_HEAD + WEFT_RENDER_TILE * WEFT_RENDER_TILE * numbers, sizeof *at);
    for (int tile = 0; at && tile < weft_render_tile_count(gather->render); tile++) {
        if (gather->wanted && !gather->wanted[tile]) continue;
        weft_render_tile(gather->render, tile, at);
        if (at[0] > 0.0f) continue;
        char text[120];
        snprintf(text, sizeof text, "--from: no file has the pixels from row %d on; they are rendered from the start",
                 tile / across * WEFT_RENDER_TILE);
        warnings_add(gather->job->warnings, true, text);
        break;
    }
    free(at);
}

static WeftResult earlier_begin(Gather *gather, WeftError *error) {
    const Request *request = gather->job->request;
    int cursor = 0;
    WeftResult result = WEFT_OK;
    for (const char *path; result == WEFT_OK && (path = option_next(request->options, "--from", &cursor));)
        result = part_begin(gather, path, error);
    if (result == WEFT_OK && option_given(request->options, "--from")) warn_missing(gather);
    if (result == WEFT_OK && request->checkpoint) result = checkpoint_begin(gather, error);
    return result;
}

WeftResult gather_checkpoint(Gather *gather, WeftError *error) {
    char words[PART_WORDS];
    TileSums sums = {.count = 0};
    WeftImage image = {0};
    WeftImageLayer layers[SUMS_LAYERS];
    WeftResult result = words_of(gather, "weft-checkpoint", words, error);
    if (result == WEFT_OK) result = weft_render_image(gather->render, &image, error);
    if (result == WEFT_OK) result = sums_make(gather->render, image.width, image.height, &sums, error);
    const WeftImageWriting how = {
        .comment = words, .isa = weft_isa(), .layers = layers, .layer_count = sums_layers(&sums, layers)};
    if (result == WEFT_OK) result = weft_image_write_as(gather->job->request->checkpoint, &image, &how, error);
    sums_free(&sums);
    weft_image_free(&image);
    gather->next = clock_now() + gather->job->request->checkpoint_every;
    return result;
}

void gather_forget(const Request *request) {
    if (request->checkpoint) unlink(request->checkpoint);
}

/* ---- gathering */

/* Redraws the line, as a WeftProgress whose user is a Gather; stops after a signal and for a checkpoint. */
static int gather_heed(void *user, double fraction) {
    Gather *gather = user;
    if (progress_heed(&gather->progress, gather->base + (1.0 - gather->base) * fraction)) return 1;
    gather->due = clock_now() >= gather->next;
    return gather->due;
}

/* Runs until all is done, or it is stopped. */
static WeftResult run(Gather *gather, int spp, double limit) {
    gather->due = false;
    gather->base = 0.0;
    if (gather->wanted) return weft_render_tiles_run(gather->render, gather->wanted, spp, gather_heed, gather);
    const int done = weft_render_samples(gather->render);
    gather->base = (double)done / spp;
    return done < spp ? weft_render_run(gather->render, spp - done, limit, gather_heed, gather) : WEFT_OK;
}

/* Runs alone, with checkpoints. */
static WeftResult run_alone(Gather *gather, int spp, double limit, WeftError *error) {
    WeftResult result = WEFT_OK;
    do {
        result = run(gather, spp, limit);
        if (result != WEFT_INTERRUPTED || !gather->job->request->checkpoint) break;
        const WeftResult written = gather_checkpoint(gather, error);
        if (written != WEFT_OK) return written;
    } while (gather->due);
    return result == WEFT_OK || result == WEFT_INTERRUPTED ? result
                                                           : failure(error, result, "the render could not be finished");
}

/* Runs with the other processes of a crew. */
static WeftResult run_together(Gather *gather, int spp, WeftError *error) {
    char words[PART_WORDS];
    WeftResult result = words_of(gather, "weft-part", words, error);
    return result == WEFT_OK ? crew_place()->run(gather, words, spp, error) : result;
}

WeftResult gather_samples(Gather *gather, WeftError *error) {
    const Request *request = gather->job->request;
    const int spp = request->spp ? request->spp : REQUEST_SPP_MOST;
    const double limit = request->time_limit / request_count(request);
    char prefix[32] = "";
    WeftResult result = crew_follows() ? WEFT_OK : earlier_begin(gather, error);
    if (result != WEFT_OK) return result;
    if (request_count(request) > 1)
        snprintf(prefix, sizeof prefix, "%d/%d ", gather->job->number + 1, request_count(request));
    gather->progress = progress_start(request->quiet, prefix, request->spp, spp, job_pixels(gather->job), limit);
    gather->next = request->checkpoint ? clock_now() + request->checkpoint_every : (double)INFINITY;
    result = crew_place() ? run_together(gather, spp, error) : run_alone(gather, spp, limit, error);
    progress_finish(&gather->progress);
    gather->job->interrupted = result == WEFT_INTERRUPTED;
    return result == WEFT_INTERRUPTED ? WEFT_OK : result;
}
