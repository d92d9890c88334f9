/* coarse_guide.glsl - what tells whether two points, seen at different rates of shading, lie on one surface
 *
 * A moving picture has one shading point for coarse.y x coarse.y pixels. With its light it keeps a guide: normal, depth and
 * number of the surface. All pixels of the outline then take the light of those points around them whose guide fits:
 * Johannes Kopf, Michael Cohen, Dani Lischinski, Matt Uyttendaele, "Joint Bilateral Upsampling", ACM Transactions on
 * Graphics 26(3), 2007. The text around this one includes picture.glsl. */
const vec3 LUMINANCE = vec3(0.2126, 0.7152, 0.0722);

/* Returns a number that is linear over the pixels of a plane: 1 / distance along the axis, or a distance. */
float coarse_depth() { return eye.w > 0.5 ? gl_FragCoord.w : 1.0 + gl_FragCoord.z; }

/* Returns the normal, of any length, on the faces of an octahedron (xy), the depth and the number of the surface, which is
 * above 0. */
vec4 coarse_guide(vec3 normal, float surface) {
    vec3 n = normal / max(abs(normal.x) + abs(normal.y) + abs(normal.z), 1e-12);
    vec2 folded = (1.0 - abs(n.yx)) * vec2(n.x < 0.0 ? -1.0 : 1.0, n.y < 0.0 ? -1.0 : 1.0);
    return vec4(n.z < 0.0 ? folded : n.xy, coarse_depth(), surface);
}

/* Returns depth and number of a guide in one number, 0 where there is no surface: the number is in the lowest bits, which
 * adds less than 0.004 % to the error of the half float that the depth was. */
float coarse_packed(vec4 guide) {
    float depth = clamp(guide.z, 1e-6, 6e4); /* halves may be 0 or infinite */
    uint bits = (floatBitsToUint(depth) & 0xffffff00u) | uint(guide.w);
    return guide.w > 0.0 ? uintBitsToFloat(bits) : 0.0;
}

/* Returns the number in such a number. */
uint coarse_number(float packed_guide) { return floatBitsToUint(packed_guide) & 255u; }
