/* ambient_view.h - a point under an environment, viewed from wo: its frame, its occlusion, its visible radiance
 *
 * Occlusion is one number, the visible part of the cosine-weighted sky. A lobe of another shape sees more of the sky or
 * less, so each look-up is dimmed by ambient_sky_visibility in its own direction, and each light by
 * ambient_light_visibility. A source that has no more than the number dims a look-up by a cone about the normal
 * (occlusion_cone.h). It dims a light by the number itself, because a cone would hide the light wholly or not at all. */
#pragma once

#include "shading/ambient/ambient_source.h"

STRUCT(AmbientView) {
    Dir o;           /* wo in the lobe's frame */
    float tx, ty;    /* cosine and sine of the azimuth of wo in the lobe's frame */
    float heading;   /* cosine of the azimuth of wo from that of the lobe's nap (nap.h) */
    Dir x, y, z;     /* axes of the lobe's frame, in the frame of the source */
    float occlusion; /* visible part of the cosine-weighted sky, 0 to 1 */
};

FN AmbientView ambient_view(Dir o, Dir x, Dir y, Dir z, float occlusion) {
    AmbientView v;
    float s = sqrt(o.x * o.x + o.y * o.y), r = 1.0f / max(s, 1e-6f);
    v.o = o;
    v.tx = s > 1e-6f ? o.x * r : 1.0f;
    v.ty = s > 1e-6f ? o.y * r : 0.0f;
    v.heading = v.tx;
    v.x = x;
    v.y = y;
    v.z = z;
    v.occlusion = occlusion;
    return v;
}

/* Transforms a direction of the lobe's frame into the frame of the source. */
FN Dir ambient_to_source(AmbientView v, Dir w) {
    return dir(w.x * v.x.x + w.y * v.y.x + w.z * v.z.x, w.x * v.x.y + w.y * v.y.y + w.z * v.z.y,
               w.x * v.x.z + w.y * v.y.z + w.z * v.z.z);
}

/* Transforms w into the lobe's frame. w is given in the lobe's frame rotated about z so that x points towards
 * wo. */
FN Dir ambient_to_lobe(AmbientView v, Dir w) { return dir(w.x * v.tx - w.y * v.ty, w.x * v.ty + w.y * v.tx, w.z); }

/* Returns the visible part of `all`, the radiance about w with the lights in it. open: the factor on the residual.
 * lights: the factor on what the lights add to it. */
FN Rgb ambient_visible_radiance(AmbientSource s, Dir w, Rgb all, float kappa, float lights, float open) {
    Rgb residual = ambient_residual(s, w, kappa);
    residual = rgb(min(residual.r, all.r), min(residual.g, all.g), min(residual.b, all.b));
    return rgb_add(rgb_scale(residual, open), rgb_scale(rgb_add(all, rgb_scale(residual, -1.0f)), lights));
}

/* The reflected light of a lobe, for each of its two colours, before these colours are applied. */
STRUCT(LobeLight) { Rgb first, second; };

FN LobeLight lobe_light_of(Rgb radiance, float first, float second) {
    LobeLight p;
    p.first = rgb_scale(radiance, first);
    p.second = rgb_scale(radiance, second);
    return p;
}
FN LobeLight lobe_light_add(LobeLight a, LobeLight b) {
    LobeLight p;
    p.first = rgb_add(a.first, b.first);
    p.second = rgb_add(a.second, b.second);
    return p;
}
FN LobeLight lobe_light_scale(LobeLight a, float scale) {
    LobeLight p;
    p.first = rgb_scale(a.first, scale);
    p.second = rgb_scale(a.second, scale);
    return p;
}
FN LobeLight lobe_light_mix(LobeLight a, LobeLight b, float t) {
    LobeLight p;
    p.first = rgb_mix(a.first, b.first, t);
    p.second = rgb_mix(a.second, b.second, t);
    return p;
}
