// Velvet under a rectangular lamp and a sun behind it. The functions weft_* are the text that `weft export` made, which
// comes before this one. f cos of the lobe is amplitude times a linearly transformed cosine, and of a cosine any polygon
// is a sum over its edges: Heitz, Dupuy, Hill, Neubelt, "Real-Time Polygonal-Light Shading with Linearly Transformed
// Cosines", 2016.
uniform sampler2D ltc;       // z, q, b, r: sqrt(cos_o) to the right, sqrt(alpha) downwards from 0.05 to 1
uniform sampler2D amplitude; // over the same
uniform sampler2D albedo;    // E: cos_o to the right, alpha downwards, both from 0 to 1
uniform vec3 eye, lamp[4];
uniform vec3 lamp_light;      // radiance
uniform vec3 sun, sun_light;  // towards it; W/m^2 across it
uniform vec3 base, sheen;     // colours
uniform float roughness;
uniform int points; // 0: by edges; else by so many points times so many, through the lobe itself, to compare
in vec3 position, normal, tangent;
flat in int is_lamp;
out vec4 color;

const float PI_ = 3.14159265;

struct Polygon {
    vec3 corners[6];
    int count;
};

// What of it is above z = 0.
Polygon clipped(Polygon p) {
    Polygon q;
    q.count = 0;
    for (int k = 0; k < p.count; k++) {
        vec3 a = p.corners[k], b = p.corners[(k + 1) % p.count];
        if (a.z > 0.0) q.corners[q.count++] = a;
        if ((a.z > 0.0) != (b.z > 0.0)) q.corners[q.count++] = mix(a, b, a.z / (a.z - b.z));
    }
    return q;
}

// The integral of max(z, 0) / pi over it.
float cosine(Polygon p) {
    float sum = 0.0;
    p = clipped(p);
    for (int k = 0; k < p.count; k++) {
        vec3 a = normalize(p.corners[k]), b = normalize(p.corners[(k + 1) % p.count]), n = cross(a, b);
        float s = length(n); // sin of the arc
        sum += s > 1e-6 ? atan(s, dot(a, b)) / s * n.z : n.z;
    }
    return abs(sum) / (2.0 * PI_);
}

vec4 node(sampler2D table, vec2 at) { // at in [0, 1], the first and the last node at its ends
    vec2 size = vec2(textureSize(table, 0));
    return textureLod(table, (at * (size - 1.0) + 0.5) / size, 0.0);
}

// f cos of the sheen over the lamp: the polygon through M^-1, v_xy = w_xy + ((q - 1) t + b w_z) o,
// v_z = z w_z - r b t, with t = w_xy . o, o = wo_xy.
float sheen_of(Polygon p, vec3 wo, float alpha) {
    const float low = sqrt(0.05);
    vec2 at = vec2(sqrt(wo.z), (sqrt(alpha) - low) / (1.0 - low));
    vec4 m = node(ltc, at);
    p = clipped(p);
    for (int k = 0; k < p.count; k++) {
        vec3 w = p.corners[k];
        float t = dot(w.xy, wo.xy);
        p.corners[k] = vec3(w.xy + ((m.y - 1.0) * t + m.z * w.z) * wo.xy, m.x * w.z - m.w * m.z * t);
    }
    return node(amplitude, at).x * cosine(p);
}

void main() {
    if (is_lamp == 1) {
        color = vec4(lamp_light, 1);
        return;
    }
    vec3 n = normalize(normal), x = normalize(tangent - dot(tangent, n) * n);
    mat3 local = transpose(mat3(x, cross(n, x), n));
    vec3 wo = normalize(local * (eye - position)), wi = normalize(local * sun);
    wo = normalize(vec3(wo.xy, max(wo.z, 1e-3)));
    float alpha = roughness * roughness;
    float keeps = 1.0 - max(sheen.r, max(sheen.g, sheen.b)) * texture(albedo, vec2(wo.z, alpha)).x;

    // the sun: f of the text, times the cosine
    color.rgb = (weft_ashikhmin_neubelt_eval(weft_ashikhmin_neubelt_rough(roughness), sheen, wo, wi) +
                 base * keeps / PI_) * max(wi.z, 0.0) * sun_light;

    Polygon p;
    p.count = 4;
    for (int k = 0; k < 4; k++) p.corners[k] = local * (lamp[k] - position);
    if (points == 0) color.rgb += lamp_light * (sheen * sheen_of(p, wo, alpha) + base * keeps * cosine(p));
    vec3 face = cross(lamp[1] - lamp[0], lamp[3] - lamp[0]); // its length is the area
    for (int k = 0; k < points * points; k++) {
        vec2 u = (vec2(k % points, k / points) + 0.5) / float(points);
        vec3 to = mix(mix(lamp[0], lamp[1], u.x), mix(lamp[3], lamp[2], u.x), u.y) - position, w = normalize(to);
        float solid = abs(dot(face, w)) / dot(to, to) / float(points * points);
        wi = local * w;
        color.rgb += (weft_ashikhmin_neubelt_eval(weft_ashikhmin_neubelt_rough(roughness), sheen, wo, wi) +
                      base * keeps / PI_) * max(wi.z, 0.0) * lamp_light * solid;
    }
    color.a = 1.0;
}
