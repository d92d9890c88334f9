/* relmse - prints the relative mean squared error of a picture against a reference: bench_relmse PICTURE
 * REFERENCE */
#include <stdio.h>

#include "weft/weft.h"

int main(int argc, char **argv) {
    WeftImage raw, image[2];
    WeftError error;
    if (argc != 3) {
        fputs("bench_relmse PICTURE REFERENCE\n", stderr);
        return WEFT_USAGE;
    }
    for (int k = 0; k < 2; k++) {
        WeftResult result = weft_image_read(argv[1 + k], &raw, NULL, &error);
        if (result == WEFT_OK) {
            result = weft_image_convert_f32(&raw, 1, &image[k], &error);
            weft_image_free(&raw);
        }
        if (result != WEFT_OK) {
            fprintf(stderr, "bench_relmse: %s\n", error.text);
            return (int)result;
        }
    }
    double value = weft_image_relmse(&image[0], &image[1]);
    for (int k = 0; k < 2; k++) weft_image_free(&image[k]);
    if (value < 0.0) {
        fputs("bench_relmse: the pictures differ in size or channels\n", stderr);
        return WEFT_USAGE;
    }
    printf("%.6g\n", value);
    return 0;
}
