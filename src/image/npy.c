/* npy.c - arrays of NumPy
 *
 * Robert Kern, "A Simple File Format for NumPy Arrays", NumPy Enhancement Proposal 1, 2007. Versions 2.0 and 3.0 differ
 * in the width of a length, and in the encoding of names, which an array of numbers does not have. */
#include <ctype.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "base/fail.h"
#include "base/stream_reason.h"
#include "image/codec.h"
#include "image/half.h"

static const unsigned char signature[] = {0x93, 'N', 'U', 'M', 'P', 'Y'};

enum { SIGNATURE = sizeof signature, SIDES_MAX = 3 };

typedef struct Npy {
    char kind;   /* 'f' or 'u' */
    int bytes;   /* of a value */
    bool big;    /* the high byte comes first */
    bool by_row; /* C order; else the first index runs fastest */
    int sides;
    int64_t side[SIDES_MAX];
    const unsigned char *data;
} Npy;

/* The header's text, a Python dictionary. */
typedef struct NpyText {
    const char *at, *end;
} NpyText;

static void skip_blanks(NpyText *text) {
    while (text->at < text->end && isspace((unsigned char)*text->at)) text->at++;
}

/* Skips `mark` and returns true if it comes next. */
static bool take(NpyText *text, char mark) {
    skip_blanks(text);
    if (text->at == text->end || *text->at != mark) return false;
    text->at++;
    return true;
}

static bool take_word(NpyText *text, const char *word) {
    size_t length = strlen(word);
    skip_blanks(text);
    if ((size_t)(text->end - text->at) < length || strncmp(text->at, word, length) != 0) return false;
    text->at += length;
    return true;
}

enum { WORD = 32 };

/* Takes 'word' or "word", of less than WORD characters. */
static bool take_quoted(NpyText *text, char word[WORD]) {
    const char quote = take(text, '\'') ? '\'' : take(text, '"') ? '"' : '\0';
    size_t length = 0;
    if (!quote) return false;
    for (; text->at < text->end && *text->at != quote; text->at++) {
        if (length + 1 == WORD) return false;
        word[length++] = *text->at;
    }
    word[length] = '\0';
    return take(text, quote);
}

/* Takes an integer. It stops growing when it is too large for any image. Python 2 puts an L behind it. */
static bool take_side(NpyText *text, int64_t *side) {
    const int64_t enough = INT64_C(1) << 40;
    skip_blanks(text);
    const char *first = text->at;
    for (*side = 0; text->at < text->end && isdigit((unsigned char)*text->at); text->at++)
        if (*side < enough) *side = 10 * *side + (*text->at - '0');
    if (text->at == first) return false;
    take(text, 'L');
    return true;
}

/* Returns true if another item of a list follows. Items are separated by commas, and the last may have one
 * too. At the end of the list takes `close` and returns false; sets *broken if neither follows. */
static bool take_next(NpyText *text, bool first, char close, bool *broken) {
    const bool closed = take(text, close);
    *broken = !closed && !first && !take(text, ',');
    return !closed && !*broken && (first || !take(text, close));
}

/* Takes a shape such as (4, 5) or (4,). Sides beyond SIDES_MAX are counted but not stored. */
static bool take_shape(NpyText *text, Npy *npy) {
    bool broken = !take(text, '(');
    for (npy->sides = 0; !broken && take_next(text, npy->sides == 0, ')', &broken); npy->sides++) {
        int64_t side;
        if (!take_side(text, &side)) return false;
        if (npy->sides < SIDES_MAX) npy->side[npy->sides] = side;
    }
    return !broken;
}

/* Returns the fault of the values' type, or NULL. */
static const char *type_of(const char *word, Npy *npy) {
    npy->big = word[0] == '>';
    if (!word[0] || !strchr("<>|=", word[0])) return "its values are of no known type";
    npy->kind = word[1];
    npy->bytes = word[1] && word[2] && !word[3] ? word[2] - '0' : 0;
    if (npy->kind == 'f' && (npy->bytes == 2 || npy->bytes == 4 || npy->bytes == 8)) return NULL;
    if (npy->kind == 'u' && (npy->bytes == 1 || npy->bytes == 2)) return NULL;
    return "its values are not f2, f4, f8, u1 or u2";
}

typedef enum Wrong { FINE, DAMAGED, UNSUPPORTED } Wrong;

/* Reads the dictionary; sets *words to the fault. */
static Wrong header_read(NpyText text, Npy *npy, const char **words) {
    char key[WORD], type[WORD] = "";
    *words = "its header is not a dictionary of descr, fortran_order and shape";
    npy->sides = -1;
    bool ordered = false, broken = !take(&text, '{');
    for (int n = 0; !broken && take_next(&text, n == 0, '}', &broken); n = 1) {
        if (!take_quoted(&text, key) || !take(&text, ':')) return DAMAGED;
        if (strcmp(key, "descr") == 0) {
            if (take(&text, '[')) {
                *words = "its values are records";
                return UNSUPPORTED;
            }
            if (!take_quoted(&text, type)) return DAMAGED;
        } else if (strcmp(key, "fortran_order") == 0) {
            npy->by_row = take_word(&text, "False");
            ordered = npy->by_row || take_word(&text, "True");
            if (!ordered) return DAMAGED;
        } else if (strcmp(key, "shape") != 0 || !take_shape(&text, npy)) {
            return DAMAGED;
        }
    }
    if (broken || !type[0] || !ordered || npy->sides < 0) return DAMAGED;
    *words = type_of(type, npy);
    if (*words) return UNSUPPORTED;
    *words = "it is not an array of rows by columns, with 1 to 4 channels or without";
    if (npy->sides == 2) npy->side[2] = 1;
    if (npy->sides < 2 || npy->sides > 3 || npy->side[2] < 1 || npy->side[2] > 4) return UNSUPPORTED;
    return FINE;
}

/* Finds the header's text and the data after it; returns false if the file ends before. */
static bool header_find(const ImageSource *source, NpyText *text, Npy *npy) {
    const unsigned char *at = source->data + SIGNATURE + 2;
    if (source->size < SIGNATURE + 2) return false;
    const size_t digits = at[-2] == 1 ? 2 : 4, before = SIGNATURE + 2 + digits;
    size_t length = 0;
    if (source->size < before) return false;
    for (size_t k = digits; k-- > 0;) length = length << 8 | at[k];
    if (length > source->size - before) return false;
    text->at = (const char *)at + digits;
    text->end = text->at + length;
    npy->data = at + digits + length;
    return true;
}

/* Returns the bits of value n in this machine's byte order. */
static uint64_t bits_at(const Npy *npy, size_t n) {
    const unsigned char *at = npy->data + n * (size_t)npy->bytes;
    uint64_t bits = 0;
    for (int k = 0; k < npy->bytes; k++) bits = bits << 8 | at[npy->big ? k : npy->bytes - 1 - k];
    return bits;
}

static float float_of(uint64_t bits, int bytes) {
    if (bytes == 2) return half_value((unsigned)bits);
    if (bytes == 4) {
        const uint32_t low = (uint32_t)bits;
        float value;
        memcpy(&value, &low, sizeof value);
        return value;
    }
    double value;
    memcpy(&value, &bits, sizeof value);
    return (float)value;
}

/* Reads the values into the image, whose first index is the row. */
static void values_read(const Npy *npy, WeftImage *image) {
    const size_t height = (size_t)image->height, width = (size_t)image->width, channels = (size_t)image->channels;
    for (size_t n = 0; n < height * width * channels; n++) {
        const size_t c = n % channels, x = n / channels % width, y = n / channels / width;
        const uint64_t bits = bits_at(npy, npy->by_row ? n : (c * width + x) * height + y);
        if (image->type == WEFT_PIXEL_F32)
            ((float *)image->pixels)[n] = float_of(bits, npy->bytes);
        else if (image->type == WEFT_PIXEL_U16)
            ((uint16_t *)image->pixels)[n] = (uint16_t)bits;
        else
            ((uint8_t *)image->pixels)[n] = (uint8_t)bits;
    }
}

WeftResult image_read_npy(const ImageSource *source, WeftImage *out, WeftError *error) {
    NpyText text = {0};
    Npy npy = {0};
    const char *words;
    if (!header_find(source, &text, &npy))
        return fail(error, WEFT_MESSAGE_IMAGE_DAMAGED, source->name, "NPY: it ends within its header");
    if (source->data[SIGNATURE] < 1 || source->data[SIGNATURE] > 3)
        return fail(error, WEFT_MESSAGE_IMAGE_UNSUPPORTED, source->name, "NPY: version %d",
                    (int)source->data[SIGNATURE]);
    const Wrong wrong = header_read(text, &npy, &words);
    if (wrong != FINE)
        return fail(error, wrong == DAMAGED ? WEFT_MESSAGE_IMAGE_DAMAGED : WEFT_MESSAGE_IMAGE_UNSUPPORTED, source->name,
                    "NPY: %s", words);
    const WeftPixelType type = npy.kind == 'f' ? WEFT_PIXEL_F32 : npy.bytes == 2 ? WEFT_PIXEL_U16 : WEFT_PIXEL_U8;
    const int64_t in_memory = type == WEFT_PIXEL_F32 ? (int64_t)sizeof(float) : npy.bytes;
    WeftResult result = image_check_header(source, npy.side[1], npy.side[0], npy.side[2] * in_memory, error);
    if (result == WEFT_OK) {
        const int64_t before = npy.data - source->data;
        result = image_reachable(source, before + npy.side[0] * npy.side[1] * npy.side[2] * npy.bytes, error);
    }
    if (result == WEFT_OK)
        result = weft_image_create((int)npy.side[1], (int)npy.side[0], (int)npy.side[2], type, out, error);
    if (result != WEFT_OK) return result;
    values_read(&npy, out);
    if (type == WEFT_PIXEL_F32) image_repair(source, out);
    return WEFT_OK;
}

/* Writes the header, padded by blanks and a newline so that the values begin at a multiple of 64. */
static void header_write(FILE *stream, const WeftImage *image) {
    enum { BEFORE = SIGNATURE + 4, STEP = 64 };
    char text[128], channels[16] = "";
    if (image->channels > 1) snprintf(channels, sizeof channels, ", %d", image->channels);
    const int length = snprintf(text, sizeof text, "{'descr': '<f4', 'fortran_order': False, 'shape': (%d, %d%s), }",
                                image->height, image->width, channels);
    const int padded = (BEFORE + length + 1 + STEP - 1) / STEP * STEP - BEFORE;
    const unsigned char version[] = {1, 0, (unsigned char)(padded & 255), (unsigned char)(padded >> 8)};
    fwrite(signature, 1, SIGNATURE, stream);
    fwrite(version, 1, sizeof version, stream);
    fprintf(stream, "%s%*s\n", text, padded - 1 - length, "");
}

WeftResult image_write_npy(FILE *stream, const char *name, const WeftImage *image, const WeftImageWriting *how,
                           WeftError *error) {
    (void)how;
    const float *values = image->pixels;
    const size_t count = (size_t)image->width * (size_t)image->height * (size_t)image->channels;
    header_write(stream, image);
    for (size_t n = 0; n < count; n++) {
        uint32_t bits;
        memcpy(&bits, &values[n], sizeof bits);
        const unsigned char bytes[] = {(unsigned char)(bits & 255), (unsigned char)(bits >> 8 & 255),
                                       (unsigned char)(bits >> 16 & 255), (unsigned char)(bits >> 24)};
        fwrite(bytes, 1, sizeof bytes, stream);
    }
    return ferror(stream) ? fail(error, WEFT_MESSAGE_FILE_WRITE, name, "%s", stream_reason(stream)) : WEFT_OK;
}
