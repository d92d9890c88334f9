// Bends of denim side by side, each four times as far away as the one before: from ten pixels a thread to six threads a
// pixel. The functions weft_* are the text that `weft export` made, which comes before this one.
uniform vec2 size;  // of the picture, in pixels
uniform int points; // of a pixel
out vec4 color;

const int BENDS = 4;
const float THREADS = 16.0; // of the warp across the first bend
const float STEEP = 1.1;    // the angle at the rims of a bend, radians

// f cos of the cloth for a light, in the frame of the point.
vec3 lit(WeftSurface s, WeftWeaveSeen seen, mat3 local, vec3 wo, vec3 light) {
    return weft_woven_denim_shade(s, seen, wo, normalize(light * local));
}

void main() {
    float side = size.x / float(BENDS), bend = floor(gl_FragCoord.x / side);
    float across = (gl_FragCoord.x - bend * side) / side * 2.0 - 1.0, angle = across * STEEP;
    vec3 n = vec3(sin(angle), 0.0, cos(angle));
    mat3 local = mat3(vec3(n.z, 0.0, -n.x), vec3(0.0, 1.0, 0.0), n); // tangent, bitangent, normal
    vec3 wo = normalize(vec3(0.0, 0.0, 1.0) * local);

    // texture coordinates, v downwards: every bend has a scale of its own
    float scale = THREADS * pow(4.0, bend) / weft_woven_denim_placing().warps;
    vec2 uv = scale * vec2(0.5 * across, -gl_FragCoord.y / side);
    vec2 dx = dFdx(uv), dy = dFdy(uv);
    WeftSurface s = weft_woven_denim_surface();
    color = vec4(0.0, 0.0, 0.0, 1.0);
    for (int k = 0; k < points; k++) { // a lattice by the golden ratio, shifted from pixel to pixel
        float shift = fract(52.9829189 * fract(dot(gl_FragCoord.xy, vec2(0.06711056, 0.00583715))));
        vec2 at = fract(vec2((float(k) + 0.5) / float(points), 0.618034 * float(k) + 0.5) + shift) - 0.5;
        vec2 spot = points > 1 ? uv + at.x * dx + at.y * dy : uv;
        WeftWeaveSeen seen = weft_woven_denim_see(s, spot.x, spot.y, dx.x, dx.y, dy.x, dy.y, points);
        vec3 sum = 2.6 * lit(s, seen, local, wo, vec3(-0.5, 0.6, 0.7)) + 0.5 * lit(s, seen, local, wo, vec3(0.8, -0.2, 0.5));
        color.rgb += sum / float(points);
    }
}
