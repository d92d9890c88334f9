/* writer - the toy of tests, with functions that write through references to numbers
 *
 *   f = 0.36 t c (k + 2) / (2 pi) (cos_o cos_i)^k,   k = 1 - roughness                           [1/sr]
 *   t = cos_i^k where that is above 1/2, else a tenth of it
 *
 *   Made for weft's tests, 2026. c = color, the second colour c c, mixed as the toy's.
 *   roughness: as it is; 1 is Lambert in front.
 *   reciprocal: no.
 *   energy: E <= color cos_o^k.
 *   sampling: by cos_i^(k + 1). */
#ifndef WEFT_WRITER_H
#define WEFT_WRITER_H

#include "shading/lobe.h"

#define WRITER_PARAMS(P)                                                                                               \
    P(float, roughness, 0.5f, 0.0f, 1.0f, 0.0f, 1.0f, "how slowly it darkens towards the edge")                        \
    P(float, fade, 1.0f, 0.0f, 1.0f, 0.0f, 1.0f, "how much of the second colour the edge shows")
#define WRITER_TRAITS (TRAIT_CONSERVES | TRAIT_TWO_COLORS)

STRUCT(Writer){WRITER_PARAMS(FIELD)};

STRUCT(WriterPrepared) { float power, scale, fade; };
FN void writer_prepare(Writer m, WriterPrepared *p) {
    p->power = 1.0f - m.roughness;
    p->scale = (p->power + 2.0f) / (2.0f * PI);
    p->fade = m.fade;
}

STRUCT(WriterView) { float factor, away; };
FN void writer_view(const WriterPrepared *p, Dir o, WriterView *w) {
    w->factor = p->scale * pow(max(o.z, 1e-6f), p->power);
    w->away = p->fade * (1.0f - o.z);
}

FN float writer_second(Writer m, float f0, float f90) { return f0 * f0; }

/* Its value is not asked for, but what it writes is. */
FN float writer_halve(float *x) {
    *x = *x * 0.5f;
    return *x;
}

/* The second round reads what the first has written. */
FN void writer_most(float v, int k, float *m) {
    if (k == 0) {
        *m = v;
    } else {
        *m = max(*m, v);
    }
}

FN void writer_above(float *m, float v) {
    if (v > 0.5f)
        *m = v;
    else
        *m = v * *m;
}

FN LobeValue writer_value(const WriterPrepared *p, const WriterView *w, Angles a) {
    float i = pow(max(a.i.z, 1e-6f), p->power), part = 0.8f, above = 0.1f, most;
    float ignored = writer_halve(&part);
    for (int k = 0; k < 3; k++) {
        writer_most(0.9f - 0.1f * to_float(k), k, &most);
    }
    writer_above(&above, i);
    i = i * part * most * above;
    return lobe_value_of(w->factor * i, w->away * (1.0f - a.i.z), p->scale * i * a.i.z);
}

FN Dir writer_sample(const WriterPrepared *p, const WriterView *w, Dir o, float u, float v) {
    float z = pow(1.0f - u, 1.0f / (p->power + 2.0f)), r = sqrt(max(1.0f - z * z, 0.0f)), phi = 2.0f * PI * v;
    return dir(r * cos(phi), r * sin(phi), z);
}

#endif
