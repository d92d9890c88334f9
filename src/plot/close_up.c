/* close_up.c - a cloth from above, so near that its threads are visible
 *
 * It is lit by a directional light of irradiance pi from the upper left, 35 degrees above the cloth, and by a third as
 * much uniform light. */
#include <math.h>

#include "base/fail.h"
#include "base/thread.h"
#include "shading/dialect/tone.h"
#include "shading/weave/weave_light.h"
#include "weave/weft_cloth.h"

enum { FINE = 4, SIDE_MAX = 8192 }; /* points along a pixel's side */

typedef struct CloseUp {
    const WeftCloth *cloth;
    float step_x, step_y; /* threads a pixel */
    WeftImage *image;
} CloseUp;

static const Dir light = {-0.579f, 0.579f, 0.574f};

/* Adds the radiance that one point of the cloth reflects towards the viewer above it. */
static void add_point(const Weave *m, float x, float y, float spacing, float across, float sum[3]) {
    const Dir o = {0.0f, 0.0f, 1.0f};
    const WeavePoint point = weave_point(m, x, y, spacing, across);
    YarnPrepared yarn;
    YarnView view;
    if (point.height <= WEAVE_NONE) return;
    yarn_prepare(weave_yarn(m, point), &yarn);
    yarn_view(&yarn, o, &view);
    const LobeValue value = yarn_value(&yarn, &view, angles_between(o, light));
    for (int c = 0; c < 3; c++) {
        const float single = weave_single(m, point, c), multiple = weave_multiple(m, point, c);
        const float f = value.f * (single + (multiple - single) * value.s);
        sum[c] += PI * f * light.z * 1.25f + 0.3f * (0.3f * single + 0.7f * multiple) * weave_open(m, point);
    }
}

static void draw_row(void *user, int row, int thread) {
    const CloseUp *d = user;
    const int side = d->image->width;
    uint8_t *to = (uint8_t *)d->image->pixels + 3 * (size_t)row * (size_t)side;
    (void)thread;
    for (int column = 0; column < side; column++) {
        float sum[3] = {0.0f, 0.0f, 0.0f};
        for (int k = 0; k < FINE * FINE; k++) {
            const int a = k % FINE, b = k / FINE; /* sheared: rows of points would beat with threads */
            const float x = (float)column + ((float)a + ((float)b + 0.5f) / FINE) / FINE;
            const float y = (float)(side - 1 - row) + ((float)b + ((float)a + 0.5f) / FINE) / FINE;
            add_point(&d->cloth->weave, x * d->step_x, y * d->step_y, fmaxf(d->step_x, d->step_y) / FINE,
                      2.0f * ((float)((a + b) % FINE) + 0.5f) / FINE - 1.0f, sum);
        }
        for (int c = 0; c < 3; c++)
            to[3 * column + c] =
                (uint8_t)lrintf(255.0f * tone_encode(fminf(fmaxf(sum[c] / (FINE * FINE), 0.0f), 1.0f)));
    }
}

WeftResult weft_cloth_draw(const WeftCloth *cloth, int pixels, float threads, WeftImage *out, WeftError *error) {
    if (pixels < 1 || pixels > SIDE_MAX)
        return fail(error, WEFT_MESSAGE_DESC, "cloth", "%d pixels; 1 to %d are possible", pixels, SIDE_MAX);
    if (!(threads > 0.0f && threads <= 1e5f))
        return fail(error, WEFT_MESSAGE_DESC, "cloth", "%g threads across", (double)threads);
    WeftResult result = weft_image_create(pixels, pixels, 3, WEFT_PIXEL_U8, out, error);
    if (result != WEFT_OK) return result;
    const WeaveYarn *warp = &cloth->weave.warp;
    CloseUp close_up = {.cloth = cloth,
                        .step_x = threads / (float)pixels,
                        .step_y = threads / (float)pixels * warp->pitch / warp->cross_pitch,
                        .image = out};
    parallel_for(0, pixels, draw_row, &close_up);
    return WEFT_OK;
}
