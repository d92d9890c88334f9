/* weave_sky.glsl - what the systems of a cloth reflect of an even sky (raster/material/cloth_sky.h) */

/* Returns the amplitudes of a wave. */
vec4 weave_sky_wave(int wave, float t) {
    int first = CLOTH_SKY_FIRST + wave * CLOTH_SKY_TERMS;
    vec4 sum = material_fits[first + CLOTH_SKY_TERMS - 1];
    for (int k = CLOTH_SKY_TERMS - 2; k >= 0; k--) sum = sum * t + material_fits[first + k];
    return sum;
}

/* Returns E of the warp's light that met one fibre and of its other light (xy), and of the weft's (zw). */
vec4 weave_sky(Dir o) {
    float t = 1.0 - 2.0 * sqrt(max(1.0 - sqrt(clamp(o.z, 0.0, 1.0)), 0.0));
    float s2 = max(o.x * o.x + o.y * o.y, 1e-12), c = (o.x * o.x - o.y * o.y) / s2, s = 2.0 * o.x * o.y / s2;
    vec4 twice = c * weave_sky_wave(1, t) + s * weave_sky_wave(2, t);
    vec4 four = (2.0 * c * c - 1.0) * weave_sky_wave(3, t) + 2.0 * c * s * weave_sky_wave(4, t);
    return max(weave_sky_wave(0, t) + twice + four, vec4(0.0));
}
