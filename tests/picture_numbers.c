/* The numbers of a sheet that tests/sources.sh asks for: "r1=0.5 g1=0.4 ... " for each of its columns.
 *
 *   picture_numbers FILE COLUMNS WIDTH HEIGHT
 *
 * Pictures of a sheet are in the middle of columns of equal width, below its title; COLUMNS 0 is a picture without a sheet. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "weft/weft.h"

enum { MARGIN = 18, GAP = 7, TITLE = 43 };

typedef struct Sum {
    double rgb[3];
    int count;
} Sum;

static double channel(const Sum *sum, int c) { return sum->count ? sum->rgb[c] / sum->count : 0.0; }
static double luminance(const Sum *sum) {
    return 0.2126 * channel(sum, 0) + 0.7152 * channel(sum, 1) + 0.0722 * channel(sum, 2);
}

static void add(Sum *sum, const float *pixel) {
    for (int c = 0; c < 3; c++) sum->rgb[c] += (double)pixel[c];
    sum->count++;
}

/* Prints the numbers of the picture whose corner is at x0, y0. Places of the ball of builtin:ball are in parts of its radius. */
static void print_column(const WeftImage *image, int k, int x0, int y0, int width, int height) {
    Sum all = {0}, middle = {0}, edge = {0};
    double low = 1e9, high = 0.0;
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++) {
            const float *pixel =
                (const float *)image->pixels + (size_t)image->channels * (size_t)((y0 + y) * image->width + x0 + x);
            const double u = (x + 0.5 - 0.5 * width) / (0.43 * height), v = (y + 0.5 - 0.47 * height) / (0.43 * height);
            const double radius = sqrt(u * u + v * v);
            add(&all, pixel);
            if (radius < 0.4) add(&middle, pixel);
            if (radius > 0.8 && radius < 0.94) add(&edge, pixel);
            const double value = (double)(pixel[0] + pixel[1] + pixel[2]);
            low = fmin(low, value), high = fmax(high, value);
        }
    printf("r%d=%.5f; g%d=%.5f; b%d=%.5f; y%d=%.5f; mid%d=%.5f; midr%d=%.5f; midg%d=%.5f; midb%d=%.5f; rim%d=%.5f; "
           "rimr%d=%.5f; rimb%d=%.5f; span%d=%.5f\n",
           k, channel(&all, 0), k, channel(&all, 1), k, channel(&all, 2), k, luminance(&all), k, luminance(&middle), k,
           channel(&middle, 0), k, channel(&middle, 1), k, channel(&middle, 2), k, luminance(&edge), k,
           channel(&edge, 0), k, channel(&edge, 2), k, high - low);
}

int main(int count, char **words) {
    WeftImage read, image;
    WeftError error;
    if (count != 5) return 2;
    const int columns = atoi(words[2]);
    int width = atoi(words[3]), height = atoi(words[4]);
    if (weft_image_read(words[1], &read, NULL, &error) != WEFT_OK ||
        weft_image_convert_f32(&read, 0, &image, &error) != WEFT_OK) {
        fprintf(stderr, "%s\n", error.text);
        return 1;
    }
    if (columns == 0) print_column(&image, 1, 0, 0, image.width, image.height);
    const double pitch = columns ? (double)(image.width - 2 * MARGIN + GAP) / columns : 0.0;
    for (int k = 0; k < columns; k++) {
        const int x = (int)(MARGIN + pitch * k + 0.5 * (pitch - GAP) - 0.5 * width);
        if (x < 0 || x + width > image.width || TITLE + height > image.height) return 1;
        print_column(&image, k + 1, x, TITLE, width, height);
    }
    weft_image_free(&read);
    weft_image_free(&image);
    return 0;
}
