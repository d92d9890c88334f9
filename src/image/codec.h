/* codec.h - the file formats of images: each reads from memory, some write to a stream
 *
 * A reader leaves *out untouched or zeroed on failure, never half filled. It refuses a size that the file
 * cannot hold (image_check_header) before it allocates. */
#ifndef WEFT_IMAGE_CODEC_H
#define WEFT_IMAGE_CODEC_H

#include <stdio.h>

#include "weft/image.h"

/* A whole file in memory. */
typedef struct ImageSource {
    const unsigned char *data;
    size_t size;
    const char *name; /* the subject of errors and warnings */
    const WeftLog *log;
} ImageSource;

enum { IMAGE_SIDE_MAX = 65536 };

/* The media type of an image by its first bytes, as glTF or one of its extensions has it; NULL: they have
 * none. */
const char *image_media_type(const unsigned char *data, size_t size);

/* Refuses (WEFT_MESSAGE_IMAGE_SIZE) sides outside 1 .. IMAGE_SIDE_MAX and more bytes of memory than are
 * believed of a file of this size: 512 MiB, more only for a file of at least a sixteenth of it, never above 2
 * GiB. So a small hostile file cannot ask for much, and a large honest one is read. */
WeftResult image_check_header(const ImageSource *source, int64_t width, int64_t height,
                              int64_t bytes_per_pixel, WeftError *error);

/* Refuses (WEFT_MESSAGE_IMAGE_SIZE) a file smaller than the fewest bytes its pixels can be coded in. */
WeftResult image_reachable(const ImageSource *source, int64_t fewest_bytes, WeftError *error);

/* Sets values of an F32 image that are not finite to 0, with one warning that counts them. */
void image_repair(const ImageSource *source, WeftImage *image);

WeftResult image_read_png(const ImageSource *source, WeftImage *out, WeftError *error);
WeftResult image_read_jpeg(const ImageSource *source, WeftImage *out, WeftError *error);
WeftResult image_read_tga(const ImageSource *source, WeftImage *out, WeftError *error);
WeftResult image_read_hdr(const ImageSource *source, WeftImage *out, WeftError *error);
WeftResult image_read_exr(const ImageSource *source, WeftImage *out, WeftError *error);
WeftResult image_read_npy(const ImageSource *source, WeftImage *out, WeftError *error);

/* The image is of a type the format takes; name is the subject of errors. */
WeftResult image_write_png(FILE *stream, const char *name, const WeftImage *image,
                           const WeftImageWriting *how, WeftError *error);
WeftResult image_write_hdr(FILE *stream, const char *name, const WeftImage *image,
                           const WeftImageWriting *how, WeftError *error);
WeftResult image_write_exr(FILE *stream, const char *name, const WeftImage *image,
                           const WeftImageWriting *how, WeftError *error);
WeftResult image_write_npy(FILE *stream, const char *name, const WeftImage *image,
                           const WeftImageWriting *how, WeftError *error);

#endif
