// A square of cloth in folds, without a vertex in any buffer; behind it the two triangles of the lamp.
uniform mat4 camera;
uniform vec3 lamp[4];
uniform int cells; // a side of the cloth
out vec3 position, normal, tangent;
flat out int is_lamp;

float height(vec2 p) {
    float fold = sin(5.1 * p.x + 1.3 * sin(1.7 * p.y) + 0.4) + 0.5 * sin(8.3 * p.x - 2.1 * p.y + sin(2.3 * p.y));
    return 0.07 * fold + 0.03 * sin(4.7 * p.y + 1.9 * p.x) + 0.25 * exp(-3.0 * dot(p, p));
}

vec3 at(vec2 p) { return vec3(p.x, height(p), p.y); }

void main() {
    const vec2 corners[6] = vec2[6](vec2(0, 0), vec2(0, 1), vec2(1, 0), vec2(1, 0), vec2(0, 1), vec2(1, 1));
    vec2 corner = corners[gl_VertexID % 6];
    int cell = gl_VertexID / 6;
    is_lamp = cell == cells * cells ? 1 : 0;
    vec2 p = (vec2(cell % cells, cell / cells) + corner) / float(cells) * 4.0 - 2.0;
    const float d = 1e-3;
    vec3 along = at(p + vec2(d, 0)) - at(p - vec2(d, 0)), across = at(p + vec2(0, d)) - at(p - vec2(0, d));
    normal = normalize(cross(across, along));
    tangent = normalize(along);
    position = at(p);
    if (is_lamp == 1) position = mix(mix(lamp[0], lamp[1], corner.x), mix(lamp[3], lamp[2], corner.x), corner.y);
    gl_Position = camera * vec4(position, 1);
}
