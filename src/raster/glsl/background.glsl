/* background.glsl - the unfiltered environment */
uniform highp sampler2D environment_map;

/* Returns the radiance from a direction in the world. place: cosine and sine of the rotation, factor on radiance. */
vec3 environment_background(vec3 world, vec4 place) {
    vec3 d = normalize(world);
    float x = d.x * place.x - d.z * place.y, z = d.x * place.y + d.z * place.x;
    float u = 0.5 + atan(x, -z) / 6.28318531, v = acos(clamp(d.y, -1.0, 1.0)) / 3.14159265;
    return textureLod(environment_map, vec2(u, v), 0.0).rgb * place.z;
}
