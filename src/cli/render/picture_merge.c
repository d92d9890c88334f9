#include "cli/render/picture_merge.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/render/picture_part.h"
#include "cli/render/picture_words.h"
#include "weft/weft.h"

int picture_merged_layers(const PicturePart *part, WeftImageLayer layers[WEFT_IMAGE_LAYERS]) {
    for (int k = 0; k < part->layer_count; k++) {
        layers[k] = (WeftImageLayer){.image = &part->layers[k]};
        for (int c = 0; c < part->layers[k].channels; c++) layers[k].channels[c] = part->names[k][c];
    }
    return part->layer_count;
}

/* Makes a layer of the whole picture, black, with these names of channels. */
static WeftResult layer_make(Job *job, const char *const names[4], WeftError *error) {
    PicturePart *part = &job->part;
    const int k = part->layer_count;
    int channels = 0;
    if (k == PART_LAYERS) return failure(error, WEFT_USAGE, "merge: too many AOVs");
    while (channels < 4 && names[channels]) {
        snprintf(part->names[k][channels], PART_NAME, "%s", names[channels]);
        channels++;
    }
    WeftResult result = weft_image_create(job->width, job->height, channels, WEFT_PIXEL_F32, &part->layers[k], error);
    if (result == WEFT_OK) part->layer_count++;
    return result;
}

/* A part that was read, without its pixels. */
typedef struct PartFile {
    const char *path;
    char *words; /* owned */
    int index, count;
    int spp; /* samples a pixel */
} PartFile;

/* The parts that were read, of those with the most samples. */
typedef struct Merge {
    Request *request;
    Job *job;
    PartFile first;                /* the one that others are compared with */
    const char *seen[CHUNKS_MOST]; /* paths by index of part; NULL: missing */
    const char *lesser;            /* a part with fewer samples; NULL: none */
    int lesser_spp;
} Merge;

static WeftResult refuse(WeftError *error, WeftResult result, const char *path, const char *text) {
    char line[sizeof error->text];
    snprintf(line, sizeof line, "%.240s: %.260s", path, text);
    return failure(error, result, line);
}

static const char no_part[] = "is no part of a picture that weft render --chunk wrote";

/* Reads the picture of a part and its words. */
static WeftResult part_read(PartFile *part, WeftImage *image, WeftError *error) {
    double index[1], count[1], form[1], spp[1];
    WeftResult result = weft_image_read_channels(part->path, picture_channels, 4, image, &part->words, error);
    if (result != WEFT_OK && error->message == WEFT_MESSAGE_IMAGE_UNSUPPORTED)
        return refuse(error, WEFT_INPUT, part->path, no_part);
    if (result != WEFT_OK) return result;
    if (!part->words || !word_numbers(part->words, "weft-part", 1, form) || form[0] < 1.0 || form[0] > 1.0 ||
        !word_numbers(part->words, "part", 1, index) || !word_numbers(part->words, "of", 1, count) ||
        !word_numbers(part->words, "spp", 1, spp) || !(spp[0] >= 1.0 && spp[0] <= (double)REQUEST_SPP_MOST) ||
        !(count[0] >= 1.0 && count[0] <= CHUNKS_MOST && index[0] >= 1.0 && index[0] <= count[0]))
        return refuse(error, WEFT_INPUT, part->path, no_part);
    part->index = (int)index[0] - 1, part->count = (int)count[0], part->spp = (int)spp[0];
    return WEFT_OK;
}

/* Compares what two parts say of their picture, word by word. Their samples may differ, and then how they were cut and
 * how they are shown. */
static WeftResult part_compare(const PartFile *first, const PartFile *part, WeftError *error) {
    static const char *const equal[] = {"part", NULL};
    static const char *const others[] = {"part", "of", "spp", "tone", "behind", NULL};
    char difference[WORDS_DIFFERENCE], text[260];
    if (words_same(part->words, first->words, part->spp == first->spp ? equal : others, difference)) return WEFT_OK;
    snprintf(text, sizeof text, "is of another picture than %.60s: %s", first->path, difference);
    return refuse(error, WEFT_USAGE, part->path, text);
}

/* Copies the rows of a part; refuses numbers that are not finite. */
static WeftResult rows_take(const PartFile *part, const WeftImage *image, WeftImage *whole, WeftError *error) {
    const size_t row = (size_t)whole->width * (size_t)whole->channels;
    for (int y = 0; y < whole->height; y++) {
        if (!picture_part_has_row(whole->height, part->index, part->count, y)) continue;
        const float *from = (const float *)image->pixels + (size_t)y * row;
        for (size_t k = 0; k < row; k++)
            if (!isfinite(from[k])) return refuse(error, WEFT_INPUT, part->path, "has a number that is not finite");
        memcpy((float *)whole->pixels + (size_t)y * row, from, row * sizeof(float));
    }
    return WEFT_OK;
}

/* Takes the picture's size and how it is shown from the words of the first part. */
static WeftResult words_take(const PartFile *part, Request *request, Job *job, WeftError *error) {
    double crop[4], tone[6], behind[4];
    SceneOptions *shown = &request->scene_options;
    size_t length = 0;
    const char *isa = word_value(part->words, "isa", &length);
    if (!word_numbers(part->words, "crop", 4, crop) || !word_numbers(part->words, "tone", 6, tone) ||
        !word_numbers(part->words, "behind", 4, behind) || !isa || length >= sizeof job->part.isa ||
        !(crop[2] >= 1.0 && crop[2] <= 65536.0 && crop[3] >= 1.0 && crop[3] <= 65536.0) ||
        !(tone[0] >= 0.0 && tone[0] < (double)WEFT_TONEMAP_COUNT) || !(fabs(tone[1]) <= 64.0))
        return refuse(error, WEFT_INPUT, part->path, no_part);
    job->width = (int)crop[2], job->height = (int)crop[3];
    snprintf(job->part.isa, sizeof job->part.isa, "%.*s", (int)length, isa);
    shown->tone = (WeftTone){(WeftTonemap)(int)tone[0], (float)tone[1], {(float)tone[2], (float)tone[3]}};
    shown->meter_exposure = tone[4] > 0.0;
    shown->find_white = tone[5] > 0.0;
    shown->background = behind[0] > 0.0 ? WEFT_BACKGROUND_COLOR : WEFT_BACKGROUND_AUTO;
    for (int c = 0; c < 3; c++) shown->background_color[c] = (float)behind[c + 1];
    return WEFT_OK;
}

static WeftResult size_check(const PartFile *part, const Job *job, const WeftImage *image, WeftError *error) {
    if (image->width == job->width && image->height == job->height) return WEFT_OK;
    return refuse(error, WEFT_INPUT, part->path, "has not the size that it says: it is damaged");
}

/* Reads the names of a layer's channels, "albedo.R,albedo.G", from *at on, and moves *at behind them. Returns how many
 * there are; 0 where that is no list. */
static int names_read(const char **at, char names[4][PART_NAME]) {
    int count = 0;
    for (;;) {
        const size_t length = strcspn(*at, ",; ");
        if (length < 1 || length >= PART_NAME || count == 4) return 0;
        memcpy(names[count], *at, length);
        names[count++][length] = '\0';
        *at += length;
        if (**at != ',') return count;
        ++*at;
    }
}

/* Reads the other layers of a part, which its words name; makes them if it is the first part. */
static WeftResult layers_take(const PartFile *part, bool first, Job *job, WeftError *error) {
    size_t length = 0;
    const char *at = word_value(part->words, "layers", &length);
    WeftResult result = WEFT_OK;
    if (!at) return refuse(error, WEFT_INPUT, part->path, no_part);
    for (int k = 0; result == WEFT_OK && *at && *at != ' '; k++) {
        char names[4][PART_NAME];
        WeftImage image = {0};
        const int count = names_read(&at, names);
        const char *const channels[4] = {names[0], count > 1 ? names[1] : NULL, count > 2 ? names[2] : NULL,
                                         count > 3 ? names[3] : NULL};
        if (!count || k == PART_LAYERS) return refuse(error, WEFT_INPUT, part->path, no_part);
        result = weft_image_read_channels(part->path, channels, count, &image, NULL, error);
        if (result == WEFT_OK) result = size_check(part, job, &image, error);
        if (result == WEFT_OK && first) result = layer_make(job, channels, error);
        if (result == WEFT_OK) result = rows_take(part, &image, &job->part.layers[k], error);
        weft_image_free(&image);
        at += *at == ';';
    }
    return result;
}

/* Begins a picture with its first part, or with the first that has more samples than those before. */
static WeftResult merge_begin(Merge *merge, PartFile *part, const WeftImage *image, WeftError *error) {
    Job *job = merge->job;
    WeftResult result = words_take(part, merge->request, job, error);
    if (result == WEFT_OK) result = size_check(part, job, image, error);
    if (result != WEFT_OK) return result;
    for (int k = 0; k < CHUNKS_MOST; k++) {
        if (merge->seen[k]) merge->lesser = merge->seen[k], merge->lesser_spp = merge->first.spp, job->part.left++;
        merge->seen[k] = NULL;
    }
    weft_image_free(&job->linear);
    picture_part_free(&job->part);
    free(merge->first.words);
    merge->first = *part;
    part->words = NULL;
    job->part.spp = part->spp;
    return weft_image_create(job->width, job->height, 4, WEFT_PIXEL_F32, &job->linear, error);
}

/* Adds one part to the picture. */
static WeftResult part_take(Merge *merge, PartFile *part, WeftError *error) {
    WeftImage image = {0};
    WeftResult result = part_read(part, &image, error);
    bool first = !merge->first.words, less = false;
    PartFile own = *part;
    if (result == WEFT_OK && !first) result = part_compare(&merge->first, part, error);
    if (result == WEFT_OK && !first && part->spp < merge->first.spp) {
        less = true;
        merge->lesser = part->path, merge->lesser_spp = part->spp, merge->job->part.left++;
    }
    first |= part->spp > merge->first.spp;
    if (result == WEFT_OK && first)
        result = merge_begin(merge, part, &image, error);
    else if (result == WEFT_OK && !less)
        result = size_check(part, merge->job, &image, error);
    own.words = first ? merge->first.words : part->words;
    if (result == WEFT_OK && !less && merge->seen[own.index]) {
        char text[200];
        snprintf(text, sizeof text, "is part %d of %d, as is %.100s", own.index + 1, own.count, merge->seen[own.index]);
        result = refuse(error, WEFT_USAGE, own.path, text);
    }
    if (result == WEFT_OK && !less) result = rows_take(&own, &image, &merge->job->linear, error);
    weft_image_free(&image);
    if (result == WEFT_OK && !less) result = layers_take(&own, first, merge->job, error);
    if (result == WEFT_OK && !less) merge->seen[own.index] = own.path;
    return result;
}

/* Names the parts that are missing. */
static WeftResult missing_refuse(const Merge *merge, WeftError *error) {
    char list[160] = "", fewer[160] = "";
    int missing = 0;
    for (int k = 0; k < merge->first.count; k++) {
        if (merge->seen[k]) continue;
        const size_t used = strlen(list);
        if (used < sizeof list - 24)
            snprintf(list + used, sizeof list - used, "%s%d", missing ? ", " : "", k + 1);
        else if (strcmp(list + used - 3, "...") != 0)
            snprintf(list + used, sizeof list - used, ", ...");
        missing++;
    }
    if (!missing) return WEFT_OK;
    char line[460];
    if (merge->lesser)
        snprintf(fewer, sizeof fewer, " of %d samples a pixel; %.80s has %d (weft render --from adds samples)",
                 merge->first.spp, merge->lesser, merge->lesser_spp);
    snprintf(line, sizeof line, "merge: of %d parts %d %s missing: %s%s", merge->first.count, missing,
             missing > 1 ? "are" : "is", list, fewer);
    return failure(error, WEFT_USAGE, line);
}

WeftResult picture_parts_read(const char *const *paths, int count, Request *request, Job *job, WeftError *error) {
    Merge *merge = calloc(1, sizeof *merge);
    WeftResult result = WEFT_OK;
    if (!merge) return failure(error, WEFT_RESOURCES, "out of memory");
    merge->request = request, merge->job = job;
    for (int k = 0; k < count && result == WEFT_OK; k++) {
        PartFile part = {.path = paths[k]};
        result = part_take(merge, &part, error);
        free(part.words);
    }
    if (result == WEFT_OK) result = missing_refuse(merge, error);
    free(merge->first.words);
    free(merge);
    return result;
}
