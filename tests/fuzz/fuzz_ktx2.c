/* fuzz_ktx2 - the KTX 2 reader: header, descriptor, keys, levels, Zstandard, BasisLZ, blocks of UASTC and ETC1S
 *
 * Any input must be read or refused with one line; sanitizers watch the rest. All levels and faces of small pictures are
 * read; what claims to be large is only opened, since its time would be that of filling memory. */
#include "image/ktx2/ktx2.h"

#include "image_input.h"

static WeftResult all_read(const ImageSource *source, WeftImage *out, WeftError *error) {
    Ktx2 file;
    WeftResult result = ktx2_open(source, &file, error);
    if (result != WEFT_OK || (uint64_t)file.width * file.height > 1 << 14) return result;
    for (int level = 0; level < (int)file.levels && result == WEFT_OK; level++)
        for (int face = 0; face < (int)file.faces && result == WEFT_OK; face++) {
            weft_image_free(out);
            result = ktx2_picture(&file, level, face, out, error);
        }
    return result;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) { return image_input(all_read, data, size); }
