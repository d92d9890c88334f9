/* reference.glsl - a fragment of a frame of a sum: its direct light by one random sample of each kind of light and one
 * of the material, with shadow rays, as the path tracer's first vertex has it (trace/path/shade.c, lit.c)
 *
 * The mean of frames with other random numbers, each moved by a fraction of a pixel, is the path tracer's picture at
 * depth 1. With BOUNCES the ray that the material draws brings back what it meets reflects of its own direct light. The text before it is that of forward.glsl. */
in highp vec3 from_eye;
in highp vec3 vertex_normal;
#ifdef NEEDS_TANGENT
in highp vec4 vertex_tangent;
#else
const vec4 vertex_tangent = vec4(0.0, 0.0, 0.0, 1.0);
#endif
out highp vec4 fragment;

#include "raster/glsl/light.glsl"
#include "raster/glsl/ray_emitters.glsl"
#include "raster/glsl/sky.glsl"
#include "shading/material/dust.h"
#include "shading/material/stack_sample.h"
#ifdef WOVEN
#include "raster/glsl/weave_far.glsl"
#endif

/* The kinds of samples, and their pairs of dimensions (trace/geometry/sampler.h); the last is that of the material. */
const int BY_SKY = 0, BY_EMITTER = 1, BY_LIGHT = 2, BY_LOBE = 3, KINDS = 4;
const uint PAIR_VERTEX = 5u, PAIR_CLOTH = 65536u;
const float FAR = 1e30;

uint pixel_key() { return sampler_key(uint(gl_FragCoord.x), uint(gl_FragCoord.y), 0u); }
uint frame_index() { return sampler_index(uint(ray_count.y)); }

/* Returns a number that decides partial opacity. Surfaces behind one another have each its own, by their depth: by one
 * number for all, what lies behind a surface of opacity .5 would show only where its own opacity is higher. */
float layer_random() {
    return point_fraction(point_hash_two(pixel_key() ^ frame_index(), floatBitsToUint(gl_FragCoord.z)));
}

/* The point that is shaded. */
struct Place {
    vec3 lifted;         /* on the smooth surface that the normals at the corners describe */
    vec3 origin, behind; /* of rays that leave on the viewer's side, and on the other */
    vec3 horizon;        /* normal below whose plane no light counts */
};

/* Steps out from a coordinate along a normal, by units in the last place, or by a fixed length near 0. Carsten Waechter,
 * Nikolaus Binder, "A Fast and Robust Method for Avoiding Self-Intersection", Ray Tracing Gems, 2019. */
float step_out(float p, float n) {
    int by = int(256.0 * n);
    float stepped = intBitsToFloat(floatBitsToInt(p) + (p < 0.0 ? -by : by));
    return abs(p) < 1.0 / 32.0 ? p + n / 65536.0 : stepped;
}
vec3 stepped_out(vec3 p, vec3 n) { return vec3(step_out(p.x, n.x), step_out(p.y, n.y), step_out(p.z, n.z)); }

/* Returns the step along n, times weight, that raises p to the tangent plane at a corner. */
vec3 raise(vec3 p, vec3 corner, vec3 n, float weight) { return n * (-min(dot(p - corner, n), 0.0) * weight); }

/* Returns the mean of p's projections onto the tangent planes of the corners, outward only. Johannes Hanika, "Hacking
 * the Shadow Terminator", Ray Tracing Gems II, 2021. */
vec3 lift(RayTriangle t, RayHit hit, vec3 p, float side) {
    vec3 sum = raise(p, t.a, side * ray_normal(hit.triangle, 0), 1.0 - hit.u - hit.v);
    sum += raise(p, t.b, side * ray_normal(hit.triangle, 1), hit.u);
    return p + sum + raise(p, t.c, side * ray_normal(hit.triangle, 2), hit.v);
}

/* True at a fibre of hair of which the rays' tree has not all. */
#ifdef HAIRY
#define FINER_THAN_RAYS (ray_count.w > 0.5)
#else
#define FINER_THAN_RAYS false
#endif

/* Finds the triangle of the fragment by a short ray through it, and sets normals and tangent of the side that is seen
 * and the place. */
void find_place(vec3 wo, inout Facing at, inout Place place) {
    vec3 here = eye.xyz + from_eye;
    float reach = 1e-3 * max(length(from_eye), 1e-6);
    RayHit hit = RayHit(0.0, -1, 0.0, 0.0, vec3(1.0));
    if (!FINER_THAN_RAYS) hit = ray_trace(Ray(here + reach * wo, -wo, 0.0, 2.0 * reach), false, reach, 0u);
    vec3 geometric = cross(dFdx(from_eye), dFdy(from_eye));
    RayTriangle t = ray_triangle(max(hit.triangle, 0));
    if (hit.triangle >= 0) geometric = cross(t.b - t.a, t.c - t.a);
    float side = gl_FrontFacing ? 1.0 : -1.0;
    geometric *= dot(geometric, wo) < 0.0 ? -1.0 : 1.0;
    at.geometric = dir_normal_or(dir_of(geometric), dir_of(wo));
    at.normal = dir_normal_or(dir_of(side * vertex_normal), at.geometric);
    at.normal = facing_normal(at);
    at.tangent = dir_of(side * vertex_tangent.xyz);
    at.handedness = side * vertex_tangent.w;
    vec3 below = here;
    if (hit.triangle >= 0) {
        here = t.a * (1.0 - hit.u - hit.v) + t.b * hit.u + t.c * hit.v;
        below = lift(t, hit, here, -side);
        here = lift(t, hit, here, side);
    }
    place.lifted = here;
    place.origin = stepped_out(here, vec_of_dir(at.geometric));
    place.behind = stepped_out(below, -vec_of_dir(at.geometric));
    place.horizon = vec_of_dir(frame_visible_normal(at.normal, dir_of(wo)));
}

/* Returns f cos and pdf of a direction; below the horizon those of transmitted light. */
StackValue stack_towards(Stack m, StackView w, Slots only, Dir i) {
    bool below = i.z < 0.0;
    Dir up = dir(i.x, i.y, max(abs(i.z), 1e-6)); /* at the horizon it is evaluated and then dropped */
    Angles a = angles_between(w.o, up), coat = a;
    if (HAS_COAT(m)) coat = angles_between(w.coat_o, stack_to_coat(m, i));
    StackValue v = stack_value_of(m, w, only, a, coat);
    if (HAS_TRANSMITTED(m) && below) {
        v = stack_transmitted(m, w, a);
        if (!only.diffuse) v.f_cos = rgb_grey(0.0);
    }
    bool seen = i.z > 0.0 || (below && HAS_TRANSMITTED(m));
    v.f_cos = rgb_scale(v.f_cos, seen ? 1.0 : 0.0);
    v.pdf = seen ? v.pdf : 0.0;
    return v;
}

const Slots SHOWN = Slots(SHOWS_DIFFUSE, SHOWS_SPECULAR, SHOWS_SHEEN, SHOWS_COAT, SHOWS_DUST);

/* Returns f cos of what is shown, given that of all lobes. */
#ifdef SHOWS_PART
Rgb shown_f_cos(Stack m, StackView w, Dir i, Rgb all) { return stack_towards(m, w, SHOWN, i).f_cos; }
#else
Rgb shown_f_cos(Stack m, StackView w, Dir i, Rgb all) { return all; }
#endif

/* Returns f cos for light of the environment, which has a factor of its own on the diffuse lobe and dust, and one on the
 * others and on thin glass. */
#ifdef SKY_IN_PARTS
Rgb clear_f_cos(Stack m, StackView w, Dir i) {
    Rgb f = rgb_grey(0.0);
    if (HAS_GLASS(m) && SHOWS_DIFFUSE && i.z < 0.0)
        f = stack_through_glass(m, w, angles_between(w.o, dir(i.x, i.y, -i.z))).f_cos;
    return f;
}
Rgb sky_f_cos(Stack m, StackView w, Dir i, Rgb all) {
    Slots rest = Slots(false, SHOWS_SPECULAR, SHOWS_SHEEN, SHOWS_COAT, false);
    Rgb apart = rgb_add(stack_towards(m, w, rest, i).f_cos, clear_f_cos(m, w, i));
    Rgb f = rgb_scale(apart, sky_parts.y - sky_parts.x);
    f = rgb_add(f, rgb_scale(all, sky_parts.x));
    return rgb(max(f.r, 0.0), max(f.g, 0.0), max(f.b, 0.0));
}
#else
Rgb sky_f_cos(Stack m, StackView w, Dir i, Rgb all) { return all; }
#endif

/* A sample of light: direction, radiance, density (1/sr, or probability of a punctual light), distance. */
struct Arriving {
    vec3 wi, radiance;
    float pdf, distance;
};

/* Draws one of the punctual lights in proportion to its power. */
Arriving light_sample(vec3 here, float u) {
    int k = 0, count = int(forward.w);
    while (k < count - 1 && lights[4 * k + 3].z <= u) k++;
    Beam beam = light_beam_at(k, int(lights[4 * k].w), here);
    vec3 to = lights[4 * k].xyz - here;
    return Arriving(vec_of_dir(beam.wi), vec_of(beam.radiance), lights[4 * k + 3].w,
                    lights[4 * k].w > 0.5 ? length(to) : FAR);
}

Arriving arriving_by(int kind, vec3 here, Point at) {
    if (kind == BY_EMITTER) {
        EmitterPoint p = emitter_sample(here, at.u, at.v);
        return Arriving(p.wi, p.radiance, p.pdf, p.distance);
    }
    if (kind == BY_LIGHT) return light_sample(here, at.u);
    SkyPoint p = sky_sample(at.u, at.v);
    return Arriving(p.wi, p.radiance, p.pdf, FAR);
}

bool has_kind(int kind) {
    return kind == BY_LOBE || (kind == BY_SKY && sky_place.w > 0.5) || (kind == BY_EMITTER && ray_count.x > 0.5) ||
           (kind == BY_LIGHT && forward.w > 0.5);
}

/* Returns the first kind of samples from `kind` on that the scene has. A software driver runs the whole body of a loop
 * for a kind that is left out inside. */
int kind_from(int kind) {
    int k = kind;
    while (k < BY_LOBE && !has_kind(k)) k++;
    return k;
}

/* Light that a ray has met, and the density with which a sample of that light has its direction. */
struct LightMet {
    vec3 radiance;
    float pdf;
};

LightMet light_at(Ray r, RayHit hit) {
    LightMet met = LightMet(vec3(0.0), 0.0);
    if (hit.triangle < 0 && sky_place.w > 0.5) {
        met.radiance = sky_radiance(r.direction);
        met.pdf = sky_pdf(r.direction);
    }
    RayTriangle t = ray_triangle(max(hit.triangle, 0));
    if (hit.triangle >= 0 && t.emitter > 0.5) {
        int emitter = int(t.emitter) - 1;
        vec4 light = emitter_texel(emitter, 3);
        vec3 normal = cross(t.b - t.a, t.c - t.a);
        float cosine = -dot(normal, r.direction) * inversesqrt(max(dot(normal, normal), 1e-30));
        bool lit = cosine > 0.0 || emitter_texel(emitter, 1).w > 0.5;
        met.radiance = lit ? light.rgb : vec3(0.0);
        met.pdf = emitter_pdf(light.w, emitter_texel(emitter, 2).w, hit.t, cosine);
    }
    return met;
}

/* Returns the light along a ray that the material drew with density pdf, weighted against the draw of the same light.
 * Eric Veach, "Robust Monte Carlo Methods for Light Transport Simulation", 1997, power heuristic, Equation 9.13. */
vec3 light_met(Ray r, RayHit hit, float pdf) {
    LightMet met = light_at(r, hit);
    return met.radiance * (pdf / (pdf + met.pdf * (met.pdf / pdf)));
}

/* Returns the ray of a sample, from aside of the lifted point that was lit to just before the light. */
Ray ray_towards(Place place, vec3 wi, float distance, bool below) {
    vec3 from = below ? place.behind : place.origin;
    if (distance >= 0.5 * FAR) return Ray(from, wi, 0.0, FAR);
    vec3 to = place.lifted + wi * distance - from;
    float far = max(length(to), 1e-20);
    return Ray(from, to / far, 0.0, far * 0.9999);
}

#ifdef BOUNCES
#include "raster/glsl/bounce.glsl"
#endif

/* Returns the direct light that a stack sends to the eye: a sum over the kinds of samples, in one loop so that the
 * stack is in the text once. */
vec3 direct_light(Stack m, StackView w, Frame f, Place place) {
    uint key = pixel_key(), index = frame_index(), ray_key = point_hash(key ^ index);
    vec3 sum = vec3(0.0);
#ifdef BOUNCES
    vec3 through = vec3(0.0);
    Ray last = Ray(place.origin, place.horizon, 0.0, -1.0);
    RayHit met = RayHit(0.0, -1, 0.0, 0.0, vec3(1.0));
#endif
    for (int kind = kind_from(0); kind < KINDS; kind = kind_from(kind + 1)) {
        Point at = sampler_point(key, index, PAIR_VERTEX + uint(kind));
        Arriving light = Arriving(vec3(0.0), vec3(0.0), 1.0, FAR);
        Dir i;
        if (kind == BY_LOBE) {
            stack_draw_direction(m, w, at.u, at.v, i);
            light.wi = vec_of_dir(frame_from(f, i));
        } else {
            light = arriving_by(kind, place.lifted, at);
            i = frame_to(f, dir_of(light.wi));
        }
        StackValue value = stack_towards(m, w, slots_all(), i);
        value.f_cos = shown_f_cos(m, w, i, value.f_cos);
        vec3 of_sky = vec_of(sky_f_cos(m, w, i, value.f_cos)), of_lights = vec_of(value.f_cos);
        float up = dot(light.wi, place.horizon) * i.z;
        float density = kind == BY_LOBE ? value.pdf : light.pdf;
        float mis = kind == BY_LOBE || kind == BY_LIGHT ? 0.0 : value.pdf * (value.pdf / max(density, 1e-30));
        float weight = 1.0 / (max(density, 1e-30) + mis);
        bool live = density > 0.0 && up > 0.0 && dot(of_sky + of_lights, vec3(1.0)) > 0.0;
        Ray r = ray_towards(place, light.wi, light.distance, i.z < 0.0);
        r.far = live ? r.far : -1.0;
        RayHit hit = ray_trace(r, kind != BY_LOBE, 0.0, kind == BY_LOBE ? point_hash(ray_key + 1u) : ray_key);
        if (kind == BY_LOBE)
            light.radiance = light_met(r, hit, value.pdf);
        light.radiance *= hit.through;
        bool from_sky = kind == BY_SKY || (kind == BY_LOBE && hit.triangle < 0);
        bool arrives = live && (kind == BY_LOBE || hit.triangle < 0);
        vec3 added = (from_sky ? of_sky : of_lights) * light.radiance * weight;
        sum += arrives ? added : vec3(0.0);
#ifdef BOUNCES
        through = live ? of_lights * weight * hit.through : vec3(0.0); /* of the last kind, the material's own */
        last = r;
        met = hit;
#endif
    }
#ifdef BOUNCES
    sum += through * bounced(last, met, key, index);
#endif
    return sum;
}

#ifdef WOVEN
/* From LATER times the size of a pixel on, at which one picture alone goes over to the cloth from afar, the path tracer
 * does (weave/cloth_base.c), with colours over a FINER-th of the pixel. */
const float LATER = 2.0, FINER = 4.0;

WeaveFootprint footprint_over(WeaveFootprint f, float by) { return WeaveFootprint(f.x / by, f.y / by, f.longest / by); }

/* Returns the mean of what fibres of these colours reflect of light from all around, as weave/cloth_base.c has it. */
float weave_reflected(WeaveBase b) { return 0.3 * rgb_mean(b.single) + 0.7 * rgb_mean(b.multiple); }

/* Puts one of the systems from afar in the place of the base, chosen with u by what it reflects. */
void weave_base_far(inout Stack m, Weave c, vec2 place, vec2 across, vec2 up, WeaveFootprint f, float wear, float u) {
    WeaveFootprint finer = footprint_over(f, FINER);
    WeaveBase warp = woven_far(c, false, place, across / FINER, up / FINER, finer, wear);
    WeaveBase b = woven_far(c, true, place, across / FINER, up / FINER, finer, wear);
    float shown = weave_reflected(warp), all = shown + weave_reflected(b), chance = all > 0.0 ? shown / all : 1.0;
    bool weft = u >= chance;
    if (!weft) b = warp;
    float scale = 0.5 / max(weft ? 1.0 - chance : chance, 1e-6); /* the colours are those of half a cloth */
    compose_base(m, b.lobe, rgb_scale(b.single, scale), rgb_scale(b.multiple, scale));
    m.diffuse_prepared.woven = woven_afar(weft);
}

/* Puts a point of a thread in the place of the base, or a system from afar, by chance where the path tracer mixes
 * both. Returns its coverage. wear: the input of the material. Loops may have 0 rounds, as in weave.glsl. */
float weave_base(inout Stack m, float wear) {
    Weave c = material_cloth();
    vec2 place = weave_place(), across = dFdx(place), up = dFdy(place);
    WeaveFootprint f = weave_footprint(across.x, across.y, up.x, up.y);
    Point random = sampler_point(pixel_key(), frame_index(), PAIR_CLOTH);
    bool far = random.u < weave_far_weight(footprint_over(f, LATER));
    int points = far ? 0 : 1, systems = far ? 1 : 0;
    float covered = 1.0;
    for (int k = 0; k < systems; k++) {
        weave_base_far(m, c, place, across, up, f, wear, random.v);
        if (MATERIAL_HOLED) covered = weave_is_gap() ? 0.0 : 1.0;
    }
    for (int k = 0; k < points; k++) {
        WeavePoint p = weave_point(c, place.x, place.y, 0.25 * f.longest, 2.0 * random.v - 1.0);
        WeaveBase b = weave_near(c, p, wear);
        compose_base(m, b.lobe, b.single, b.multiple);
        m.diffuse_prepared.yarn.axis = p.fibre; /* exactly, instead of through the azimuth */
        covered = p.height > WEAVE_NONE ? 1.0 : 0.0;
    }
    return covered;
}
#endif

void main() {
    vec3 wo = eye.w > 0.5 ? -normalize(from_eye) : -forward.xyz;
    Facing at;
    Place place;
    find_place(wo, at, place);
    Surface s = material_surface();
    float opacity = coverage_of(s.opacity);
    Frame f = frame_of(at, s, dir_of(wo));
#ifdef WOVEN
    f = frame_rotate(f, weave_number(CLOTH_ROTATION_COS), weave_number(CLOTH_ROTATION_SIN));
#endif
#ifdef PROPERTY
    vec3 sum = PROPERTY;
#else
    vec3 sum = vec_of(rgb_scale(s.base_color, SHOWS_EMISSION));
    if (!MATERIAL_UNLIT) {
        float strength = gl_FrontFacing || MATERIAL_DOUBLE_SIDED ? s.emission_strength : 0.0;
        sum = vec_of(rgb_scale(s.emission, SHOWS_EMISSION * strength));
        Dir o = frame_to(f, dir_of(wo));
        s = dust_accumulate(frame_surface(s), f.z, dir_of(eye.xyz + from_eye));
        Stack m;
        surface_stack(m, s, material_choices(), material_table());
#ifdef WOVEN
        float covered = weave_base(m, s.wear);
        if (MATERIAL_HOLED) opacity *= covered;
#endif
        StackView w;
        stack_view(m, o, w);
        vec3 light = direct_light(m, w, f, place);
        bool finite = light.r + light.g + light.b < 1e30;
        sum += finite ? light : vec3(0.0);
    }
#endif
    if (opacity < 1.0 && layer_random() >= opacity) discard;
    fragment = vec4(min(sum, vec3(65000.0)), 1.0);
}
