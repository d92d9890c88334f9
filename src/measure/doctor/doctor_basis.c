/* doctor_basis.c - pictures in KTX 2 that KHR_texture_basisu does not allow, though weft reads them
 *
 * Khronos Group, KHR_texture_basisu; "KTX File Format Specification", version 2.0.4, 2024, sections 3 (header) and 5
 * (keys); "Khronos Data Format Specification", version 1.3.1, 2020, section 5 (descriptor). */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/little_endian.h"
#include "image/ktx2/ktx2.h"
#include "measure/doctor/doctor.h"

/* Places of numbers in a file, in bytes. */
enum {
    WIDTH = 20,
    HEIGHT = 24,
    DEPTH = 28,
    LAYERS = 32,
    FACES = 36,
    SCHEME = 44,
    DESCRIPTOR = 48,
    KEYS = 56,
    KEYS_SIZE = 60,
    HEADER = 80
};

/* Numbers of the descriptor, behind its size: colour model, primaries, transfer function, flags. */
enum { MODEL = 12, TRANSFER = 14, FLAGS = 15, BLOCK = 16 };

static size_t number_at(Span file, size_t at) { return (size_t)little_endian(file.data + at, 4); }

/* Returns true if a key of the file has another value than this. */
static bool key_differs(Span file, const char *key, const char *value) {
    size_t at = number_at(file, KEYS);
    const size_t size = number_at(file, KEYS_SIZE), length = strlen(key) + 1;
    if (at > file.size || size > file.size - at) return false;
    for (const size_t end = at + size; at + 4 <= end;) {
        const size_t entry = number_at(file, at), text = at + 4;
        if (entry > end - text) return false;
        if (entry > length && memcmp(file.data + text, key, length) == 0)
            return strncmp((const char *)file.data + text + length, value, entry - length) != 0;
        at = text + (entry + 3) / 4 * 4;
    }
    return false;
}

/* Writes what the extension does not allow to words. Returns false if it allows the file. */
static bool basis_fault(Span file, const char *color, const char *data, char words[192]) {
    const size_t block = number_at(file, DESCRIPTOR), width = number_at(file, WIDTH), height = number_at(file, HEIGHT);
    if (block > file.size || file.size - block < BLOCK) return false; /* no reader takes it */
    const int model = file.data[block + MODEL], transfer = file.data[block + TRANSFER];
    const char *use = color && transfer != KTX2_TRANSFER_SRGB              ? color
                      : !color && data && transfer != KTX2_TRANSFER_LINEAR ? data
                                                                           : NULL;
    words[0] = 0;
    if (model != KTX2_MODEL_ETC1S && model != KTX2_MODEL_UASTC)
        snprintf(words, 192, "its texels are neither ETC1S nor UASTC");
    else if (number_at(file, SCHEME) > KTX2_ZSTANDARD)
        snprintf(words, 192, "it is packed neither by BasisLZ nor by Zstandard");
    else if (width % 4 || height % 4)
        snprintf(words, 192, "its sides, %zu x %zu, are no multiples of 4", width, height);
    else if (number_at(file, DEPTH) || number_at(file, LAYERS) || number_at(file, FACES) != 1)
        snprintf(words, 192, "it is not of type 2D");
    else if (key_differs(file, "KTXorientation", "rd"))
        snprintf(words, 192, "its KTXorientation is not rd");
    else if (key_differs(file, "KTXswizzle", "rgba"))
        snprintf(words, 192, "its KTXswizzle is not rgba");
    else if (file.data[block + FLAGS] & KTX2_PREMULTIPLIED)
        snprintf(words, 192, "its colours are multiplied by alpha");
    else if (use)
        snprintf(words, 192, "its transfer function is %s, but it is used as %.60s",
                 transfer == KTX2_TRANSFER_SRGB     ? "that of sRGB"
                 : transfer == KTX2_TRANSFER_LINEAR ? "linear"
                                                    : "another",
                 use);
    return words[0] != 0;
}

void check_basis(WeftDoctor *doctor, int image, Span file, const char *color, const char *data) {
    char words[192];
    if (file.size < HEADER || !ktx2_starts(file.data, file.size)) return;
    if (!basis_fault(file, color, data, words)) return;
    doctor_found(doctor, WEFT_FINDING_IMAGE_BASIS, (Place){WEFT_OF_IMAGE, image, NULL}, 0, (double)NAN, NULL,
                 "%s, which KHR_texture_basisu does not allow: engines may refuse it or show it otherwise", words);
    doctor_advise(doctor, "write it as ETC1S or UASTC of one picture, with sides that 4 divides");
}
