/* texture.c - reads textures and samplers, and decodes the images of those that are used */
#include "gltf/read/gltf_texture.h"

#include <pthread.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/fail.h"
#include "base/thread.h"
#include "gltf/asset/asset_file.h"
#include "gltf/asset/buffer_views.h"
#include "gltf/asset/extent.h"
#include "gltf/asset/field.h"
#include "gltf/asset/uri.h"
#include "gltf/read/glossiness.h"

/* The extensions by which a texture names a picture of another format, and whether that is read here. */
static const struct {
    const char *extension;
    bool read;
} offers[] = {
    {"EXT_texture_webp", true},
    {"KHR_texture_basisu", true},
    {"EXT_texture_avif", false},
    {"MSFT_texture_dds", false},
};
enum { OFFERS = sizeof offers / sizeof *offers };

bool texture_extension_read(const char *extension) {
    for (size_t i = 0; i < OFFERS; i++)
        if (strcmp(extension, offers[i].extension) == 0) return offers[i].read;
    return false;
}

/* Reads what a texture names: the picture of the first extension whose format is read, else its plain source.
 * Extensions with other formats are passed over with a warning; where nothing else is named the warning comes from the
 * material that has the texture. */
static TextureSource source_read(const Field *field) {
    Field source = field_member(field, "source"), sampler = field_member(field, "sampler");
    TextureSource texture = {
        .image = -1, .spare = -1, .sampler = field_index(&sampler, field->asset->sampler_count), .scene_texture = -1};
    const int plain = field_index(&source, field->asset->image_count);
    for (size_t i = 0; i < OFFERS; i++) {
        Field offer = field_extension(field, offers[i].extension), offered = field_member(&offer, "source");
        if (!offer.json) continue;
        if (offers[i].read && texture.image < 0) {
            texture.image = field_needed_index(&offered, field->asset->image_count);
        } else if (!offers[i].read) {
            texture.offer = offers[i].extension;
            if (source.json)
                field_warn(field, WEFT_MESSAGE_GLTF_WARN_IGNORED, "%s, its plain source is used", texture.offer);
        }
    }
    texture.spare = texture.image < 0 || texture.image == plain ? -1 : plain;
    if (texture.image < 0) texture.image = plain;
    return texture;
}

/* Returns the place of a number among values, which ends with 0. An absent field reads as the first, and any other
 * number too, with a warning. */
static int constant_read(const Field *field, const size_t *values) {
    const size_t value = field_size(field, values[0], 0, SIZE_MAX);
    for (int k = 0; values[k]; k++)
        if (values[k] == value) return k;
    field_warn(field, WEFT_MESSAGE_GLTF_WARN_REPAIRED, "%zu is no value of glTF's; it is taken as %zu", value,
               values[0]);
    return 0;
}

static Texture sampler_read(const Field *field) {
    static const size_t wraps[] = {10497, 33648, 33071, 0}; /* as TextureWrap */
    static const size_t mags[] = {9729, 9728, 0}, mins[] = {9729, 9728, 9984, 9985, 9986, 9987, 0};
    static const char *const keys[] = {"wrapS", "wrapT",      "magFilter", "minFilter",
                                       "name",  "extensions", "extras",    NULL};
    Field wrap_s = field_member(field, "wrapS"), wrap_t = field_member(field, "wrapT"),
          mag = field_member(field, "magFilter"), min = field_member(field, "minFilter");
    const int minified = constant_read(&min, mins); /* absent: as the renderer likes */
    field_keys(field, keys);
    return (Texture){.wrap_u = (TextureWrap)constant_read(&wrap_s, wraps),
                     .wrap_v = (TextureWrap)constant_read(&wrap_t, wraps),
                     .nearest = constant_read(&mag, mags) == 1,
                     .single = min.json && minified < 2};
}

void textures_read(Asset *asset) {
    Field root = field_root(asset), images = field_member(&root, "images"), samplers = field_member(&root, "samplers"),
          list = field_member(&root, "textures");
    asset->image_count = field_count(&images);
    for (size_t i = 0; i < asset->image_count; i++) {
        Field field = field_element(&images, i), view = field_member(&field, "bufferView"),
              uri = field_member(&field, "uri");
        field_index(&view, asset->view_count);
        field_text(&uri, NULL);
    }
    asset->sampler_count = field_count(&samplers);
    asset->samplers = asset_array(asset, &asset->arena, asset->sampler_count, sizeof *asset->samplers);
    for (size_t i = 0; i < asset->sampler_count && asset->result == WEFT_OK; i++) {
        Field field = field_element(&samplers, i);
        asset->samplers[i] = sampler_read(&field);
    }
    asset->texture_count = field_count(&list);
    asset->textures = asset_array(asset, &asset->arena, asset->texture_count, sizeof *asset->textures);
    for (size_t i = 0; i < asset->texture_count && asset->result == WEFT_OK; i++) {
        Field field = field_element(&list, i);
        asset->textures[i] = source_read(&field);
    }
}

/* One image to decode, and the result. */
typedef struct DecodeJob {
    Span bytes;
    unsigned char *owned;
    TextureLevels *levels; /* owned until textures have them */
    const char *name;      /* named in messages */
    const char *path;      /* NULL: no file of its own */
    int image;             /* number of the image in the file */
    bool spared;           /* each texture that has it has a plain picture beside it */
    WeftResult result;     /* of finding its bytes, then of decoding them */
    WeftError error;
} DecodeJob;

typedef struct Jobs {
    Asset *asset;
    DecodeJob *items;         /* one for each image of the scene */
    int first;                /* the first image that is to be decoded */
    int *order;               /* of the images: the longest file first, so that it does not end last */
    pthread_mutex_t log_lock; /* a log is never called by two threads at once */
    atomic_size_t decoded;    /* bytes of files */
    size_t encoded;           /* of all files */
    atomic_bool stopped;
} Jobs;

/* Hands a line about an image of the file to the asset's log. */
static void image_log(Asset *asset, int image, WeftMessage message, const char *text) {
    if (!asset->log || !asset->log->fn) return;
    Field root = field_root(asset), list = field_member(&root, "images"), field = field_element(&list, (size_t)image);
    asset->place = &field;
    asset->log->fn(asset->log->user, message, text);
    asset->place = NULL;
}

/* An image that a thread decodes, as the receiver of its warnings. */
typedef struct Listener {
    Jobs *jobs;
    int image;
} Listener;

static void log_locked(void *user, WeftMessage message, const char *text) {
    const Listener *listener = user;
    pthread_mutex_lock(&listener->jobs->log_lock);
    image_log(listener->jobs->asset, listener->image, message, text);
    pthread_mutex_unlock(&listener->jobs->log_lock);
}

static void decode(void *user, int place, int thread) {
    Jobs *jobs = user;
    const int item = jobs->order[jobs->first + place];
    DecodeJob *job = &jobs->items[item];
    Listener listener = {jobs, job->image};
    const WeftLog log = {log_locked, &listener};
    if (atomic_load(&jobs->stopped) || job->result != WEFT_OK) return;
    job->result = levels_decode(job->bytes.data, job->bytes.size, job->name, &jobs->asset->scene->images[item],
                                &job->levels, &log, &job->error);
    size_t decoded = atomic_fetch_add(&jobs->decoded, job->bytes.size) + job->bytes.size;
    if (thread == 0 && !asset_progress(jobs->asset, 0.5, 1.0, decoded, jobs->encoded))
        atomic_store(&jobs->stopped, true); /* the others finish what they have begun */
}

/* Fails if the images together decode to more than `expansion` times the bytes of their files, or than the
 * floor if that is more: a blank 8192 x 8192 PNG has 200 kB. The sizes come from the headers, before the
 * first image is decoded. */
static void sizes_check(Jobs *jobs) {
    const size_t expansion = 64, floor = (size_t)768 << 20;
    Asset *asset = jobs->asset;
    size_t encoded = 0, decoded = 0;
    for (int i = 0; i < asset->scene->image_count; i++) {
        encoded += jobs->items[i].bytes.size;
        decoded += extent_bytes(jobs->items[i].bytes);
    }
    jobs->encoded = encoded;
    size_t allowed = encoded * expansion > floor ? encoded * expansion : floor;
    if (decoded > allowed)
        asset_fail(asset, WEFT_MESSAGE_GLTF_TOO_LARGE, "its images decode to %zu bytes, more than %zu", decoded,
                   allowed);
}

static void order_find(Jobs *jobs, int first) {
    for (int i = first; i < jobs->asset->scene->image_count; i++) {
        int at = i;
        for (; at > first && jobs->items[jobs->order[at - 1]].bytes.size < jobs->items[i].bytes.size; at--)
            jobs->order[at] = jobs->order[at - 1];
        jobs->order[at] = i;
    }
}

/* Says why a picture cannot be read and, to whom the asset is shown, what becomes of its textures. */
static void image_unread(Asset *asset, const DecodeJob *job) {
    char line[sizeof job->error.text + 64];
    snprintf(line, sizeof line, "%s%s", job->error.text,
             asset->examined ? ""
             : job->spared   ? "; the plain picture beside it is shown"
                             : "; its textures are left out");
    image_log(asset, job->image, job->error.message, line);
}

/* Decodes the images of the scene from the first of these on. */
static void images_decode(Jobs *jobs, int first) {
    Asset *asset = jobs->asset;
    const int count = asset->scene->image_count;
    jobs->first = first;
    sizes_check(jobs);
    order_find(jobs, first);
    if (asset->result == WEFT_OK) parallel_for(0, count - first, decode, jobs);
    for (int i = first; i < count && asset->result == WEFT_OK; i++) {
        const DecodeJob *job = &jobs->items[i];
        if (job->result == WEFT_INPUT) {
            image_unread(asset, job);
            continue;
        }
        asset->result = job->result;
        if (asset->result != WEFT_OK && asset->error) *asset->error = job->error;
    }
}

/* Gives textures the mip levels that their files have of their own. */
static void levels_take(Jobs *jobs) {
    WeftScene *scene = jobs->asset->scene;
    for (int i = 0; i < scene->image_count; i++) {
        textures_put_levels(scene->textures, scene->texture_count, i, jobs->items[i].levels);
        jobs->items[i].levels = NULL;
    }
}

/* Returns the name of image number index in messages: its file, or the asset's name and the place in it. */
static const char *image_name(Asset *asset, int index) {
    size_t size = strlen(asset->name) + 32;
    char *name = asset_array(asset, &asset->arena, size, 1);
    if (name) snprintf(name, size, "%s: images[%d]", asset->name, index);
    return name;
}

/* Goes on after an image whose bytes cannot be read. An asset that breaks glTF's rules is forgiven only while it is
 * examined. */
static void image_excuse(Asset *asset, DecodeJob *job, WeftError *error) {
    const bool rules = error->message == WEFT_MESSAGE_GLTF_SCHEMA || error->message == WEFT_MESSAGE_GLTF_REFERENCE ||
                       error->message == WEFT_MESSAGE_GLTF_BOUNDS || error->message == WEFT_MESSAGE_GLTF_TOO_LARGE;
    if (asset->result == WEFT_INPUT && (asset->examined || !rules)) {
        job->result = asset->result;
        job->error = *error;
        asset->result = WEFT_OK;
    } else if (asset->result != WEFT_OK && asset->error) {
        *asset->error = *error;
    }
}

/* Returns the scene's image for glTF image number index: that of its view or file if they have one already. */
static int image_resolve(Jobs *jobs, int index) {
    Asset *asset = jobs->asset;
    Field root = field_root(asset), list = field_member(&root, "images"), field = field_element(&list, (size_t)index),
          view_field = field_member(&field, "bufferView"), uri_field = field_member(&field, "uri");
    const char *uri = field_text(&uri_field, NULL);
    int view = field_index(&view_field, asset->view_count), none = 0, *made = &none;
    WeftError why = {0}, *const told = asset->error;
    asset->error = &why;
    DecodeJob job = {.name = image_name(asset, index), .image = index, .spared = true};
    if (uri && uri_is_data(uri)) {
        job.bytes.data = job.owned = uri_decode(&uri_field, uri, &job.bytes.size);
    } else if (uri) {
        AssetFile *file = file_refer(&asset->image_files, &uri_field, uri, SIZE_MAX);
        if (file) {
            job.bytes = file_bytes(&asset->image_files, asset, file);
            job.name = job.path = file->path;
            made = &file->image;
        }
    } else if (view >= 0) {
        job.bytes = view_bytes(asset, view);
        made = &asset->views[view].image;
    } else {
        field_fail(&field, WEFT_MESSAGE_GLTF_SCHEMA, "it has neither uri nor bufferView");
    }
    asset->error = told;
    image_excuse(asset, &job, &why);
    if (!*made) {
        jobs->items[asset->scene->image_count] = job;
        *made = ++asset->scene->image_count;
    }
    return *made - 1;
}

/* Returns one of the materials as seen from the front, or after those one as seen from behind: NULL if it has no back of its
 * own. */
static Material *side(const Asset *asset, int k) {
    const int m = k - asset->scene->material_count;
    if (m < 0) return &asset->scene->materials[k];
    return asset->backs[m];
}

/* Takes out the images without pixels, the textures that have them, and what inputs read of those. */
static void unread_drop(Asset *asset) {
    WeftScene *scene = asset->scene;
    int *image_place = asset_array(asset, &asset->arena, (size_t)scene->image_count, sizeof(int));
    int *texture_place = asset_array(asset, &asset->arena, (size_t)scene->texture_count, sizeof(int));
    int images = 0, textures = 0;
    if (asset->result != WEFT_OK) return;
    for (int i = 0; i < scene->image_count; i++) {
        image_place[i] = scene->images[i].pixels ? images : -1;
        if (scene->images[i].pixels) scene->images[images++] = scene->images[i];
    }
    for (int t = 0; t < scene->texture_count; t++) {
        const int place = image_place[scene->textures[t].image];
        texture_place[t] = place < 0 ? -1 : textures;
        if (place < 0) continue;
        scene->textures[textures] = scene->textures[t];
        scene->textures[textures++].image = place;
    }
    scene->image_count = images;
    scene->texture_count = textures;
    for (int m = 0; m < 2 * scene->material_count; m++) {
        Material *material = side(asset, m);
        for (int i = 0; i < INPUT_COUNT && material; i++) {
            int *texture = &material->inputs[i].texture;
            if (*texture) *texture = texture_place[*texture - 1] + 1;
        }
    }
}

/* Returns the scene texture for a glTF texture, made on first use: 0 or its index + 1, as in Input. */
static int texture_resolve(Jobs *jobs, int texture, int *image_of_source) {
    Asset *asset = jobs->asset;
    WeftScene *scene = asset->scene;
    TextureSource *source = &asset->textures[texture];
    if (source->image < 0) return 0;
    if (source->scene_texture < 0) {
        source->scene_texture = scene->texture_count++;
        Texture *made = &scene->textures[source->scene_texture];
        int *image = &image_of_source[source->image];
        if (source->sampler >= 0) *made = asset->samplers[source->sampler];
        if (*image < 0) *image = image_resolve(jobs, source->image);
        made->image = *image;
        if (jobs->items[*image].path) made->path = asset_text(asset, jobs->items[*image].path);
        jobs->items[*image].spared &= source->spare >= 0;
    }
    return source->scene_texture + 1;
}

/* Gives the textures whose picture cannot be read the plain one that lies beside it, and decodes that. */
static void spares_take(Jobs *jobs, int *image_of_source) {
    Asset *asset = jobs->asset;
    const int decoded = asset->scene->image_count;
    for (size_t i = 0; i < asset->texture_count && asset->result == WEFT_OK; i++) {
        TextureSource *source = &asset->textures[i];
        if (source->scene_texture < 0 || source->spare < 0) continue;
        Texture *texture = &asset->scene->textures[source->scene_texture];
        if (jobs->items[texture->image].result == WEFT_OK) continue;
        int *image = &image_of_source[source->spare];
        if (*image < 0) *image = image_resolve(jobs, source->spare);
        jobs->items[*image].spared = false;
        texture->image = *image;
        texture->path = jobs->items[*image].path ? asset_text(asset, jobs->items[*image].path) : NULL;
    }
    if (asset->result == WEFT_OK && asset->scene->image_count > decoded) images_decode(jobs, decoded);
}

void textures_resolve(Asset *asset) {
    WeftScene *scene = asset->scene;
    Jobs jobs = {.asset = asset};
    jobs.items = asset_array(asset, &asset->arena, asset->image_count, sizeof *jobs.items);
    jobs.order = asset_array(asset, &asset->arena, asset->image_count, sizeof *jobs.order);
    const size_t more = glossiness_count(scene);
    scene->textures = asset_array(asset, &scene->arena, asset->texture_count + more, sizeof *scene->textures);
    scene->images = asset_array(asset, &scene->arena, asset->image_count + more, sizeof *scene->images);
    int *image_of_source = asset_array(asset, &asset->arena, asset->image_count, sizeof(int));
    if (asset->result != WEFT_OK) return;
    for (size_t i = 0; i < asset->image_count; i++) image_of_source[i] = -1;

    for (int m = 0; m < 2 * scene->material_count; m++)
        for (int i = 0; i < INPUT_COUNT && asset->result == WEFT_OK && side(asset, m); i++) {
            int *texture = &side(asset, m)->inputs[i].texture;
            if (*texture && (asset->material_shown[m % scene->material_count] || asset->examined))
                *texture = texture_resolve(&jobs, *texture - 1, image_of_source);
            else
                *texture = 0;
        }

    if (asset->result == WEFT_OK && pthread_mutex_init(&jobs.log_lock, NULL) != 0)
        asset_fail(asset, WEFT_MESSAGE_MEMORY, NULL);
    if (asset->result == WEFT_OK) {
        images_decode(&jobs, 0);
        if (asset->result == WEFT_OK && !asset->examined) spares_take(&jobs, image_of_source);
        if (asset->result == WEFT_OK) levels_take(&jobs);
        pthread_mutex_destroy(&jobs.log_lock);
    }
    for (int i = 0; i < scene->image_count; i++) {
        levels_free(jobs.items[i].levels);
        free(jobs.items[i].owned);
    }
    if (asset->result == WEFT_OK && !asset->examined) unread_drop(asset);
    files_free(&asset->image_files);
    glossiness_end(asset);
}
