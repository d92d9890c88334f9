/* draft_picture.c - a picture of two colours as a draft, one pixel a crossing, as for jacquard looms
 *
 * A picture of more colours, such as one that JPEG has made noisy, is parted in two by brightness: Nobuyuki Otsu, "A
 * Threshold Selection Method from Gray-Level Histograms", IEEE Transactions on Systems, Man, and Cybernetics 9(1), 1979:
 * of all thresholds, the one whose two classes are farthest from each other for their size, w0 w1 (m0 - m1)^2. */
#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <string.h>

#include "base/fail.h"
#include "image/pixel.h"
#include "weave/weave_draft.h"
#include "weft/image.h"

static size_t pixel_size(const WeftImage *image) { return pixel_type_size(image->type) * (size_t)image->channels; }

static float value_at(const WeftImage *image, size_t k) {
    if (image->type == WEFT_PIXEL_U8) return ((const uint8_t *)image->pixels)[k];
    if (image->type == WEFT_PIXEL_U16) return ((const uint16_t *)image->pixels)[k];
    return ((const float *)image->pixels)[k];
}

/* Returns the sum of a pixel's colours, without alpha. */
static float brightness(const WeftImage *image, size_t pixel) {
    const int colors = image->channels < 3 ? 1 : 3;
    float sum = 0.0f;
    for (int c = 0; c < colors; c++) sum += value_at(image, pixel * (size_t)image->channels + (size_t)c);
    return sum;
}

enum { LEVELS = 256 };

/* The figures of a picture that its draft depends on. */
typedef struct Survey {
    size_t pixels;
    int colors;      /* 1, 2, or 3 for more */
    float low, high; /* the least and the greatest brightness */
    bool finite;     /* every pixel is a number */
} Survey;

static Survey survey_of(const WeftImage *image) {
    const char *bytes = image->pixels;
    const size_t size = pixel_size(image);
    Survey survey = {.pixels = (size_t)image->width * (size_t)image->height, .colors = 1, .finite = true};
    survey.low = survey.high = brightness(image, 0);
    size_t second = 0;
    for (size_t k = 0; k < survey.pixels; k++) {
        const float value = brightness(image, k);
        survey.finite &= isfinite(value) != 0;
        survey.low = fminf(survey.low, value);
        survey.high = fmaxf(survey.high, value);
        if (survey.colors == 3 || memcmp(bytes + k * size, bytes, size) == 0) continue;
        if (!second) second = k;
        survey.colors = memcmp(bytes + k * size, bytes + second * size, size) == 0 ? 2 : 3;
    }
    return survey;
}

/* Returns the brightness below which pixels are dark: between the classes of Otsu, in the middle of the levels from the
 * last dark to the first bright one. */
static float threshold(const WeftImage *image, const Survey *survey) {
    const float low = survey->low, range = survey->high - low;
    double count[LEVELS] = {0}, sum = 0.0, dark = 0.0, dark_sum = 0.0, best = -1.0;
    int first = 0, last = 0;
    for (size_t k = 0; k < survey->pixels; k++) {
        const int level = (int)((brightness(image, k) - low) / range * (float)(LEVELS - 1) + 0.5f);
        count[level] += 1.0;
        sum += (double)level;
    }
    for (int level = 0; level < LEVELS - 1; level++) {
        dark += count[level];
        dark_sum += (double)level * count[level];
        const double bright = (double)survey->pixels - dark;
        if (!(bright > 0.0)) break;
        const double distance = dark_sum / dark - (sum - dark_sum) / bright,
                     between = dark * bright * distance * distance;
        if (between > best * (1.0 + 1e-12)) first = level;
        if (between >= best * (1.0 - 1e-12)) last = level;
        if (between > best) best = between;
    }
    return low + (0.5f * (float)(first + last) + 0.5f) / (float)(LEVELS - 1) * range;
}

/* Makes the draft; the warp is on top at the darker colour. */
static WeftResult from_image(const char *path, const WeftImage *image, WeftDraft **out, const WeftLog *log,
                             WeftError *error) {
    const Survey survey = survey_of(image);
    const bool is_even = survey.colors == 1;
    if (!survey.finite || !isfinite(survey.high - survey.low))
        return fail(error, WEFT_MESSAGE_DRAFT, path, "it has pixels that are no number");
    if (!is_even && !(survey.high > survey.low))
        return fail(error, WEFT_MESSAGE_DRAFT, path, "its %scolours are equally bright",
                    survey.colors == 2 ? "two " : "");
    WeftResult result = draft_create(path, image->width, image->height, WEFT_MESSAGE_DRAFT, out, error);
    if (result != WEFT_OK) return result;
    const float limit = is_even ? survey.high : threshold(image, &survey);
    size_t dark = 0;
    for (size_t k = 0; k < survey.pixels; k++) {
        const size_t row = (size_t)image->height - 1 - k / (size_t)image->width, column = k % (size_t)image->width;
        const bool up = brightness(image, k) <= limit;
        (*out)->up[row * (size_t)image->width + column] = up;
        dark += up;
    }
    if (survey.colors > 2)
        warn(log, WEFT_MESSAGE_DRAFT_COMPLETED, path,
             "it has more than two colours, not one for warp on top and one for weft: the %.3g %% of pixels that are "
             "darker than %.3g %% of its brightness have the warp on top",
             100.0 * (double)dark / (double)survey.pixels,
             100.0 * (double)((limit - survey.low) / (survey.high - survey.low)));
    return WEFT_OK;
}

/* Returns the end of the message about a picture that cannot be read: ": it is WebP", or "" for an unknown format. */
static const char *format_suffix(const WeftError *error) {
    const char *text = weft_message_text(WEFT_MESSAGE_IMAGE_FORMAT), *at = strstr(error->text, text);
    return at ? at + strlen(text) : "";
}

WeftResult draft_from_picture(const char *path, bool text, WeftDraft **out, const WeftLog *log, WeftError *error) {
    WeftImage image;
    WeftError why;
    WeftResult result = weft_image_read(path, &image, log, &why);
    if (result != WEFT_OK && why.message == WEFT_MESSAGE_IMAGE_FORMAT)
        return fail(error, WEFT_MESSAGE_DRAFT, path, "%s%s",
                    text ? "it is text that does not begin with [WIF]" : "it is neither a WIF nor a picture",
                    format_suffix(&why));
    if (result != WEFT_OK && error) *error = why;
    if (result != WEFT_OK) return result;
    result = from_image(path, &image, out, log, error);
    weft_image_free(&image);
    return result;
}
