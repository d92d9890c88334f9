/* lobe_arrays.c - the public face of the array functions */
#include "base/fail.h"
#include "shading/catalogue/albedo.h"
#include "weft/arrays.h"

/* The loops of a lobe may round a pair differently in their vector body and in what is left at their end.
 * So they are only ever given whole groups of LANES, which leave nothing at the end. */
enum { LANES = 64, BLOCK = 512 };

/* Some of the pairs of directions, a whole number of groups. */
typedef struct Pairs {
    size_t used, n; /* used: how many of the n count */
    const float *ox, *oy, *oz, *ix, *iy, *iz;
    float padded[6][LANES];
} Pairs;

static const float *padded(float *to, const float *from, size_t used, float rest) {
    memcpy(to, from, used * sizeof *from);
    for (size_t k = used; k < LANES; k++) to[k] = rest;
    return to;
}

/* Takes the next pairs, from k on, at most BLOCK. Pads the last ones to a whole group. */
static void pairs_take(Pairs *p, size_t k, size_t n, WeftDirections o, WeftDirections i) {
    size_t left = n - k;
    p->used = left >= BLOCK ? BLOCK : left >= LANES ? left - left % LANES : left;
    p->n = left >= LANES ? p->used : LANES;
    p->ox = o.x + k, p->oy = o.y + k, p->oz = o.z + k;
    p->ix = i.x + k, p->iy = i.y + k, p->iz = i.z + k;
    if (left >= LANES) return;
    p->ox = padded(p->padded[0], p->ox, left, 0.0f);
    p->oy = padded(p->padded[1], p->oy, left, 0.0f);
    p->oz = padded(p->padded[2], p->oz, left, 1.0f);
    p->ix = padded(p->padded[3], p->ix, left, 0.0f);
    p->iy = padded(p->padded[4], p->iy, left, 0.0f);
    p->iz = padded(p->padded[5], p->iz, left, 1.0f);
}

static void channel(size_t n, const float *f, const float *s, float first, float second, float *out) {
    if (!out) return;
    if (!s)
        for (size_t k = 0; k < n; k++) out[k] = f[k] * first;
    else
        for (size_t k = 0; k < n; k++) out[k] = f[k] * fresnel_weight_mix(s[k], first, second);
}

static void copy(float *to, const float *from, size_t n) {
    if (to) memcpy(to, from, n * sizeof *to);
}

static void clear(float *array, size_t n) {
    if (array) memset(array, 0, n * sizeof *array);
}

static WeftResult no_lobe(WeftError *error, int lobe) {
    return fail(error, WEFT_MESSAGE_LOBE_NAME, "index", "%d", lobe);
}

static WeftResult missing(WeftError *error, const char *array) {
    return fail(error, WEFT_MESSAGE_DESC, array, "is NULL");
}

static bool given(WeftDirections w) { return w.x && w.y && w.z; }

WeftResult weft_eval_n(const WeftLobe *lobe, size_t n, WeftDirections wo, WeftDirections wi, WeftColors f,
                       WeftError *error) {
    if (n == 0) return WEFT_OK;
    if (!given(wo)) return missing(error, "wo");
    if (!given(wi)) return missing(error, "wi");
    Lobe inner;
    if (!lobe_of(lobe, &inner)) {
        clear(f.r, n), clear(f.g, n), clear(f.b, n);
        return no_lobe(error, lobe->lobe);
    }
    unsigned traits = weft_lobe_info(lobe->lobe)->traits;
    bool two = (traits & TRAIT_TWO_COLORS) != 0;
    float second[3], value[BLOCK], share[BLOCK], red[BLOCK], green[BLOCK], blue[BLOCK];
    for (int c = 0; c < 3; c++) second[c] = lobe_second(&inner, lobe->f0[c], lobe->f90[c]);
    Pairs p;
    for (size_t k = 0; k < n; k += p.used) {
        pairs_take(&p, k, n, wo, wi);
        if (traits & TRAIT_TINTED) {
            lobe_tinted_n(&inner, lobe->f0, p.n, p.ox, p.oy, p.oz, p.ix, p.iy, p.iz,
                          (float *const[3]){red, green, blue});
            copy(f.r ? f.r + k : NULL, red, p.used);
            copy(f.g ? f.g + k : NULL, green, p.used);
            copy(f.b ? f.b + k : NULL, blue, p.used);
            continue;
        }
        lobe_eval_n(&inner, p.n, p.ox, p.oy, p.oz, p.ix, p.iy, p.iz, value, two ? share : NULL);
        const float *s = two ? share : NULL;
        channel(p.used, value, s, lobe->f0[0], second[0], f.r ? f.r + k : NULL);
        channel(p.used, value, s, lobe->f0[1], second[1], f.g ? f.g + k : NULL);
        channel(p.used, value, s, lobe->f0[2], second[2], f.b ? f.b + k : NULL);
    }
    return WEFT_OK;
}

static void density(const Lobe *lobe, size_t n, WeftDirections wo, WeftDirections wi, float *pdf) {
    float value[BLOCK];
    Pairs p;
    for (size_t k = 0; k < n; k += p.used) {
        pairs_take(&p, k, n, wo, wi);
        lobe_pdf_n(lobe, p.n, p.ox, p.oy, p.oz, p.ix, p.iy, p.iz, value);
        memcpy(pdf + k, value, p.used * sizeof *pdf);
    }
}

WeftResult weft_pdf_n(const WeftLobe *lobe, size_t n, WeftDirections wo, WeftDirections wi, float *pdf,
                      WeftError *error) {
    if (n == 0) return WEFT_OK;
    if (!given(wo)) return missing(error, "wo");
    if (!given(wi)) return missing(error, "wi");
    if (!pdf) return missing(error, "pdf");
    Lobe inner;
    if (!lobe_of(lobe, &inner)) {
        clear(pdf, n);
        return no_lobe(error, lobe->lobe);
    }
    density(&inner, n, wo, wi, pdf);
    return WEFT_OK;
}

static float in_unit(float u) { return u > 0.0f ? min(u, 0x1.fffffep-1f) : 0.0f; }

WeftResult weft_sample_n(const WeftLobe *lobe, size_t n, WeftDirections wo, const float *u, const float *v, float *wi_x,
                         float *wi_y, float *wi_z, float *pdf, WeftError *error) {
    if (n == 0) return WEFT_OK;
    if (!given(wo)) return missing(error, "wo");
    if (!u || !v) return missing(error, u ? "v" : "u");
    WeftDirections wi = {wi_x, wi_y, wi_z};
    if (!given(wi)) return missing(error, "wi");
    if (!pdf) return missing(error, "pdf");
    Lobe inner;
    if (!lobe_of(lobe, &inner)) {
        clear(wi_x, n), clear(wi_y, n), clear(wi_z, n), clear(pdf, n);
        return no_lobe(error, lobe->lobe);
    }
    for (size_t k = 0; k < n; k++) {
        Dir o = dir(wo.x[k], wo.y[k], wo.z[k]), i = dir(0.0f, 0.0f, 0.0f);
        if (isfinite(o.x + o.y + o.z) && o.z > 0.0f) i = lobe_sample(&inner, o, in_unit(u[k]), in_unit(v[k]));
        wi_x[k] = i.x, wi_y[k] = i.y, wi_z[k] = i.z;
    }
    density(&inner, n, wo, wi, pdf);
    return WEFT_OK;
}

WeftResult weft_albedo_n(const WeftLobe *lobe, size_t n, const float *cos_o, WeftColors e, WeftError *error) {
    if (n == 0) return WEFT_OK;
    if (!cos_o) return missing(error, "cos_o");
    if (!weft_lobe_info(lobe->lobe)) {
        clear(e.r, n), clear(e.g, n), clear(e.b, n);
        return no_lobe(error, lobe->lobe);
    }
    for (size_t k = 0; k < n; k++) {
        float color[3];
        weft_lobe_albedo(lobe, cos_o[k], color);
        if (e.r) e.r[k] = color[0];
        if (e.g) e.g[k] = color[1];
        if (e.b) e.b[k] = color[2];
    }
    return WEFT_OK;
}
