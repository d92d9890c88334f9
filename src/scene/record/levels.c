#include "scene/record/levels.h"

#include <stdlib.h>
#include <string.h>

#include "base/fail.h"
#include "base/file.h"
#include "base/memory.h"
#include "image/halve.h"
#include "image/ktx2/ktx2.h"

/* Reads a level after the first. Returns NULL, or why it cannot be used: it is not whole, or not half of the one before and
 * of its kind. */
static const char *level_read(const Ktx2 *file, int level, const WeftImage *before, WeftImage *out) {
    WeftError why;
    if (ktx2_picture(file, level, 0, out, &why) != WEFT_OK) return weft_message_text(why.message);
    return out->width == halved(before->width) && out->height == halved(before->height) &&
                   out->channels == before->channels && out->type == before->type
               ? NULL
               : "is not half of the one before";
}

/* Reads all levels of a file that has as many as the picture halves. Returns NULL, with a warning, unless they are whole. */
static TextureLevels *levels_of(const Ktx2 *file, const WeftImage *picture, const WeftLog *log) {
    const ImageSource *source = file->source;
    int count = 0;
    for (int w = picture->width, h = picture->height; w > 1 || h > 1; w = halved(w), h = halved(h)) count++;
    if (!count || (uint32_t)count + 1 > file->levels) return NULL;
    TextureLevels *levels = alloc_array(1, sizeof *levels);
    if (!levels) return NULL;
    levels->images = alloc_array((size_t)count, sizeof *levels->images);
    levels->file = alloc_array(source->size, 1);
    levels->size = source->size;
    const bool room = levels->images && levels->file;
    const char *why = NULL;
    for (; room && !why && levels->count < count; levels->count++)
        why = level_read(file, levels->count + 1, levels->count ? &levels->images[levels->count - 1] : picture,
                         &levels->images[levels->count]);
    if (room && !why) {
        memcpy(levels->file, source->data, source->size);
        return levels;
    }
    warn(log, WEFT_MESSAGE_IMAGE_REPAIRED, source->name, "mip level %d %s; means of the picture are drawn in its place",
         levels->count, room ? why : weft_message_text(WEFT_MESSAGE_MEMORY));
    levels_free(levels);
    return NULL;
}

WeftResult levels_decode(const void *data, size_t size, const char *name, WeftImage *out, TextureLevels **levels,
                         const WeftLog *log, WeftError *error) {
    const ImageSource source = {.data = data, .size = size, .name = name};
    Ktx2 file;
    *levels = NULL;
    const WeftResult result = weft_image_read_memory(data, size, name, out, log, error);
    if (result == WEFT_OK && ktx2_starts(data, size) && ktx2_open(&source, &file, NULL) == WEFT_OK)
        *levels = levels_of(&file, out, log);
    return result;
}

WeftResult levels_read(const char *path, WeftImage *out, TextureLevels **levels, const WeftLog *log, WeftError *error) {
    FileBytes file;
    *out = (WeftImage){0};
    *levels = NULL;
    WeftResult result = file_read(path, (size_t)1 << 30, &file, error);
    if (result != WEFT_OK) return result;
    result = levels_decode(file.data, file.size, path, out, levels, log, error);
    free(file.data);
    return result;
}

void levels_free(TextureLevels *levels) {
    if (!levels) return;
    for (int k = 0; k < levels->count; k++) weft_image_free(&levels->images[k]);
    free(levels->images);
    free(levels->file);
    free(levels);
}
