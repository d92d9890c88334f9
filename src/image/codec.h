/* codec.h - the file formats of images: all are read from memory, some are written to a stream
 *
 * A reader leaves *out unchanged or zeroed on failure. Before it allocates, it refuses a size that the file cannot
 * contain (image_check_header). */
#pragma once

#include <stdbool.h>
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

/* Returns the media type of an image by its first bytes, as in glTF and its extensions; NULL for a format that they do
 * not have. */
const char *image_media_type(const unsigned char *data, size_t size);

/* Returns true if the suffix of a path is that of pictures that are read: .png .jpg .jpeg .webp .tga .hdr .exr .ktx2,
 * and .tif .tiff where libtiff is. */
bool image_suffix_read(const char *path);

/* Refuses (WEFT_MESSAGE_IMAGE_SIZE) sides outside 1 .. IMAGE_SIDE_MAX and images that are implausibly large for the
 * file: above 512 MiB of memory if the file has less than a sixteenth of that memory, and above 2 GiB always. A small
 * hostile file cannot request much memory, and a large valid one is read. */
WeftResult image_check_header(const ImageSource *source, int64_t width, int64_t height, int64_t bytes_per_pixel,
                              WeftError *error);

/* Refuses (WEFT_MESSAGE_IMAGE_SIZE) a file that is smaller than the least encoding of its pixels. */
WeftResult image_reachable(const ImageSource *source, int64_t fewest_bytes, WeftError *error);

/* Sets values of an F32 image that are not finite to 0, with one warning that counts them. */
void image_repair(const ImageSource *source, WeftImage *image);

WeftResult image_read_png(const ImageSource *source, WeftImage *out, WeftError *error);
WeftResult image_read_jpeg(const ImageSource *source, WeftImage *out, WeftError *error);
WeftResult image_read_webp(const ImageSource *source, WeftImage *out, WeftError *error);
WeftResult image_read_tga(const ImageSource *source, WeftImage *out, WeftError *error);
WeftResult image_read_hdr(const ImageSource *source, WeftImage *out, WeftError *error);
WeftResult image_read_exr(const ImageSource *source, WeftImage *out, WeftError *error);

/* Reads channels of an OpenEXR file by name, as weft_image_read_channels does. */
WeftResult image_read_exr_channels(const ImageSource *source, const char *const *channels, int count, WeftImage *out,
                                   char **comment, WeftError *error);
WeftResult image_read_dds(const ImageSource *source, WeftImage *out, WeftError *error);
WeftResult image_read_tiff(const ImageSource *source, WeftImage *out, WeftError *error); /* where libtiff is */

/* Reads level 0 of a KTX 2 file: the first face of the first layer, with a warning where there are more. */
WeftResult image_read_ktx2(const ImageSource *source, WeftImage *out, WeftError *error);
WeftResult image_read_npy(const ImageSource *source, WeftImage *out, WeftError *error);

/* Writes an image whose pixel type the format supports; name is the subject of errors. */
WeftResult image_write_png(FILE *stream, const char *name, const WeftImage *image, const WeftImageWriting *how,
                           WeftError *error);
WeftResult image_write_hdr(FILE *stream, const char *name, const WeftImage *image, const WeftImageWriting *how,
                           WeftError *error);
WeftResult image_write_exr(FILE *stream, const char *name, const WeftImage *image, const WeftImageWriting *how,
                           WeftError *error);

/* Writes UASTC, packed by Zstandard, with all mip levels. */
WeftResult image_write_ktx2(FILE *stream, const char *name, const WeftImage *image, const WeftImageWriting *how,
                            WeftError *error);
WeftResult image_write_npy(FILE *stream, const char *name, const WeftImage *image, const WeftImageWriting *how,
                           WeftError *error);
