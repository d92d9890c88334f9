/* green.c - the sign of green in a normal map
 *
 * The slopes p = dh/dx and q = dh/dy of a surface of height h have dp/dy = dq/dx; with the sign of q wrong they have
 * dp/dy = -dq/dx. So the correlation of the two derivatives over the picture tells, without a name: Robert Frankot,
 * Rama Chellappa, "A Method for Enforcing Integrability in Shape from Shading Algorithms", IEEE Transactions on
 * Pattern Analysis and Machine Intelligence 10, 1988, whose condition this is. */
#include "scene/material/green.h"

#include <math.h>

#include "image/pixel.h"

static double value_at(const WeftImage *image, int x, int y, int channel) {
    const size_t pixel = (size_t)y * (size_t)image->width + (size_t)x;
    return pixel_value(image, pixel * (size_t)image->channels + (size_t)channel);
}

/* Returns the slope along x (channel 0) or along y (channel 1) as it is with green down: y grows downwards. */
static double slope(const WeftImage *image, int x, int y, int channel) {
    return (1.0 - 2.0 * value_at(image, x, y, channel)) / fmax(2.0 * value_at(image, x, y, 2) - 1.0, 0.05);
}

bool normals_green_down(const WeftImage *image) {
    enum { SIDE = 512 }; /* points looked at along a side, at most */
    const double relief = 1e-5, alike = 0.5;
    const int across = 1 + image->width / SIDE, down = 1 + image->height / SIDE;
    double both = 0.0, first = 0.0, second = 0.0, points = 0.0;
    for (int y = 1; image->channels >= 3 && y < image->height - 1; y += down)
        for (int x = 1; x < image->width - 1; x += across) {
            const double p = slope(image, x, y + 1, 0) - slope(image, x, y - 1, 0);
            const double q = slope(image, x + 1, y, 1) - slope(image, x - 1, y, 1);
            both += p * q;
            first += p * p;
            second += q * q;
            points++;
        }
    return points > 0.0 && fmin(first, second) > relief * points && both > alike * sqrt(first * second);
}
