#include "view/state/brush.h"

#include <math.h>

static int wrapped(int k, int n) {
    k %= n;
    return k < 0 ? k + n : k;
}

static unsigned char coded(float x) { return (unsigned char)(127.5f + 127.5f * x + 0.5f); }

/* Rotates a direction of the nap towards `along`. Directions are mixed as vectors of the length of their lean, lean' =
 * (1 - w) lean + w, and normalised; where they are opposite the new one replaces the old one. */
static void rotate_towards(unsigned char *texel, const float along[2], float w) {
    float lean = (float)texel[2] / 255.0f, was = (1.0f - w) * lean;
    float x = was * ((float)texel[0] / 127.5f - 1.0f) + w * along[0],
          y = was * ((float)texel[1] / 127.5f - 1.0f) + w * along[1], n = sqrtf(x * x + y * y);
    if (!(n > 0.05f * (was + w))) x = along[0], y = along[1], n = 1.0f;
    texel[0] = coded(x / n), texel[1] = coded(y / n);
    texel[2] = (unsigned char)(255.0f * (was + w) + 0.5f);
}

void brush_stroke(WeftImage *nap, const float at[2], float radius, const float along[2], float strength) {
    int width = nap->width, height = nap->height;
    float n = sqrtf(along[0] * along[0] + along[1] * along[1]);
    if (!(n > 0.0f) || !isfinite(at[0]) || !isfinite(at[1]) || !(radius > 0.0f)) return;
    const float unit[2] = {along[0] / n, along[1] / n};
    float reach = fminf(radius, 0.5f);
    float u = at[0] - floorf(at[0]), v = at[1] - floorf(at[1]);
    int across = (int)ceilf(reach * (float)width), down = (int)ceilf(reach * (float)height);
    int cx = (int)(u * (float)width), cy = (int)(v * (float)height);
    unsigned char *pixels = nap->pixels;
    for (int y = cy - down; y <= cy + down; y++)
        for (int x = cx - across; x <= cx + across; x++) {
            float du = ((float)x + 0.5f) / (float)width - u, dv = ((float)y + 0.5f) / (float)height - v;
            float d = sqrtf(du * du + dv * dv) / reach, fall = 1.0f - d * d;
            if (!(d < 1.0f)) continue;
            rotate_towards(pixels + 3 * ((size_t)wrapped(y, height) * (size_t)width + (size_t)wrapped(x, width)), unit,
                           strength * fall * fall);
        }
}
