/* proxy.h - the linearly transformed cosine that stands for a lobe under polygon lights (area.h): a lobe's
 * file names it (lobe.h), and reads no table for that */
#pragma once

#include "shading/dialect/lang.h"

#define PROXY_COSINE 0 /* for broad lobes: the cosine itself */
#define PROXY_FACETS 1 /* fitted to ggx of the widths ax and ay */
#define PROXY_FIBRES 2 /* fitted to upright fibres of alpha ax */

STRUCT(Proxy) {
    int fit; /* PROXY_... */
    float ax, ay;
};

FN Proxy proxy_of(int fit, float ax, float ay) {
    Proxy p;
    p.fit = fit;
    p.ax = ax;
    p.ay = ay;
    return p;
}

FN Proxy proxy_cosine(void) { return proxy_of(PROXY_COSINE, 1.0f, 1.0f); }
FN Proxy proxy_facets(float ax, float ay) { return proxy_of(PROXY_FACETS, ax, ay); }
FN Proxy proxy_fibres(float alpha) { return proxy_of(PROXY_FIBRES, alpha, alpha); }
