/* What tests/extra/ktx2.sh compares with the transcoder of three.js: ktx2_texels FILE ... writes the texels of all levels of
 * a file to FILE.rgba, four bytes each, or nothing where it is refused. */
#include <stdio.h>
#include <stdlib.h>

#include "base/file.h"
#include "image/ktx2/ktx2.h"

/* Writes a picture of 1, 3 or 4 channels: one is grey, and what is absent opaque. */
static void picture_write(const WeftImage *image, FILE *to) {
    const unsigned char *pixel = image->pixels;
    const size_t count = (size_t)image->width * (size_t)image->height;
    for (size_t n = 0; n < count; n++, pixel += image->channels)
        for (int c = 0; c < 4; c++)
            fputc(c == 3 && image->channels < 4 ? 255 : pixel[image->channels == 1 ? 0 : c], to);
}

static int file_write(const char *path) {
    FileBytes bytes;
    WeftError error = {0};
    Ktx2 file;
    char name[512];
    if (file_read(path, (size_t)1 << 26, &bytes, &error) != WEFT_OK) return 1;
    const ImageSource source = {.data = bytes.data, .size = bytes.size, .name = path, .log = NULL};
    WeftResult result = ktx2_open(&source, &file, &error);
    if (snprintf(name, sizeof name, "%s.rgba", path) >= (int)sizeof name) return 1;
    FILE *to = fopen(name, "wb");
    for (int level = 0; to && result == WEFT_OK && level < (int)file.levels; level++) {
        WeftImage image;
        result = ktx2_picture(&file, level, 0, &image, &error);
        if (result != WEFT_OK) break;
        picture_write(&image, to);
        weft_image_free(&image);
    }
    free(bytes.data);
    const int failed = to ? fclose(to) : 1;
    if (result != WEFT_OK) fprintf(stderr, "%s\n", error.text);
    return failed || (result != WEFT_OK && remove(name) != 0);
}

int main(int count, char **words) {
    int failed = 0;
    for (int k = 1; k < count; k++) failed |= file_write(words[k]);
    return failed;
}
