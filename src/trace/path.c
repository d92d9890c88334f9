#include "trace/path_radiance.h"

#include "scene/shade.h"
#include "shading/frame.h"

/* A point of a surface ready to be lit: its lobes and its frame. */
typedef struct ShadingPoint {
    Vec3 geometric; /* unit, on the viewer's side */
    Vec3 origin;    /* where rays that leave start, before their offset */
    Frame frame;
    Dir wo;
    const Stack *stack; /* the material's, or the point's own; NULL: it only shines */
    const StackKind *kind;
    StackView view;
    Stack own;
} ShadingPoint;

static Dir dir_of(Vec3 v) { return dir(v.x, v.y, v.z); }

static Dir to_local(const ShadingPoint *p, Vec3 w) { return frame_to(p->frame, dir_of(w)); }

static Vec3 to_world(const ShadingPoint *p, Dir w) {
    Dir d = frame_from(p->frame, w);
    return vec3(d.x, d.y, d.z);
}

/* Carsten Waechter, Nikolaus Binder, "A Fast and Robust Method for Avoiding Self-Intersection", Ray Tracing
 * Gems, 2019: a step of so many units in the last place, or of a fixed length near the origin of the world.
 */
static float step_out(float p, float n) {
    const float near_origin = 1.0f / 32.0f, length = 1.0f / 65536.0f, units = 256.0f;
    if (fabsf(p) < near_origin) return p + length * n;
    int32_t bits, step = (int32_t)(units * n);
    memcpy(&bits, &p, 4);
    bits += p < 0.0f ? -step : step;
    memcpy(&p, &bits, 4);
    return p;
}

static Vec3 leave(Vec3 p, Vec3 n) { return vec3(step_out(p.x, n.x), step_out(p.y, n.y), step_out(p.z, n.z)); }

/* Fills p for a hit seen from wo and returns what the surface itself sends there. */
static Rgb prepare(const PathContext *context, const Mesh *mesh, const Hit *hit, Vec3 wo, ShadingPoint *p) {
    const PathMaterial *known = &context->materials[mesh->material];
    const Material *material = &known->material;
    bool textured = known->textured || mesh->color;
    Vertex vertex = geometry_vertex(mesh, hit);
    float side = vec3_dot(vertex.geometric, wo) < 0.0f ? -1.0f : 1.0f;
    Surface surface = known->plain;
    if (textured) {
        Attributes at = geometry_attributes(mesh, hit);
        material_textures(context->scene, material, at.uv, at.color, &surface);
    }
    p->geometric = vec3_scale(vertex.geometric, side);
    p->stack = NULL;

    float strength = side < 0.0f && !material->double_sided ? 0.0f : surface.emission_strength;
    Rgb emission = {surface.emission.r * strength, surface.emission.g * strength,
                    surface.emission.b * strength};
    if (material->unlit) return surface.base_color;
    p->origin = geometry_lift(mesh, hit, &vertex, side);
    /* from behind everything is mirrored: the bumps of a normal map are dents there */
    Facing at = {.geometric = dir_of(p->geometric),
                 .normal = dir_of(vec3_scale(vertex.normal, side)),
                 .tangent = dir_of(vec3_scale(vertex.tangent, side)),
                 .handedness = vertex.handedness * side};
    p->frame = frame_of(at, surface, dir_of(wo));
    p->wo = to_local(p, wo);
    p->stack = &known->stack;
    p->kind = known->kind;
    if (textured || surface.dust > 0.0f) {
        surface = dust_accumulate(frame_surface(surface), p->frame.z, dir_of(vertex.position));
        p->kind->make(&p->own, &surface, &known->choices, known->sheen_e);
        p->stack = &p->own;
    }
    p->kind->see(p->stack, &p->wo, &p->view);
    return emission;
}

static void add(Rgb *sum, Rgb a, Rgb b, float k) {
    sum->r += a.r * b.r * k;
    sum->g += a.g * b.g * k;
    sum->b += a.b * b.b * k;
}

/* Weight of the strategy with density a, beside one of density b. Eric Veach, "Robust Monte Carlo Methods for
 * Light Transport Simulation", 1997, power heuristic, Equation 9.13. */
static float mis_weight(const PathContext *context, WeftSampling strategy, float a, float b) {
    if (context->sampling != WEFT_SAMPLING_MIS)
        return b > 0.0f && strategy != context->sampling ? 0.0f : 1.0f;
    return b > 0.0f ? a / (a + b * (b / a)) : 1.0f;
}

/* f cos, which was asked for with that seed, as it is for the environment's light: ambient times what the
 * diffuse lobe and dust reflect first, reflection times what the others do. */
static Rgb f_cos_of_sky(const PathContext *context, const ShadingPoint *p, Dir wi, uint32_t seed, Rgb f_cos) {
    const Environment *sky = &context->scene->environment;
    Slots others = slots_of(false, true, true, true, false);
    Rgb rest = rgb_add(stack_eval_of(p->stack, &p->view, others, wi).f_cos,
                       layer_walk_bounces(p->stack, &p->view, others, wi, seed));
    Rgb f = rgb_add(rgb_scale(f_cos, sky->ambient), rgb_scale(rest, sky->reflection - sky->ambient));
    return rgb(max(f.r, 0.0f), max(f.g, 0.0f), max(f.b, 0.0f));
}

static float ratio(float a, float b) { return b > 0.0f ? a / b : 0.0f; }

/* One light sample of a group. */
static void add_direct(const PathContext *context, const ShadingPoint *p, LightGroup group, Rgb throughput,
                       Point uv, uint32_t key, Rgb *sum, long long *rays) {
    LightSample light = lights_sample(context->lights, group, p->origin, uv.u, uv.v);
    if (!(light.pdf > 0.0f) || vec3_dot(light.wi, p->geometric) <= 0.0f) return;
    if (!light.punctual && context->sampling == WEFT_SAMPLING_LOBE) return;
    Dir wi = to_local(p, light.wi);
    StackValue value;
    p->kind->eval(p->stack, &p->view, &wi, key, &value);
    Rgb f = value.f_cos;
    if (light.sky && context->sky_in_parts) f = f_cos_of_sky(context, p, wi, key, f);
    if (!(f.r * light.radiance.r + f.g * light.radiance.g + f.b * light.radiance.b > 0.0f)) return;
    Ray shadow = {leave(p->origin, p->geometric), light.wi, 0.0f, light.distance, key, false};
    if (light.distance < INFINITY) {
        /* from the moved start to just before the light */
        Vec3 to = vec3_sub(vec3_madd(p->origin, light.wi, light.distance), shadow.origin);
        float d = vec3_length(to);
        shadow.direction = vec3_normal_or(to, light.wi);
        shadow.far = d * (1.0f - 1e-4f);
    }
    *rays += context->shadows;
    if (context->shadows && geometry_occluded(context->geometry, shadow)) return;
    float weight = light.punctual ? 1.0f : mis_weight(context, WEFT_SAMPLING_LIGHT, light.pdf, value.pdf);
    Rgb arriving = {f.r * light.radiance.r, f.g * light.radiance.g, f.b * light.radiance.b};
    add(sum, throughput, arriving, weight / light.pdf);
}

/* flatten: everything a path does in one body is worth a twentieth of the time. */
__attribute__((flatten)) Rgb path_radiance(const PathContext *context, Ray ray, Hit hit, Sampler *sampler,
                                           long long *rays) {
    Rgb sum = {0}, throughput = {1.0f, 1.0f, 1.0f};
    ShadingPoint p;
    float pdf = 0.0f; /* of the direction by which we came; 0: the camera's */
    for (int depth = 0;; depth++) {
        const Mesh *mesh = &context->scene->meshes[hit.mesh];
        Vec3 wo = vec3_scale(ray.direction, -1.0f);
        Rgb emission = prepare(context, mesh, &hit, wo, &p);
        if (emission.r + emission.g + emission.b > 0.0f) {
            float cosine = vec3_dot(wo, p.geometric), weight = 1.0f;
            if (pdf > 0.0f)
                weight =
                    mis_weight(context, WEFT_SAMPLING_LOBE, pdf,
                               lights_triangle_pdf(context->lights, hit.mesh, hit.triangle, hit.t, cosine));
            add(&sum, throughput, emission, weight);
        }
        if (depth == context->max_depth || !p.stack) return sum;
        TwoPoints two = sampler_next(sampler), four = sampler_next(sampler);
        const Point uv[LIGHT_GROUPS] = {two.first, two.second, four.first};
        for (int g = 0; g < LIGHT_GROUPS; g++)
            if (lights_shine(context->lights, (LightGroup)g))
                add_direct(context, &p, (LightGroup)g, throughput, uv[g], hash32(ray.key), &sum, rays);

        Dir wi;
        p.kind->sample(p.stack, &p.view, four.second.u, four.second.v, &wi);
        ray.direction = to_world(&p, wi);
        if (wi.z <= 0.0f || vec3_dot(ray.direction, p.geometric) <= 0.0f) return sum;
        uint32_t seed = hash32(ray.key ^ 0x68e31da4u);
        StackValue value;
        p.kind->eval(p.stack, &p.view, &wi, seed, &value);
        if (!(value.pdf > 0.0f)) return sum;
        float k = 1.0f / value.pdf;
        throughput = (Rgb){throughput.r * value.f_cos.r * k, throughput.g * value.f_cos.g * k,
                           throughput.b * value.f_cos.b * k};
        pdf = value.pdf;
        float strongest = max(throughput.r, max(throughput.g, throughput.b));
        if (depth >= 1 && context->roulette) {
            /* the square root ends paths later than their share of the light would, as the eye sees it */
            float survive = min(sqrt(strongest), 1.0f);
            if (sampler_random(sampler) >= survive) return sum;
            throughput = (Rgb){throughput.r / survive, throughput.g / survive, throughput.b / survive};
        }
        if (!(strongest > 0.0f)) return sum;

        ray.origin = leave(p.origin, p.geometric);
        ray.near = 0.0f, ray.far = INFINITY;
        ray.key = hash32(ray.key + 0x9e3779b9u);
        ++*rays;
        if (!geometry_hit(context->geometry, ray, &hit)) {
            LightSample sky = lights_environment(context->lights, ray.direction);
            if (context->sky_in_parts) {
                Rgb f = f_cos_of_sky(context, &p, wi, seed, value.f_cos);
                throughput =
                    (Rgb){throughput.r * ratio(f.r, value.f_cos.r), throughput.g * ratio(f.g, value.f_cos.g),
                          throughput.b * ratio(f.b, value.f_cos.b)};
            }
            add(&sum, throughput, sky.radiance, mis_weight(context, WEFT_SAMPLING_LOBE, pdf, sky.pdf));
            return sum;
        }
    }
}
