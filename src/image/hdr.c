/* hdr.c - Radiance HDR: a text header, then lines of RGBE pixels, flat or in one of two run-length codes
 *
 * Greg Ward, "Real Pixels", Graphics Gems II, 1991, and the file formats chapter of the Radiance manual. */
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "base/fail.h"
#include "base/memory.h"
#include "base/number.h"
#include "base/stream_reason.h"
#include "image/codec.h"
#include "image/primaries.h"

enum { HDR_LINE_MIN = 8, HDR_LINE_MAX = 32767 }; /* the line lengths that the new code can have */

typedef struct Hdr {
    const ImageSource *source;
    size_t position;
    double gain[3];              /* from stored values to radiance */
    int lines, length;           /* of the file: a line is a column if x comes first */
    int x_first;                 /* lines run along y */
    int from_right, from_bottom; /* direction of x and of y */
    bool xyz, converted;         /* the colours are X Y Z, or of other primaries */
    ColorConversion matrix;      /* from those */
} Hdr;

/* Reads the next line of the header, without its end, truncated to size - 1; returns 0 at the end of the file. */
static int text_line(Hdr *hdr, char *line, size_t size) {
    const ImageSource *source = hdr->source;
    const unsigned char *start = source->data + hdr->position;
    const unsigned char *end = memchr(start, '\n', source->size - hdr->position);
    if (!end) return 0;
    size_t length = (size_t)(end - start);
    hdr->position += length + 1;
    if (length >= size) length = size - 1;
    memcpy(line, start, length);
    line[length] = 0;
    if (length && line[length - 1] == '\r') line[length - 1] = 0;
    return 1;
}

/* Reads `count` numbers with blanks between; returns what follows them, or NULL. */
static const char *numbers_read(const char *text, int count, double *numbers) {
    for (int k = 0; k < count; k++) {
        float number = 0.0f;
        text = number_prefix(text, &number);
        if (!text) return NULL;
        numbers[k] = (double)number;
    }
    return text;
}

static bool is_blank(const char *text) { return text[strspn(text, " \t\r")] == '\0'; }

/* Divides the gain by the factors of an EXPOSURE (one for all) or COLORCORR (one each) line. Several such lines
 * multiply. Returns what follows the factors, or NULL. */
static const char *gain_divide(Hdr *hdr, const char *text, int count) {
    double factors[3];
    text = numbers_read(text, count, factors);
    for (int c = 0; text && c < 3; c++) {
        const double factor = factors[c < count ? c : 0];
        if (!(factor > 0.0)) return NULL;
        hdr->gain[c] /= factor;
        if (!(hdr->gain[c] > 1e-30 && hdr->gain[c] < 1e30)) return NULL;
    }
    return text;
}

/* The key of a line of the header that changes the picture. */
typedef enum HdrKey {
    HDR_OTHER = 0,
    HDR_FORMAT,
    HDR_EXPOSURE,
    HDR_COLORCORR,
    HDR_PRIMARIES,
    HDR_PIXASPECT,
    HDR_GAMMA
} HdrKey;

/* Returns the key of a line KEY=VALUE, in any case, and its value. */
static HdrKey key_of(const char *line, const char **value) {
    static const char *const keys[] = {"", "FORMAT", "EXPOSURE", "COLORCORR", "PRIMARIES", "PIXASPECT", "GAMMA"};
    const char *equals = strchr(line, '=');
    if (!equals) return HDR_OTHER;
    const size_t length = strcspn(line, " \t=");
    *value = equals + 1 + strspn(equals + 1, " \t");
    for (int k = HDR_FORMAT; k <= HDR_GAMMA; k++)
        if (length == strlen(keys[k]) && strncasecmp(line, keys[k], length) == 0) return (HdrKey)k;
    return HDR_OTHER;
}

/* Says that a line of the header does not change the picture as it asks. */
static void line_left(const Hdr *hdr, const char *line, const char *why) {
    warn(hdr->source->log, WEFT_MESSAGE_IMAGE_REPAIRED, hdr->source->name, "HDR: \"%.60s\" %s", line, why);
}

/* Takes the primaries of a line: eight chromaticities. */
static void primaries_take(Hdr *hdr, const char *line, const char *value) {
    Primaries given = {{0}};
    const char *rest = numbers_read(value, 8, given.xy);
    if (!rest || !is_blank(rest)) {
        line_left(hdr, line, "is not understood; its colours are taken for Rec. 709's");
    } else if (!primaries_rec709(&given)) {
        hdr->converted = primaries_matrix(&given, &hdr->matrix);
        line_left(hdr, line,
                  hdr->converted ? "was applied: its colours are Rec. 709's now" : "are those of no colours");
    }
}

/* Looks for a ratio that the picture would have to be changed by, which it is not. */
static void ratio_check(const Hdr *hdr, const char *line, const char *value) {
    double ratio;
    const char *rest = numbers_read(value, 1, &ratio);
    if (!rest || !is_blank(rest) || fabs(ratio - 1.0) > 0.02) line_left(hdr, line, "is passed over");
}

/* Takes one line of the header. */
static WeftResult header_line(Hdr *hdr, const char *line, WeftError *error) {
    const char *name = hdr->source->name, *value = "", *rest = NULL;
    const HdrKey key = key_of(line, &value);
    switch (key) {
    case HDR_FORMAT:
        hdr->xyz = strncmp(value, "32-bit_rle_xyze", 15) == 0 && is_blank(value + 15);
        if (hdr->xyz || (strncmp(value, "32-bit_rle_rgbe", 15) == 0 && is_blank(value + 15))) break;
        return fail(error, WEFT_MESSAGE_IMAGE_UNSUPPORTED, name,
                    "HDR: a FORMAT other than 32-bit_rle_rgbe and 32-bit_rle_xyze");
    case HDR_EXPOSURE:
    case HDR_COLORCORR:
        rest = gain_divide(hdr, value, key == HDR_EXPOSURE ? 1 : 3);
        if (!rest) return fail(error, WEFT_MESSAGE_IMAGE_DAMAGED, name, "HDR: %.9s is not a positive factor", line);
        if (!is_blank(rest)) line_left(hdr, line, "has more than its factors, which is passed over");
        break;
    case HDR_PRIMARIES: primaries_take(hdr, line, value); break;
    case HDR_PIXASPECT:
    case HDR_GAMMA: ratio_check(hdr, line, value); break;
    default: break;
    }
    return WEFT_OK;
}

/* Reads the resolution, such as "-Y 512 +X 1024": the slower axis comes first; +Y is up, +X to the right. */
static int resolution(Hdr *hdr, const char *line) {
    char sign[2], axis[2], rest;
    int count[2];
    if (sscanf(line, "%c%c %5d %c%c %5d %c", &sign[0], &axis[0], &count[0], &sign[1], &axis[1], &count[1], &rest) != 6)
        return 0;
    hdr->x_first = axis[0] == 'X';
    const int x = hdr->x_first ? 0 : 1, y = 1 - x;
    if (axis[x] != 'X' || axis[y] != 'Y') return 0;
    for (int i = 0; i < 2; i++)
        if ((sign[i] != '+' && sign[i] != '-') || count[i] < 1) return 0;
    hdr->from_right = sign[x] == '-';
    hdr->from_bottom = sign[y] == '+';
    hdr->lines = count[0];
    hdr->length = count[1];
    return 1;
}

static WeftResult hdr_header(Hdr *hdr, WeftError *error) {
    const char *name = hdr->source->name;
    char line[256];
    while (text_line(hdr, line, sizeof line) && line[0]) {
        WeftResult result = header_line(hdr, line, error);
        if (result != WEFT_OK) return result;
    }
    if (!text_line(hdr, line, sizeof line) || !resolution(hdr, line))
        return fail(error, WEFT_MESSAGE_IMAGE_DAMAGED, name, "HDR: it has no resolution after its header");
    return WEFT_OK;
}

/* Reads one line in the new code: the four components after one another, each in runs (a count above 128 and a
 * byte) and dumps (a count and as many bytes). Returns the fault or NULL. */
static const char *line_components(Hdr *hdr, unsigned char (*line)[4]) {
    const unsigned char *at = hdr->source->data + hdr->position, *end = hdr->source->data + hdr->source->size;
    for (int c = 0; c < 4; c++)
        for (int x = 0; x < hdr->length;) {
            if (end - at < 2) return "it ends early";
            int run = *at > 128, count = run ? *at - 128 : *at;
            at++;
            if (count == 0) return "a run of no length";
            if (count > hdr->length - x) return "a run over the end of its line";
            if (!run && end - at < count) return "it ends early";
            for (int i = 0; i < count; i++) line[x++][c] = run ? *at : at[i];
            at += run ? 1 : count;
        }
    hdr->position = (size_t)(at - hdr->source->data);
    return NULL;
}

/* Reads one line, flat or in the old code: a pixel 1 1 1 n repeats the one before n times; directly after another
 * such pixel n counts 256 times as much. Returns the fault or NULL. */
static const char *line_pixels(Hdr *hdr, unsigned char (*line)[4]) {
    const unsigned char *at = hdr->source->data + hdr->position, *end = hdr->source->data + hdr->source->size;
    int shift = 0;
    for (int x = 0; x < hdr->length; at += 4) {
        if (end - at < 4) return "it ends early";
        if (at[0] != 1 || at[1] != 1 || at[2] != 1) {
            memcpy(line[x++], at, 4);
            shift = 0;
            continue;
        }
        if (x == 0) return "a run with nothing before it";
        if (shift > 16) return "a run over the end of its line";
        int count = at[3] << shift;
        if (count > hdr->length - x) return "a run over the end of its line";
        for (int i = 0; i < count; i++, x++) memcpy(line[x], line[x - 1], 4);
        shift += 8;
    }
    hdr->position = (size_t)(at - hdr->source->data);
    return NULL;
}

static const char *line_read(Hdr *hdr, unsigned char (*line)[4]) {
    const unsigned char *at = hdr->source->data + hdr->position;
    if (hdr->source->size - hdr->position < 4) return "it ends early";
    if (hdr->length < HDR_LINE_MIN || hdr->length > HDR_LINE_MAX || at[0] != 2 || at[1] != 2 || at[2] > 127)
        return line_pixels(hdr, line);
    if ((at[2] << 8 | at[3]) != hdr->length) return "a line of another length than the image's";
    hdr->position += 4;
    return line_components(hdr, line);
}

/* Puts the pixels of a line at their places by the orientation. */
static void line_place(const Hdr *hdr, unsigned char (*line)[4], int number, const WeftImage *image) {
    for (int n = 0; n < hdr->length; n++) {
        int x = hdr->x_first ? number : n, y = hdr->x_first ? n : number;
        if (hdr->from_right) x = image->width - 1 - x;
        if (hdr->from_bottom) y = image->height - 1 - y;
        float *to = (float *)image->pixels + 3 * ((size_t)y * (size_t)image->width + (size_t)x);
        for (int c = 0; c < 3; c++)
            to[c] = line[n][3] ? (float)(ldexp(line[n][c], line[n][3] - 136) * hdr->gain[c]) : 0.0f;
    }
}

/* Returns the fewest bytes of a line, in the shorter of both codes. Old: a pixel and one, two or three runs (of 255,
 * 255 * 256 ...). New: its mark, then for each component a run of two bytes for 127 pixels. */
static int64_t fewest_line_bytes(int length) {
    int64_t old = length == 1 ? 4 : length <= 256 ? 8 : 12, fresh = 4 + (length + 126) / 127 * 8;
    return fresh < old ? fresh : old;
}

WeftResult image_read_hdr(const ImageSource *source, WeftImage *out, WeftError *error) {
    Hdr hdr = {.source = source, .gain = {1.0, 1.0, 1.0}};
    WeftResult result = hdr_header(&hdr, error);
    if (result != WEFT_OK) return result;
    const int width = hdr.x_first ? hdr.lines : hdr.length, height = hdr.x_first ? hdr.length : hdr.lines;
    result = image_check_header(source, width, height, 3 * (int64_t)sizeof(float), error);
    if (result == WEFT_OK) result = image_reachable(source, hdr.lines * fewest_line_bytes(hdr.length), error);
    if (result == WEFT_OK) result = weft_image_create(width, height, 3, WEFT_PIXEL_F32, out, error);
    if (result != WEFT_OK) return result;

    unsigned char(*line)[4] = alloc_array((size_t)hdr.length, 4);
    const char *wrong = NULL;
    for (int i = 0; line && !wrong && i < hdr.lines; i++) {
        wrong = line_read(&hdr, line);
        if (!wrong) line_place(&hdr, line, i, out);
    }
    if (!line)
        result = fail(error, WEFT_MESSAGE_MEMORY, source->name, NULL);
    else if (wrong)
        result = fail(error, WEFT_MESSAGE_IMAGE_DAMAGED, source->name, "HDR: %s", wrong);
    free(line);
    if (result != WEFT_OK)
        weft_image_free(out);
    else
        image_repair(source, out);
    if (result == WEFT_OK && hdr.xyz) hdr.matrix = xyz_matrix();
    if (result == WEFT_OK && (hdr.xyz || hdr.converted)) image_convert_colors(out, &hdr.matrix);
    return result;
}

/* Converts to the nearest RGBE, whose exponent is that of the largest component. Components that RGBE cannot represent
 * become 0 (negative, NaN, all below 1e-32) or the largest value (about 2^127). */
static void rgbe_pack(const float *rgb, unsigned char rgbe[4]) {
    double value[3], largest = 0.0;
    for (int c = 0; c < 3; c++) {
        value[c] = (double)fminf(fmaxf(rgb[c], 0.0f), 0x1.fdp126f);
        if (value[c] > largest) largest = value[c];
    }
    memset(rgbe, 0, 4);
    if (largest < 1e-32) return;
    int exponent;
    if (frexp(largest, &exponent) * 256.0 >= 255.5) exponent++; /* the mantissa would round to 256 */
    for (int c = 0; c < 3; c++) rgbe[c] = (unsigned char)(ldexp(value[c], 8 - exponent) + 0.5);
    rgbe[3] = (unsigned char)(exponent + 128);
}

/* Returns the number of pixels from x on with an equal component, at most limit. */
static int run_length(unsigned char (*line)[4], int c, int x, int length, int limit) {
    if (limit > length - x) limit = length - x;
    int run = 1;
    while (run < limit && line[x + run][c] == line[x][c]) run++;
    return run;
}

/* Writes one component of a line in the new code. Only runs of 3 or more save anything. */
static void component_write(FILE *stream, unsigned char (*line)[4], int c, int length) {
    for (int x = 0, start = 0; x < length; start = x) {
        const int run = run_length(line, c, x, length, 127);
        if (run >= 3) {
            fputc(128 + run, stream);
            fputc(line[x][c], stream);
            x += run;
            continue;
        }
        while (x < length && x - start < 128 && run_length(line, c, x, length, 3) < 3) x++;
        fputc(x - start, stream);
        for (; start < x; start++) fputc(line[start][c], stream);
    }
}

WeftResult image_write_hdr(FILE *stream, const char *name, const WeftImage *image, const WeftImageWriting *how,
                           WeftError *error) {
    (void)how;
    if (image->channels < 3) return fail(error, WEFT_MESSAGE_DESC, name, ".hdr takes 3 or 4 channels");
    const int width = image->width;
    unsigned char(*line)[4] = alloc_array((size_t)width, 4);
    if (!line) return fail(error, WEFT_MESSAGE_MEMORY, name, NULL);
    fprintf(stream, "#?RADIANCE\nSOFTWARE=weft\nFORMAT=32-bit_rle_rgbe\n\n-Y %d +X %d\n", image->height, width);
    const float *from = image->pixels;
    for (int y = 0; y < image->height; y++) {
        for (int x = 0; x < width; x++, from += image->channels) rgbe_pack(from, line[x]);
        if (width < HDR_LINE_MIN || width > HDR_LINE_MAX) {
            fwrite(line, 4, (size_t)width, stream);
            continue;
        }
        const unsigned char mark[4] = {2, 2, (unsigned char)(width >> 8), (unsigned char)(width & 255)};
        fwrite(mark, 1, 4, stream);
        for (int c = 0; c < 4; c++) component_write(stream, line, c, width);
    }
    free(line);
    return ferror(stream) ? fail(error, WEFT_MESSAGE_FILE_WRITE, name, "%s", stream_reason(stream)) : WEFT_OK;
}
