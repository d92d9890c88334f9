#include "cli/render/picture_part.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/render/picture_gather.h"
#include "cli/render/picture_words.h"
#include "cli/render/sums_file.h"
#include "weft/weft.h"

enum {
    TILE = WEFT_RENDER_TILE,
    BANDS_EACH = 8
}; /* about so many bands a part, so that each has some of all that is slow */

const char *const picture_channels[4] = {"part.R", "part.G", "part.B", "part.A"};

/* Returns the height of a band, pixels. */
static int band_height(int height, int count) {
    const int tiles = (height + TILE - 1) / TILE, rows = tiles / (BANDS_EACH * count);
    return TILE * (rows < 1 ? 1 : rows);
}

bool picture_part_has_row(int height, int index, int count, int y) {
    return y / band_height(height, count) % count == index;
}

/* Marks the tiles of the part; returns a byte for each tile, to be released with free, and counts its pixels. */
static unsigned char *tiles_of(Job *job, WeftError *error) {
    const int across = (job->width + TILE - 1) / TILE, down = (job->height + TILE - 1) / TILE;
    unsigned char *wanted = calloc((size_t)across * (size_t)down, 1);
    if (!wanted) failure(error, WEFT_RESOURCES, "out of memory");
    job->part.pixels = 0.0;
    for (int row = 0; wanted && row < down; row++) {
        const int rest = job->height - TILE * row;
        if (!picture_part_has_row(job->height, job->request->chunk_index, job->request->chunk_count, TILE * row))
            continue;
        memset(wanted + (size_t)row * (size_t)across, 1, (size_t)across);
        job->part.pixels += (double)job->width * (rest < TILE ? rest : TILE);
    }
    return wanted;
}

/* Writes of what picture the part is, and the names of its layers. */
static WeftResult words_write(Job *job, const WeftRenderDesc *desc, WeftError *error) {
    char *words = job->part.words;
    snprintf(words, PART_WORDS, "weft-part=1 part=%d of=%d ", job->request->chunk_index + 1, job->request->chunk_count);
    WeftResult result = picture_words(job, desc, words, error);
    for (int k = -1; k < job->layers.layer_count; k++)
        for (int c = 0; c < (k < 0 ? 1 : job->layers.layers[k].image->channels); c++) {
            const size_t used = strlen(words);
            snprintf(words + used, PART_WORDS - used, "%s%s",
                     k < 0   ? " layers="
                     : c     ? ","
                     : k > 0 ? ";"
                             : "",
                     k < 0 ? "" : job->layers.layers[k].channels[c]);
        }
    return result;
}

/* Takes the rows of the part, their AOVs and their sums. */
static WeftResult rows_take(Job *job, const WeftRender *render, const WeftRenderDesc *desc, WeftError *error) {
    const unsigned aovs = job->request->aovs;
    job->info = weft_render_info(render);
    job->info.samples_per_pixel *= (double)job->width * job->height / job->part.pixels;
    job->part.sums = calloc(1, sizeof *job->part.sums);
    if (!job->part.sums) return failure(error, WEFT_RESOURCES, "out of memory");
    WeftResult result = weft_render_image(render, &job->linear, error);
    if (result == WEFT_OK && aovs) result = weft_render_layers(render, aovs, &job->layers, error);
    if (result == WEFT_OK) result = sums_make(render, job->width, job->height, job->part.sums, error);
    if (result == WEFT_OK && 1 + job->layers.layer_count + job->part.sums->count > WEFT_IMAGE_LAYERS)
        result = failure(error, WEFT_USAGE, "--chunk: too many AOVs");
    return result == WEFT_OK ? words_write(job, desc, error) : result;
}

/* Says what an interruption left. */
static WeftResult interrupted(const Request *request, WeftError *error) {
    char text[400];
    if (!request->checkpoint)
        return failure(error, WEFT_INTERRUPTED, "interrupted: a part is whole or not at all, and nothing was written");
    snprintf(text, sizeof text, "interrupted: %.300s has what there is, from which the same command goes on",
             request->checkpoint);
    return failure(error, WEFT_INTERRUPTED, text);
}

WeftResult picture_part_trace(Job *job, WeftRender *render, const WeftRenderDesc *desc, WeftError *error) {
    unsigned char *wanted = tiles_of(job, error);
    if (!wanted) return WEFT_RESOURCES;
    Gather gather = {.job = job, .render = render, .desc = *desc, .wanted = wanted};
    WeftResult result = gather_samples(&gather, error);
    free(wanted);
    if (result == WEFT_OK && job->interrupted) result = interrupted(job->request, error);
    return result == WEFT_OK ? rows_take(job, render, desc, error) : result;
}

WeftResult picture_part_write(const Job *job, WeftError *error) {
    WeftImageLayer layers[1 + WEFT_IMAGE_LAYERS + SUMS_LAYERS] = {{.image = &job->linear}};
    int count = 1;
    memcpy(layers[0].channels, picture_channels, sizeof picture_channels);
    for (int k = 0; k < job->layers.layer_count; k++) layers[count++] = job->layers.layers[k];
    count += sums_layers(job->part.sums, layers + count);
    const Outputs outputs = {
        &job->linear, NULL, {.comment = job->part.words, .isa = weft_isa(), .layers = layers, .layer_count = count}};
    return request_outputs_write(job->request, NULL, &outputs, error);
}

void picture_part_free(PicturePart *part) {
    for (int k = 0; k < part->layer_count; k++) weft_image_free(&part->layers[k]);
    part->layer_count = 0;
    if (part->sums) sums_free(part->sums);
    free(part->sums);
    part->sums = NULL;
}
