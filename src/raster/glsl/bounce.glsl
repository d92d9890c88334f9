/* bounce.glsl - the light that a surface sends back along a ray that has met it: its direct light, by one random sample
 * with a shadow ray, reflected evenly to all sides
 *
 * The sample is of the sky, an emissive triangle or a punctual light, or a direction drawn by the cosine, each as likely.
 * A direction that both a kind of light and the cosine draw has the sum of their densities: Eric Veach, "Robust Monte
 * Carlo Methods for Light Transport Simulation", 1997, one-sample model, Equation 9.15. The text is that of
 * reference.glsl. */

/* The pairs of dimensions of the choice and of the sample, behind those of the first vertex. */
const uint PAIR_CHOICE = PAIR_VERTEX + 4u, PAIR_BOUNCE = PAIR_VERTEX + 5u;

/* The side of a surface that a ray has met. */
struct Bounce {
    vec3 origin, normal, plane; /* of rays that leave it; smooth, and of the triangle, both towards the ray */
    vec3 albedo;                /* the part of light that it sends back (raster/light/ray_albedos.h) */
};

Bounce bounce_of(Ray r, RayHit hit) {
    int k = max(hit.triangle, 0), at = int(ray_first.z) + 3 * k;
    RayTriangle t = ray_triangle(k);
    vec4 a = ray_texel(at), b = ray_texel(at + 1), c = ray_texel(at + 2);
    vec3 plane = cross(t.b - t.a, t.c - t.a), both = vec3(a.w, b.w, c.w), behind = floor(both / 4096.0);
    bool front = dot(plane, r.direction) < 0.0;
    plane *= (front ? 1.0 : -1.0) * inversesqrt(max(dot(plane, plane), 1e-30));
    vec3 normal = a.xyz * (1.0 - hit.u - hit.v) + b.xyz * hit.u + c.xyz * hit.v;
    normal *= (front ? 1.0 : -1.0) * inversesqrt(max(dot(normal, normal), 1e-30));
    if (dot(normal, normal) < 0.5 || dot(normal, r.direction) > 0.0) normal = plane;
    vec3 place = t.a * (1.0 - hit.u - hit.v) + t.b * hit.u + t.c * hit.v;
    return Bounce(stepped_out(place, plane), normal, plane, (front ? both - 4096.0 * behind : behind) / 4095.0);
}

/* Returns a direction about a normal with a density proportional to the cosine: the normal plus a point of the sphere. */
vec3 cosine_direction(vec3 normal, Point at) {
    float z = 1.0 - 2.0 * at.u, rim = sqrt(max(1.0 - z * z, 0.0)), turn = 2.0 * SKY_PI * at.v;
    vec3 to = normal + vec3(rim * cos(turn), rim * sin(turn), z);
    return to * inversesqrt(max(dot(to, to), 1e-12));
}

/* Returns the number of kinds of samples: those of light that the scene has, and the cosine unless all lights are points. */
int bounce_kinds() {
    int kinds = 0;
    for (int kind = 0; kind < BY_LOBE; kind++) kinds += has_kind(kind) ? 1 : 0;
    return has_kind(BY_SKY) || has_kind(BY_EMITTER) ? kinds + 1 : kinds;
}

/* Returns the kind of number k among those that the scene has; BY_LOBE stands for the cosine. */
int bounce_kind(int k) {
    int kind = kind_from(0);
    for (int j = 0; j < k; j++) kind = kind_from(kind + 1);
    return kind;
}

/* Returns the radiance that comes back along a ray from what it has met; black if that is nothing. */
vec3 bounced(Ray r, RayHit hit, uint key, uint index) {
    Bounce at = bounce_of(r, hit);
    Point chosen = sampler_point(key, index, PAIR_CHOICE), point = sampler_point(key, index, PAIR_BOUNCE);
    int kinds = bounce_kinds();
    int kind = bounce_kind(min(int(chosen.u * float(kinds)), kinds - 1));
    bool by_cosine = kind == BY_LOBE;
    Arriving light = arriving_by(by_cosine ? BY_LIGHT : kind, at.origin, point);
    if (by_cosine) light = Arriving(cosine_direction(at.normal, point), vec3(0.0), 1.0, FAR);
    float cosine = dot(light.wi, at.normal);
    bool live = hit.triangle >= 0 && kinds > 0 && light.pdf > 0.0 && cosine > 0.0 && dot(light.wi, at.plane) > 0.0;
    float far = light.distance < 0.5 * FAR ? light.distance * 0.9999 : FAR;
    Ray to = Ray(at.origin, light.wi, 0.0, live ? far : -1.0);
    RayHit end = ray_trace(to, !by_cosine, 0.0, point_hash(point_hash(key ^ index) + 2u));
    LightMet met = light_at(to, end);
    bool arrives = live && (by_cosine || end.triangle < 0);
    bool of_sky = kind == BY_SKY || (by_cosine && end.triangle < 0);
    float density = by_cosine ? met.pdf : light.pdf;
    density += kind == BY_LIGHT ? 0.0 : cosine / SKY_PI;
    vec3 radiance = (by_cosine ? met.radiance : light.radiance) * end.through * (of_sky ? sky_parts.x : 1.0);
    vec3 back = at.albedo * radiance * (cosine / SKY_PI * float(kinds) / max(density, 1e-30));
    return arrives ? back : vec3(0.0);
}
