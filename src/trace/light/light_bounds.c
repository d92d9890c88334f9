#include "trace/light/light_bounds.h"

#include "base/pi.h"

static float angle_of(float cosine) { return acosf(fminf(fmaxf(cosine, -1.0f), 1.0f)); }

/* Gives the narrowest cone around those of a and b, of which a is the wider. It leans from a towards b by half the
 * angle by which b reaches beyond a. */
static void join_cones(const LightBounds *a, const LightBounds *b, LightBounds *both) {
    float wide = angle_of(a->cos_spread), narrow = angle_of(b->cos_spread);
    float between = angle_of(vec3_dot(a->axis, b->axis));
    both->axis = a->axis;
    both->cos_spread = a->cos_spread;
    if (between + narrow <= wide) return;
    float spread = 0.5f * (wide + between + narrow), lean = spread - wide;
    Vec3 across = vec3_normal_or(vec3_madd(b->axis, a->axis, -vec3_dot(a->axis, b->axis)), vec3(0, 0, 0));
    both->cos_spread = -1.0f;
    if (spread >= PI_FLOAT || !(vec3_dot(across, across) > 0.0f)) return;
    both->cos_spread = cosf(spread);
    both->axis = vec3_madd(vec3_scale(a->axis, cosf(lean)), across, sinf(lean));
}

LightBounds light_bounds_join(LightBounds a, LightBounds b) {
    if (!(a.power > 0.0f)) return b;
    if (!(b.power > 0.0f)) return a;
    LightBounds both = {.low = vec3_least(a.low, b.low),
                        .high = vec3_most(a.high, b.high),
                        .power = a.power + b.power,
                        .two_sided = a.two_sided || b.two_sided};
    bool first = a.cos_spread <= b.cos_spread;
    join_cones(first ? &a : &b, first ? &b : &a, &both);
    return both;
}

/* Returns the solid angle of the cone of half angle t, plus that of the hemispheres around it weighted by the cosine:
 *
 *   M = 2 pi (1 - cos t) + pi / 2 (2 w sin t - cos(t - 2 w) - 2 t sin t + cos t),  w = min(t + pi / 2, pi)
 *
 * Conty Estevez and Kulla (light_tree.h), equation 1. */
static float directions(float t) {
    float w = fminf(t + 0.5f * PI_FLOAT, PI_FLOAT);
    return 2.0f * PI_FLOAT * (1.0f - cosf(t)) +
           0.5f * PI_FLOAT * (2.0f * w * sinf(t) - cosf(t - 2.0f * w) - 2.0f * t * sinf(t) + cosf(t));
}

float light_bounds_cost(const LightBounds *bounds) {
    Vec3 d = vec3_sub(bounds->high, bounds->low);
    float area = 2.0f * (d.x * d.y + d.y * d.z + d.z * d.x);
    return bounds->power * area * directions(angle_of(bounds->cos_spread));
}
