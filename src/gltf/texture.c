#include "gltf/texture.h"

#include <pthread.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/fail.h"
#include "base/file.h"
#include "base/thread.h"
#include "gltf/buffer.h"
#include "gltf/field.h"
#include "gltf/uri.h"

/* The image a texture names: its plain source. A container that cannot be read here is only an offer. */
static int source_read(const Field *field) {
    static const char *const offers[] = {"KHR_texture_basisu", "EXT_texture_webp", "EXT_texture_avif",
                                         "MSFT_texture_dds"};
    Field source = field_member(field, "source");
    for (size_t i = 0; i < sizeof offers / sizeof *offers; i++) {
        Field offer = field_extension(field, offers[i]);
        if (offer.json)
            field_warn(field, WEFT_MESSAGE_GLTF_WARN_IGNORED, "%s, %s", offers[i],
                       source.json ? "its plain source is used"
                                   : "which leaves the texture without an image");
    }
    return field_index(&source, field->asset->image_count);
}

void textures_read(Asset *asset) {
    Field root = field_root(asset), images = field_member(&root, "images"),
          samplers = field_member(&root, "samplers"), list = field_member(&root, "textures");
    asset->image_count = field_count(&images);
    for (size_t i = 0; i < asset->image_count; i++) {
        Field field = field_element(&images, i), view = field_member(&field, "bufferView"),
              uri = field_member(&field, "uri");
        field_index(&view, asset->view_count);
        field_text(&uri, NULL);
    }
    asset->sampler_count = field_count(&samplers);
    for (size_t i = 0; i < asset->sampler_count; i++) {
        Field field = field_element(&samplers, i);
        field_member(&field, "wrapS");
    }
    asset->texture_count = field_count(&list);
    asset->textures = asset_array(asset, &asset->arena, asset->texture_count, sizeof *asset->textures);
    for (size_t i = 0; i < asset->texture_count && asset->result == WEFT_OK; i++) {
        Field field = field_element(&list, i), sampler = field_member(&field, "sampler");
        asset->textures[i] = (TextureSource){.image = source_read(&field),
                                             .sampler = field_index(&sampler, asset->sampler_count),
                                             .scene_texture = -1};
    }
}

static Wrap wrap_read(const Field *field) {
    enum { CLAMP_TO_EDGE = 33071, MIRRORED_REPEAT = 33648, REPEAT = 10497 };
    size_t value = field_size(field, REPEAT, 0, SIZE_MAX);
    switch (value) {
    case CLAMP_TO_EDGE: return WRAP_CLAMP;
    case MIRRORED_REPEAT: return WRAP_MIRROR;
    case REPEAT: return WRAP_REPEAT;
    default: field_fail(field, WEFT_MESSAGE_GLTF_SCHEMA, "%zu is not a wrapping mode", value);
    }
    return WRAP_REPEAT;
}

static void sampler_read(Asset *asset, int index, Texture *texture) {
    enum { NEAREST = 9728 };
    if (index < 0) return;
    Field root = field_root(asset), list = field_member(&root, "samplers"),
          field = field_element(&list, (size_t)index), wrap_s = field_member(&field, "wrapS"),
          wrap_t = field_member(&field, "wrapT"), filter = field_member(&field, "magFilter");
    texture->wrap_u = wrap_read(&wrap_s);
    texture->wrap_v = wrap_read(&wrap_t);
    texture->nearest = field_size(&filter, 0, 0, SIZE_MAX) == NEAREST;
}

/* One image to decode, and what came of it. */
typedef struct Job {
    struct Jobs *jobs;
    const char *path; /* of a file, or NULL */
    Span bytes;       /* otherwise */
    unsigned char *owned;
    const char *name; /* subject of messages */
    WeftImage *image;
    WeftResult result;
    WeftError error;
} Job;

typedef struct Jobs {
    Asset *asset;
    Job *items;
    int count;
    pthread_mutex_t log_lock;       /* a log is never called by two threads at once */
    atomic_size_t encoded, decoded; /* bytes */
} Jobs;

static void log_locked(void *user, WeftMessage message, const char *text) {
    Jobs *jobs = user;
    const WeftLog *log = jobs->asset->log;
    if (!log || !log->fn) return;
    pthread_mutex_lock(&jobs->log_lock);
    log->fn(log->user, message, text);
    pthread_mutex_unlock(&jobs->log_lock);
}

/* All images together may hold this many times the bytes of their files, or the floor where that is less: a
 * plain 8192 x 8192 PNG is 200 kB. */
static const size_t IMAGE_FILE_MAX = (size_t)1 << 30, IMAGES_EXPANSION = 64, IMAGES_LOW = (size_t)768 << 20;

static size_t pixel_bytes(const WeftImage *image) {
    size_t size = image->type == WEFT_PIXEL_U8 ? 1 : image->type == WEFT_PIXEL_U16 ? 2 : 4;
    return (size_t)image->width * (size_t)image->height * (size_t)image->channels * size;
}

static void decode(void *user, int item, int thread) {
    (void)thread;
    Jobs *jobs = user;
    Job *job = &jobs->items[item];
    const WeftLog log = {log_locked, jobs};
    FileBytes file = {0};
    Span bytes = job->bytes;
    if (job->path) {
        job->result = file_read(job->path, IMAGE_FILE_MAX, &file, &job->error);
        bytes = (Span){file.data, file.size};
    }
    size_t encoded = atomic_fetch_add(&jobs->encoded, bytes.size) + bytes.size;
    size_t room = encoded * IMAGES_EXPANSION > IMAGES_LOW ? encoded * IMAGES_EXPANSION : IMAGES_LOW;
    if (job->result == WEFT_OK && atomic_load(&jobs->decoded) > room)
        job->result = fail(&job->error, WEFT_MESSAGE_GLTF_TOO_LARGE, job->name,
                           "the images decode to more than %zu bytes", room);
    if (job->result == WEFT_OK)
        job->result =
            weft_image_read_memory(bytes.data, bytes.size, job->name, job->image, &log, &job->error);
    if (job->result == WEFT_OK) atomic_fetch_add(&jobs->decoded, pixel_bytes(job->image));
    free(file.data);
}

/* What messages call image number index: its file, or the asset's name and its place there. */
static const char *job_name(Asset *asset, int index) {
    size_t size = strlen(asset->name) + 32;
    char *name = asset_array(asset, &asset->arena, size, 1);
    if (name) snprintf(name, size, "%s: images[%d]", asset->name, index);
    return name;
}

static void job_prepare(Asset *asset, int index, Job *job) {
    Field root = field_root(asset), list = field_member(&root, "images"),
          field = field_element(&list, (size_t)index), view_field = field_member(&field, "bufferView"),
          uri_field = field_member(&field, "uri");
    const char *uri = field_text(&uri_field, NULL);
    int view = field_index(&view_field, asset->view_count);
    job->name = job_name(asset, index);
    if (uri && uri_is_data(uri)) {
        job->bytes.data = job->owned = uri_decode(&uri_field, uri, &job->bytes.size);
    } else if (uri) {
        job->path = uri_path(&uri_field, uri);
        job->name = job->path;
    } else if (view >= 0) {
        job->bytes = view_bytes(asset, view);
    } else {
        field_fail(&field, WEFT_MESSAGE_GLTF_SCHEMA, "it has neither uri nor bufferView");
    }
}

static void images_decode(Asset *asset, Jobs *jobs, const int *sources) {
    for (int i = 0; i < jobs->count && asset->result == WEFT_OK; i++) {
        jobs->items[i] = (Job){.image = &asset->scene->images[i]};
        job_prepare(asset, sources[i], &jobs->items[i]);
    }
    if (asset->result == WEFT_OK) parallel_for(0, jobs->count, decode, jobs);
    for (int i = 0; i < jobs->count; i++) {
        const Job *job = &jobs->items[i];
        free(job->owned);
        if (asset->result != WEFT_OK || job->result == WEFT_OK) continue;
        asset->result = job->result;
        if (asset->error) *asset->error = job->error;
    }
}

/* The scene texture for a glTF texture, made when first asked for; 0 or its index + 1, as in Input. */
static int texture_resolve(Asset *asset, int texture, int *image_of_source, int *sources) {
    WeftScene *scene = asset->scene;
    TextureSource *source = &asset->textures[texture];
    if (source->image < 0) return 0;
    if (source->scene_texture < 0) {
        int *image = &image_of_source[source->image];
        if (*image < 0) {
            *image = scene->image_count++;
            sources[*image] = source->image;
        }
        source->scene_texture = scene->texture_count++;
        scene->textures[source->scene_texture] = (Texture){.image = *image};
        sampler_read(asset, source->sampler, &scene->textures[source->scene_texture]);
    }
    return source->scene_texture + 1;
}

void textures_resolve(Asset *asset) {
    WeftScene *scene = asset->scene;
    scene->textures = asset_array(asset, &scene->arena, asset->texture_count, sizeof *scene->textures);
    scene->images = asset_array(asset, &scene->arena, asset->image_count, sizeof *scene->images);
    int *image_of_source = asset_array(asset, &asset->arena, asset->image_count, sizeof(int));
    int *sources = asset_array(asset, &asset->arena, asset->image_count, sizeof(int));
    if (asset->result != WEFT_OK) return;
    for (size_t i = 0; i < asset->image_count; i++) image_of_source[i] = -1;

    for (int m = 0; m < scene->material_count; m++)
        for (int i = 0; i < INPUT_COUNT; i++) {
            int *texture = &scene->materials[m].inputs[i].texture;
            if (*texture && asset->material_shown[m])
                *texture = texture_resolve(asset, *texture - 1, image_of_source, sources);
            else
                *texture = 0;
        }

    Jobs jobs = {.asset = asset, .count = scene->image_count};
    jobs.items = asset_array(asset, &asset->arena, (size_t)jobs.count, sizeof *jobs.items);
    if (!jobs.items || pthread_mutex_init(&jobs.log_lock, NULL) != 0) {
        asset_fail(asset, WEFT_MESSAGE_MEMORY, NULL);
        return;
    }
    images_decode(asset, &jobs, sources);
    pthread_mutex_destroy(&jobs.log_lock);
}
