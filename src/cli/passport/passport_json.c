#include <math.h>

#include "cli/passport/passports.h"

static void json_place(Json *json, const char *key, const WeftPlace *place) {
    json_open(json, key, '{');
    json_float(json, "value", place->value);
    json_float(json, "cos_o", place->cos_o);
    if (place->cos_i > 0.0f) {
        json_float(json, "cos_i", place->cos_i);
        json_float(json, "phi", place->phi);
    }
    json_close(json, '}');
}

static void json_albedo(Json *json, const WeftPassport *p) {
    json_open(json, "albedo", '{');
    json_floats(json, "cos_o", p->cosines, WEFT_PASSPORT_COSINES);
    json_open(json, "e", '[');
    for (int row = 0; row < p->rows; row++) json_floats(json, NULL, p->albedo[row], WEFT_PASSPORT_COSINES);
    json_close(json, ']');
    bool tinted = (p->traits & WEFT_LOBE_TINTED) != 0;
    if (tinted) json_open(json, "e_half", '[');
    for (int row = 0; tinted && row < p->rows; row++)
        json_floats(json, NULL, p->albedo_half[row], WEFT_PASSPORT_COSINES);
    if (tinted) json_close(json, ']');
    json_float(json, "most", p->albedo_most);
    json_place(json, "at", &p->albedo_place);
    json_whole(json, "above_one", p->albedo_above);
    json_close(json, '}');
}

static void json_layers(Json *json, const char *key, int layers,
                        const float cells[][WEFT_PASSPORT_SHEENS][WEFT_PASSPORT_VIEWS]) {
    json_open(json, key, '{');
    for (int layer = 0; layer < layers; layer++) {
        json_open(json, weft_layer_name(layer), '[');
        for (int k = 0; k < WEFT_PASSPORT_SHEENS; k++) json_floats(json, NULL, cells[layer][k], WEFT_PASSPORT_VIEWS);
        json_close(json, ']');
    }
    json_close(json, '}');
}

static void json_furnace(Json *json, const WeftPassport *p) {
    json_open(json, "furnace", '{');
    json_floats(json, "roughness", p->sheens, WEFT_PASSPORT_SHEENS);
    json_floats(json, "cos_o", p->views, WEFT_PASSPORT_VIEWS);
    json_layers(json, "layers", p->layers, p->furnace);
    json_layers(json, "noise", p->layers, p->furnace_noise);
    json_float(json, "conserving_most", p->furnace_most);
    json_close(json, '}');
}

static void json_sampling(Json *json, const WeftPassport *p) {
    json_open(json, "sampling", '{');
    json_float(json, "integral_most", p->pdf_most);
    json_place(json, "integral_at", &p->pdf_place);
    json_whole(json, "tests", p->tests);
    json_number(json, "p_least", p->p);
    json_place(json, "p_at", &p->p_place);
    json_number(json, "significance", weft_passport_significance(p->p, p->tests));
    json_whole(json, "stray", p->stray);
    json_float(json, "missed", p->missed);
    json_place(json, "missed_at", &p->missed_place);
    json_floats(json, "cos_o", p->views, WEFT_PASSPORT_VIEWS);
    json_open(json, "variance", '[');
    for (int row = 0; row < p->rows; row++) json_floats(json, NULL, p->variance[row], WEFT_PASSPORT_VIEWS);
    json_close(json, ']');
    json_open(json, "variance_cosine", '[');
    for (int row = 0; row < p->rows; row++) json_floats(json, NULL, p->variance_cosine[row], WEFT_PASSPORT_VIEWS);
    json_close(json, ']');
    json_float(json, "ratio", p->variance_ratio);
    json_float(json, "ratio_worst", p->variance_worst);
    json_float(json, "ratio_worst_value", p->variance_value);
    json_close(json, '}');
}

static void json_sweep(Json *json, const WeftPassport *p) {
    json_open(json, "sweep", '{');
    json_whole(json, "results", p->sweep_count);
    json_whole(json, "not_finite", p->sweep_infinite);
    json_whole(json, "negative", p->sweep_negative);
    json_whole(json, "below_horizon", p->sweep_below);
    json_close(json, '}');
}

/* Writes the floor as a number: 0 if none is needed, null if none helps. */
static void json_floor(Json *json, const char *key, int exponent) {
    json_number(json, key, exponent == 0 ? HUGE_VAL : exponent == WEFT_HALF_FREE ? 0.0 : ldexp(1.0, -exponent));
}

static void json_half(Json *json, const WeftPassport *p) {
    json_open(json, "half", '{');
    json_bool(json, "measured", p->half_measured);
    if (p->half_measured) {
        json_whole(json, "results", p->half_count);
        json_whole(json, "bad", p->half_bad);
        json_open(json, "floor", '[');
        for (int row = 0; row < p->rows; row++) json_floor(json, NULL, p->half_floor[row]);
        json_close(json, ']');
        json_floats(json, "underflow", p->half_zero, p->rows);
        json_floats(json, "off", p->half_off, p->rows);
        if (p->half_place.cos_o > 0.0f) json_place(json, "never_at", &p->half_place);
        json_float(json, "least_value", p->half_parameter);
        json_floor(json, "least_value_floor", p->half_cosine);
    }
    json_close(json, '}');
}

static void json_parity(Json *json, const WeftPassport *p) {
    json_open(json, "parity", '{');
    json_bool(json, "measured", p->parity_measured);
    json_text(json, p->parity_measured ? "driver" : "why", p->parity_words);
    if (p->parity_measured) {
        json_float(json, "worst", p->parity_worst);
        json_float(json, "share_beyond", p->parity_beyond);
    }
    json_close(json, '}');
}

void passport_json(Json *json, const WeftPassport *p) {
    json_open(json, NULL, '{');
    json_text(json, "id", p->id);
    json_text(json, "kind", p->woven ? "weave" : p->profile ? "profile" : "lobe");
    if (*p->surface) json_text(json, "surface", p->surface);
    if (*p->parameter) json_text(json, "parameter", p->parameter);
    json_floats(json, "values", p->values, p->rows);
    json_albedo(json, p);
    json_open(json, "reciprocity", '{');
    json_float(json, "worst", p->reciprocity);
    json_place(json, "at", &p->reciprocity_place);
    json_close(json, '}');
    if (p->layers) json_furnace(json, p);
    json_sampling(json, p);
    json_sweep(json, p);
    json_half(json, p);
    json_parity(json, p);
    json_close(json, '}');
}
