#include "weft/image.h"

double weft_image_relmse(const WeftImage *a, const WeftImage *b) {
    if (a->type != WEFT_PIXEL_F32 || b->type != WEFT_PIXEL_F32 || a->width != b->width ||
        a->height != b->height || a->channels != b->channels || !a->pixels || !b->pixels)
        return -1.0;
    const float *image = a->pixels, *reference = b->pixels;
    size_t count = (size_t)a->width * (size_t)a->height * (size_t)a->channels;
    double sum = 0.0;
    for (size_t i = 0; i < count; i++) {
        double truth = (double)reference[i], off = (double)image[i] - truth;
        sum += off * off / (truth * truth + 1e-2);
    }
    return sum / (double)count;
}
