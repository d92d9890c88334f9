/* weave_motion.glsl - what a shading point of a moving picture leaves out of a woven material: all points of threads but one,
 * and the slopes along yarns, whose variance makes the lobe wider instead */

/* Returns how far away the cloth is, 0 to 1. The lobes of both systems take over from the point of a thread where four
 * shading points stand side by side on it, since their colours still tell threads apart. */
float pixel_far(WeaveFootprint f) { return weave_far_weight_alone(f); }

int pixel_points(WeaveFootprint f, float far) { return far < 1.0 ? 1 : 0; }

/* Adds the weight of a bin and of its opposite, and that times their squared slope. */
#define ADD_BIN(name)                                                                                        \
    bin = 2.0 * p.bins.name.weight * (p.width - p.taper * p.bins.name.slope * p.bins.name.slope) / p.width;  \
    sum += bin * vec2(1.0, p.bins.name.slope * p.bins.name.slope);                                           \
    p.bins.name.weight = 0.0;

/* Returns lobe woven of a system with the level bin alone, whose D has the variance of the slopes of all, as where 33 are
 * too few in woven_prepare. */
WovenPrepared pixel_afar(bool weft) {
    WovenPrepared p = woven_afar(weft);
    vec2 sum = vec2(p.level, 0.0);
    float bin;
    WOVEN_EACH_BIN(ADD_BIN)
    float square = sum.y / max(sum.x, 1e-12), angle = p.steepest / (1.0 + p.steepest * p.steepest * square);
    float a2 = 1.0 / (1.0 + p.e), wide = a2 + (1.0 - a2) * angle * angle * square;
    p.e = (1.0 - wide) / wide;
    p.level = sum.x * a2 / wide;
    p.count = 1.0;
    return p;
}
