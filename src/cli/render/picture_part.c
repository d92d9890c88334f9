#include "cli/render/picture_part.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/console/progress.h"
#include "weft/weft.h"

enum { TILE = 16, BANDS_EACH = 8 }; /* about so many bands a part, so that each part has some of all that is slow */

static const char *const picture_channels[] = {"part.R", "part.G", "part.B", "part.A"};

/* Returns the height of a band, pixels. */
static int band_height(int height, int count) {
    const int tiles = (height + TILE - 1) / TILE, rows = tiles / (BANDS_EACH * count);
    return TILE * (rows < 1 ? 1 : rows);
}

bool picture_part_has_row(int height, int index, int count, int y) {
    return y / band_height(height, count) % count == index;
}

/* ---- rendering */

/* The progress of a band within that of the part. */
typedef struct Share {
    Progress *progress;
    double before, size;
} Share;

static int share_heed(void *user, double fraction) {
    const Share *share = user;
    return progress_heed(share->progress, share->before + share->size * fraction);
}

/* Copies the rows of a band into an image of the whole picture. */
static void rows_copy(const WeftImage *band, int top, WeftImage *whole) {
    const size_t row = (size_t)whole->width * (size_t)whole->channels;
    memcpy((float *)whole->pixels + (size_t)top * row, band->pixels, (size_t)band->height * row * sizeof(float));
}

static void band_place(WeftImage *band, int top, WeftImage *whole) {
    rows_copy(band, top, whole);
    weft_image_free(band);
}

/* Makes a layer of the whole picture, black, with these names of channels. */
static WeftResult layer_make(Job *job, const char *const names[4], WeftError *error) {
    PicturePart *part = &job->part;
    const int k = part->layer_count;
    int channels = 0;
    if (k == PART_LAYERS) return failure(error, WEFT_USAGE, "--chunk: too many AOVs");
    while (channels < 4 && names[channels]) {
        snprintf(part->names[k][channels], PART_NAME, "%s", names[channels]);
        channels++;
    }
    WeftResult result = weft_image_create(job->width, job->height, channels, WEFT_PIXEL_F32, &part->layers[k], error);
    if (result == WEFT_OK) part->layer_count++;
    return result;
}

static WeftResult band_take(Job *job, const WeftRender *render, int top, WeftError *error) {
    WeftImage band;
    WeftRenderLayers layers = {0};
    WeftResult result = weft_render_image(render, &band, error);
    if (result == WEFT_OK) band_place(&band, top, &job->linear);
    if (result == WEFT_OK && job->request->aovs)
        result = weft_render_layers(render, job->request->aovs, &layers, error);
    for (int k = 0; k < layers.layer_count && result == WEFT_OK; k++) {
        if (k == job->part.layer_count) result = layer_make(job, layers.layers[k].channels, error);
        if (result == WEFT_OK) rows_copy(layers.layers[k].image, top, &job->part.layers[k]);
    }
    weft_render_layers_free(&layers);
    return result;
}

int picture_part_layers(const PicturePart *part, WeftImageLayer layers[WEFT_IMAGE_LAYERS]) {
    for (int k = 0; k < part->layer_count; k++) {
        layers[k] = (WeftImageLayer){.image = &part->layers[k]};
        for (int c = 0; c < part->layers[k].channels; c++) layers[k].channels[c] = part->names[k][c];
    }
    return part->layer_count;
}

void picture_part_free(PicturePart *part) {
    for (int k = 0; k < part->layer_count; k++) weft_image_free(&part->layers[k]);
    part->layer_count = 0;
}

/* Adds what a band took to the figures of the part. */
static void info_add(Job *job, const WeftRender *render, double share) {
    const WeftRenderInfo info = weft_render_info(render);
    job->info.rays += info.rays;
    job->info.non_finite += info.non_finite;
    job->info.render_seconds += info.render_seconds;
    job->info.build_seconds += info.build_seconds;
    job->info.samples_per_pixel += share * info.samples_per_pixel;
    job->info.camera_fov = info.camera_fov;
    memcpy(job->info.camera_eye, info.camera_eye, sizeof info.camera_eye);
    memcpy(job->info.camera_target, info.camera_target, sizeof info.camera_target);
}

/* Renders the band that begins at pixel row `top`. */
static WeftResult band_trace(Job *job, WeftRender **render, WeftRenderDesc desc, int top, Share *share,
                             WeftError *error) {
    const int height = band_height(job->height, job->request->chunk_count);
    desc.crop[1] += top;
    desc.crop[3] = job->height - top < height ? job->height - top : height;
    WeftResult result =
        *render ? weft_render_restart(*render, &desc, 0, error) : weft_render_create(job->scene, &desc, render, error);
    if (result != WEFT_OK) return result;
    result = weft_render_run(*render, job->request->spp, 0.0, share_heed, share);
    if (result == WEFT_INTERRUPTED)
        return failure(error, result, "interrupted: a part is whole or not at all, and nothing was written");
    if (result != WEFT_OK) return failure(error, result, "the render could not be finished");
    info_add(job, *render, (double)desc.crop[3] / job->height);
    return band_take(job, *render, top, error);
}

static WeftResult words_write(Job *job, const WeftRenderDesc *desc, WeftError *error);

WeftResult picture_part_trace(Job *job, const WeftRenderDesc *desc, WeftError *error) {
    const Request *request = job->request;
    WeftRenderDesc whole = *desc;
    WeftRender *render = NULL;
    if (!whole.crop[2]) whole.crop[2] = job->width, whole.crop[3] = job->height;
    job->info = (WeftRenderInfo){.samples_per_pixel = 0.0};
    WeftResult result = weft_image_create(job->width, job->height, 4, WEFT_PIXEL_F32, &job->linear, error);
    Progress progress =
        progress_start(request->quiet, "", request->spp, request->spp, (double)job->width * job->height, 0.0);
    const int height = band_height(job->height, request->chunk_count), step = height * request->chunk_count;
    Share share = {&progress, 0.0, (double)step / job->height};
    for (int top = height * request->chunk_index; top < job->height && result == WEFT_OK; top += step) {
        result = band_trace(job, &render, whole, top, &share, error);
        share.before += share.size;
    }
    progress_finish(&progress);
    weft_render_free(render);
    return result == WEFT_OK ? words_write(job, &whole, error) : result;
}

/* ---- words */

/* Writes of what picture the part is: all that its pixels depend on, and how it is shown. */
static WeftResult words_write(Job *job, const WeftRenderDesc *desc, WeftError *error) {
    const Request *request = job->request;
    const SceneOptions *shown = &request->scene_options;
    const bool laid = shown->background == WEFT_BACKGROUND_COLOR;
    const float *behind = shown->background_color;
    const WeftTone *tone = &shown->tone;
    WeftCamera camera;
    WeftResult result =
        weft_scene_camera(job->scene, desc->camera, (float)desc->width / (float)desc->height, &camera, error);
    if (result != WEFT_OK) return result;
    char *words = job->part.words;
    snprintf(words, sizeof job->part.words,
             "weft-part=1 part=%d of=%d version=%s isa=%s scene=%016llx camera=%.9g,%.9g,%.9g;%.9g,%.9g,%.9g;%.9g "
             "picture=%dx%d crop=%d,%d,%d,%d spp=%d seed=%u depth=%d sampling=%d background=%d floor=%d,%.9g,%.9g "
             "lights=%d halves=%d aovs=%u tone=%d,%.9g,%.9g,%.9g,%d,%d behind=%d,%.9g,%.9g,%.9g layers=",
             request->chunk_index + 1, request->chunk_count, weft_version(), weft_isa(),
             (unsigned long long)weft_scene_hash(job->scene), (double)camera.eye[0], (double)camera.eye[1],
             (double)camera.eye[2], (double)camera.target[0], (double)camera.target[1], (double)camera.target[2],
             (double)camera.fov, desc->width, desc->height, desc->crop[0], desc->crop[1], desc->crop[2], desc->crop[3],
             request->spp, (unsigned)desc->seed, desc->max_depth, (int)desc->sampling, (int)desc->background,
             desc->floor.on, (double)desc->floor.reflection, (double)desc->floor.roughness, !desc->hide_lights,
             desc->halves, request->aovs, (int)tone->curve, (double)tone->exposure, (double)tone->white[0],
             (double)tone->white[1], shown->meter_exposure, shown->find_white, laid, laid ? (double)behind[0] : 0.0,
             laid ? (double)behind[1] : 0.0, laid ? (double)behind[2] : 0.0);
    for (int k = 0; k < job->part.layer_count; k++)
        for (int c = 0; c < job->part.layers[k].channels; c++) {
            const size_t used = strlen(words);
            snprintf(words + used, sizeof job->part.words - used, "%s%s",
                     c   ? ","
                     : k ? ";"
                         : "",
                     job->part.names[k][c]);
        }
    return WEFT_OK;
}

WeftResult picture_part_write(const Job *job, WeftError *error) {
    WeftImageLayer layers[1 + WEFT_IMAGE_LAYERS] = {{.image = &job->linear}};
    memcpy(layers[0].channels, picture_channels, sizeof picture_channels);
    const int count = 1 + picture_part_layers(&job->part, layers + 1);
    const Outputs outputs = {
        &job->linear, NULL, {.comment = job->part.words, .isa = weft_isa(), .layers = layers, .layer_count = count}};
    return request_outputs_write(job->request, NULL, &outputs, error);
}

/* Returns the value of a word, and its length; NULL where there is no such key. */
static const char *word_value(const char *words, const char *key, size_t *length) {
    const size_t size = strlen(key);
    for (const char *at = words; at; at = strchr(at, ' ') ? strchr(at, ' ') + 1 : NULL)
        if (strncmp(at, key, size) == 0 && at[size] == '=') {
            *length = strcspn(at + size + 1, " ");
            return at + size + 1;
        }
    return NULL;
}

/* Reads `wanted` numbers of a word, with "," or "x" between; returns true if there are just so many. */
static bool word_numbers(const char *words, const char *key, int wanted, double *numbers) {
    size_t length;
    const char *value = word_value(words, key, &length);
    int found = 0;
    while (value && found < wanted) {
        char *end;
        numbers[found] = strtod(value, &end);
        if (end == value || !isfinite(numbers[found])) return false;
        found++;
        value = found < wanted ? *end == ',' || *end == 'x' ? end + 1 : NULL : *end && *end != ' ' ? NULL : end;
    }
    return value && found == wanted;
}

/* ---- merging */

/* A part that was read, without its pixels. */
typedef struct PartFile {
    const char *path;
    char *words; /* owned */
    int index, count;
} PartFile;

static WeftResult refuse(WeftError *error, WeftResult result, const char *path, const char *text) {
    char line[sizeof error->text];
    snprintf(line, sizeof line, "%.300s: %.200s", path, text);
    return failure(error, result, line);
}

static const char no_part[] = "is no part of a picture that weft render --chunk wrote";

/* Reads the picture of a part and its words. */
static WeftResult part_read(PartFile *part, WeftImage *image, WeftError *error) {
    double index[1], count[1], form[1];
    WeftResult result = weft_image_read_channels(part->path, picture_channels, 4, image, &part->words, error);
    if (result != WEFT_OK && error->message == WEFT_MESSAGE_IMAGE_UNSUPPORTED)
        return refuse(error, WEFT_INPUT, part->path, no_part);
    if (result != WEFT_OK) return result;
    if (!part->words || !word_numbers(part->words, "weft-part", 1, form) || form[0] < 1.0 || form[0] > 1.0 ||
        !word_numbers(part->words, "part", 1, index) || !word_numbers(part->words, "of", 1, count) ||
        !(count[0] >= 1.0 && count[0] <= CHUNKS_MOST && index[0] >= 1.0 && index[0] <= count[0]))
        return refuse(error, WEFT_INPUT, part->path, no_part);
    part->index = (int)index[0] - 1, part->count = (int)count[0];
    return WEFT_OK;
}

/* Compares what two parts say of their picture, word by word. */
static WeftResult part_compare(const PartFile *first, const PartFile *part, WeftError *error) {
    const char *a = first->words, *b = part->words;
    while (*a || *b) {
        const size_t m = strcspn(a, " "), n = strcspn(b, " ");
        if ((m != n || strncmp(a, b, m) != 0) && (strncmp(a, "part=", 5) != 0 || strncmp(b, "part=", 5) != 0)) {
            char text[200];
            snprintf(text, sizeof text, "is of another picture than %.60s: %.*s, and not %.*s", first->path,
                     (int)(n < 60 ? n : 60), b, (int)(m < 60 ? m : 60), a);
            return refuse(error, WEFT_USAGE, part->path, text);
        }
        a += m + (a[m] == ' ');
        b += n + (b[n] == ' ');
    }
    return WEFT_OK;
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
    WeftResult result = at ? WEFT_OK : refuse(error, WEFT_INPUT, part->path, no_part);
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

/* Adds one part to the picture. seen: CHUNKS_MOST paths by index of part. */
static WeftResult part_take(PartFile *part, PartFile *first, const char **seen, Request *request, Job *job,
                            WeftError *error) {
    WeftImage image = {0};
    char text[200];
    WeftResult result = part_read(part, &image, error);
    if (result == WEFT_OK && part == first) {
        result = words_take(part, request, job, error);
        if (result == WEFT_OK) result = size_check(part, job, &image, error);
        if (result == WEFT_OK)
            result = weft_image_create(job->width, job->height, 4, WEFT_PIXEL_F32, &job->linear, error);
    } else if (result == WEFT_OK) {
        result = part_compare(first, part, error);
        if (result == WEFT_OK) result = size_check(part, job, &image, error);
    }
    if (result == WEFT_OK && seen[part->index]) {
        snprintf(text, sizeof text, "is part %d of %d, as is %.100s", part->index + 1, part->count, seen[part->index]);
        result = refuse(error, WEFT_USAGE, part->path, text);
    }
    if (result == WEFT_OK) result = rows_take(part, &image, &job->linear, error);
    weft_image_free(&image);
    if (result == WEFT_OK) result = layers_take(part, part == first, job, error);
    if (result == WEFT_OK) seen[part->index] = part->path;
    return result;
}

/* Names the parts that are missing. */
static WeftResult missing_refuse(const char *const *seen, int count, WeftError *error) {
    char list[160] = "";
    int missing = 0;
    for (int k = 0; k < count; k++) {
        if (seen[k]) continue;
        const size_t used = strlen(list);
        if (used < sizeof list - 24)
            snprintf(list + used, sizeof list - used, "%s%d", missing ? ", " : "", k + 1);
        else if (strcmp(list + used - 3, "...") != 0)
            snprintf(list + used, sizeof list - used, ", ...");
        missing++;
    }
    if (!missing) return WEFT_OK;
    char line[300];
    snprintf(line, sizeof line, "merge: of %d parts %d %s missing: %s", count, missing, missing > 1 ? "are" : "is",
             list);
    return failure(error, WEFT_USAGE, line);
}

WeftResult picture_parts_read(const char *const *paths, int count, Request *request, Job *job, WeftError *error) {
    static const char *seen[CHUNKS_MOST];
    PartFile first = {.path = paths[0]};
    memset(seen, 0, sizeof seen);
    WeftResult result = part_take(&first, &first, seen, request, job, error);
    for (int k = 1; k < count && result == WEFT_OK; k++) {
        PartFile part = {.path = paths[k]};
        result = part_take(&part, &first, seen, request, job, error);
        free(part.words);
    }
    if (result == WEFT_OK) result = missing_refuse(seen, first.count, error);
    free(first.words);
    return result;
}
