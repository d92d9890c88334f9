/* image.h - pixels in memory, and the files they come from
 *
 * Rows run from the top, pixels from the left, channels interleaved without padding. Integer pixels are the
 * values of the file, usually sRGB for colour and linear for data; the reader cannot tell which. Float pixels
 * are linear Rec. 709 radiance. Channels: 1 grey, 2 grey+alpha, 3 RGB, 4 RGBA; alpha is straight, never
 * premultiplied. */
#ifndef WEFT_IMAGE_H
#define WEFT_IMAGE_H

#include <stddef.h>
#include <stdint.h>

#include "weft/result.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Unsigned bytes, unsigned 16 bit integers in this machine's byte order, or 32 bit floats. */
typedef enum WeftPixelType { WEFT_PIXEL_U8 = 0, WEFT_PIXEL_U16 = 1, WEFT_PIXEL_F32 = 2 } WeftPixelType;

/* A picture or a table. May be filled in by hand around pixels that the caller owns; do not pass such an image to
 * weft_image_free. */
typedef struct WeftImage {
    int width, height;  /* 1 .. 65536 */
    int channels;       /* 1 .. 4 */
    WeftPixelType type; /* of every channel */
    void *pixels;       /* width * height * channels of the type; owned, see weft_image_free */
} WeftImage;

/* Makes a zeroed image. Fails with WEFT_MESSAGE_DESC or _MEMORY. */
WEFT_API WeftResult weft_image_create(int width, int height, int channels, WeftPixelType type, WeftImage *out,
                                      WeftError *error);

/* Releases the pixels and zeroes the struct. image may be NULL or all zero. */
WEFT_API void weft_image_free(WeftImage *image);

/* Reads PNG, JPEG, WebP, TGA, Radiance HDR, OpenEXR, DDS, KTX 2, TIFF (where libtiff is) or NumPy's .npy, told by
 * content (TGA last). PNG gives U8 or U16, JPEG, WebP and TGA U8, HDR F32 RGB, EXR F32 of its display window, DDS, KTX 2
 * and TIFF any of the three. An .npy is an array of rows by columns, by 1 to 4 channels where it has three indices: f2,
 * f4 and f8 give F32, u1 U8, u2 U16. Float values are finite. log (may be NULL) receives a warning for each repair, and
 * WEFT_MESSAGE_IMAGE_DENOISED where the file states that it was denoised. Fails with WEFT_MESSAGE_FILE_OPEN,
 * _FILE_READ, _FILE_LARGE, _IMAGE_FORMAT, _IMAGE_SIZE, _IMAGE_DAMAGED, _IMAGE_UNSUPPORTED or _MEMORY; *out is then
 * zero. */
WEFT_API WeftResult weft_image_read(const char *path, WeftImage *out, const WeftLog *log, WeftError *error);

/* Works as weft_image_read, from size bytes at data. Errors begin with name. */
WEFT_API WeftResult weft_image_read_memory(const void *data, size_t size, const char *name, WeftImage *out,
                                           const WeftLog *log, WeftError *error);

/* Reads count channels, 1 to 4, of an .exr by their full names, such as "albedo.R", as the floats of the file: nothing
 * is divided by alpha, converted or repaired, so that what WeftImageLayer wrote is read bit by bit. comment (may be
 * NULL) becomes the attribute "comments", NULL where there is none; release it with free. Fails as weft_image_read, and
 * with WEFT_MESSAGE_IMAGE_FORMAT where the file is no .exr or _IMAGE_UNSUPPORTED where it lacks a channel. */
WEFT_API WeftResult weft_image_read_channels(const char *path, const char *const *channels, int count, WeftImage *out,
                                             char **comment, WeftError *error);

/* Writes by suffix: .png (U8 or U16 as the image is; F32 is refused: tone-map first), .exr (F32, half float,
 * ZIP), .hdr (F32, RGBE, no alpha), .npy (F32, as it is), .ktx2 (U8 or U16 as 8 bits: UASTC in Zstandard, with mip
 * levels). The file appears complete or not at all. */
WEFT_API WeftResult weft_image_write(const char *path, const WeftImage *image, WeftError *error);

/* Channels of an .exr beside the picture's, written as 32 bit floats, not multiplied by alpha. */
typedef struct WeftImageLayer {
    const WeftImage *image;  /* F32, of the picture's size */
    const char *channels[4]; /* full names, such as "albedo.R", one for each channel of image */
} WeftImageLayer;

enum { WEFT_IMAGE_LAYERS = 32 };

/* An attribute of an .exr: a name of at most 31 characters, and its text. */
typedef struct WeftImageText {
    const char *name; /* at most 31 characters */
    const char *text; /* of one line or several */
} WeftImageText;

/* Options of weft_image_write_as. All zero: as weft_image_write does. */
typedef struct WeftImageWriting {
    int data;   /* not 0: linear data: a .png or .ktx2 is not marked sRGB, an .exr not multiplied by its alpha */
    int single; /* not 0: .exr of 32 bit floats in place of half */
    const char *comment;          /* one line kept in a .png (text chunk "Comment") or .exr (attribute "comments");
                             the other formats have no place for it; may be NULL */
    const char *denoised;         /* how the picture was denoised, kept in a .png ("Denoised") or .exr ("denoised"),
                             where readers warn of it; may be NULL */
    const WeftImageLayer *layers; /* of an .exr; the other formats leave them out */
    int layer_count;              /* at most WEFT_IMAGE_LAYERS */
    const WeftImageText *texts;   /* of an .exr; the other formats leave them out */
    int text_count;               /* of texts */
    const WeftImage *levels; /* of a .ktx2: its mip levels after the first, U8 or U16, each side half of that before,
                                rounded down and at least 1; NULL: means of the picture, of linear light unless `data` */
    int level_count;         /* of levels; 0: all, down to a single texel */
    const char *isa;         /* the instruction set that made it (weft_isa), kept in an .exr ("isa"); may be NULL */
} WeftImageWriting;

/* Works as weft_image_write, with options. */
WEFT_API WeftResult weft_image_write_as(const char *path, const WeftImage *image, const WeftImageWriting *how,
                                        WeftError *error);

/* Returns 1 if weft_image_write supports this suffix, and if the file would be linear (EXR, HDR, NPY) and not
 * display-referred; else 0. */
WEFT_API int weft_image_suffix_known(const char *path);
WEFT_API int weft_image_suffix_linear(const char *path);

/* Converts any image to F32: integers become value / 255 or / 65535, colours (not alpha) then go through the sRGB
 * decoding curve if srgb is not 0; F32 is copied. For environment maps that come as PNG or JPEG. out must not be in. */
WEFT_API WeftResult weft_image_convert_f32(const WeftImage *in, int srgb, WeftImage *out, WeftError *error);

/* The curve that maps linear radiance to a display value in [0, 1], before the sRGB curve. */
typedef enum WeftTonemap {
    WEFT_TONEMAP_PBR_NEUTRAL = 0, /* Khronos PBR Neutral, 2024: keeps base colours, for products */
    WEFT_TONEMAP_ACES = 1,        /* Narkowicz, "ACES Filmic Tone Mapping Curve", 2015 */
    WEFT_TONEMAP_NONE = 2,        /* clamp */
    WEFT_TONEMAP_AGX = 3,         /* Sobotka's AgX as fitted by Wrensch, "Minimal AgX Implementation", 2023 */
    WEFT_TONEMAP_COUNT
} WeftTonemap;

/* Returns "pbr-neutral", "aces", "none" or "agx"; NULL beyond. */
WEFT_API const char *weft_tonemap_name(int tonemap);

/* The rendering of radiance for a display. Zero means the default, in every member. */
typedef struct WeftTone {
    WeftTonemap curve; /* from exposed radiance to the display */
    float exposure;    /* stops: colours are first multiplied by 2^exposure */
    /* chromaticity x, y (CIE 1931) of the light that shows as white; 0, 0: D65, the display's own. Colours are adapted
     * as in King Lam, "Metamerism and Colour Constancy", 1985 (the Bradford transform) */
    float white[2];
} WeftTone;

/* Makes a display-referred U8 image (sRGB-encoded) of a linear F32 image of 3 or 4 channels. A tiny ordered dither
 * breaks up banding; the same input gives the same bytes. behind may be NULL: alpha is kept; else the image becomes
 * opaque over this background, as weft_image_tonemap_over has it. Fails with WEFT_MESSAGE_DESC or _MEMORY. */
WEFT_API WeftResult weft_image_show(const WeftImage *linear, const WeftTone *tone, const float behind[3],
                                    WeftImage *out, WeftError *error);

/* Works as weft_image_show with this curve and exposure; alpha is kept. */
WEFT_API WeftResult weft_image_tonemap(const WeftImage *linear, WeftTonemap tonemap, float exposure, WeftImage *out,
                                       WeftError *error);

/* Works as weft_image_tonemap, but opaque over a background. behind is light of the display, linear in [0, 1]:
 * neither exposure nor curve change it, so that a white one stays white. Light is blended before it is encoded. An
 * image without alpha hides the background. */
WEFT_API WeftResult weft_image_tonemap_over(const WeftImage *linear, WeftTonemap tonemap, float exposure,
                                            const float behind[3], WeftImage *out, WeftError *error);

/* Returns the exposure in stops, -32 to 32, that shows the mean of a linear F32 image of 3 or 4 channels as middle grey,
 * 0.18: the geometric mean of the luminance, without the darkest and the brightest twentieth of what is covered. Erik
 * Reinhard, Michael Stark, Peter Shirley, James Ferwerda, "Photographic Tone Reproduction for Digital Images", 2002,
 * Equations 1 and 2. Returns 0 for an image without light, or not of such channels. */
WEFT_API float weft_image_meter(const WeftImage *linear);

/* Estimates the chromaticity of the light on a linear F32 image of 3 or 4 channels from its colours, which are taken to
 * be grey in the mean of their sixth powers: Graham Finlayson, Elisabetta Trezzi, "Shades of Gray and Colour
 * Constancy", 2004. The darkest and the brightest twentieth are left out. 0, 0 for an image without light. */
WEFT_API void weft_image_find_white(const WeftImage *linear, float white[2]);

/* Fills the chromaticity of light of a correlated colour temperature, 1700 to 25000 K: that of daylight from 5000 K on
 * (CIE 15:2004, Equations 3.1 to 3.4; 6504 K is D65), that of a black body up to 3000 K (Michael Krystek, "An Algorithm
 * to Calculate Correlated Colour Temperature", 1985), and mixed between. tint moves it at right angles to this curve, in
 * thousandths of CIE 1960 u, v: above 0 the light is greener, so that pictures become more purple. */
WEFT_API void weft_white(float kelvin, float tint, float white[2]);

/* Fills the matrix, by rows, that takes linear Rec. 709 colours under light of that chromaticity to those under D65; of
 * 0, 0 and of what no light has the unit matrix. */
WEFT_API void weft_white_matrix(const float white[2], float matrix[9]);

#ifdef __cplusplus
}
#endif

#endif
