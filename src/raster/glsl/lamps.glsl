/* lamps.glsl - what a fragment sees of the environment's lamps, of which there are eight: raster/occlusion.h */
in highp vec2 vertex_occlusion;
in highp vec4 vertex_lamps_0;
in highp vec4 vertex_lamps_1;

/* Of the sky, by a texture, which is of the material's own bumps. */
float texture_occlusion = 1.0;

float ambient_seen(Frame f, int k, float occlusion) {
    float seen = k < 4 ? vertex_lamps_0[k] : vertex_lamps_1[k - 4];
    /* -1 is unknown; beside their triangle fragments are a little out of range */
    return seen < -0.5 ? occlusion : clamp(seen, 0.0, 1.0) * texture_occlusion;
}
