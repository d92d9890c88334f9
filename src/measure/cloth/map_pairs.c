#include "measure/cloth/map_pairs.h"

#include <math.h>

#include "base/pi.h"
#include "measure/bsdf/halton.h"

/* Returns the direction with that cosine to the normal, at an azimuth in parts of a circle. */
static Dir direction_of(double z, double part) {
    const double r = (sqrt)(fmax(1.0 - z * z, 0.0)), phi = 2.0 * PI_DOUBLE * part;
    return dir((float)(r * (cos)(phi)), (float)(r * (sin)(phi)), (float)z);
}

/* Adds the lights at one point of the ball: `off` degrees from the viewer, on a cone about it, of which every other one is in
 * the plane of viewer and normal. */
static void add_lights(MapPairs *pairs, int normal) {
    static const double off[MAP_LIGHTS] = {12.0, 37.0, 72.0, 95.0, 128.0};
    const Dir o = pairs->o[normal];
    const Frame view = frame_about(o, dir(-o.z, 0.0f, o.x), 1.0f); /* x towards the normal's side */
    for (int k = 0; k < MAP_LIGHTS; k++) {
        const double aside = (normal + k) % 2 ? halton(normal * MAP_LIGHTS + k + 1, 5) : 0.5 * (normal / 2 % 2);
        const Dir w = direction_of((cos)(off[k] * PI_DOUBLE / 180.0), aside);
        pairs->i[normal * MAP_LIGHTS + k] = frame_from(view, w);
    }
}

Dir map_sky_in(int n, int count, int sky) {
    return direction_of((sqrt)((n + 0.5) / count), halton(n + 1, 2) + halton(sky + 1, 7));
}

MapPairs map_pairs(void) {
    MapPairs pairs = {.first = {0}};
    for (int k = 0; k < MAP_NORMALS; k++) {
        /* even over the disc of the ball, up to 75 degrees */
        pairs.o[k] = direction_of((sqrt)(1.0 - 0.933 * (k + 0.5) / MAP_NORMALS), halton(k + 1, 2));
        pairs.first[k] = k * MAP_LIGHTS;
        add_lights(&pairs, k);
    }
    for (int k = 0; k < MAP_SKIES; k++) {
        const int out = MAP_NORMALS + k, first = MAP_CONTRASTS + k * MAP_SKY_INS;
        pairs.o[out] = direction_of((sqrt)(1.0 - 0.933 * (k + 0.5) / MAP_SKIES), halton(k + 1, 3));
        pairs.first[out] = first;
        for (int n = 0; n < MAP_SKY_INS; n++) pairs.i[first + n] = map_sky_in(n, MAP_SKY_INS, k);
    }
    pairs.first[MAP_OUTS] = MAP_PAIRS;
    return pairs;
}
