/* disc.glsl - points on a disc */

/* Returns point k of n on a disc: Helmut Vogel, "A better way to construct the sunflower head",
 * Mathematical Biosciences 44, 1979. */
vec2 disc_point(float k, float n) {
    float angle = k * 2.39996323;
    return sqrt((k + 0.5) / n) * vec2(cos(angle), sin(angle));
}
