/* shade.c - light samples and materials at the vertices of a chunk, and the rays that go on */
#include "trace/chunk.h"

#include "shading/dialect/loop.h"
#include "shading/stack/frame.h"
#include "trace/sampler.h"

LOOP(draw_numbers, (const Chunk *c, uint32_t pair, int n, float *restrict u, float *restrict v),
     (c, pair, n, u, v)) {
    const uint32_t *pixel = c->pixel, *sample = c->sample;
    EACH(k, (size_t)n) {
        Point p = sampler_point(pixel[k], sample[k], pair);
        u[k] = p.u;
        v[k] = p.v;
    }
}

/* World directions as the shading frame has them. */
LOOP(turn_in_n, (const Chunk *c, Row w[3], int n, Row *restrict local), (c, w, n, local)) {
    for (int axis = 0; axis < 3; axis++) {
        const Row *along = c->frame[axis];
        float *to = local[axis];
        EACH(k, (size_t)n) { to[k] = w[0][k] * along[0][k] + w[1][k] * along[1][k] + w[2][k] * along[2][k]; }
    }
}

/* The normals below which no light counts; 0 where it counts from both sides. */
static void put_facing(const Chunk *c, const PathMaterial *material, const float *facing[3]) {
    static const Row nowhere;
    for (int a = 0; a < 3; a++) facing[a] = material->transmits ? nowhere : c->facing[a];
}

static void sample_lights(Chunk *c, const ChunkSource *from, int n) {
    const Lights *lights = from->context->lights;
    KindVertices *v = &c->vertices;
    uint32_t pair = SAMPLER_VERTEX + SAMPLER_PER_VERTEX * (uint32_t)from->depth;
    const float *const point[3] = {c->lifted[0], c->lifted[1], c->lifted[2]};
    const float *normal[3];
    put_facing(c, &from->context->materials[from->material], normal);
    for (int g = 0; g < LIGHT_GROUPS; g++) {
        if (!lights_shine(lights, (LightGroup)g)) continue;
        draw_numbers(c, pair + (uint32_t)g, n, v->u, v->v);
        stage_end(c->clock, STAGE_NUMBERS);
        lights_sample_rows(lights, (LightGroup)g, n, point, normal, v->u, v->v, &c->light[g]);
        turn_in_n(c, c->light[g].wi, n, v->i[g]);
        stage_end(c->clock, (TraceStage)(STAGE_SKY + g)); /* in the order of LightGroup */
    }
    draw_numbers(c, pair + LIGHT_GROUPS, n, v->u, v->v);
    stage_end(c->clock, STAGE_NUMBERS);
}

static void put_value(Chunk *c, int direction, int k, const Rgb *f, float pdf) {
    KindVertices *v = &c->vertices;
    v->f[direction][0][k] = f->r;
    v->f[direction][1][k] = f->g;
    v->f[direction][2][k] = f->b;
    v->pdf[direction][k] = pdf;
}

/* f cos, which was asked for with that seed, as it is for the environment's light: ambient times what the
 * diffuse lobe and dust reflect first, reflection times what the others do. */
static Rgb f_cos_of_sky(const PathContext *context, const Stack *stack, const StackView *view, Dir wi,
                        uint32_t seed, Rgb f_cos) {
    const Environment *sky = &context->scene->environment;
    Slots others = slots_of(false, true, true, true, false);
    Rgb rest = rgb_add(stack_eval_of(stack, view, others, wi).f_cos,
                       layer_walk_bounces(stack, view, others, wi, seed));
    Rgb f = rgb_add(rgb_scale(f_cos, sky->ambient), rgb_scale(rest, sky->reflection - sky->ambient));
    return rgb(max(f.r, 0.0f), max(f.g, 0.0f), max(f.b, 0.0f));
}

/* The stack at a vertex: the material's, or one of its own. */
static const Stack *stack_at(Chunk *c, const PathMaterial *material, int k) {
    Surface surface = surface_of_row(&c->vertices.surface, (size_t)k);
    if (!material->textured && !(surface.dust > 0.0f)) return &material->stack;
    Dir normal = dir(c->frame[2][0][k], c->frame[2][1][k], c->frame[2][2][k]);
    Dir position = dir(c->position[0][k], c->position[1][k], c->position[2][k]);
    surface = dust_accumulate(frame_surface(surface), normal, position);
    stack_make(&c->stack, &surface, &material->choices, material->sheen_e);
    if (material->cloth) {
        const YarnRows *yarn = &c->vertices.yarn;
        const Lobe lobe = yarn_of_row(yarn, (size_t)k);
        stack_put_base(&c->stack, &lobe, ROW_RGB(yarn->once, k), ROW_RGB(yarn->again, k));
    }
    return &c->stack;
}

/* f cos and pdf of the stack, or of a measurement in its place, whose samples are half its own, half the stack's. */
static void vertex_eval(const Measured *measured, const Stack *stack, const StackView *view, const Dir *wi,
                        uint32_t seed, StackValue *value) {
    float f[3];
    stack_eval(stack, view, wi, seed, value);
    if (!measured) return;
    measured_at(measured, view->o, *wi, f);
    value->f_cos = rgb_scale(rgb(f[0], f[1], f[2]), max(wi->z, 0.0f));
    value->pdf = wi->z > 0.0f ? 0.5f * (value->pdf + measured_pdf(measured, view->o, *wi)) : 0.0f;
}

static void vertex_sample(const Measured *measured, const Stack *stack, const StackView *view, float u,
                          float v, Dir *wi) {
    if (measured && u < 0.5f)
        *wi = measured_sample(measured, view->o, 2.0f * u, v);
    else
        stack_sample(stack, view, measured ? 2.0f * u - 1.0f : u, v, wi);
}

/* f cos as it is for the environment's light; all of a measurement counts as reflection. */
static Rgb vertex_sky(const PathContext *context, const Measured *measured, const Stack *stack,
                      const StackView *view, Dir wi, uint32_t seed, Rgb f_cos) {
    return measured ? rgb_scale(f_cos, context->scene->environment.reflection)
                    : f_cos_of_sky(context, stack, view, wi, seed, f_cos);
}

/* One vertex at a time, whatever its stack is. */
static void shade_vertex(Chunk *c, const ChunkSource *from, const PathMaterial *material, int k) {
    const PathContext *context = from->context;
    const Measured *measured = material->measured;
    KindVertices *v = &c->vertices;
    const Stack *stack = stack_at(c, material, k);
    uint32_t seed = hash32(c->key[k]);
    Dir o = dir(v->o[0][k], v->o[1][k], v->o[2][k]), wi;
    StackValue value;
    stack_see(stack, &o, &c->view);
    for (int g = 0; g < LIGHT_GROUPS; g++) {
        if (!lights_shine(context->lights, (LightGroup)g)) continue;
        wi = dir(v->i[g][0][k], v->i[g][1][k], v->i[g][2][k]);
        vertex_eval(measured, stack, &c->view, &wi, seed, &value);
        if (g == LIGHTS_SKY && context->sky_in_parts)
            value.f_cos = vertex_sky(context, measured, stack, &c->view, wi, seed, value.f_cos);
        put_value(c, g, k, &value.f_cos, value.pdf);
    }
    seed = hash32(c->key[k] ^ 0x68e31da4u);
    vertex_sample(measured, stack, &c->view, v->u[k], v->v[k], &wi);
    vertex_eval(measured, stack, &c->view, &wi, seed, &value);
    v->i[KIND_DRAWN][0][k] = wi.x, v->i[KIND_DRAWN][1][k] = wi.y, v->i[KIND_DRAWN][2][k] = wi.z;
    put_value(c, KIND_DRAWN, k, &value.f_cos, value.pdf);
    if (!context->sky_in_parts) return;
    Rgb f = vertex_sky(context, measured, stack, &c->view, wi, seed, value.f_cos);
    c->f_sky[0][k] = f.r, c->f_sky[1][k] = f.g, c->f_sky[2][k] = f.b;
}

void chunk_shade(Chunk *c, const ChunkSource *from) {
    const PathContext *context = from->context;
    const PathMaterial *material = &context->materials[from->material];
    int n = row_whole(from->n);
    sample_lights(c, from, n);
    if (material->kind && !context->sky_in_parts) {
        bool shine[LIGHT_GROUPS];
        for (int g = 0; g < LIGHT_GROUPS; g++) shine[g] = lights_shine(context->lights, (LightGroup)g);
        kind_shade(material->kind, &c->vertices, material->sheen_e, shine, n);
        stage_end(c->clock, STAGE_SHADE);
    } else {
        for (int k = 0; k < from->n; k++) shade_vertex(c, from, material, k);
        stage_end(c->clock, STAGE_SHADE_EACH);
    }
}

/* Weighs each path along the direction that was drawn; goes is 0 if it ends. */
LOOP(weigh_paths_n, (Chunk *restrict c, bool roulette, uint32_t place, int n), (c, roulette, place, n)) {
    KindVertices *v = &c->vertices;
    float(*i)[ROW_ROOM] = v->i[KIND_DRAWN], (*f)[ROW_ROOM] = v->f[KIND_DRAWN], *pdf = v->pdf[KIND_DRAWN];
    Row *facing = c->facing;
    float surely = roulette ? 0.0f : 1.0f;
    EACH(k, (size_t)n) {
        float x = i[0][k], y = i[1][k], z = i[2][k], p = pdf[k];
        float wx = x * c->frame[0][0][k] + y * c->frame[1][0][k] + z * c->frame[2][0][k];
        float wy = x * c->frame[0][1][k] + y * c->frame[1][1][k] + z * c->frame[2][1][k];
        float wz = x * c->frame[0][2][k] + y * c->frame[1][2][k] + z * c->frame[2][2][k];
        float up = wx * facing[0][k] + wy * facing[1][k] + wz * facing[2][k];
        float worth = 1.0f / (p > 0.0f ? p : 1.0f);
        float r = c->throughput[0][k] * f[0][k] * worth, g = c->throughput[1][k] * f[1][k] * worth,
              b = c->throughput[2][k] * f[2][k] * worth, most = max(r, max(g, b));
        /* the square root ends paths later than their share of the light would, as the eye sees it */
        float survive = max(min(sqrt(max(most, 0.0f)), 1.0f), surely);
        float chance = sampler_random(c->pixel[k], c->sample[k], place);
        bool live = (z * up > 0.0f) & (p > 0.0f) & (most > 0.0f) & (chance < survive);
        float gain = 1.0f / max(survive, 1e-20f);
        c->goes[k] = live ? 1.0f : 0.0f;
        c->worth[0][k] = r * gain;
        c->worth[1][k] = g * gain;
        c->worth[2][k] = b * gain;
        c->gain[k] = worth * gain;
        c->next[0][k] = wx;
        c->next[1][k] = wy;
        c->next[2][k] = wz;
    }
}

static int list_paths(Chunk *c, int n) {
    int count = 0;
    for (int k = 0; k < n; k++) {
        c->list[count] = k;
        count += c->goes[k] > 0.0f;
    }
    return count;
}

FN void append_each(const Chunk *c, bool transmits, int at, int n, Paths *restrict to) {
    const int *list = c->list;
    const float *z = c->vertices.i[KIND_DRAWN][2];
    for (int a = 0; a < 3; a++) {
        float *o = to->o[a] + at, *d = to->d[a] + at, *throughput = to->throughput[a] + at;
        const float *origin = c->origin[a], *behind = c->behind[a], *w = c->next[a], *worth = c->worth[a];
        EACH(k, (size_t)n) {
            float from = origin[list[k]];
            if (transmits) {
                float far = behind[list[k]];
                from = z[list[k]] < 0.0f ? far : from;
            }
            o[k] = from;
            d[k] = w[list[k]];
            throughput[k] = worth[list[k]];
        }
    }
    uint32_t *id = to->id + at, *key = to->key + at;
    float *pdf = to->pdf + at;
    EACH(k, (size_t)n) {
        int j = list[k];
        id[k] = c->id[j];
        key[k] = hash32(c->key[j] + 0x9e3779b9u);
        pdf[k] = c->vertices.pdf[KIND_DRAWN][j];
    }
}

LOOP(append, (const Chunk *c, bool transmits, int at, int n, Paths *restrict to), (c, transmits, at, n, to)) {
    if (transmits)
        append_each(c, true, at, n, to);
    else
        append_each(c, false, at, n, to);
}

/* The normals, for those who ask how probable their light was. */
static void append_normals(const Chunk *c, const PathMaterial *material, int at, int n, Paths *to) {
    const float *facing[3];
    put_facing(c, material, facing);
    for (int a = 0; a < 3; a++)
        for (int k = 0; k < n; k++) to->normal[a][at + k] = facing[a][c->list[k]];
}

static void append_sky(const Chunk *c, int at, int n, Paths *to) {
    for (int a = 0; a < 3; a++)
        for (int k = 0; k < n; k++) {
            int j = c->list[k];
            to->sky[a][at + k] = c->throughput[a][j] * c->f_sky[a][j] * c->gain[j];
        }
}

int chunk_go_on(Chunk *c, const ChunkSource *from, Paths *paths, int at) {
    const PathContext *context = from->context;
    const PathMaterial *material = &context->materials[from->material];
    weigh_paths_n(c, context->roulette && from->depth >= 1, (uint32_t)from->depth, row_whole(from->n));
    int count = list_paths(c, from->n);
    append(c, material->transmits, at, count, paths);
    if (context->sky_in_parts) append_sky(c, at, count, paths);
    if (lights_shine(context->lights, LIGHTS_EMITTERS)) append_normals(c, material, at, count, paths);
    return at + count;
}
