/* nap.h - the direction in which the fibres of a sheen lean, relative to a viewer
 *
 *   heading = cos(phi),  phi: the azimuth of a direction about the normal, from where the fibres lean
 *
 * 1 along the nap, 0 across it, -1 against it. */
#pragma once

#include "shading/dialect/angles.h"

STRUCT(Nap) {
    float tilt; /* from the normal, radians; 0: there is no nap */
    float x, y; /* where to, in the tangent plane, of unit length */
};

/* Returns the nap with that tilt, in radians, towards a direction. A direction without length is taken as the tangent,
 * as in azimuth_of. */
FN Nap nap_of(float tilt, Dir direction) {
    float r = sqrt(direction.x * direction.x + direction.y * direction.y);
    Nap n;
    n.tilt = tilt;
    n.x = r < 1e-15f ? 1.0f : direction.x / max(r, 1e-15f);
    n.y = r < 1e-15f ? 0.0f : direction.y / max(r, 1e-15f);
    return n;
}

/* Returns the cosine of the azimuth of w from that of the nap; 0 at the normal, where there is no azimuth. */
FN float nap_heading(Nap n, Dir w) {
    float r = sqrt(w.x * w.x + w.y * w.y);
    return clamp((n.x * w.x + n.y * w.y) / max(r, 1e-15f), -1.0f, 1.0f);
}
