#include "measure/match/match_texels.h"

#include <math.h>
#include <stdlib.h>

#include "base/fail.h"
#include "base/memory.h"
#include "gltf/asset/material_fields.h"
#include "image/pixel.h"
#include "measure/bsdf/halton.h"
#include "measure/match/match_factor.h"
#include "measure/match/match_place.h"
#include "shading/dialect/tone.h"
#include "shading/material/choice.h"

/* The inputs whose textures may be rewritten. */
static const InputId inputs[] = {INPUT_sheen_color, INPUT_base_color, INPUT_sheen_roughness, INPUT_roughness};
enum { EDITS_MOST = sizeof inputs / sizeof *inputs };

/* The ways in which a texel changes: it is multiplied by a number, goes through a curve, or a colour has the gain of the
 * sheen that is there. */
typedef enum EditKind { EDIT_SCALE, EDIT_CURVE, EDIT_GAIN } EditKind;

/* The new texels of one input. */
typedef struct TexelEdit {
    EditKind kind;
    InputId input;
    json_t *info;     /* the textureInfo that is changed, or from which a new one is made; borrowed */
    int texture;      /* of the file: is rewritten; -1: there is none yet */
    int canvas;       /* index of the image that it is part of */
    double factor[3]; /* by which the new texels are multiplied */
} TexelEdit;

/* A new image. */
typedef struct Canvas {
    int texture; /* of the file; -1: none, white */
    int like;    /* texture of the file whose sampler it has */
    bool taken[4];
    WeftImage image;
} Canvas;

/* The materials that may be written: as it is, with other factors, with other textures. */
typedef enum Offer { OFFER_COPY, OFFER_FACTORS, OFFER_TEXELS, OFFERS } Offer;

/* The errors of what may be written, at one texel. */
typedef struct Weighed {
    double errors[OFFERS];
    WeftResult result;
    WeftError error;
} Weighed;

enum { TEXELS_WEIGHED = 16 };

typedef struct TexelWork {
    const TexelMatch *match;
    const WeftMaterial *to; /* with the factors of what is not edited */
    Weighed weighed[TEXELS_WEIGHED];
    TexelEdit edits[EDITS_MOST];
    Canvas canvases[EDITS_MOST];
    int edit_count, canvas_count;
    const TexelEdit *now; /* in hand */
    double *most;         /* of each row and channel */
    LoopWatch watch;
} TexelWork;

static const Input *input_of(const TexelMatch *match, InputId input) { return &match->material->inputs[input]; }

bool texels_joined(const WeftMaterial *material) {
    const Input *color = &material->inputs[INPUT_sheen_color], *roughness = &material->inputs[INPUT_sheen_roughness];
    return !color->texture || !roughness->texture || place_same(color, roughness);
}

/* Returns the textureInfo of an input in the JSON, NULL if there is none. */
static json_t *info_of(json_t *material, InputId input) {
    const MaterialField *field = material_field_of(input);
    json_t *home = material_field_extends(field) ? json_object_get(material, "extensions") : material;
    json_t *info = json_object_get(json_object_get(home, field->object), field->texture);
    return json_is_integer(json_object_get(info, "index")) ? info : NULL;
}

static int index_of(const json_t *info) { return info ? (int)json_integer_value(json_object_get(info, "index")) : -1; }

/* Returns true if a factor would have to exceed 1, the limit of glTF. */
static bool exceeds(const TexelMatch *match, InputId input) {
    bool beyond = false;
    for (int c = 0; c < input_value_count(input); c++)
        beyond |= (double)match->factors->inputs[input].value[c] > 1.0 + 1e-6;
    return beyond;
}

/* Returns true if an input whose curve is a factor has it in `to`. */
static bool factor_does(const TexelMatch *match, InputId input, WeftMaterial *to) {
    double factor = 1.0;
    const bool is_factor = input == INPUT_roughness ? curves_roughness_is_factor(match->curves, &factor)
                                                    : curves_sheen_is_factor(match->curves, &factor);
    factor *= (double)input_of(match, input)->value[0];
    if (is_factor && factor <= 1.0) to->inputs[input].value[0] = (float)factor;
    return is_factor && factor <= 1.0;
}

/* Returns true if the texels of an input have to change, and sets the kind. */
static bool edit_needed(const TexelMatch *match, json_t *material, InputId input, WeftMaterial *to, TexelEdit *edit) {
    const bool colored = input_value_count(input) > 1, textured = input_of(match, input)->texture != 0;
    const bool curved = input == INPUT_roughness ? match->curves->roughnesses > 1 : match->curves->columns > 1;
    json_t *own = info_of(material, input), *driver = info_of(material, place_driver(match->curves));
    *edit = (TexelEdit){.kind = EDIT_SCALE, .input = input, .info = own, .texture = textured ? index_of(own) : -1};
    if (textured && !own) return false; /* the texture is that of another extension */
    if (colored && driver && curves_gain_varies(match->curves, input == INPUT_base_color) &&
        (!textured || place_same(input_of(match, input), input_of(match, place_driver(match->curves))))) {
        edit->kind = EDIT_GAIN;
        if (!textured) edit->info = driver;
        return true;
    }
    if (!textured) return false;
    if (colored || !curved) return exceeds(match, input);
    edit->kind = EDIT_CURVE;
    return !factor_does(match, input, to);
}

static Texel texel_of(const TexelMatch *match, InputId input, float u, float v) {
    return place_texel(match->scene, match->material, input, u, v);
}

static double number_at(const TexelMatch *match, InputId input, float u, float v) {
    return place_number(match->scene, match->material, input, u, v);
}

/* Computes what becomes of the sheen at a place. */
static SheenTexel sheen_at(const TexelMatch *match, float u, float v) {
    return curves_sheen(match->curves, number_at(match, INPUT_sheen_roughness, u, v),
                        place_brightness(match->scene, match->material, u, v));
}

/* Computes the new values of an input at a place. */
static void values_at(const TexelMatch *match, const TexelEdit *edit, float u, float v, double out[3]) {
    const Input *input = input_of(match, edit->input);
    const int count = input_value_count(edit->input);
    const Texel texel = texel_of(match, edit->input, u, v);
    if (edit->kind == EDIT_CURVE) {
        const double was = number_at(match, edit->input, u, v);
        out[0] = edit->input == INPUT_roughness ? curves_roughness(match->curves, was)
                                                : curves_sheen(match->curves, was, 0.0).roughness;
        return;
    }
    SheenTexel sheen = {0};
    if (edit->kind == EDIT_GAIN) sheen = sheen_at(match, u, v);
    const double *gain = edit->input == INPUT_base_color ? sheen.base_gain : sheen.sheen_gain;
    for (int c = 0; c < count; c++) {
        const double was = (double)texel.c[count == 1 ? input->channel : c];
        out[c] = edit->kind == EDIT_GAIN ? was * (double)input->value[c] * gain[c]
                                         : was * (double)match->factors->inputs[edit->input].value[c];
    }
}

static void pixel_set(WeftImage *image, size_t at, double value) {
    const double unit = fmin(fmax(value, 0.0), 1.0);
    if (image->type == WEFT_PIXEL_U16)
        ((uint16_t *)image->pixels)[at] = (uint16_t)(unit * 65535.0 + 0.5);
    else
        ((uint8_t *)image->pixels)[at] = (uint8_t)(unit * 255.0 + 0.5);
}

static const WeftImage *canvas_of(const TexelWork *self) { return &self->canvases[self->now->canvas].image; }

/* Computes the greatest values of a row, or writes it once the factors are known. */
static void row_done(TexelWork *self, int y, bool write) {
    const TexelEdit *edit = self->now;
    const WeftImage *image = canvas_of(self);
    const int count = input_value_count(edit->input);
    const float v = ((float)y + 0.5f) / (float)image->height;
    for (int x = 0; x < image->width; x++) {
        double value[3] = {0.0};
        values_at(self->match, edit, ((float)x + 0.5f) / (float)image->width, v, value);
        const size_t pixel = ((size_t)y * (size_t)image->width + (size_t)x) * (size_t)image->channels;
        for (int c = 0; c < count; c++) {
            double *most = &self->most[(size_t)y * 3 + (size_t)c];
            if (!write) {
                *most = fmax(*most, value[c]);
                continue;
            }
            const double texel = value[c] / edit->factor[c];
            const int channel = count == 1 ? input_of(self->match, edit->input)->channel : c;
            pixel_set(&self->canvases[edit->canvas].image, pixel + (size_t)channel,
                      count == 1 ? texel : (double)tone_encode((float)fmin(texel, 1.0)));
        }
    }
}

static void row_measure(void *user, int y, int thread) {
    (void)thread;
    row_done(user, y, false);
}

static void row_write(void *user, int y, int thread) {
    (void)thread;
    row_done(user, y, true);
}

/* Computes the factors: the greatest values, so that the texels use the whole range. */
static void factors_of(TexelWork *self, TexelEdit *edit) {
    const int height = canvas_of(self)->height;
    for (int c = 0; c < input_value_count(edit->input); c++) {
        double most = 0.0;
        for (int y = 0; y < height; y++) most = fmax(most, self->most[(size_t)y * 3 + (size_t)c]);
        edit->factor[c] = most > 0.0 ? fmin(most, 1.0) : 1.0;
    }
}

static int while_rewriting(void *user, double fraction) {
    const TexelMatch *match = user;
    (void)fraction;
    return match->progress ? match->progress(match->user, 1.0) : 0;
}

static WeftResult edit_run(TexelWork *self, TexelEdit *edit, WeftError *error) {
    self->now = edit;
    const int height = canvas_of(self)->height;
    TexelMatch match = *self->match;
    if (while_rewriting(&match, 1.0)) return WEFT_INTERRUPTED;
    self->most = alloc_array((size_t)height, 3 * sizeof(double));
    if (!self->most) return fail(error, WEFT_MESSAGE_MEMORY, "a match", NULL);
    bool whole = watch_loop(&self->watch, 0, height, row_measure, self, while_rewriting, &match);
    if (whole) {
        factors_of(self, edit);
        whole = watch_loop(&self->watch, 0, height, row_write, self, while_rewriting, &match);
    }
    free(self->most);
    return whole ? WEFT_OK : WEFT_INTERRUPTED;
}

/* Copies an image into a canvas of three or four channels, which is white without one. */
static void canvas_fill(WeftImage *image, const WeftImage *from) {
    const size_t pixels = (size_t)image->width * (size_t)image->height, channels = (size_t)image->channels;
    for (size_t k = 0; k < pixels; k++)
        for (size_t c = 0; c < channels; c++) {
            const size_t of = from ? (size_t)from->channels : 0;
            const bool has_alpha = of == 2 || of == 4;
            const size_t at = c == 3 ? of - 1 : of < 3 ? 0 : c;
            const bool white = !from || (c == 3 && !has_alpha);
            pixel_set(image, k * channels + c, white ? 1.0 : pixel_value(from, k * of + at));
        }
}

static bool edit_takes(const TexelMatch *match, const TexelEdit *edit, int channel) {
    return input_value_count(edit->input) > 1 ? channel < 3 : channel == input_of(match, edit->input)->channel;
}

/* Returns the canvas of that texture whose channels the edit finds free, or -1. */
static int canvas_find(const TexelWork *self, const TexelEdit *edit) {
    for (int k = 0; k < self->canvas_count; k++) {
        const Canvas *canvas = &self->canvases[k];
        bool is_free = canvas->texture == edit->texture && edit->texture >= 0;
        for (int c = 0; c < 4; c++) is_free = is_free && !(canvas->taken[c] && edit_takes(self->match, edit, c));
        if (is_free) return k;
    }
    return -1;
}

/* Makes the canvas of an edit, or takes one that there is. */
static WeftResult canvas_for(TexelWork *self, TexelEdit *edit, WeftError *error) {
    const TexelMatch *match = self->match;
    edit->canvas = canvas_find(self, edit);
    WeftResult result = WEFT_OK;
    if (edit->canvas < 0) {
        edit->canvas = self->canvas_count++;
        const InputId shown = edit->texture < 0 ? place_driver(match->curves) : edit->input;
        const WeftImage *from =
            &match->scene->images[match->scene->textures[input_of(match, shown)->texture - 1].image];
        Canvas *canvas = &self->canvases[edit->canvas];
        *canvas = (Canvas){.texture = edit->texture, .like = index_of(edit->info)};
        const bool is_alpha = edit->texture >= 0 && (from->channels == 2 || from->channels == 4);
        const WeftPixelType type = from->type == WEFT_PIXEL_U8 ? WEFT_PIXEL_U8 : WEFT_PIXEL_U16;
        result = weft_image_create(from->width, from->height, is_alpha || edit_takes(match, edit, 3) ? 4 : 3, type,
                                   &canvas->image, error);
        if (result == WEFT_OK) canvas_fill(&canvas->image, edit->texture < 0 ? NULL : from);
    }
    for (int c = 0; c < 4; c++) self->canvases[edit->canvas].taken[c] |= edit_takes(match, edit, c);
    return result;
}

/* Makes an input name a new texture. */
static WeftResult info_set(json_t *material, const TexelEdit *edit, int texture, const char *name, WeftError *error) {
    const MaterialField *field = material_field_of(edit->input);
    json_t *home =
        factor_home(material_field_extends(field) ? factor_home(material, "extensions") : material, field->object);
    json_t *info = edit->texture < 0 ? json_deep_copy(edit->info) : json_incref(edit->info);
    int failed = json_object_set_new(info, "index", json_integer(texture));
    failed |= json_object_set_new(home, field->texture, info);
    return failed ? fail(error, WEFT_MESSAGE_MEMORY, name, NULL) : WEFT_OK;
}

/* Adds the images to the file and names them. */
static WeftResult images_add(TexelWork *self, Rewrite *rewrite, json_t *material, WeftError *error) {
    int textures[EDITS_MOST];
    WeftResult result = WEFT_OK;
    for (int k = 0; k < self->canvas_count && result == WEFT_OK; k++) {
        const Canvas *canvas = &self->canvases[k];
        result = rewrite_image(rewrite, &canvas->image, 1, !canvas->taken[0], canvas->like, &textures[k], error);
    }
    for (int k = 0; k < self->edit_count && result == WEFT_OK; k++)
        result = info_set(material, &self->edits[k], textures[self->edits[k].canvas], rewrite->asset->name, error);
    return result;
}

static WeftResult edits_run(TexelWork *self, Rewrite *rewrite, json_t *material, WeftError *error) {
    WeftResult result = WEFT_OK;
    for (int k = 0; k < self->edit_count && result == WEFT_OK; k++) {
        result = canvas_for(self, &self->edits[k], error);
        if (result == WEFT_OK) result = edit_run(self, &self->edits[k], error);
    }
    if (result == WEFT_OK) result = images_add(self, rewrite, material, error);
    for (int k = 0; k < self->canvas_count; k++) weft_image_free(&self->canvases[k].image);
    return result;
}

static const TexelEdit *edit_of(const TexelWork *self, int input) {
    for (int k = 0; k < self->edit_count; k++)
        if ((int)self->edits[k].input == input) return &self->edits[k];
    return NULL;
}

static bool is_matched(InputId input) {
    bool one = input == INPUT_specular;
    for (int k = 0; k < EDITS_MOST; k++) one |= inputs[k] == input;
    return one;
}

/* Makes the material that a texel shows: as the file has it, or as what may be written would. */
static WeftMaterial texel_material(const TexelWork *self, Offer offer, float u, float v) {
    const TexelMatch *match = self->match;
    WeftMaterial out = *match->material;
    for (int k = 0; k < INPUT_COUNT; k++) {
        WeftInput *input = &out.inputs[k];
        const WeftInputKind kind = input_infos[k].kind;
        const TexelEdit *edit = offer == OFFER_TEXELS ? edit_of(self, k) : NULL;
        const WeftMaterial *numbers = offer == OFFER_TEXELS ? self->to : match->factors;
        const Texel texel = texel_of(match, (InputId)k, u, v);
        double value[3] = {0.0};
        if (edit) values_at(match, edit, u, v, value);
        for (int c = 0; c < input_value_count((InputId)k); c++) {
            const bool is_number = kind == WEFT_INPUT_COLOR || kind == WEFT_INPUT_SCALAR;
            if (offer != OFFER_COPY && is_matched((InputId)k))
                input->value[c] = fminf(numbers->inputs[k].value[c], 1.0f);
            if (input->texture && is_number) input->value[c] *= texel.c[kind == WEFT_INPUT_COLOR ? c : input->channel];
            if (edit) input->value[c] = (float)fmin(value[c], 1.0);
        }
        input->texture = 0;
    }
    return out;
}

/* Computes the errors at one texel. */
static void texel_weigh(void *user, int item, int thread) {
    (void)thread;
    TexelWork *self = user;
    Weighed *weighed = &self->weighed[item];
    const float u = (float)halton(item + 1, 2), v = (float)halton(item + 1, 3);
    WeftReflection *original = NULL;
    WeftMaterial source = texel_material(self, OFFER_COPY, u, v);
    weft_material_choose(&source, CHOICE_profile, self->match->from);
    weighed->result = weft_reflection_create(&source, &original, &weighed->error);
    for (Offer offer = OFFER_COPY; offer < OFFERS && weighed->result == WEFT_OK; offer++) {
        WeftReflection *other = NULL;
        WeftMaterial material = texel_material(self, offer, u, v);
        weft_material_choose(&material, CHOICE_profile, self->match->to);
        weighed->result = weft_reflection_create(&material, &other, &weighed->error);
        if (weighed->result == WEFT_OK)
            weighed->result = weft_brdf_distance(other, original, WEFT_PART_ALL, self->match->metric,
                                                 &weighed->errors[offer], &weighed->error);
        weft_reflection_free(other);
    }
    weft_reflection_free(original);
}

/* Finds what is nearest at the texels, and the errors. */
static WeftResult offers_weigh(TexelWork *self, Offer *best, WeftMatch *found, WeftError *error) {
    TexelMatch match = *self->match;
    double sums[OFFERS] = {0.0};
    if (!watch_loop(&self->watch, 0, TEXELS_WEIGHED, texel_weigh, self, while_rewriting, &match))
        return WEFT_INTERRUPTED;
    for (int k = 0; k < TEXELS_WEIGHED; k++) {
        const Weighed *weighed = &self->weighed[k];
        if (weighed->result != WEFT_OK && error) *error = weighed->error;
        if (weighed->result != WEFT_OK) return weighed->result;
        for (int n = 0; n < OFFERS; n++) sums[n] += weighed->errors[n] / TEXELS_WEIGHED;
    }
    for (Offer offer = OFFER_TEXELS; offer-- > 0;)
        if (sums[offer] < sums[*best]) *best = offer;
    found->copied = sums[OFFER_COPY];
    found->matched = sums[*best];
    return WEFT_OK;
}

static bool has_textures(const WeftMaterial *material) {
    bool any = false;
    for (int k = 0; k < INPUT_COUNT; k++) {
        const WeftInputKind kind = input_infos[k].kind;
        any |= material->inputs[k].texture && (kind == WEFT_INPUT_COLOR || kind == WEFT_INPUT_SCALAR);
    }
    return any;
}

/* Takes the factors of what is nearest. */
static void offer_take(const TexelMatch *match, Offer offer, WeftMaterial *to) {
    for (int k = 0; k < INPUT_COUNT && offer != OFFER_TEXELS; k++) {
        const WeftMaterial *from = offer == OFFER_COPY ? match->material : match->factors;
        for (int c = 0; c < 3 && is_matched((InputId)k); c++)
            to->inputs[k].value[c] = fminf(from->inputs[k].value[c], 1.0f);
    }
}

WeftResult texels_rewrite(const TexelMatch *match, Rewrite *rewrite, json_t *material, WeftMaterial *to, uint64_t *maps,
                          WeftMatch *found, WeftError *error) {
    TexelWork self = {.match = match, .to = to};
    Offer offer = OFFER_TEXELS;
    WeftResult result = WEFT_OK;
    for (int k = 0; k < EDITS_MOST; k++)
        self.edit_count += edit_needed(match, material, inputs[k], to, &self.edits[self.edit_count]);
    if (has_textures(match->material)) result = offers_weigh(&self, &offer, found, error);
    if (result != WEFT_OK) return result;
    offer_take(match, offer, to);
    if (offer == OFFER_TEXELS) result = edits_run(&self, rewrite, material, error);
    for (int k = 0; k < self.edit_count && result == WEFT_OK && offer == OFFER_TEXELS; k++) {
        const TexelEdit *edit = &self.edits[k];
        for (int c = 0; c < input_value_count(edit->input); c++)
            to->inputs[edit->input].value[c] = (float)edit->factor[c];
        *maps |= (uint64_t)1 << edit->input;
    }
    return result;
}
